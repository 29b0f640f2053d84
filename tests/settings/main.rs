//! Power that fails in any operation of the flash, or any bit that turns, loses nothing of what was stored.

mod image;
mod interrupted;
mod turned;

use documented_figures::assert_figure;
use hil_sim::machine::Cells;
use system_tests::flash::{BYTES, Flash, SECTOR, numbered};
use thermal_display::settings::{Kept, Store};

fn erased() -> Cells {
    Cells::new(vec![0xff; BYTES])
}

fn store<const FINGERS: usize>(cells: Cells) -> (Store<Flash, FINGERS>, Flash) {
    let flash = Flash::new(cells);
    (Store::new(flash.clone()), flash)
}

/// What a device finds that is switched on with these cells.
fn loaded<const FINGERS: usize>(cells: &Cells) -> Option<[Kept; FINGERS]> {
    store(cells.clone()).0.load().expect("valid settings")
}

/// Saves, and the cells afterwards: with a cut, of a device that is switched on anew.
fn saved<const FINGERS: usize>(
    cells: &Cells,
    settings: Option<&[Kept; FINGERS]>,
    cut: Option<(u64, u64)>,
) -> Cells {
    let mut cells = cells.clone();
    if let Some((nth, seed)) = cut {
        cells.cut_power_at(nth, seed);
    }
    let (mut store, flash) = store(cells);
    let done = store.save(settings);
    let mut cells = flash.cells();
    assert_eq!(done.is_ok(), cells.is_powered(), "{done:?}");
    cells.power_up();
    cells
}

/// Whether a save has turned to another page: the sector that it begins gets its seal, the one after that loses it.
fn turns(before: &Cells, after: &Cells) -> bool {
    let seals =
        |cells: &Cells| [0, 1, 2].map(|sector| cells.bytes()[sector * SECTOR..][..24].to_vec());
    seals(before) != seals(after)
}

/// What a campaign has tried.
#[derive(Debug, Default)]
struct Tried {
    saves: u32,
    turns: u32,
    cuts: u64,
    cuts_of_turns: u64,
}

/// Saves one setting after the other. Power is cut in all operations of the saves that turn to another page, and of every
/// `stride`th: what was stored before is still there, or what was to be; and the next save works, though power is cut
/// in that, too.
fn campaign<const FINGERS: usize>(saves: u32, stride: u32) -> Tried {
    let mut cells = erased();
    let mut tried = Tried::default();
    let mut before = None;
    for number in 0..saves {
        let settings = numbered::<FINGERS>(number);
        let settings = settings.as_ref();
        let after = saved(&cells, settings, None);
        assert_eq!(loaded(&after).as_ref(), settings, "save {number}");
        let operations = after.operations() - cells.operations();
        let turns = turns(&cells, &after);
        tried.saves += 1;
        tried.turns += u32::from(turns);
        if turns || number % stride == 0 {
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
                assert!(
                    later == found || later == next,
                    "save {number}, cut in {nth}, then again"
                );
                let healed = saved(&again, next.as_ref(), None);
                assert_eq!(
                    loaded::<FINGERS>(&healed),
                    next,
                    "save {number}, cut in {nth}, then again"
                );
                tried.cuts += 1;
                tried.cuts_of_turns += u64::from(turns);
            }
        }
        cells = after;
        before = settings.copied();
    }
    tried
}

#[test]
fn one_fingers_settings_survive_a_cut_in_any_operation() {
    let tried = campaign::<1>(230, 12);
    assert_figure("storage.cuts_one", tried.cuts as f64);
    assert!(tried.turns >= 5, "{tried:?}");
}

#[test]
fn five_fingers_settings_survive_a_cut_in_any_operation() {
    let tried = campaign::<5>(45, 20);
    assert_figure("storage.cuts_five", tried.cuts as f64);
    assert!(tried.turns >= 5, "{tried:?}");
}

#[test]
fn settings_can_be_stored_whatever_byte_of_the_flash_is_damaged() {
    // After 40 saves a sector is full and closed, the next is in use, and the third is empty.
    let cells = (0..40).fold(erased(), |cells, number| {
        saved::<1>(&cells, numbered(number).as_ref(), None)
    });
    let next = numbered(200);
    // Seals of all sectors, and every so often what is between them.
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
