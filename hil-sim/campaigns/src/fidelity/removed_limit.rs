//! Limits of the plant that are removed to show their effect on fidelity.

use thermal_plant::sensors::ConverterParams;
use thermal_sim::named_enum;
use thermal_sim::scene::Sensor;

named_enum! {
    /// A removed limit.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum RemovedLimit {
        /// The converter's noise.
        SensorNoise = "sensor-noise",
        /// The converter's integral non-linearity.
        Inl = "inl",
        /// The lag of both thermistors on the display.
        SensorLag = "sensor-lag",
        /// Coupling of the thermistors to room air through their leads, and of the skin's thermistor to the contact.
        SensorSite = "sensor-site",
        /// Lag of the force sensor.
        ForceLag = "force-lag",
        /// A quarter of the heat capacity of the plates, so that the same power changes their temperature faster.
        Power = "power",
        /// Change of the module's properties with temperature, which a linear model does not identify.
        Identification = "identification",
    }
}

impl RemovedLimit {
    /// The plant parameters, with values, that remove the limit.
    pub fn plant(self) -> Vec<(String, f64)> {
        let keys = |keys: &[(&str, f64)]| {
            keys.iter().map(|(key, value)| ((*key).into(), *value)).collect()
        };
        match self {
            Self::SensorNoise => keys(&[("sensors.converter.noise_counts", DITHER_COUNTS)]),
            Self::Inl => keys(&[("sensors.converter.inl_counts", 0.0)]),
            Self::SensorLag => {
                keys(&[("sensors.display.lag_s", 1e-3), ("sensors.check.lag_s", 1e-3)])
            }
            Self::SensorSite => {
                let leads = Sensor::ALL
                    .map(|sensor| (format!("sensors.{}.lead_share", sensor.name()), 0.0));
                leads.into_iter().chain(keys(&[("sensors.skin_sees_contact", 0.0)])).collect()
            }
            Self::ForceLag => keys(&[("sensors.force.lag_s", 1e-5)]),
            Self::Power => keys(&[("tile.ceramic_j_m3k", 2.3e6)]),
            Self::Identification => keys(&[("tile.variation", 0.0)]),
        }
    }
}

/// Without any noise a converter of 12 bits repeats its codes, which the device takes for a frozen converter
/// and averaging cannot resolve; this much noise is left.
const DITHER_COUNTS: f64 = ConverterParams::NOMINAL.noise_counts / 2.0;

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_plant::{Params, parameters};

    #[test]
    fn every_bound_is_removed_by_possible_values_that_are_not_nominal() {
        for without in RemovedLimit::ALL {
            let mut params = Params::nominal();
            for (key, value) in without.plant() {
                parameters::set(&mut params, &key, value).expect("a key and a possible value");
            }
            assert_ne!(params, Params::nominal(), "{}", without.name());
        }
    }
}
