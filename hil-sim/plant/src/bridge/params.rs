//! Parameters of the power stage.

/// Driver, MOSFETs, filter and supply of one bridge: a DRV8702-Q1 with four BSC035N04LS G, as in `hardware/bridge.cir`.
///
/// Tolerances and sources are in [`parameters`](crate::parameters). No value was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgeParams {
    /// Supply, V.
    pub supply_v: f64,
    /// PWM frequency, Hz; that of the firmware for one finger, 180 MHz by 1856 steps. Five fingers have one of their own.
    pub pwm_hz: f64,
    /// Time for which both switches of a leg are off at each edge, s, 0 to half a period.
    pub dead_time_s: f64,
    /// Forward voltage of the MOSFETs' body diodes, V.
    pub diode_v: f64,
    /// On resistance of two MOSFETs (7 milliohm, a third more when hot), sense resistor and leads to the tile, ohm.
    pub on_ohm: f64,
    /// Filter inductors of both legs, H.
    pub filter_h: f64,
    /// Resistance of both inductors, ohm.
    pub filter_ohm: f64,
    /// Filter capacitor across the tile, F; a ceramic capacitor loses capacitance under DC bias.
    pub filter_f: f64,
    /// Series resistance of the capacitor, ohm.
    pub filter_esr_ohm: f64,
    /// Overcurrent trip level of a switch, A.
    pub trip_a: f64,
    /// Retry time after an overcurrent trip, s.
    pub retry_s: f64,
}

impl BridgeParams {
    /// Values of the reference design.
    pub const NOMINAL: Self = Self {
        supply_v: 12.0,
        pwm_hz: 180e6 / 1856.0,
        dead_time_s: 0.16e-6,
        diode_v: 0.9,
        on_ohm: 0.04,
        filter_h: 9.4e-6,
        filter_ohm: 0.01,
        filter_f: 10e-6,
        filter_esr_ohm: 0.003,
        trip_a: 49.0,
        retry_s: 3e-3,
    };
}
