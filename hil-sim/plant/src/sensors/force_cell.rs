//! The load cell under the display: the display's stack is a mass, the cell a spring, and its fan shakes them.

use std::f64::consts::TAU;

/// Stack and load cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceCellParams {
    /// Mass of what rests on the cell: plate, module, sink and fan, kg.
    pub mass_kg: f64,
    /// Deflection of the cell per newton, m/N; 0 is a rigid cell, which shows each force at once.
    pub compliance_m_n: f64,
    /// Damping of the resonance relative to the critical one, below 1.
    pub damping: f64,
    /// Amplitude of the fan's vibration in the cell's force, N, with what the resonance makes of it.
    pub vibration_n: f64,
    /// Frequency of the vibration, Hz: revolutions of the fan.
    pub vibration_hz: f64,
    /// Drift of the cell's zero, N/s, by temperature and creep.
    pub drift_n_s: f64,
    /// Where the drift ends, N.
    pub drift_max_n: f64,
}

impl ForceCellParams {
    /// Angular frequency of the undamped resonance, rad/s; infinite for a rigid cell.
    fn resonance_rad_s(&self) -> f64 {
        (self.compliance_m_n * self.mass_kg).sqrt().recip()
    }
}

/// The force that the cell's strain gauges see.
#[derive(Clone, Copy, Debug)]
pub struct ForceCell {
    params: ForceCellParams,
    /// Force of the spring, N, and its rate, N/s.
    spring_n: f64,
    spring_n_s: f64,
    time_s: f64,
    /// Length of the last step, s, and what it makes of deviation and rate of the spring's force: the solution of the
    /// oscillator's equation for a constant force.
    step_s: f64,
    transition: [[f64; 2]; 2],
}

impl ForceCell {
    /// A cell at rest under a force, N.
    pub const fn new(params: ForceCellParams, force_n: f64) -> Self {
        Self {
            params,
            spring_n: force_n,
            spring_n_s: 0.0,
            time_s: 0.0,
            step_s: 0.0,
            transition: [[1.0, 0.0], [0.0, 1.0]],
        }
    }

    /// Force of the strain gauges, N, after a step, s, under a constant force, N.
    pub fn step(&mut self, step_s: f64, force_n: f64) -> f64 {
        let Self { params, .. } = *self;
        self.time_s += step_s;
        if params.compliance_m_n == 0.0 {
            self.spring_n = force_n;
        } else {
            self.set_step(step_s);
            let [deviation, rate] = self
                .transition
                .map(|[of, by]| of * (self.spring_n - force_n) + by * self.spring_n_s);
            (self.spring_n, self.spring_n_s) = (force_n + deviation, rate);
        }
        let drift_n = params.drift_n_s * self.time_s;
        let vibration_n = if params.vibration_n == 0.0 {
            0.0
        } else {
            params.vibration_n * (TAU * params.vibration_hz * self.time_s).sin()
        };
        self.spring_n + vibration_n + drift_n.clamp(-params.drift_max_n, params.drift_max_n)
    }

    fn set_step(&mut self, step_s: f64) {
        if self.step_s == step_s {
            return;
        }
        self.step_s = step_s;
        let (natural, damping) = (self.params.resonance_rad_s(), self.params.damping);
        let damped = natural * (1.0 - damping * damping).sqrt();
        let (sin, cos) = (damped * step_s).sin_cos();
        let decay = (-damping * natural * step_s).exp();
        let ratio = damping * natural / damped;
        self.transition = [
            [decay * (cos + ratio * sin), decay * sin / damped],
            [-decay * natural * natural / damped * sin, decay * (cos - ratio * sin)],
        ];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELL: ForceCellParams = ForceCellParams {
        mass_kg: 0.5,
        compliance_m_n: 3e-5,
        damping: 0.03,
        vibration_n: 0.0,
        vibration_hz: 50.0,
        drift_n_s: 0.0,
        drift_max_n: 0.15,
    };

    /// `m x'' + d x' + x / c = F`, integrated in steps of 1 us by the Verlet method, which is not the solution that the cell uses.
    #[test]
    fn it_moves_as_the_equation_of_a_damped_oscillator_says() {
        let ForceCellParams { mass_kg, compliance_m_n, damping, .. } = CELL;
        let damping_ns_m = 2.0 * damping * (mass_kg / compliance_m_n).sqrt();
        let mut cell = ForceCell::new(CELL, 0.0);
        let (mut way_m, mut speed_m_s) = (0.0, 0.0);
        for tick in 0..200 {
            let force_n = if tick < 90 { 2.0 } else { -0.3 };
            for _ in 0..1000 {
                let acceleration = |way_m: f64, speed_m_s: f64| {
                    (force_n - way_m / compliance_m_n - damping_ns_m * speed_m_s) / mass_kg
                };
                let half_m_s = speed_m_s + 0.5e-6 * acceleration(way_m, speed_m_s);
                way_m += 1e-6 * half_m_s;
                speed_m_s = half_m_s + 0.5e-6 * acceleration(way_m, half_m_s);
            }
            let shown_n = cell.step(1e-3, force_n);
            assert!((shown_n - way_m / compliance_m_n).abs() < 1e-4, "tick {tick}: {shown_n} N");
        }
    }

    /// 0.5 kg on 3e-5 m/N: 41.09 Hz, and a damping of 0.03 leaves `e^(-2 pi 0.03)` after a period.
    #[test]
    fn it_rings_at_its_resonance_and_decays() {
        let step_s = 1e-5;
        let mut cell = ForceCell::new(CELL, 1.0);
        let shown: Vec<f64> = (0..20_000).map(|_| cell.step(step_s, 0.0)).collect();
        let falls: Vec<usize> =
            (1..shown.len()).filter(|&k| shown[k - 1] > 0.0 && shown[k] <= 0.0).collect();
        let period_s = (falls[4] - falls[0]) as f64 * step_s / 4.0;
        assert!((period_s.recip() - 41.09).abs() < 0.1, "{} Hz", period_s.recip());
        let peak = |period: usize| {
            shown[falls[period]..falls[period + 1]].iter().fold(0.0f64, |most, n| most.max(*n))
        };
        assert!((peak(1) / peak(0) - (-TAU * 0.03f64).exp()).abs() < 0.005);
    }

    #[test]
    fn a_rigid_cell_shows_the_force_vibration_and_a_drift_that_ends() {
        let rigid = ForceCellParams {
            compliance_m_n: 0.0,
            vibration_n: 0.05,
            vibration_hz: 100.0,
            drift_n_s: -2e-3,
            ..CELL
        };
        let mut cell = ForceCell::new(rigid, 0.0);
        for ms in 1..100_000 {
            let (t_s, force_n) = (1e-3 * f64::from(ms), if ms > 50 { 2.0 } else { 0.0 });
            let expected_n = force_n + 0.05 * (TAU * 100.0 * t_s).sin() - (2e-3 * t_s).min(0.15);
            assert!((cell.step(1e-3, force_n) - expected_n).abs() < 1e-7, "{t_s} s");
        }
    }
}
