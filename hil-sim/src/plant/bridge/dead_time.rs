//! What the mean current loses in the dead times.
//!
//! At each edge of a switching leg both its switches are off for a moment, and a diode carries the inductor's
//! current: where it flows with the pulses, they begin late and end on time; where it flows against them they begin
//! on time and end late. So the mean voltage loses `(V + 2 Vf) td/T` or gains as much, and where the ripple takes
//! the current through zero within each period, it does neither.
//!
//! ```text
//!           i > 0       crossing       i < 0
//! late     |--td        |              |
//! begin    |  ______    |________      |________
//!          |_|      |_  |        |_    |        |--td late end
//! ```
//!
//! An inductor current that reaches zero within a dead time stays there until a switch turns on: the leg then
//! floats at the tile's voltage. Between the three cases the loss follows straight lines through the currents at
//! which it does so for the whole of a dead time.

use super::BridgeParams;

/// Pulses of one switching leg. Voltages and currents count along them.
#[derive(Clone, Copy, Debug)]
pub struct Pulses {
    /// Part of the period that the inputs ask for, above 0, below 1.
    pub width: f64,
    /// The tile's Seebeck voltage, V.
    pub seebeck_v: f64,
    /// Everything that the mean current passes, ohm.
    pub ohm: f64,
}

/// Peak-to-peak ripple of the inductor's current, A, for pulses of a part of the period: a triangle, since the
/// filter keeps the tile's voltage nearly constant.
pub fn inductor_ripple_a(params: &BridgeParams, width: f64) -> f64 {
    params.supply_v * width * (1.0 - width) / (params.filter_h * params.pwm_hz)
}

/// Mean current of the pulses, A.
pub fn mean_current_a(params: &BridgeParams, pulses: &Pulses) -> f64 {
    let drive_v = params.supply_v * pulses.width - pulses.seebeck_v;
    let corners = corners(params, pulses.width);
    // What drives the current, less what it costs, falls along the corners.
    let left_v = |&(at_a, lost_v): &(f64, f64)| drive_v - lost_v - pulses.ohm * at_a;
    let [first, .., last] = corners;
    if left_v(&first) <= 0.0 {
        return (drive_v - first.1) / pulses.ohm;
    }
    for pair in corners.windows(2) {
        let (before_v, after_v) = (left_v(&pair[0]), left_v(&pair[1]));
        if after_v <= 0.0 {
            let part = before_v / (before_v - after_v);
            return pair[0].0 + part * (pair[1].0 - pair[0].0);
        }
    }
    (drive_v - last.1) / pulses.ohm
}

/// Corners of the mean voltage lost, V, over the mean current, A; both rise. Before the first and after the last the
/// loss is constant.
fn corners(params: &BridgeParams, width: f64) -> [(f64, f64); 6] {
    let (supply_v, diode_v) = (params.supply_v, params.diode_v);
    let dead = params.dead_time_s * params.pwm_hz;
    // A pulse cannot lose more than itself, nor gain more than the pause.
    let (lost, gained) = (dead.min(width), dead.min(1.0 - width));
    let per_v = 1.0 / (params.filter_h * params.pwm_hz);
    let drops_v = diode_v * dead;
    let half_ripple_a = |width: f64| 0.5 * inductor_ripple_a(params, width);
    let half_floating_a = |width: f64, tile_v: f64| 0.5 * (supply_v - tile_v) * width * per_v * (1.0 - dead);

    // Where the current touches zero: with the pulses, and floating for a whole dead time before they begin.
    let with = (
        half_ripple_a(width - lost),
        supply_v * lost + diode_v * (lost + dead),
    );
    let tile_v = supply_v * (width - lost) / (1.0 - dead);
    let floating_before = (
        half_floating_a(width - lost, tile_v),
        (supply_v - tile_v) * lost + drops_v.min(supply_v * (width - lost)),
    );
    // Likewise against the pulses, and after they end.
    let against = (
        -half_ripple_a(width + gained),
        -supply_v * gained - diode_v * (gained + dead),
    );
    let tile_v = (supply_v * width / (1.0 - dead)).min(supply_v);
    let floating_after = (-half_floating_a(width, tile_v), -tile_v * gained - drops_v);
    // Where it crosses within the pulses, and still flows in the diode at the end of each dead time.
    let crossing_a = half_ripple_a(width);
    let from_a = (diode_v + supply_v * width) * dead * per_v - crossing_a;
    let to_a = crossing_a - (diode_v + supply_v * (1.0 - width)) * dead * per_v;
    let middle_a = 0.5 * (from_a + to_a);

    let mut corners = [
        against,
        floating_after,
        (from_a.min(middle_a), 0.0),
        (to_a.max(middle_a), 0.0),
        floating_before,
        with,
    ];
    // With ripple smaller than what a dead time changes, cases are passed over.
    for k in 1..corners.len() {
        corners[k].0 = corners[k].0.max(corners[k - 1].0);
    }
    corners
}
