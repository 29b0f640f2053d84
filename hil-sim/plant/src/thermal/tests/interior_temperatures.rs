//! Temperatures inside the skin against the exact solution of two half-spaces with a contact resistance.

use contact_model::material::find;
use documented_figures::assert_figure;

use super::*;

#[test]
fn skin_at_depth_follows_the_golden_solution() {
    let golden = include_str!("../../../../../model/tests/data/contact_interior.csv");
    let mut running: Option<(&str, f64, f64, Bench)> = None;
    let (mut seen, mut worst_mk) = (0, [0.0f64; 3]);
    let mut rows: Vec<(&'static str, [f64; 6])> = golden
        .lines()
        .skip(1)
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let number = |i: usize| fields[i].parse::<f64>().expect("a number");
            (fields[0], [2, 3, 4, 5, 6, 7].map(number))
        })
        .collect();
    // One run for each contact, in order of time.
    let order = |(name, row): &(&'static str, [f64; 6])| (*name, row[2], row[4]);
    rows.sort_by(|a, b| order(a).partial_cmp(&order(b)).expect("numbers"));
    for (name, [skin_c, object_c, resistance_m2k_w, depth_m, t_s, expected_c]) in rows {
        assert_eq!(skin_c, SKIN_C);
        let same = |(material, ohm, ..): &(&str, f64, f64, Bench)| {
            (*material, *ohm) == (name, resistance_m2k_w)
        };
        if !running.as_ref().is_some_and(same) {
            let object = ObjectConfig::half_space(*find(name).expect("known"), object_c);
            let mut bench = Bench::new(&FingerParams::homogeneous(), &object, TileParams::NOMINAL);
            let touch = SkinContact { area_m2: 135e-6, resistance_m2k_w };
            bench.touch(None, Some(touch));
            running = Some((name, resistance_m2k_w, 0.0, bench));
        }
        let (.., now_s, bench) = running.as_mut().expect("just begun");
        while *now_s < t_s - 0.5 * STEP_S {
            bench.step(None);
            *now_s += STEP_S;
        }
        let probe = DepthProbe::at(&bench.finger, depth_m).expect("inside");
        let off_mk = 1e3 * (bench.heat.depth_c(Finger::OnObject, &probe) - expected_c).abs();
        let place = if depth_m < 0.2e-3 { 0 } else { usize::from(depth_m > 0.6e-3) + 1 };
        worst_mk[place] = worst_mk[place].max(off_mk);
        seen += 1;
    }
    assert!(seen >= 347, "{seen}");
    println!("{worst_mk:?} mK down to 0.2 mm, down to 0.6 mm, below");
    assert_figure("truth.inside", worst_mk.into_iter().fold(0.0, f64::max));
}
