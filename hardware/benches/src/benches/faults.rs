//! Faults of the protection: each must show in a test, or leave the bridge without supply.

use anyhow::Result;

use super::{Bench, self_test};
use crate::measure;
use crate::netlist::Netlists;
use crate::ngspice;
use crate::picture::Scene;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "faults",
    title: "dead comparator, shorted switch, missing supplies, emergency stop",
    parts: &[emergency_stop, dead_parts, missing_supplies, excursions],
    // The emergency stop's contact is welded.
    broken: |netlists| netlists.with_line("S1 contact vstop", "RS1 contact vstop 1m"),
    pictures: &[("trip", trip_scene), ("emergency-stop", stop_scene)],
};

/// Bridge supply above which a switch has not opened, V.
const STILL_ON_V: f64 = 9.0;

fn dead_parts(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let mut all = Vec::new();
    let (v3, warm) = self_test::SOUND;
    for (side, alive) in [("hot", "alive_hot"), ("cold", "alive_cold")] {
        let dead = self_test::simulate(&netlists.with(alive, 0.0)?, v3, warm, "")?;
        all.push(Quantity::at_least(
            format!("{side} comparator dead: nFAULT at the end of its test stays high"),
            dead.get(&format!("{side}_fault"))?,
            "V",
            2.5,
        ));
        all.push(Quantity::at_least(
            format!("{side} comparator dead: bridge supply at the end of its test"),
            dead.get(&format!("{side}_cut"))?,
            "V",
            STILL_ON_V,
        ));
    }
    let shorted = netlists.with_line("M1 vbr g vstop", "RM1 vbr vstop 5m")?;
    let shorted = self_test::simulate(&shorted, v3, warm, "")?;
    all.extend([
        Quantity::at_least(
            "switch shorted: bridge supply at the end of the test",
            shorted.get("hot_cut")?,
            "V",
            STILL_ON_V,
        ),
        Quantity::at_most(
            "switch shorted: nFAULT alone does not show it",
            shorted.get("hot_fault")?,
            "V",
            0.4,
        ),
    ]);
    Ok(all)
}

fn missing_supplies(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let mut all = Vec::new();
    let (_, warm) = self_test::SOUND;
    let measure =
        ".meas tran open_at when v(on)=1 fall=1 td=45m\n.meas tran left find v(vbr) at=58m";
    // The latch is cleared at 40 ms; 3.3 V goes at 46 ms, shorted to ground, or open with what hangs on it as its load.
    let shorted = "PWL(0 0 1m 3.3 46m 3.3 46.5m 0)";
    let open = netlists
        .with_line("R5 v3 level", "R5 v3 level {r_test_top}\nRload v3 0 1k\nCload v3 0 10u")?;
    let open_lines = format!("{measure}\nRopen v3s v3 1");
    let missing = [
        ("3.3 V shorted to ground", self_test::simulate(netlists, shorted, warm, measure)?),
        ("3.3 V open", simulate_open(&open, warm, &open_lines)?),
    ];
    for (what, measured) in missing {
        all.push(Quantity::between(
            format!("{what}: until the switch opens"),
            measured.get("open_at")? * 1e3 - 46.0,
            "ms",
            (0.0, 10.0),
        ));
    }
    let without_5v = netlists.with_line("X1 vf v5 regulator", "Rv5 v5 0 1k")?;
    let (v3, warm) = self_test::SOUND;
    let dead = self_test::simulate(&without_5v, v3, warm, ".meas tran most max v(vbr)")?;
    all.push(Quantity::at_most(
        "5 V missing: bridge supply, at most, power-on included",
        dead.get("most")?,
        "V",
        0.5,
    ));
    let sound =
        self_test::simulate(netlists, v3, warm, ".meas tran most max v(vbr) from=0 to=20m")?;
    all.push(Quantity::at_most(
        "power-on: bridge supply until the first test, at most",
        sound.get("most")?,
        "V",
        0.5,
    ));
    Ok(all)
}

