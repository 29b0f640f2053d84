//! Results that are known by hand, or that the thesis or another program gives.

use thermal_session::record::StationRecord;

use super::assert_near;
use super::data::{self, display, participant, sample, task, trial};
use crate::analyses::of_task;
use crate::input::Trial;
use crate::report::Cell;

const SIDES: [&str; 2] = ["left", "right"];

/// Trials with one pair, of which the first `correct` are answered correctly.
fn one_pair(first: &str, second: &str, total: usize, correct: usize) -> Vec<Trial> {
    let of = |index: usize| {
        let answer = if index < correct { "left" } else { "right" };
        trial(index as u32 + 1, "main", vec![sample(first), sample(second)], answer, Some("left"))
    };
    (0..total).map(of).collect()
}

#[test]
fn seventy_per_cent_of_forty_answers_are_above_chance_at_one_per_cent() {
    let mut task = task("pair", &SIDES, &SIDES, &["pairs"]);
    task.threshold = Some(0.72);
    for code in ["P1", "P2"] {
        task.participants.push(participant(code, one_pair("copper", "bronze", 20, 14)));
    }
    let analysis = of_task(&task);
    let pairs = analysis.table("pairs");
    let number = |column| pairs.number(&["copper / bronze"], column);
    assert_near(number("share correct"), 70.0, 1e-9);
    // By sums of binomial terms in Python, and their bisection for the interval.
    assert_near(number("p by chance"), 0.0082945017, 1e-9);
    assert_near(number("95 % from"), 53.46837, 1e-4);
    assert_near(number("95 % to"), 83.43728, 1e-4);
    assert_near(number("criterion"), 28.0, 0.0);
    assert_near(number("participants"), 2.0, 0.0);
    assert_near(number("SEM"), 0.0, 1e-9);
    // sqrt(2) z(28.5 / 41).
    assert_near(number("d' (2AFC)"), 0.7218452, 1e-6);
    assert_eq!(pairs.cell(&["copper / bronze"], "told apart"), &Cell::from("no"));
}

#[test]
fn the_mode_is_whether_the_real_material_has_the_larger_contact_coefficient() {
    let mut task = task("modes", &SIDES, &SIDES, &["pairs-by-mode"]);
    let trials = vec![
        trial(1, "main", vec![sample("copper"), display(0, "abs")], "left", Some("left")),
        trial(2, "main", vec![display(0, "copper"), sample("abs")], "right", Some("left")),
    ];
    task.participants.push(participant("P1", trials));
    let analysis = of_task(&task);
    let table = analysis.table("pairs-by-mode");
    assert_near(table.number(&["copper / abs", "R/S > 1"], "share correct"), 100.0, 0.0);
    assert_near(table.number(&["copper / abs", "R/S < 1"], "share correct"), 0.0, 0.0);
}

#[test]
fn answers_to_equal_materials_are_counted_by_side_and_by_kind() {
    let mut task = task("equal", &SIDES, &SIDES, &["identical-pairs"]);
    for (code, rights) in [("P1", 3), ("P2", 2), ("P3", 4)] {
        let of = |index: u32| {
            let answer = if index < rights { "right" } else { "left" };
            trial(index + 1, "main", vec![sample("abs"), display(0, "abs")], answer, None)
        };
        task.participants.push(participant(code, (0..4).map(of).collect()));
    }
    let analysis = of_task(&task);
    let table = analysis.table("identical-pairs");
    assert_near(table.number(&["abs", "right"], "times"), 9.0, 0.0);
    assert_near(table.number(&["abs", "the real one"], "times"), 3.0, 0.0);
    // Shares .75, .5, 1: mean .75, SD .25, t = .25 / (.25 / sqrt 3).
    assert_near(table.number(&["abs", "right"], "t"), 3f64.sqrt(), 1e-9);
    // 2 P(X >= 9 | 12, 1/2) = 2 * 299 / 4096.
    assert_near(table.number(&["abs", "right"], "p (binomial)"), 598.0 / 4096.0, 1e-12);
}

#[test]
fn oddity_gives_a_larger_sensitivity_than_a_choice_of_three() {
    let fingers = ["index", "middle", "ring"];
    let mut task = task("odd", &fingers, &fingers, &["oddity"]);
    let of = |index: u32| {
        let answer = if index < 343 { "middle" } else { "ring" };
        let presented = vec![display(0, "foam"), display(1, "copper"), display(2, "foam")];
        trial(index + 1, "main", presented, answer, Some("middle"))
    };
    task.participants.push(participant("P1", (0..900).map(of).collect()));
    let analysis = of_task(&task);
    let row = ["copper", "foam", "high/low"];
    let number = |column| analysis.table("oddity").number(&row, column);
    // The thesis prints 0.16 for 38 %; by oddity it is 0.74.
    assert_near(number("d' (3AFC)"), 0.16, 0.01);
    assert_near(number("d' (oddity)"), 0.74, 0.02);
    assert_near(analysis.table("oddity-modes").number(&["target at middle"], "n"), 900.0, 0.0);
}

