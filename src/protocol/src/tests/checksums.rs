//! Checksums at the ends of lines.

use core::fmt::Display;
use std::format;
use std::string::{String, ToString};

use proptest::prelude::*;
use thermal_device::Device;
use thermal_settings::Settings;

use crate::{ANSWER_MAX_BYTES, CommandHandler, OutgoingLine, line_checksum};

/// A device with its protocol.
struct Line<const FINGERS: usize> {
    device: Device<FINGERS>,
    handler: CommandHandler<FINGERS>,
}

impl<const FINGERS: usize> Line<FINGERS> {
    fn new() -> Self {
        let settings = Settings::default();
        Self { device: Device::new(&settings), handler: CommandHandler::new(settings) }
    }

    fn send(&mut self, line: &str) -> String {
        let answer =
            self.handler.answer(line, |finger, command| self.device.execute(finger, command));
        match answer {
            Ok(reply) => self.written(&reply),
            Err(error) => self.written(&error),
        }
    }

    /// What is sent to the host, without the line feed.
    fn written(&self, content: &dyn Display) -> String {
        let mut line = OutgoingLine::new();
        self.handler.write_line(&mut line, content);
        let (end, text) = line.split_last().expect("a line");
        assert_eq!(*end, b'\n');
        String::from_utf8(text.to_vec()).expect("ASCII")
    }
}

/// The sentence that Wikipedia shows in its article on NMEA 0183; the `$` before it does not count.
#[test]
fn the_checksum_is_that_of_nmea_0183() {
    let sentence = "GPGGA,092750.000,5321.6802,N,00630.3372,W,1,8,1.03,61.7,M,55.2,M,,";
    assert_eq!(line_checksum(sentence.as_bytes()), 0x76);
}

// The checksums of the lines below are what Python prints:
// '%02X' % functools.reduce(operator.xor, b'checksum on', 0)
#[test]
fn every_line_to_the_host_has_a_checksum_from_the_answer_to_on_until_the_answer_to_off() {
    let mut line = Line::<5>::new();
    let telemetry = "T 5 off - 24.0000";
    for _ in 0..2 {
        assert_eq!(line.written(&telemetry), telemetry);
        assert_eq!(line.send("stream 20"), "ok");
        assert_eq!(line.send("checksum on"), "ok*04");
        assert_eq!(line.send("checksum on*2C"), "ok*04");
        assert_eq!(line.send("stream 20*3e"), "ok*04");
        assert_eq!(
            line.send("stream 20"),
            "err checksum missing, the line has 3E; send the line again with it*74"
        );
        assert_eq!(line.send("@2 abort*38"), "@2 ok*56");
        assert_eq!(line.send("law x*22"), "err unknown law 'x'; known: pi-10hz pi model*0C");
        assert_eq!(line.written(&telemetry), "T 5 off - 24.0000*0B");
        assert_eq!(line.send("checksum off*42"), "ok");
    }
}

#[test]
fn abort_is_executed_without_a_checksum_and_nothing_else() {
    let mut line = Line::<5>::new();
    assert_eq!(line.send("checksum on"), "ok*04");
    for (sent, answer) in [
        ("abort", "ok"),
        ("@2 abort", "@2 ok"),
        (" abort ", "ok"),
        ("@2  abort", "@2 ok"),
        ("abort now", "err checksum missing"),
        ("aborts", "err checksum missing"),
        ("@7 abort", "err checksum missing"),
        ("abort*00", "err checksum 00 is wrong"),
        ("arm", "err checksum missing"),
    ] {
        let received = line.send(sent);
        assert!(received.starts_with(answer), "{sent}: {received}");
        assert_eq!(received.as_bytes()[received.len() - 3], b'*');
    }
}

#[test]
fn a_line_with_a_wrong_checksum_is_not_executed() {
    let mut line = Line::<1>::new();
    assert_eq!(line.send("law pi*43"), "ok");
    for (sent, answer) in [
        ("law pi-10hz*43", "err checksum 43 is wrong, the line has 7D; send the line again"),
        ("law*43", "err checksum 43 is wrong, the line has 7A; send the line again"),
        ("law model*3", "err checksum '3' is not 2 hexadecimal digits"),
        ("law model*+5", "err checksum '+5' is not 2 hexadecimal digits"),
        ("law model*035", "err checksum '035' is not 2 hexadecimal digits"),
        ("law model*35 ", "err checksum '35 ' is not 2 hexadecimal digits"),
        ("law model*", "err checksum '' is not 2 hexadecimal digits"),
    ] {
        assert_eq!(line.send(sent), answer);
        assert_eq!(line.send("law"), "ok law=pi");
    }
}

#[test]
fn the_refusal_of_a_damaged_line_has_the_address_that_has_arrived() {
    let mut line = Line::<5>::new();
    for (sent, answer) in [
        ("@2 law*00", "@2 err checksum 00 is wrong, the line has 28; send the line again"),
        ("@2 law*4", "@2 err checksum '4' is not 2 hexadecimal digits"),
        // Damaged addresses: of a finger that the device does not have, and none.
        ("@7 law*28", "err checksum 28 is wrong, the line has 2D; send the line again"),
        ("R2 law*28", "err checksum 28 is wrong, the line has 3A; send the line again"),
        ("law*28", "err checksum 28 is wrong, the line has 7A; send the line again"),
    ] {
        assert_eq!(line.send(sent), answer);
    }
    assert_eq!(line.send("@2 law*28"), "@2 ok law=model");
}

#[test]
fn checksums_are_switched_for_the_whole_device_by_on_and_off() {
    let mut line = Line::<5>::new();
    for (sent, answer) in [
        ("checksum", "err switch missing; known: on off"),
        ("checksum 1", "err unknown switch '1'; known: on off"),
        ("checksum on now", "err unexpected 'now' after the command"),
        ("@2 checksum on", "@2 err checksum is for all fingers at once"),
        ("id*0D", "ok thermal-display 0.2.0 fingers=5"),
    ] {
        assert!(line.send(sent).starts_with(answer), "{}", line.send(sent));
    }
}

#[test]
fn the_longest_answer_fits_with_address_and_checksum() {
    let mut line = Line::<1>::new();
    line.send("checksum on");
    let text = format!("@0 {}", "x".repeat(ANSWER_MAX_BYTES));
    let written = line.written(&text);
    assert_eq!(written.strip_prefix(&text).map(str::len), Some(3));
}

proptest! {
    #[test]
    fn a_line_with_one_damaged_character_is_refused(
        line in "[a-z][a-z0-9 .-]{1,60}",
        place in 0usize..60,
        damage in 1u8..16,
    ) {
        let checksum = line_checksum(line.as_bytes());
        let damaged: String = line.bytes().zip(0..).map(|(byte, i)| {
            // Of the damaged characters, only those count that a line may contain.
            char::from(if i == place % line.len() { byte ^ damage } else { byte })
        }).collect();
        prop_assume!(damaged.bytes().all(|byte| matches!(byte, b' '..=b'~') && byte != b'*'));
        let answer = Line::<1>::new().send(&format!("{damaged}*{checksum:02X}"));
        let expected = "err checksum ".to_string();
        prop_assert!(answer.starts_with(&expected), "{}", answer);
    }
}
