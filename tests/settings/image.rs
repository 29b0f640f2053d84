//! The same on the image: lines to the emulated microcontroller, power that is cut while it stores, lines back.

use documented_figures::assert_figure;
use hil_sim::machine::{Cells, Firmware, ResetCause};
use system_tests::flash::{BYTES, append, numbered};
use system_tests::{Bare, START, image};
use thermal_display::commission::Desk;
use thermal_display::settings::{Kept, LONGEST, encode};

use super::{saved, turns};

/// The lines that settings are given in.
pub fn lines(kept: Option<&[Kept; 1]>) -> Vec<String> {
    let mut desk: Desk<1> = kept.map_or_else(|| Desk::new(Default::default()), Desk::restored);
    (1..=8)
        .map(|line| {
            let answer = desk.answer(&format!("settings {line}"), |_| {
                unreachable!("nothing to execute")
            });
            answer.expect("a line of settings").to_string()
        })
        .collect()
}

pub fn firmware() -> Firmware {
    Firmware::from_file(image()).expect("an image for this chip")
}

/// Cells after so many saves.
pub fn after(saves: u32) -> Cells {
    (0..saves).fold(Cells::new(vec![0xff; BYTES]), |cells, number| {
        saved::<1>(&cells, numbered(number).as_ref(), None)
    })
}

#[test]
fn what_is_saved_outlives_the_power_and_can_be_forgotten() {
    let firmware = firmware();
    let mut device = Bare::new(&firmware, &after(0));
    assert_eq!(device.settings(), lines(None));
    let kept = numbered::<1>(3);
    for line in lines(kept.as_ref()) {
        assert_eq!(device.tell(line.trim_start_matches("ok ")), "ok");
    }
    assert_eq!(device.ask("save", START), ["ok"], "after it is stored");
    let stored = device.cells();
    assert_eq!(
        stored.bytes(),
        saved::<1>(&after(0), kept.as_ref(), None).bytes(),
        "as the host does it"
    );
    assert_eq!(device.settings(), lines(kept.as_ref()));

    let mut device = Bare::new(&firmware, &stored);
    assert_eq!(device.settings(), lines(kept.as_ref()), "switched on anew");
    assert_eq!(device.ask("forget", START), ["ok"]);
    assert_eq!(device.settings(), lines(None));
    let mut device = Bare::new(&firmware, &device.cells());
    assert_eq!(device.settings(), lines(None));
}

#[test]
fn corrupt_settings_trip_the_device_until_it_is_told_others() {
    let mut cells = after(1);
    // A record of a firmware to come: its version, with both checksums.
    let record = encode(Some(&[Kept::of(&Default::default())]));
    assert!(record.len() < LONGEST);
    let mut content = record[..record.len() - 4].to_vec();
    content[0] = 2;
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&content);
    content.extend(crc.to_le_bytes());
    assert!(append(&mut cells, &content));

    let mut device = Bare::new(&firmware(), &cells);
    let state = device.tell("state");
    assert!(
        state.starts_with("ok state=tripped fault=settings-corrupt "),
        "{state}"
    );
    assert_eq!(device.settings(), lines(None));
    assert_eq!(device.ask("save", START), ["ok"]);
    let state = device.tell("state");
    assert!(!state.contains("settings-corrupt"), "{state}");
}

/// Milliseconds that 16 MHz take for these cycles.
fn start_ms(cycles: u64) -> f64 {
    cycles as f64 / 16e3
}

/// From power-up to the first conversion; nothing but the start is slower than 180 MHz.
fn first_conversion_ms(firmware: &Firmware, cells: &Cells) -> f64 {
    let mut device = Bare::switched_on(firmware, cells);
    device.run_until(1000, |machine| machine.wiring().converted_at > 0);
    start_ms(device.0.wiring().converted_at)
}

/// From the reset that a save makes to its answer.
fn save_ms(firmware: &Firmware, cells: &Cells, number: u32) -> f64 {
    let mut device = Bare::new(firmware, cells);
    for line in lines(numbered(number).as_ref()) {
        assert_eq!(device.tell(line.trim_start_matches("ok ")), "ok");
    }
    assert_eq!(device.ask("save", START), ["ok"]);
    let reset = device.0.resets().last().expect("resets").at;
    start_ms(device.0.wiring().sent_at - reset)
}

#[test]
fn the_flash_delays_a_start_by_little() {
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
    // The sector's erasure (DS10693, typical).
    assert!(turning - second > 250.0);
}

/// Saves on the image with power that is cut in some of the operations, and what is found then: the number of times it was
/// the old settings, and the new ones.
fn cut(firmware: &Firmware, cells: &Cells, number: u32, operations: &[u64]) -> (u32, u32) {
    let [old, new] = [number - 1, number].map(|number| lines(numbered(number).as_ref()));
    let (mut found_old, mut found_new) = (0, 0);
    for nth in operations {
        let mut device = Bare::new(firmware, cells);
        for line in &new {
            assert_eq!(device.tell(line.trim_start_matches("ok ")), "ok");
        }
        device
            .0
            .flash_mut()
            .cut_power_at(*nth, nth ^ u64::from(number));
        device.ask("save", START + START);
        let causes: Vec<_> = device.0.resets().iter().map(|reset| reset.cause).collect();
        let expected = [
            ResetCause::PowerOn,
            ResetCause::Software,
            ResetCause::PowerOn,
        ];
        assert_eq!(causes, expected, "save {number}, cut in operation {nth}");
        let found = device.settings();
        assert!(
            found == old || found == new,
            "save {number}, cut in operation {nth}: {found:?}"
        );
        found_old += u32::from(found == old);
        found_new += u32::from(found == new);
    }
    (found_old, found_new)
}

#[test]
fn the_image_loses_nothing_in_any_operation() {
    let firmware = firmware();
    let mut cells = after(1);
    let (mut cuts, mut turned) = (0, 0);
    for number in 1..150 {
        let next = saved(&cells, numbered::<1>(number).as_ref(), None);
        let operations = next.operations() - cells.operations();
        let is_turn = turns(&cells, &next);
        if is_turn || number == 3 {
            // What turns to another page comes first.
            let chosen: Vec<_> = (1..=operations)
                .filter(|nth| nth % 4 == 0 || is_turn && *nth < 8)
                .collect();
            let (old, new) = cut(&firmware, &cells, number, &chosen);
            println!(
                "save {number} of {operations} operations: {old} times the old, {new} times the new settings"
            );
            assert!(old > 0, "save {number}");
            cuts += chosen.len();
            turned += u32::from(is_turn);
        }
        cells = next;
    }
    assert!(cuts >= 40 && turned >= 3, "{cuts} cuts, {turned} turns");
}
