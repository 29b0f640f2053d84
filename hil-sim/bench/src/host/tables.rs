//! The figures as text: tables in Markdown, aligned for the terminal, and the page around them.
use std::fmt::Write;

use super::figures::{Figures, KernelFigures, SceneFigures};

/// Name of the plot beside the page.
pub const SVG: &str = "benchmark.svg";

/// Both tables with their explanations.
pub fn tables(figures: &Figures) -> String {
    let kernels = grid(
        &[
            "E = erfcx(sqrt(n K))",
            "worst / 2^-32",
            "mean / 2^-32",
            "worst / mK",
            "breaks at z",
            "table bytes",
            "instructions",
            "(most)",
            "cycles",
            "(most)",
            "host ns",
            "x firmware",
        ],
        figures.kernels.iter().map(kernel_row),
    );
    let scenes = grid(
        &[
            "scene",
            "arithmetic",
            "worst / mK",
            "instructions",
            "(fewest)",
            "(most)",
            "cycles",
            "(fewest)",
            "(most)",
            "host ns",
        ],
        figures.scenes.iter().map(scene_row),
    );
    format!(
        "{kernels}\n\
         Errors over {} inputs, u = n K from 2^-24 to 2^16, against a 100-bit reference, without results that \
         are not numbers; in mK: error of a set-point at a step of {} K. \"Breaks\": NaN, infinite or off by \
         more than 1 %, for z up to 256. Costs of a call, call and return included: mean and largest of {} \
         inputs on the {}; {}. Host: {}, median of calls side by side.\n\n\
         {scenes}\n\
         The model's share of a control tick over {} ticks of 1 ms, skin 34 C, object 24 C, granite at 2 N \
         (streaming: 1 to 2 N, R and E in every tick); five fingers: granite, copper, stainless steel, ABS, \
         foam. Errors of the set-point against Eq. 6-12 or 3-1 in f64. Under constant force the integer path \
         follows chords within {:.1} mK and evaluates E at their ends: the fewest instructions are those of a \
         tick without an evaluation, the most those of a tick that also doubles the length of the chords; a \
         tick with an evaluation only lies between.\n\n\
         Render step: the firmware's step from force to set-point, landing included. R is computed again, and \
         the chord interpolation rebuilt, only when the force has changed. Under a streaming force the \
         set-point therefore follows the mean of the last 64 ticks with a delay, which is the error shown.\n",
        figures.inputs,
        figures.step_k,
        figures.inputs_on_target,
        figures.target,
        figures.compiler,
        figures.host,
        figures.ticks,
        figures.tolerance_mk,
    )
}

/// Explanations of the peers and of unexpected figures.
const PEERS: &str = "\
## The peers
\n\
All take the inputs of the firmware's kernel, the ticks since contact `n` and `K = b² dt`, each in its natural \
type, and return `E`; computing `z = sqrt(n K)` is part of their cost and error. In `f32` rounding `K`, the \
product and its root causes up to 141 units of error before anything is evaluated, and rounding the result 128 \
more: most of the error of the quadratic tables of 16 and 64 KiB. Coefficients are derived by `hil-sim/bench/build.rs`.

- libm: `exp(u) erfc(z)`. On this FPU `f64` is software. Near the z at which it breaks, all of its error is the \
rounding of `z`, amplified by `2 z²`. Beyond, it returns early, which lowers its mean cost.
- micromath: its `exp`. Its `sqrt` is off by up to 6.07 %, which would dominate, so the FPU's is used throughout. \
Its `ln`, which nothing here needs, is off by up to 0.118 below 1.
- Abramowitz and Stegun, *Handbook of Mathematical Functions*, 7.1.26: the polynomial is `erfc(z) exp(z²)` to \
1.5e-7 times `exp(z²)`.
- Shepherd and Laframboise, *Mathematics of Computation* 36 (1981): `(1 + 2z) erfcx(z)` as a polynomial in \
`(z - 3.75) / (z + 3.75)`, 12 coefficients, two divisions. The compiler does not fuse multiplications with \
additions, so each step of its Horner chain rounds twice.
- Faddeeva structure: a hundred parts of `4 / (4 + z)`, degree 6, as in S. G. Johnson's package.
- Tables: equal steps of `z` up to 16, then three terms of the asymptotic series.
- One polynomial: degree 14 in `1 / (1 + z/2)`, in integers after a root and a reciprocal that begin on the FPU.

