//! What five fingers share: the relay of the emergency stop, and the 12 V supply.

use anyhow::Result;

use super::transients::OPTIONS;
use super::{Bench, PERIOD_OF_FIVE_FINGERS_S};
use crate::measure;
use crate::netlist::Netlists;
use crate::ngspice::{self, Measured};
use crate::picture::Scene;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "five-fingers",
    title: "five fingers: relay of the emergency stop, welded contact, current of the 12 V supply",
    parts: &[run],
    // The relay's contact is welded.
    broken: |netlists| weld(netlists),
    pictures: &[("stop-relay", scene)],
};

/// When the button is pressed, ms.
const PRESSED_MS: f64 = 20.0;
/// Bridge supply above which the relay has not opened, V, and how long after the button to look, ms.
const STILL_ON: (f64, f64) = (9.0, 200.0);
/// Least supply current of a gate driver, A (SLVSDR9E): all that discharges a bridge supply if nothing drives.
const DRIVER_A: f64 = 5.5e-3;
/// Supply current of a finger at 6 A of tile current, A; the quantity below checks it.
const FINGER_A: f64 = 4.5;

fn weld(netlists: &Netlists) -> Result<Netlists> {
    netlists.with_line("X1 coil 0 vmain vstop relay", "R9 vmain vstop 2m")
}

/// Five fingers' switches, which are on, behind the relay. Each takes `load_a` while it has more than 5.2 V, and the current of
/// its gate driver. The button follows `stop`, 1 V while it is not pressed.
fn deck(load_a: f64, stop: &str, more: &str) -> String {
    let mut lines = format!(
        "V3 v3 0 3.3\nV12 v12s 0 12.6\nRs v12s v12l 5m\nLs v12l v12 0.5u\nRc v12 bulk 30m\nCb bulk 0 1m\n\
         Vstop stop 0 {stop}\nXr v12 v3 stop vstop sense stop_relay\nVon on 0 5\nVtrip trip 0 0\nBc across 0 V=V(xr.vmain)-V(vstop)\n"
    );
    for finger in 0..5 {
        lines += &format!(
            "Rf{finger} vstop f{finger} {{r_fuse}}\nXs{finger} f{finger} vbr{finger} on trip sense{finger} supply_switch\n\
             Bl{finger} vbr{finger} 0 I={load_a}*0.5*(1+tanh((V(vbr{finger})-5.2)/0.2))+{DRIVER_A}*tanh(V(vbr{finger}))\n"
        );
    }
    lines + ".options reltol=2e-3 abstol=1u vntol=1m method=gear\n" + more
}

fn press(netlists: &Netlists, load_a: f64) -> Result<Measured> {
    let late_ms = PRESSED_MS + STILL_ON.1;
    let lines = deck(
        load_a,
        &format!("PWL(0 1 {PRESSED_MS}m 1 20.01m 0)"),
        &format!(
            ".tran 50u 230m 0 100u uic\n.meas tran before find v(vbr0) at=19m\n\
             .meas tran opened when v(across)=0.3 rise=1 td={PRESSED_MS}m\n\
             .meas tran late find v(vbr0) at={late_ms}m\n.meas tran sensed find v(sense) at={late_ms}m\n\
             .meas tran coil min v(xr.coil)\n"
        ),
    );
    ngspice::run("stop-relay", netlists, &lines)
}

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let idle = press(netlists, 0.0)?;
    let driving = press(netlists, FINGER_A)?;
    let welded = press(&weld(netlists)?, 0.0)?;
    let released = release(netlists)?;
    let (still_on_v, late_ms) = STILL_ON;
    let mut all = vec![
        Quantity::at_least(
            "five fingers at 6 A: bridge supply before the button",
            driving.get("before")?,
            "V",
            11.0,
        ),
        Quantity::between(
            "button to relay open",
            driving.get("opened")? * 1e3 - PRESSED_MS,
            "ms",
            (0.0, 30.0),
        ),
        Quantity::at_least(
            "voltage of the coil while it is switched off",
            driving.get("coil")?,
            "V",
            -45.0,
        ),
        Quantity::at_most(
            format!("bridge supply {late_ms} ms after the button, five fingers at 6 A"),
            driving.get("late")?,
            "V",
            still_on_v,
        ),
        Quantity::at_most(
            format!("bridge supply {late_ms} ms after the button, nothing drives"),
            idle.get("late")?,
            "V",
            still_on_v,
        ),
        Quantity::at_most("sense line (low below 0.99 V)", idle.get("sensed")?, "V", 0.5),
        Quantity::at_least(
            format!("contact welded: bridge supply {late_ms} ms after the button shows it"),
            welded.get("late")?,
            "V",
            still_on_v + 1.0,
        ),
    ];
    // Ends of the contacts' and of the relay's ratings for a capacitor: short peaks weld them.
    all.push(Quantity::at_most(
        "button released while five switches are told to close: peak through the relay",
        released.get("peak")?,
        "A",
        40.0,
    ));
    let hard = netlists.with_line("M4 low hold 0 0 bss138", "Rlow low 0 1m")?;
    all.push(Quantity::at_least(
        "the same without M4 of the switches: no soft start",
        release(&hard)?.get("peak")?,
        "A",
        60.0,
    ));
    all.extend(supply(netlists)?);
    Ok(all)
}

