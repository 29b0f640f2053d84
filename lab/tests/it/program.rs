//! The command `thermal-lab`.

use std::io::{BufRead, BufReader, Write};
use std::net::{SocketAddr, TcpListener};
use std::process::{Command, Output, Stdio};
use std::thread::{self, JoinHandle};

use serde_json::Value;

use crate::command::{self, text, thermal_lab};

fn run(line: &str) -> Output {
    command::run(&line.split(' ').collect::<Vec<_>>())
}

fn json(bytes: &[u8]) -> Value {
    serde_json::from_slice(bytes).unwrap()
}

#[test]
fn version_is_that_of_the_package() {
    let version = run("--version");
    assert!(version.status.success());
    assert_eq!(text(&version.stdout), format!("thermal-lab {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn ports_are_listed_as_json() {
    assert!(json(&run("ports --json").stdout).is_array());
    assert!(run("ports").status.success());
}

#[test]
fn a_simulated_device_says_what_it_is() {
    let info = json(&run("info --simulated --json").stdout);
    assert_eq!(info["device"]["fingers"], 1);
    assert_eq!(info["state"]["state"], "off");
    assert_eq!(info["settings"].as_array().unwrap().len(), 8);
}

#[test]
fn a_course_is_loaded_and_waits_for_the_landing() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("course.csv");
    std::fs::write(&path, "t_s,celsius\n0,30\n2,28\n").unwrap();
    let play = format!("play --simulated --json {}", path.display());
    let played = run(&format!("{play} --arm --repeats 3"));
    assert!(played.status.success(), "{}", text(&played.stderr));
    let played = json(&played.stdout);
    assert_eq!((&played["points"], &played["at"]), (&2.into(), &"landing".into()));
    let refused = run(&play);
    assert_eq!(refused.status.code(), Some(1));
    assert!(
        text(&refused.stderr).contains("play needs a driven display: arm first"),
        "{}",
        text(&refused.stderr)
    );
    std::fs::write(&path, "0,30\n2,99\n").unwrap();
    let wrong = run(&play);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(text(&wrong.stderr).contains("course.csv:2: celsius 99"), "{}", text(&wrong.stderr));
}

/// `play` with these arguments and this standard input.
fn play(arguments: &[&str], input: &[u8]) -> Output {
    let mut player = thermal_lab()
        .args(["play", "--simulated", "--arm"])
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A program that refuses the file does not read it.
    let _ignored = player.stdin.take().unwrap().write_all(input);
    player.wait_with_output().unwrap()
}

/// Whoever opens a FIFO waits until another program writes into it, and a device may have no end.
#[cfg(unix)]
#[test]
fn a_course_may_come_through_a_pipe_but_not_from_a_fifo_device_or_folder() {
    let course = b"t_s,celsius\n0,30\n2,28\n";
    let piped = play(&["/dev/stdin"], course);
    assert!(piped.status.success(), "{}", text(&piped.stderr));
    assert_eq!(piped.stdout, play(&["/dev/fd/0"], course).stdout);
    let fifo = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("course.fifo");
    let _ignored = std::fs::remove_file(&fifo);
    assert!(Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    for (path, kind) in [
        (fifo.to_str().unwrap(), "a FIFO"),
        ("/dev/zero", "a device"),
        (env!("CARGO_TARGET_TMPDIR"), "a folder"),
    ] {
        let refused = play(&[path], b"");
        assert_eq!(refused.status.code(), Some(2), "{path}");
        let said = format!("{path}: this is {kind}; allowed is a file");
        assert!(text(&refused.stderr).contains(&said), "{}", text(&refused.stderr));
    }
}

#[test]
fn errors_of_touches_that_are_no_numbers_are_refused_with_their_line() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("touches.csv");
    let columns = "population,case,told,skin_max_after_50ms_mk,skin_max_after_500ms_mk";
    for (columns, rows, said) in [
        (
            columns,
            "B,copper,as-it-is,20,NaN",
            "touches.csv:2: skin_max_after_500ms_mk = NaN; allowed is a finite number",
        ),
        (
            columns,
            "B,copper,as-it-is,20,9\nB,copper,other,1e999,9",
            "touches.csv:3: skin_max_after_50ms_mk = inf; allowed is a finite number",
        ),
        (
            &format!("{columns},told"),
            "B,copper,as-it-is,20,9,x",
            "touches.csv:1: two columns \"told\"; allowed is each name once",
        ),
    ] {
        std::fs::write(&path, format!("{columns}\n{rows}\n")).unwrap();
        let refused = run(&format!("predict --touches {}", path.display()));
        assert_eq!((refused.status.code(), text(&refused.stdout)), (Some(2), ""));
        assert!(text(&refused.stderr).contains(said), "{}", text(&refused.stderr));
    }
}

#[test]
fn answers_are_printed_and_a_refusal_is_a_failure() {
    let sent = run("send --simulated law arm");
    assert_eq!(text(&sent.stdout), "ok law=model\nok\n");
    assert!(sent.status.success());
    let refused = run("send --simulated --json law start state");
    assert_eq!(refused.status.code(), Some(1));
    let lines: Vec<Value> =
        text(&refused.stdout).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 2);
    assert_eq!(lines[1]["answer"], "err start needs arm first");
    assert_eq!(lines[1]["ok"], false);
}

