//! `.meas` lines over a window of time, and the check that no deck measures what ngspice gets wrong without a word.
//!
//! Version 39 of ngspice integrates AVG beyond the end of its window, gives 0 for MAX, MIN, PP and INTEG of a window
//! without a point, cuts INTEG where the run ends, and takes the magnitude of a base: `(-2)**3` is 8.

use std::ops::Range;

use anyhow::{Context, Result, ensure};

use crate::number;

/// Lines that measure the mean of a signal over a window, s: its integral divided by the window's length.
pub fn mean(name: &str, signal: &str, window_s: Range<f64>) -> String {
    let Range { start, end } = window_s;
    let length = end - start;
    format!(
        ".meas tran {name}_integral integ {signal} from={start:e} to={end:e}\n\
         .meas tran {name} param='{name}_integral/{length:e}'\n"
    )
}

/// Part of a transient run whose points are kept, and the longest step between two of them.
struct Points {
    kept_s: Range<f64>,
    longest_step_s: f64,
}

/// Share of a time by which a window may exceed the run, for the rounding of both.
const ROUNDING: f64 = 1e-9;

/// Checks that a deck raises nothing to a power, measures no AVG, and that every window of a measurement lies within the
/// run and is at least as long as the longest step, so that a point is in it.
///
/// # Errors
/// The first line that does not meet this.
pub fn check(deck: &str) -> Result<()> {
    // A line that begins with + continues the one before.
    let deck = deck.to_ascii_lowercase().replace("\n+", " ");
    let lines = || deck.lines().filter(|line| !line.starts_with('*'));
    let points = lines().find_map(points);
    for line in lines() {
        let (code, _comment) = line.split_once(';').unwrap_or((line, ""));
        let has_power = ["^", "**", "pow("].iter().any(|power| code.contains(power));
        ensure!(!has_power, "{line}: ngspice loses the sign of a power's base; write a product");
        // Spaces are allowed around an equals sign.
        let code = code.split('=').map(str::trim).collect::<Vec<_>>().join("=");
        let words: Vec<_> = code.split_whitespace().collect();
        if let [".meas" | ".measure", "tran", _, function, ..] = words[..] {
            ensure!(function != "avg", "{line}: AVG exceeds its window; use measure::mean");
            check_window(&words, points.as_ref()).with_context(|| line.to_owned())?;
        }
    }
    Ok(())
}

/// What a line `.tran STEP END START LONGEST_STEP` keeps.
fn points(line: &str) -> Option<Points> {
    let numbers = line.strip_prefix(".tran ")?.split_whitespace().map_while(number::parse);
    match numbers.collect::<Vec<_>>()[..] {
        [_, end, start, longest_step_s] => Some(Points { kept_s: start..end, longest_step_s }),
        _ => None,
    }
}

