//! A single flipped bit anywhere in the settings' flash loses nothing that was stored.

use documented_figures::one_case_in;
use system_tests::flash::{BYTES, Flash, SECTOR, erased, loaded, numbered, saved};
use thermal_display::settings::SettingsStore;

/// Bits of a sector's header.
const HEADER_BITS: usize = 192;
/// Outside the sectors' headers, settings are saved again after every 37th flipped bit.
const STRIDE: usize = 37;
/// Outside the headers, the suite flips one bit in so many: prime, so that each bit of a word has its turn.
const ONE_IN: usize = 11;

/// Flips bits of the three sectors, one at a time, after a number of saves: the newest settings are found, and others can
/// be stored.
fn flip_each_bit<const FINGERS: usize>(saves: u32) {
    let (mut newest, mut cells) = (None, erased());
    for number in 0..saves {
        newest = numbered::<FINGERS>(number);
        cells = saved(&cells, newest.as_ref(), None);
    }
    let next = numbered::<FINGERS>(saves);
    let flash = Flash::new(cells);
    let (mut flipped, mut stored) = (0, 0);
    let in_header = |bit: usize| bit % (8 * SECTOR) < HEADER_BITS;
    let step = one_case_in(ONE_IN);
    for bit in (0..8 * BYTES).filter(|bit| in_header(*bit) || bit % step == 0) {
        flash.flip(bit);
        let found = SettingsStore::new(flash.clone()).load();
        assert_eq!(found, Ok(newest.clone()), "{saves} saves, bit {bit}");
        flipped += 1;
        if in_header(bit) || bit % STRIDE == 0 {
            let after = saved(&flash.cells(), next.as_ref(), None);
            assert_eq!(loaded(&after), next, "{saves} saves, bit {bit}, one more save");
            stored += 1;
        }
        flash.flip(bit);
    }
    println!("{FINGERS} fingers, {saves} saves, {flipped} bits: none lost; {stored} saves more");
}

/// After 0 and 1 saves, with a sector about to become full (37) and just full (38), and with the first and the third sector in
/// use after all of them have been (100).
#[test]
fn a_flipped_bit_loses_no_settings_of_one_finger() {
    for saves in [0, 1, 37, 38, 100] {
        flip_each_bit::<1>(saves);
    }
}

#[test]
fn a_flipped_bit_loses_no_settings_of_five_fingers() {
    flip_each_bit::<5>(22);
}
