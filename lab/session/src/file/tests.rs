//! Wrong files are answered with file, line, what is wrong and what is allowed; and the documentation has all keys.

use std::path::Path;

use contact_model::material::{MATERIALS, Material, Surface};
use thermal_client::client::StationRequest;
use thermal_protocol::check_line;

use super::value::{Number, Whole};
use super::{KEYS, design, materials, present, score, setup, trial};
use crate::{ANALYSES, PUBLISHED_TABLES, Plan, Session};

const DOCS: &str = include_str!("../../../../docs/sessions.md");

/// The example of the documentation.
fn example() -> &'static str {
    let (_, from) = DOCS.split_once("```toml\n").expect("an example");
    let (example, _) = from.split_once("```").expect("the end of the example");
    example
}

/// The text of a ready session.
fn ready(name: &str) -> String {
    let path = format!("{}/../sessions/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect(name)
}

/// Changes of a right file, each with the error that it must give, in which `{materials}` stands for all names.
fn assert_errors(right: &str, changes: &[(&str, &str, &str)]) {
    let path = Path::new("s.toml");
    Session::parse(right, path).expect("the file before the change");
    for (from, to, expected) in changes {
        assert_eq!(right.matches(from).count(), 1, "{from:?} occurs once");
        let error = Session::parse(&right.replace(from, to), path).expect_err(to);
        let expected = expected.replace("{materials}", &MATERIALS.map(|(name, _)| name).join(", "));
        assert_eq!(error.to_string(), expected, "{from:?} as {to:?}");
    }
}

#[test]
fn a_wrong_file_is_answered_with_line_mistake_and_what_is_allowed() {
    assert_errors(
        example(),
        &[
            ("format = 1\n", "\n", "s.toml:1: format is missing; allowed is 1"),
            ("format = 1\n", "format = 2\n", "s.toml:1: format = 2; allowed is 1"),
            (
                "title = ",
                "titel = ",
                "s.toml:2: titel is no key; allowed are format, title, task, cite, instruction, device, materials, stations, present, rest, trial, design, part, staircase, void, score",
            ),
            ("title = ", "title 5 = ", "s.toml:2: key with no value, expected `=`"),
            (
                "title = \"Copper and foam under two fingers\"",
                "title = \"\"",
                "s.toml:2: title = \"\"; allowed is a text of 1 to 200 characters",
            ),
            (
                "task = \"demo\"",
                "task = \"demo-1\"",
                "s.toml:3: task = \"demo-1\"; allowed is 1 to 20 letters and digits",
            ),
            (
                "task = \"demo\"",
                "task = 5",
                "s.toml:3: task = 5; allowed is 1 to 20 letters and digits",
            ),
            (
                "law = \"model\"",
                "law = \"pid\"",
                "s.toml:10: device.law = \"pid\"; allowed is \"pi-10hz\" or \"pi\" or \"model\"",
            ),
            (
                "mode = \"contact\"",
                "mode = 3",
                "s.toml:11: device.mode = 3; allowed is \"contact\" or \"semi-infinite\"",
            ),
            (
                "object_c = \"room\"",
                "object_c = \"cold\"",
                "s.toml:13: device.object_c = \"cold\"; allowed is \"room\" or -20 to 60",
            ),
            (
                "object_c = \"room\"",
                "object_c = 80",
                "s.toml:13: device.object_c = 80; allowed is \"room\" or -20 to 60",
            ),
            (
                "stream_ms = 10",
                "stream_ms = 1",
                "s.toml:15: device.stream_ms = 1; allowed is a whole number from 5 to 250",
            ),
            (
                "stream_ms = 10",
                "stream_ms = 251",
                "s.toml:15: device.stream_ms = 251; allowed is a whole number from 5 to 250",
            ),
            (
                "stream_ms = 10",
                "stream_ms = 7.5",
                "s.toml:15: device.stream_ms = 7.5; allowed is a whole number from 5 to 250",
            ),
            (
                "assumed_finger = \"mean-on-pad\"",
                "assumed_finger = \"index\"",
                "s.toml:12: device.assumed_finger = \"index\"; allowed is \"mean\" or \"mean-on-pad\" or \"thesis\"",
            ),
            (
                "[stations.right]",
                "[stations.trial]",
                "s.toml:20: stations.trial: allowed as a name is 1 to 40 letters, digits and _, with a small letter first, and none of answer, attempt, block, break_before, by, contact, correct, duration, expected, land, level_k, lift, onset, part, participant, participant_id, reach_cue, reason, response, response_time, room, sample, staircase, stim_file, target_force, target_force_n, touch_cue, touches, trial, trial_type, void",
            ),
            (
                "[stations.right]",
                "[stations.real-right]",
                "s.toml:20: stations.real-right: allowed as a name is 1 to 40 letters, digits and _, with a small letter first, and none of answer, attempt, block, break_before, by, contact, correct, duration, expected, land, level_k, lift, onset, part, participant, participant_id, reach_cue, reason, response, response_time, room, sample, staircase, stim_file, target_force, target_force_n, touch_cue, touches, trial, trial_type, void",
            ),
            (
                "finger = \"right index\"",
                "",
                "s.toml:20: stations.right.finger is missing; allowed is the participant's finger in words",
            ),
            (
                "by = \"side\"",
                "by = \"hand\"",
                "s.toml:24: present.by = \"hand\"; allowed is a factor of all parts: real, simulated, side",
            ),
            (
                "[present.real-left]",
                "[present.left]",
                "s.toml:26: present.left is no level of \"side\"; allowed are real-left, real-right",
            ),
            (
                "left = { sample = \"real\" }",
                "",
                "s.toml:26: present.real-left.left is missing; allowed is \"nothing\" or a table with sample, display, hold_c or pulses",
            ),
            (
                "left = { sample = \"real\" }",
                "links = { sample = \"real\" }",
                "s.toml:27: present.real-left.links: \"links\" is no station; allowed are left, right",
            ),
            (
                "left = { sample = \"real\" }",
                "left = \"empty\"",
                "s.toml:27: present.real-left.left = \"empty\"; allowed is \"nothing\" or a table with sample, display, hold_c or pulses",
            ),
            (
                "left = { sample = \"real\" }",
                "left = 5",
                "s.toml:27: present.real-left.left = 5; allowed is \"nothing\" or a table with sample, display, hold_c or pulses",
            ),
            (
                "left = { sample = \"real\" }",
                "left = { sample = \"gold\" }",
                "s.toml:27: present.real-left.left.sample = \"gold\"; allowed is a factor (real, simulated, side) or a material ({materials})",
            ),
            (
                "left = { sample = \"real\" }",
                "left = { sample = \"side\" }",
                "s.toml:54: design.random.side = \"real-left\"; allowed are materials, because present.real-left.left.sample takes it: {materials}",
            ),
            (
                "left = { sample = \"real\" }",
                "left = { sample = \"real\", display = \"real\" }",
                "s.toml:27: present.real-left.left needs one of sample, display, hold_c and pulses; allowed is one",
            ),
            (
                "left = { sample = \"real\" }",
                "left = { sample = \"real\", device_finger = 1 }",
                "s.toml:27: present.real-left.left.device_finger has no meaning here; it is allowed beside display, hold_c or pulses",
            ),
            (
                "left = { sample = \"real\" }",
                "left = { display = \"real\" }",
                "s.toml:28: present.real-left.right.device_finger = 0 again; allowed is another finger of the device for each station",
            ),
            (
                "left = { sample = \"real\" }",
                "left = { hold_c = \"real\" }",
                "s.toml:52: design.factors.real = copper; allowed is 15 to 42, because present.real-left.left.hold_c takes it",
            ),
            (
                "left = { sample = \"real\" }",
                "left = { hold_c = 50 }",
                "s.toml:27: present.real-left.left.hold_c = 50; allowed is 15 to 42 or a factor (real, simulated, side)",
            ),
            (
                "left = { sample = \"real\" }",
                "left = { pulses = { base_c = 33, change = \"cooling\", change_k = 1, changed = \"side\", rate_k_s = 1 } }",
                "s.toml:27: present.real-left.left.pulses.changed = \"side\"; allowed is a factor with the levels first and second (real, simulated, side)",
            ),
            (
                "factors.real = [\"copper\", \"foam\"]",
                "factors.real = [\"copper\", \"gold\"]",
                "s.toml:52: design.factors.real = \"gold\"; allowed are materials, because present.real-left.left.sample takes it: {materials}",
            ),
            (
                "factors.real = [\"copper\", \"foam\"]",
                "factors.real = [\"copper\", \"copper\"]",
                "s.toml:52: design.factors.real = \"copper\"; allowed is each level once in design.factors.real",
            ),
            (
                "factors.real = [\"copper\", \"foam\"]",
                "factors.real = [\"copper\"]",
                "s.toml:52: design.factors.real = [\"copper\"]; allowed is a list of 2 to 100 different levels: words or numbers",
            ),
            (
                "factors.real = [\"copper\", \"foam\"]",
                "factors.real = \"copper\"",
                "s.toml:52: design.factors.real = \"copper\"; allowed is a list of 2 to 100 different levels: words or numbers",
            ),
            (
                "factors.real = [\"copper\", \"foam\"]",
                "factors.real = [\"copper\", \"a b\"]",
                "s.toml:52: design.factors.real = \"a b\"; allowed is 1 to 40 letters, digits, - _ and .",
            ),
            (
                "factors.real = [\"copper\", \"foam\"]",
                "factors.left = [\"copper\", \"foam\"]",
                "s.toml:52: design.factors.left: \"left\" is a factor; allowed is a name that is not that of the station \"left\" and does not begin with \"left_\", as that station's columns do",
            ),
            (
                "factors.real = [\"copper\", \"foam\"]",
                "factors.block = [\"copper\", \"foam\"]",
                "s.toml:52: design.factors.block: \"block\" is a factor; allowed is as a name 1 to 40 letters, digits and _, with a small letter first, and none of answer, attempt, block, break_before, by, contact, correct, duration, expected, land, level_k, lift, onset, part, participant, participant_id, reach_cue, reason, response, response_time, room, sample, staircase, stim_file, target_force, target_force_n, touch_cue, touches, trial, trial_type, void",
            ),
            (
                "random = { side = ",
                "random = { real = [\"a\", \"b\"], side = ",
                "s.toml:54: design.random.real: \"real\" is a factor; allowed is each factor once in a part",
            ),
            (
                "balance = [\"side\"]",
                "balance = [\"real\"]",
                "s.toml:55: design.balance = \"real\"; allowed is a list of factors of random: side",
            ),
            (
                "repeat = 4",
                "repeat = 3",
                "s.toml:56: design.repeat = 3 with \"side\" in balance; allowed is a multiple of its 2 levels",
            ),
            (
                "repeat = 4",
                "repeat = 0",
                "s.toml:56: design.repeat = 0; allowed is a whole number from 1 to 1000",
            ),
            (
                "repeat = 4",
                "repeat = 1000000",
                "s.toml:56: design.repeat = 1000000; allowed is a whole number from 1 to 1000",
            ),
            (
                "blocks = \"repetition\"",
                "blocks = \"latin\"",
                "s.toml:57: design.blocks = \"latin\"; allowed is \"repetition\", \"none\" or a table with the keys by, repetitions",
            ),
            (
                "blocks = \"repetition\"",
                "blocks = { repetitions = 3 }",
                "s.toml:57: design.blocks.repetitions = 3; allowed is a divisor of design.repeat = 4",
            ),
            (
                "blocks = \"repetition\"",
                "blocks = { by = \"side\" }",
                "s.toml:57: design.blocks.by = \"side\"; allowed is a factor of factors: real, simulated",
            ),
            (
                "max_run = { real = 3 }",
                "max_run = { fake = 3 }",
                "s.toml:58: design.max_run.fake: \"fake\" is no factor; allowed are real, simulated, side",
            ),
            (
                "max_run = { real = 3 }",
                "max_run = { real = 0 }",
                "s.toml:58: design.max_run.real = 0; allowed is a whole number from 1 to 100",
            ),
            (
                "place = \"pad\"",
                "place = \"lap\"",
                "s.toml:35: rest.place = \"lap\"; allowed is \"pad\" or \"display\" or \"air\"",
            ),
            (
                "timeout_s = 180.0",
                "timeout_s = 1",
                "s.toml:39: rest.timeout_s = 1; allowed is more than rest.for_s = 2",
            ),
            ("skin_c = 33.0", "skin_c = 50", "s.toml:36: rest.skin_c = 50; allowed is 20 to 40"),
            ("skin_c = 33.0", "", "s.toml:34: rest.skin_c is missing; allowed is 20 to 40"),
            (
                "procedure = \"touch\"",
                "procedure = \"intervals\"",
                "s.toml:43: trial.reach_s has no meaning here; it is allowed with trial.procedure = \"touch\"",
            ),
            (
                "max_s = 10.0",
                "max_ss = 10.0",
                "s.toml:45: trial.max_ss is no key; allowed are procedure, reach_s, contact, max_s, land_s, target_force_n, interval_s, gap_s, answer, answer_s, feedback",
            ),
            (
                "max_s = 10.0",
                "max_s = \"long\"",
                "s.toml:45: trial.max_s = \"long\"; allowed is 0.5 to 600",
            ),
            ("max_s = 10.0", "max_s = nan", "s.toml:45: trial.max_s = nan; allowed is 0.5 to 600"),
            (
                "reach_s = 0.0",
                "target_force_n = 1",
                "s.toml:43: trial.target_force_n has no meaning here; it is allowed with trial.contact = \"force\"",
            ),
            (
                "contact = \"free\"",
                "contact = \"force\"",
                "s.toml:41: trial.target_force_n is missing; allowed is 0.05 to 5 or a factor",
            ),
            (
                "reach_s = 0.0",
                "gap_s = 1",
                "s.toml:43: trial.gap_s has no meaning here; it is allowed with trial.procedure = \"intervals\"",
            ),
            (
                "feedback = false",
                "feedback = \"no\"",
                "s.toml:48: trial.feedback = \"no\"; allowed is true or false",
            ),
            (
                "one_of = [\"left\", \"right\"]",
                "one_of = [\"left\", \"rihgt\"]",
                "s.toml:49: trial.answer.one_of = \"rihgt\"; allowed is a station, with score.correct = \"colder\": left, right",
            ),
            (
                "one_of = [\"left\", \"right\"]",
                "one_of = [\"left\"]",
                "s.toml:49: trial.answer.one_of = [\"left\"]; allowed is 2 to 10 different words",
            ),
            (
                "one_of = [\"left\", \"right\"]",
                "number_per_station = [0, 100]",
                "s.toml:69: score.correct = \"colder\" without answers; it is allowed beside trial.answer.one_of",
            ),
            (
                "one_of = [\"left\", \"right\"]",
                "number_per_station = [100, 0]",
                "s.toml:49: trial.answer.number_per_station = [100, 0]; allowed is two numbers from -1000 to 1000, the smaller one first",
            ),
            (
                ", one_of = [\"left\", \"right\"]",
                "",
                "s.toml:49: trial.answer needs one of one_of and number_per_station; allowed is either",
            ),
            (
                "correct = \"colder\"",
                "correct = \"warmer\"",
                "s.toml:69: score.correct = \"warmer\"; allowed is \"none\", \"colder\", \"same\" or a table { factor = … }",
            ),
            (
                "correct = \"colder\"",
                "correct = \"same\"",
                "s.toml:49: trial.answer.one_of = \"left\"; allowed is same and different with score.correct = \"same\"",
            ),
            (
                "correct = \"colder\"",
                "correct = { factor = \"side\" }",
                "s.toml:69: score.correct.factor = \"side\", whose level \"real-left\" is no answer; allowed is a factor of which each level is one of left, right",
            ),
            (
                "correct = \"colder\"",
                "correct = { factor = \"hand\" }",
                "s.toml:69: score.correct.factor = \"hand\"; allowed is a factor of all parts: real, simulated, side",
            ),
            (
                "correct = \"colder\"\n",
                "",
                "s.toml:69: score.chance has no meaning here; it is allowed beside score.correct",
            ),
            (
                "threshold = 0.72",
                "threshold = 0.4",
                "s.toml:71: score.threshold = 0.4; allowed is more than the chance 0.500",
            ),
            (
                "analyses = [\"pairs-by-mode\", \"identical-pairs\"]",
                "analyses = [\"falls\"]",
                "s.toml:72: score.analyses: \"falls\" needs contact = \"hold\" or \"force\"",
            ),
            (
                "analyses = [\"pairs-by-mode\", \"identical-pairs\"]",
                "analyses = [\"ancova\"]",
                "s.toml:72: score.analyses: \"ancova\" needs pairs or confusion",
            ),
            (
                "analyses = [\"pairs-by-mode\", \"identical-pairs\"]",
                "analyses = [\"anova\"]",
                "s.toml:72: score.analyses = \"anova\"; allowed is pairs, pairs-by-mode, identical-pairs, confusion, information, oddity, same-different, falls, exponential-fit, levene, pearson-with-model, force-matching, anova-within, anova-split-plot, tukey, ancova, pearson-between-parts, chi-squared-against, staircase, psychometric-fit, magnitudes",
            ),
            (
                "threshold = 0.72",
                "against = \"table-3-3\"",
                "s.toml:71: score.against has no meaning here; it is allowed beside \"chi-squared-against\" in score.analyses",
            ),
            (
                "contact_min_s = 0.5",
                "contact_min_s = 20",
                "s.toml:64: void.contact_min_s = 20; allowed is 0 to trial.max_s = 10",
            ),
            (
                "force_max_n = 5.0",
                "force_off_target = 0.2",
                "s.toml:63: void.force_off_target has no meaning here; it is allowed with trial.contact = \"force\"",
            ),
            ("[device]", "[device]\n[device]", "s.toml:10: device again; allowed is each key once"),
            (
                "[score]",
                "[[staircase]]\nname = \"a\"\nstart_k = 1\nmax_k = 2\n\n[score]",
                "s.toml:52: design.factors has no meaning here; it is allowed in a part without staircases; their levels tell factors",
            ),
            (
                "[rest]",
                "[materials.copper]\nk_w_mk = 1\n\n[rest]",
                "s.toml:34: materials.copper: allowed is a name of its own; {materials} have their meaning",
            ),
            (
                "[rest]",
                "[materials.gold]\nk_w_mk = 1\n\n[rest]",
                "s.toml:34: materials.gold.rq_um is missing; allowed is 0.001 to 1000",
            ),
            (
                "[rest]",
                "[[part]]\nname = \"one\"\n\n[rest]",
                "s.toml:55: design.factors has no meaning here; it is allowed in a [[part]], if the file has parts",
            ),
            (
                "[rest]",
                "a.b.c.d.e.f.g.h.i.j = 1\n[rest]",
                "s.toml:34: a key of more than 8 words; allowed is 1 to 8",
            ),
            (
                "[rest]",
                "a = [[[[[[[[[[]]]]]]]]]]\n[rest]",
                "s.toml:34: 9 brackets in each other; allowed is 0 to 8",
            ),
        ],
    );
}

/// Changes of a ready session, each with the beginning of the line at which the error must be, and its text. The files have
/// comments, which may change.
fn assert_errors_at(right: &str, changes: &[(&str, &str, &str, &str)]) {
    let path = Path::new("s.toml");
    Session::parse(right, path).expect("the file before the change");
    for (from, to, at, expected) in changes {
        assert_eq!(right.matches(from).count(), 1, "{from:?} occurs once");
        let text = right.replace(from, to);
        let error = Session::parse(&text, path).expect_err(to);
        let line = error.line().and_then(|line| text.lines().nth(line - 1));
        assert!(line.is_some_and(|line| line.starts_with(at)), "{line:?}: {error}");
        assert_eq!(error.problem(), *expected, "{from:?} as {to:?}");
    }
}

#[test]
fn wrong_pulses_and_staircases_are_answered() {
    // With the factor of the intervals in balance, so that it can be wrong.
    let balanced = "balance = [\"interval\"]\nrandom = {";
    assert_errors_at(
        &ready("p9-change-threshold").replace("random = {", balanced),
        &[
            (
                "[device]\nlaw = \"model\"\nstream_ms = 10\n",
                "",
                "index",
                "present.cooling.index is a display; it is allowed beside a table [device]",
            ),
            (
                "interval_s = 4.0\n",
                "",
                "[trial]",
                "trial.interval_s is missing; allowed is 0.5 to 60",
            ),
            (
                "gap_s = 2.0",
                "gap_s = 1.0",
                "index",
                "present.cooling.index departs by -2 K in 1.3 s; allowed is at most 1 s, the shorter of trial.interval_s and trial.gap_s",
            ),
            (
                "interval_s = 4.0\n",
                "interval_s = 4.0\nmax_s = 3\n",
                "max_s",
                "trial.max_s has no meaning here; it is allowed with trial.procedure = \"touch\"",
            ),
            (
                "[present.cooling]\nindex = { pulses = { base_c = 33.0,",
                "[present.cooling]\nindex = { pulses = { base_c = 16.0,",
                "index",
                "present.cooling.index reaches 14.00 C; allowed is 15 to 42 C",
            ),
            (
                "[present.cooling]\nindex = { pulses = {",
                "[present.cooling]\nindex = { pulses = { change_k = 1.0,",
                "index",
                "present.cooling.index.pulses.change_k beside a [[staircase]]; allowed is one of both",
            ),
            (
                "\nanswer = {",
                "\n#answer = {",
                "answer_s",
                "trial.answer_s has no meaning here; it is allowed beside trial.answer",
            ),
            (
                "break_after = 40",
                "repeat = 2",
                "repeat",
                "design.repeat has no meaning here; it is allowed in a part without staircases; their levels tell factors",
            ),
            (
                "trials_max = 60\n\n[[",
                "trials_max = 61\n\n[[",
                "trials_max = 61",
                "staircase.trials_max = 61 with \"interval\" in balance; allowed is a multiple of its 2 levels",
            ),
            (
                "levels = { change = \"cooling\" }",
                "levels = { interval = \"first\" }",
                "levels",
                "staircase.levels.interval: \"interval\" is a factor; allowed is each factor once in a part",
            ),
            (
                "levels = { change = \"cooling\" }",
                "levels = { other = \"cooling\" }",
                "[[staircase]]",
                "staircase.levels has the factors [\"change\"]; allowed are those of the staircase \"cooling\" in the same part: [\"other\"]",
            ),
            (
                "name = \"warming\"",
                "name = \"cooling\"",
                "name",
                "staircase.name = \"cooling\"; allowed is a name that no other staircase has",
            ),
            (
                "name = \"warming\"",
                "name = \"warming\"\npart = \"two\"",
                "part",
                "staircase.part must name a part; allowed are main",
            ),
            (
                "correct = { factor = \"interval\" }\nchance = 0.5",
                "",
                "[[staircase]]",
                "a staircase follows correct answers; it is allowed beside score.correct",
            ),
        ],
    );
}

#[test]
fn wrong_forces_blocks_parts_and_pairs_are_answered() {
    assert_errors_at(
        &ready("p8-force-matching"),
        &[
            (
                "index = { display = \"window\" }",
                "index = { sample = \"window\" }",
                "contact",
                "trial.contact = \"force\"; allowed is \"force\" with a station that presents a display, which measures it",
            ),
            (
                "target_force_n = \"force_n\"",
                "",
                "[trial]",
                "trial.target_force_n is missing; allowed is 0.05 to 5 or a factor",
            ),
            (
                "target_force_n = \"force_n\"",
                "target_force_n = 9",
                "target_force_n",
                "trial.target_force_n = 9; allowed is 0.05 to 5 or a factor (window, force_n)",
            ),
            (
                "target_force_n = \"force_n\"",
                "target_force_n = \"window\"",
                "factors.window",
                "design.factors.window = baf2; allowed is 0.05 to 5, because trial.target_force_n takes it",
            ),
            (
                "[0.1, 0.25, 0.5, 1, 2]",
                "[0.1, 0.25, 0.5, 1, 20]",
                "factors.force_n",
                "design.factors.force_n = 20; allowed is 0.05 to 5, because trial.target_force_n takes it",
            ),
            (
                "contact_min_s = 9.5",
                "force_max_n = 1.5",
                "force_max_n",
                "void.force_max_n = 1.5; allowed is at least the largest target force, 2 N",
            ),
            (
                "contact_min_s = 9.5",
                "landings_apart_s = 1",
                "landings_apart_s",
                "void.landings_apart_s has no meaning here; it is allowed with two stations or more",
            ),
            (
                "repetitions = 3",
                "repetitions = 4",
                "blocks",
                "design.blocks.repetitions = 4; allowed is a divisor of design.repeat = 6",
            ),
            (
                "place = \"pad\"",
                "place = \"display\"\nwithin = 1",
                "within",
                "rest.within is no key; allowed are place, skin_c, within_k, for_s, timeout_s",
            ),
        ],
    );
    assert_errors_at(
        &ready("p4-identification"),
        &[
            (
                "[design]",
                "[design]\nrepeat = 3",
                "repeat",
                "design.repeat has no meaning here; it is allowed in a [[part]], if the file has parts",
            ),
            (
                "name = \"simulated\"",
                "name = \"real\"",
                "name",
                "part.name = \"real\"; allowed is a name that no other part has",
            ),
            (
                "constants = { mode = \"simulated\" }",
                "constants = { mode = \"fake\" }",
                "[present.simulated]",
                "present.simulated is no level of \"mode\"; allowed are real, fake",
            ),
            (
                "constants = { mode = \"simulated\" }",
                "",
                "by",
                "present.by = \"mode\"; allowed is a factor of all parts: material",
            ),
            (
                "[present.simulated]\nindex = { display = \"material\" }",
                "",
                "by",
                "present.simulated is missing; allowed is a table for each level of \"mode\": real, simulated",
            ),
            (
                "one_of = [\"copper\", ",
                "one_of = [\"cupper\", ",
                "correct",
                "score.correct.factor = \"material\", whose level \"copper\" is no answer; allowed is a factor of which each level is one of cupper, stainless-steel, granite, abs, foam",
            ),
        ],
    );
    assert_errors_at(
        &ready("p1-discrimination"),
        &[
            (
                "identical = true",
                "identical = true, ordered = true",
                "pairs",
                "design.pairs.identical = true; allowed is false with ordered = true; all pairs of two factors are their combinations: use factors",
            ),
            (
                "into = [\"first\", \"second\"]",
                "into = [\"first\"]",
                "pairs",
                "design.pairs.into = [\"first\"]; allowed is a list of two names of factors",
            ),
            (
                "place = \"pad\" ",
                "place = \"display\" ",
                "place",
                "rest.place = \"display\" without a display; allowed is \"pad\" or \"air\", or a station that presents a display",
            ),
        ],
    );
}

#[test]
fn a_skin_thermistor_is_one_of_the_device_and_at_one_station() {
    assert_errors_at(
        &ready("p2-skin-temperature-fall"),
        &[
            (
                "skin_sensor = 0 ",
                "skin_sensor = 5 ",
                "skin_sensor = 5",
                "stations.left.skin_sensor = 5; allowed is a whole number from 0 to 4",
            ),
            (
                "skin_sensor = 0 ",
                "skin_sensor = \"index\" ",
                "skin_sensor = \"index\"",
                "stations.left.skin_sensor = \"index\"; allowed is a whole number from 0 to 4",
            ),
            (
                "skin_sensor = 1",
                "skin_sensors = 1",
                "skin_sensors",
                "stations.right.skin_sensors is no key; allowed are finger, skin_sensor",
            ),
            (
                "skin_sensor = 1",
                "skin_sensor = 0x0",
                "skin_sensor = 0x0",
                "stations.right.skin_sensor = 0 again; allowed is another finger of the device for each station",
            ),
            (
                "[device]\nstream_ms = 50 ",
                "",
                "skin_sensor = 0 ",
                "stations.left.skin_sensor is a thermistor of the device; it is allowed beside a table [device]",
            ),
        ],
    );
    // A display has the thermistor of the other station: in one trial, in two, and although its station names another one.
    let problem = |display: &str| {
        format!(
            "{display}: a display on finger 0 of the device, whose skin thermistor is at another station by \
             stations.left.skin_sensor; allowed is another device_finger, or another skin_sensor there"
        )
    };
    assert_errors_at(
        &ready("p5-real-and-simulated"),
        &[(
            "finger = \"left index\"",
            "finger = \"left index\"\nskin_sensor = 0",
            "right = { display = \"simulated\" }",
            &problem("present.real-left.right"),
        )],
    );
    let display = "right = { display = \"copper\", device_finger = 2 }";
    let in_one = format!("left = {{ sample = \"copper\" }}\n{display}\n");
    let in_two = format!(
        "by = \"side\"\n[present.a]\nleft = {{ sample = \"copper\" }}\nright = \"nothing\"\n\
         [present.b]\nleft = \"nothing\"\n{display}\n"
    );
    for (present, factors, key) in [
        (in_one, "", "present.right"),
        (in_two, "factors = { side = [\"a\", \"b\"] }", "present.b.right"),
    ] {
        for own in ["", "skin_sensor = 1\n"] {
            let text = format!(
                "format = 1\ntitle = \"t\"\ntask = \"t\"\ncite = \"t\"\ninstruction = \"t\"\n[device]\n\
                 [stations.left]\nfinger = \"left index\"\nskin_sensor = 0\n\
                 [stations.right]\nfinger = \"right index\"\n{own}[present]\n{present}[trial]\n[design]\n{factors}\n"
            );
            assert_errors_at(
                &text,
                &[("device_finger = 2", "device_finger = 0", "right = { display", &problem(key))],
            );
        }
    }
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let error = Session::read(Path::new("missing.toml")).expect_err("no file");
    assert!(error.to_string().starts_with("missing.toml: cannot be read: "), "{error}");
    assert_eq!(error.line(), None);
}

#[test]
fn control_characters_are_refused_with_key_and_line() {
    let allowed = "; allowed are characters that are shown, line ends and tabs";
    let control = |line: u32, what: &str| format!("s.toml:{line}: {what}{allowed}");
    assert_errors(
        example(),
        &[
            (
                "title = \"Copper and",
                "title = \"\\u001b]0;Copper and",
                &control(2, "title has the control character U+001B"),
            ),
            (
                "finger = \"right index\"",
                "finger = \"right \u{202e}index\"",
                &control(21, "stations.right.finger has the control character U+202E"),
            ),
            (
                "title = \"Copper",
                "\"ti\\u0007tle\" = \"Copper",
                &control(2, r"ti\u{7}tle has the control character U+0007"),
            ),
            (
                "format = 1\n",
                "'k\u{9b}' = 1\n'k\u{9b}' = 1\n",
                r"s.toml:2: 'k\u{9b}' again; allowed is each key once",
            ),
        ],
    );
    let text = example().replacen("title = \"Copper", "title = \"\tCopper, 23 °C, 冷,", 1);
    Session::parse(&text, Path::new("s.toml")).expect("a title in other scripts");
}

#[test]
fn answers_that_a_spreadsheet_would_compute_are_refused() {
    let with = |word: &str| {
        let text =
            example().replacen("[\"left\", \"right\"]", &format!("[\"left\", \"{word}\"]"), 1);
        let parsed = Session::parse(&text, Path::new("s.toml"));
        parsed.map_err(|error| error.to_string()).err().unwrap_or_default()
    };
    for formula in ["=1+1", "=HYPERLINK('x')", "@SUM(A1)", "+1+1", "-2+cmd|' /C calc'!A0", "-cold"]
    {
        let expected = format!(
            "s.toml:49: trial.answer.one_of = \"{formula}\"; allowed is a word that no spreadsheet takes for a formula"
        );
        assert!(with(formula).starts_with(&expected), "{}", with(formula));
    }
    for word in ["+", "-", "-1", "+0.5", "a=b", "1+1", "−2"] {
        // The words of the answers are those of the correct ones.
        assert!(!with(word).contains("spreadsheet"), "{word}: {}", with(word));
    }
}

/// Lines left out, cut, or with another value: an answer, or a session with a plan, and no panic.
#[test]
fn no_change_of_a_file_makes_the_reader_panic() {
    let values =
        ["0", "-1e300", "\"x\"", "[]", "[[1]]", "{}", "{ a = { b = 1 } }", "true", "1979-05-27"];
    let names = [
        "p4-identification",
        "p6-skin-temperature",
        "p8-force-matching",
        "p9-change-threshold",
        "p14-same-or-different",
    ];
    let mut refused = 0;
    for text in names.map(ready) {
        let lines: Vec<&str> = text.lines().collect();
        for (at, line) in lines.iter().enumerate() {
            let key = line.split_once('=').map(|(key, _)| key);
            let changed =
                key.into_iter().flat_map(|key| values.map(|value| format!("{key}= {value}")));
            for change in
                changed.chain([String::new(), line.chars().take(line.len() / 2).collect()])
            {
                let mut lines = lines.clone();
                lines[at] = &change;
                match Session::parse(&lines.join("\n"), Path::new("s.toml")) {
                    Ok(session) => drop(Plan::new(&session, "P01", 1)),
                    Err(error) => {
                        assert!(error.line().is_some(), "{error}");
                        refused += 1;
                    }
                }
            }
        }
    }
    assert!(refused > 1000, "{refused}");
}

/// The row of a key in the table after a heading or a text.
fn row(after: &str, key: &str) -> &'static str {
    let (_, from) = DOCS.split_once(after).expect(after);
    let mut rows = from.lines();
    rows.find(|row| row.starts_with(&format!("| `{key}` |")))
        .unwrap_or_else(|| panic!("{after}: {key}"))
}

