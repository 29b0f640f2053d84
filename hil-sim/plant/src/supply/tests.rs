//! The node against the exponential of its bleeder and against Ohm's law.

use super::*;

const STEP_S: f64 = 1e-3;

fn after(supply: &mut Supply, ms: u32, latched: bool, bridge_a: f64) -> f64 {
    for _ in 0..ms {
        supply.step(STEP_S, 12.0, latched, bridge_a);
    }
    supply.node_v()
}

fn on() -> Supply {
    let mut supply = Supply::new(SupplyParams::NOMINAL);
    assert_eq!(supply.node_v(), 0.0, "off at power-on");
    let node_v = after(&mut supply, 5, false, 0.0);
    assert!((node_v - 12.0).abs() < 0.001, "{node_v}");
    supply
}

/// 12 V exp(-20/18) = 3.95 V, less the charge that the driver takes: about 0.7 V.
#[test]
fn a_latched_switch_leaves_less_than_6_v_after_20_ms() {
    let node_v = after(&mut on(), 20, true, 0.0);
    assert!((3.0..3.9).contains(&node_v), "{node_v}");
}

#[test]
fn a_shorted_switch_leaves_12_v() {
    let mut supply = on();
    supply
        .set_defects(&SupplyDefects { switch: SwitchDefect::Shorted, ..SupplyDefects::default() });
    assert!(after(&mut supply, 20, true, 0.0) > 11.9);
}

/// 45 milliohm at 4 A.
#[test]
fn a_current_lowers_the_voltage_by_ohms_law() {
    let node_v = after(&mut on(), 1, false, 4.0);
    assert!((node_v - 11.82).abs() < 0.001, "{node_v}");
}

/// 120 uF at 12 V hold 1.4 mC.
#[test]
fn an_emergency_stop_ends_a_current_at_once_and_leaves_an_idle_supply_to_the_driver() {
    let stopped = SupplyDefects { emergency_stop: true, ..SupplyDefects::default() };
    let mut driving = on();
    driving.set_defects(&stopped);
    assert_eq!(after(&mut driving, 1, false, 4.0), 0.0);
    let mut idle = on();
    idle.set_defects(&stopped);
    let node_v = after(&mut idle, 20, false, 0.0);
    assert!((10.6..11.0).contains(&node_v), "{node_v}");
    assert!(idle.driver_is_on());
}

/// 12 V are 2.79 V at the pin.
#[test]
fn the_sense_divider_reads_3464_counts_at_12_v_and_none_with_an_open_wire() {
    let mut supply = on();
    assert!((supply.sensed_counts() - 3464.0).abs() < 1.0);
    supply.set_defects(&SupplyDefects { sense_open: true, ..SupplyDefects::default() });
    assert_eq!(supply.sensed_counts(), 0.0);
}
