//! Time-domain simulation of inductor, capacitor, switches and diodes until the periodic steady state.

use super::super::{BridgeParams, Load};

/// Steps in a PWM period, and number of periods: the slowest time constant of the circuit is about 20 us.
const STEPS: u32 = 10_000;
const PERIODS: u32 = 120;

/// Mean, A, and mean square ripple, A^2, of the tile current, and extremes of the inductor current, A, with leg `a` at the
/// supply and leg `b` at ground for a fraction of each period.
pub fn steady_state(params: &BridgeParams, width: f64, load: &Load) -> [f64; 4] {
    let period_s = params.pwm_hz.recip();
    let step_s = period_s / f64::from(STEPS);
    let series_ohm = params.on_ohm + params.filter_ohm;
    let esr = params.filter_esr_ohm / load.resistance_ohm;
    let (mut inductor_a, mut capacitor_v) = (0.0f64, load.seebeck_v);
    let (mut sum, mut squares) = (0.0, 0.0);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for period in 0..PERIODS {
        for step in 0..STEPS {
            let at_s = (f64::from(step) + 0.5) * step_s;
            let low_side = at_s >= params.dead_time_s && at_s < width * period_s;
            let high_side = at_s >= width * period_s + params.dead_time_s;
            let tile_v = (capacitor_v
                + params.filter_esr_ohm * (inductor_a + load.seebeck_v / load.resistance_ohm))
                / (1.0 + esr);
            let tile_a = (tile_v - load.seebeck_v) / load.resistance_ohm;
            // Voltage across the legs; the inductor's current flows into leg `b`.
            let legs_v = match (low_side, high_side) {
                (true, _) => params.supply_v,
                (_, true) => 0.0,
                _ if inductor_a > 0.0 => -params.diode_v,
                _ if inductor_a < 0.0 => params.supply_v + params.diode_v,
                _ => tile_v.clamp(-params.diode_v, params.supply_v + params.diode_v),
            };
            let next_a =
                inductor_a + step_s / params.filter_h * (legs_v - tile_v - series_ohm * inductor_a);
            let blocked = !low_side && !high_side && next_a * inductor_a < 0.0;
            capacitor_v += step_s / params.filter_f * (inductor_a - tile_a);
            inductor_a = if blocked { 0.0 } else { next_a };
            if period >= PERIODS - 10 {
                sum += tile_a;
                squares += tile_a * tile_a;
                least = least.min(inductor_a);
                most = most.max(inductor_a);
            }
        }
    }
    let count = f64::from(10 * STEPS);
    let mean_a = sum / count;
    [mean_a, squares / count - mean_a * mean_a, least, most]
}
