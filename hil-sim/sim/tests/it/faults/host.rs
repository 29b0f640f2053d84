//! What the host sends, and when.

use thermal_sim::host::Host;

use super::scene;

/// Settling time of a scene, ms.
const ZERO_MS: u64 = 8000;
/// 1 Mbaud, ten bits a byte.
const BYTES_A_MS: usize = 100;

/// What leaves in each millisecond of a scene's 20 s, set-up included.
fn sent(tables: &str) -> Vec<Vec<u8>> {
    let mut host = Host::new(&scene(tables), &[], 1, 10);
    let mut send = |half_ms| host.send(half_ms).map_or(Vec::new(), <[u8]>::to_vec);
    (0..ZERO_MS + 20_000)
        .map(|ms| [send(2 * ms), send(2 * ms + 1)].concat())
        .collect()
}

/// Times, ms after time zero, at which something like it leaves.
fn times(sent: &[Vec<u8>], what: impl Fn(&[u8]) -> bool) -> Vec<i64> {
    let all = (0..)
        .zip(sent)
        .filter(|(_, bytes)| !bytes.is_empty() && what(bytes));
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
    let since: Vec<_> = times(&back, |_| true)
        .into_iter()
        .filter(|ms| *ms >= 3000)
        .collect();
    assert_eq!(since[..3], [7480, 7980, 8480]);
}

#[test]
fn flood_is_what_the_line_carries_and_ends() {
    let sent = sent(&fault("host-flood", "t_s = 2\nuntil_s = 4"));
    let many = times(&sent, |bytes| bytes.len() > 10);
    let in_scene: Vec<_> = many.into_iter().filter(|ms| *ms >= 0).collect();
    assert_eq!(
        (in_scene.first(), in_scene.last()),
        (Some(&2000), Some(&3999))
    );
    assert_eq!(in_scene.len(), 2000);
    let second = &sent[ZERO_MS as usize + 2000..ZERO_MS as usize + 4000];
    let most = second.iter().map(Vec::len).max();
    let mean = second.iter().map(Vec::len).sum::<usize>() / 2000;
    assert!(
        (90..=BYTES_A_MS).contains(&mean),
        "{mean} of {BYTES_A_MS} bytes a millisecond"
    );
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
