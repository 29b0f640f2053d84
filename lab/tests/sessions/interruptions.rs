//! A program that is killed, a full disk, and two programs with one folder.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use thermal_session::dataset::{Folder, recorded_sessions};

use crate::folder::{assert_equal, contents, with_session, with_skin_sensors};
use crate::program::{line, run, thermal_lab};

/// Number of moments at which the program is killed: as this variable says, or few enough for a suite of tests.
const KILLS_VARIABLE: &str = "THERMAL_LAB_KILLS";
const KILLS: u32 = 3;

#[test]
fn a_session_that_was_killed_at_any_moment_is_resumed_to_the_same_data() {
    let (folder, session) = with_session("killed");
    kill_and_resume(&folder, &session, "p5");
}

#[test]
fn a_session_that_only_measures_the_skin_was_killed_and_is_resumed_to_the_same_data() {
    let (folder, session) = with_skin_sensors("killed-skin");
    kill_and_resume(&folder, &session, "p2");
}

fn kill_and_resume(folder: &Path, session: &Path, task: &str) {
    let [whole, killed] = ["whole", "killed"].map(|name| folder.join(name));
    let began = Instant::now();
    assert!(run(&line(session, &whole)).status.success());
    let took = began.elapsed();
    let kills = std::env::var(KILLS_VARIABLE).ok().and_then(|count| count.parse().ok());
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    let (mut in_the_middle, mut trials_kept) = (0, 0);
    for _ in 0..kills.unwrap_or(KILLS) {
        let _ignored = fs::remove_dir_all(&killed);
        let after = took.mul_f64(random.random_range(0.05..1.0));
        let mut child = thermal_lab(&line(session, &killed)).stderr(Stdio::null()).spawn().unwrap();
        sleep(after);
        in_the_middle += u32::from(child.try_wait().unwrap().is_none());
        child.kill().unwrap();
        child.wait().unwrap();
        if log(&killed, task).exists() {
            let left = recorded_sessions(&killed).unwrap().sessions;
            trials_kept += left.first().map_or(0, |session| session.records.len());
            let resumed = run(&(line(session, &killed) + " --resume"));
            assert!(resumed.status.success(), "{}", String::from_utf8_lossy(&resumed.stderr));
        } else {
            // Killed before it had begun: nothing is there that could be resumed.
            assert!(run(&line(session, &killed)).status.success());
        }
        assert_equal(&whole, &killed);
    }
    println!(
        "{in_the_middle} of the kills found the program running; {trials_kept} trials were kept"
    );
    assert!(in_the_middle > 0);
}

fn log(root: &Path, task: &str) -> std::path::PathBuf {
    Folder::new(root, "01", task).source("log.jsonl")
}

#[test]
fn a_full_disk_ends_the_session_with_a_message_and_loses_no_recorded_trial() {
    let (folder, session) = with_session("full");
    let [whole, full] = ["whole", "full"].map(|name| folder.join(name));
    assert!(run(&line(&session, &whole)).status.success());
    // No file may become longer than 300 KB, and the program is told so by an error of its writes.
    let program = env!("CARGO_BIN_EXE_thermal-lab");
    let script = format!("trap '' XFSZ; ulimit -f 600; exec {program} {}", line(&session, &full));
    let output = Command::new("sh").args(["-c", &script]).stdin(Stdio::null()).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(
        stderr.contains("telemetry.csv: ")
            && stderr.contains("--resume goes on when there is room"),
        "{stderr}"
    );
    let sessions = recorded_sessions(&full).unwrap().sessions;
    let trials = sessions[0].records.len();
    assert!((1..8).contains(&trials), "{trials} trials before the disk was full");
    assert!(run(&(line(&session, &full) + " --resume")).status.success());
    assert_equal(&whole, &full);
}

#[test]
fn two_programs_do_not_record_into_the_same_session() {
    let (folder, session) = with_session("twice");
    let out = folder.join("data");
    let mut first = thermal_lab(&(line(&session, &out) + " --real-time"))
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let began = Instant::now();
    while !log(&out, "p5").exists() && began.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(20));
    }
    let second = run(&(line(&session, &out) + " --resume"));
    first.kill().unwrap();
    first.wait().unwrap();
    let stderr = String::from_utf8_lossy(&second.stderr);
    assert_eq!(second.status.code(), Some(1), "{stderr}");
    assert!(stderr.contains("another program records this session"), "{stderr}");
}

