//! When settings may be stored, and what is.

use std::format;
use std::string::ToString;

use crate::Hand;
use crate::commission::{Desk, Order};
use crate::guard::Fault;
use crate::protocol::Reply;
use crate::settings::{Settings, decode};

fn answer<const FINGERS: usize>(
    desk: &mut Desk<FINGERS>,
    hand: &mut Hand<FINGERS>,
    line: &str,
) -> Reply {
    desk.answer(line, |request| hand.execute(request))
        .expect(line)
        .said
}

fn refusal<const FINGERS: usize>(
    desk: &mut Desk<FINGERS>,
    hand: &mut Hand<FINGERS>,
    line: &str,
) -> std::string::String {
    let refused = desk.answer(line, |request| hand.execute(request));
    refused.expect_err(line).to_string()
}

#[test]
fn settings_are_stored_while_all_bridges_are_off_only() {
    let settings = Settings::default();
    let (mut desk, mut hand) = (Desk::<5>::new(settings), Hand::new(&settings));
    for (line, order) in [("save", Order::Save), ("forget", Order::Forget)] {
        assert_eq!(answer(&mut desk, &mut hand, line), Reply::Restart(order));
        assert_eq!(
            refusal(&mut desk, &mut hand, &format!("@2 {line}")),
            format!("@2 err {line} is for all fingers at once")
        );
        assert_eq!(
            refusal(&mut desk, &mut hand, &format!("{line} it")),
            "err unexpected 'it' after the command"
        );
        answer(&mut desk, &mut hand, "@3 arm");
        assert_eq!(
            refusal(&mut desk, &mut hand, line),
            format!("@3 err {line} needs the bridge off: abort first")
        );
        answer(&mut desk, &mut hand, "@3 abort");
    }
    hand.trip(Fault::SettingsCorrupt);
    assert_eq!(
        answer(&mut desk, &mut hand, "save"),
        Reply::Restart(Order::Save)
    );
    assert_eq!(
        refusal(&mut desk, &mut hand, "@1 arm"),
        "@1 err tripped by settings-corrupt; clear it first"
    );
    assert_eq!(answer(&mut desk, &mut hand, "clear"), Reply::Done);
    assert_eq!(answer(&mut desk, &mut hand, "arm"), Reply::Done);
}

#[test]
fn what_a_record_holds_is_what_the_fingers_were_told() {
    let settings = Settings::default();
    let (mut desk, mut hand) = (Desk::<2>::new(settings), Hand::new(&settings));
    for line in [
        "@0 set correction skin 0.125 0.001 -0.0001",
        "@1 set tile 3.5 0.06 0.1 0.2 0.02",
        "@1 set steps 10 0.5 -0.25",
    ] {
        answer(&mut desk, &mut hand, line);
    }
    let kept = decode::<2>(&desk.record(Order::Save))
        .expect("settings")
        .expect("no defaults");
    assert_eq!(kept[0].calibration.corrections[3].offset_k, 0.125);
    assert_eq!(kept[0].tile, settings.tile);
    assert_eq!(kept[1].tile.to_array(), [3.5, 0.06, 0.1, 0.2, 0.02]);
    assert_eq!(kept[1].calibration.steps_counts[..3], [0.5, -0.25, 0.0]);

    let mut restored = Desk::restored(&kept);
    for line in
        (1..=8).flat_map(|line| [format!("@0 settings {line}"), format!("@1 settings {line}")])
    {
        assert_eq!(
            answer(&mut restored, &mut hand, &line),
            answer(&mut desk, &mut hand, &line)
        );
    }
    assert_eq!(decode::<2>(&desk.record(Order::Forget)), Ok(None));
}
