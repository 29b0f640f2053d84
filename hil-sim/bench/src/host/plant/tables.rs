//! The figures as text: tables in Markdown, aligned for the terminal, and the page around them.
use super::super::tables::{grid, short};
use super::bodies::{CONTACT_S, COUNTS_FROM_S, FORCES_N, OBJECTS, REPORTED_FROM_S};
use super::figures::{Cost, CutFigures, Figures};
use super::finger::{DURATION_S, FORCE_N, OBJECT};

/// Name of the plot beside the page.
const SVG: &str = "plant-benchmark.svg";

/// All tables with their explanations.
pub fn tables(figures: &Figures) -> String {
    let fingers = grid(
        &["fingers", "us a finger and ms", "(fastest)", "x one finger", "x real time"],
        figures.fingers.iter().map(|f| row(f.fingers.to_string(), &f.cost)),
    );
    let parts = grid(
        &["of one finger", "us a ms", "(fastest)", "x one finger", "x real time"],
        figures.parts.iter().map(|part| row(part.name.into(), &part.cost)),
    );
    let heads = [
        "growth",
        "cells",
        "step / ms",
        "us a step",
        "x one finger",
        "x real time",
        "surfaces / mK",
        "receptors / mK",
        "flux / (dT/R)",
        "surfaces before",
        "receptors before",
        "flux before",
    ];
    let meshes = grid(&heads, figures.meshes.iter().map(cut));
    let steps = grid(&heads, figures.steps.iter().map(cut));
    let forces = FORCES_N.map(|n| n.to_string()).join(" and ");
    format!(
        "{fingers}\n\
         A finger is the native plant with its truth (the same finger on the real object), sensors, converter \
         and the firmware's logic in ticks of 1 ms, on {OBJECT} at {FORCE_N} N, half-spaces cut for \
         {DURATION_S} s; all fingers take turns in every millisecond on one core. The cost of all of them grows \
         with the power {power:.3} of their number (1 is linear). Host: {host}, medians of {rounds} rounds in \
         which everything on this page takes its turn; ratios are those of the same round.\n\n\
         {parts}\n\
         The first three rows are the parts of a finger, measured separately with recorded samples and a fixed \
         bridge state; the rest of a finger's time is the engine that connects them.\n\n\
         {meshes}\n\
         The two fingers, the object and the tile without the rest, in steps of 1 ms: a step costs {none:.2} us \
         and {cell:.1} ns for each cell of all three slabs, within {off:.1} %. {cells} cells are what every run \
         uses: the surface needs fewer, because the mesh is optimised for it; the receptors need them.\n\n\
         {steps}\n\
         Errors are the largest of the surfaces of skin and object, of the skin at its receptors (0.16 and 0.45 \
         mm deep) and of the flux, over {objects} at {forces} N for {CONTACT_S} s at a step of 10 K, against \
         Eq. 6-5 to 6-7, and 6-5 continued into the skin, at the end of every step and sub-step from {counts} \
         ms on; \"before\": from {reported} ms to {counts} ms. The aim is 1 mK at the surfaces and 1e-4 of the flux \
         from {counts} ms on. The first sub-step is the step halved seven times.\n",
        power = figures.fingers_power,
        host = figures.host,
        rounds = figures.rounds,
        none = figures.no_cells_ns * 1e-3,
        cell = figures.cell_ns,
        off = figures.worst_off_line * 1e2,
        cells = figures.cells,
        objects = OBJECTS.join(", "),
        counts = COUNTS_FROM_S * 1e3,
        reported = REPORTED_FROM_S * 1e3,
    )
}

/// The tables as a page with the plot.
pub fn page(figures: &Figures) -> String {
    format!(
        "# Cost of the simulated plant\n\n\
         Written by `cargo xtask bench plant --out docs`. Times are those of one host in one run; ratios are \
         comparable between hosts, and errors, up to rounding, do not depend on the host.\n\n\
         ![Cost of a finger against their number, and error against run time over meshes and steps]({SVG})\n\n{}",
        tables(figures)
    )
}

fn row(name: String, cost: &Cost) -> Vec<String> {
    vec![
        name,
        format!("{:.2}", cost.ns * 1e-3),
        format!("{:.2}", cost.least_ns * 1e-3),
        format!("{:.3}", cost.ratio),
        format!("{:.0}", cost.times_real_time),
    ]
}

fn cut(cut: &CutFigures) -> Vec<String> {
    let (now, before) = (&cut.errors.counted, &cut.errors.before);
    vec![
        format!("{:.2}", cut.growth),
        cut.cells.to_string(),
        cut.step_ms.to_string(),
        format!("{:.2}", cut.step_ns * 1e-3),
        format!("{:.3}", cut.cost.ratio),
        format!("{:.0}", cut.cost.times_real_time),
        short(now.surface_mk),
        short(now.inside_mk),
        format!("{:.1e}", now.flux),
        short(before.surface_mk),
        short(before.inside_mk),
        format!("{:.1e}", before.flux),
    ]
}
