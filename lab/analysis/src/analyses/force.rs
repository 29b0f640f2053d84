//! How well participants follow a force.

use super::courses::{mean_courses, table};
use super::design::Design;
use super::left_out;
use crate::cells::{distinct, mean, over_participants};
use crate::input::{Task, Trial, finite};
use crate::picture::{Curve, Stroke, color, lines, positive_range};
use crate::report::{Section, Table, cells, numbers, words};
use thermal_session::record::StationRecord;

/// A contact with a target force.
struct Contact<'a> {
    participant: usize,
    target_n: f64,
    material: &'a str,
    station: &'a StationRecord,
}

fn contacts(task: &Task) -> Vec<Contact<'_>> {
    contacts_with_a_target(task).filter(has_force).collect()
}

/// Contacts with a target, whether a force was measured or not.
fn contacts_with_a_target(task: &Task) -> impl Iterator<Item = Contact<'_>> {
    task.trials().flat_map(|(participant, trial)| {
        let target_n = trial.record.target_force_n.and_then(finite);
        trial.stimuli().filter_map(move |stimulus| {
            let station = trial.station(stimulus.station)?;
            Some(Contact { participant, target_n: target_n?, material: stimulus.material, station })
        })
    })
}

fn has_force(contact: &Contact<'_>) -> bool {
    contact.station.force_mean_n.is_some()
}

