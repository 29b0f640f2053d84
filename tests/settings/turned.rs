//! Any one bit of the flash that turns loses nothing of what was stored.

use system_tests::flash::{BYTES, Flash, SECTOR, numbered};
use thermal_display::settings::Store;

use super::{erased, loaded, saved};

/// Bits from one to the next after which others are stored, of those that are not a seal's.
const STRIDE: usize = 37;

/// Turns every bit of the three sectors, one at a time, after so many saves: the newest settings are found, and others can be
/// stored.
fn turn_all<const FINGERS: usize>(saves: u32) {
    let (mut newest, mut cells) = (None, erased());
    for number in 0..saves {
        newest = numbered::<FINGERS>(number);
        cells = saved(&cells, newest.as_ref(), None);
    }
    let next = numbered::<FINGERS>(saves);
    let flash = Flash::new(cells);
    let mut stored = 0;
    for bit in 0..8 * BYTES {
        flash.turn(bit);
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
        flash.turn(bit);
    }
    println!(
        "{FINGERS} fingers, {saves} saves, {} bits: none lost; {stored} saves more",
        8 * BYTES
    );
}

/// None, one, a sector that is about to become full, one that is followed by another, and the first and the third in use
/// when all of them have been.
#[test]
fn any_bit_of_one_fingers_flash_may_turn() {
    for saves in [0, 1, 37, 38, 100] {
        turn_all::<1>(saves);
    }
}

#[test]
fn any_bit_of_five_fingers_flash_may_turn() {
    turn_all::<5>(22);
}
