//! Parameters of the heat-flux sensor, which are those of the error budget in `docs/flux.md`.

use super::Source::{Design, Estimate, Netlist};
use super::entry::{Entry, entry, prefixed};
use super::tolerance::{FIXED, absolute, relative};
use crate::sensors::FluxParams;

pub fn entries(flux: &mut FluxParams) -> impl Iterator<Item = Entry<'_>> {
    let FluxParams { gain_error, zero_w_m2, noise_w_m2, lag_s, resistance_m2k_w, counts_per_w_m2 } =
        flux;
    let all = [
        entry!(
            gain_error,
            "1",
            "error of the gain after calibration on a phantom",
            absolute(0.03).normal(),
            (-0.5, 0.5),
            Estimate("error budget; 1.5 % is one standard deviation"),
        ),
        entry!(
            zero_w_m2,
            "W/m2",
            "flux that it reads without any, after its zero was taken",
            absolute(7.0).normal(),
            (-500.0, 500.0),
            Estimate("error budget; 3.5 W/m2 is one standard deviation"),
        ),
        entry!(
            noise_w_m2,
            "W/m2",
            "standard deviation of one conversion before quantisation",
            relative(0.3),
            (0.0, 1000.0),
            Netlist,
        ),
        entry!(
            lag_s,
            "s",
            "lag of its layer and its filter",
            relative(0.2).normal(),
            (1e-4, 10.0),
            Netlist,
        ),
        entry!(
            resistance_m2k_w,
            "m2 K/W",
            "thermal resistance of its layer, between display and skin",
            relative(0.1).normal(),
            (0.0, 1e-2),
            Design,
        ),
        entry!(counts_per_w_m2, "counts/(W/m2)", "gain", FIXED, (1e-4, 10.0), Netlist,),
    ];
    prefixed("flux", all)
}
