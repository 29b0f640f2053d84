//! A device on the line of another program. Nothing here depends on how fast the machine is: the device's time passes as fast
//! as it goes.

use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use thermal_sim::World;
use thermal_sim::engine::{Engine, NativeEngine};
use thermal_sim::run::run;
use thermal_sim::scene::Scene;
use thermal_sim::serve::{
    ClientLine, Clock, OneFinger, OutgoingBytes, ServedDevice, Speed, TcpLine, read_scene, serve,
};

/// A finger lands when the device has been on for 10 s; 2 s later a thermistor breaks.
const LANDING: &str = "\
duration_s = 20.0
skin_c = 34.0
room_c = 24.0
seed = 1
[object]
material = \"copper\"
[[force]]
t_s = 2.0
force_n = 2.0
[[fault]]
kind = \"thermistor-open\"
t_s = 4.0
value = 0.0
";

/// Lines of a client with their times, ms: a contact and its end by a fault.
const LINES: [(u64, &str); 10] = [
    (0, "id\n"),
    (10, "stream 7\nmaterial copper\n"),
    (20, "arm\n"),
    (900, "\n"),
    (2600, "\nfinger mean\n"),
    (4000, "start\n"),
    (5900, "\n"),
    (7800, "\nnonsense\n"),
    (9700, "\n"),
    (11_400, "\n"),
];
const END_MS: u64 = 12_300;

fn landing() -> Scene {
    Scene::parse(LANDING, Path::new("landing")).expect("a scene")
}

fn native(scene: &Scene) -> NativeEngine {
    NativeEngine::new(World::new(scene).expect("a world"))
}

/// A line whose client sends lines at their times, and reads everything.
struct Script<'a> {
    ms: u64,
    waiting: Vec<u8>,
    received: Vec<u8>,
    stop: &'a AtomicBool,
}

impl ClientLine for Script<'_> {
    fn poll(&mut self) -> Option<u64> {
        let due = LINES.iter().filter(|(ms, _)| *ms == self.ms);
        self.waiting.extend(due.flat_map(|(_, line)| line.bytes()));
        self.ms += 1;
        self.stop.store(self.ms == END_MS, Ordering::Relaxed);
        Some(1)
    }

    fn read(&mut self, limit: usize) -> Vec<u8> {
        self.waiting.drain(..limit.min(self.waiting.len())).collect()
    }

    fn write(&mut self, bytes: &[u8], _patience: Duration) -> usize {
        self.received.extend(bytes);
        0
    }
}

#[test]
fn a_client_receives_what_the_engine_sends_when_it_is_given_the_same_lines() {
    let scene = landing();
    let stop = AtomicBool::new(false);
    let mut line = Script { ms: 0, waiting: Vec::new(), received: Vec::new(), stop: &stop };
    let mut clock = Clock::start(Speed::Max);
    // The clock of a client that is always there.
    clock.wait_for_next_ms(true);
    let mut device = OneFinger::new(native(&scene), scene.clone());
    serve(&mut device, &mut line, &mut clock, &stop).expect("a device that runs");

    let (mut engine, mut expected) = (native(&scene), Vec::new());
    for ms in 0..END_MS {
        let lines = LINES.iter().filter(|(at, _)| *at == ms);
        lines.for_each(|(_, line)| engine.send(line.as_bytes()));
        let t_s = ms as f64 / 1e3 - 8.0;
        let faults = scene.faults.iter().filter_map(|fault| fault.at(t_s));
        let force_n = if t_s < 2.0 { 0.0 } else { 2.0 };
        engine.world().set_force_and_faults(force_n, faults);
        let legs = engine.legs();
        engine.world().step(legs);
        for _half in 0..2 {
            let Ok(()) = engine.run_half_ms();
        }
        engine.receive(&mut expected);
    }
    let text = String::from_utf8(line.received.clone()).expect("ASCII");
    for part in [
        "ok thermal-display 0.2.0 fingers=1 ",
        " preset ",
        " contact ",
        "err unknown command 'nonsense'",
        " tripped ",
        " display-open\n",
    ] {
        assert!(text.contains(part), "{part}");
    }
    assert_eq!(line.received, expected);
}