/// A text tool that writes CR LF makes the telemetry longer than the log says. Nothing is cut then, and nothing is written.
#[test]
fn a_session_whose_files_were_changed_is_refused_before_anything_is_written() {
    let (folder, session) = with_session("line-ends");
    let data = folder.join("data");
    assert!(run(&line(&session, &data)).status.success());
    let telemetry = Folder::new(&data, "01", "p5").source("telemetry.csv");
    let text = fs::read_to_string(&telemetry).unwrap();
    fs::write(&telemetry, text.replace('\n', "\r\n")).unwrap();
    let before = contents(&data);
    let refused = run(&(line(&session, &data) + " --resume"));
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(1), "{said}");
    assert!(said.contains("telemetry.csv:1: this line ends with CR LF"), "{said}");
    assert!(contents(&data) == before);
    // A code that differs in capital letters only would be the same folder on some computers.
    fs::rename(data.join("sourcedata/sub-01"), data.join("sourcedata/sub-p01")).unwrap();
    let alike = line(&session, &data).replace("--participant 01", "--participant P01");
    let refused = run(&alike);
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(said.contains("participant P01: there are data of p01"), "{said}");
}

/// A full disk has interrupted it.
#[test]
fn a_session_is_resumed_with_a_file_in_which_only_a_comment_was_corrected_and_says_so() {
    let (folder, session) = with_session("comment");
    let [whole, data] = ["whole", "data"].map(|name| folder.join(name));
    assert!(run(&line(&session, &whole)).status.success());
    let program = env!("CARGO_BIN_EXE_thermal-lab");
    let script = format!("trap '' XFSZ; ulimit -f 600; exec {program} {}", line(&session, &data));
    let stopped = Command::new("sh").args(["-c", &script]).stdin(Stdio::null()).output().unwrap();
    assert_eq!(stopped.status.code(), Some(1));
    let resume = line(&session, &data) + " --resume";
    let text = fs::read_to_string(&session).unwrap();
    let recorded = Folder::new(&data, "01", "p5").source("session.toml");
    let recorded = recorded.to_str().unwrap();
    // Another rule for void trials is the same plan, and another session.
    for (from, to) in
        [("off_preset_k = 0.3", "off_preset_k = 0.4"), ("Rest both hands", "Put both hands")]
    {
        assert!(text.contains(from), "{from}");
        fs::write(&session, text.replace(from, to)).unwrap();
        let before = contents(&data);
        let refused = run(&resume);
        let said = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{said}");
        assert!(said.contains(recorded) && said.contains("something else"), "{said}");
        assert!(contents(&data) == before);
    }
    fs::write(&session, format!("# Room 12\r\n{}", text.replace('\n', "\r\n"))).unwrap();
    let resumed = run(&resume);
    let said = String::from_utf8_lossy(&resumed.stderr);
    assert!(resumed.status.success(), "{said}");
    assert!(said.contains(recorded) && said.contains("the recorded file is used"), "{said}");
    assert_equal(&whole, &data);
}

/// Each adds its participant to the list that all share.
#[test]
fn several_programs_record_into_one_data_set_at_once() {
    const PROGRAMS: usize = 4;
    let (folder, session) = with_session("at-once");
    let data = folder.join("data");
    let programs: Vec<_> = (1..=PROGRAMS)
        .map(|number| {
            let words = line(&session, &data)
                .replace("--participant 01", &format!("--participant 0{number}"));
            thermal_lab(&words).stderr(Stdio::null()).spawn().unwrap()
        })
        .collect();
    for mut program in programs {
        assert!(program.wait().unwrap().success());
    }
    let list = fs::read_to_string(data.join("participants.tsv")).unwrap();
    let mut codes: Vec<_> = list.lines().skip(1).collect();
    codes.sort_unstable();
    assert_eq!(codes, ["sub-01", "sub-02", "sub-03", "sub-04"]);
    assert_eq!(recorded_sessions(&data).unwrap().sessions.len(), PROGRAMS);
}
