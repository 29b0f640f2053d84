//! Parameters of the supply of the bridge.

use super::Source::{ClassValue, Design, Netlist, Recalled};
use super::entry::{Entry, entry, prefixed};
use super::tolerance::{between, relative};
use crate::supply::SupplyParams;

pub fn entries(supply: &mut SupplyParams) -> impl Iterator<Item = Entry<'_>> {
    let SupplyParams {
        source_ohm,
        node_f,
        bleeder_ohm,
        driver_a,
        soft_start_v_s,
        driver_from_v,
        sense_counts_per_v,
    } = supply;
    let all = [
        entry!(
            source_ohm,
            "ohm",
            "power supply, fuse, contacts, switch and leads",
            between(0.03, 0.1),
            (0.0, 10.0),
            ClassValue,
        ),
        entry!(node_f, "F", "capacitors behind the switch", relative(0.2), (1e-7, 1e-1), Design,),
        entry!(
            bleeder_ohm,
            "ohm",
            "bleeder, connected while the latch is set",
            relative(0.05),
            (1.0, 1e6),
            Design,
        ),
        entry!(
            driver_a,
            "A",
            "current of the bridge's driver",
            relative(0.3),
            (0.0, 1.0),
            Recalled,
        ),
        entry!(
            soft_start_v_s,
            "V/s",
            "rise of the voltage when the switch closes",
            relative(0.3),
            (1.0, 1e6),
            Netlist,
        ),
        entry!(
            driver_from_v,
            "V",
            "voltage below which the driver turns its outputs off",
            between(5.0, 5.5),
            (0.0, 12.0),
            Recalled,
        ),
        entry!(
            sense_counts_per_v,
            "counts/V",
            "gain of the sense divider",
            relative(0.002),
            (1.0, 4095.0),
            Design,
        ),
    ];
    prefixed("supply", all)
}