/// `send -` with this standard input.
fn send_all(input: &[u8]) -> Output {
    let mut sender = thermal_lab()
        .args(["send", "--simulated", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    sender.stdin.take().unwrap().write_all(input).unwrap();
    sender.wait_with_output().unwrap()
}

#[test]
fn lines_of_standard_input_are_sent() {
    for mark in ["", "\u{feff}"] {
        let output = send_all(format!("{mark}law\r\n\n  finger\n").as_bytes());
        assert_eq!(text(&output.stdout), "ok law=model\nok finger=mean\n");
    }
}

#[test]
fn standard_input_in_utf_16_is_refused_before_anything_is_sent() {
    for mark in ["", "\u{feff}"] {
        let input = format!("{mark}law\nfinger\n");
        let output = send_all(&input.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<_>>());
        assert_eq!((output.status.code(), text(&output.stdout)), (Some(2), ""));
        let error = text(&output.stderr);
        assert!(error.contains("standard input: this is UTF-16; allowed is UTF-8"), "{error}");
    }
}

#[test]
fn telemetry_is_logged_with_the_time_of_its_ticks() {
    let logged = run("log --simulated --interval 20 --duration 1");
    assert!(logged.status.success());
    let mut reader = csv::Reader::from_reader(&*logged.stdout);
    let names = reader.headers().unwrap().clone();
    let column = |name: &str| names.iter().position(|other| other == name).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert!((48..=51).contains(&rows.len()), "{}", rows.len());
    let number = |row: &csv::StringRecord, name: &str| row[column(name)].parse::<f64>().unwrap();
    for pair in rows.windows(2) {
        assert_eq!(number(&pair[1], "tick") - number(&pair[0], "tick"), 20.0);
        assert_eq!(number(&pair[1], "lost_before"), 0.0);
    }
    let last = rows.last().unwrap();
    assert!((number(last, "tick_at_s") - number(last, "received_s")).abs() < 2e-3);
    assert!((number(last, "room_c") - 24.0).abs() < 0.5);
    assert_eq!(&last[column("state")], "off");
}

#[test]
fn a_log_has_the_columns_of_a_heat_flux_sensor_at_its_end_if_the_device_has_one() {
    const ALWAYS: &str = "received_s,tick_at_s,tick_error_s,lost_before,finger,tick,state,fault,setpoint_c,display_c,sink_c,\
                          skin_c,room_c,force_n,demand_a,current_a,evaluations,limited";
    for (sensor, header) in [
        (false, format!("{ALWAYS},check_c")),
        (true, format!("{ALWAYS},flux_w_m2,surface_c,known,check_c")),
    ] {
        let scene = command::scene_file(&format!("log-{sensor}.toml"), "copper", sensor, "");
        let logged =
            run(&format!("log --simulated --scene {} --duration 0.5", scene.to_str().unwrap()));
        assert!(logged.status.success(), "{}", text(&logged.stderr));
        let lines: Vec<_> = text(&logged.stdout).lines().collect();
        assert_eq!(lines[0], header);
        let cells: Vec<_> = lines.last().unwrap().split(',').collect();
        assert_eq!(cells.len(), header.split(',').count());
        if sensor {
            // Nobody touches it: the air takes little, and nothing is learnt yet.
            let flux_w_m2: f64 = cells[18].parse().unwrap();
            assert!(flux_w_m2.abs() < 200.0, "{flux_w_m2}");
            assert_eq!(cells[20], "learning");
        }
    }
}

#[test]
fn a_simulated_device_is_commissioned_as_by_the_simulated_operator() {
    let done = run("commission --simulated --json");
    let record = json(&done.stdout);
    let settings = record["settings"].as_array().unwrap();
    let operators =
        thermal_sim::commissioning::settings_for_device(&thermal_plant::Params::nominal(), 24.0, 0);
    assert_eq!(settings, &operators.unwrap());
    assert!(text(&done.stderr).contains("calibrate the sink's thermistor on coolants"));
}

#[test]
fn wrong_arguments_say_what_is_allowed() {
    for (line, says) in [
        ("info", "--port NAME (`thermal-lab ports` lists them), --tcp ADDR or --simulated"),
        ("info --port /dev/no-such-port", "thermal-lab ports"),
        ("info --tcp 127.0.0.1:1", "--tcp 127.0.0.1:1"),
        ("info --simulated --tcp 127.0.0.1:1", "cannot be used with"),
        ("log --simulated --interval 0", "1..=60000"),
        ("log --simulated --duration=-1", "allowed are 0 to 1e6 s"),
        ("send --simulated", "<LINE>"),
        ("commission --simulated --surroundings 127.0.0.1:1", "--tcp"),
    ] {
        let output = run(line);
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert!(text(&output.stderr).contains(says), "{line}: {}", text(&output.stderr));
    }
}

/// Answer to `id`.
const IDENTITY: &str =
    "ok thermal-display 0.2.0 fingers=1 tick_hz=1000 scan_hz=16000 protocol=2 capabilities=course";

/// A device that answers as `answer` says, and the lines that it has received. In place of a mere `ok` to `id` and `state` it says what it
/// is, and whether it is driven: it was armed, and has not accepted `abort` since.
fn device(
    answer: impl Fn(&str) -> String + Send + 'static,
) -> (SocketAddr, JoinHandle<Vec<String>>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let server = thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let (mut lines, mut is_driven) = (Vec::new(), false);
        for line in BufReader::new(stream.try_clone().unwrap()).lines() {
            let line = line.unwrap();
            if line.is_empty() {
                continue;
            }
            let answer = match (line.as_str(), answer(&line)) {
                (line, _) if line.starts_with("synchronize") => {
                    format!("err unknown command '{line}'")
                }
                ("id", ok) if ok == "ok" => IDENTITY.into(),
                ("state", ok) if ok == "ok" => {
                    let state = if is_driven { "armed" } else { "ready" };
                    format!(
                        "ok state={state} fault=- material=- object_c=room mode=contact setpoint_c=- body=half-space"
                    )
                }
                (line, answer) => {
                    is_driven = line == "arm" || is_driven && (line != "abort" || answer != "ok");
                    answer
                }
            };
            lines.push(line);
            if stream.write_all((answer + "\n").as_bytes()).is_err() {
                break;
            }
        }
        // The first two lines end checksums and find the answers.
        lines.split_off(2)
    });
    (address, server)
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_log_with_abort() {
    let (address, server) = device(|line| match line {
        "id" => "ok thermal-display 0.1.0 fingers=1 tick_hz=1000 scan_hz=1000".into(),
        "flux" => "err unknown command 'flux'".into(),
        "stream 10" => "ok\nT 10 armed - - - - - - 0 0 0 -".into(),
        _ => "ok".into(),
    });
    let mut logger = thermal_lab()
        .args(["log", "--tcp", &address.to_string()])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut out = BufReader::new(logger.stdout.take().unwrap());
    let mut line = String::new();
    // Columns and the first row.
    out.read_line(&mut line).unwrap();
    out.read_line(&mut line).unwrap();
    let signalled = Command::new("kill").args(["-INT", &logger.id().to_string()]).status();
    assert!(signalled.unwrap().success());
    assert!(logger.wait().unwrap().success());
    assert_eq!(
        server.join().unwrap(),
        ["id", "flux", "stream 10", "abort", "id", "state", "stream 0"]
    );
}

/// What an armed device refuses, for a reason that no program can know before, switches its bridge off again.
#[test]
fn a_command_that_fails_after_it_has_armed_the_device_switches_the_bridge_off() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("refused-course.csv");
    std::fs::write(&path, "0,30\n2,28\n").unwrap();
    for refused in ["upload commit", "play landing", "law"] {
        let (address, server) = device(move |line| match line {
            line if line.starts_with(refused) => "err so it is".into(),
            _ => "ok".into(),
        });
        let path = path.display();
        let command =
            if refused == "law" { "send arm law".into() } else { format!("play --arm {path}") };
        let failed = run(&format!("{command} --tcp {address}"));
        assert_eq!(failed.status.code(), Some(1), "{refused}");
        let said = text(&failed.stderr);
        assert!(said.contains("the bridge is off"), "{refused}: {said}");
        let lines = server.join().unwrap();
        if refused != "law" {
            assert_eq!(
                lines[0], "stream 60000",
                "a device that is armed trips if the program vanishes"
            );
        }
        // What guards the device ends only when its bridge is known to be off.
        let end = ["abort", "id", "state", "stream 0"].map(String::from);
        let end = &end[..if refused == "law" { 3 } else { 4 }];
        assert!(lines.ends_with(end), "{lines:?}");
    }
    // A device that this program has not armed is left as it is.
    let (address, server) =
        device(|line| if line == "law" { "err so it is".into() } else { "ok".into() });
    assert_eq!(run(&format!("send --tcp {address} law")).status.code(), Some(1));
    assert_eq!(server.join().unwrap(), ["law"]);
}