fn check_window(words: &[&str], points: Option<&Points>) -> Result<()> {
    let time = |key: &str| {
        let value = words.iter().find_map(|word| word.strip_prefix(key))?;
        Some(number::parse(value).with_context(|| format!("{key}{value} is not a number")))
    };
    let (from, to) = (time("from=").transpose()?, time("to=").transpose()?);
    if from.is_none() && to.is_none() {
        return Ok(());
    }
    let Points { kept_s, longest_step_s } =
        points.context("a window needs a line `.tran STEP END START LONGEST_STEP`")?;
    let (from, to) = (from.unwrap_or(kept_s.start), to.unwrap_or(kept_s.end));
    ensure!(
        from >= kept_s.start * (1.0 - ROUNDING) && to <= kept_s.end * (1.0 + ROUNDING),
        "the run is from {:.3e} to {:.3e} s",
        kept_s.start,
        kept_s.end
    );
    ensure!(
        to - from >= *longest_step_s,
        "the window is shorter than the longest step, {longest_step_s:e} s"
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::netlist::Netlists;
    use crate::ngspice::{is_installed, run};

    /// Sine of 1 V and 1 kHz and ramp of 1 V/ms from 0.1 to 0.5 ms, neither of which is a whole number of steps of 13 us.
    #[test]
    fn means_of_a_sine_and_of_a_ramp_meet_the_analytic_ones() {
        if !is_installed() {
            println!("skipped: ngspice is not installed");
            return;
        }
        let window_s = 0.1e-3..0.5e-3;
        let deck = "V1 sine 0 SIN(0 1 1k)\nR1 sine 0 1k\nV2 ramp 0 PWL(0 0 1m 1)\nR2 ramp 0 1k\n.tran 1u 1m 0 13u\n"
            .to_owned()
            + &mean("of_sine", "v(sine)", window_s.clone())
            + &mean("of_ramp", "v(ramp)", window_s);
        let measured = run("test-mean", &Netlists::from_text(""), &deck).unwrap();
        let of_sine = ((0.2 * PI).cos() - PI.cos()) / (TAU * 0.4);
        for (name, exact, allowed) in [
            // The trapezoidal rule's error, (2 pi 13/1000)^2 / 12 of the mean.
            ("of_sine", of_sine, 6e-4),
            // Exact for a straight line; the rest is the last printed digit.
            ("of_ramp", 0.3, 2e-6),
        ] {
            let error = measured.get(name).unwrap() / exact - 1.0;
            assert!(error.abs() < allowed, "{name}: {error:e}");
        }
    }

    #[test]
    fn measurements_that_ngspice_gets_wrong_are_refused_with_their_line() {
        let run = ".tran 20n 500u 100u 60n\n";
        for (lines, expected) in [
            (".meas tran x avg i(vi) from=150u to=200u", "measure::mean"),
            (".MEAS TRAN x AVG i(vi) from=150u to=200u", "measure::mean"),
            (".meas tran x max i(vi) from=600u to=700u", "from 1.000e-4 to 5.000e-4 s"),
            (".meas tran x integ i(vi) from=400u to=501u", "from 1.000e-4 to 5.000e-4 s"),
            (".meas tran x min i(vi) from=50u to=200u", "from 1.000e-4 to 5.000e-4 s"),
            (".meas tran x pp i(vi) from=200u to=150u", "longest step"),
            (".meas tran x max i(vi) from=200u to=200.05u", "longest step"),
            (".meas tran x max i(vi) from=early to=200u", "from=early is not a number"),
            (".meas tran x max i(vi) from=600u", "longest step"),
            (".meas tran x max i(vi) to=50u", "longest step"),
            (".meas tran x max i(vi) from = 600u to =700u", "from 1.000e-4 to 5.000e-4 s"),
            (".measure tran x avg i(vi) from=150u to=200u", "measure::mean"),
            ("B1 a 0 V=V(b)**3", "product"),
            ("B1 a 0 V=pow(V(b),3)", "product"),
            (".param x={y^3}", "product"),
        ] {
            let error = format!("{:#}", check(&format!("{run}{lines}")).expect_err(lines));
            assert!(error.contains(expected), "{lines}: {error}");
            assert!(error.starts_with(&lines.to_ascii_lowercase()), "{error}");
        }
        let continued = check(&format!("{run}.meas tran x max i(vi)\n+ from=600u to=700u"));
        assert!(continued.is_err());
        let unbounded = check(".tran 20n 500u\n.meas tran x max i(vi) from=150u to=200u");
        assert!(unbounded.is_err());
        for lines in [
            "* x**2 in a comment\nR1 a 0 1k ; x^2",
            ".meas tran x max i(vi) from=100u to=0.5m\n.meas tran y max i(vi) from=150u",
            ".meas tran x min i(vi)\n.meas tran y when v(a)=1 fall=1 td=900u",
            ".meas dc x find v(a) at=9",
        ] {
            check(&format!("{run}{lines}")).unwrap();
        }
    }
}
