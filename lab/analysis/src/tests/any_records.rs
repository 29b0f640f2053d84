//! Whatever the records are, there is an analysis whose numbers are finite.

use proptest::prelude::*;
use thermal_session::{Departure, Presented};

use super::data::{self, participant, sample};
use super::documents::elements;
use crate::Analysis;
use crate::analyses::{WORDS, of_task};
use crate::input::{Task, Trial};

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -50.0..50.0,
        1 => Just(0.0),
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(f64::MIN),
        1 => Just(f64::MAX),
        1 => Just(1e-300),
        1 => Just(-0.0),
    ]
}

fn maybe() -> impl Strategy<Value = Option<f64>> {
    prop::option::weighted(0.8, number())
}

fn word() -> impl Strategy<Value = String> {
    prop_oneof![
        Just("left".to_owned()),
        Just("right".to_owned()),
        Just("copper".to_owned()),
        Just("same".to_owned()),
        Just("different".to_owned()),
        Just("3;4".to_owned()),
        Just("NaN;inf".to_owned()),
        Just(String::new()),
        "\\PC{0,6}".prop_map(|text| text),
    ]
}

fn presented() -> impl Strategy<Value = Presented> {
    let material = || prop_oneof![Just("copper"), Just("abs"), Just("foam"), Just("no such thing")];
    prop_oneof![
        Just(Presented::Nothing),
        material().prop_map(sample),
        (0u8..3, material()).prop_map(|(finger, material)| data::display(finger, material)),
        number().prop_map(|celsius| Presented::Hold { device_finger: 0, celsius }),
        (number(), number()).prop_map(|(one, other)| Presented::Pulses {
            device_finger: 0,
            base_c: 33.0,
            departures_k: [Departure::Fixed(one), Departure::Fixed(other)],
            rate_k_s: 1.0,
        }),
    ]
}

fn trial() -> impl Strategy<Value = Trial> {
    let words = (prop::option::of(word()), prop::option::of(word()), word(), any::<Option<bool>>());
    let presented = prop::collection::vec(presented(), 0..4);
    let numbers = prop::collection::vec(maybe(), 8);
    let station = prop::collection::vec(maybe(), 12);
    let rest =
        (0usize..3, 0u32..4, prop::option::of(0usize..3), prop::collection::vec(word(), 0..3));
    (words, presented, numbers, station, rest).prop_map(
        |(words, presented, numbers, station, rest)| {
            let (answer, expected, part, is_correct) = words;
            let (_, block, staircase, levels) = rest;
            let mut trial = data::trial(block, &part, presented, "", None);
            let record = &mut trial.record;
            (record.answer, record.expected, record.is_correct) = (answer, expected, is_correct);
            record.block = block;
            record.levels.clone_from(&levels);
            (record.land_s, record.lift_s, record.answer_s) = (numbers[0], numbers[1], numbers[2]);
            (record.contact_s, record.room_c, record.target_force_n) =
                (numbers[3], numbers[4], numbers[5]);
            record.staircase_level_k = numbers[6];
            record.end_s = numbers[7].unwrap_or_default();
            for one in &mut record.stations {
                (one.land_s, one.skin_before_c, one.skin_fall_k) =
                    (station[0], station[1], station[2]);
                (one.setpoint_c, one.display_c) = (station[3], station[4]);
                (one.force_mean_n, one.force_sd_n) = (station[5], station[6]);
                (one.force_end_mean_n, one.force_end_sd_n) = (station[7], station[8]);
                (one.force_error_rms_n, one.force_settled_s) = (station[9], station[10]);
                one.is_limited = station[11].map(|number| number > 0.0);
            }
            trial.levels = levels.into_iter().map(|level| ("factor".to_owned(), level)).collect();
            trial.staircase = staircase;
            trial
        },
    )
}

fn tasks() -> impl Strategy<Value = Task> {
    let participants = prop::collection::vec(prop::collection::vec(trial(), 0..14), 0..4);
    let chance = prop::option::of(number());
    (participants, chance, any::<bool>(), 1usize..4).prop_map(
        |(participants, chance, is_p5, stations)| {
            let names = ["left", "right", "third"];
            let answers = ["left", "right", "copper", "abs"];
            let mut task =
                data::task(if is_p5 { "p5" } else { "p4" }, &names[..stations], &answers, &WORDS);
            task.chance = chance;
            task.staircases = data::thresholds(0, 0.1).staircases;
            task.materials.remove("foam");
            for (index, trials) in participants.into_iter().enumerate() {
                let mut person = participant(&format!("P{index}"), trials);
                for record in person.records.iter_mut().step_by(3) {
                    record.void = record.answer.clone();
                }
                task.participants.push(person);
            }
            task
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_records_panic_or_give_a_number_that_is_not_finite(task in tasks()) {
        let analysis = Analysis { left_out: Vec::new(), tasks: vec![of_task(&task)] };
        for table in analysis.tasks[0].sections.iter().flat_map(|section| &section.tables) {
            for cell in table.rows.iter().flatten() {
                if let crate::Cell::Number(number) = cell {
                    prop_assert!(number.is_finite(), "{} in {}", number, table.name);
                }
            }
            for row in &table.rows {
                prop_assert_eq!(row.len(), table.columns.len());
            }
        }
        serde_json::from_str::<serde_json::Value>(&analysis.json()).expect("JSON");
        elements(&analysis.page());
        prop_assert!(!analysis.csv().is_empty());
    }
}
