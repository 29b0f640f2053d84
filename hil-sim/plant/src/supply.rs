//! Supply of the bridge: source, emergency stop, switch that the comparator opens, capacitors, bleeder, sense divider.
//!
//! ```text
//! 12 V -- source resistance -- emergency stop -- switch --+---- bridge
//!                                               latch set |
//!                                               = open    +-- 120 uF, bleeder of 150 ohm while the latch is set
//!                                                         +-- divider, to the converter
//! ```
//!
//! Not modelled: current limit of the source, melting of the fuse, ripple, bounce of the contacts.

/// Parameters of the supply; its voltage is that of the [bridge](crate::bridge::BridgeParams).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupplyParams {
    /// Resistance from the source to the bridge, ohm.
    pub source_ohm: f64,
    /// Capacitance behind the switch, F.
    pub node_f: f64,
    /// Bleeder, ohm.
    pub bleeder_ohm: f64,
    /// Current of the bridge's driver, A.
    pub driver_a: f64,
    /// Rate at which the voltage rises when the switch closes, V/s.
    pub soft_start_v_s: f64,
    /// Voltage below which the driver turns its outputs off, V.
    pub driver_from_v: f64,
    /// Gain of the sense divider, counts/V.
    pub sense_counts_per_v: f64,
}

impl SupplyParams {
    /// Values of the circuit in `hardware/`.
    pub const NOMINAL: Self = Self {
        source_ohm: 0.045,
        node_f: 120e-6,
        bleeder_ohm: 150.0,
        driver_a: 7.5e-3,
        soft_start_v_s: 9e3,
        driver_from_v: 5.2,
        sense_counts_per_v: 4096.0 / 3.3 * 10.0 / 43.0,
    };
}

/// Defect of the switch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SwitchDefect {
    /// No defect.
    #[default]
    None,
    /// It never opens.
    Shorted,
    /// It never closes.
    Open,
}

/// Defects and inputs of the supply; none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SupplyDefects {
    /// The switch.
    pub switch: SwitchDefect,
    /// The emergency stop is pressed.
    pub emergency_stop: bool,
    /// Its sense wire is open, which reads as pressed.
    pub stop_sense_open: bool,
    /// The wire from the sense divider to the converter is open; the pin is at ground.
    pub sense_open: bool,
    /// Resistance of a contact between source and bridge, ohm.
    ///
    /// ```
    /// use thermal_plant::supply::{Supply, SupplyDefects, SupplyParams};
    ///
    /// let mut supply = Supply::new(SupplyParams::NOMINAL);
    /// supply.set_node(12.0);
    /// supply.set_defects(&SupplyDefects { contact_ohm: 0.3, ..SupplyDefects::default() });
    /// supply.step(1e-3, 12.0, false, 4.0);
    /// // 4 A and 7.5 mA through 0.045 and 0.3 ohm.
    /// assert!((supply.node_v() - (12.0 - 0.345 * 4.0075)).abs() < 1e-9);
    /// ```
    pub contact_ohm: f64,
}

/// Voltage behind the switch below which the driver has no supply to pull nFAULT with, V.
const DRIVER_DEAD_BELOW_V: f64 = 2.0;

/// The node behind the switch.
#[derive(Clone, Copy, Debug)]
pub struct Supply {
    params: SupplyParams,
    defects: SupplyDefects,
    node_v: f64,
}

impl Supply {
    /// The supply at power-on, when the latch keeps it off.
    pub const fn new(params: SupplyParams) -> Self {
        Self {
            params,
            defects: SupplyDefects {
                switch: SwitchDefect::None,
                emergency_stop: false,
                stop_sense_open: false,
                sense_open: false,
                contact_ohm: 0.0,
            },
            node_v: 0.0,
        }
    }

    /// Sets the defects.
    pub const fn set_defects(&mut self, defects: &SupplyDefects) {
        self.defects = *defects;
    }

    /// Sets the voltage behind the switch, V.
    pub const fn set_node(&mut self, node_v: f64) {
        self.node_v = node_v;
    }

    /// Advances by a step, s, with a source, V, the comparator's latch, and the current that the bridge takes, A.
    pub fn step(&mut self, step_s: f64, source_v: f64, latched: bool, bridge_a: f64) {
        let closed = match self.defects.switch {
            SwitchDefect::None => !latched,
            SwitchDefect::Shorted => true,
            SwitchDefect::Open => false,
        };
        let p = &self.params;
        if closed && !self.defects.emergency_stop {
            let ohm = p.source_ohm + self.defects.contact_ohm;
            let loaded_v = source_v - ohm * (bridge_a + p.driver_a);
            self.node_v = (self.node_v + p.soft_start_v_s * step_s).min(loaded_v);
            return;
        }
        if latched {
            self.node_v *= (-step_s / (p.bleeder_ohm * p.node_f)).exp();
        }
        self.node_v = (self.node_v - (bridge_a.max(0.0) + p.driver_a) * step_s / p.node_f).max(0.0);
    }

    /// Voltage at the bridge, V.
    pub const fn node_v(&self) -> f64 {
        self.node_v
    }

    /// Whether the voltage is high enough for the driver.
    pub fn driver_is_on(&self) -> bool {
        self.node_v >= self.params.driver_from_v
    }

    /// Whether the driver pulls nFAULT because its supply is too low.
    pub fn driver_reports_low(&self) -> bool {
        !self.driver_is_on() && self.node_v > DRIVER_DEAD_BELOW_V
    }

    /// Voltage that the sense divider shows, V; none if its wire is open.
    pub const fn sensed_v(&self) -> f64 {
        if self.defects.sense_open { 0.0 } else { self.node_v }
    }

    /// Voltage at the converter's pin, counts at a nominal reference.
    pub const fn sensed_counts(&self) -> f64 {
        self.params.sense_counts_per_v * self.sensed_v()
    }
}

#[cfg(test)]
mod tests;