/// A damaged answer to `abort`, and an `ok` after which the device goes on.
#[test]
fn a_bridge_that_may_still_be_on_is_said() {
    // Out of step `abort` is sent before answers and lines are in step, and once more after.
    for (abort, says, aborts) in [
        ("ok T 1 and other noise", "the answer to 'abort' is not understood", 5),
        ("ok ", "finger 0 is in state armed", 3),
    ] {
        let (address, server) = device(move |line| match line {
            "abort" => abort.into(),
            "law" => "err so it is".into(),
            _ => "ok".into(),
        });
        let failed = run(&format!("send --tcp {address} arm law"));
        assert_eq!(failed.status.code(), Some(1));
        let said = text(&failed.stderr);
        assert!(said.contains("THE BRIDGE MAY STILL BE ON") && said.contains(says), "{said}");
        assert!(!said.contains("bridge is off"), "{said}");
        let sent = server.join().unwrap();
        assert_eq!(sent.iter().filter(|line| *line == "abort").count(), aborts, "{says}");
    }
}

/// A course that the device would refuse is refused before the line is opened: there is no device at this address.
#[test]
fn a_course_that_a_device_refuses_is_refused_before_anything_is_armed() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("too-much.csv");
    for (course, repeats, says) in [
        ("0,32\n1000,32\n3400,20\n7400,20\n", 1, "too-much.csv:4: too long: 7400000 ms"),
        ("0,32\n1000,32\n3400,20\n7400,20\n", 1, "3600000 ms at most"),
        ("t_s,celsius\n0,32\n1,32\n1.05,20\n3,20\n", 1, "too-much.csv:4: too fast: 240 K/s"),
        ("0,32\n1,41\n600,41\n", 1, "too-much.csv: too hot for too long: CEM43 would be"),
        ("0,32\n1,41\n100,41\n", 20, "played 20 times it is too hot for too long"),
    ] {
        std::fs::write(&path, course).unwrap();
        let line = format!("play --arm --tcp 127.0.0.1:1 --repeats {repeats} {}", path.display());
        let refused = run(&line);
        let said = text(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{course}: {said}");
        assert!(said.contains(says), "{course}: {said}");
    }
}

