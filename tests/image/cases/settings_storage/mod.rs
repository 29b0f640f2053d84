//! The release image stores settings that the host sends, and restores them after power cuts and resets.

mod interruption;

use documented_figures::assert_figure;
use image_tests::{Bare, START, image};
use stm32_emulator::Firmware;
use system_tests::flash::{append, changes_page, erased, numbered, saved};
use thermal_display::protocol::CommandHandler;
use thermal_display::settings::{
    RECORD_MAX_BYTES, StoredDevice, StoredSettings, encode_settings_record,
};
use thermal_sim::FlashCells;
use thermal_sim::processor::{ChipState, ResetCause};

/// The answers to `settings 1` to `settings 8` of a device with these settings.
pub fn lines(kept: Option<&StoredDevice<1>>) -> Vec<String> {
    let mut handler: CommandHandler<1> =
        kept.map_or_else(|| CommandHandler::new(Default::default()), CommandHandler::from_stored);
    (1..=9)
        .map(|line| {
            let answer = handler.answer(&format!("settings {line}"), |_, _| {
                unreachable!("the station executes nothing")
            });
            answer.expect("a line of settings").to_string()
        })
        .collect()
}

pub fn firmware() -> Firmware {
    Firmware::from_file(image()).expect("an image for this chip")
}

/// The settings' sectors after a number of saves.
pub fn after(saves: u32) -> FlashCells {
    (0..saves).fold(erased(), |cells, number| saved::<1>(&cells, numbered(number).as_ref(), None))
}

#[test]
fn saved_settings_survive_a_power_cycle_and_can_be_forgotten() {
    let firmware = firmware();
    let mut device = Bare::new(&firmware, &after(0));
    assert_eq!(device.settings(), lines(None));
    let kept = numbered::<1>(3);
    for line in lines(kept.as_ref()) {
        assert_eq!(device.answer(line.trim_start_matches("ok ")), "ok");
    }
    assert_eq!(device.ask("save", START), ["ok"], "answered after the save");
    let stored = device.cells();
    assert_eq!(stored.bytes(), saved::<1>(&after(0), kept.as_ref(), None).bytes(), "as natively");
    assert_eq!(device.settings(), lines(kept.as_ref()));

    let mut device = Bare::new(&firmware, &stored);
    assert_eq!(device.settings(), lines(kept.as_ref()), "after a power cycle");
    assert_eq!(device.ask("forget", START), ["ok"]);
    assert_eq!(device.settings(), lines(None));
    let mut device = Bare::new(&firmware, &device.cells());
    assert_eq!(device.settings(), lines(None));
}

#[test]
fn corrupt_settings_trip_the_device_until_others_are_saved() {
    let mut cells = after(1);
    // A record with the version of a future firmware and valid checksums.
    let record =
        encode_settings_record(Some(&[StoredSettings::from_settings(&Default::default())].into()));
    assert!(record.len() < RECORD_MAX_BYTES);
    let mut content = record[..record.len() - 4].to_vec();
    content[0] = 3;
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&content);
    content.extend(crc.to_le_bytes());
    assert!(append(&mut cells, &content));

    let mut device = Bare::new(&firmware(), &cells);
    let state = device.answer("state");
    assert!(state.starts_with("ok state=tripped fault=settings-corrupt "), "{state}");
    assert_eq!(device.settings(), lines(None));
    assert_eq!(device.ask("save", START), ["ok"]);
    let state = device.answer("state");
    assert!(!state.contains("settings-corrupt"), "{state}");
}

/// Time of a cycle of the present clock since the last reset, ms.
fn since_reset_ms(device: &Bare, cycle: u64) -> f64 {
    let reset = device.0.resets().last().expect("at power-on");
    (device.0.ps_at(cycle) - reset.at_ps) as f64 / 1e9
}

/// Time from power-up to the first conversion, ms.
fn first_conversion_ms(firmware: &Firmware, cells: &FlashCells) -> f64 {
    let mut device = Bare::switched_on(firmware, cells);
    device.run_until(1000, |machine| machine.wiring().converted_at > 0);
    since_reset_ms(&device, device.0.wiring().converted_at)
}

/// Time from the reset that a save causes to its answer, ms.
fn save_ms(firmware: &Firmware, cells: &FlashCells, number: u32) -> f64 {
    let mut device = Bare::new(firmware, cells);
    for line in lines(numbered(number).as_ref()) {
        assert_eq!(device.answer(line.trim_start_matches("ok ")), "ok");
    }
    assert_eq!(device.ask("save", START), ["ok"]);
    since_reset_ms(&device, device.0.wiring().sent_at)
}

