//! What the bridge does while the firmware does not run: reset, ROM boot loader, supplies that come and go in any order.

use anyhow::Result;

use super::Bench;
use super::transients::OPTIONS;
use crate::measure;
use crate::netlist::Netlists;
use crate::ngspice::{self, Measured};
use crate::picture::Scene;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "pins",
    title: "bridge off in reset, in the ROM boot loader, and while supplies come and go",
    parts: &[lines_alone, boot_loader, supplies],
    // Pull-downs of IN1, IN2 and enable too weak.
    broken: |netlists| netlists.scaled("r_in_down", 20.0),
    pictures: &[("boot-loader", boot_loader_scene), ("supplies", supplies_scene)],
};

/// The bridge's three lines, and the pull-down of each.
const LINES: [(&str, &str); 3] = [
    ("in1", "R1 in1 0 {r_in_down}"),
    ("in2", "R2 in2 0 {r_in_down}"),
    ("enable", "R3 enable 0 {r_in_down}"),
];
/// What holds the latch set while 5 V is low.
const DETECTOR: &str = "X7 v5 out detector";
/// Strongest pull-up of a pin of the microcontroller, ohm: 40 kohm, 30 at least (data sheet; recalled, check).
const PULL_UP_OHM: f64 = 30e3;
/// Input level that the AND gates (74LVC) certainly take as low, V (recalled, check).
const LOW_V: f64 = 0.8;

/// The bridge on 12 V, its lines as `pins` describes them.
fn bridge_alone(netlists: &Netlists, pins: &str) -> Result<Measured> {
    let lines = format!(
        "V3 v3 0 3.3\nVbr vbr 0 12\nX1 vbr v3 in1 in2 enable nfault p n sa sb bridge\nVi p pt 0\nXt pt n tile\n{pins}\n\
         {OPTIONS}\n.tran 20n 60u 0 100n\n\
         .meas tran in1 max v(in1)\n.meas tran in2 max v(in2)\n.meas tran enable max v(enable)\n\
         .meas tran most max i(vi)\n.meas tran least min i(vi)\n"
    );
    ngspice::run("pins", netlists, &lines)
}

/// Largest current of the tile in either direction, A.
fn current_a(measured: &Measured) -> Result<f64> {
    Ok(measured.get("most")?.max(-measured.get("least")?))
}

/// Supplies that come in any order, and go.
fn supplies(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let mut all = Vec::new();
    for (what, ramps) in orders() {
        let measured = power(netlists, &ramps)?;
        all.push(Quantity::at_most(
            format!("{what}: bridge supply, highest"),
            measured.get("supply")?,
            "V",
            1.0,
        ));
        all.push(Quantity::at_most(
            format!("{what}: tile current, largest"),
            current_a(&measured)?,
            "A",
            0.05,
        ));
    }
    // The same with the parts removed that prevent it.
    let slow = Ramps { v12: "PWL(0 0 50m 6.7 350m 7.3 400m 12)", v3: "PWL(0 0 1m 3.3)" };
    let undetected = netlists.with_line(DETECTOR, "* no detector")?;
    all.push(Quantity::at_most(
        "3.3 V first, 12 V turned up by hand: bridge supply, highest",
        power(netlists, &slow)?.get("supply")?,
        "V",
        1.0,
    ));
    all.push(Quantity::at_least(
        "the same without the 5 V detector: the latch is not set, the bridge is supplied",
        power(&undetected, &slow)?.get("supply")?,
        "V",
        5.0,
    ));
    all.extend(loss(netlists)?);
    Ok(all)
}

/// Pins in reset and with pull-ups, the bridge supplied: only the pull-downs keep it off.
fn lines_alone(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let each = |line: &dyn Fn(&str) -> String| LINES.map(|(name, _)| line(name)).join("\n");
    let leakage = each(&|name| format!("I{name} 0 {name} 1u"));
    let pull_ups = each(&|name| format!("Rup{name} {name} v3 {PULL_UP_OHM:e}"));
    let mut all = Vec::new();
    for (what, pins) in [
        ("reset, 1 uA of leakage", &leakage),
        ("pull-ups of 30 kohm in the microcontroller", &pull_ups),
    ] {
        let measured = bridge_alone(netlists, pins)?;
        for (name, _) in LINES {
            all.push(Quantity::at_most(format!("{what}: {name}"), measured.get(name)?, "V", LOW_V));
        }
        all.push(Quantity::at_most(
            format!("{what}: tile current with 12 V on the bridge"),
            current_a(&measured)?,
            "A",
            0.05,
        ));
    }
    for (name, resistor) in LINES {
        let without = netlists.with_line(resistor, "* no pull-down")?;
        all.push(Quantity::at_least(
            format!("pull-ups, without the pull-down of {name}: {name} reads high"),
            bridge_alone(&without, &pull_ups)?.get(name)?,
            "V",
            2.0,
        ));
    }
    let without = LINES
        .iter()
        .try_fold(netlists.clone(), |all, line| all.with_line(line.1, "* no pull-down"))?;
    // IN2 alone without its pull-up: both high would stop the tile too.
    let one_side = pull_ups.replace("Rupin2 in2 v3", "Rupin2 in2 0");
    all.push(Quantity::at_least(
        "pull-ups, without pull-downs: tile current",
        current_a(&bridge_alone(&without, &one_side)?)?,
        "A",
        5.0,
    ));
    Ok(all)
}

