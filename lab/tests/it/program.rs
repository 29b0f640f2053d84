//! The command `thermal-lab`.

use std::io::{BufRead, BufReader, Write};
use std::net::TcpListener;
use std::process::{Command, Output, Stdio};
use std::thread;

use serde_json::Value;

use crate::command::{self, text, thermal_lab};

fn run(line: &str) -> Output {
    command::run(&line.split(' ').collect::<Vec<_>>())
}

fn json(bytes: &[u8]) -> Value {
    serde_json::from_slice(bytes).unwrap()
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

#[test]
fn lines_of_standard_input_are_sent() {
    let mut sender = thermal_lab()
        .args(["send", "--simulated", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    sender.stdin.take().unwrap().write_all(b"law\n\n  finger\n").unwrap();
    let output = sender.wait_with_output().unwrap();
    assert_eq!(text(&output.stdout), "ok law=model\nok finger=mean\n");
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

/// A device that answers everything with `ok`, and counts nothing lost.
#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_log_with_abort() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let server = thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let mut lines = Vec::new();
        for line in BufReader::new(stream.try_clone().unwrap()).lines() {
            let line = line.unwrap();
            let answer = match line.as_str() {
                "" => continue,
                line if line.starts_with("synchronize") => {
                    format!("err unknown command '{line}'\n")
                }
                "stream 10" => "ok\nT 10 armed - - - - - - 0 0 0 -\n".into(),
                _ => "ok\n".into(),
            };
            lines.push(line);
            if stream.write_all(answer.as_bytes()).is_err() {
                break;
            }
        }
        lines
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
    let lines = server.join().unwrap();
    // The first two lines end checksums and find the answers.
    assert_eq!(lines[2..], ["stream 10", "stream 0", "abort"]);
}
