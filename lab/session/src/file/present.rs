//! The table `[present]`.

use contact_model::material::Material;

use super::design::Parts;
use super::materials;
use super::setup::setpoints_c;
use super::source::SessionError;
use super::value::{Number, Table, Value, Whole, listed};
use crate::{MaterialOf, Present, PresentCase, Pulses, Quantity, Station, Stimulus};

pub(super) const STIMULUS_KEYS: [&str; 5] =
    ["sample", "display", "hold_c", "pulses", "device_finger"];
pub(super) const DEVICE_FINGER: Whole = Whole::new("device_finger", 0, 4, Some(0));
pub(super) const PULSES_KEYS: [&str; 6] =
    ["base_c", "standard_k", "change", "change_k", "changed", "rate_k_s"];
pub(super) const STANDARD_K: Number = Number::new("standard_k", -20.0, 20.0, Some(0.0));
pub(super) const CHANGE_K: Number = Number::new("change_k", 0.0, 20.0, None);
pub(super) const RATE_K_S: Number = Number::new("rate_k_s", 0.01, 100.0, None);

const STIMULUS: &str = "\"nothing\" or a table with sample, display, hold_c or pulses";

/// What the stations present, with what other tables point to in their errors.
pub(super) struct Presentation<'a> {
    pub present: Present,
    /// Each stimulus with its place.
    pub stimuli: Vec<(Stimulus, Value<'a>)>,
    /// The first display.
    pub display: Option<Value<'a>>,
}

pub(super) fn present<'a>(
    file: &Value<'a>,
    stations: &[Station],
    parts: &Parts<'a>,
    materials: &[(String, Material)],
) -> Result<Presentation<'a>, SessionError> {
    let table = file.any_table("a table")?;
    let mut reader = Reader { stations, parts, materials, stimuli: Vec::new() };
    let present = match table.get("by") {
        None => Present {
            by: None,
            cases: vec![PresentCase { level: None, stations: reader.case(&table, &parts.all())? }],
        },
        Some(by) => reader.cases(by, &table)?,
    };
    let shown = |(stimulus, _): &&(Stimulus, Value<'a>)| stimulus.device_finger().is_some();
    let display = reader.stimuli.iter().find(shown).map(|(_, value)| value.clone());
    let pulses = reader.stimuli.iter().any(|(stimulus, _)| matches!(stimulus, Stimulus::Pulses(_)));
    if let (Some(staircase), false) = (parts.staircase_at.first(), pulses) {
        let problem = "a staircase without pulses, whose change it decides; it is allowed beside pulses in [present]";
        return Err(staircase.error(problem));
    }
    Ok(Presentation { present, stimuli: reader.stimuli, display })
}

struct Reader<'a, 'p> {
    stations: &'p [Station],
    parts: &'p Parts<'a>,
    materials: &'p [(String, Material)],
    stimuli: Vec<(Stimulus, Value<'a>)>,
}

impl<'a> Reader<'a, '_> {
    /// The cases by the levels of a factor.
    fn cases(&mut self, by: &Value<'a>, table: &Table<'a>) -> Result<Present, SessionError> {
        let factor = by.string("a factor")?;
        let all = self.parts.all();
        if all.iter().any(|part| self.parts.factor(*part, factor).is_none()) {
            return Err(by.wrong(format!("a factor of all parts: {}", self.parts.common(&all))));
        }
        // In which parts each level occurs.
        let mut levels: Vec<(String, Vec<usize>)> = Vec::new();
        for of_part in self.parts.factors.iter().filter(|levels| levels.name == factor) {
            for (level, _) in &of_part.levels {
                match levels.iter_mut().find(|(known, _)| known == level) {
                    Some((_, parts)) => parts.push(of_part.part),
                    None => levels.push((level.clone(), vec![of_part.part])),
                }
            }
        }
        let names: Vec<_> = levels.iter().map(|(level, _)| &**level).collect();
        let mut cases = Vec::new();
        for (level, value) in table.values.iter().filter(|(key, _)| *key != "by") {
            let Some((_, parts)) = levels.iter().find(|(known, _)| known == level) else {
                let problem = format!(
                    "{} is no level of {factor:?}; allowed are {}",
                    value.key,
                    listed(&names)
                );
                return Err(value.error(problem));
            };
            cases.push(PresentCase {
                level: Some((*level).into()),
                stations: self.case(&value.any_table("a table of stations")?, parts)?,
            });
        }
        let missing =
            |level: &&&str| cases.iter().all(|case| case.level.as_deref() != Some(**level));
        if let Some(level) = names.iter().find(missing) {
            let problem = format!(
                "{} is missing; allowed is a table for each level of {factor:?}: {}",
                table.key(level),
                listed(&names)
            );
            return Err(by.error(problem));
        }
        Ok(Present { by: Some(factor.into()), cases })
    }