/// Target forces in ascending order.
fn targets(contacts: &[Contact<'_>]) -> Vec<f64> {
    let mut targets = distinct(contacts.iter().map(|contact| contact.target_n));
    targets.sort_by(f64::total_cmp);
    targets
}

/// Name of a target.
fn target_name(target_n: f64) -> String {
    format!("{target_n} N")
}

/// Force and its errors by material and target.
pub fn force_matching(task: &Task) -> Section {
    let mut section = Section::new("force-matching", "Force matching").note(
        "Settled: time from the landing until the force stays within 10 % of its target, through the last 2 s of the contact at \
         least; means are of the contacts that settled. \
         Mean and SD of the force are those of the last 2 s of a contact; the RMS error is from 2 s after the landing on. n counts \
         contacts; the SEM is that of the participants' means of the force.",
    );
    let unmeasured: Vec<_> = contacts_with_a_target(task)
        .filter(|contact| !has_force(contact))
        .map(|contact| contact.participant)
        .collect();
    let what = "contacts with a target force and no measured force";
    left_out::count(&mut section, task, &unmeasured, what);
    let contacts = contacts(task);
    let short = contacts.iter().filter(|contact| contact.station.force_end_mean_n.is_none());
    let short: Vec<_> = short.map(|contact| contact.participant).collect();
    let what = "contacts too short for a force of the last 2 s, of which the other columns are";
    left_out::count(&mut section, task, &short, what);
    if contacts.is_empty() {
        section.lacks("Force", "no contact that counts has a target and a measured force");
        return section;
    }
    let mut all = Table::new(
        "force-matching",
        "Force by material and target; n counts contacts",
        [
            words("material"),
            numbers("target", "N", 2),
            words("n"),
            words("settled"),
            numbers("time to settle", "s", 2),
            numbers("force, last 2 s", "N", 3),
            numbers("SEM", "N", 3),
            numbers("error", "%", 1),
            numbers("SD within, last 2 s", "N", 3),
            numbers("RMS error", "N", 3),
            numbers("fall of skin", "K", 3),
        ],
    );
    for material in task.sorted(contacts.iter().map(|contact| contact.material)) {
        for target_n in targets(&contacts) {
            let of = || {
                contacts
                    .iter()
                    .filter(|contact| contact.material == material && contact.target_n == target_n)
            };
            let settled_s =
                |contact: &Contact<'_>| contact.station.force_settled_s.and_then(finite);
            let of_station = |value: fn(&StationRecord) -> Option<f64>| {
                mean(of().filter_map(|contact| value(contact.station).and_then(finite)))
            };
            let count = of().count();
            if count == 0 {
                continue;
            }
            let ends = of().filter_map(|contact| {
                Some((contact.participant, contact.station.force_end_mean_n?))
            });
            let (_, force_n, sem) = over_participants(&ends.collect::<Vec<_>>());
            all.row(cells![
                material,
                target_n,
                count,
                of().filter_map(settled_s).count(),
                mean(of().filter_map(settled_s)),
                force_n,
                sem,
                force_n.map(|force_n| 100.0 * (force_n / target_n - 1.0)),
                of_station(|station| station.force_end_sd_n),
                of_station(|station| station.force_error_rms_n),
                of_station(|station| station.skin_fall_k)
            ]);
        }
    }
    let names: Vec<String> = targets(&contacts).into_iter().map(target_name).collect();
    let name = |trial: &Trial, station: usize| {
        let name = trial.record.target_force_n.map(target_name)?;
        Some((name, trial.presented.get(station)?.device_finger()?))
    };
    let courses = mean_courses(&mut section, task, "force_n", &names, name);
    if courses.is_empty() {
        section.lacks("Picture of the courses", "there is no telemetry of a force");
    } else {
        let times =
            positive_range(courses.iter().flat_map(|course| course.points.iter().map(|(t, _)| *t)));
        let curves = courses.iter().enumerate().flat_map(|(series, course)| {
            let target = course.name.trim_end_matches(" N").parse().unwrap_or_default();
            let force = Curve {
                name: format!("{} (n = {})", course.name, course.contacts),
                color: color(series),
                stroke: Stroke::Solid(2),
                points: course.points.clone(),
            };
            let target = Curve {
                name: "target".into(),
                color: color(series),
                stroke: Stroke::Dashed,
                points: vec![(times.start, target), (times.end, target)],
            };
            [force, target]
        });
        let curves: Vec<_> = curves.collect();
        section.draw(
            "Mean courses of the force (lines) and targets (dashed)",
            lines(times.clone(), "time since the landing / s", "force / N", &curves),
        );
    }
    section.add(all);
    section.add(table("force-courses", "Mean courses of the force", "N", &courses));
    section
}

/// Fall, time to settle and error, by material and target.
pub fn designs(task: &Task) -> Vec<Design> {
    let contacts = contacts(task);
    let materials = task.sorted(contacts.iter().map(|contact| contact.material));
    let materials: Vec<String> = materials.into_iter().map(str::to_owned).collect();
    let forces: Vec<String> = targets(&contacts).into_iter().map(target_name).collect();
    let presented: Vec<_> = contacts_with_a_target(task).collect();
    let of = |name: &str, value: fn(&Contact<'_>) -> Option<f64>| {
        let observations: Vec<_> = contacts
            .iter()
            .filter_map(|contact| {
                let cell = (contact.material.to_owned(), target_name(contact.target_n));
                Some((contact.participant, cell, finite(value(contact)?)?))
            })
            .collect();
        // No contact with a force below the tremor may have settled.
        let has_values = |force: &&String| observations.iter().any(|(_, (_, at), _)| at == *force);
        let forces: Vec<String> = forces.iter().filter(has_values).cloned().collect();
        let design = if materials.len() > 1 {
            Design::two(name, ("material", &materials), ("force", &forces), &observations)
        } else {
            let observations: Vec<_> = observations
                .into_iter()
                .map(|(participant, (_, force), value)| (participant, force, value))
                .collect();
            Design::one(name, "force", &forces, &observations)
        };
        let materials = presented.iter().map(|contact| contact.material);
        let design =
            if design.factors.len() > 1 { design.without("material", materials) } else { design };
        design.without("force", targets(&presented).into_iter().map(target_name))
    };
    vec![
        of("fall of skin / K", |contact| contact.station.skin_fall_k),
        of("time to settle / s", |contact| contact.station.force_settled_s),
        of("RMS error over target", |contact| {
            Some(contact.station.force_error_rms_n? / contact.target_n)
        }),
    ]
}
