//! Select lines of the multiplexers: whether the parity gate shows each line that is broken or shorted.

use anyhow::Result;

use super::Bench;
use crate::netlist::Netlists;
use crate::ngspice;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "parity",
    title: "select lines of five fingers: the parity gate shows each that is broken or shorted",
    parts: &[run],
    // The gate does not see the third line.
    broken: |netlists| netlists.with_line("X1 s0 s1 s2 odd v3 xor3", "X1 s0 s1 0 odd v3 xor3"),
    pictures: &[],
};

const FINGERS: usize = 5;
/// Time for which each finger is selected, us, and when in it the levels are read.
const TURN_US: usize = 20;
const READ_US: usize = 15;
/// Levels of an input of the microcontroller, V: 0.3 and 0.7 of 3.3 V.
const LOW_V: f64 = 0.99;
const HIGH_V: f64 = 2.31;
/// Resistance of the microcontroller's outputs and of another one that is stronger, ohm (class values). Between two lines that
/// are shorted the stronger level wins.
const OUTPUT_OHM: f64 = 50.0;
const STRONGER_OHM: f64 = 25.0;

/// What happens to the lines.
#[derive(Clone, Copy)]
enum LineFault {
    None,
    /// A line is broken between the microcontroller and the last multiplexer.
    Broken(usize),
    /// A line is shorted to this voltage.
    Shorted(usize, f64),
    /// Two lines are shorted together, and high or low wins.
    Together([usize; 2], f64),
}

/// Each finger in turn, its signal 0.5 V more than the previous one's.
fn deck(fault: LineFault) -> String {
    let mut lines = String::from("V3 v3 0 3.3\n");
    for finger in 0..FINGERS {
        lines += &format!("Vy{finger} y{finger} 0 {}\n", signal_v(finger));
    }
    let ohm = |is_high: bool| match fault {
        LineFault::Together(_, winner_v) if is_high == (winner_v > LOW_V) => STRONGER_OHM,
        _ => OUTPUT_OHM,
    };
    for line in 0..3 {
        let levels = |level: &dyn Fn(bool) -> f64| {
            let mut points = String::new();
            for finger in 0..FINGERS {
                let (from, to) = (finger * TURN_US, (finger + 1) * TURN_US);
                let value = level(finger >> line & 1 == 1);
                points += &format!("{from}.01u {value} {to}u {value} ");
            }
            points
        };
        let drives = levels(&|is_high| if is_high { 3.3 } else { 0.0 });
        let siemens = levels(&|is_high| ohm(is_high).recip());
        let wire_ohm = match fault {
            LineFault::Broken(broken) if broken == line => 1e12,
            _ => 0.1,
        };
        lines += &format!(
            "Vd{line} d{line} 0 PWL({drives})\nVg{line} g{line} 0 PWL({siemens})\n\
             Bd{line} d{line} p{line} I=V(d{line},p{line})*V(g{line})\nRw{line} p{line} s{line} {wire_ohm:e}\n"
        );
    }
    lines += &match fault {
        LineFault::Shorted(line, volt) => format!("Vf f 0 {volt}\nRf f s{line} 1\n"),
        LineFault::Together([a, b], _) => format!("Rf s{a} s{b} 0.1\n"),
        LineFault::None | LineFault::Broken(_) => String::new(),
    };
    lines += "Xm v3 y0 y1 y2 y3 y4 s0 s1 s2 adc multiplexer\nXp v3 s0 s1 s2 odd parity\n\
              .options reltol=1e-3 method=gear\n.tran 0.1u 100u 0 0.2u\n";
    for finger in 0..FINGERS {
        let at_us = finger * TURN_US + READ_US;
        lines += &format!(
            ".meas tran adc{finger} find v(adc) at={at_us}u\n.meas tran odd{finger} find v(odd) at={at_us}u\n"
        );
    }
    lines
}

fn signal_v(finger: usize) -> f64 {
    0.5 + 0.5 * finger as f64
}

/// Of all fingers: those that get another signal than their own, those of them whose parity is right, and how far the gate's
/// output is at most from the supply or ground, V.
struct Outcome {
    wrong: usize,
    unnoticed: usize,
    from_rail_v: f64,
}

fn simulate(netlists: &Netlists, fault: LineFault) -> Result<Outcome> {
    let measured = ngspice::run("parity", netlists, &deck(fault))?;
    let mut outcome = Outcome { wrong: 0, unnoticed: 0, from_rail_v: 0.0 };
    for finger in 0..FINGERS {
        let adc_v = measured.get(&format!("adc{finger}"))?;
        let odd_v = measured.get(&format!("odd{finger}"))?;
        let is_odd = finger.count_ones() % 2 == 1;
        let parity_is_right = if is_odd { odd_v > LOW_V } else { odd_v < HIGH_V };
        if (adc_v - signal_v(finger)).abs() > 0.05 {
            outcome.wrong += 1;
            outcome.unnoticed += usize::from(parity_is_right);
        }
        outcome.from_rail_v = outcome.from_rail_v.max(odd_v.min(3.3 - odd_v));
    }
    Ok(outcome)
}

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let sound = simulate(netlists, LineFault::None)?;
    let mut all = vec![
        Quantity::at_most(
            "sound lines: fingers with another's signal",
            sound.wrong as f64,
            "1",
            0.0,
        ),
        Quantity::at_most(
            "sound lines: gate's output from supply or ground",
            sound.from_rail_v,
            "V",
            0.5,
        ),
    ];
    let mut faults = Vec::new();
    for line in 0..3 {
        faults.push((format!("line {line} broken"), LineFault::Broken(line)));
        for (level, volt) in [("ground", 0.0), ("3.3 V", 3.3)] {
            faults
                .push((format!("line {line} shorted to {level}"), LineFault::Shorted(line, volt)));
        }
    }
    for pair in [[0, 1], [0, 2], [1, 2]] {
        for (winner, volt) in [("low", 0.0), ("high", 3.3)] {
            let [a, b] = pair;
            let what = format!("lines {a} and {b} shorted together, {winner} wins");
            faults.push((what, LineFault::Together(pair, volt)));
        }
    }
    for (what, fault) in faults {
        let outcome = simulate(netlists, fault)?;
        all.push(Quantity::at_least(
            format!("{what}: fingers with another's signal"),
            outcome.wrong as f64,
            "1",
            1.0,
        ));
        all.push(Quantity::at_most(
            format!("{what}: those that the gate does not show"),
            outcome.unnoticed as f64,
            "1",
            0.0,
        ));
    }
    Ok(all)
}
