//! A person who mistypes, asks and ends.

use std::io::{self, Cursor};
use std::time::Duration;

use thermal_client::client::Client;
use thermal_client::link::{Link, LinkError, ReceivedLine};
use thermal_lab::bench_operator::{BenchOperator, lines};
use thermal_lab::bring_up::{Bench, BenchError, Measurement, Terminal, Unit};

/// A line to nobody, whose time passes.
struct NoDevice(Duration);

impl Link for NoDevice {
    fn send(&mut self, _bytes: &[u8]) -> Result<(), LinkError> {
        Ok(())
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        self.0 += timeout;
        Ok(None)
    }

    fn now(&self) -> Duration {
        self.0
    }
}

const PULL_DOWN: Measurement = Measurement {
    what: "bridge enable, PB10 (D6)",
    point: "ohm enable",
    how: "ohm meter to ground",
    unit: Unit::Ohm,
    allowed: (4465.0, 4935.0),
    basis: "4.7 kΩ, 1 %",
};

/// What the procedure gets from a person who types these lines, and what the screen shows.
fn typed(text: &'static str) -> (Result<f64, BenchError>, String) {
    let mut screen = Vec::new();
    let person = BenchOperator::new(None, lines(Cursor::new(text)), &mut screen);
    let mut client = Client::new(NoDevice(Duration::ZERO));
    let value = Terminal::new(person).read(&mut client, &PULL_DOWN);
    (value, String::from_utf8_lossy(&screen).into_owned())
}

#[test]
fn an_expected_value_is_taken_at_once() {
    let (value, screen) = typed("4.68 kohm\n");
    assert_eq!(value, Ok(4680.0));
    assert!(screen.contains("bridge enable, PB10 (D6): ohm meter to ground"), "{screen}");
}

#[test]
fn a_wrong_unit_and_no_number_are_asked_for_again() {
    let (value, screen) = typed("4.68 V\nhigh\n\n4.68k\n");
    assert_eq!(value, Ok(4680.0));
    assert!(screen.contains("'4.68 V' has the unit 'V'; needed is Ω"), "{screen}");
    assert!(screen.contains("'high' is no number"), "{screen}");
}

#[test]
fn a_slip_of_a_prefix_is_doubted_and_mended() {
    let (value, screen) = typed("4.68\n4.68k\n");
    assert_eq!(value, Ok(4680.0));
    assert!(screen.contains("4.68 Ω is not expected"), "{screen}");
}

#[test]
fn an_unexpected_value_counts_if_it_is_typed_again() {
    assert_eq!(typed("open\nopen\n").0, Ok(f64::INFINITY));
    assert_eq!(typed("47k\n46.9k\n").0, Ok(46_900.0));
}

#[test]
fn a_question_mark_says_what_is_expected_and_why() {
    let (value, screen) = typed("?\n4.7k\n");
    assert_eq!(value, Ok(4700.0));
    assert!(screen.contains("expected: 4.465 kΩ to 4.935 kΩ (4.7 kΩ, 1 %)"), "{screen}");
}

#[test]
fn abort_and_the_end_of_the_input_end_the_procedure() {
    assert_eq!(typed("4.68 V\nABORT\n").0, Err(BenchError::Aborted));
    let (value, _) = typed("");
    assert!(matches!(value, Err(BenchError::Failed(_))), "{value:?}");
}

#[test]
fn a_reader_that_fails_is_reported() {
    struct Broken;
    impl io::Read for Broken {
        fn read(&mut self, _buffer: &mut [u8]) -> io::Result<usize> {
            Err(io::Error::other("unplugged"))
        }
    }
    let mut screen = Vec::new();
    let person = BenchOperator::new(None, lines(io::BufReader::new(Broken)), &mut screen);
    let mut client = Client::new(NoDevice(Duration::ZERO));
    let value = Terminal::new(person).read(&mut client, &PULL_DOWN);
    assert_eq!(value, Err(BenchError::Failed("unplugged".into())));
}
