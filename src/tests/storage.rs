//! When settings may be stored, and what is.

use std::format;
use std::string::ToString;

use crate::commissioning::StorageOrder;
use crate::device::Device;
use crate::device::safety::Fault;
use crate::protocol::Desk;
use crate::protocol::Reply;
use crate::settings::{Settings, decode};

fn answer<const FINGERS: usize>(
    desk: &mut Desk<FINGERS>,
    device: &mut Device<FINGERS>,
    line: &str,
) -> Reply {
    desk.answer(line, |request| device.execute(request))
        .expect(line)
        .said
}

fn refusal<const FINGERS: usize>(
    desk: &mut Desk<FINGERS>,
    device: &mut Device<FINGERS>,
    line: &str,
) -> std::string::String {
    let refused = desk.answer(line, |request| device.execute(request));
    refused.expect_err(line).to_string()
}

#[test]
fn settings_are_stored_while_all_bridges_are_off_only() {
    let settings = Settings::default();
    let (mut desk, mut device) = (Desk::<5>::new(settings), Device::new(&settings));
    for (line, order) in [
        ("save", StorageOrder::Save),
        ("forget", StorageOrder::Forget),
    ] {
        assert_eq!(answer(&mut desk, &mut device, line), Reply::Restart(order));
        assert_eq!(
            refusal(&mut desk, &mut device, &format!("@2 {line}")),
            format!("@2 err {line} is for all fingers at once")
        );
        assert_eq!(
            refusal(&mut desk, &mut device, &format!("{line} it")),
            "err unexpected 'it' after the command"
        );
        answer(&mut desk, &mut device, "@3 arm");
        assert_eq!(
            refusal(&mut desk, &mut device, line),
            format!("@3 err {line} needs the bridge off: abort first")
        );
        answer(&mut desk, &mut device, "@3 abort");
    }
    device.trip(Fault::SettingsCorrupt);
    assert_eq!(
        answer(&mut desk, &mut device, "save"),
        Reply::Restart(StorageOrder::Save)
    );
    assert_eq!(
        refusal(&mut desk, &mut device, "@1 arm"),
        "@1 err tripped by settings-corrupt; clear it first"
    );
    assert_eq!(answer(&mut desk, &mut device, "clear"), Reply::DONE);
    assert_eq!(answer(&mut desk, &mut device, "arm"), Reply::DONE);
}

#[test]
fn what_a_record_holds_is_what_the_fingers_were_told() {
    let settings = Settings::default();
    let (mut desk, mut device) = (Desk::<2>::new(settings), Device::new(&settings));
    for line in [
        "@0 set correction skin 0.125 0.001 -0.0001",
        "@1 set tile 3.5 0.06 0.1 0.2 0.02",
        "@1 set steps 10 0.5 -0.25",
    ] {
        answer(&mut desk, &mut device, line);
    }
    let kept = decode::<2>(&desk.record(StorageOrder::Save))
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
            answer(&mut restored, &mut device, &line),
            answer(&mut desk, &mut device, &line)
        );
    }
    assert_eq!(decode::<2>(&desk.record(StorageOrder::Forget)), Ok(None));
}
