//! Heat-flux sensor: gain, zero, lag, noise, each wire broken, and the error budget.

use anyhow::Result;

use super::current_measurement::COUNTS_PER_V;
use super::{Bench, PERIOD_S};
use crate::netlist::Netlists;
use crate::ngspice;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "flux",
    title: "heat-flux sensor: 8.4 W/m2 a count, zero, lag, noise, each wire broken, error budget",
    parts: &[run],
    // Without the filter's capacitor the amplifiers' noise is that of their whole bandwidth.
    broken: |netlists| netlists.scaled("c_flux_filter", 1e-3),
    pictures: &[],
};

/// Code without flux in an ideal circuit, counts.
const MID_SCALE: f64 = 2048.0;
/// Codes that a sensor with sound wires has.
const SOUND_CODES: (f64, f64) = (64.0, 4031.0);

/// Temperature by which the board changes between two zeros, K.
const BOARD_K: f64 = 2.0;
/// Drift of the amplifier's offset, V/K, at most (recalled, check).
const OFFSET_V_K: f64 = 15e-9;
/// Thermal voltages of board and connector, V, which solder and copper of slightly different temperatures make (class value).
const THERMAL_V: f64 = 50e-9;
/// Drift of a thin-film resistor of 0.1 %, 1/K, and of a thick-film one of 100 Mohm (class values).
const RESISTOR_1_K: f64 = 25e-6;
const PULL_1_K: f64 = 500e-6;
/// Non-linearity of the converter that is left where its steps have been measured and corrected, and all of it, counts.
const NONLINEARITY_LEFT: f64 = 0.3;
const NONLINEARITY: f64 = 1.5;
/// Film of air on the display, W/(m2 K), and by how much display and room differ when the zero is taken, K.
const FILM_W_M2K: f64 = 10.0;
const ROOM_K: f64 = 0.2;
/// Noise of one conversion, counts: that of the plant's converter.
const CONVERTER_COUNTS: f64 = 0.7;
/// What the bridge's return adds, V: less than 0.2 mV at one phase of the PWM, by the bench `ground` (estimate).
const BRIDGE_V: f64 = 0.19e-3;
/// Parts of the gain's error, %, one standard deviation (estimates; the first is that of a block of known effusivity).
const GAIN_PERCENT: [(&str, f64); 6] = [
    ("gain, effusivity of the phantom", 1.0),
    ("gain, fit to the contact of the phantom", 0.4),
    ("gain, sensor against contact", 0.8),
    ("gain, 15 to 42 C", 0.2),
    ("gain, resistors", 0.1),
    ("gain, ageing", 0.3),
];

/// The sensor with a flux from a source of this description, kW/m2, behind further lines; `wire` has the lines between
/// thermopile (`tp`, `tm`) and connector (`cp`, `cm`).
fn deck(flux: &str, wire: &str, more: &str) -> String {
    format!(
        "V3 v3 0 3.3\nIq 0 q {flux}\n\
         Xt tp tm q thermopile m={{flux_layer_m}} w_mk={{flux_layer_w_mk}} j_m3k={{flux_layer_j_m3k}} \
         pairs={{flux_pairs}} seebeck={{flux_seebeck}} ohm={{r_thermopile}}\n{wire}\nX1 v3 cp cm adc flux\n\
         .options gmin=1e-14 reltol=1e-6 vntol=1n abstol=1p\n{more}"
    )
}

/// Both wires of the thermopile.
const WIRES: &str = "Rp tp cp 0.1\nRm tm cm 0.1";

/// Codes at fluxes, kW/m2.
fn codes<const N: usize>(
    netlists: &Netlists,
    wire: &str,
    flux_kw_m2: [f64; N],
) -> Result<[f64; N]> {
    let mut more = ".dc Iq -18 18 1\n".to_owned();
    for (number, at) in flux_kw_m2.iter().enumerate() {
        more += &format!(".meas dc code{number} find v(adc) at={at}\n");
    }
    let measured = ngspice::run("flux", netlists, &deck("0", wire, &more))?;
    let mut codes = [0.0; N];
    for (number, code) in codes.iter_mut().enumerate() {
        *code = measured.get(&format!("code{number}"))? * COUNTS_PER_V;
    }
    Ok(codes)
}

/// Standard deviation of the pin's voltage, V.
fn noise_v(netlists: &Netlists) -> Result<f64> {
    // Without an analysis outside of the control block ngspice reports that it has run none.
    let more = ".control\nnoise v(adc) Iq dec 20 0.01 1meg\nprint onoise_total\n.endc\n\
                .dc Iq 0 1 1\n.meas dc unused find v(adc) at=0\n";
    ngspice::run("flux-noise", netlists, &deck("0 ac 1", WIRES, more))?.get("onoise_total")
}