#[test]
fn hits_and_false_alarms_of_same_and_different() {
    let mut task = task("same", &SIDES, &["same", "different"], &["same-different"]);
    let of = |index: u32| {
        let (other, differs) = if index < 10 { ("abs", index < 8) } else { ("copper", index < 12) };
        let answer = if differs { "different" } else { "same" };
        trial(index + 1, "main", vec![sample("copper"), display(0, other)], answer, None)
    };
    task.participants.push(participant("P1", (0..20).map(of).collect()));
    let analysis = of_task(&task);
    let table = analysis.table("same-different");
    assert_near(table.number(&["copper / abs"], "share"), 80.0, 1e-9);
    assert_near(table.number(&["copper / copper"], "share"), 20.0, 1e-9);
    // z(8.5 / 11) - z(2.5 / 11).
    assert_near(table.number(&["copper / abs"], "z(H) - z(F)"), 1.495717, 1e-5);
    // 2 x 2 table 8, 2, 2, 8.
    assert_near(table.number(&["copper / abs"], "chi-squared"), 7.2, 1e-9);
}

#[test]
fn perfect_identification_transmits_log2_of_five_bits() {
    let analysis = of_task(&data::identification(3, 0.0));
    let information = analysis.table("information");
    for part in ["real", "simulated"] {
        assert_near(information.number(&[part], "observed"), 5f64.log2(), 1e-12);
    }
    let confusion = analysis.table("confusion-real");
    assert_near(confusion.number(&["copper"], "copper"), 9.0, 0.0);
    assert_near(confusion.number(&["copper"], "foam"), 0.0, 0.0);
    assert_near(analysis.table("pearson-between-parts").number(&["confusions"], "r"), 1.0, 1e-12);
}

/// Contacts of one material each, with these falls for each participant.
fn with_falls(participants: &[&[(&str, f64)]], words: &[&str]) -> crate::input::Task {
    let mut task = task("falls", &["index"], &[], words);
    for (person, falls) in participants.iter().enumerate() {
        let of = |(index, (material, fall_k)): (usize, &(&str, f64))| {
            let mut trial = trial(index as u32 + 1, "main", vec![display(0, material)], "", None);
            trial.record.stations[0] = StationRecord {
                skin_before_c: Some(34.0),
                skin_fall_k: Some(*fall_k),
                ..StationRecord::default()
            };
            trial
        };
        let trials = falls.iter().enumerate().map(of).collect();
        task.participants.push(participant(&format!("P{person}"), trials));
    }
    task
}

#[test]
fn two_levels_give_the_square_of_the_paired_t() {
    // Differences 1, 2 and 3: t = 2 / (1 / sqrt 3), F = 12, p(1, 2) = .0742.
    let task = with_falls(
        &[
            &[("copper", 2.0), ("foam", 1.0)],
            &[("copper", 4.0), ("foam", 2.0)],
            &[("copper", 6.0), ("foam", 3.0)],
            &[("copper", 9.0)],
        ],
        &["falls", "anova-within"],
    );
    let analysis = of_task(&task);
    let anova = analysis.table("anova-within");
    let number = |column| anova.number(&["fall / K, main", "material"], column);
    assert_near(number("F"), 12.0, 1e-9);
    assert_near(number("df error"), 2.0, 0.0);
    assert_near(number("p"), 0.0741799, 1e-6);
    assert_near(number("n"), 3.0, 0.0);
    assert_near(number("left out"), 1.0, 0.0);
}

#[test]
fn unequal_variances_lead_to_the_square_root() {
    let spread = |mean: f64| [0.3, 0.6, 0.9, 1.1, 1.4, 1.7].map(|factor| factor * mean);
    let (cold, warm) = (spread(3.0), spread(0.3));
    let rows: Vec<Vec<(&str, f64)>> =
        (0..6).map(|i| vec![("copper", cold[i]), ("foam", warm[5 - i])]).collect();
    let rows: Vec<&[(&str, f64)]> = rows.iter().map(Vec::as_slice).collect();
    let analysis = of_task(&with_falls(&rows, &["falls", "levene", "anova-within"]));
    assert!(analysis.table("levene").number(&["falls"], "p") < 0.05);
    assert_eq!(
        analysis.table("anova-within").rows[0][0],
        Cell::from("square root of fall / √K, main")
    );
}