/// A measurement is not replaced unless someone asks for it, and a device that is not there leaves no empty file.
#[test]
fn a_file_of_an_earlier_measurement_is_kept() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("kept-files");
    let _ignored = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let new = folder.join("new.csv");
    assert!(!run(&format!("log --tcp 127.0.0.1:1 --out {}", new.display())).status.success());
    assert!(!new.exists());
    for (line, file) in [
        ("log --simulated --duration 0.1 --out", "log.csv"),
        ("contact P1 --simulated --out", "contact.svg"),
        ("enrol P1 --simulated --out", "person.toml"),
        ("bring-up --simulated --out", "bring-up.json"),
    ] {
        let path = folder.join(file);
        std::fs::write(&path, "measured\n").unwrap();
        let out = match file {
            "contact.svg" => path.with_extension(""),
            "bring-up.json" => folder.clone(),
            _ => path.clone(),
        };
        let refused = run(&format!("{line} {}", out.display()));
        let said = text(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{line}: {said}");
        assert!(said.contains(file) && said.contains("--force"), "{line}: {said}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "measured\n");
    }
    let log = folder.join("log.csv");
    let replaced = run(&format!("log --simulated --duration 0.1 --force --out {}", log.display()));
    assert!(replaced.status.success());
    assert!(std::fs::read_to_string(&log).unwrap().starts_with("received_s,"));
}

/// Firmware of version 0.1, which knows no courses.
#[test]
fn a_device_that_cannot_run_a_session_is_refused_before_a_folder_is_made() {
    let (address, server) = device(|line| match line {
        "id" => "ok thermal-display 0.1.0 fingers=1 tick_hz=1000 scan_hz=1000".into(),
        _ => "ok".into(),
    });
    let out = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("unsuitable");
    let _ignored = std::fs::remove_dir_all(&out);
    let session = concat!(env!("CARGO_MANIFEST_DIR"), "/sessions/p5-real-and-simulated.toml");
    let refused = run(&format!(
        "run {session} --participant 01 --headless --tcp {address} --out {}",
        out.display()
    ));
    let said = text(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(said.contains("its firmware 0.1.0 has no 'course'"), "{said}");
    assert_eq!(server.join().unwrap(), ["id"]);
    assert!(!out.exists());
}