fn assert_row(after: &str, key: &str, (least, most): (f64, f64), default: Option<f64>) {
    let row = row(after, key);
    assert!(row.contains(&format!("{least} to {most}")), "{row}");
    if let Some(default) = default {
        assert!(row.ends_with(&format!("| {default} |")), "{row}: {default}");
    }
}

#[test]
fn the_documentation_has_each_number_with_range_and_default() {
    let numbers: [(&str, &[Number]); 8] = [
        ("`[device]`", &[setup::OBJECT_C, setup::DEVICE_SKIN_C]),
        ("`[materials.NAME]`", &materials::PROPERTIES),
        ("`[rest]`", &[setup::REST_SKIN_C, setup::WITHIN_K, setup::FOR_S, setup::TIMEOUT_S]),
        ("Keys of `pulses`", &[present::STANDARD_K, present::CHANGE_K, present::RATE_K_S]),
        (
            "`[trial]`",
            &[
                trial::REACH_S,
                trial::MAX_S,
                trial::LAND_S,
                trial::TARGET_FORCE_N,
                trial::INTERVAL_S,
                trial::GAP_S,
                trial::ANSWER_S,
            ],
        ),
        ("## Staircases", &[design::START_K, design::MAX_K, design::FACTOR]),
        (
            "## Void",
            &[
                trial::DISPLAY_OFF_PRESET_K,
                trial::FORCE_MAX_N,
                trial::CONTACT_MIN_S,
                trial::FORCE_OFF_TARGET,
                trial::LANDINGS_APART_S,
            ],
        ),
        ("## Score", &[score::CHANCE, score::THRESHOLD]),
    ];
    for (after, numbers) in numbers {
        for number in numbers {
            assert_row(after, number.key, number.range, number.default);
        }
    }
    assert_row("## Design", "break_s", design::BREAK_S.range, design::BREAK_S.default);
    let wholes: [(&str, &[Whole]); 5] = [
        ("`[device]`", &[setup::STREAM_MS]),
        ("## Design", &[design::REPEAT, design::BREAK_AFTER]),
        ("## Staircases", &[design::DOWN, design::REVERSALS, design::COUNTED, design::TRIALS_MAX]),
        ("## Void", &[trial::ATTEMPTS_MAX]),
        ("`[stations.NAME]`", &[setup::SKIN_SENSOR]),
    ];
    for (after, wholes) in wholes {
        for whole in wholes {
            let (least, most) = whole.range;
            let range = (f64::from(least), f64::from(most));
            assert_row(after, whole.key, range, whole.default.map(f64::from));
        }
    }
}

