//! The program `thermal-lab bring-up`.

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use thermal_sim::board::BROKEN_BOARDS;

fn run(arguments: &[&str], typed: &str) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_thermal-lab"))
        .arg("bring-up")
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut keys = program.stdin.take().expect("standard input");
    keys.write_all(typed.as_bytes()).expect("keys");
    drop(keys);
    program.wait_with_output().expect("the program ends")
}

fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    // It is there if the tests have run before.
    let _ignored = fs::remove_dir_all(&folder);
    folder
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn the_list_of_broken_boards_is_their_names_and_nothing_else() {
    let output = run(&["--list-broken"], "");
    assert!(output.status.success());
    let names: Vec<_> = BROKEN_BOARDS.iter().map(|board| board.name).collect();
    assert_eq!(text(&output.stdout), names.join("\n") + "\n");
}

#[test]
fn json_has_the_verdict_and_the_findings() {
    let folder = folder("bring-up-json");
    let out = folder.to_str().expect("a path");
    let board = ["--simulated", "--board", "plate-not-bonded"];
    let output = run(&[&board[..], &["--json", "--out", out]].concat(), "");
    assert_eq!(output.status.code(), Some(1));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(json["passed"], false);
    let finding = json["findings"][0].as_str().expect("a finding");
    assert!(finding.contains("plate is not bonded"), "{finding}");
    let page = fs::read_to_string(folder.join("bring-up.html")).expect("a page");
    assert!(page.contains("plate is not bonded") && page.contains("emulated board"));
}

#[test]
fn from_is_refused_with_another_microcontroller_or_image_and_then_leaves_the_record_unchanged() {
    let folder = folder("bring-up-other-device");
    let record = || fs::read_to_string(folder.join("bring-up.json")).expect("a record");
    let image = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
    let other = concat!(env!("CARGO_MANIFEST_DIR"), "/README.md");
    let bring_up = |arguments: &[&str]| {
        let out = folder.to_str().expect("a path");
        // Its first finding keeps it from 12 V at the bridge.
        let board = ["--simulated", "--board", "missing-pull-down", "--out", out];
        run(&[&board[..], arguments].concat(), "")
    };
    assert_eq!(bring_up(&["--image", image]).status.code(), Some(1));
    let first = record();
    for (arguments, part) in [
        (
            &["--from", "reset", "--image", other][..],
            "--from reset: the results of the earlier stages are those of the image",
        ),
        (&["--from", "reset"], "that of --image now is not known"),
        (
            &["--from", "reset", "--image", image, "--draw", "5"],
            "those of microcontroller 53494D550046001400460018, ",
        ),
    ] {
        let refused = bring_up(arguments);
        let shown = text(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{shown}");
        assert!(shown.contains(part), "{shown}");
        assert_eq!(record(), first);
    }
    let same = bring_up(&["--from", "reset", "--image", image]);
    assert_eq!(same.status.code(), Some(1));
    assert!(text(&same.stdout).contains("pull-down R3"), "{same:?}");
    let page = fs::read_to_string(folder.join("bring-up.html")).expect("a page");
    assert!(page.contains("<code>53494D550046001400460018</code>"));
}

/// The first stage needs no device: its port comes with its power.
#[test]
fn a_person_begins_without_a_device_and_ends_with_abort() {
    let folder = folder("bring-up-abort");
    let out = folder.to_str().expect("a path");
    // Everything is off, the first reading has the wrong unit, then the person ends.
    let output = run(&["--port", "/nowhere/at/all", "--out", out], "\n1 V\n1 kohm\nabort\n");
    assert_eq!(output.status.code(), Some(1));
    let (shown, result) = (text(&output.stderr), text(&output.stdout));
    assert!(shown.contains("'1 V' has the unit 'V'; needed is Ω"), "{shown}");
    assert!(shown.contains("ok      touched plate"), "{shown}");
    assert_eq!(result, "not finished: ended by the person; go on with --from bare-board\n");
    assert!(folder.join("bring-up.json").exists());
}

#[test]
fn wrong_arguments_are_answered_with_what_is_allowed() {
    for (arguments, part) in [
        (&["--simulated", "--from", "nowhere"][..], "known: bare-board, rails"),
        (&["--simulated", "--board", "cat"], "known: sound swapped-wires"),
        (&["--board", "sound"], "--board is for --simulated only"),
        (&["--surroundings", "127.0.0.1:1"], "--surroundings is for --tcp only"),
        (&[], "which device? --port NAME"),
    ] {
        let output = run(arguments, "");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let shown = text(&output.stderr);
        assert!(shown.contains(part), "{arguments:?}: {shown}");
    }
}
