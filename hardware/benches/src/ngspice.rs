//! Runs ngspice on a deck and reads its measurements.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result, bail, ensure};

use crate::netlist::Netlists;
use crate::{measure, number};

/// Name of the program.
const PROGRAM: &str = "ngspice";

/// Whether ngspice starts.
pub fn is_installed() -> bool {
    Command::new(PROGRAM)
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

/// Results of `.meas` lines by their names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measured(BTreeMap<String, f64>);

impl Measured {
    /// The result of a measurement.
    ///
    /// # Errors
    /// The measurement has failed, for instance because a level was never crossed, or does not exist.
    pub fn get(&self, name: &str) -> Result<f64> {
        self.find(name).with_context(|| format!("the measurement {name} has failed"))
    }

    /// The result of a measurement that may fail, such as the time of an event that may not come.
    pub fn find(&self, name: &str) -> Option<f64> {
        self.0.get(name).copied()
    }
}

/// Reads what ngspice prints: lines `name = value`, perhaps followed by `from=`, `to=` or `at=`.
pub fn parse(output: &str) -> Measured {
    let results = output.lines().filter_map(|line| {
        let (name, value) = line.split_once('=')?;
        let name = name.trim();
        let is_name =
            !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        let value = number::parse(value.split_whitespace().next()?)?;
        is_name.then(|| (name.to_owned(), value))
    });
    Measured(results.collect())
}

/// The folder of decks, for whoever wants to look at one or run it by hand.
fn deck_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/hardware")
}

/// Runs the netlists with these lines behind them.
///
/// # Errors
/// ngspice does not start, does not converge, reports an error, or would measure wrongly ([`measure::check`]).
pub fn run(title: &str, netlists: &Netlists, lines: &str) -> Result<Measured> {
    Ok(parse(&output(title, netlists, lines)?))
}

/// Runs the netlists with these lines, which end in a `.tran` line, behind them; points (time in s, value) of each signal,
/// such as `v(out)`.
///
/// # Errors
/// As [`run`], or a signal does not exist.
pub fn waveforms(
    title: &str,
    netlists: &Netlists,
    lines: &str,
    signals: &[&str],
) -> Result<Vec<Vec<(f64, f64)>>> {
    let mut deck = lines.to_owned();
    for signal in signals {
        deck += &format!("\n.print tran {signal}");
    }
    let tables = parse_tables(&output(title, netlists, &deck)?);
    ensure!(
        tables.len() == signals.len(),
        "{title}: {} of the signals {} exist",
        tables.len(),
        signals.join(", ")
    );
    Ok(tables)
}

/// Reads the tables that `.print` lines of one signal each write: lines `index time value`, the index from 0 in each table.
fn parse_tables(output: &str) -> Vec<Vec<(f64, f64)>> {
    let mut tables: Vec<Vec<_>> = Vec::new();
    for line in output.lines() {
        let mut words = line.split_whitespace();
        let Some(index) = words.next().and_then(|word| word.parse::<usize>().ok()) else {
            continue;
        };
        let mut number = || words.next().and_then(number::parse);
        let (Some(time_s), Some(value)) = (number(), number()) else {
            continue;
        };
        if index == 0 {
            tables.push(Vec::new());
        }
        if let Some(table) = tables.last_mut() {
            table.push((time_s, value));
        }
    }
    tables
}

/// What ngspice prints when it runs the netlists with these lines behind them.
fn output(title: &str, netlists: &Netlists, lines: &str) -> Result<String> {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let folder = deck_folder();
    fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let path = folder.join(format!("{title}-{number}.cir"));
    let deck = format!("* {title}\n{}\n{lines}\n.end\n", netlists.text());
    fs::write(&path, &deck).with_context(|| path.display().to_string())?;
    measure::check(&deck).with_context(|| path.display().to_string())?;
    // ngspice reads the deck from its standard input: another run may write files of the same names.
    let mut child = Command::new(PROGRAM)
        .arg("-b")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .with_context(|| format!("{PROGRAM} did not start"))?;
    if let Some(mut input) = child.stdin.take() {
        input.write_all(deck.as_bytes())?;
    }
    let output = child.wait_with_output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    // Progress is printed in one line, by carriage returns.
    for line in text.split(['\n', '\r']).chain(errors.split(['\n', '\r'])) {
        let lower = line.to_ascii_lowercase();
        if ["aborted", "no such", "unknown", "syntax", "too small", "can't find"]
            .iter()
            .any(|sign| lower.contains(sign))
        {
            bail!("{}: {line}", path.display());
        }
    }
    ensure!(text.contains("Total elapsed time"), "{}: {errors}", path.display());
    Ok(text.into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As ngspice 39 prints.
    const OUTPUT: &str = "\
Doing analysis at TEMP = 27.000000 and TNOM = 27.000000
No. of Data Rows : 2250
  Measurements for Transient Analysis
imean               =  6.523032e+00 from=  9.500000e-05 to=  1.987551e-04
ipk                 =  -1.057072e+01 at=  1.891180e-05
 meas tran late when v(a)=1 failed!
late                =   failed
";

    #[test]
    fn measurements_are_read_and_failed_ones_are_absent() {
        let measured = parse(OUTPUT);
        assert_eq!(measured.get("imean").unwrap(), 6.523032);
        assert_eq!(measured.find("ipk"), Some(-10.57072));
        assert_eq!(measured.find("late"), None);
        assert!(measured.get("late").is_err());
    }

    #[test]
    fn tables_of_printed_signals_are_read_over_page_breaks() {
        let output = "Index   time    v(a)\n----\n0\t0.0e+00\t1.0e+00\t\nIndex   time    v(a)\n1\t5.0e-10\t2.0e+00\t\n\
            No. of Data Rows : 2\nIndex   time    v(b)\n0\t0.0e+00\t3.0e+00\t\n";
        let expected = vec![vec![(0.0, 1.0), (5e-10, 2.0)], vec![(0.0, 3.0)]];
        assert_eq!(parse_tables(output), expected);
    }

    #[test]
    fn a_deck_that_ngspice_refuses_is_an_error() {
        if !is_installed() {
            println!("skipped: ngspice is not installed");
            return;
        }
        let nothing = Netlists::from_text("");
        let refused = run("test-refused", &nothing, "R1 a 0 1k\nX1 a missing\n.op");
        assert!(refused.is_err());
        let divider = "V1 a 0 3\nR1 a b 1k\nR2 b 0 2k\n.dc V1 0 3 1\n.meas dc half find v(b) at=3";
        let measured = run("test-divider", &nothing, divider).unwrap();
        assert!((measured.get("half").unwrap() - 2.0).abs() < 1e-6);
    }
}
