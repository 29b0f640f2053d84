//! What the host sends, and when.

use thermal_sim::engine::DeviceReset;
use thermal_sim::host::Host;
use thermal_sim::metrics::{Figures, figures};
use thermal_sim::processor::ResetCause;
use thermal_sim::report::table;

use super::{ran, scene};

/// Settling time of a scene, ms.
const ZERO_MS: u64 = 8000;
/// 1 Mbaud, ten bits a byte.
const BYTES_A_MS: usize = 100;

/// What leaves in each millisecond of a scene's 20 s, set-up included.
fn sent(tables: &str) -> Vec<Vec<u8>> {
    let mut host = Host::new(&scene(tables), &[], 1, 10);
    let mut send = |half_ms| host.send(half_ms).map_or(Vec::new(), <[u8]>::to_vec);
    (0..ZERO_MS + 20_000).map(|ms| [send(2 * ms), send(2 * ms + 1)].concat()).collect()
}

/// Times, ms after time zero, at which something like it leaves.
fn times(sent: &[Vec<u8>], what: impl Fn(&[u8]) -> bool) -> Vec<i64> {
    let all = (0..).zip(sent).filter(|(_, bytes)| !bytes.is_empty() && what(bytes));
    all.map(|(ms, _): (i64, _)| ms - ZERO_MS as i64).collect()
}

fn fault(kind: &str, times: &str) -> String {
    format!("[[fault]]\nkind = \"{kind}\"\n{times}\n")
}

#[test]
fn blank_lines_every_half_second_say_that_the_host_is_alive() {
    let sent = sent("");
    let stream_ms = times(&sent, |bytes| bytes.starts_with(b"stream"));
    assert_eq!(stream_ms, [-20]);
    let blank_ms = times(&sent, |bytes| bytes == b"\n");
    assert_eq!(blank_ms.len(), 40);
    for (before, after) in stream_ms.iter().chain(&blank_ms).zip(&blank_ms) {
        assert_eq!(after - before, 500);
    }
}

#[test]
fn line_of_the_scene_does_not_wait_for_a_blank_one() {
    let sent = sent("[[host]]\nt_s = 0.48\nline = \"state\"\n");
    assert_eq!(times(&sent, |bytes| bytes == b"state\n"), [480]);
    assert_eq!(times(&sent, |bytes| bytes == b"\n")[..2], [483, 980]);
}

#[test]
fn silent_host_sends_nothing_until_it_is_back() {
    let tables = "[[host]]\nt_s = 5\nline = \"state\"\n".to_owned();
    let gone = sent(&(tables.clone() + &fault("host-silent", "t_s = 3")));
    assert_eq!(times(&gone, |_| true).last(), Some(&2980));
    let back = sent(&(tables + &fault("host-silent", "t_s = 3\nuntil_s = 7")));
    let since: Vec<_> = times(&back, |_| true).into_iter().filter(|ms| *ms >= 3000).collect();
    assert_eq!(since[..3], [7480, 7980, 8480]);
}

#[test]
fn flood_is_what_the_line_carries_and_ends() {
    let sent = sent(&fault("host-flood", "t_s = 2\nuntil_s = 4"));
    let many = times(&sent, |bytes| bytes.len() > 10);
    let in_scene: Vec<_> = many.into_iter().filter(|ms| *ms >= 0).collect();
    assert_eq!((in_scene.first(), in_scene.last()), (Some(&2000), Some(&3999)));
    assert_eq!(in_scene.len(), 2000);
    let second = &sent[ZERO_MS as usize + 2000..ZERO_MS as usize + 4000];
    let most = second.iter().map(Vec::len).max();
    let mean = second.iter().map(Vec::len).sum::<usize>() / 2000;
    assert!((90..=BYTES_A_MS).contains(&mean), "{mean} of {BYTES_A_MS} bytes a millisecond");
    assert!(most <= Some(BYTES_A_MS), "{most:?}");
    for line in second.concat().split_inclusive(|byte| *byte == b'\n') {
        assert!(line == b"state\n" || line == b"\n", "{line:?}");
    }
}

#[test]
fn garbage_comes_once() {
    let sent = sent(&fault("host-garbage", "t_s = 2"));
    assert_eq!(times(&sent, |bytes| bytes.contains(&0xff)), [2000]);
}

/// Lines of the scene, and the lines and answers of those that the device refuses.
#[test]
fn refused_lines_stand_in_the_results_with_their_answers() {
    let lines = |lines: &[(f64, &str)]| -> String {
        lines
            .iter()
            .map(|(t_s, line)| format!("[[host]]\nt_s = {t_s}\nline = {line:?}\n"))
            .collect()
    };
    let asked = lines(&[(1.0, "state"), (1.0, "object slap"), (2.0, "id"), (3.0, "mode x")]);
    let refused = |tables: &str| -> (Vec<(Option<String>, String)>, Figures) {
        let (scene, outcome) = ran(tables);
        let figures = figures(&scene, &outcome);
        let lines = figures.refused_lines.iter();
        let lines = lines.map(|refused| (refused.line.clone(), refused.answer.clone()));
        (lines.collect(), figures)
    };
    let slap = "err object temperature 'slap' is not a decimal number; -20 to 60 C; or room half-space slab";
    let mode = "err unknown mode 'x'; known: contact semi-infinite";
    let of = |line: &str, answer: &str| (Some(line.to_owned()), answer.to_owned());
    let expected = [of("object slap", slap), of("mode x", mode)];
    let (found, figures) = refused(&asked);
    assert_eq!(found, expected);
    let text = table(&figures);
    assert!(text.contains("host lines refused   2 of 4\n"), "{text}");
    assert!(text.contains(&format!(" \"object slap\": {slap}\n")), "{text}");
    assert!(!table(&refused("").1).contains("refused"));
    // A garbage line is refused as what was sent.
    let (found, _) = refused(&format!("{asked}{}", fault("host-garbage", "t_s = 1.5")));
    assert_eq!((&found[0], found.last()), (&expected[0], expected.last()));
    assert_eq!(found[1].0.as_deref(), Some("\0\u{fffd}\u{fffd}\u{fffd}arm\u{1}"));
}

/// A device that restarts answers neither the lines before nor those after as if they were others.
#[test]
fn answers_belong_to_the_lines_that_a_reset_has_not_lost() {
    let (_, mut outcome) = ran("[[host]]\nt_s = 1\nline = \"save\"\n");
    let at = |t_s, text: &str| (t_s, text.to_owned());
    let reset = |t_s| DeviceReset { t_s, cause: ResetCause::Software };
    outcome.sent =
        vec![at(0.1, "id"), at(0.3, "lost"), at(0.4, "state"), at(0.6, "save"), at(0.9, "arm")];
    outcome.resets = vec![reset(0.3), reset(0.61)];
    outcome.answers = vec![
        at(0.101, "one"),
        at(0.35, "none"),
        at(0.401, "two"),
        at(0.7, "three"),
        at(0.901, "four"),
    ];
    let exchanges = outcome.exchanges();
    let lines: Vec<_> =
        (exchanges.iter()).map(|exchange| (exchange.line, exchange.answer)).collect();
    let expected = [
        (Some("id"), "one"),
        (None, "none"),
        (Some("state"), "two"),
        (Some("save"), "three"),
        (Some("arm"), "four"),
    ];
    assert_eq!(lines, expected);
}
