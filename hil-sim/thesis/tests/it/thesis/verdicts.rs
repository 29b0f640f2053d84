//! Agreement of a row, and effect of a remark on its verdict.

use thermal_thesis::Stated;
use thermal_thesis::row::{Correction, Remark, Row, Verdict};

const fn printed(value: f64, decimals: i32) -> Stated {
    Stated::Printed { value, decimals }
}

fn row(stated: Stated, computed: f64, remark: Option<Remark>) -> Row {
    Row { place: "Table", quantity: "quantity".into(), unit: "", stated, computed, remark }
}

#[test]
fn a_printed_number_agrees_with_all_values_that_round_to_it() {
    for (stated, agreeing, differing) in [
        (printed(24.3, 1), [24.251, 24.349], [24.249, 24.351]),
        // Trailing zeros are digits.
        (printed(29.0, 1), [28.951, 29.049], [28.949, 29.051]),
        (printed(29.0, 0), [28.51, 29.49], [28.49, 29.51]),
        // Unless they stand for tens.
        (printed(240.0, -1), [235.1, 244.9], [234.9, 245.1]),
        (printed(-0.12, 2), [-0.1249, -0.1151], [-0.1251, -0.1149]),
        // An exact half may go either way, whatever its binary fraction is.
        (printed(0.28, 2), [0.285, 0.275], [0.2851, 0.2749]),
        (printed(37.0, 0), [36.5, 37.5], [36.499, 37.501]),
    ] {
        for value in agreeing {
            assert!(stated.agrees(value), "{value} rounds to {stated}");
        }
        for value in differing {
            assert!(!stated.agrees(value), "{value} does not round to {stated}");
        }
    }
    assert!(!printed(1.0, 0).agrees(f64::NAN));
}

#[test]
fn ranges_and_limits_agree_within_their_bounds() {
    let about = Stated::About { value: 27.0, within: 0.5 };
    assert!(
        about.agrees(26.5) && about.agrees(27.5) && !about.agrees(26.49) && !about.agrees(27.51)
    );
    let between = Stated::Between { low: 2.0, high: 6.0 };
    assert!(
        between.agrees(2.0)
            && between.agrees(6.0)
            && !between.agrees(1.99)
            && !between.agrees(6.01)
    );
    assert!(Stated::Below(0.05).agrees(0.0499) && !Stated::Below(0.05).agrees(0.05));
    assert!(Stated::Above(3.0).agrees(3.01) && !Stated::Above(3.0).agrees(3.0));
    assert!(!Stated::Garbled("47 53".into()).agrees(53.0));
    assert_eq!(between.difference(6.5), Some(0.5));
    assert_eq!(between.difference(1.0), Some(-1.0));
    assert_eq!(Stated::Garbled("47 53".into()).difference(53.0), None);
}

#[test]
fn a_remark_counts_only_if_it_explains_the_difference() {
    let damaged = |correction| Some(Remark::Damaged("why".into(), correction));
    let wrong = |correction| Some(Remark::Wrong("why".into(), correction));
    for (computed, remark, verdict) in [
        (29.0, None, Verdict::Agrees),
        (30.0, None, Verdict::Differs(Some(1.0))),
        (30.0, Some(Remark::Note("why".into())), Verdict::Differs(Some(1.0))),
        // Agreement needs no remark and is not spoilt by one.
        (29.0, wrong(Correction::Is(77.0)), Verdict::Agrees),
        (29.9, Some(Remark::Cut), Verdict::Cut),
        (30.0, Some(Remark::Cut), Verdict::Differs(Some(1.0))),
        (28.4, Some(Remark::Cut), Verdict::Differs(Some(28.4 - 29.0))),
        (30.0, damaged(Correction::Reads(printed(30.0, 0))), Verdict::Damaged),
        (30.0, wrong(Correction::Reads(printed(30.0, 0))), Verdict::Wrong),
        (30.0, wrong(Correction::Reads(printed(31.0, 0))), Verdict::Differs(Some(1.0))),
        (30.0, damaged(Correction::Is(29.2)), Verdict::Damaged),
        (30.0, damaged(Correction::Is(29.6)), Verdict::Differs(Some(1.0))),
    ] {
        let row = row(printed(29.0, 0), computed, remark);
        assert_eq!(row.verdict(), verdict, "{row:?}");
    }
}
