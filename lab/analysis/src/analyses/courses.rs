//! Mean courses of a contact from the telemetry, and exponential fits.

use std::path::Path;

use experiment_statistics::exponential::fit_exponential;
use thermal_client::text;

use super::falls::{group, parts_with_both_modes};
use super::left_out;
use crate::cells::distinct;
use crate::input::{Task, Trial, finite};
use crate::picture::{Curve, Stroke, color, lines, positive_range};
use crate::report::{Section, Table, cells, numbers, words};

/// Width of a cell of a mean course, s.
const CELL_S: f64 = 0.1;
/// Longest course, s.
const LONGEST_S: f64 = 30.0;
/// Part of the contacts that must last as long as a point of a mean course, so that it is of the same contacts throughout.
const MOST: f64 = 0.9;

/// A contact whose course is wanted.
struct Contact {
    finger: u8,
    land_s: f64,
    lift_s: f64,
    course: usize,
}

/// A mean course: time since the landing, s, and value.
pub struct Course {
    pub name: String,
    pub contacts: usize,
    pub points: Vec<(f64, f64)>,
}

/// Mean courses of a column of the telemetry over the contacts of stations that `name` names, each with the finger of the device
/// that has measured it, in the order of `names`.
pub fn mean_courses(
    section: &mut Section,
    task: &Task,
    column: &str,
    names: &[String],
    name: impl Fn(&Trial, usize) -> Option<(String, u8)>,
) -> Vec<Course> {
    let mut sums = vec![Sums::default(); names.len()];
    let mut without = Vec::new();
    for (number, participant) in task.participants.iter().enumerate() {
        let contacts = contacts(&participant.trials, names, &name);
        if contacts.is_empty() {
            continue;
        }
        match add_telemetry(&participant.telemetry, column, &contacts, &mut sums) {
            Ok(left_out) => {
                without.extend((0..left_out.contacts).map(|_| number));
                section.warn((left_out.lines > 0).then(|| {
                    let (count, code) = (left_out.lines, &participant.code);
                    format!("Left out: damaged lines of the telemetry of {code}: {count}.")
                }));
            }
            Err(error) => {
                section.lacks("Courses", format!("telemetry of {} ({error})", participant.code));
            }
        }
    }
    let what = format!("contacts without telemetry of {column} in the mean courses");
    left_out::count(section, task, &without, &what);
    let courses = names.iter().zip(sums).map(|(name, sums)| Course {
        name: name.clone(),
        contacts: sums.contacts,
        points: sums.points(),
    });
    courses.filter(|course| course.points.len() > 1).collect()
}

/// The contacts by the time of their landing.
fn contacts(
    trials: &[Trial],
    names: &[String],
    name: impl Fn(&Trial, usize) -> Option<(String, u8)>,
) -> Vec<Contact> {
    let mut contacts = Vec::new();
    for trial in trials {
        for index in 0..trial.presented.len() {
            let land_s = trial.station(index).and_then(|station| station.land_s);
            let contact = || {
                let (name, finger) = name(trial, index)?;
                let (land_s, lift_s) = (finite(land_s?)?, finite(trial.record.lift_s?)?);
                Some(Contact {
                    finger,
                    land_s,
                    lift_s: lift_s.min(land_s + LONGEST_S),
                    course: names.iter().position(|known| *known == name)?,
                })
            };
            contacts.extend(contact().filter(|contact| contact.lift_s > contact.land_s));
        }
    }
    contacts.sort_by(|one, other| one.land_s.total_cmp(&other.land_s));
    contacts
}

/// Sums of the samples of a course by cell of time.
#[derive(Clone, Default)]
struct Sums {
    contacts: usize,
    /// Sums of the contacts' mean times and mean values, and number of contacts that have samples in the cell.
    cells: Vec<(f64, f64, usize)>,
}

