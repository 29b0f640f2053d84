//! States, phases and decisions in words.

use thermal_device::StateName;
use thermal_session::{Cue, Decision, OperatorQuestion, Phase, PlannedTrial, Presented, Station};

/// What is written beside the button of the stop.
pub const EMERGENCY_STOP: &str = "This button asks the device to switch its bridge off. \
    The hardware's emergency stop is the one that always works: keep a hand near it.";

/// A choice of the operator: its key is the letter that is underlined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// What is decided.
    pub decision: Decision,
    /// Its key, a letter in lower case.
    pub key: char,
    /// Text of its button.
    pub label: &'static str,
}

const fn choice(decision: Decision, key: char, label: &'static str) -> Choice {
    Choice { decision, key, label }
}

/// What the operator can decide; the stop is always there besides.
pub const fn choices(question: &OperatorQuestion) -> &'static [Choice] {
    const READY: [Choice; 1] = [choice(Decision::Continue, 'c', "Continue: all is in place")];
    const SKIN: [Choice; 3] = [
        choice(Decision::Wait, 'w', "Wait for the skin once more"),
        choice(Decision::Continue, 'c', "Continue in spite of the skin"),
        choice(Decision::Void, 'v', "Void: this trial does not count"),
    ];
    const TRIPPED: [Choice; 1] = [choice(Decision::Continue, 'c', "Clear the fault and continue")];
    const BREAK: [Choice; 1] = [choice(Decision::Continue, 'c', "Continue: the break is over")];
    match question {
        OperatorQuestion::Ready(_) => &READY,
        OperatorQuestion::SkinNotReady { .. } => &SKIN,
        OperatorQuestion::Tripped { .. } => &TRIPPED,
        OperatorQuestion::BreakOver => &BREAK,
    }
}

/// A question to the operator: title and text.
pub fn question(question: &OperatorQuestion) -> (&'static str, String) {
    match question {
        OperatorQuestion::Ready(what) => ("Ready?", what.clone()),
        OperatorQuestion::SkinNotReady { skin_c, wanted_c } => (
            "The skin is not at its temperature",
            match skin_c {
                Some(skin_c) => format!(
                    "It has {skin_c:.2} °C in place of {wanted_c:.2} °C, after the time that the session allows."
                ),
                None => format!(
                    "The device does not know it; wanted are {wanted_c:.2} °C. Is the sensor on the finger?"
                ),
            },
        ),
        OperatorQuestion::Tripped { fault, explanation } => (
            "The device has tripped; the bridge is off",
            format!("{fault}: {explanation}. The trial is void."),
        ),
        OperatorQuestion::BreakOver => ("The break is over", "Is the participant ready?".into()),
    }
}

/// A state of the device: its word on screens, and what it means.
pub const fn state(state: StateName) -> (&'static str, &'static str) {
    match state {
        StateName::Off => ("OFF", "The bridge is off. `arm` begins with the self-test."),
        StateName::SelfTest => {
            ("SELF-TEST", "The device tests itself: keep all fingers off the display.")
        }
        StateName::Ready => (
            "READY",
            "The bridge is off. The self-test was passed; `arm` drives the display at once.",
        ),
        StateName::Armed => {
            ("ARMED", "The bridge drives the display to the temperature of the skin.")
        }
        StateName::Preset => ("PRESET", "The bridge drives the display, which waits for a finger."),
        StateName::Contact => ("CONTACT", "A finger is on the display, which follows the object."),
        StateName::Stimulus => {
            ("STIMULUS", "The display follows temperatures that this computer prescribes.")
        }
        StateName::Tripped(_) => {
            ("TRIPPED", "The bridge is off because of a fault, until it is cleared.")
        }
    }
}

