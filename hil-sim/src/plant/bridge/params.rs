//! What the power stage is made of.

/// Driver, filter and supply of one bridge, class DRV8873 in IN/IN mode with its current regulation switched off.
///
/// "Class value" is typical of such parts, "recalled" a figure remembered and not looked up, "data sheet" read in
/// the public one (SLVSDY7B). Nothing here was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgeParams {
    /// Supply, V, above 0; 12 within 5 % (reference design, class value of a supply).
    pub supply_v: f64,
    /// PWM frequency, Hz, above 0; 96000, as exact as the crystal (reference design).
    pub pwm_hz: f64,
    /// Time for which both switches of a leg are off at each edge, s, 0 to half a period; 0.3e-6, from 0.1e-6 to
    /// 0.6e-6 (class value, recalled).
    pub dead_time_s: f64,
    /// Forward voltage of the switches' body diodes, V, 0 or more; 0.9, within 0.2 (class value, recalled).
    pub diode_v: f64,
    /// Both switches that conduct, and the leads to the tile, ohm, 0 or more; 0.15 + 0.02, from 0.12 to 0.30 with
    /// the driver's temperature (data sheet's typical value, recalled).
    pub on_ohm: f64,
    /// Filter inductor, H, above 0; 10e-6 within 20 % (reference design, class tolerance). It does not saturate.
    pub filter_h: f64,
    /// Resistance of the inductor, ohm, 0 or more; 0.02, within 50 % (class value).
    pub filter_ohm: f64,
    /// Filter capacitor across the tile, F, 0 or more; 10e-6, from -50 % (a ceramic one under bias) to 20 %
    /// (reference design, class tolerance).
    pub filter_f: f64,
    /// Series resistance of the capacitor, ohm, 0 or more; 0.005, up to 0.02 (class value).
    pub filter_esr_ohm: f64,
    /// Current at which a switch counts as overloaded, A, above 0; 10, up to 16 (data sheet: at least 10).
    pub trip_a: f64,
    /// Time after which an overloaded driver tries again, s, 0 or more; 4e-3 within 50 % (class value, recalled;
    /// that it retries by itself: data sheet, mode 01b).
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
