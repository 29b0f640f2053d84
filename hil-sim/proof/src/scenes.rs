//! Scenes that cover materials, forces, control laws, faults, courses and lines of the host.
use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result};
use contact_model::material::THESIS_MATERIALS;
use thermal_client::client::upload_course;
use thermal_device::stimulus::TemperatureKind;
use thermal_sim::scene::{FaultKind, Scene};

/// Time at which each fault begins, during contact, s.
const FAULT_S: f64 = 0.5;

/// One scene for each material of the thesis, with changes of force and law, queries, and lines that are refused.
///
/// # Errors
/// A scene is refused.
pub fn touched() -> Result<Vec<(String, Scene)>> {
    let forces =
        [(0.2, 2.0), (0.5, 0.1), (0.8, 10.0), (1.2, 0.0), (1.4, 0.5), (1.8, 0.0), (1.9, 1.0)];
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
    let scene = |name: &&str| {
        let mut text = head(name, 2.5);
        for (t_s, force_n) in forces {
            writeln!(text, "[[force]]\nt_s = {t_s}\nforce_n = {force_n}")?;
        }
        for (t_s, line) in lines {
            writeln!(text, "[[host]]\nt_s = {t_s}\nline = {line:?}")?;
        }
        parsed(name, &text)
    };
    THESIS_MATERIALS.iter().map(scene).collect()
}

/// One scene for each fault, during contact, with a value at three quarters of its range.
///
/// # Errors
/// A scene is refused.
pub fn faulty() -> Result<Vec<(String, Scene)>> {
    let scene = |kind: FaultKind| {
        let mut text = head("copper", 1.5);
        if kind.needs_flux_sensor() {
            writeln!(text, "[device]\nflux_sensor = true")?;
        }
        writeln!(text, "[[force]]\nt_s = 0.2\nforce_n = 2.0")?;
        writeln!(text, "[[fault]]\nkind = \"{}\"\nt_s = {FAULT_S}", kind.name())?;
        if let Some(value) = kind.value() {
            writeln!(text, "value = {:?}", value.min + (value.max - value.min) * 0.75)?;
        }
        if kind.needs_second_sensor() {
            writeln!(text, "with = \"sink\"")?;
        }
        parsed(kind.name(), &text)
    };
    FaultKind::ALL.into_iter().map(scene).collect()
}

/// Scenes in which a landing starts a course whose points are 1 ms apart, so that each tick begins a segment: one of many points,
/// and one of two, which each tick begins again. The force rises so slowly that the course begins with the most ticks behind it.
///
/// # Errors
/// A scene is refused.
pub fn courses() -> Result<Vec<(String, Scene)>> {
    const PLAY_S: f64 = 0.5;
    const LANDING_S: f64 = 1.0;
    let scene = |(what, count, times): (&str, usize, u16)| {
        let mut text = head("copper", 2.2);
        let points: Vec<_> = (0..count)
            .map(|point| (1e-3 * point as f64, 33.0 + 0.05 * (point % 2) as f64))
            .collect();
        let upload = upload_course(TemperatureKind::Absolute, &points);
        let upload = upload.iter().map(ToString::to_string);
        let play = ["events on".into(), format!("play landing {times} neutral")];
        for line in upload.chain(play) {
            writeln!(text, "[[host]]\nt_s = {PLAY_S:?}\nline = {line:?}")?;
        }
        for (t_s, force_n) in [(LANDING_S, 0.012), (LANDING_S + 0.05, 2.0)] {
            writeln!(text, "[[force]]\nt_s = {t_s}\nforce_n = {force_n}")?;
        }
        parsed(what, &text)
    };
    [("course", 48, 20), ("course-of-two-points", 2, 1000)].into_iter().map(scene).collect()
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