/// Time from a step of the flux to 63 % of the reading, and mean delay of the reading, s.
fn lag_s(netlists: &Netlists, zero: f64, counts_per_w_m2: f64) -> Result<[f64; 2]> {
    let level_v = |share: f64| (zero + share * 1e3 * counts_per_w_m2) / COUNTS_PER_V;
    let (none_v, most_v) = (level_v(0.0), level_v(1.0));
    let more = format!(
        ".tran 50u 61m 0 50u\n.meas tran reached when v(adc)={} rise=1\n.meas tran sum integ v(adc) from=1m to=61m\n",
        level_v(1.0 - (-1f64).exp())
    );
    let step = deck("PULSE(0 1 1m 1u 1u 1 2)", WIRES, &more);
    let measured = ngspice::run("flux-step", netlists, &step)?;
    let delay_s = (0.06 * most_v - measured.get("sum")?) / (most_v - none_v);
    Ok([measured.get("reached")? - 1e-3, delay_s])
}

/// Time from the break of a wire to a code that no sound wires have, s.
fn break_s(netlists: &Netlists) -> Result<f64> {
    let wires = "Vb break 0 PULSE(1 0 1m 1u 1u 1 2)\nSp tp cp break 0 breaks\nRm tm cm 0.1\n\
                 .model breaks sw(vt=0.5 vh=0.1 ron=0.1 roff=1t)";
    let more = format!(
        ".tran 50u 100m 0 50u\n.meas tran rail when v(adc)={} rise=1\n",
        SOUND_CODES.1 / COUNTS_PER_V
    );
    let measured = ngspice::run("flux-break", netlists, &deck("0", wires, &more))?;
    Ok(measured.get("rail")? - 1e-3)
}

/// Ripple of the pin's voltage from peak to peak, V: the tile's terminal under PWM, through its ceramic to the plate, and from
/// there through the layer to the thermopile.
fn ripple_v(netlists: &Netlists) -> Result<f64> {
    let high_s = 0.5 * PERIOD_S;
    let more = format!(
        "Vt tile 0 PULSE(0 12 0 30n 30n {high_s:e} {PERIOD_S:e})\nVm mains 0 0\nVu usb 0 0\n\
         Xl mains 0 tile plate usb leakage\nCl plate tp {{c_flux_layer}}\n.tran 0.5u 0.4m 0.3m 0.2u\n\
         .meas tran ripple pp v(adc) from=0.3m to=0.4m\n"
    );
    ngspice::run("flux-ripple", netlists, &deck("0", WIRES, &more))?.get("ripple")
}

/// Voltage at the amplifier's input with 12 V on a wire of the connector.
fn input_v(netlists: &Netlists, wire: &str) -> Result<f64> {
    let wires = format!("{WIRES}\nVs s 0 12\nRs s {wire} 1");
    let more = ".dc Iq 0 1 1\n.meas dc input find v(x1.p) at=0\n";
    ngspice::run("flux-12v", netlists, &deck("0", &wires, more))?.get("input")
}

/// Root of the sum of squares.
fn root(parts: &[f64]) -> f64 {
    parts.iter().map(|part| part * part).sum::<f64>().sqrt()
}

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let [zero, minus, plus, most, least] = codes(netlists, WIRES, [0.0, -10.0, 10.0, 16.0, -16.0])?;
    let counts_per_w_m2 = (plus - minus) / 20e3;
    let off_w_m2 = |code: f64| (code - zero) / counts_per_w_m2;
    let zero_of = |netlists: &Netlists| -> Result<f64> {
        let [code] = codes(netlists, WIRES, [0.0])?;
        Ok(off_w_m2(code))
    };
    let noise_w_m2 = noise_v(netlists)? * COUNTS_PER_V / counts_per_w_m2;
    let [reached_s, delay_s] = lag_s(netlists, zero, counts_per_w_m2)?;
    let mut all = vec![
        Quantity::between("gain", 1e3 * counts_per_w_m2, "counts/(kW/m2)", (118.0, 120.4)),
        Quantity::between(
            "straight line, error from -16 to 16 kW/m2",
            f64::max(
                (most - zero - 16e3 * counts_per_w_m2).abs(),
                (least - zero + 16e3 * counts_per_w_m2).abs(),
            ),
            "counts",
            (0.0, 0.5),
        ),
        Quantity::between(
            "zero by the pull, which the device takes away",
            zero - MID_SCALE,
            "counts",
            (-60.0, 60.0),
        ),
        Quantity::at_most(
            "zero by an offset of 2.5 uV, which the device takes away",
            zero_of(&netlists.with("vos_flux", 2.5e-6)?)?.abs(),
            "W/m2",
            60.0,
        ),
        Quantity::between("step of the flux to 63 %", 1e3 * reached_s, "ms", (4.5, 5.5)),
        Quantity::between("mean delay", 1e3 * delay_s, "ms", (4.2, 5.5)),
        Quantity::at_most(
            "ripple by the PWM through ceramic and layer",
            ripple_v(netlists)? * COUNTS_PER_V / counts_per_w_m2,
            "W/m2",
            0.5,
        ),
        Quantity::at_least(
            "the same without C5 and with 1 nF at the pin: what they are for",
            ripple_v(&(netlists.with("c_flux_adc", 1e-9)?).with_line("C5 tm 0", "")?)?
                * COUNTS_PER_V
                / counts_per_w_m2,
            "W/m2",
            20.0,
        ),
    ];
    for (fault, wire) in [
        ("wire tp broken", "Rp tp cp 1e12\nRm tm cm 0.1"),
        ("wire tm broken", "Rp tp cp 0.1\nRm tm cm 1e12"),
        ("wire tp at ground", "Rp tp cp 0.1\nRm tm cm 0.1\nRs cp 0 1"),
        ("wire tm at ground", "Rp tp cp 0.1\nRm tm cm 0.1\nRs cm 0 1"),
    ] {
        let [code] = codes(netlists, wire, [0.0])?;
        let (first, last) = SOUND_CODES;
        all.push(Quantity::at_least(
            format!("{fault}: beyond the codes of sound wires by"),
            f64::max(first - code, code - last),
            "counts",
            0.0,
        ));
    }
    all.push(Quantity::at_most(
        "wire tp breaks: beyond them after",
        1e3 * break_s(netlists)?,
        "ms",
        10.0,
    ));
    let [shorted] = codes(netlists, &format!("{WIRES}\nRs cp cm 0.1"), [10.0])?;
    all.push(Quantity::at_most(
        "wires shorted: 10 kW/m2 reads as (no rail shows it)",
        off_w_m2(shorted).abs(),
        "W/m2",
        100.0,
    ));
    for wire in ["cp", "cm"] {
        let volt = input_v(netlists, wire)?;
        all.push(Quantity::at_most(
            format!("12 V on {wire}: at the amplifier's input"),
            volt,
            "V",
            4.3,
        ));
    }
    all.extend(budget(netlists, counts_per_w_m2, &zero_of, noise_w_m2)?);
    Ok(all)
}