    /// What each station presents in some parts.
    fn case(&mut self, table: &Table<'a>, parts: &[usize]) -> Result<Vec<Stimulus>, SessionError> {
        let names: Vec<_> = self.stations.iter().map(|station| &*station.name).collect();
        if let Some((name, value)) = table.values.iter().find(|(name, _)| !names.contains(name)) {
            let problem =
                format!("{}: {name:?} is no station; allowed are {}", value.key, listed(&names));
            return Err(value.error(problem));
        }
        let mut stimuli: Vec<Stimulus> = Vec::new();
        for station in self.stations {
            let name = &*station.name;
            let value = table.need(name, STIMULUS)?;
            let stimulus = self.stimulus(value, parts)?;
            let finger = stimulus.device_finger();
            if finger.is_some() && stimuli.iter().any(|other| other.device_finger() == finger) {
                let problem = format!(
                    "{}.device_finger = {} again; allowed is another finger of the device for each station",
                    value.key,
                    finger.unwrap_or_default()
                );
                return Err(value.error(problem));
            }
            // For the whole session, because the thermistor stays where it is between trials.
            let measures_it = |other: &&Station| other.name != name && other.skin_sensor == finger;
            if let (Some(finger), Some(other)) = (finger, self.stations.iter().find(measures_it)) {
                let problem = format!(
                    "{}: a display on finger {finger} of the device, whose skin thermistor is at another station by \
                     stations.{other}.skin_sensor; allowed is another device_finger, or another skin_sensor there",
                    value.key,
                    other = other.name
                );
                return Err(value.error(problem));
            }
            self.stimuli.push((stimulus.clone(), value.clone()));
            stimuli.push(stimulus);
        }
        if stimuli.iter().all(|stimulus| *stimulus == Stimulus::Nothing) {
            return Err(
                table.error("no station presents anything; allowed is one that does, or more")
            );
        }
        Ok(stimuli)
    }

    fn stimulus(&self, value: &Value<'a>, parts: &[usize]) -> Result<Stimulus, SessionError> {
        if !value.is_table() {
            let nothing = value.word(&[("nothing", Stimulus::Nothing)]);
            return nothing.map_err(|_| value.wrong(STIMULUS));
        }
        let table = value.table(&STIMULUS_KEYS)?;
        let kinds = STIMULUS_KEYS.iter().filter(|key| **key != DEVICE_FINGER.key);
        let mut given = kinds.filter_map(|key| Some((*key, table.get(key)?)));
        let (Some((kind, what)), None) = (given.next(), given.next()) else {
            let problem = format!(
                "{} needs one of sample, display, hold_c and pulses; allowed is one",
                value.key
            );
            return Err(value.error(problem));
        };
        if kind == "sample" {
            table.without(&[DEVICE_FINGER.key], "beside display, hold_c or pulses")?;
            return Ok(Stimulus::Sample(self.material(what, parts)?));
        }
        let device_finger = table.whole(&DEVICE_FINGER)? as u8;
        Ok(match kind {
            "display" => Stimulus::Display { device_finger, material: self.material(what, parts)? },
            "hold_c" => Stimulus::Hold {
                device_finger,
                celsius: quantity(what, setpoints_c(), self.parts, parts)?,
            },
            _ => Stimulus::Pulses(self.pulses(what, parts, device_finger)?),
        })
    }

