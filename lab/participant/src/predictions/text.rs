//! The predictions as text.

use std::fmt;

use super::{Basis, Check, DisplayMode, Identification, RealAgainstSimulated, Report, TableResult};

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Predictions of the simulated participant; per cent unless said otherwise.")?;
        let (skin_c, room_c) = self.falls.skin_room_c;
        writeln!(f, "\nFalls at 0.16 mm on samples in free exploration, {skin_c}/{room_c} C:")?;
        for (material, fall_k) in &self.falls.falls_k {
            writeln!(f, "  {material:16} {fall_k:6.3} K")?;
        }
        for table in &self.tables {
            table.fmt(f)?;
        }
        self.identification.fmt(f)?;
        for comparison in &self.real_against_simulated {
            comparison.fmt(f)?;
        }
        writeln!(
            f,
            "\nPer cent correct by which two stimuli are told apart that differ at the skin by"
        )?;
        writeln!(
            f,
            "  {:22} {:>7} {:>6} {:>6} {:>6} {:>6} {:>9}",
            "observer", "fall K", "20 mK", "50", "100", "200", "75 % at K"
        )?;
        for worth in &self.worth {
            write!(f, "  {:22} {:7.2}", worth.observer, worth.fall_k)?;
            for (_, percent) in &worth.correct {
                write!(f, " {percent:6.1}")?;
            }
            writeln!(f, " {:9.3}", worth.threshold_75_k)?;
        }
        Ok(())
    }
}

fn write_checks(f: &mut fmt::Formatter<'_>, checks: &[Check]) -> fmt::Result {
    for check in checks {
        let met = if check.met { "met" } else { "NOT MET" };
        let value = if check.value.is_empty() { "none" } else { &check.value };
        writeln!(f, "  {met}: {} {value} (allowed: {})", check.what, check.allowed)?;
    }
    Ok(())
}

impl fmt::Display for TableResult {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let basis = match self.basis {
            Basis::Fitted => "fitted to Tables 3-3 and 3-5 together",
            Basis::Predicted => "predicted from the other table alone, no factor of three fingers",
        };
        writeln!(f, "\n{}, {basis}: {}", self.name, self.observer)?;
        for cell in &self.cells {
            let off = cell.predicted - cell.published;
            writeln!(
                f,
                "  {:38} published {:5.1} ours {:5.1} ({off:+.1})",
                cell.label, cell.published, cell.predicted
            )?;
        }
        writeln!(
            f,
            "  rms {:.1}, mean published {:.1}, ours {:.1}",
            self.rms, self.mean_published, self.mean_predicted
        )?;
        write_checks(f, &self.checks)
    }
}

impl fmt::Display for Identification {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "\nSection 4.2, identification; factor {:.2} fitted to both overall percentages:",
            self.factor
        )?;
        for cell in &self.overall {
            writeln!(
                f,
                "  {:10} published {:5.1} ours {:5.1}",
                cell.label, cell.published, cell.predicted
            )?;
        }
        for (index, material) in self.materials.iter().enumerate() {
            let [real_k, simulated_k] = self.falls_k.each_ref().map(|falls_k| falls_k[index]);
            let [real, simulated] = self.correct.each_ref().map(|correct| correct[index]);
            writeln!(
                f,
                "  {material:16} real {real:5.1} ({real_k:.3} K), simulated {simulated:5.1} ({simulated_k:.3} K)"
            )?;
        }
        write_checks(f, &self.checks)
    }
}

impl fmt::Display for RealAgainstSimulated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (skin_c, room_c) = self.condition.skin_room_c;
        let [first, second] = DisplayMode::ALL.map(DisplayMode::words);
        let finger =
            if self.condition.is_layered { "layered finger" } else { "the thesis's finger" };
        let touches = if self.condition.lifts { "lifting and replacing" } else { "one touch" };
        writeln!(
            f,
            "\nSection 4.3 (P5), predicted, {skin_c}/{room_c} C, {touches}, {finger}: {first} and {second}"
        )?;
        for pair in &self.pairs {
            let [a, b] = pair.correct;
            let published = if pair.published_below { "published below 72" } else { "" };
            writeln!(
                f,
                "  real {:16} simulated {:16} {a:5.1} {b:5.1} ({:+.1}) {published}",
                pair.real,
                pair.simulated,
                b - a
            )?;
        }
        let [a, b] = self.means;
        writeln!(
            f,
            "  means {a:.1} and {b:.1}, {:+.1} apart; largest difference {:.1}",
            b - a,
            self.largest_difference
        )?;
        for row in &self.identical {
            let [a, b] = row.simulated_k;
            let [p, q] = row.real_colder;
            writeln!(
                f,
                "  identical {:16} real {:.3} K, displays {a:.3} and {b:.3} K ({:+.0} and {:+.0} mK), real colder {p:.1} and {q:.1}",
                row.material,
                row.real_k,
                1e3 * (a - row.real_k),
                1e3 * (b - row.real_k)
            )?;
        }
        write_checks(f, &self.checks)
    }
}