impl Sums {
    /// Adds the samples of one contact, which counts once in each cell, however many samples it has there.
    fn add(&mut self, samples: &[(f64, f64)]) {
        if samples.is_empty() {
            return;
        }
        self.contacts += 1;
        let cell = |(since_s, _): &(f64, f64)| (since_s / CELL_S) as usize;
        for of_cell in samples.chunk_by(|one, other| cell(one) == cell(other)) {
            let index = cell(&of_cell[0]);
            if self.cells.len() <= index {
                self.cells.resize(index + 1, (0.0, 0.0, 0));
            }
            let (time, sum, contacts) = &mut self.cells[index];
            let count = of_cell.len() as f64;
            *time += of_cell.iter().map(|(since_s, _)| since_s).sum::<f64>() / count;
            *sum += of_cell.iter().map(|(_, value)| value).sum::<f64>() / count;
            *contacts += 1;
        }
    }

    /// Mean time and mean value of each cell.
    fn points(&self) -> Vec<(f64, f64)> {
        let least = MOST * self.contacts as f64;
        let whole =
            self.cells.iter().filter(|(.., contacts)| *contacts > 0 && *contacts as f64 >= least);
        let means =
            whole.map(|(time, sum, contacts)| (time / *contacts as f64, sum / *contacts as f64));
        means.filter(|(_, mean)| mean.is_finite()).collect()
    }
}

/// What of one participant's telemetry is in no course.
struct LeftOut {
    /// Lines that cannot be read.
    lines: usize,
    /// Contacts without a value.
    contacts: usize,
}

/// Adds the telemetry of one participant; lines that cannot be read are left out, as after an interruption.
fn add_telemetry(
    path: &Path,
    column: &str,
    contacts: &[Contact],
    sums: &mut [Sums],
) -> anyhow::Result<LeftOut> {
    let file = text::open(path, text::RECORDING_BYTES_MAX)?;
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(file);
    let headers = reader.headers()?.clone();
    if let Some(name) = text::repeated_column(&headers) {
        anyhow::bail!("it has two columns {name:?}; allowed is each name once");
    }
    let place = |name: &str| headers.iter().position(|header| header == name);
    let (Some(time), Some(finger), Some(value)) = (place("t_s"), place("finger"), place(column))
    else {
        anyhow::bail!("it has no columns t_s, finger and {column}");
    };
    let mut lines = 0;
    let mut samples: Vec<Vec<(f64, f64)>> = contacts.iter().map(|_| Vec::new()).collect();
    for row in reader.records() {
        let row = row.ok().filter(|row| row.len() == headers.len());
        let Some((row, t_s)) = row.and_then(|row| number(&row, time).map(|t_s| (row, t_s))) else {
            lines += 1;
            continue;
        };
        // A sensor may report nothing.
        let Some(value) = number(&row, value) else { continue };
        let of_finger = row.get(finger).and_then(|cell| cell.parse::<u8>().ok());
        // The last contacts that have begun; stations of a trial land at about the same time.
        let begun = contacts.partition_point(|contact| contact.land_s <= t_s);
        for index in begun.saturating_sub(8)..begun {
            let contact = &contacts[index];
            if Some(contact.finger) == of_finger && t_s < contact.lift_s {
                samples[index].push((t_s - contact.land_s, value));
            }
        }
    }
    for (contact, samples) in contacts.iter().zip(&samples) {
        sums[contact.course].add(samples);
    }
    let contacts = samples.iter().filter(|samples| samples.is_empty()).count();
    Ok(LeftOut { lines, contacts })
}

fn number(row: &csv::StringRecord, place: usize) -> Option<f64> {
    row.get(place)?.parse().ok().and_then(finite)
}

/// A table of courses, a row for each time.
pub fn table(name: &str, caption: &str, unit: &'static str, courses: &[Course]) -> Table {
    let heads = courses.iter().map(|course| numbers(course.name.clone(), unit, 4));
    let mut table = Table::new(
        name,
        caption,
        [numbers("time since the landing", "s", 2)].into_iter().chain(heads),
    );
    let longest = courses.iter().map(|course| course.points.len()).max().unwrap_or(0);
    for cell in 0..longest {
        let (from_s, to_s) = (cell as f64 * CELL_S, (cell + 1) as f64 * CELL_S);
        let at = |course: &Course| {
            course.points.iter().find(|(t, _)| (from_s..to_s).contains(t)).map(|(_, y)| *y)
        };
        let mut row = cells![0.5 * (from_s + to_s)];
        row.extend(courses.iter().map(|course| at(course).into()));
        table.row(row);
    }
    table.folded()
}