#[test]
fn falls_of_the_model_correlate_with_it() {
    // Eq. 3-1 with 34 and 24 °C, times 0.3.
    let skin = contact_model::material::SKIN;
    let fall = |name: &str| {
        let object = contact_model::material::find(name).expect("a material");
        0.3 * (34.0 - contact_model::reference::interface_temperature(&skin, 34.0, object, 24.0))
    };
    let falls: Vec<_> = data::FIVE.iter().map(|name| (*name, fall(name))).collect();
    let analysis = of_task(&with_falls(&[&falls], &["falls", "pearson-with-model"]));
    assert_near(analysis.table("pearson-with-model").number(&["main"], "r"), 1.0, 1e-9);
    assert_near(
        analysis.table("falls-model").number(&["main", "abs"], "measured over model"),
        0.3,
        1e-9,
    );
}

#[test]
fn participants_of_different_parts_are_a_factor_between_participants() {
    let mut task = data::identification(4, 0.5);
    for (person, participant) in task.participants.iter_mut().enumerate() {
        let part = if person < 2 { "real" } else { "simulated" };
        participant.trials.retain(|trial| trial.record.part == part);
    }
    let analysis = of_task(&task);
    let table = analysis.table("anova-split-plot");
    let row = ["correct / %", "part (between participants)"];
    assert_near(table.number(&row, "df"), 1.0, 0.0);
    assert_near(table.number(&row, "df error"), 2.0, 0.0);
    assert_near(table.number(&["correct / %", "presented"], "df error"), 8.0, 0.0);
}

#[test]
fn a_staircase_has_the_mean_of_its_reversals() {
    let analysis = of_task(&data::thresholds(1, 1e-9));
    // Always correct: it falls to its least level and never turns.
    assert!(analysis.not_possible().iter().any(|sentence| sentence.contains("enough reversals")));

    let mut task = data::thresholds(1, 0.14);
    // Two correct, one wrong, for ever: it turns at 1 / 1.41 and at 1.
    let person = &mut task.participants[0];
    let one = person.trials[0].clone();
    person.trials = (0..30).map(|_| one.clone()).collect();
    for (index, trial) in person.trials.iter_mut().enumerate() {
        trial.record.is_correct = Some(index % 3 != 2);
    }
    let analysis = of_task(&task);
    let table = analysis.table("staircases");
    assert_near(table.number(&["cooling"], "threshold"), 1.41f64.powf(-0.5), 1e-12);
    assert_near(table.number(&["cooling"], "reversals"), 8.0, 0.0);
}

#[test]
fn magnitudes_are_means_by_condition_and_station() {
    let mut task = data::referral(2);
    for person in &mut task.participants {
        person.trials.truncate(2);
        for (trial, answer) in person.trials.iter_mut().zip(["10; 20;30", "not a number;1;2"]) {
            trial.record.answer = Some(answer.into());
        }
    }
    let analysis = of_task(&task);
    let table = analysis.table("magnitudes");
    let condition = "cooled outer, cold_c 31";
    assert_near(table.number(&[condition, "middle"], "mean"), 20.0, 1e-12);
    assert_near(table.number(&[condition, "ring"], "n"), 2.0, 0.0);
    assert_eq!(table.rows.len(), 3);
}

#[test]
fn answers_as_in_table_3_3_do_not_differ_from_it() {
    let mut task = task("p5", &SIDES, &SIDES, &["pairs", "chi-squared-against"]);
    // 30, 39 and 40 of 40 are 75, 98 and 100 %.
    let mut trials = one_pair("copper", "stainless-steel", 40, 30);
    trials.extend(one_pair("copper", "abs", 40, 39));
    trials.extend(one_pair("stainless-steel", "abs", 40, 40));
    task.participants.push(participant("P1", trials));
    let analysis = of_task(&task);
    let row = &analysis.table("chi-squared-against").rows[0];
    assert_eq!(row[..3], [Cell::from(3u32), Cell::from(0.0), Cell::from(2.0)]);
}