/// How the two supplies come.
struct Ramps {
    v12: &'static str,
    v3: &'static str,
}

fn orders() -> [(&'static str, Ramps); 5] {
    [
        ("3.3 V first", Ramps { v12: "PWL(0 0 100m 0 101m 12)", v3: "PWL(0 0 1m 3.3)" }),
        ("12 V first", Ramps { v12: "PWL(0 0 1m 12)", v3: "PWL(0 0 100m 0 101m 3.3)" }),
        (
            "12 V first, 3.3 V in 200 ms",
            Ramps { v12: "PWL(0 0 1m 12)", v3: "PWL(0 0 100m 0 300m 3.3)" },
        ),
        (
            "3.3 V first, 12 V in 300 ms",
            Ramps { v12: "PWL(0 0 100m 0 400m 12)", v3: "PWL(0 0 1m 3.3)" },
        ),
        ("3.3 V missing", Ramps { v12: "PWL(0 0 1m 12)", v3: "0" }),
    ]
}

/// The whole path from 12 V to the tile, the thermistor at 25 °C, pull-ups of 30 kohm on the three lines.
fn power(netlists: &Netlists, ramps: &Ramps) -> Result<Measured> {
    let pull_ups = LINES.map(|(name, _)| format!("Rup{name} {name} v3 {PULL_UP_OHM:e}"));
    let lines = path(ramps.v12, ramps.v3, &pull_ups.join("\n"))
        + "Vtest test 0 0\n.tran 50u 500m 0 500u uic\n.meas tran supply max v(vbr)\n\
           .meas tran most max i(vi)\n.meas tran least min i(vi)\n";
    ngspice::run("power-order", netlists, &lines)
}

/// The path from 12 V to the tile with the bridge's lines as `pins` describes them.
pub fn path(ramps_v12: &str, ramps_v3: &str, pins: &str) -> String {
    format!(
        "V3 v3s 0 {ramps_v3}\nR3 v3s v3 10m\nV12 v12 0 {ramps_v12}\nVt tc 0 25\nVstop stop 0 1\nVside side 0 0\n\
         Rn v3 nrst 40k\nCn nrst 0 100n\nXn pin 0 tc ntc\nX1 v3 pin in adc divider\n\
         X2 v3 v5 in test side nrst on trip nfault window\nX3 v12 v3 stop vstop stopped v5 supply\n\
         X4 vstop vbr on trip vbr_sense supply_switch\nX5 vbr v3 in1 in2 enable nfault p n sa sb bridge\n\
         Vi p pt 0\nXt pt n tile\n{pins}\n\
         .options reltol=2e-3 abstol=1u vntol=1m method=gear itl4=50\n"
    )
}

/// Reset into the ROM boot loader after the firmware has cleared the latch: the boot loader drives PB10 (enable) and PA9 (IN2)
/// high as transmitters of serial ports.
fn boot_loader(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let after = reset_into_boot_loader(netlists)?;
    let without = netlists.with_line("D1 out reset bat54", "* NRST not connected")?;
    Ok(vec![
        Quantity::at_least("reset: bridge supply before", after.get("before")?, "V", 11.0),
        Quantity::at_most(
            "reset: NRST low to switch open",
            after.get("opened")? * 1e3 - 60.0,
            "ms",
            1.0,
        ),
        Quantity::at_most(
            "ROM boot loader drives enable and IN2 high 10 ms after the reset: tile current, mean of 80 to 100 ms",
            after.get("current")?.abs(),
            "A",
            0.05,
        ),
        Quantity::at_least(
            "the same without NRST at the latch: tile current",
            reset_into_boot_loader(&without)?.get("current")?.abs(),
            "A",
            5.0,
        ),
    ])
}

/// Lines of a device whose latch is cleared by the test at 20 to 40 ms, that is reset at 60 ms for 0.1 ms and started with BOOT0
/// high.
pub const BOOT_LOADER: &str = "Vtest test 0 PWL(0 0 20m 0 20.01m 3.3 40m 3.3 40.01m 0)\n\
    Sreset nrst 0 r 0 button\nVr r 0 PWL(0 0 60m 0 60.01m 1 60.1m 1 60.11m 0)\n.model button sw(vt=0.5 vh=0.1 ron=20 roff=100meg)\n\
    Vin2 in2 0 PWL(0 0 70m 0 70.01m 3.3)\nVen enable 0 PWL(0 0 70m 0 70.01m 3.3)";

fn reset_into_boot_loader(netlists: &Netlists) -> Result<Measured> {
    let lines = path("PULSE(0 12 0 1m)", "PULSE(0 3.3 0 1m)", BOOT_LOADER)
        + ".tran 20u 100m 0 20u uic\n.meas tran before find v(vbr) at=59m\n\
           .meas tran opened when v(on)=1 fall=1 td=60m\n"
        + &measure::mean("current", "i(vi)", 80e-3..100e-3);
    ngspice::run("boot-loader", netlists, &lines)
}

/// A supply goes while the bridge drives.
fn loss(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let cleared = "Vtest test 0 PWL(0 0 20m 0 20.01m 3.3 40m 3.3 40.01m 0)\n";
    let drives = &format!(
        "{cleared}\
        Bin1 in1 0 V=V(v3)\nBin2 in2 0 V=0\nBen enable 0 V=V(v3)*0.5*(1+tanh((time-0.055)/1e-4))"
    );
    let lines = path("PULSE(0 12 0 1m)", "PWL(0 0 1m 3.3 60m 3.3 60.1m 0)", drives)
        + ".tran 20u 80m 0 20u uic\n.meas tran before find i(vi) at=59.9m\n.meas tran gone when i(vi)=0.3 fall=1 td=60m\n";
    let lost = ngspice::run("loss-3v3", netlists, &lines)?;
    let lines = path("PWL(0 0 1m 12 60m 12 160m 0)", "PULSE(0 3.3 0 1m)", drives)
        + ".tran 20u 200m 0 50u uic\n.meas tran back max i(vi) from=170m to=200m\n.meas tran most max i(vi) from=60m to=200m\n";
    let faded = ngspice::run("loss-12v", netlists, &lines)?;
    let dip = |netlists| -> Result<f64> {
        let lines = path(
            "PWL(0 0 1m 12 60m 12 60.1m 6 60.6m 6 60.7m 12)",
            "PULSE(0 3.3 0 1m)",
            &format!("{cleared}Vin1 in1 0 0\nVin2 in2 0 0\nVen enable 0 0"),
        ) + ".tran 20u 150m 0 50u uic\n.meas tran back find v(vbr) at=149m\n";
        ngspice::run("dip-12v", netlists, &lines)?.get("back")
    };
    let undetected = netlists.with_line(DETECTOR, "* no detector")?;
    Ok(vec![
        Quantity::at_most(
            "12 V dips to 6 V for 0.5 ms: bridge supply afterwards",
            dip(netlists)?,
            "V",
            6.0,
        ),
        Quantity::at_least(
            "the same without the 5 V detector: the bridge is supplied without a self-test",
            dip(&undetected)?,
            "V",
            11.0,
        ),
        Quantity::at_least("tile current before 3.3 V goes", lost.get("before")?, "A", 5.0),
        Quantity::at_most(
            "3.3 V goes while the bridge drives: until the tile current is below 0.3 A",
            lost.get("gone")? * 1e3 - 60.0,
            "ms",
            1.0,
        ),
        Quantity::at_most(
            "12 V fades in 100 ms while the bridge drives: largest tile current from then on (full duty)",
            faded.get("most")?,
            "A",
            12.0,
        ),
        Quantity::at_most("12 V faded: tile current", faded.get("back")?.abs(), "A", 0.05),
    ])
}

fn boot_loader_scene() -> Scene {
    Scene {
        lines: path("PULSE(0 12 0 1m)", "PULSE(0 3.3 0 1m)", BOOT_LOADER)
            + ".tran 20u 100m 0 20u uic",
        time: ("time, ms; latch cleared at 44 ms, reset at 60 ms, ROM boot loader at 70 ms", 1e3),
        range: 0.0..100.0,
        charts: &[
            (
                "V",
                &[
                    ("test line", "v(test)", 1.0),
                    ("NRST", "v(nrst)", 1.0),
                    ("enable and IN2", "v(enable)", 1.0),
                ],
            ),
            ("V", &[("bridge supply", "v(vbr)", 1.0)]),
            ("A", &[("tile current", "i(vi)", 1.0)]),
        ],
    }
}

fn supplies_scene() -> Scene {
    Scene {
        lines: path(
            "PWL(0 0 50m 6.7 350m 7.3 400m 12)",
            "PWL(0 0 1m 3.3)",
            "Vtest test 0 0\nVin1 in1 0 0\nVin2 in2 0 0\nVen enable 0 0",
        ) + ".tran 50u 500m 0 500u uic",
        time: ("time, ms; 12 V turned up by hand", 1e3),
        range: 0.0..500.0,
        charts: &[
            ("V", &[("12 V", "v(v12)", 1.0), ("5 V", "v(v5)", 1.0), ("3.3 V", "v(v3)", 1.0)]),
            (
                "V",
                &[
                    ("latch: high closes the switch", "v(on)", 1.0),
                    ("bridge supply", "v(vbr)", 1.0),
                ],
            ),
        ],
    }
}