/// Exponential fits to the mean courses of the skin.
pub fn exponential_fit(task: &Task) -> Section {
    let mut section = Section::new("exponential-fit", "Course of the skin's temperature").note(
        "Mean courses of the skin thermistor in contact, in steps of 0.1 s, over all contacts of part and material, and the \
         least-squares fit T = c + a exp(−t/τ). On a sample the time counts from the tone to touch, and the finger comes later. The \
         contact of two half-spaces is no exponential: its best fits over 10 s have \
         R² of 0.84 to 0.91.",
    );
    let both = parts_with_both_modes(task);
    let name = |trial: &Trial, station: usize| {
        let stimulus = trial.stimuli().find(|stimulus| stimulus.station == station)?;
        let group = group(&trial.record.part, &stimulus, &both);
        Some(format!("{}, {}", group.part, group.material))
    };
    let mut names = Vec::new();
    for part in task.parts() {
        let own =
            task.trials().filter(|(_, trial)| trial.record.part == part).map(|(_, trial)| trial);
        let stimuli: Vec<_> =
            own.flat_map(|trial| trial.stimuli().map(move |stimulus| (trial, stimulus))).collect();
        for material in task.sorted(stimuli.iter().map(|(_, stimulus)| stimulus.material)) {
            let of = stimuli.iter().filter(|(_, stimulus)| stimulus.material == material);
            names.extend(of.filter_map(|(trial, stimulus)| name(trial, stimulus.station)));
        }
    }
    let names = distinct(names);
    let courses = mean_courses(&mut section, task, "skin_c", &names, |trial, station| {
        let sensor = trial.skin_sensors.get(station).copied().flatten()?;
        Some((name(trial, station)?, sensor))
    });
    if courses.is_empty() {
        section.lacks("Fits", "there is no telemetry of a skin in contact");
        return section;
    }
    let mut table = Table::new(
        "exponential-fit",
        "Fits to the mean courses; n counts contacts",
        [
            words("part and material"),
            words("n"),
            numbers("c", "°C", 3),
            numbers("a", "K", 3),
            numbers("time constant", "s", 3),
            numbers("R²", "", 4),
        ],
    );
    let part_of = |course: &Course| course.name.rsplit_once(", ").map(|(part, _)| part.to_owned());
    for part in distinct(courses.iter().map(part_of)) {
        let own = courses.iter().filter(|course| part_of(course) == part);
        let mut curves = Vec::new();
        for (series, course) in own.enumerate() {
            curves.extend(fitted(course, series, &mut table, &mut section));
        }
        let times = curves.iter().flat_map(|curve| curve.points.iter().map(|(t, _)| *t));
        section.draw(
            format!("{}: mean courses (lines) and fits (dashed)", part.unwrap_or_default()),
            lines(positive_range(times), "time since the landing / s", "skin / °C", &curves),
        );
    }
    section.add(table);
    section.add(self::table("courses", "Mean courses of the skin", "°C", &courses));
    section
}

/// The curves of a course and of its fit, which gets a row.
fn fitted(course: &Course, series: usize, table: &mut Table, section: &mut Section) -> Vec<Curve> {
    let (t, y): (Vec<f64>, Vec<f64>) = course.points.iter().copied().unzip();
    let material = course.name.rsplit_once(", ").map_or(&*course.name, |(_, material)| material);
    let mut curves = vec![Curve {
        name: material.into(),
        color: color(series),
        stroke: Stroke::Solid(2),
        points: course.points.clone(),
    }];
    match fit_exponential(&t, &y) {
        Ok(fit) => {
            let at = |t: f64| fit.offset + fit.amplitude * (-t / fit.time_constant).exp();
            curves.push(Curve {
                name: "its fit".into(),
                color: color(series),
                stroke: Stroke::Dashed,
                points: t.iter().map(|t| (*t, at(*t))).filter(|(_, y)| y.is_finite()).collect(),
            });
            table.row(cells![
                course.name.clone(),
                course.contacts,
                fit.offset,
                fit.amplitude,
                fit.time_constant,
                fit.r_squared
            ]);
        }
        Err(error) => section.lacks(&course.name, error),
    }
    curves
}