/// What happens in a phase, for the operator.
pub const fn phase(phase: Phase) -> &'static str {
    match phase {
        Phase::Connect => "the device is set up",
        Phase::Rest => "the skin returns to its temperature; place the stimuli",
        Phase::Prepare => "the display goes to its preset",
        Phase::Reach => "the participant moves above the stimuli",
        Phase::Contact => "the participant touches",
        Phase::Respond => "the participant answers",
        Phase::Return => "the participant lifts the fingers",
        Phase::Break => "a break between two blocks",
        Phase::End => "the session has ended",
    }
}

/// What the participant is told of an answer.
pub const fn feedback(is_correct: bool) -> &'static str {
    if is_correct { "Correct." } else { "Not correct." }
}

/// What a tone asks of the participant.
pub fn cue(cue: Cue) -> String {
    match cue {
        Cue::Reach => "Move above".into(),
        Cue::Touch => "Touch".into(),
        Cue::Interval(index) => format!("Interval {}", u16::from(index) + 1),
        Cue::Lift => "Lift".into(),
    }
}

/// What the participant reads in a phase without text, cue or question.
pub const fn participant_phase(phase: Option<Phase>) -> &'static str {
    match phase {
        Some(Phase::Break) => "Break",
        Some(Phase::Rest | Phase::Return) => "Rest",
        Some(Phase::Contact) => "",
        Some(Phase::End) => "Thank you",
        _ => "Please wait",
    }
}

/// What is to be placed where, a line for each station.
pub fn placement(stations: &[Station], trial: &PlannedTrial) -> Vec<String> {
    let presented = trial.presented.iter().enumerate();
    let line = |(index, presented): (usize, &Presented)| {
        let what = match presented {
            Presented::Nothing => "nothing".into(),
            Presented::Sample { material } => format!("sample of {material}"),
            Presented::Material { device_finger, material } => {
                format!("display {device_finger} as {material}")
            }
            Presented::Hold { device_finger, celsius } => {
                format!("display {device_finger} at {celsius:.2} °C")
            }
            Presented::Pulses { device_finger, base_c, .. } => {
                format!("display {device_finger}, two intervals from {base_c:.2} °C")
            }
        };
        match stations.get(index) {
            Some(Station { name, finger, skin_sensor }) => {
                // Where nothing is presented, nothing is measured.
                let sensor = skin_sensor.filter(|_| *presented != Presented::Nothing);
                let sensor = sensor.map(|sensor| format!(" with skin thermistor {sensor}"));
                let sensor = sensor.unwrap_or_default();
                format!("{name}: {what}, under the {finger}{sensor}")
            }
            None => what,
        }
    };
    presented.map(line).collect()
}

/// A key as it is written on a button.
pub fn key_cap(key: char) -> String {
    key.to_ascii_uppercase().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn questions() -> [OperatorQuestion; 4] {
        [
            OperatorQuestion::Ready("left: copper".into()),
            OperatorQuestion::SkinNotReady { skin_c: None, wanted_c: 33.0 },
            OperatorQuestion::Tripped { fault: "sink-hot".into(), explanation: "too warm".into() },
            OperatorQuestion::BreakOver,
        ]
    }

    #[test]
    fn the_first_letter_of_each_choice_is_its_key_and_no_two_are_the_same() {
        for question in questions() {
            let mut keys: Vec<_> = choices(&question).iter().map(|choice| choice.key).collect();
            for choice in choices(&question) {
                assert!(choice.label.to_lowercase().starts_with(choice.key), "{}", choice.label);
            }
            keys.dedup();
            assert_eq!(keys.len(), choices(&question).len());
        }
    }

    #[test]
    fn every_state_says_whether_the_bridge_is_off() {
        let all = [
            StateName::Off,
            StateName::SelfTest,
            StateName::Ready,
            StateName::Armed,
            StateName::Preset,
            StateName::Contact,
            StateName::Stimulus,
            StateName::Tripped(thermal_device::safety::Fault::Dose),
        ];
        for one in all {
            let (word, meaning) = state(one);
            assert_eq!(word.to_lowercase(), one.name());
            assert_eq!(meaning.contains("bridge is off"), !one.is_driven(), "{meaning}");
        }
    }
}
