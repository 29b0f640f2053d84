//! Lines by TCP, in real time.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use thermal_lab::client::{Client, ClientError, StationRequest};
use thermal_lab::link::{Link, LinkError, tcp};

/// A server for one client.
fn serve(serve: impl FnOnce(TcpStream) + Send + 'static) -> (SocketAddr, JoinHandle<()>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let server = thread::spawn(move || serve(listener.accept().unwrap().0));
    (address, server)
}

/// Reads until the end of a line.
fn line(stream: &mut TcpStream) -> String {
    let mut bytes = Vec::new();
    let mut byte = [0];
    while stream.read(&mut byte).unwrap() == 1 && byte[0] != b'\n' {
        bytes.push(byte[0]);
    }
    String::from_utf8(bytes).unwrap()
}

#[test]
fn an_answer_that_comes_in_parts_is_one_line() {
    let (address, server) = serve(|mut stream| {
        assert_eq!(line(&mut stream), "law");
        for part in ["T 1 off - - - - - - 0 ", "0 0 -\nok l", "aw=", "pi\r", "\n"] {
            stream.write_all(part.as_bytes()).unwrap();
            thread::sleep(Duration::from_millis(20));
        }
    });
    let mut client = Client::new(tcp(address).unwrap());
    assert_eq!(client.query("law").unwrap(), "ok law=pi");
    assert_eq!(client.next_telemetry(Duration::ZERO).unwrap().unwrap().telemetry.tick, 1);
    server.join().unwrap();
}

#[test]
fn a_link_that_vanishes_ends_a_wait_at_once() {
    let (address, server) = serve(|mut stream| {
        assert_eq!(line(&mut stream), "arm");
        stream.write_all(b"ok\nT 1 ar").unwrap();
    });
    let mut client = Client::new(tcp(address).unwrap());
    client.ask(&StationRequest::Arm).unwrap();
    server.join().unwrap();
    let began = Instant::now();
    let gone = client.wait(Duration::from_secs(30)).unwrap_err();
    assert!(matches!(gone, LinkError::Gone(_)), "{gone}");
    assert!(began.elapsed() < Duration::from_secs(5));
    let error = client.ask(&StationRequest::Abort).unwrap_err();
    assert!(matches!(error, ClientError::Link(LinkError::Gone(_))), "{error}");
}

#[test]
fn a_flood_of_garbage_neither_hides_the_answer_nor_holds_up_the_client() {
    let (address, server) = serve(|mut stream| {
        assert_eq!(line(&mut stream), "law");
        let mut garbage: Vec<u8> =
            (0..1_000_000u32).map(|i| (i.wrapping_mul(i) % 251) as u8).collect();
        garbage.push(b'\n');
        stream.write_all(&garbage).unwrap();
        stream.write_all(b"ok law=pi\n").unwrap();
    });
    let mut client = Client::new(tcp(address).unwrap());
    assert_eq!(client.query("law").unwrap(), "ok law=pi");
    assert!(client.counts().damaged > 1000);
    server.join().unwrap();
}

#[test]
fn a_silent_device_is_given_up_after_two_seconds_of_real_time() {
    let (address, server) = serve(|mut stream| {
        line(&mut stream);
        thread::sleep(Duration::from_millis(2500));
    });
    let mut client = Client::new(tcp(address).unwrap());
    let began = client.link().now();
    assert!(matches!(client.ask(&StationRequest::Arm).unwrap_err(), ClientError::TimedOut { .. }));
    let waited = client.link().now() - began;
    assert!((1.9..2.4).contains(&waited.as_secs_f64()), "{waited:?}");
    server.join().unwrap();
}
