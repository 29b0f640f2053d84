//! Orders to store settings: when they are accepted, and the record that they store.

use std::format;
use std::string::ToString;

use crate::commissioning::StorageOrder;
use crate::device::Device;
use crate::device::safety::Fault;
use crate::protocol::CommandHandler;
use crate::protocol::Reply;
use crate::settings::{Settings, decode_settings_record};

fn answer<const FINGERS: usize>(
    handler: &mut CommandHandler<FINGERS>,
    device: &mut Device<FINGERS>,
    line: &str,
) -> Reply {
    handler.answer(line, |finger, command| device.execute(finger, command)).expect(line).content
}

fn refusal<const FINGERS: usize>(
    handler: &mut CommandHandler<FINGERS>,
    device: &mut Device<FINGERS>,
    line: &str,
) -> std::string::String {
    let refused = handler.answer(line, |finger, command| device.execute(finger, command));
    refused.expect_err(line).to_string()
}

#[test]
fn storage_orders_are_accepted_only_while_all_bridges_are_off() {
    let settings = Settings::default();
    let (mut handler, mut device) = (CommandHandler::<5>::new(settings), Device::new(&settings));
    for (line, order, extra) in [
        ("save", StorageOrder::Save, "err unexpected 'it' after the command"),
        ("forget", StorageOrder::Forget, "err unknown forget 'it'; known: person"),
    ] {
        assert_eq!(answer(&mut handler, &mut device, line), Reply::Restart(order));
        assert_eq!(
            refusal(&mut handler, &mut device, &format!("@2 {line}")),
            format!("@2 err {line} is for all fingers at once")
        );
        assert_eq!(refusal(&mut handler, &mut device, &format!("{line} it")), extra);
        answer(&mut handler, &mut device, "@3 arm");
        assert_eq!(
            refusal(&mut handler, &mut device, line),
            format!("@3 err {line} needs the bridge off: abort first")
        );
        answer(&mut handler, &mut device, "@3 abort");
    }
    device.trip_all(Fault::SettingsCorrupt);
    assert_eq!(answer(&mut handler, &mut device, "save"), Reply::Restart(StorageOrder::Save));
    assert_eq!(
        refusal(&mut handler, &mut device, "@1 arm"),
        "@1 err tripped by settings-corrupt; clear it first"
    );
    assert_eq!(answer(&mut handler, &mut device, "clear"), Reply::DONE);
    assert_eq!(answer(&mut handler, &mut device, "arm"), Reply::DONE);
}

#[test]
fn the_record_holds_the_settings_of_each_finger_and_restores_them() {
    let settings = Settings::default();
    let (mut handler, mut device) = (CommandHandler::<2>::new(settings), Device::new(&settings));
    for line in [
        "@0 set correction skin 0.125 0.001 -0.0001",
        "@1 set tile 3.5 0.06 0.1 0.2 0.02",
        "@1 set steps 10 0.5 -0.25",
    ] {
        answer(&mut handler, &mut device, line);
    }
    let stored = decode_settings_record::<2>(&handler.record_to_save_or_forget(StorageOrder::Save))
        .expect("a valid record")
        .expect("settings rather than factory defaults");
    assert_eq!(stored.fingers[0].calibration.corrections[3].offset_k, 0.125);
    assert_eq!(stored.fingers[0].tile, settings.tile);
    assert_eq!(stored.fingers[1].tile.to_array(), [3.5, 0.06, 0.1, 0.2, 0.02]);
    assert_eq!(stored.fingers[1].calibration.steps_counts[..3], [0.5, -0.25, 0.0]);

    let mut restored = CommandHandler::from_stored(&stored);
    for line in
        (1..=8).flat_map(|line| [format!("@0 settings {line}"), format!("@1 settings {line}")])
    {
        assert_eq!(
            answer(&mut restored, &mut device, &line),
            answer(&mut handler, &mut device, &line)
        );
    }
    assert_eq!(
        decode_settings_record::<2>(&handler.record_to_save_or_forget(StorageOrder::Forget)),
        Ok(None)
    );
}
