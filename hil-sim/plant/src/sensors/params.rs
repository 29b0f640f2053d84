//! What the sensors are made of.

use super::THERMISTORS;
use super::converter::ConverterParams;
use super::thermistor::ThermistorParams;

/// Force sensor: an amplified transducer with a live zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceParams {
    /// Without force, counts.
    pub zero_counts: f64,
    /// Gain, counts/N.
    pub counts_per_n: f64,
    /// First-order lag of its amplifier, s.
    pub lag_s: f64,
    /// Dead time of its interface, s; whole steps of the plant.
    pub delay_s: f64,
}

impl ForceParams {
    /// Level at a force, N.
    #[must_use]
    pub fn counts(&self, force_n: f64) -> f64 {
        self.zero_counts + self.counts_per_n * force_n
    }
}

/// Current mirror of the driver and its resistor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MirrorParams {
    /// Gain, counts/A: 354 ohm on 1/1100 of the current, the mirror's ratio recalled.
    pub counts_per_a: f64,
    /// Error of the mirror's ratio, fraction.
    pub gain_error: f64,
    /// Current that it shows too much, A. It cannot show less than none.
    pub offset_a: f64,
}

impl MirrorParams {
    /// Level at a current, A.
    #[must_use]
    pub fn counts(&self, mirror_a: f64) -> f64 {
        (self.counts_per_a * (mirror_a * (1.0 + self.gain_error) + self.offset_a)).max(0.0)
    }
}

/// The converter's reference, from which the dividers are fed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceParams {
    /// Voltage, V. Matters to self-heating.
    pub volt: f64,
    /// Its error, fraction. Thermistors are read ratiometrically and do not see it; force and current do.
    pub error: f64,
    /// Part of the time for which the dividers are fed, 0 to 1; all of it, as the reference design has no pin to gate
    /// them with.
    pub excitation_duty: f64,
}

/// Everything between the physical state and the codes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorParams {
    /// Display, second display, sink, skin, room: in the order of [`Channel`](super::Channel).
    pub thermistors: [ThermistorParams; THERMISTORS],
    /// Share of the contact's skin surface in what the skin thermistor at its edge sees, 0 to 1; the rest is the
    /// skin as it was before contact. Section 6.4.3 of the thesis saw 0.05 deg C of 3 to 5 deg C in 10 s, 2 to 3 mm from
    /// the contact; one right on its edge sees more.
    pub skin_sees_contact: f64,
    /// Force sensor.
    pub force: ForceParams,
    /// Current mirror.
    pub mirror: MirrorParams,
    /// Reference.
    pub reference: ReferenceParams,
    /// Converter.
    pub converter: ConverterParams,
}

/// A thermistor bonded to the display.
pub(crate) const BONDED: ThermistorParams = ThermistorParams {
    at_25c_ohm: 10e3,
    beta_k: 3950.0,
    pull_up_ohm: 10e3,
    lag_s: 0.1,
    dissipation_w_k: 8e-3,
    lead_share: 0.002,
};

impl SensorParams {
    /// The reference design's.
    pub const NOMINAL: Self = Self {
        thermistors: [
            BONDED,
            BONDED,
            ThermistorParams {
                lag_s: 1.0,
                ..BONDED
            },
            ThermistorParams {
                lag_s: 0.3,
                dissipation_w_k: 3e-3,
                lead_share: 0.01,
                ..BONDED
            },
            ThermistorParams {
                lag_s: 2.0,
                dissipation_w_k: 1e-3,
                lead_share: 0.0,
                ..BONDED
            },
        ],
        skin_sees_contact: 0.0125,
        force: ForceParams {
            zero_counts: 410.0,
            counts_per_n: 300.0,
            lag_s: 1e-3,
            delay_s: 0.0,
        },
        mirror: MirrorParams {
            counts_per_a: 400.0,
            gain_error: 0.0,
            offset_a: 0.0,
        },
        reference: ReferenceParams {
            volt: 3.3,
            error: 0.0,
            excitation_duty: 1.0,
        },
        converter: ConverterParams::NOMINAL,
    };
}
