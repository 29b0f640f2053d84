//! A single flipped bit anywhere in the settings' flash loses nothing that was stored.

use system_tests::flash::{BYTES, Flash, SECTOR, erased, loaded, numbered, saved};
use thermal_display::settings::Store;

/// Outside the sectors' headers, settings are saved again after every 37th flipped bit.
const STRIDE: usize = 37;

/// Flips every bit of the three sectors, one at a time, after a number of saves: the newest settings are found, and others can
/// be stored.
fn flip_each_bit<const FINGERS: usize>(saves: u32) {
    let (mut newest, mut cells) = (None, erased());
    for number in 0..saves {
        newest = numbered::<FINGERS>(number);
        cells = saved(&cells, newest.as_ref(), None);
    }
    let next = numbered::<FINGERS>(saves);
    let flash = Flash::new(cells);
    let mut stored = 0;
    for bit in 0..8 * BYTES {
        flash.flip(bit);
        let found = Store::new(flash.clone()).load();
        assert_eq!(found, Ok(newest), "{saves} saves, bit {bit}");
        if bit % (8 * SECTOR) < 192 || bit % STRIDE == 0 {
            let after = saved(&flash.cells(), next.as_ref(), None);
            assert_eq!(
                loaded(&after),
                next,
                "{saves} saves, bit {bit}, one more save"
            );
            stored += 1;
        }
        flash.flip(bit);
    }
    println!(
        "{FINGERS} fingers, {saves} saves, {} bits: none lost; {stored} saves more",
        8 * BYTES
    );
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