/// A scene's edges reach a served device as they reach one in a run: to the microsecond.
#[test]
fn the_trigger_input_of_a_served_device_has_the_edges_of_the_scene() {
    let text = "duration_s = 1\nskin_c = 34\nroom_c = 24\n[device]\ncommissioned = false\n[object]\nmaterial = \"copper\"\n\
                [[trigger]]\nt_s = 0.1004\n[[trigger]]\nt_s = 0.2009\n[[host]]\nt_s = 0\nline = \"events on\"\n";
    let scene = Scene::parse(text, "trigger".as_ref()).expect("a scene");
    let mut engine = native(&scene);
    let outcome = run(&scene, &mut engine, |_| ()).expect("the scene runs");
    let expected: Vec<_> = outcome.events.iter().map(|(_, line)| line.clone()).collect();
    assert_eq!(expected.iter().filter(|line| line.ends_with(" trigger")).count(), 2);

    let mut device = OneFinger::new(native(&scene), scene.clone());
    device.send(b"events on\n");
    let mut received = Vec::new();
    for _ in 0..8_500 {
        device.run_1_ms().expect("a device that runs");
        device.receive(&mut received);
    }
    let text = String::from_utf8(received).expect("ASCII");
    let events: Vec<_> = text.lines().filter(|line| line.starts_with("E ")).collect();
    assert_eq!(events, expected);
}

/// A device that counts its milliseconds.
struct Counted {
    device: OneFinger<NativeEngine>,
    ms: Arc<AtomicU64>,
}

impl ServedDevice for Counted {
    type Stop = <OneFinger<NativeEngine> as ServedDevice>::Stop;

    fn send(&mut self, bytes: &[u8]) {
        assert!(bytes.len() <= 100, "more than the line carries in 1 ms");
        self.device.send(bytes);
    }

    fn run_1_ms(&mut self) -> Result<(), Self::Stop> {
        self.ms.fetch_add(1, Ordering::Relaxed);
        self.device.run_1_ms()
    }

    fn receive(&mut self, into: &mut Vec<u8>) {
        self.device.receive(into);
    }
}

/// A device that is served on a TCP port until the test ends.
struct Served {
    address: SocketAddr,
    ms: Arc<AtomicU64>,
    stop: Arc<AtomicBool>,
    server: Option<JoinHandle<()>>,
}

impl Served {
    fn new() -> Self {
        let mut line = TcpLine::listen("127.0.0.1:0").expect("a free port");
        let address = line.address().expect("an address");
        let (ms, stop) = (Arc::new(AtomicU64::new(0)), Arc::new(AtomicBool::new(false)));
        let scene = read_scene(None).expect("a scene");
        let mut device =
            Counted { device: OneFinger::new(native(&scene), scene), ms: Arc::clone(&ms) };
        let stopped = Arc::clone(&stop);
        let server = thread::spawn(move || {
            let mut clock = Clock::start(Speed::Max);
            serve(&mut device, &mut line, &mut clock, &stopped).expect("a device that runs");
        });
        Self { address, ms, stop, server: Some(server) }
    }

    fn connect(&self) -> Client {
        Client(BufReader::new(TcpStream::connect(self.address).expect("a connection")))
    }

    /// Waits until the device has run for this many milliseconds more.
    fn run(&self, ms: u64) {
        let end = self.ms.load(Ordering::Relaxed) + ms;
        while self.ms.load(Ordering::Relaxed) < end {
            thread::yield_now();
        }
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        let ended = self.server.take().map(JoinHandle::join);
        assert!(thread::panicking() || matches!(ended, Some(Ok(()))));
    }
}

struct Client(BufReader<TcpStream>);

impl Client {
    fn send(&mut self, bytes: &[u8]) {
        self.0.get_mut().write_all(bytes).expect("a connection");
    }

    fn line(&mut self) -> String {
        let mut line = String::new();
        self.0.read_line(&mut line).expect("a connection");
        line.trim_end().into()
    }

    /// The next line that is no telemetry.
    fn answer(&mut self) -> String {
        loop {
            let line = self.line();
            if !line.starts_with("T ") {
                return line;
            }
        }
    }

