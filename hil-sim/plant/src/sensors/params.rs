//! Parameters of the sensors.

use super::THERMISTORS;
use super::converter::ConverterParams;
use super::force_cell::ForceCellParams;
use super::thermistor::ThermistorParams;

/// Force sensor: transducer and amplifier with a live zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceParams {
    /// Output without force, counts.
    pub zero_counts: f64,
    /// Gain, counts/N.
    pub counts_per_n: f64,
    /// Time constant of its amplifier, s.
    pub lag_s: f64,
    /// Dead time of its interface, s; rounded to steps of the plant.
    pub delay_s: f64,
    /// The load cell and what rests on it.
    pub cell: ForceCellParams,
}

impl ForceParams {
    /// Output at a force, N, in counts.
    pub fn counts(&self, force_n: f64) -> f64 {
        self.zero_counts + self.counts_per_n * force_n
    }
}

/// Current measurement: sense resistors below the legs, filters and amplifiers, whose output does not show the sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MirrorParams {
    /// Gain, counts/A.
    pub counts_per_a: f64,
    /// Error of sense resistors and amplifiers, fraction.
    pub gain_error: f64,
    /// Offset, A; the output is never negative.
    pub offset_a: f64,
    /// Time constant of its filters, s; 0 for a board without them, whose converter sees the ripple.
    pub lag_s: f64,
    /// Phase of the PWM period at which the first scan of a step samples, 0 to 1 from the begin of the pulses.
    pub sampling_phase: f64,
    /// Change of the phase from one scan to the next, periods. The 16 scans of one finger are spread over a period; 0 for
    /// a firmware whose scans are whole numbers of periods apart.
    pub phase_step: f64,
}

impl MirrorParams {
    /// Fraction of the inductors' ripple, at a PWM frequency, Hz, that passes the filters: two poles, with a fifth and four
    /// fifths of the lag.
    pub fn ripple_share(&self, pwm_hz: f64) -> f64 {
        let radians = std::f64::consts::TAU * pwm_hz * self.lag_s;
        (1.0f64.hypot(0.2 * radians) * 1.0f64.hypot(0.8 * radians)).recip()
    }

    /// Output at a current, A, in counts.
    pub fn counts(&self, mirror_a: f64) -> f64 {
        (self.counts_per_a * (mirror_a * (1.0 + self.gain_error) + self.offset_a)).max(0.0)
    }
}

/// Voltage reference of the converter, which also supplies the dividers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceParams {
    /// Voltage, V; determines the self-heating of the thermistors.
    pub volt: f64,
    /// Relative error; it affects force and current, but not the thermistors, which are read ratiometrically.
    pub error: f64,
    /// Duty cycle of the dividers' supply, 0 to 1; 1 in the reference design, which has no pin to switch it.
    pub excitation_duty: f64,
}

/// Parameters of all sensors of a finger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorParams {
    /// Thermistors in the order of [`Channel`](super::Channel): display, second display, sink, skin, room.
    pub thermistors: [ThermistorParams; THERMISTORS],
    /// Time constant of the filters between the dividers and the converter, s. An open or shorted wire acts at once all
    /// the same: it is modelled behind the filter.
    pub divider_lag_s: f64,
    /// Weight of the skin under the contact in the temperature at the skin thermistor on its edge, 0 to 1; the remaining
    /// weight has the skin temperature before contact. Section 6.4.3 of the thesis measured a change of 0.05 deg C, 2 to
    /// 3 mm from a contact that changed by 3 to 5 deg C in 10 s; on the perimeter itself (sections 3.2 and 4.4) it is 0.22
    /// to 0.32.
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
    /// Values of the reference design.
    pub const NOMINAL: Self = Self {
        thermistors: [
            BONDED,
            BONDED,
            ThermistorParams { lag_s: 1.0, ..BONDED },
            ThermistorParams { lag_s: 0.3, dissipation_w_k: 3e-3, lead_share: 0.01, ..BONDED },
            ThermistorParams { lag_s: 2.0, dissipation_w_k: 1e-3, lead_share: 0.0, ..BONDED },
        ],
        divider_lag_s: 0.6e-3,
        skin_sees_contact: 0.0125,
        force: ForceParams {
            zero_counts: 410.0,
            counts_per_n: 300.0,
            lag_s: 1e-3,
            delay_s: 0.0,
            cell: ForceCellParams {
                mass_kg: 0.5,
                compliance_m_n: 0.0,
                damping: 0.03,
                vibration_n: 0.0,
                vibration_hz: 50.0,
                drift_n_s: 0.0,
                drift_max_n: 0.15,
            },
        },
        mirror: MirrorParams {
            counts_per_a: 400.0,
            gain_error: 0.0,
            offset_a: 0.0,
            lag_s: 0.43e-3,
            sampling_phase: 0.0,
            phase_step: 0.0614,
        },
        reference: ReferenceParams { volt: 3.3, error: 0.0, excitation_duty: 1.0 },
        converter: ConverterParams::NOMINAL,
    };
}
