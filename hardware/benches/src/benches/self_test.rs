//! The comparator's test by the microcontroller: window, latch, switch and sensed supply.

use anyhow::Result;

use super::Bench;
use crate::netlist::Netlists;
use crate::ngspice::{self, Measured};
use crate::picture::Scene;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "self-test",
    title: "power-on, test of the hot and of the cold side, sensed bridge supply",
    parts: &[run],
    broken: |netlists| netlists.scaled("r_bleed", 10.0),
    pictures: &[("self-test", scene)],
};

/// Pulses of the test line, ms: the first clears the latch, the second tests the hot side, the third the cold side. The
/// firmware holds the line for 20 ms and waits 20 ms.
pub const HOT_MS: (f64, f64) = (60.0, 80.0);
/// As [`HOT_MS`].
pub const COLD_MS: (f64, f64) = (100.0, 120.0);

/// Change of the divider's voltage at 25 °C, V/K: 3.3 V, beta 3950 K, equal resistances.
const SLOPE_V_K: f64 = 3.3 * 0.25 * 3950.0 / (298.15 * 298.15);

/// Power-on and three pulses, with the 3.3 V and the temperature as sources describe them.
pub fn deck(v3: &str, temperature: &str) -> String {
    format!(
        "V3 v3s 0 {v3}\nR3 v3s v3 10m\nV12 v12 0 PULSE(0 12 0 1m)\nVt tc 0 {temperature}\nVstop stop 0 1\n\
         Vtest test 0 PWL(0 0 20m 0 20.01m 3.3 40m 3.3 40.01m 0 60m 0 60.01m 3.3 80m 3.3 80.01m 0 100m 0 100.01m 3.3 120m 3.3 120.01m 0)\n\
         Vside side 0 PWL(0 0 90m 0 90.01m 3.3 130m 3.3 130.01m 0)\n\
         Xn pin 0 tc ntc\nX1 v3 pin in adc divider\nX2 v3 v5 in test side nrst on trip nfault window\nRn v3 nrst 40k\n\
         X3 v12 v3 stop vstop stopped v5 supply\nX4 vstop vbr on trip vbr_sense supply_switch\nR1 v3 nfault 4.7k\n\
         .options reltol=1e-3 abstol=1n vntol=1m method=gear\n.tran 20u 140m 0 50u"
    )
}

/// Simulates [`deck`]. `more` are further lines, such as a fault or measurements.
pub fn simulate(netlists: &Netlists, v3: &str, temperature: &str, more: &str) -> Result<Measured> {
    let (hot, hot_end) = HOT_MS;
    let (cold, cold_end) = COLD_MS;
    let lines = format!(
        "{circuit}\n\
         .meas tran first find v(vbr) at=19m\n\
         .meas tran hot_trip when v(nfault)=1 fall=1 td={hot}m\n.meas tran hot_release when v(nfault)=2 rise=1 td={hot_end}m\n\
         .meas tran hot_fault find v(nfault) at=79.9m\n\
         .meas tran hot_cut find v(vbr) at=79.9m\n.meas tran hot_back find v(vbr) at=99.9m\n\
         .meas tran cold_trip when v(nfault)=1 fall=1 td={cold}m\n.meas tran cold_release when v(nfault)=2 rise=1 td={cold_end}m\n\
         .meas tran cold_fault find v(nfault) at=119.9m\n\
         .meas tran cold_cut find v(vbr) at=119.9m\n.meas tran cold_back find v(vbr) at=139.9m\n\
         .meas tran check_low min v(in) from=55m to=139m\n.meas tran check_high max v(in) from=55m to=139m\n\
         .meas tran sense find v(vbr_sense) at=99.9m\n\
         .meas tran inrush min i(v12) from=41m to=139m\n{more}\n",
        circuit = deck(v3, temperature),
    );
    ngspice::run("self-test", netlists, &lines)
}

fn scene() -> Scene {
    Scene {
        lines: deck(SOUND.0, SOUND.1),
        time: ("time, ms", 1e3),
        range: 0.0..140.0,
        charts: &[
            ("V", &[("test line", "v(test)", 1.0), ("side: low hot, high cold", "v(side)", 1.0)]),
            (
                "V",
                &[
                    ("input of the comparators", "v(x2.buf)", 1.0),
                    ("hot threshold", "v(x2.hot)", 1.0),
                    ("cold threshold", "v(x2.cold)", 1.0),
                ],
            ),
            ("V", &[("nFAULT", "v(nfault)", 1.0)]),
            ("V", &[("bridge supply", "v(vbr)", 1.0)]),
        ],
    }
}

/// The 3.3 V and the temperature of a sound device.
pub const SOUND: (&str, &str) = ("PULSE(0 3.3 0 1m)", "25");

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let sound = simulate(netlists, SOUND.0, SOUND.1, "")?;
    let mut all = vec![Quantity::at_most(
        "bridge supply before the first test: the latch is set at power-on",
        sound.get("first")?,
        "V",
        0.5,
    )];
    for (side, (begin, end)) in [("hot", HOT_MS), ("cold", COLD_MS)] {
        let at = |name: &str| sound.get(&format!("{side}_{name}"));
        let delay_ms = |name: &str, from: f64| at(name).map(|at_s| at_s * 1e3 - from);
        all.extend([
            Quantity::between(
                format!("{side}: test line to nFAULT low"),
                delay_ms("trip", begin)?,
                "ms",
                (0.0, 10.0),
            ),
            Quantity::at_most(
                format!("{side}: bridge supply at the end of the test"),
                at("cut")?,
                "V",
                6.0,
            ),
            Quantity::between(
                format!("{side}: test line to nFAULT high"),
                delay_ms("release", end)?,
                "ms",
                (1.0, 10.0),
            ),
            Quantity::at_least(
                format!("{side}: bridge supply 20 ms after the test"),
                at("back")?,
                "V",
                11.0,
            ),
        ]);
    }
    let check_k = (sound.get("check_high")? - sound.get("check_low")?) / SLOPE_V_K;
    all.extend([
        Quantity::between("sensed 12 V at the pin", sound.get("sense")?, "V", (2.6, 3.0)),
        Quantity::at_most(
            "disturbance of the second display thermistor's reading",
            check_k,
            "K",
            0.25,
        ),
        Quantity::at_most("inrush when the switch closes", -sound.get("inrush")?, "A", 5.0),
    ]);
    for (which, tolerance, falling) in [("slowest", 1.15, 0.5), ("fastest", 0.85, 1.2)] {
        let changed = netlists
            .scaled("c_clear", tolerance)?
            .with_line("X5 slow clk", &format!("X5 slow clk v5 schmitt vtn={falling}"))?;
        let measured = simulate(&changed, SOUND.0, SOUND.1, "")?;
        all.push(Quantity::between(
            format!("test line to nFAULT high, {which} (15 % and the gate's thresholds)"),
            measured.get("hot_release")? * 1e3 - HOT_MS.1,
            "ms",
            (1.0, 10.0),
        ));
    }
    Ok(all)
}