/// 3.3 V is disconnected at 46 ms by a switch in its wire.
fn simulate_open(netlists: &Netlists, warm: &str, more: &str) -> Result<ngspice::Measured> {
    let wire = more.replace(
        "Ropen v3s v3 1",
        "Sopen v3q v3 keep 0 wire\nVopen v3q 0 3.3\nVkeep keep 0 PWL(0 1 46m 1 46.01m 0)\n.model wire sw(vt=0.5 vh=0.1 ron=10m roff=100meg)",
    );
    let deck = format!(
        "V12 v12 0 PULSE(0 12 0 1m)\nVt tc 0 {warm}\nVstop stop 0 1\n\
         Vtest test 0 PWL(0 0 20m 0 20.01m 3.3 40m 3.3 40.01m 0)\nVside side 0 0\n\
         Xn pin 0 tc ntc\nX1 v3 pin in adc divider\nX2 v3 v5 in test side nrst on trip nfault window\nRn v3 nrst 40k\n\
         X3 v12 v3 stop vstop stopped v5 supply\nX4 vstop vbr on trip vbr_sense supply_switch\nR1 v3 nfault 4.7k\n\
         .options reltol=1e-3 abstol=1n vntol=1m method=gear\n.tran 20u 100m 0 50u\n{wire}\n"
    );
    ngspice::run("open-3v3", netlists, &deck)
}

/// The thermistor leaves the window while the bridge is supplied.
fn excursions(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let (v3, _) = self_test::SOUND;
    let mut all = Vec::new();
    for (what, temperature) in [
        ("46 °C", "PWL(0 25 45m 25 45.1m 46)"),
        ("9 °C", "PWL(0 25 45m 25 45.1m 9)"),
        ("thermistor open", "PWL(0 25 45m 25 45.01m -150)"),
        ("thermistor shorted", "PWL(0 25 45m 25 45.01m 400)"),
    ] {
        let more = ".meas tran open_at when v(on)=1 fall=1 td=45m";
        let measured = self_test::simulate(netlists, v3, temperature, more)?;
        all.push(Quantity::between(
            format!("{what}: until the switch opens"),
            measured.get("open_at")? * 1e3 - 45.0,
            "ms",
            (0.0, 10.0),
        ));
    }
    Ok(all)
}

/// The contact opens at 0.1 ms while the microcontroller drives at full duty, and goes on.
const EMERGENCY_STOP: &str = "V3 v3 0 3.3\nV12 v12 0 12\nVstop stop 0 PWL(0 1 0.1m 1 0.101m 0)\nVon on 0 5\nVtrip trip 0 0\n\
        Vin1 in1 0 3.3\nVin2 in2 0 0\nVen enable 0 3.3\n\
        X3 v12 v3 stop vstop stopped v5 supply\nX4 vstop vbr on trip vbr_sense supply_switch\n\
        X5 vbr v3 in1 in2 enable nfault p n sa sb bridge\nVi p pt 0\nXt pt n tile\n\
        .options reltol=3e-3 abstol=10u vntol=5m chgtol=1e-12 method=gear itl4=50\n.tran 40n 1m 0 500n";

fn emergency_stop(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let lines = format!(
        "{EMERGENCY_STOP}\n\
        .meas tran after max i(vi) from=0.9m to=1m\n.meas tran sensed find v(stopped) at=1m\n\
        {before}",
        before = measure::mean("before", "i(vi)", 0.06e-3..0.1e-3),
    );
    let measured = ngspice::run("emergency-stop", netlists, &lines)?;
    Ok(vec![
        Quantity::at_least(
            "emergency stop: tile current before",
            measured.get("before")?,
            "A",
            5.0,
        ),
        Quantity::at_most(
            "emergency stop: tile current 0.8 ms later, inputs still driving",
            measured.get("after")?,
            "A",
            0.2,
        ),
        Quantity::at_most(
            "emergency stop: sense line 0.9 ms later (low below 0.99 V)",
            measured.get("sensed")?,
            "V",
            0.5,
        ),
    ])
}

/// The plate warms from 25 to 46 °C at 45 ms.
fn trip_scene() -> Scene {
    Scene {
        lines: self_test::deck(self_test::SOUND.0, "PWL(0 25 45m 25 45.1m 46)"),
        time: ("time, ms", 1e3),
        range: 44.0..58.0,
        charts: &[
            ("°C", &[("second display thermistor", "v(tc)", 1.0)]),
            (
                "V",
                &[
                    ("input of the comparators", "v(x2.buf)", 1.0),
                    ("hot threshold", "v(x2.hot)", 1.0),
                ],
            ),
            ("V", &[("latch: high closes the switch", "v(on)", 1.0), ("nFAULT", "v(nfault)", 1.0)]),
            ("V", &[("bridge supply", "v(vbr)", 1.0)]),
        ],
    }
}

fn stop_scene() -> Scene {
    Scene {
        lines: EMERGENCY_STOP.into(),
        time: ("time, ms; the button is pressed at 0.1 ms", 1e3),
        range: 0.0..1.0,
        charts: &[
            ("V", &[("bridge supply", "v(vbr)", 1.0), ("sense line (PC13)", "v(stopped)", 1.0)]),
            ("A", &[("tile current", "i(vi)", 1.0)]),
        ],
    }
}
