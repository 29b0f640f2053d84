//! What fits deviate from the laws of their plants.

use contact_law_fit::{FORCES_N, Fit};
use thermal_plant::Params;

/// The law of a plant's finger.
pub struct Exact {
    /// Contact resistances at [`FORCES_N`], m² K/W.
    pub resistances_m2k_w: [f64; FORCES_N.len()],
    exponent: f64,
    gap_w_m2k: f64,
}

impl Exact {
    /// That of a plant with these parameters.
    pub fn of(params: &Params) -> Self {
        let factor = params.finger.resistance_factor;
        let resistance = |force_n| {
            let contact =
                (params.contact).at_force(force_n, &params.finger.surface, &params.display);
            factor * contact.expect("a force").resistance_m2k_w
        };
        Self {
            resistances_m2k_w: FORCES_N.map(resistance),
            exponent: params.contact.exponent,
            // The factor is on the whole resistance.
            gap_w_m2k: params.contact.gap_w_m2k / factor,
        }
    }
}

/// Deviations of fits, without their signs.
#[derive(Default)]
pub struct Deviations {
    resistance_percent: [Vec<f64>; FORCES_N.len()],
    exponent: Vec<f64>,
    gap_w_m2k: Vec<f64>,
    /// Number of fits with a gap.
    gaps: usize,
    /// How many of the intervals of resistances, exponent and gap contain the plant's value.
    inside: [usize; FORCES_N.len() + 2],
}

/// Median, 90 % and worst.
fn three(values: &[f64]) -> [f64; 3] {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    [0.5, 0.9, 1.0].map(|part| sorted[((sorted.len() - 1) as f64 * part).round() as usize])
}

impl Deviations {
    /// Adds a fit.
    pub fn add(&mut self, fit: &Fit, exact: &Exact) {
        let fitted = fit.resistances_m2k_w.iter().zip(exact.resistances_m2k_w);
        for (percent, (fitted, exact)) in self.resistance_percent.iter_mut().zip(fitted) {
            percent.push(100.0 * (fitted / exact - 1.0).abs());
        }
        (self.exponent).push((fit.law.exponent - exact.exponent).abs());
        (self.gap_w_m2k).push((fit.law.gap_w_m2k - exact.gap_w_m2k).abs());
        self.gaps += usize::from(fit.law.gap_w_m2k > 0.0);
        let [a, b, c] = fit.resistance_intervals_m2k_w;
        let intervals = [a, b, c, fit.exponent_interval, fit.gap_interval_w_m2k];
        let [a, b, c] = exact.resistances_m2k_w;
        let exact = [a, b, c, exact.exponent, exact.gap_w_m2k];
        for (inside, (interval, exact)) in self.inside.iter_mut().zip(intervals.iter().zip(exact)) {
            *inside += usize::from((interval.low..=interval.high).contains(&exact));
        }
    }

    /// Prints all, and asserts the documented figures whose keys begin so by `assert`. Gaps must be taken where there are some, and of the
    /// intervals, 95 in a hundred of which are to contain the plant's value, most must.
    #[track_caller]
    pub fn assert_figures(&self, assert: fn(&str, f64), key: &str, has_gap: bool) {
        let fingers = self.exponent.len();
        println!("{key}, {fingers} fingers; median, 90 %, worst:");
        for (force_n, percent) in FORCES_N.iter().zip(&self.resistance_percent) {
            println!("  R at {force_n} N {:.2?} %", three(percent));
        }
        let (exponent, gap) = (three(&self.exponent), three(&self.gap_w_m2k));
        println!("  exponent {exponent:.5?}, gap {gap:.1?} W/(m2 K), taken in {}", self.gaps);
        println!("  inside of the intervals: {:?}", self.inside);
        let beyond = |percent: &&f64| **percent > 10.0;
        let beyond: Vec<_> = (self.resistance_percent.iter())
            .map(|percent| percent.iter().filter(beyond).count())
            .collect();
        println!("  beyond 10 %: {beyond:?}");
        assert_eq!(self.gaps, if has_gap { fingers } else { 0 });
        let names = ["r_0n1", "r_0n5", "r_2n"].iter();
        for (name, percent) in names.zip(&self.resistance_percent) {
            assert(&format!("{key}_{name}"), three(percent)[2]);
        }
        let [_, most, worst] = exponent;
        assert(&format!("{key}_exponent_90"), 1e4 * most);
        assert(&format!("{key}_exponent"), 1e4 * worst);
        if has_gap {
            assert(&format!("{key}_gap"), gap[2]);
        }
        let counted = if has_gap { 5 } else { 4 };
        for inside in &self.inside[..counted] {
            assert!(*inside as f64 > 0.84 * fingers as f64, "{:?}", self.inside);
        }
    }
}