#[test]
fn stored_records_delay_a_start_by_less_than_100_ms_and_a_save_takes_less_than_a_second() {
    let firmware = firmware();
    let never = first_conversion_ms(&firmware, &after(0));
    let (one, full) = (after(1), after(37));
    let [with_one, with_most] = [&one, &full].map(|cells| first_conversion_ms(&firmware, cells));
    assert_figure("storage.start", never);
    assert_figure("storage.start_one", with_one);
    assert_figure("storage.start_full", with_most);
    let [first, second, turning] = [(&after(0), 0), (&one, 1), (&full, 37)]
        .map(|(cells, number)| save_ms(&firmware, cells, number));
    assert_figure("storage.save_first", first);
    assert_figure("storage.save", second);
    assert_figure("storage.save_turning", turning);
    // The erase time of a sector (DS10693, typical).
    assert!(turning - second > 250.0);
}

/// DS10693: programming a word takes up to 100 us, erasing a sector up to 500 ms.
#[test]
fn settings_are_saved_with_the_slowest_flash() {
    let firmware = firmware();
    let slow = ChipState { slow_flash: true, ..ChipState::default() };
    for (saves, with_erase) in [(1, false), (37, true)] {
        let mut device = Bare::with_chip(&firmware, &after(saves), &slow);
        device.run(START);
        let kept = numbered::<1>(saves);
        for line in lines(kept.as_ref()) {
            assert_eq!(device.answer(line.trim_start_matches("ok ")), "ok");
        }
        assert_eq!(device.ask("save", 2 * START), ["ok"]);
        let resets: Vec<_> = (device.0.resets().iter()).map(|reset| reset.cause).collect();
        assert_eq!(resets, [ResetCause::PowerOn, ResetCause::Software]);
        let took_ms = since_reset_ms(&device, device.0.wiring().sent_at);
        assert_eq!(took_ms > 500.0, with_erase, "{took_ms} ms");
        assert!(took_ms < 1500.0, "{took_ms} ms");
        assert_eq!(device.settings(), lines(kept.as_ref()));
    }
}

/// Saves on the image with power cut in each of some flash operations; how often the old and how often the new settings are
/// found afterwards.
fn count_after_power_cuts(
    firmware: &Firmware,
    cells: &FlashCells,
    number: u32,
    operations: &[u64],
) -> (u32, u32) {
    let [old, new] = [number - 1, number].map(|number| lines(numbered(number).as_ref()));
    let (mut found_old, mut found_new) = (0, 0);
    for nth in operations {
        let mut device = Bare::new(firmware, cells);
        for line in &new {
            assert_eq!(device.answer(line.trim_start_matches("ok ")), "ok");
        }
        device.0.flash_mut().cut_power_at(*nth, nth ^ u64::from(number));
        device.ask("save", START + START);
        let causes: Vec<_> = device.0.resets().iter().map(|reset| reset.cause).collect();
        let expected = [ResetCause::PowerOn, ResetCause::Software, ResetCause::PowerOn];
        assert_eq!(causes, expected, "save {number}, cut in operation {nth}");
        let found = device.settings();
        assert!(found == old || found == new, "save {number}, cut in operation {nth}: {found:?}");
        found_old += u32::from(found == old);
        found_new += u32::from(found == new);
    }
    (found_old, found_new)
}

#[test]
fn a_power_cut_in_any_flash_operation_leaves_the_old_or_the_new_settings() {
    let firmware = firmware();
    let mut cells = after(1);
    let (mut cuts, mut page_changes) = (0, 0);
    for number in 1..150 {
        let next = saved(&cells, numbered::<1>(number).as_ref(), None);
        let operations = next.operations() - cells.operations();
        let new_page = changes_page(&cells, &next);
        if new_page || number == 3 {
            // The operations that change the page come first.
            let chosen: Vec<_> =
                (1..=operations).filter(|nth| nth % 4 == 0 || new_page && *nth < 8).collect();
            let (old, new) = count_after_power_cuts(&firmware, &cells, number, &chosen);
            println!(
                "save {number} of {operations} operations: {old} times the old, {new} times the new settings"
            );
            assert!(old > 0, "save {number}");
            cuts += chosen.len();
            page_changes += u32::from(new_page);
        }
        cells = next;
    }
    assert!(cuts >= 40 && page_changes >= 3, "{cuts} cuts, {page_changes} page changes");
}
