//! Answers of the release image over the serial line.

use image_tests::on_image;
use system_tests::{between, forces, host, scene};

/// Sends lines during a contact and returns the answers in their order; asserts that the contact goes on.
fn answers(lines: &[&str], more: &str) -> Vec<String> {
    let timed: Vec<_> =
        lines.iter().enumerate().map(|(i, line)| (1.0 + 0.01 * i as f64, *line)).collect();
    let scene = scene("abs", 3.0, "", &(forces(&[(0.5, 2.0)]) + &host(&timed) + more));
    let outcome = on_image(&scene);
    for row in between(&outcome, 2.5, 3.0) {
        assert_eq!(row.device.as_ref().map(|device| device.state.name()), Some("contact"));
    }
    let after_set_up = outcome.answers.iter().filter(|(t_s, _)| *t_s >= 1.0);
    after_set_up.map(|(_, line)| line.clone()).collect()
}

#[test]
fn id_and_state_are_answered() {
    let answers = answers(&["id", "state"], "");
    assert!(answers[0].starts_with("ok thermal-display "), "{answers:?}");
    assert!(
        answers[1].starts_with("ok state=contact fault=- material=abs object_c=24.00"),
        "{answers:?}"
    );
    assert_eq!(answers.len(), 2);
}

#[test]
fn each_wrong_line_is_answered_with_its_error_and_the_contact_goes_on() {
    let long = "x".repeat(300);
    let cases = [
        ("frobnicate", "err unknown command 'frobnicate'; known: id board checksum"),
        ("material gold", "err unknown material 'gold'; known: copper bronze"),
        ("mode loud", "err unknown mode 'loud'; known: contact semi-infinite"),
        (
            "object hot",
            "err object temperature 'hot' is not a decimal number; -20 to 60 C; or room",
        ),
        ("object 99", "err object temperature '99' out of range; -20 to 60 C"),
        ("stream", "err interval missing; 0 to 60000 ms"),
        ("id id", "err unexpected 'id' after the command"),
        ("start", "err already started"),
        ("clear", "err no fault to clear"),
        (long.as_str(), "err line too long; at most 96 bytes"),
        ("tür", "err byte 0xc3 is not printable ASCII"),
    ];
    let answers = answers(&cases.map(|(line, _)| line), "");
    assert_eq!(answers.len(), cases.len(), "{answers:?}");
    for ((line, expected), answer) in cases.iter().zip(&answers) {
        assert!(answer.starts_with(expected), "{line}: {answer}");
    }
}

#[test]
fn binary_garbage_is_refused_and_the_next_line_is_answered() {
    let garbage =
        "[[fault]]\nkind = \"host-garbage\"\nt_s = 1.5\n[[host]]\nt_s = 1.6\nline = \"id\"\n";
    let answers = answers(&[], garbage);
    assert!(answers.len() >= 2, "{answers:?}");
    assert!(answers[0].starts_with("err byte 0x00 is not printable ASCII"), "{answers:?}");
    assert!(
        answers.last().is_some_and(|line| line.starts_with("ok thermal-display")),
        "{answers:?}"
    );
}
