//! The figures as text: tables in Markdown, aligned for the terminal, and the page around them.
use std::fmt::Write;

use super::figures::{Figures, KernelFigures, SceneFigures};

/// Name of the plot beside the page.
pub const SVG: &str = "benchmark.svg";

/// Both tables with what they mean.
#[must_use]
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
            "(most)",
            "cycles",
            "(most)",
            "host ns",
        ],
        figures.scenes.iter().map(scene_row),
    );
    format!(
        "{kernels}\n\
         Errors over {} inputs, u = n K from 2^-24 to 2^16, against a 100-bit reference, of the results that are \
         numbers; in mK of a set-point at a step of {} K. \"Breaks\": NaN, infinite or off by more than 1 %, for z up \
         to 256. Costs of a call, call and return included: mean and most of {} inputs on the {}. Host: {}, median of \
         calls side by side.\n\n\
         {scenes}\n\
         The model's share of a control tick over {} ticks of 1 ms, skin 34 C, object 24 C, granite at 2 N (streaming: \
         1 to 2 N); five fingers: granite, copper, stainless steel, ABS, foam. Errors of the set-point against \
         Eq. 6-12 or 3-1 in f64.\n",
        figures.inputs, figures.step_k, figures.inputs_on_target, figures.target, figures.host, figures.ticks,
    )
}

/// The tables as a page with the plot.
#[must_use]
pub fn page(figures: &Figures) -> String {
    format!(
        "# Run time against error\n\n\
         Written by `cargo xtask bench`; the instructions and cycles come out the same on every machine, the \
         nanoseconds are this machine's. Nobody has run this on silicon.\n\n\
         ![Worst error against estimated cycles]({SVG})\n\n{}",
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
        kernel
            .table_bytes
            .map_or("in code".into(), |bytes| bytes.to_string()),
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
    let broken = scene
        .breaks_at_s
        .map_or(String::new(), |at| format!(", none from {at:.3} s"));
    vec![
        scene.kind.into(),
        scene.arithmetic.into(),
        format!("{}{broken}", short(scene.worst_mk)),
        format!("{:.0}", cost.instructions_mean),
        cost.instructions_max.to_string(),
        format!("{:.0}", cost.cycles_mean),
        cost.cycles_max.to_string(),
        format!("{:.1}", scene.host_ns),
    ]
}

/// Three digits.
fn short(value: f64) -> String {
    match value {
        0.0 => "0".into(),
        v if !(1e-3..1e5).contains(&v) => format!("{v:.1e}"),
        v => {
            let digits = (2 - v.log10().floor() as i32).clamp(0, 5) as usize;
            format!("{v:.digits$}")
        }
    }
}

/// A Markdown table: the first column to the left, all others to the right.
fn grid(heads: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let rows: Vec<Vec<String>> = rows.collect();
    let width = |column: usize| {
        let cells = rows
            .iter()
            .filter_map(|row| row.get(column))
            .map(|cell| cell.chars().count());
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
