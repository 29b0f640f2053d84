use super::*;

const HSI: u32 = 16_000_000;
const PSIZE_32: u32 = 2 << 8;

fn unlocked() -> Flash {
    let mut flash = Flash::new(vec![0xff; 0x8_0000], &ChipState::default());
    for key in KEYS {
        flash.write(4, key, 0, HSI).unwrap();
    }
    assert_eq!(flash.read(0x10, 0).unwrap(), 0, "CR is unlocked");
    flash
}

#[test]
fn the_keys_unlock_the_control_register_in_their_order_only() {
    let mut flash = Flash::new(vec![0xff; 0x8_0000], &ChipState::default());
    assert_eq!(flash.read(0x10, 0).unwrap(), LOCK);
    assert!(flash.write(0x10, PG, 0, HSI).is_err());
    for key in [KEYS[1], KEYS[0], KEYS[1]] {
        flash.write(4, key, 0, HSI).unwrap();
    }
    assert_eq!(flash.read(0x10, 0).unwrap(), LOCK, "locked until reset");
    flash.reset();
    for key in KEYS {
        flash.write(4, key, 0, HSI).unwrap();
    }
    assert_eq!(flash.read(0x10, 0).unwrap(), 0);
    flash.write(0x10, LOCK, 0, HSI).unwrap();
    assert_eq!(flash.read(0x10, 0).unwrap(), LOCK);
}

#[test]
fn programming_and_erasing_take_their_documented_times() {
    let mut flash = unlocked();
    flash.write(0x10, PG | PSIZE_32, 0, HSI).unwrap();
    flash.store(SETTINGS.start + 8, 4, 0x1234_5678, 100, HSI).unwrap();
    flash.store(SETTINGS.start + 8, 4, 0xffff_00ff, 100, HSI).unwrap();
    assert_eq!(flash.load(SETTINGS.start + 8, 4), 0x1234_0078);
    // 16 us are 256 cycles of 16 MHz.
    assert_eq!((flash.read(0x0c, 611).unwrap(), flash.read(0x0c, 612).unwrap()), (BSY, 0));
    flash.write(0x10, SER | 1 << 3 | PSIZE_32 | STRT, 1000, HSI).unwrap();
    assert_eq!(flash.load(SETTINGS.start + 8, 4), u32::MAX);
    assert_eq!(flash.busy_until(), 1000 + 4_000_000, "250 ms");
    assert!(
        flash.write(0x10, SER | PSIZE_32 | STRT, 9_000_000, HSI).is_err(),
        "sector 0 holds code"
    );
}

#[test]
fn a_wrong_store_changes_nothing_and_sets_its_error_flag() {
    let mut flash = unlocked();
    let cases =
        [(SER, 4, 0, PGSERR), (PSIZE_32 | PG, 2, 0, PGPERR), (PSIZE_32 | PG, 4, 14, PGAERR)];
    for (control, bytes, offset, flag) in cases {
        flash.write(0x10, control, 0, HSI).unwrap();
        flash.store(SETTINGS.start + offset, bytes, 0, 0, HSI).unwrap();
        assert_eq!(flash.read(0x0c, 0).unwrap(), flag);
        flash.write(0x0c, flag, 0, HSI).unwrap();
        assert_eq!(flash.read(0x0c, 0).unwrap(), 0);
    }
    assert!(flash.cells.bytes().iter().all(|byte| *byte == 0xff));
    assert_eq!(flash.cells.operations(), 0);
}

/// 3.8.6: BOR_LEV is in bits 3 and 2; as delivered it is 11.
#[test]
fn the_option_register_shows_the_brown_out_level() {
    for (code, expected) in [(3, 0x0fff_aaed), (0, 0x0fff_aae1), (1, 0x0fff_aae5)] {
        let flash = Flash::new(
            vec![0xff; 0x8_0000],
            &ChipState { brown_out_code: code, ..ChipState::default() },
        );
        assert_eq!(flash.read(0x14, 0), Ok(expected));
    }
}

/// DS10693, flash memory programming, maximum.
#[test]
fn a_slow_flash_takes_the_longest_times_of_the_data_sheet() {
    let slow = ChipState { slow_flash: true, ..ChipState::default() };
    let mut flash = Flash::new(vec![0xff; 0x8_0000], &slow);
    for key in KEYS {
        flash.write(4, key, 0, HSI).unwrap();
    }
    flash.write(0x10, PG | PSIZE_32, 0, HSI).unwrap();
    flash.store(SETTINGS.start, 4, 0, 0, HSI).unwrap();
    assert_eq!(flash.busy_until(), 1600, "100 us");
    for (size, ms) in [(0, 800), (1, 600), (2, 500)] {
        let begin = flash.busy_until();
        let erase = SER | 1 << 3 | size << 8 | STRT;
        flash.write(0x10, erase, begin, HSI).unwrap();
        assert_eq!(flash.busy_until(), begin + ms * 16_000, "{ms} ms");
    }
}