#[test]
fn the_documentation_has_all_keys_and_words() {
    let tables: [(&str, &[&str]); 10] = [
        ("## Keys", &KEYS),
        ("`[device]`", &setup::DEVICE_KEYS),
        ("`[rest]`", &setup::REST_KEYS),
        ("`[stations.NAME]`", &setup::STATION_KEYS),
        ("Keys of `pulses`", &present::PULSES_KEYS),
        ("`[trial]`", &trial::TRIAL_KEYS),
        ("## Design", &design::PART_KEYS),
        ("## Staircases", &design::STAIRCASE_KEYS),
        ("## Void", &trial::VOID_KEYS),
        ("## Score", &score::SCORE_KEYS),
    ];
    for (after, keys) in tables {
        for key in keys {
            row(after, key);
        }
    }
    for (word, needs) in ANALYSES {
        assert_eq!(row("| analysis |", word), format!("| `{word}` | {needs} |"));
    }
    for table in PUBLISHED_TABLES {
        assert!(row("## Score", "against").contains(table));
    }
}

/// A session's material must not be refused in the middle of a session.
#[test]
fn the_device_accepts_the_same_materials() {
    let accepted = |values: [f64; 5]| {
        let [conductivity_w_mk, density_kg_m3, specific_heat_j_kgk, roughness_um, slope_rad] =
            values;
        let material = Material {
            surface: Surface { conductivity_w_mk, roughness_um, slope_rad },
            density_kg_m3,
            specific_heat_j_kgk,
        };
        let line = StationRequest::custom_material(&material).to_string();
        check_line(&line).is_ok()
    };
    let corner = |corner: usize| {
        let mut values = [0.0; 5];
        for (bit, (value, property)) in values.iter_mut().zip(&materials::PROPERTIES).enumerate() {
            let (least, most) = property.range;
            *value = if corner >> bit & 1 == 0 { least } else { most };
        }
        values
    };
    for index in 0..32 {
        assert!(accepted(corner(index)), "{:?}", corner(index));
    }
    for property in 0..5 {
        let (mut below, mut above) = (corner(0), corner(31));
        below[property] *= 0.5;
        above[property] *= 1.01;
        assert!(!accepted(below) && !accepted(above), "{}", materials::PROPERTIES[property].key);
    }
}
