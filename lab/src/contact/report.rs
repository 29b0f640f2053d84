//! What a measurement of a contact law says.

use contact_law_fit::{FORCES_N, Fit, Interval, Measurement};
use contact_model::contact_law::ContactLaw;
use contact_model::material::SKIN;
use contact_model::pressure::pressure_pa;
use contact_model::reference::conductance_at_hardness;
use serde::Serialize;
use thermal_client::client::StationRequest;

/// The contact law of a person, as it is printed and written.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Code of the person.
    pub code: String,
    /// The line that tells a device of the law.
    pub line: String,
    /// Exponent, and its interval of 95 %.
    pub exponent: f64,
    exponent_95: [f64; 2],
    /// Microhardness, Pa.
    pub hardness_pa: f64,
    /// Conductance of the gap, W/(m² K), and its interval; 0 if none was taken.
    pub gap_w_m2k: f64,
    gap_95_w_m2k: [f64; 2],
    /// Skin and room before contact, °C.
    skin_c: f64,
    room_c: f64,
    /// Typical deviation of the force from that which was asked, %.
    force_deviation_percent: f64,
    /// Root of the mean square of what the fit leaves, K.
    residual_k: f64,
    /// The resistance at each force.
    pub resistance: Vec<Resistance>,
}

/// Contact resistance at a force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Resistance {
    /// Force, N.
    pub force_n: f64,
    /// Resistance, m² K/W, and its interval of 95 %.
    pub m2k_w: f64,
    pub(super) m2k_w_95: [f64; 2],
    /// That of Eq. 6-8, m² K/W, and the deviation from it, %.
    equation_6_8_m2k_w: f64,
    deviation_percent: f64,
}

/// An interval wider than this part of R says that the finger rolled or that the force was not followed.
const WIDE: f64 = 0.2;

impl Report {
    /// The report of a person's measurement.
    pub fn new(code: &str, measurement: &Measurement, fit: &Fit) -> Self {
        let recording = &measurement.recording;
        let at_hardness_w_m2k = conductance_at_hardness::<f64>(&SKIN.surface, &recording.display);
        let resistance = |index: usize| {
            let force_n = FORCES_N[index];
            let conductance =
                ContactLaw::NOMINAL.conductance_w_m2k(at_hardness_w_m2k, pressure_pa(force_n));
            let m2k_w = fit.resistances_m2k_w[index];
            Resistance {
                force_n,
                m2k_w,
                m2k_w_95: ends(&fit.resistance_intervals_m2k_w[index]),
                equation_6_8_m2k_w: 1.0 / conductance,
                deviation_percent: 100.0 * (m2k_w * conductance - 1.0),
            }
        };
        Self {
            code: code.into(),
            line: StationRequest::contact_law(fit.law).to_string(),
            exponent: fit.law.exponent,
            exponent_95: ends(&fit.exponent_interval),
            hardness_pa: fit.law.hardness_pa,
            gap_w_m2k: fit.law.gap_w_m2k,
            gap_95_w_m2k: ends(&fit.gap_interval_w_m2k),
            skin_c: recording.skin_c,
            room_c: recording.room_c,
            force_deviation_percent: measurement.force_tracking.deviation_percent,
            residual_k: fit.residual_k,
            resistance: (0..FORCES_N.len()).map(resistance).collect(),
        }
    }

    /// Lines for a terminal, with the line to send as the last one.
    pub fn text(&self) -> String {
        let mut text =
            String::from("force, N   R, 1e-6 m2 K/W   95 %            Eq. 6-8   deviation\n");
        for one in &self.resistance {
            let [low, high] = one.m2k_w_95.map(|end| 1e6 * end);
            text += &format!(
                "{:8}   {:13.0}   {:15} {:7.0}   {:+7.0} %\n",
                one.force_n,
                1e6 * one.m2k_w,
                format!("{low:.0} to {high:.0}"),
                1e6 * one.equation_6_8_m2k_w,
                one.deviation_percent
            );
        }
        let [low, high] = self.exponent_95;
        text += &format!("exponent {:.3}, {low:.3} to {high:.3}\n", self.exponent);
        let [low, high] = self.gap_95_w_m2k;
        text += &if self.gap_w_m2k > 0.0 {
            format!("gap {:.0} W/(m2 K), {low:.0} to {high:.0}\n", self.gap_w_m2k)
        } else {
            "no gap\n".into()
        };
        text += &format!(
            "the force was typically off its target by {:.0} %\n",
            self.force_deviation_percent
        );
        let is_wide = |one: &Resistance| one.m2k_w_95[1] - one.m2k_w_95[0] > WIDE * one.m2k_w;
        if self.resistance.iter().any(is_wide) {
            text +=
                "an interval is wider than 20 % of R: repeat, after three minutes in still air\n";
        }
        text + &self.line + "\n"
    }
}

fn ends(interval: &Interval) -> [f64; 2] {
    [interval.low, interval.high]
}
