use super::*;

fn touch(group: &str, object: &str, error_mk: f64) -> RenderedTouch {
    RenderedTouch {
        group: group.into(),
        object: object.into(),
        max_after_50ms_mk: error_mk,
        max_after_500ms_mk: 0.5 * error_mk,
    }
}

/// By hand: 0.14 K of one interval under the fingertip are its threshold of 75 %, less lapses of 2 %; no error is chance.
#[test]
fn a_thermode_finds_its_threshold_in_three_of_four_trials_but_for_lapses() {
    let touches =
        [touch("threshold", "granite 3 mm wood, draw 2", 140.2), touch("none", "foam", 0.0)];
    let report = told_apart(&touches).expect("known materials");
    let find = |group: &str, observer: &str| {
        let mut rows = report.rows.iter();
        let row = rows.find(|row| row.group == group && row.observer == observer);
        row.expect("a row").after_50ms
    };
    let [mean, highest] = find("threshold", "thermode, fingertip");
    assert!((mean - (0.98 * 75.0 + 1.0)).abs() < 0.02, "{mean}");
    assert_eq!(mean, highest);
    for observer in ["touch", "thermode, fingertip", "thermode, thenar"] {
        assert_eq!(find("none", observer), [50.0, 50.0]);
    }
    let [touch, _] = find("threshold", "touch");
    assert!((50.0..60.0).contains(&touch), "{touch}");
}

/// The 95th percentile is that of the touches, not of one observer's noise.
#[test]
fn one_touch_in_twenty_five_is_beyond_the_percentile() {
    let mut touches = vec![touch("all", "copper", 0.0); 24];
    touches.push(touch("all", "copper", 5000.0));
    let report = told_apart(&touches).expect("a known material");
    for row in &report.rows {
        let [mean, percentile] = row.after_50ms;
        assert_eq!(percentile, 50.0);
        assert!((50.5..52.1).contains(&mean), "{mean}");
        assert_eq!(row.touches, 25);
    }
}

#[test]
fn an_object_of_no_known_material_is_named() {
    let error = told_apart(&[touch("all", "cheese 3 mm", 1.0)]).expect_err("no material");
    let text = error.to_string();
    assert!(text.contains("cheese 3 mm") && text.contains("granite"), "{text}");
}
