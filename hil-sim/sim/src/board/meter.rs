//! What meters and the oscilloscope show.

use thermal_client::commissioning::MeterPoint;

use super::BoardBench;
use crate::World;

/// 12 V terminals to ground, and the tile's terminals, without power, ohm.
const REGULATOR_OHM: f64 = 47e3;
const TERMINALS_OHM: f64 = 100e3;
/// 3.3 V rail to ground without power, ohm.
const RAIL_OHM: f64 = 2000.0;
/// What the open contact of the emergency stop has beside it, ohm.
const OPEN_CONTACT_OHM: f64 = 1e6;
/// What a pin without a pull-down floats to, V.
const FLOATING_V: f64 = 1.1;
/// Voltage at the current input per ampere: 400 counts of 4096 at 3.3 V.
const MIRROR_V_A: f64 = 400.0 * 3.3 / 4096.0;
/// RMS value of a triangle by its peak.
const TRIANGLE_RMS: f64 = 0.577_350_269_189_625_8;

/// What is shown at a point, in its [unit](MeterPoint::unit).
pub fn value(bench: &BoardBench, point: MeterPoint, world: &World) -> f64 {
    let (board, connected) = (&bench.board, &bench.connected);
    let wiring = &board.wiring;
    let powered = |volt: f64| if connected.supply { volt } else { 0.0 };
    // The only pins that are looked at by a volt meter are those that the microcontroller in reset leaves alone.
    let held = |ohm: f64| if ohm.is_finite() { 0.0 } else { FLOATING_V };
    let pulse = world.pulse();
    match point {
        MeterPoint::OhmPlate => wiring.plate_ohm,
        MeterPoint::OhmSupply => REGULATOR_OHM,
        MeterPoint::OhmBridgeSupply => wiring.sense_ohm,
        MeterPoint::OhmTile => TERMINALS_OHM,
        MeterPoint::OhmIn1 => wiring.in1_ohm,
        MeterPoint::OhmIn2 => wiring.in2_ohm,
        MeterPoint::OhmEnable => wiring.enable_ohm,
        MeterPoint::OhmBoot0 => wiring.boot0_ohm,
        MeterPoint::OhmTest => wiring.test_ohm,
        MeterPoint::OhmSide => wiring.side_to_ground_ohm(RAIL_OHM),
        MeterPoint::OhmNfault => wiring.nfault_ohm,
        MeterPoint::OhmFuse => wiring.fuse_ohm,
        MeterPoint::OhmStop if connected.stop && !board.stop_is_bypassed => OPEN_CONTACT_OHM,
        MeterPoint::OhmStop => wiring.stop_ohm,
        MeterPoint::VoltSupply => powered(wiring.supply_v),
        MeterPoint::Volt5 => powered(wiring.rail_5_v),
        MeterPoint::Volt3 => powered(wiring.rail_3_v),
        MeterPoint::VoltCold => powered(wiring.taps_v()[0]),
        MeterPoint::VoltHot => powered(wiring.taps_v()[1]),
        MeterPoint::VoltBridgeSupply => world.plant().supply_v(),
        MeterPoint::VoltIn1 => held(wiring.in1_ohm),
        MeterPoint::VoltIn2 => held(wiring.in2_ohm),
        MeterPoint::VoltEnable => held(wiring.enable_ohm),
        MeterPoint::VoltTest => held(wiring.test_ohm),
        MeterPoint::VoltBoot0 => held(wiring.boot0_ohm),
        MeterPoint::AmpereSupply => powered(wiring.idle_a),
        MeterPoint::ScopeLoadVolt => pulse.mean_v,
        MeterPoint::ScopeLoadRipple => pulse.ripple_v,
        MeterPoint::ScopeMirrorRipple => {
            let share = board.params.sensors.mirror.ripple_share(board.params.bridge.pwm_hz);
            MIRROR_V_A * share * pulse.inductor_half_a * TRIANGLE_RMS
        }
    }
}
