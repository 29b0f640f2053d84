//! A served device whose time a client of its surroundings rules.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};

use thermal_plant::Params;
use thermal_sim::commissioning::{CommissioningSetup, SimulatedSurroundings};
use thermal_sim::engine::NativeEngine;
use thermal_sim::serve::{Clock, Speed, TcpLine, serve_in_step};

/// A device and its surroundings, served until the test ends.
struct Served {
    addresses: [SocketAddr; 2],
    stop: Arc<AtomicBool>,
    server: Option<JoinHandle<()>>,
}

impl Served {
    fn new() -> Self {
        let mut lines = [(); 2].map(|()| TcpLine::listen("127.0.0.1:0").expect("a free port"));
        let addresses = lines.each_ref().map(|line| line.address().expect("an address"));
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let server = thread::spawn(move || {
            let setup = CommissioningSetup::new(&Params::nominal(), 24.0, 1);
            let mut engine = NativeEngine::new(setup.in_use().expect("a world"));
            let mut surroundings = SimulatedSurroundings::new(&setup);
            let mut clock = Clock::start(Speed::Max);
            let [device, around] = &mut lines;
            let Ok(()) = serve_in_step(
                &mut engine,
                &mut surroundings,
                [device, around],
                &mut clock,
                &stopped,
            );
        });
        Self { addresses, stop, server: Some(server) }
    }

    fn connect(&self) -> Client {
        let [device, surroundings] = self
            .addresses
            .map(|address| BufReader::new(TcpStream::connect(address).expect("a connection")));
        Client { device, surroundings, sent: 0, read: 0 }
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        let ended = self.server.take().map(JoinHandle::join);
        assert!(thread::panicking() || matches!(ended, Some(Ok(()))));
    }
}

struct Client {
    device: BufReader<TcpStream>,
    surroundings: BufReader<TcpStream>,
    sent: usize,
    read: usize,
}

impl Client {
    /// A line to the surroundings, and its answer.
    fn around(&mut self, line: &str) -> String {
        let bytes = format!("{line}\n");
        self.surroundings.get_mut().write_all(bytes.as_bytes()).expect("a connection");
        let mut answer = String::new();
        self.surroundings.read_line(&mut answer).expect("a connection");
        answer.trim_end().into()
    }

    /// Sends text to the device and lets it run; returns what it has sent by then, and the time, ms.
    fn run(&mut self, text: &str, ms: u64) -> (String, u64) {
        self.device.get_mut().write_all(text.as_bytes()).expect("a connection");
        self.sent += text.len();
        let answer = self.around(&format!("wait {ms} {}", self.sent));
        let numbers = answer.strip_prefix("ok ").and_then(|rest| rest.split_once(' '));
        let (now_ms, written) = numbers.expect(&answer);
        let written: usize = written.parse().expect(&answer);
        let mut bytes = vec![0; written - self.read];
        self.device.read_exact(&mut bytes).expect("a connection");
        self.read = written;
        (String::from_utf8(bytes).expect("ASCII"), now_ms.parse().expect(&answer))
    }

    /// A column of the last line of telemetry, after letting the device run.
    fn telemetry(&mut self, ms: u64, column: usize) -> f64 {
        let (text, _) = self.run("\n", ms);
        let last = text.lines().last().expect("telemetry");
        last.split(' ').nth(column).expect(last).parse().expect(last)
    }
}

/// Columns of telemetry.
const SKIN: usize = 6;
const FORCE: usize = 8;

#[test]
fn time_passes_only_as_the_client_of_the_surroundings_says() {
    let served = Served::new();
    let mut from_ms = 0;
    for _client in 0..2 {
        let mut client = served.connect();
        let (text, now_ms) = client.run("id\n", 3);
        assert!(text.starts_with("ok thermal-display ") && text.lines().count() == 1, "{text}");
        // What happens while no client is there takes no time of the test, but of the device.
        assert!(if from_ms == 0 { now_ms == 3 } else { now_ms >= from_ms + 3 });
        from_ms = now_ms;
        assert!(client.around("reference display").starts_with("ok 2"));
        assert_eq!(client.run("", 1), (String::new(), from_ms + 1));
        let (text, now_ms) = client.run("stream 100\n", 1001);
        assert_eq!(now_ms, from_ms + 1002);
        assert!(text.starts_with("ok\nT ") && (10..=12).contains(&text.lines().count()), "{text}");
        (_, from_ms) = client.run("stream 0\n", 3);
    }
}

#[test]
fn baths_force_and_reference_thermometer_are_those_of_the_device() {
    let served = Served::new();
    let mut client = served.connect();
    client.run("stream 10\n", 1000);
    for bath_c in [26.7, 35.0] {
        assert_eq!(client.around(&format!("bath skin {bath_c}")), "ok");
        // A sensor from the shelf reads within a kelvin.
        let skin_c = client.telemetry(2000, SKIN);
        assert!((skin_c - bath_c).abs() < 1.0, "{skin_c} in {bath_c}");
        let answer = client.around("reference skin");
        let shown_c: f64 = answer.strip_prefix("ok ").and_then(|c| c.parse().ok()).expect(&answer);
        assert!((shown_c - bath_c).abs() < 0.01, "{shown_c} in {bath_c}");
    }
    for force_n in [2.0, 0.0] {
        assert_eq!(client.around(&format!("force {force_n}")), "ok");
        let read_n = client.telemetry(500, FORCE);
        assert!((read_n - force_n).abs() < 0.3, "{read_n} of {force_n}");
    }
}

#[test]
fn a_wrong_line_to_the_surroundings_is_answered_with_what_is_allowed() {
    let served = Served::new();
    let mut client = served.connect();
    for (line, answer) in [
        ("", "err ''; known: reference SENSOR"),
        ("fly", "err 'fly'; known: reference SENSOR"),
        ("reference nose", "err unknown sensor 'nose'; known: display"),
        ("bath display 30", "err no bath for 'display'; known: sink"),
        ("bath skin hot", "err bath of 'hot'; 0 to 60 C"),
        ("force 41", "err force of '41'; 0 to 40 N"),
        ("wait 0 0", "err time in 'wait 0 0'; 1 to 60000 ms"),
    ] {
        let answered = client.around(line);
        assert!(answered.starts_with(answer), "{line}: {answered}");
    }
    let long = "x".repeat(1000);
    assert!(client.around(&long).starts_with("err 'xxx"));
}
