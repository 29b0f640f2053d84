//! Parameters of the power stage.

/// Driver, filter and supply of one bridge: a DRV8873 in IN/IN mode with current regulation off (data sheet SLVSDY7B).
///
/// Tolerances and sources are in [`parameters`](crate::parameters). No value was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgeParams {
    /// Supply, V.
    pub supply_v: f64,
    /// PWM frequency, Hz.
    pub pwm_hz: f64,
    /// Time for which both switches of a leg are off at each edge, s, 0 to half a period.
    pub dead_time_s: f64,
    /// Forward voltage of the switches' body diodes, V.
    pub diode_v: f64,
    /// On resistance of two switches (nominally 0.15 ohm, more when warm) and of the leads to the tile, ohm.
    pub on_ohm: f64,
    /// Filter inductor, H.
    pub filter_h: f64,
    /// Resistance of the inductor, ohm.
    pub filter_ohm: f64,
    /// Filter capacitor across the tile, F; a ceramic capacitor loses capacitance under DC bias.
    pub filter_f: f64,
    /// Series resistance of the capacitor, ohm.
    pub filter_esr_ohm: f64,
    /// Overcurrent trip level of a switch, A.
    pub trip_a: f64,
    /// Retry time after an overcurrent trip, s (data sheet, mode 01b: automatic retry).
    pub retry_s: f64,
}

impl BridgeParams {
    /// Values of the reference design.
    pub const NOMINAL: Self = Self {
        supply_v: 12.0,
        pwm_hz: 96e3,
        dead_time_s: 0.3e-6,
        diode_v: 0.9,
        on_ohm: 0.17,
        filter_h: 10e-6,
        filter_ohm: 0.02,
        filter_f: 10e-6,
        filter_esr_ohm: 0.005,
        trip_a: 10.0,
        retry_s: 4e-3,
    };
}
