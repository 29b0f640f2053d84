//! Reads the faults of a scene, or reports what is wrong with them.

use toml::Spanned;

use super::processor::{self, ProcessorKind};
use super::{ActiveFault, FaultKind, ScheduledFault, Sensor};
use crate::processor::Injection;
use crate::scene::file;
use crate::scene::source::{SceneError, Source};

/// Shortest duration of a fault, s: one step of the plant.
const SHORTEST_S: f64 = 1e-3;

/// The faults of a scene and of its processor; `seed` is that of the scene.
pub(in crate::scene) fn faults(
    source: &Source<'_>,
    rows: &[Spanned<file::Fault>],
    has_flux_sensor: bool,
    duration_s: f64,
    seed: u64,
) -> Result<(Vec<ScheduledFault>, Vec<Injection>), SceneError> {
    let (mut faults, mut injections) = (Vec::new(), Vec::new());
    for row in rows {
        match ProcessorKind::from_name(row.get_ref().kind.get_ref()) {
            Some(kind) => {
                injections.push(processor::injection(source, row, kind, duration_s, seed)?)
            }
            None => {
                let fault = fault(source, row, duration_s)?;
                if fault.fault.kind.needs_flux_sensor() && !has_flux_sensor {
                    let kind = row.get_ref().kind.get_ref();
                    let problem =
                        format!("fault.kind = {kind:?} needs flux_sensor = true in [device]");
                    return Err(source.error(Some(row.get_ref().kind.span()), problem));
                }
                faults.push(fault);
                processor::no_keys(source, row)?;
            }
        }
    }
    Ok((faults, injections))
}

fn fault(
    source: &Source<'_>,
    row: &Spanned<file::Fault>,
    duration_s: f64,
) -> Result<ScheduledFault, SceneError> {
    let file::Fault { kind: word, t_s, until_s, value, sensor, with, .. } = row.get_ref();
    let kind = kind(source, word)?;
    let t_s = source.time("fault.t_s", t_s, duration_s)?;
    let until_s = match until_s {
        Some(until_s) if !kind.has_duration() => {
            return Err(meaningless_key(source, "until_s", until_s, kind, |kind| {
                kind.has_duration()
            }));
        }
        Some(until_s) => source.within("fault.until_s", until_s, t_s + SHORTEST_S, duration_s)?,
        None => f64::INFINITY,
    };
    if let Some(sensor) = sensor.as_ref().filter(|_| !kind.has_sensor()) {
        return Err(meaningless_key(source, "sensor", sensor, kind, |kind| kind.has_sensor()));
    }
    if let Some(with) = with.as_ref().filter(|_| !kind.needs_second_sensor()) {
        return Err(meaningless_key(source, "with", with, kind, |kind| kind.needs_second_sensor()));
    }
    let sensor = sensor.as_ref().map_or(Sensor::Display, |sensor| *sensor.get_ref());
    let with = match with {
        Some(with) if *with.get_ref() == sensor => {
            let problem = "fault.with names the same thermistor as fault.sensor (which is display if absent); \
                           allowed is another one";
            return Err(source.error(Some(with.span()), problem));
        }
        Some(with) => *with.get_ref(),
        None if kind.needs_second_sensor() => {
            let problem = format!(
                "fault.with is missing; {} needs one of display, check, sink, skin, room",
                kind.name()
            );
            return Err(source.error(Some(row.span()), problem));
        }
        None => sensor,
    };
    let fault =
        ActiveFault { kind, sensor, with, value: fault_value(source, row, kind, value.as_ref())? };
    Ok(ScheduledFault { fault, t_s, until_s })
}

/// The kind of a name.
fn kind(source: &Source<'_>, word: &Spanned<String>) -> Result<FaultKind, SceneError> {
    let known = FaultKind::ALL.into_iter().find(|kind| kind.name() == word.get_ref());
    known.ok_or_else(|| {
        let names = FaultKind::ALL.iter().map(|kind| kind.name());
        let names: Vec<_> = names.chain(ProcessorKind::ALL.iter().map(|kind| kind.name)).collect();
        let problem = format!("fault.kind = {:?}; known are {}", word.get_ref(), names.join(", "));
        source.error(Some(word.span()), problem)
    })
}

/// The value, within the range of its kind. For a kind without a value, 0 counts as none.
fn fault_value(
    source: &Source<'_>,
    row: &Spanned<file::Fault>,
    kind: FaultKind,
    value: Option<&file::Number>,
) -> Result<f64, SceneError> {
    let name = kind.name();
    match (kind.value(), value) {
        (Some(takes), Some(value)) => {
            let given = *value.get_ref();
            if (takes.min..=takes.max).contains(&given) {
                return Ok(given);
            }
            let problem = format!(
                "fault.value = {given} {} of {name}; allowed is {} to {}",
                takes.unit, takes.min, takes.max
            );
            Err(source.error(Some(value.span()), problem))
        }
        (Some(takes), None) => takes.default.ok_or_else(|| {
            let problem = format!(
                "fault.value is missing; {name} needs one in {}, {} to {}",
                takes.unit, takes.min, takes.max
            );
            source.error(Some(row.span()), problem)
        }),
        (None, Some(value)) if *value.get_ref() != 0.0 => {
            let problem = format!(
                "fault.value = {} of {name}, which takes none; allowed is none, or 0",
                value.get_ref()
            );
            Err(source.error(Some(value.span()), problem))
        }
        (None, _) => Ok(0.0),
    }
}

/// The error for a key that has no meaning for a kind; it lists the kinds for which `has_it` is true.
fn meaningless_key<T>(
    source: &Source<'_>,
    key: &str,
    place: &Spanned<T>,
    kind: FaultKind,
    has_it: impl Fn(FaultKind) -> bool,
) -> SceneError {
    let names = FaultKind::ALL.into_iter().filter(|kind| has_it(*kind));
    let names: Vec<_> = names.map(FaultKind::name).collect();
    let problem =
        format!("fault.{key} has no meaning for {}; it has for {}", kind.name(), names.join(", "));
    source.error(Some(place.span()), problem)
}
