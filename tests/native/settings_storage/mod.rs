//! Stored settings survive a power cut in any flash operation, and any single flipped bit.

mod bit_flips;

use documented_figures::assert_figure;
use system_tests::flash::{BYTES, SECTOR, changes_page, erased, loaded, numbered, saved};

/// What a campaign has covered.
#[derive(Debug, Default)]
struct Coverage {
    saves: u32,
    page_changes: u32,
    cuts: u64,
    cuts_in_page_changes: u64,
}

/// Saves different settings one after the other. Power is cut in every flash operation of each save that changes the page, and
/// of every `stride`th save: the old or the new settings are found, and the next save works even if power is cut in that one, too.
fn campaign<const FINGERS: usize>(saves: u32, stride: u32) -> Coverage {
    let mut cells = erased();
    let mut coverage = Coverage::default();
    let mut before = None;
    for number in 0..saves {
        let settings = numbered::<FINGERS>(number);
        let settings = settings.as_ref();
        let after = saved(&cells, settings, None);
        assert_eq!(loaded(&after).as_ref(), settings, "save {number}");
        let operations = after.operations() - cells.operations();
        let new_page = changes_page(&cells, &after);
        coverage.saves += 1;
        coverage.page_changes += u32::from(new_page);
        if new_page || number % stride == 0 {
            for nth in 1..=operations {
                let seed = u64::from(number) << 32 | nth;
                let cut = saved(&cells, settings, Some((nth, seed)));
                let found = loaded::<FINGERS>(&cut);
                assert!(
                    found == before || found.as_ref() == settings,
                    "save {number}, cut in operation {nth} of {operations}: neither old nor new"
                );
                let next = numbered::<FINGERS>(number + 1000);
                let again = saved(&cut, next.as_ref(), Some((1 + seed % operations, !seed)));
                let later = loaded::<FINGERS>(&again);
                assert!(later == found || later == next, "save {number}, cut in {nth}, then again");
                let healed = saved(&again, next.as_ref(), None);
                assert_eq!(
                    loaded::<FINGERS>(&healed),
                    next,
                    "save {number}, cut in {nth}, then again"
                );
                coverage.cuts += 1;
                coverage.cuts_in_page_changes += u64::from(new_page);
            }
        }
        cells = after;
        before = settings.cloned();
    }
    coverage
}

#[test]
fn settings_of_one_finger_survive_a_power_cut_in_any_flash_operation() {
    let coverage = campaign::<1>(230, 12);
    assert_figure("storage.cuts_one", coverage.cuts as f64);
    assert!(coverage.page_changes >= 5, "{coverage:?}");
}

#[test]
fn settings_of_five_fingers_survive_a_power_cut_in_any_flash_operation() {
    let coverage = campaign::<5>(45, 20);
    assert_figure("storage.cuts_five", coverage.cuts as f64);
    assert!(coverage.page_changes >= 5, "{coverage:?}");
}

#[test]
fn settings_of_ten_fingers_with_heat_flux_sensors_can_be_stored() {
    let mut cells = erased();
    for number in 1000..1010 {
        let settings = numbered::<10>(number);
        cells = saved(&cells, settings.as_ref(), None);
        assert_eq!(loaded(&cells), settings, "save {number}");
    }
}

#[test]
fn settings_can_be_stored_after_damage_to_any_byte_of_the_flash() {
    // After 40 saves a sector is full and closed, the next is in use, and the third is empty.
    let cells =
        (0..40).fold(erased(), |cells, number| saved::<1>(&cells, numbered(number).as_ref(), None));
    let next = numbered(200);
    // The headers and trailers of all sectors, and every 61st byte between them.
    let places = (0..BYTES).filter(|place| {
        let within = place % SECTOR;
        !(36..SECTOR - 16).contains(&within) || within.is_multiple_of(61)
    });
    for place in places {
        for flips in [0x01, 0x80, 0xff] {
            let mut cells = cells.clone();
            let byte = cells.bytes()[place] ^ flips;
            assert!(cells.load(place, &[byte]));
            let cells = saved::<1>(&cells, next.as_ref(), None);
            assert_eq!(loaded::<1>(&cells), next, "byte {place} ^ {flips:#x}");
        }
    }
}