    /// A factor whose levels are materials, or a material.
    fn material(&self, value: &Value<'a>, parts: &[usize]) -> Result<MaterialOf, SessionError> {
        let known = materials::known(self.materials);
        let common = self.parts.common(parts);
        let allowed = format!("a factor ({common}) or a material ({known})");
        let name = value.string(&allowed)?;
        if parts.iter().all(|part| self.parts.factor(*part, name).is_some()) {
            let factors = parts.iter().filter_map(|part| self.parts.factor(*part, name));
            for (level, at) in factors.flat_map(|factor| &factor.levels) {
                if !materials::is_known(self.materials, level) {
                    let problem = format!(
                        "{} = {level:?}; allowed are materials, because {} takes it: {known}",
                        at.key, value.key
                    );
                    return Err(at.error(problem));
                }
            }
            return Ok(MaterialOf::Factor(name.into()));
        }
        if materials::is_known(self.materials, name) {
            Ok(MaterialOf::Named(name.into()))
        } else {
            Err(value.wrong(allowed))
        }
    }

    fn pulses(
        &self,
        value: &Value<'a>,
        parts: &[usize],
        device_finger: u8,
    ) -> Result<Pulses, SessionError> {
        let table = value.table(&PULSES_KEYS)?;
        let in_parts = |key: &Number| {
            let given = table.get(key.key);
            given.map(|given| quantity(given, key.range, self.parts, parts)).transpose()
        };
        let base_c = table.need("base_c", "15 to 42")?.number(setpoints_c())?;
        let changes = [("cooling", -1.0), ("warming", 1.0)];
        let sign = table.need("change", "\"cooling\" or \"warming\"")?.word(&changes)?;
        let change_k = in_parts(&CHANGE_K)?;
        let has_staircase = |part: &usize| {
            let name = self.parts.design.parts.get(*part).map(|part| &part.name);
            self.parts.staircases.iter().any(|staircase| Some(&staircase.part) == name)
        };
        match (&change_k, table.get(CHANGE_K.key)) {
            (Some(_), Some(given)) if parts.iter().any(has_staircase) => {
                let problem =
                    format!("{} beside a [[staircase]]; allowed is one of both", given.key);
                return Err(given.error(problem));
            }
            (None, _) if !parts.iter().all(has_staircase) => {
                let problem = format!(
                    "{} is missing; allowed is 0 to 20, a factor, or a [[staircase]] in its place",
                    table.key(CHANGE_K.key)
                );
                return Err(value.error(problem));
            }
            _ => {}
        }
        let common = self.parts.common(parts);
        let allowed = format!("a factor with the levels first and second ({common})");
        let changed = table.need("changed", &allowed)?;
        let name = changed.string(&allowed)?;
        let fits = |part: &usize| {
            let factor = self.parts.factor(*part, name);
            let mut levels = factor.into_iter().flat_map(|factor| &factor.levels);
            factor.is_some() && levels.all(|(level, _)| ["first", "second"].contains(&&**level))
        };
        if !parts.iter().all(fits) {
            return Err(changed.wrong(allowed));
        }
        Ok(Pulses {
            device_finger,
            base_c,
            standard_k: in_parts(&STANDARD_K)?.unwrap_or(Quantity::Fixed(0.0)),
            sign,
            change_k,
            changed: name.into(),
            rate_k_s: table.number(&RATE_K_S)?,
        })
    }
}

/// A number within a range, or a factor of these parts whose levels are such numbers.
pub(super) fn quantity(
    value: &Value<'_>,
    range: (f64, f64),
    all: &Parts<'_>,
    parts: &[usize],
) -> Result<Quantity, SessionError> {
    let (least, most) = range;
    let allowed = format!("{least} to {most} or a factor ({})", all.common(parts));
    if !value.is_string() {
        let wrong = |_| value.wrong(&allowed);
        return value.number(range).map(Quantity::Fixed).map_err(wrong);
    }
    let name = value.string(&allowed)?;
    for part in parts {
        let Some(factor) = all.factor(*part, name) else {
            return Err(value.wrong(allowed));
        };
        for (level, at) in &factor.levels {
            let number = level.parse::<f64>().ok();
            if !number.is_some_and(|number| (least..=most).contains(&number)) {
                let problem = format!(
                    "{} = {level}; allowed is {least} to {most}, because {} takes it",
                    at.key, value.key
                );
                return Err(at.error(problem));
            }
        }
    }
    Ok(Quantity::Factor(name.into()))
}
