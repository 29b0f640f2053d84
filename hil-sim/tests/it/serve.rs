//! `hil-sim serve` as another program meets it.

use std::fs::OpenOptions;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, ChildStdout, Command, Stdio};

use thermal_lab::bring_up::EmulatedBench;
use thermal_lab::client::Client;
use thermal_lab::commissioning::commission;
use thermal_lab::link::ServedLink;
use thermal_sim::commissioning::{settings_for_device, settings_for_scene};
use thermal_sim::scene::Scene;

use super::refused;

/// A served device, which ends with the test.
struct Served {
    child: Child,
    out: BufReader<ChildStdout>,
}

impl Served {
    fn start(arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_hil-sim"))
            .args(["serve", "--engine", "native"])
            .args(arguments)
            .stdout(Stdio::piped())
            .spawn()
            .expect("hil-sim starts");
        let out = BufReader::new(child.stdout.take().expect("a pipe"));
        Self { child, out }
    }

    /// Where it listens.
    fn place(&mut self) -> String {
        self.line("listening on ")
    }

    /// The rest of its next line of output.
    fn line(&mut self, begin: &str) -> String {
        let mut line = String::new();
        self.out.read_line(&mut line).expect("a line");
        let rest = line.strip_prefix(begin).expect(&line);
        rest.strip_suffix('\n').expect("a whole line").into()
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends a line and returns the next one.
fn query(stream: impl Read + Write, line: &str) -> String {
    let mut stream = BufReader::new(stream);
    stream.get_mut().write_all(line.as_bytes()).expect("a line");
    let mut answer = String::new();
    stream.read_line(&mut answer).expect("an answer");
    answer
}

const IDENTITY: &str = "ok thermal-display 0.2.0 fingers=1 ";

#[test]
fn a_device_on_a_tcp_port_is_at_the_printed_address() {
    for speed in ["1", "max"] {
        let mut served = Served::start(&["--tcp", "127.0.0.1:0", "--speed", speed]);
        let stream = TcpStream::connect(served.place()).expect("a connection");
        let answer = query(stream, "id\n");
        assert!(answer.starts_with(IDENTITY), "{answer}");
    }
}

#[cfg(unix)]
#[test]
fn a_device_on_a_pseudo_terminal_is_at_the_printed_path_for_one_program_after_another() {
    let mut served = Served::start(&["../scenes/copper.toml", "--pty"]);
    let path = served.place();
    for _ in 0..3 {
        let terminal = OpenOptions::new().read(true).write(true).open(&path);
        let answer = query(terminal.expect("a terminal"), "id\n");
        assert!(answer.starts_with(IDENTITY), "{answer}");
    }
}

/// Byte for byte: the procedure is in step with the device that it commissions.
#[test]
fn a_served_device_is_commissioned_over_tcp_as_by_the_simulated_operator() {
    const SCENE: &str = "../scenes/copper.toml";
    let listen = ["--tcp", "127.0.0.1:0", "--surroundings", "127.0.0.1:0"];
    let mut served = Served::start(&[&[SCENE, "--speed", "max"][..], &listen].concat());
    let (device, surroundings) = (served.place(), served.line("surroundings on "));
    let link = ServedLink::connect(device, surroundings).expect("a connection");
    let mut operator = EmulatedBench { watch: &mut |_| () };
    let record = commission(&mut Client::new(link), None, &mut operator).expect("commissioned");
    let scene = Scene::read(SCENE.as_ref()).expect("a scene");
    let operators = settings_for_device(&scene.params, scene.room_c, scene.seed);
    assert_eq!(record.settings, operators.expect("commissioned"));
}

#[test]
fn a_device_that_is_served_commissioned_is_tuned_before_its_first_client() {
    for (finger, fingers) in [("", "1"), ("@4 ", "5")] {
        for (tile, options) in [("untuned", &[][..]), ("tuned", &["--commissioned"])] {
            let tcp = ["--tcp", "127.0.0.1:0", "--fingers", fingers];
            let mut served = Served::start(&[&tcp, options].concat());
            let stream = TcpStream::connect(served.place()).expect("a connection");
            let answer = query(stream, &format!("{finger}state\n"));
            assert!(answer.ends_with(&format!(" tile={tile}\n")), "{fingers}: {answer}");
        }
    }
}

#[test]
fn a_commissioned_device_on_the_bench_has_the_settings_of_its_scene() {
    let scene = "../scenes/worst-case-box.toml";
    let listen = ["--tcp", "127.0.0.1:0", "--surroundings", "127.0.0.1:0"];
    let mut served = Served::start(&[&[scene, "--commissioned"][..], &listen].concat());
    let (device, surroundings) = (served.place(), served.line("surroundings on "));
    let link = ServedLink::connect(device, surroundings).expect("a connection");
    let mut client = Client::new(link);
    let scene = Scene::read(scene.as_ref()).expect("a scene");
    let settings = settings_for_scene(&scene).expect("commissioned");
    for (number, expected) in (1..).zip(&settings) {
        let line = client.command(&format!("settings {number}"));
        assert_eq!(line.as_ref().ok(), Some(expected), "{number}: {line:?}");
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_and_sigterm_end_it_with_status_0() {
    for (signal, line) in [("-INT", "--pty"), ("-TERM", "--tcp=127.0.0.1:0")] {
        let mut served = Served::start(&[line]);
        served.place();
        let pid = served.child.id().to_string();
        let sent = Command::new("kill").args([signal, &pid]).status();
        assert!(sent.expect("kill").success());
        assert_eq!(served.child.wait().expect("an end").code(), Some(0));
        let mut rest = String::new();
        served.out.read_to_string(&mut rest).expect("text");
        assert_eq!(rest, "", "more than one line");
    }
}

#[test]
fn what_cannot_be_served_is_refused_with_what_is_allowed() {
    let serve = |rest: &[&str]| refused(&[&["serve", "--engine", "native"], rest].concat());
    for (arguments, expected) in [
        (&["--tcp", "0.0.0.0:4000"][..], "--tcp: 0.0.0.0:4000 is not a loopback address"),
        (&["--tcp", "4000"], "--tcp: '4000' is no address; allowed is a loopback address"),
        (&[], "<--pty|--tcp <ADDR>>"),
        (
            &["--tcp", "127.0.0.1:0", "--fingers", "3"],
            "invalid value '3' for '--fingers <FINGERS>': devices have 1 or 5 fingers",
        ),
        (&["--tcp", "127.0.0.1:0", "--speed", "2"], "[possible values: 1, max]"),
        (&["--tcp", "127.0.0.1:0", "--elf", "x.elf"], "--elf is for --engine image"),
        (&["nowhere.toml", "--tcp", "127.0.0.1:0"], "nowhere.toml"),
        (
            &["--tcp", "127.0.0.1:0", "--surroundings", "10.0.0.1:0"],
            "--surroundings: 10.0.0.1:0 is not a loopback address",
        ),
    ] {
        let message = serve(arguments);
        assert!(message.contains(expected), "{arguments:?}: {message}");
    }
}