    fn query(&mut self, line: &str) -> String {
        self.send(format!("{line}\n").as_bytes());
        self.answer()
    }
}

const IDENTITY: &str = "ok thermal-display 0.2.0 fingers=1 ";

#[test]
fn a_device_whose_client_vanishes_trips_with_host_silent() {
    let served = Served::new();
    let mut client = served.connect();
    assert_eq!(client.query("arm"), "ok");
    while !client.query("state").starts_with("ok state=armed ") {}
    assert_eq!(client.query("stream 10"), "ok");
    drop(client);
    // The next client only looks on.
    let mut client = served.connect();
    let mut lines = 0;
    while !client.line().ends_with(" host-silent") {
        lines += 1;
        assert!(lines < 2000, "the device goes on without a client");
    }
}

#[test]
fn garbage_is_answered_and_the_next_line_is_executed() {
    let served = Served::new();
    let mut client = served.connect();
    let garbage: Vec<u8> = (0..=255).chain(b"\x00\n".iter().copied()).collect();
    client.send(&garbage);
    client.send(&[b'x'; 5000]);
    client.send(b"\n");
    let answers: Vec<_> = (0..4).map(|_| client.answer()).collect();
    for (answer, expected) in answers.iter().zip([
        "err byte 0x00 is not printable ASCII",
        "err byte 0x0b is not printable ASCII",
        "err byte 0x0e is not printable ASCII",
        "err line too long; at most 96 bytes",
    ]) {
        assert!(answer.starts_with(expected), "{answers:?}");
    }
    assert!(client.query("id").starts_with(IDENTITY));
}

#[test]
fn a_client_that_floods_the_line_is_held_to_its_baud_rate_and_the_next_one_is_answered() {
    let served = Served::new();
    let client = served.connect();
    let mut reading = client.0.get_ref().try_clone().expect("a second handle");
    let mut flooding = client.0.get_ref().try_clone().expect("a third handle");
    let before = served.ms.load(Ordering::Relaxed);
    // Ends with an error when the client vanishes.
    let flood =
        thread::spawn(move || while flooding.write_all(&b"state\n".repeat(1000)).is_ok() {});
    let mut received = [0; 100_000];
    reading.read_exact(&mut received).expect("answers");
    let answers = received.iter().filter(|byte| **byte == b'\n').count();
    // A line of six bytes takes 0.06 ms; `Counted` asserts that no more bytes arrive.
    let elapsed = served.ms.load(Ordering::Relaxed) - before;
    assert!(elapsed as usize * 100 / 6 + 800 >= answers, "{answers} answers in {elapsed} ms");
    reading.shutdown(std::net::Shutdown::Both).expect("a connection");
    drop((client, reading));
    flood.join().expect("a flood that ends");
    let mut next = served.connect();
    while next.query("id").starts_with("err busy") {
        next = served.connect();
    }
    assert!(next.query("id").starts_with("ok "));
}

#[test]
fn a_client_that_does_not_read_holds_up_nobody_and_loses_what_it_does_not_take() {
    let served = Served::new();
    let mut client = served.connect();
    client.send(b"stream 1\n");
    // 15 MB, more than the operating system keeps for a connection.
    served.run(150_000);
    let refused = served.connect().line();
    assert!(refused.starts_with("err busy: "), "{refused}");
    // What it reads now begins with what was kept, and ends with what the device sends now.
    let now = served.ms.load(Ordering::Relaxed);
    let mut ticks = Vec::new();
    assert_eq!(client.line(), "ok");
    loop {
        let line = client.line();
        let tick = line.strip_prefix("T ").and_then(|rest| rest.split(' ').next());
        // A line may have lost its beginning or its end.
        ticks.extend(tick.and_then(|tick| tick.parse::<u64>().ok()));
        if ticks.last().is_some_and(|tick| *tick > now) {
            break;
        }
    }
    assert!(ticks.windows(2).any(|pair| pair[1] > pair[0] + 1000));
}