/// The button is released at 20 ms; nothing drives.
fn release(netlists: &Netlists) -> Result<Measured> {
    let lines = deck(
        0.0,
        "PWL(0 0 20m 0 20.01m 1)",
        ".tran 20u 60m 0 20u uic\n.meas tran peak max i(vpeak) from=20m to=60m\n\
         .meas tran late find v(vbr0) at=59m\n",
    )
    .replace("Xr v12 v3", "Vpeak v12 v12r 0\nXr v12r v3");
    ngspice::run("stop-release", netlists, &lines)
}

/// Supply current of a finger whose tile takes 6 A at the largest temperature difference (8.2 V).
fn supply(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let period_s = PERIOD_OF_FIVE_FINGERS_S;
    let low_s = 0.7123 * period_s;
    let window_s = 218.75e-6 - 10.0 * period_s..218.75e-6;
    let lines = format!(
        "V3 v3 0 3.3\nVbr vbr 0 12\nVin1 in1 0 3.3\nVin2 in2 0 PULSE(3.3 0 1u 5n 5n {low_s:e} {period_s:e})\nVen enable 0 3.3\n\
         X1 vbr v3 in1 in2 enable nfault p n sa sb bridge\nVi p pt 0\nXt pt n tile seebeck=1.83\n\
         {OPTIONS}\n.tran 5n 230u 0 25n\n\
         {tile}{input}",
        tile = measure::mean("tile", "i(vi)", window_s.clone()),
        input = measure::mean("input", "i(vbr)", window_s),
    );
    let measured = ngspice::run("supply-current", netlists, &lines)?;
    let finger_a = -measured.get("input")?;
    let all_a = 5.0 * (finger_a + FAN_A) + LOGIC_A;
    Ok(vec![
        Quantity::between("tile current", measured.get("tile")?, "A", (5.9, 6.3)),
        Quantity::at_most(
            "supply current of a finger at 6 A and 8.2 V of its tile; fuse of 7.5 A",
            finger_a,
            "A",
            FINGER_A,
        ),
        Quantity::at_most(
            "five fingers, their fans and the logic; a supply of 30 A, four fifths used",
            all_a,
            "A",
            24.0,
        ),
    ])
}

/// Supply current of a fan, and of the 5 V regulator with the relay's coil, A (class values).
const FAN_A: f64 = 0.25;
/// As [`FAN_A`].
const LOGIC_A: f64 = 0.5;

fn scene() -> Scene {
    Scene {
        lines: deck(
            FINGER_A,
            &format!("PWL(0 1 {PRESSED_MS}m 1 20.01m 0)"),
            ".tran 50u 60m 0 100u uic",
        ),
        time: ("time, ms; the button is pressed at 20 ms", 1e3),
        range: 15.0..60.0,
        charts: &[
            (
                "V",
                &[("coil of the relay", "v(xr.coil)", 1.0), ("sense line (PC13)", "v(sense)", 1.0)],
            ),
            ("V", &[("bridge supply of a finger", "v(vbr0)", 1.0)]),
            ("A", &[("12 V supply", "i(v12)", -1.0)]),
        ],
    }
}