#[test]
fn courses_and_forces_come_from_the_telemetry() {
    let folder = std::env::temp_dir().join(format!("session-analysis-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder of the test");
    let falls = of_task(&data::falls(2, &folder));
    let forces = of_task(&data::forces(2, &folder));
    std::fs::remove_dir_all(&folder).expect("the folder of the test");
    for (part, tau_s) in [("real", 0.9), ("simulated", 1.4)] {
        let name = format!("{part}, copper");
        let table = falls.table("exponential-fit");
        assert_near(table.number(&[&name], "time constant"), tau_s, 0.01);
        assert!(table.number(&[&name], "R²") > 0.9999);
        // The course begins at the landing.
        let at_landing_c = table.number(&[&name], "c") + table.number(&[&name], "a");
        assert_near(at_landing_c, 34.5, 0.01);
        assert_near(table.number(&[&name], "n"), 6.0, 0.0);
    }
    assert_eq!(forces.table("force-courses").columns.len(), 6);
    let force = forces.table("force-matching");
    assert_near(force.number(&["zns"], "n"), 12.0, 0.0);
    assert_near(force.number(&["zns"], "force, last 2 s"), 0.1, 0.005);
    // Without the telemetry the tables of the records are there, and a sentence says what is not.
    let without = of_task(&with_falls(&[&[("copper", 1.0)]], &["falls", "exponential-fit"]));
    assert!(without.not_possible().iter().any(|sentence| sentence.contains("no telemetry")));
    assert_eq!(without.table("falls").rows.len(), 1);
}

/// Five pairs, and the correct answers of four that three participants have: those of `tests/data/ancova.py`.
const ANSWERS_OF_FOUR: [([&str; 2], [usize; 3]); 5] = [
    (["copper", "bronze"], [3, 2, 1]),
    (["copper", "stainless-steel"], [2, 3, 3]),
    (["copper", "abs"], [4, 3, 4]),
    (["bronze", "abs"], [4, 4, 3]),
    (["stainless-steel", "foam"], [4, 4, 4]),
];

#[test]
fn ancova_is_that_of_packages() {
    let mut task = task("pairs", &SIDES, &SIDES, &["pairs", "ancova"]);
    for person in 0..3 {
        let trials = ANSWERS_OF_FOUR
            .iter()
            .flat_map(|([one, other], correct)| one_pair(one, other, 4, correct[person]));
        task.participants.push(participant(&format!("P{person}"), trials.collect()));
    }
    let analysis = of_task(&task);
    let table = analysis.table("ancova");
    // Covariate, then slope, F, p of the covariate, F and p of the participants.
    let packages = [
        ("roughness Rq", [5.493_247, 3.474_583, 0.089_208, 0.241_243, 0.789_700]),
        ("Young's modulus", [2.480_912, 8.831_487, 0.012_705, 0.330_525, 0.725_442]),
    ];
    let columns = ["slope", "F", "p", "F of participants", "p of participants"];
    for (covariate, values) in packages {
        let row = ["correct / %", covariate];
        for (column, value) in columns.into_iter().zip(values) {
            assert_near(table.number(&row, column), value, 1e-6);
        }
        assert_near(table.number(&row, "n"), 15.0, 0.0);
        assert_near(table.number(&row, "df error"), 11.0, 0.0);
        assert_near(table.number(&row, "df"), 1.0, 0.0);
    }
}

#[test]
fn a_covariate_that_is_not_known_of_each_material_is_said() {
    let mut task = task("pairs", &SIDES, &SIDES, &["pairs", "ancova"]);
    let trials = [one_pair("copper", "zns", 4, 3), one_pair("copper", "abs", 4, 4)];
    task.participants.push(participant("P1", trials.concat()));
    let analysis = of_task(&task);
    let sentences = analysis.not_possible();
    assert!(
        sentences
            .contains(&"correct / %, Young's modulus: it is zero, or not known, of a material"),
        "{sentences:?}"
    );
}

/// Whether a force has settled is judged where the tone is known: what is recorded counts, however long the finger stays after it.
#[test]
fn a_recorded_time_to_settle_counts_whatever_the_time_to_the_lift() {
    let mut task = task("p8", &["index"], &[], &["force-matching"]);
    let contact = |number: u32, settled_s: Option<f64>| {
        let mut trial = trial(number, "main", vec![display(0, "baf2")], "", None);
        trial.record.target_force_n = Some(0.1);
        trial.record.contact_s = Some(9.5);
        trial.record.stations[0] = StationRecord {
            force_mean_n: Some(0.1),
            force_end_mean_n: Some(0.1),
            force_settled_s: settled_s,
            ..StationRecord::default()
        };
        trial
    };
    let trials = vec![contact(1, None), contact(2, Some(8.0)), contact(3, Some(1.0))];
    task.participants.push(participant("P1", trials));
    let analysis = of_task(&task);
    let table = analysis.table("force-matching");
    assert_near(table.number(&["baf2"], "n"), 3.0, 0.0);
    assert_near(table.number(&["baf2"], "settled"), 2.0, 0.0);
    assert_near(table.number(&["baf2"], "time to settle"), 4.5, 1e-12);
}
