//! Scenes that cover materials, forces, control laws, faults and lines of the host.
use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result};
use contact_model::material::MATERIALS;
use thermal_sim::scene::{FaultKind, Scene};

/// Time at which each fault begins, during contact, s.
const FAULT_S: f64 = 0.5;

/// One scene for each material, with changes of force and law, queries, and lines that are refused.
///
/// # Errors
/// A scene is refused.
pub fn touched() -> Result<Vec<(String, Scene)>> {
    let forces = [
        (0.2, 2.0),
        (0.5, 0.1),
        (0.8, 10.0),
        (1.2, 0.0),
        (1.4, 0.5),
        (1.8, 0.0),
        (1.9, 1.0),
    ];
    let lines = [
        (0.4, "law pi"),
        (0.45, "state"),
        (0.7, "law pi-10hz"),
        (0.75, "settings 1"),
        (1.0, "law model"),
        (1.3, "margins"),
        (1.5, "mode semi-infinite"),
        (1.55, "material custom 0.001 30000 10000 1000 1.5"),
        (2.1, "abort"),
        (2.15, "material copper"),
        (2.2, "hold 15"),
        (2.3, "cause"),
    ];
    let scene = |(name, _): &(&str, _)| {
        let mut text = head(name, 2.5);
        for (t_s, force_n) in forces {
            writeln!(text, "[[force]]\nt_s = {t_s}\nforce_n = {force_n}")?;
        }
        for (t_s, line) in lines {
            writeln!(text, "[[host]]\nt_s = {t_s}\nline = {line:?}")?;
        }
        parsed(name, &text)
    };
    MATERIALS.iter().map(scene).collect()
}

/// One scene for each fault, during contact, with a value at three quarters of its range.
///
/// # Errors
/// A scene is refused.
pub fn faulty() -> Result<Vec<(String, Scene)>> {
    let scene = |kind: FaultKind| {
        let mut text = head("copper", 1.5);
        writeln!(text, "[[force]]\nt_s = 0.2\nforce_n = 2.0")?;
        writeln!(
            text,
            "[[fault]]\nkind = \"{}\"\nt_s = {FAULT_S}",
            kind.name()
        )?;
        if let Some(value) = kind.value() {
            writeln!(
                text,
                "value = {:?}",
                value.least + (value.most - value.least) * 0.75
            )?;
        }
        if kind.has_other() {
            writeln!(text, "with = \"sink\"")?;
        }
        parsed(kind.name(), &text)
    };
    FaultKind::ALL.into_iter().map(scene).collect()
}

fn head(material: &str, duration_s: f64) -> String {
    format!(
        "duration_s = {duration_s:?}\nskin_c = 34\nroom_c = 24\nseed = 1\n[object]\nmaterial = \"{material}\"\nstart_c = 24\n"
    )
}

fn parsed(what: &str, text: &str) -> Result<(String, Scene)> {
    let scene = Scene::parse(text, Path::new(what)).with_context(|| format!("scene {what}"))?;
    Ok((what.into(), scene))
}
