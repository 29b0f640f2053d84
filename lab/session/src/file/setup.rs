//! The tables `[device]`, `[stations]` and `[rest]`.

use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::reference::ContactModel;
use thermal_device::safety::Setpoint;

use super::present::Presentation;
use super::source::SessionError;
use super::value::{Number, Value, Whole};
use crate::{DeviceSetup, Rest, RestPlace, Station};

pub(super) const DEVICE_KEYS: [&str; 6] =
    ["law", "mode", "assumed_finger", "object_c", "skin_c", "stream_ms"];
pub(super) const OBJECT_C: Number = Number::new("object_c", -20.0, 60.0, None);
pub(super) const DEVICE_SKIN_C: Number = Number::new("skin_c", 15.0, 42.0, None);
/// Five fingers each send a line; 5 ms is the device's shortest interval for that. The means of the skin over half a second, by
/// which the gate and the fall are judged, need two lines or more.
pub(super) const STREAM_MS: Whole = Whole::new("stream_ms", 5, 250, Some(10));

pub(super) const STATION_KEYS: [&str; 2] = ["finger", "skin_sensor"];
pub(super) const SKIN_SENSOR: Whole = Whole::new("skin_sensor", 0, 4, None);

pub(super) const REST_KEYS: [&str; 5] = ["place", "skin_c", "within_k", "for_s", "timeout_s"];
pub(super) const REST_SKIN_C: Number = Number::new("skin_c", 20.0, 40.0, None);
pub(super) const WITHIN_K: Number = Number::new("within_k", 0.05, 5.0, Some(0.3));
pub(super) const FOR_S: Number = Number::new("for_s", 0.5, 600.0, Some(2.0));
pub(super) const TIMEOUT_S: Number = Number::new("timeout_s", 1.0, 3600.0, Some(180.0));

/// Set-points that the device accepts, °C.
pub(super) fn setpoints_c() -> (f64, f64) {
    let [least, most] = [Setpoint::MIN, Setpoint::MAX].map(|limit| limit.celsius().to_num());
    (least, most)
}

/// The device; it must be described if a station presents a display or has a skin thermistor.
pub(super) fn device(
    file: Option<&Value<'_>>,
    stations: &Stations<'_>,
    present: &Presentation<'_>,
) -> Result<Option<DeviceSetup>, SessionError> {
    let Some(file) = file else {
        let needs = |value: &Value<'_>, what: &str| {
            let problem = format!("{} is {what}; it is allowed beside a table [device]", value.key);
            Err(value.error(problem))
        };
        return match (&present.display, stations.skin_sensors.first()) {
            (Some(display), _) => needs(display, "a display"),
            (None, Some((_, sensor))) => needs(sensor, "a thermistor of the device"),
            (None, None) => Ok(None),
        };
    };
    let table = file.table(&DEVICE_KEYS)?;
    let or_word = |key: &Number, word: &str| match table.get(key.key) {
        None => Ok(None),
        Some(value) if value.is_string() && value.string("")? == word => Ok(None),
        Some(value) => {
            let (least, most) = key.range;
            let wrong = |_| value.wrong(format!("{word:?} or {least} to {most}"));
            value.number(key.range).map(Some).map_err(wrong)
        }
    };
    Ok(Some(DeviceSetup {
        law: table.vocabulary_or("law", Law::Model)?,
        mode: table.vocabulary_or("mode", ContactModel::default())?,
        assumed_finger: table.vocabulary_or("assumed_finger", AssumedFinger::default())?,
        object_c: or_word(&OBJECT_C, "room")?,
        assumed_skin_c: or_word(&DEVICE_SKIN_C, "sensor")?,
        stream_ms: table.whole(&STREAM_MS)?,
    }))
}

/// The stations, with what other tables point to in their errors.
pub(super) struct Stations<'a> {
    /// In the order of the file.
    pub stations: Vec<Station>,
    /// Skin thermistors, each with its place.
    pub skin_sensors: Vec<(u8, Value<'a>)>,
}

pub(super) fn stations<'a>(file: &Value<'a>) -> Result<Stations<'a>, SessionError> {
    const MOST: usize = 5;
    let tables = file.any_table("a table for each station")?;
    if !(1..=MOST).contains(&tables.values.len()) {
        let problem = format!("{} stations; allowed is 1 to {MOST}", tables.values.len());
        return Err(file.error(problem));
    }
    let (mut stations, mut skin_sensors) = (Vec::new(), Vec::new());
    for (name, value) in &tables.values {
        if RESERVED.contains(name) || !super::value::is_name(name) {
            let problem = format!(
                "{}: allowed as a name is {}, and none of {}",
                value.key,
                super::value::NAME,
                super::value::listed(&RESERVED)
            );
            return Err(value.error(problem));
        }
        let table = value.table(&STATION_KEYS)?;
        let finger = table.need("finger", "the participant's finger in words")?;
        let sensor = table.get(SKIN_SENSOR.key);
        let skin_sensor = sensor.map(|sensor| sensor.whole(&SKIN_SENSOR)).transpose()?;
        let skin_sensor = skin_sensor.map(|finger| finger as u8);
        stations.push(Station { name: (*name).into(), finger: finger.text(40)?, skin_sensor });
        if let Some((of, sensor)) = skin_sensor.zip(sensor) {
            if skin_sensors.iter().any(|(known, _)| *known == of) {
                let problem = format!(
                    "{} = {of} again; allowed is another finger of the device for each station",
                    sensor.key
                );
                return Err(sensor.error(problem));
            }
            skin_sensors.push((of, sensor.clone()));
        }
    }
    Ok(Stations { stations, skin_sensors })
}

/// Columns of recorded tables, and keys, which no factor and no station may be named after.
pub(super) const RESERVED: [&str; 31] = [
    "answer",
    "attempt",
    "block",
    "break_before",
    "by",
    "contact",
    "correct",
    "duration",
    "expected",
    "land",
    "level_k",
    "lift",
    "onset",
    "part",
    "participant",
    "participant_id",
    "reach_cue",
    "reason",
    "response",
    "response_time",
    "room",
    "sample",
    "staircase",
    "stim_file",
    "target_force",
    "target_force_n",
    "touch_cue",
    "touches",
    "trial",
    "trial_type",
    "void",
];

/// What must hold before a trial.
pub(super) fn rest(
    file: Option<&Value<'_>>,
    present: &Presentation<'_>,
) -> Result<Option<Rest>, SessionError> {
    let Some(file) = file else {
        return Ok(None);
    };
    let table = file.table(&REST_KEYS)?;
    let places =
        [("pad", RestPlace::Pad), ("display", RestPlace::Display), ("air", RestPlace::Air)];
    let rest = Rest {
        place: table.word_or("place", &places, RestPlace::Pad)?,
        skin_c: table.number(&REST_SKIN_C)?,
        within_k: table.number(&WITHIN_K)?,
        for_s: table.number(&FOR_S)?,
        timeout_s: table.number(&TIMEOUT_S)?,
    };
    if let (RestPlace::Display, None, Some(place)) =
        (rest.place, &present.display, table.get("place"))
    {
        return Err(place.error(
            "rest.place = \"display\" without a display; allowed is \"pad\" or \"air\", or a station that presents a display",
        ));
    }
    if rest.timeout_s <= rest.for_s {
        let at = table.get("timeout_s").or(table.get("for_s")).unwrap_or(file);
        let (timeout_s, for_s) = (rest.timeout_s, rest.for_s);
        let problem =
            format!("rest.timeout_s = {timeout_s}; allowed is more than rest.for_s = {for_s}");
        return Err(at.error(problem));
    }
    Ok(Some(rest))
}