The square root is the FPU's `VSQRT`, reached through core registers, which costs up to four moves that an \
intrinsic would save. Rust keeps a frame in every function of this target, three instructions of each call.
";

/// The tables as a page with the plot.
pub fn page(figures: &Figures) -> String {
    format!(
        "# Run time against error\n\n\
         Written by `cargo xtask bench --out docs`. Instructions and cycles are those of an emulated STM32F446 \
         and the same on every host for the same compiler; nanoseconds are not. Nobody has run this on silicon.\n\n\
         ![Worst error against estimated cycles]({SVG})\n\n{}\n{PEERS}",
        tables(figures)
    )
}

fn kernel_row(kernel: &KernelFigures) -> Vec<String> {
    let accuracy = &kernel.accuracy;
    let cost = &kernel.cost;
    vec![
        kernel.title.into(),
        short(accuracy.worst_units),
        short(accuracy.mean_units),
        short(accuracy.worst_mk),
        accuracy.breaks_at_z.map_or("never".into(), |z| format!("{z:.2}")),
        kernel.table_bytes.map_or("in code".into(), |bytes| bytes.to_string()),
        format!("{:.0}", cost.instructions_mean),
        cost.instructions_max.to_string(),
        format!("{:.0}", cost.cycles_mean),
        cost.cycles_max.to_string(),
        format!("{:.1}", kernel.host_ns),
        format!("{:.2}", kernel.host_ratio),
    ]
}

fn scene_row(scene: &SceneFigures) -> Vec<String> {
    let cost = &scene.cost;
    let broken = scene.breaks_at_s.map_or(String::new(), |at| format!(", none from {at:.3} s"));
    vec![
        scene.kind.into(),
        scene.arithmetic.into(),
        format!("{}{broken}", short(scene.worst_mk)),
        format!("{:.0}", cost.instructions_mean),
        cost.instructions_min.to_string(),
        cost.instructions_max.to_string(),
        format!("{:.0}", cost.cycles_mean),
        cost.cycles_min.to_string(),
        cost.cycles_max.to_string(),
        format!("{:.1}", scene.host_ns),
    ]
}

/// Writes a number with three significant digits.
pub(super) fn short(value: f64) -> String {
    match value {
        0.0 => "0".into(),
        v if !(1e-3..1e5).contains(&v) => format!("{v:.1e}"),
        v => {
            let digits = (2 - v.log10().floor() as i32).clamp(0, 5) as usize;
            format!("{v:.digits$}")
        }
    }
}

/// A Markdown table; the first column is left-aligned, all others are right-aligned.
pub(super) fn grid(heads: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let rows: Vec<Vec<String>> = rows.collect();
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count());
        cells.max().unwrap_or(0).max(heads[column].chars().count())
    };
    let widths: Vec<usize> = (0..heads.len()).map(width).collect();
    let mut text = String::new();
    let mut line = |cells: Vec<String>| {
        for (column, (cell, width)) in cells.iter().zip(&widths).enumerate() {
            // Writing to a String cannot fail.
            let _ = match column {
                0 => write!(text, "| {cell:<width$} |"),
                _ => write!(text, " {cell:>width$} |"),
            };
        }
        text.push('\n');
    };
    line(heads.iter().map(|head| (*head).into()).collect());
    line(
        widths
            .iter()
            .enumerate()
            .map(|(column, width)| match column {
                0 => "-".repeat(*width),
                _ => "-".repeat(width - 1) + ":",
            })
            .collect(),
    );
    rows.into_iter().for_each(line);
    text
}
