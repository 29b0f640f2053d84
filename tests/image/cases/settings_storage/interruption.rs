//! Resets while the image saves settings, and error flags that an earlier access left in the flash controller.

use image_tests::{Bare, START};
use system_tests::flash::numbered;
use thermal_sim::FlashCells;
use thermal_sim::processor::ResetCause;

use super::{after, firmware, lines};

/// A device with new settings, at the reset that follows `save`, and those settings.
fn about_to_save(cells: &FlashCells) -> (Bare, Vec<String>) {
    let mut device = Bare::new(&firmware(), cells);
    let new = lines(numbered(5).as_ref());
    for line in &new {
        assert_eq!(device.answer(line.trim_start_matches("ok ")), "ok");
    }
    device.0.uart_send(b"save\n");
    device.run_until(100, |machine| machine.resets().len() == 2);
    assert_eq!(device.0.resets()[1].cause, ResetCause::Software);
    (device, new)
}

/// Runs until one more word of the record is programmed.
fn run_into_the_save(device: &mut Bare) {
    let before = device.0.flash().operations();
    device.run_until(100, |machine| machine.flash().operations() > before);
}

#[test]
fn a_save_that_a_reset_interrupts_is_completed_by_the_next_start() {
    let (mut device, new) = about_to_save(&after(2));
    run_into_the_save(&mut device);
    device.0.brown_out().expect("starts anew");
    device.run(START);
    assert_eq!(device.received(), ["ok"]);
    assert_eq!(device.settings(), new);
    let stored = device.cells();
    assert_eq!(Bare::new(&firmware(), &stored).settings(), new);
}

#[test]
fn a_save_is_given_up_after_two_resets() {
    let (mut device, new) = about_to_save(&after(2));
    for _ in 0..2 {
        run_into_the_save(&mut device);
        device.0.pull_reset_pin().expect("starts anew");
    }
    let operations = device.0.flash().operations();
    device.run(START);
    assert_eq!(device.received(), ["err not stored: interrupted by a reset, twice"]);
    assert_eq!(device.0.flash().operations(), operations);
    let found = device.settings();
    assert!(found == lines(numbered(1).as_ref()) || found == new, "{found:?}");
    // No save is pending any more.
    device.0.pull_reset_pin().expect("starts anew");
    device.run(START);
    assert_eq!(device.received(), [""; 0]);
    assert_eq!(device.0.flash().operations(), operations);
}

/// RM0390 3.8.4: a pending error flag blocks programming until it is cleared.
#[test]
fn settings_are_saved_despite_a_pending_flash_error_flag() {
    let (mut device, new) = about_to_save(&after(2));
    device.0.stray_store(0x0800_4000, 0).expect("refused by the flash, with a flag");
    device.run(START);
    assert_eq!(device.received(), ["ok"]);
    assert_eq!(device.settings(), new);
}
