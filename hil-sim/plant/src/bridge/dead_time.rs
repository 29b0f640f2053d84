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
//! which it does so for the whole of a dead time. That takes the inductor's current as made of straight lines: with
//! the nominal filter the mean is exact while the current keeps its sign, and good to 0.03 A around zero.

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

/// The dead times of a bridge.
#[derive(Clone, Copy, Debug)]
pub struct DeadTime {
    supply_v: f64,
    diode_v: f64,
    /// Part of the period that one takes.
    part: f64,
    /// What a volt across the inductor adds to its current in a period, A.
    per_v: f64,
}

impl DeadTime {
    /// Of a bridge.
    pub fn new(params: &BridgeParams) -> Self {
        Self {
            supply_v: params.supply_v,
            diode_v: params.diode_v,
            part: params.dead_time_s * params.pwm_hz,
            per_v: 1.0 / (params.filter_h * params.pwm_hz),
        }
    }

    /// Half the peak-to-peak ripple of the inductor's current, A, for pulses of a part of the period: a triangle,
    /// since the filter keeps the tile's voltage nearly constant.
    pub fn half_ripple_a(&self, width: f64) -> f64 {
        0.5 * self.per_v * self.supply_v * width * (1.0 - width)
    }

    /// Mean current of the pulses, A.
    pub fn mean_current_a(&self, pulses: &Pulses) -> f64 {
        let drive_v = self.supply_v * pulses.width - pulses.seebeck_v;
        let (from_a, with_v) = self.with(pulses.width);
        let with_a = (drive_v - with_v) / pulses.ohm;
        if with_a >= from_a {
            return with_a;
        }
        let (to_a, against_v) = self.against(pulses.width);
        let against_a = (drive_v - against_v) / pulses.ohm;
        if against_a <= to_a {
            return against_a;
        }
        // What drives the current, less what it costs, falls along the corners, from above zero to below.
        let left_v = |(at_a, lost_v): (f64, f64)| drive_v - lost_v - pulses.ohm * at_a;
        let mut before = (to_a, left_v((to_a, against_v)));
        for corner in self.corners_between(pulses.width, to_a, (from_a, with_v)) {
            let after = (corner.0, left_v(corner));
            if after.1 <= 0.0 {
                return before.0 + before.1 / (before.1 - after.1) * (after.0 - before.0);
            }
            before = after;
        }
        before.0
    }

    /// A pulse cannot lose more than itself, nor gain more than the pause.
    fn lost_and_gained(&self, width: f64) -> (f64, f64) {
        (self.part.min(width), self.part.min(1.0 - width))
    }

    /// Mean current from which on it always flows with the pulses, A, and the voltage that it then loses, V.
    fn with(&self, width: f64) -> (f64, f64) {
        let (lost, _) = self.lost_and_gained(width);
        let lost_v = self.supply_v * lost + self.diode_v * (lost + self.part);
        let (pulse, pause) = self.rests(width);
        let tile_v = self.supply_v * width - lost_v;
        // In the diode down to zero, up to `peak`, in the diode to `knee`, down.
        let falls = (self.diode_v + tile_v) * self.part * self.per_v;
        let peak = (self.supply_v - tile_v) * pulse * self.per_v;
        let knee = peak - falls;
        let mean_a =
            falls * self.part + peak * pulse + (peak + knee) * self.part + (knee + falls) * pause;
        (0.5 * mean_a, lost_v)
    }

    /// Mean current up to which it always flows against the pulses, A, and the voltage that it then loses, V.
    fn against(&self, width: f64) -> (f64, f64) {
        let (_, gained) = self.lost_and_gained(width);
        let lost_v = -self.supply_v * gained - self.diode_v * (gained + self.part);
        let (pulse, pause) = self.rests(width);
        let tile_v = self.supply_v * width - lost_v;
        let rises = (self.supply_v + self.diode_v - tile_v) * self.part * self.per_v;
        let peak = tile_v * pause * self.per_v;
        let knee = peak - rises;
        let mean_a =
            rises * self.part + peak * pause + (peak + knee) * self.part + (knee + rises) * pulse;
        (-0.5 * mean_a, lost_v)
    }

    /// What a dead time leaves of a pulse and of a pause.
    fn rests(&self, width: f64) -> (f64, f64) {
        (
            (width - self.part).max(0.0),
            (1.0 - width - self.part).max(0.0),
        )
    }

    /// Corners of the voltage lost, V, over the mean current, A, above a current; both rise to the last.
    fn corners_between(&self, width: f64, above_a: f64, last: (f64, f64)) -> [(f64, f64); 5] {
        let Self {
            supply_v,
            diode_v,
            part,
            per_v,
        } = *self;
        let (lost, gained) = self.lost_and_gained(width);
        let drop_v = diode_v * part;
        let (pulse, pause) = self.rests(width);

        // With the pulses, and floating for a whole dead time before they begin: up to `peak`, in the diode to
        // `knee`, down to zero. What the inductor takes and gives cancels, which tells the tile's voltage.
        let end_drop_v = drop_v.min(supply_v * pulse);
        let tile_v = (supply_v * pulse - end_drop_v) / (1.0 - part);
        let peak = (supply_v - tile_v) * pulse * per_v;
        let knee = (peak - (diode_v + tile_v) * part * per_v).max(0.0);
        let floating_before = (
            0.5 * (peak * pulse + (peak + knee) * part + knee * pause),
            (supply_v - tile_v) * lost + end_drop_v,
        );
        // Against the pulses, and floating for a whole dead time after they end.
        let tile_v = ((supply_v * width + drop_v) / (1.0 - part)).min(supply_v);
        let knee = (supply_v - tile_v) * pulse * per_v;
        let peak = tile_v * pause * per_v;
        let floating_after = (
            -0.5 * ((peak + knee) * part + knee * pulse + peak * pause),
            -tile_v * gained - drop_v,
        );
        // Crossing zero within the pulses, and just reaching it at the end of the dead time after or before them.
        let tile_v = supply_v * width;
        let after = (diode_v + tile_v) * part * per_v;
        let before = (supply_v + diode_v - tile_v) * part * per_v;
        let rise = (supply_v - tile_v) * pulse * per_v;
        let low = before + rise - after;
        let from_a = 0.5 * (after * part - low * pause + (after - low) * width);
        let knee = rise - after;
        let to_a =
            0.5 * (rise * pulse - before * part + (rise + knee) * part + (knee - before) * pause);
        let middle_a = 0.5 * (from_a + to_a);
        let mut corners = [
            floating_after,
            (from_a.min(middle_a), 0.0),
            (to_a.max(middle_a), 0.0),
            floating_before,
            last,
        ];
        // With ripple smaller than what a dead time changes, cases are passed over.
        let mut least_a = above_a;
        for (at_a, _) in &mut corners {
            *at_a = at_a.max(least_a);
            least_a = *at_a;
        }
        corners
    }
}
