//! Resets that come while the image stores, and a flash that something has disturbed before.

use hil_sim::machine::{Cells, ResetCause};
use system_tests::{Bare, START};

use super::image::{after, firmware, lines};
use super::numbered;

/// A device that has been given other settings than those of `cells` and told to store them, at the reset that follows.
fn about_to_save(cells: &Cells) -> (Bare, Vec<String>) {
    let mut device = Bare::new(&firmware(), cells);
    let new = lines(numbered(5).as_ref());
    for line in &new {
        assert_eq!(device.tell(line.trim_start_matches("ok ")), "ok");
    }
    device.0.uart_send(b"save\n");
    device.run_until(100, |machine| machine.resets().len() == 2);
    assert_eq!(device.0.resets()[1].cause, ResetCause::Software);
    (device, new)
}

/// Until one more word of a record is in the flash.
fn begin_to_store(device: &mut Bare) {
    let before = device.0.flash().operations();
    device.run_until(100, |machine| machine.flash().operations() > before);
}

#[test]
fn what_a_reset_interrupts_is_stored_by_the_next_start() {
    let (mut device, new) = about_to_save(&after(2));
    begin_to_store(&mut device);
    device.0.brown_out().expect("starts anew");
    device.run(START);
    assert_eq!(device.said(), ["ok"]);
    assert_eq!(device.settings(), new);
    let stored = device.cells();
    assert_eq!(Bare::new(&firmware(), &stored).settings(), new);
}

#[test]
fn storing_that_ends_in_a_reset_each_time_is_given_up() {
    let (mut device, new) = about_to_save(&after(2));
    for _ in 0..2 {
        begin_to_store(&mut device);
        device.0.pull_reset_pin().expect("starts anew");
    }
    let operations = device.0.flash().operations();
    device.run(START);
    assert_eq!(
        device.said(),
        ["err not stored: interrupted by a reset, twice"]
    );
    assert_eq!(device.0.flash().operations(), operations);
    let found = device.settings();
    assert!(
        found == lines(numbered(1).as_ref()) || found == new,
        "{found:?}"
    );
    // Nothing waits any more.
    device.0.pull_reset_pin().expect("starts anew");
    device.run(START);
    assert_eq!(device.said(), [""; 0]);
    assert_eq!(device.0.flash().operations(), operations);
}

/// RM0390 3.8.4: an error flag that stands keeps the flash from being programmed until it is cleared.
#[test]
fn flags_of_a_stray_store_do_not_keep_settings_from_being_stored() {
    let (mut device, new) = about_to_save(&after(2));
    device
        .0
        .stray_store(0x0800_4000, 0)
        .expect("refused by the flash, with a flag");
    device.run(START);
    assert_eq!(device.said(), ["ok"]);
    assert_eq!(device.settings(), new);
}