/// The error budget in one standard deviation; the page `docs/flux.md` says how each line is derived.
fn budget(
    netlists: &Netlists,
    counts_per_w_m2: f64,
    zero_of: &impl Fn(&Netlists) -> Result<f64>,
    amplifier_w_m2: f64,
) -> Result<Vec<Quantity>> {
    let per_v = COUNTS_PER_V / counts_per_w_m2;
    let sensitivity_v = netlists.param("flux_pairs")?
        * netlists.param("flux_seebeck")?
        * netlists.param("flux_layer_m")?
        / netlists.param("flux_layer_w_mk")?;
    let nonlinearity_w_m2 = NONLINEARITY_LEFT / counts_per_w_m2;
    let zero = [
        (
            "zero, drift of the amplifier",
            zero_of(&netlists.with("vos_flux", OFFSET_V_K * BOARD_K)?)?.abs(),
        ),
        ("zero, thermal voltages", THERMAL_V / sensitivity_v),
        (
            "zero, drift of the pull",
            zero_of(&netlists.scaled("r_flux_broken", 1.0 + PULL_1_K * BOARD_K)?)?.abs(),
        ),
        (
            "zero, drift of the mid-point",
            // The drifts of two resistors are independent.
            zero_of(&netlists.scaled("r_flux_top", 1.0 + 2f64.sqrt() * RESISTOR_1_K * BOARD_K)?)?
                .abs(),
        ),
        ("zero, non-linearity of the converter", nonlinearity_w_m2),
        ("zero, air film when it is taken", FILM_W_M2K * ROOM_K),
    ];
    let noise = [
        ("noise, converter", CONVERTER_COUNTS / counts_per_w_m2),
        ("noise, amplifiers and resistors", amplifier_w_m2),
        ("noise, bridge", BRIDGE_V * per_v),
    ];
    let sum =
        |lines: &[(&str, f64)]| root(&lines.iter().map(|(_, part)| *part).collect::<Vec<_>>());
    let (zero_w_m2, noise_w_m2, gain) = (sum(&zero), sum(&noise), sum(&GAIN_PERCENT));
    // Uniform within its bound.
    let uncorrected_w_m2 = NONLINEARITY / 3f64.sqrt() / counts_per_w_m2;
    let quantisation_w_m2 = 12f64.sqrt().recip() / counts_per_w_m2;
    let line = |unit, most: f64| {
        move |(name, part): &(&str, f64)| Quantity::at_most(*name, *part, unit, most)
    };
    let mut all: Vec<_> = zero.iter().map(line("W/m2", 3.0)).collect();
    all.push(Quantity::at_most("zero, all", zero_w_m2, "W/m2", 3.6));
    all.push(Quantity::at_most(
        "zero, all, with a converter that nobody has corrected",
        (zero_w_m2.powi(2) - nonlinearity_w_m2.powi(2) + uncorrected_w_m2.powi(2)).sqrt(),
        "W/m2",
        10.0,
    ));
    all.extend(noise.iter().map(line("W/m2", 6.5)));
    all.push(Quantity::at_most("noise, all", noise_w_m2, "W/m2", 6.8));
    all.push(Quantity::at_most(
        "noise, with quantisation",
        root(&[noise_w_m2, quantisation_w_m2]),
        "W/m2",
        7.2,
    ));
    all.extend(GAIN_PERCENT.iter().map(line("%", 1.0)));
    all.push(Quantity::at_most("gain, all", gain, "%", 1.5));
    Ok(all)
}
