//! Mistakes in a file.

use super::*;

/// Reads the file of a stage, in which one text is replaced by another.
fn mistaken(name: &str, right: &str, wrong: &str) -> String {
    let (name, text) = FILES.iter().find(|(known, _)| *known == name).expect("a stage");
    assert!(text.contains(right), "{name}: {right}");
    let nothing = Table::from_iter([("do".into(), Value::from("Nothing."))]);
    let mut needs = Tables::from([("chip".into(), nothing)]);
    stage(name, &text.replacen(right, wrong, 1), &mut needs).expect_err(wrong)
}

#[test]
fn a_mistake_is_answered_with_step_key_and_what_is_allowed() {
    let check = "step 2, check = \"12v\": ";
    for (right, wrong, parts) in [
        ("title", "headline", ["unknown field `headline`", "expected one of `title`"]),
        ("[[step]]", "[[steps]]", ["unknown field `steps`", "`step`"]),
        (
            "what =",
            "measured =",
            [check, "unknown field `measured`, expected one of `check`, `what`"],
        ),
        ("basis = \"12 V", "low = \"12 V", [check, "missing field `basis`"]),
        ("reads.meter", "reads.gauge", [check, "reads"]),
        ("\"V\"]", "\"volts\"]", [check, "unknown variant `volts`, expected one of `ohm`, `V`"]),
        ("11.6, 12.4", "\"11.6\", 12.4", [check, "expected f64"]),
        ("11.6, 12.4", "12.4, 11.6", [check, "expected.range: 12.4 to 11.6; allowed: "]),
        ("range = [11.6, 12.4, \"V\"]", "words = [\"12\"]", [check, "allowed: expected.range"]),
        ("blocks = \"chip\"", "blocks = \"cheap\"", [check, "expected one of `bare-board`"]),
        ("blocks = \"chip\"", "blocks = \"bare-board\"", [check, "allowed: this one and later"]),
        ("wait_ms", "wait_s", ["step 1, do = ", "expected one of `do`, `bench`, `wait_ms`"]),
    ] {
        let problem = mistaken("rails", right, wrong);
        for part in parts {
            assert!(problem.contains(part), "{wrong}: {problem}");
        }
    }
    for (right, wrong, part) in [
        (
            "needs.like = \"chip\"",
            "needs.like = \"run\"",
            "needs: like: \"run\"; allowed: an earlier one, chip",
        ),
        (
            "like = \"in1-in-reset\"",
            "like = \"in2\"",
            "like: \"in2\"; allowed: an earlier one, in1-in-reset",
        ),
    ] {
        let problem = mistaken("reset", right, wrong);
        assert!(problem.contains(part), "{wrong}: {problem}");
    }
    let problem = mistaken("chip", "run = \"identify\"", "run = \"identity\"");
    assert!(
        problem.contains(
            "step 1, run = \"identity\": unknown variant `identity`, expected one of `identify`"
        ),
        "{problem}"
    );
}
