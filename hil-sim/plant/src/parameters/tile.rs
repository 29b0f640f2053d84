//! Parameters of the tile.

use super::Source::{ClassValue, Literature, Thesis};
use super::entry::{Entry, entry, prefixed};
use super::tolerance::{FIXED, between, factor, relative};
use crate::tile::TileParams;

/// Module and heat capacities have tolerances of 10 %, since no data sheet of the thesis's module was found; the range of
/// the coolant gives sink temperatures of 20 to 40 deg C in a room of 24 deg C.
pub fn entries(tile: &mut TileParams) -> impl Iterator<Item = Entry<'_>> {
    let TileParams {
        imax_a,
        vmax_v,
        dtmax_k,
        qmax_w,
        sheet_hot_c,
        variation,
        legs_j_k,
        tabs_j_k,
        plate_m,
        ceramic_m,
        ceramic_w_mk,
        ceramic_j_m3k,
        patch_m2,
        film_w_m2k,
        paste_w_k,
        sink_j_k,
        sink_k_w,
        coolant_k,
    } = tile;
    let all = [
        entry!(
            imax_a,
            "A",
            "current of the largest temperature difference",
            relative(0.1),
            (0.5, 30.0),
            ClassValue,
        ),
        entry!(
            vmax_v,
            "V",
            "voltage at that current and difference",
            relative(0.1),
            (0.5, 60.0),
            ClassValue,
        ),
        entry!(
            dtmax_k,
            "K",
            "largest temperature difference",
            relative(0.1),
            (20.0, 90.0),
            ClassValue,
        ),
        entry!(
            qmax_w,
            "W",
            "largest heat pumped, as the data sheet has it; the plant follows from the other three",
            FIXED,
            (0.1, 500.0),
            ClassValue,
        ),
        entry!(
            sheet_hot_c,
            "C",
            "temperature of the hot side in the data sheet",
            FIXED,
            (0.0, 100.0),
            ClassValue,
        ),
        entry!(
            variation,
            "1",
            "variation of the legs' properties with temperature: 1 that of bismuth telluride, 0 none",
            FIXED,
            (0.0, 1.0),
            Literature,
        ),
        entry!(
            legs_j_k,
            "J/K",
            "heat capacity of the legs",
            relative(0.1),
            (0.01, 100.0),
            ClassValue,
        ),
        entry!(
            tabs_j_k,
            "J/K",
            "heat capacity of one side's copper tabs",
            relative(0.1),
            (0.01, 100.0),
            ClassValue,
        ),
        entry!(plate_m, "m", "edge of the square plates", relative(0.01), (0.016, 0.2), ClassValue,),
        entry!(ceramic_m, "m", "thickness of one plate", relative(0.1), (1e-4, 0.01), ClassValue,),
        entry!(
            ceramic_w_mk,
            "W/(m K)",
            "conductivity of the plates",
            relative(0.15),
            (0.5, 500.0),
            ClassValue,
        ),
        entry!(
            ceramic_j_m3k,
            "J/(m3 K)",
            "heat capacity of the plates",
            relative(0.1),
            (5e5, 1e7),
            ClassValue,
        ),
        entry!(
            patch_m2,
            "m2",
            "part of the display plate that a finger can touch",
            FIXED,
            (182.1e-6, 0.01),
            Thesis("6.4.2"),
        ),
        entry!(
            film_w_m2k,
            "W/(m2 K)",
            "film of air on the display plate, radiation included",
            relative(0.5),
            (0.0, 1000.0),
            ClassValue,
        ),
        entry!(
            paste_w_k,
            "W/K",
            "conductance from the hot plate to the sink",
            factor(2.0),
            (0.1, 1e4),
            ClassValue,
        ),
        entry!(sink_j_k, "J/K", "heat capacity of the sink", relative(0.1), (1.0, 1e5), ClassValue,),
        entry!(
            sink_k_w,
            "K/W",
            "from the sink to what cools it",
            factor(2.0),
            (0.001, 100.0),
            ClassValue,
        ),
        entry!(
            coolant_k,
            "K",
            "coolant above the room: a fan has 0, a chiller less, a warm case more",
            between(-4.0, 16.0),
            (-40.0, 60.0),
            ClassValue,
        ),
    ];
    prefixed("tile", all)
}
