//! Effect of the dead times on the mean current.
//!
//! At each edge of a switching leg both switches are off for the dead time `td`, and a body diode carries the inductor
//! current. If the current has the sign of the pulses, the pulses begin late and end on time; with the opposite sign
//! they begin on time and end late. The mean voltage falls or rises by `(V + 2 Vf) td/T`. If the ripple makes the
//! current cross zero in each period, the mean voltage is unchanged.
//!
//! ```text
//!           i > 0       crossing       i < 0
//! late     |--td        |              |
//! begin    |  ______    |________      |________
//!          |_|      |_  |        |_    |        |--td late end
//! ```
//!
//! An inductor current that reaches zero within a dead time stays at zero until a switch turns on, and the leg floats
//! at the tile voltage. Between the three cases the voltage loss is interpolated linearly between the currents at which
//! the leg floats for a whole dead time. The inductor current is taken as piecewise linear: with the nominal filter the
//! mean is exact while the current keeps its sign, and has an error of at most 0.03 A around zero.

use super::BridgeParams;

/// Pulses of one switching leg. Voltages and currents are positive in the direction that the pulses drive.
#[derive(Clone, Copy, Debug)]
pub struct Pulses {
    /// Commanded duty cycle, above 0, below 1.
    pub width: f64,
    /// The tile's Seebeck voltage, V.
    pub seebeck_v: f64,
    /// Total resistance of the current path, ohm.
    pub ohm: f64,
}

/// Dead-time model of a bridge.
#[derive(Clone, Copy, Debug)]
pub struct DeadTime {
    supply_v: f64,
    diode_v: f64,
    /// Dead time as a fraction of the period.
    part: f64,
    /// Current change per volt across the inductor and period, A/V.
    per_v: f64,
}

impl DeadTime {
    pub fn new(params: &BridgeParams) -> Self {
        Self {
            supply_v: params.supply_v,
            diode_v: params.diode_v,
            part: params.dead_time_s * params.pwm_hz,
            per_v: 1.0 / (params.filter_h * params.pwm_hz),
        }
    }

    /// Half the peak-to-peak ripple of the inductor current, A, at a duty cycle. The ripple is triangular, since the
    /// filter keeps the tile voltage nearly constant.
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
        // The residual of Ohm's law falls from corner to corner and changes its sign between two of them.
        let residual_v = |(at_a, lost_v): (f64, f64)| drive_v - lost_v - pulses.ohm * at_a;
        let mut before = (to_a, residual_v((to_a, against_v)));
        for corner in self.corners_between(pulses.width, to_a, (from_a, with_v)) {
            let after = (corner.0, residual_v(corner));
            if after.1 <= 0.0 {
                return before.0 + before.1 / (before.1 - after.1) * (after.0 - before.0);
            }
            before = after;
        }
        before.0
    }

    /// Fractions of the period by which a dead time can shorten and lengthen a pulse.
    fn lost_and_gained(&self, width: f64) -> (f64, f64) {
        (self.part.min(width), self.part.min(1.0 - width))
    }

    /// Least mean current that keeps the sign of the pulses throughout a period, A, and its voltage loss, V.
    fn with(&self, width: f64) -> (f64, f64) {
        let (lost, _) = self.lost_and_gained(width);
        let lost_v = self.supply_v * lost + self.diode_v * (lost + self.part);
        let (pulse, pause) = self.rests(width);
        let tile_v = self.supply_v * width - lost_v;
        // Freewheeling to zero, rising to `peak`, freewheeling to `knee`, falling.
        let falls = (self.diode_v + tile_v) * self.part * self.per_v;
        let peak = (self.supply_v - tile_v) * pulse * self.per_v;
        let knee = peak - falls;
        let mean_a =
            falls * self.part + peak * pulse + (peak + knee) * self.part + (knee + falls) * pause;
        (0.5 * mean_a, lost_v)
    }

    /// Largest mean current that opposes the pulses throughout a period, A, and its voltage loss, V.
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

    /// On and off times shortened by one dead time each, as fractions of the period.
    fn rests(&self, width: f64) -> (f64, f64) {
        ((width - self.part).max(0.0), (1.0 - width - self.part).max(0.0))
    }

    /// Corners of the characteristic of voltage loss, V, over mean current, A, above a current; both rise.
    fn corners_between(&self, width: f64, above_a: f64, last: (f64, f64)) -> [(f64, f64); 5] {
        let Self { supply_v, diode_v, part, per_v } = *self;
        let (lost, gained) = self.lost_and_gained(width);
        let drop_v = diode_v * part;
        let (pulse, pause) = self.rests(width);

        // Same sign as the pulses, floating for a whole dead time before they begin: rising to `peak`, freewheeling to
        // `knee`, falling to zero. The volt-seconds of the inductor balance, which gives the tile voltage.
        let end_drop_v = drop_v.min(supply_v * pulse);
        let tile_v = (supply_v * pulse - end_drop_v) / (1.0 - part);
        let peak = (supply_v - tile_v) * pulse * per_v;
        let knee = (peak - (diode_v + tile_v) * part * per_v).max(0.0);
        let floating_before = (
            0.5 * (peak * pulse + (peak + knee) * part + knee * pause),
            (supply_v - tile_v) * lost + end_drop_v,
        );
        // Opposite sign, floating for a whole dead time after the pulses end.
        let tile_v = ((supply_v * width + drop_v) / (1.0 - part)).min(supply_v);
        let knee = (supply_v - tile_v) * pulse * per_v;
        let peak = tile_v * pause * per_v;
        let floating_after = (
            -0.5 * ((peak + knee) * part + knee * pulse + peak * pause),
            -tile_v * gained - drop_v,
        );
        // Zero crossing within the pulses, the current reaching zero at the end of the dead time after or before them.
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
        // If the ripple is smaller than the change in a dead time, some corners do not occur.
        let mut least_a = above_a;
        for (at_a, _) in &mut corners {
            *at_a = at_a.max(least_a);
            least_a = *at_a;
        }
        corners
    }
}