#[test]
fn a_second_client_is_told_so_and_may_come_when_the_first_has_gone() {
    let served = Served::new();
    let mut first = served.connect();
    assert!(first.query("id").starts_with(IDENTITY));
    let mut second = served.connect();
    second.send(b"abort\nid\n");
    let busy = second.line();
    let address = first.0.get_ref().local_addr().expect("an address");
    assert_eq!(
        busy,
        format!("err busy: the client {address} is connected, and there is one at a time")
    );
    assert_eq!(second.line(), "", "the connection has ended");
    assert!(first.query("id").starts_with(IDENTITY));
    // A script that ends with a line and another that begins at once.
    for _ in 0..20 {
        first.send(b"state\n");
        drop(first);
        first = served.connect();
        assert!(first.query("id").starts_with("ok "));
    }
}

#[test]
fn a_client_that_has_closed_its_writing_side_gets_its_answers_and_holds_up_no_other_one() {
    let served = Served::new();
    for _ in 0..20 {
        let mut client = served.connect();
        client.send(b"id\nlaw\n");
        let shut = client.0.get_ref().shutdown(std::net::Shutdown::Write);
        shut.expect("a connection");
        let answers = [client.answer(), client.answer()];
        assert!(answers[0].starts_with(IDENTITY), "{answers:?}");
        assert_eq!(answers[1], "ok law=model");
        // Its connection is open; the next client is not refused.
        assert!(served.connect().query("id").starts_with(IDENTITY));
        assert_eq!(client.line(), "", "the connection has ended");
    }
}

#[test]
fn only_addresses_of_this_machine_are_listened_on() {
    let refusal = |address| match TcpLine::listen(address) {
        Ok(line) => panic!("{line:?}"),
        Err(error) => error.to_string(),
    };
    for address in ["0.0.0.0:0", "192.168.7.8:4000", "[::]:0", "[2001:db8::1]:9", "8.8.8.8:53"] {
        assert!(
            refusal(address).starts_with(&format!(
                "{address} is not a loopback address, and whoever reaches the line drives the device; allowed are 127.0.0.1:PORT"
            )),
            "{}",
            refusal(address)
        );
    }
    for malformed in ["", "127.0.0.1", "127.0.0.1:65536", "example.org:80", ":5"] {
        assert!(
            refusal(malformed).starts_with(&format!("'{malformed}' is no address; allowed is"))
        );
    }
    let line = TcpLine::listen("localhost:0").expect("a free port");
    let address = line.address().expect("an address");
    assert!(address.ip().is_loopback() && address.port() != 0);
    assert!(refusal(&address.to_string()).starts_with(&format!("cannot listen on {address}: ")));
}

#[test]
fn at_full_speed_time_stands_still_before_the_first_client_and_10_s_after_the_last() {
    let mut clock = Clock::start(Speed::Max);
    assert!(!clock.wait_for_next_ms(false));
    for _ in 0..3 {
        assert!(clock.wait_for_next_ms(true));
    }
    let run_on = (0..20_000).take_while(|_| clock.wait_for_next_ms(false));
    assert_eq!(run_on.count(), 10_000);
    assert!(clock.wait_for_next_ms(true));
}

#[test]
fn what_a_client_does_not_take_waits_in_order_as_far_as_there_is_room_and_is_lost_beyond() {
    /// Takes this many bytes, three at a time, and is then full.
    struct Slow(usize, Vec<u8>);
    impl Write for Slow {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            let taken = bytes.len().min(self.0).min(3);
            if taken == 0 {
                return Err(ErrorKind::WouldBlock.into());
            }
            self.0 -= taken;
            self.1.extend(&bytes[..taken]);
            Ok(taken)
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let bytes: Vec<u8> = (0..70_000).map(|i| (i % 251) as u8).collect();
    let (mut outgoing, mut stream) = (OutgoingBytes::default(), Slow(100, Vec::new()));
    let mut send = |stream: &mut Slow, bytes| outgoing.send(stream, bytes, Duration::ZERO);
    // 100 are taken, and 65536 wait.
    assert_eq!(send(&mut stream, &bytes), 70_000 - 100 - 65_536);
    assert_eq!(send(&mut stream, b"lost"), 4);
    stream.0 = 70_000;
    assert_eq!(send(&mut stream, b"end"), 0);
    assert_eq!(stream.1[..65_636], bytes[..65_636]);
    assert_eq!(stream.1[65_636..], *b"end");
}
