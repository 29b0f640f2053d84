//! What the power stage is made of.

/// Driver, filter and supply of one bridge, class DRV8873 in IN/IN mode with its current regulation switched off.
///
/// Tolerances and sources stand in [`parameters`](crate::parameters); the data sheet is SLVSDY7B. Nothing here
/// was measured.
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
    /// Both switches that conduct (nominally 0.15 ohm, more as the driver warms), and the leads to the tile, ohm.
    pub on_ohm: f64,
    /// Filter inductor, H. It does not saturate.
    pub filter_h: f64,
    /// Resistance of the inductor, ohm.
    pub filter_ohm: f64,
    /// Filter capacitor across the tile, F; a ceramic one has less under bias.
    pub filter_f: f64,
    /// Series resistance of the capacitor, ohm.
    pub filter_esr_ohm: f64,
    /// Current at which a switch counts as overloaded, A.
    pub trip_a: f64,
    /// Time after which an overloaded driver tries again, s (data sheet, mode 01b: by itself).
    pub retry_s: f64,
}

impl BridgeParams {
    /// The reference design's.
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
