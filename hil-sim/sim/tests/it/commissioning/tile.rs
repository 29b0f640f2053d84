//! What tuning finds with a mirror that is off, and how plants answer sines.

use documented_figures::{assert_sampled, one_case_in};
use thermal_plant::Params;
use thermal_sim::commissioning::{FrequencyResponse, settings_for_device};

use super::{ROOM_C, device};

/// What the mirror shows too much or too little of any current, to the ends of its class. The gain of one tuning scatters by
/// 0.03 % with the converter's noise, as much as is looked for; hence the mean of several converters.
#[test]
fn the_mirrors_zero_is_not_taken_for_the_tiles_answer() {
    let gain_k_s_a = |zero_a: f64, seed: u64| -> f64 {
        let mut params = Params::nominal();
        params.sensors.mirror.offset_a = zero_a;
        let settings = settings_for_device(&params, ROOM_C, seed).expect("a commissioned device");
        let tile = settings.iter().find_map(|line| line.strip_prefix("set tile "));
        let gain = tile.and_then(|values| values.split(' ').next());
        gain.and_then(|gain| gain.parse().ok()).expect("a gain")
    };
    const SEEDS: std::ops::RangeInclusive<u64> = 1..=8;
    let mean = |zero_a: f64| SEEDS.map(|seed| gain_k_s_a(zero_a, seed)).sum::<f64>();
    let sound = mean(0.0);
    // The suite takes one of the two.
    let zeros_a = [-0.05, 0.05].into_iter().step_by(one_case_in(2));
    let off = zeros_a.map(|zero_a| (mean(zero_a) / sound - 1.0).abs());
    assert_sampled("tuning.mirror_gain", 100.0 * off.fold(0.0, f64::max));
}

/// Well below the legs' own corner, 9 rad/s, a plate and a third of its legs integrate what is pumped: `a T / (C w)`,
/// beside what leaks. The plant computes neither from these.
#[test]
fn plate_answers_sines_as_its_heat_capacity_says() {
    let plants = device(None, 1);
    let tile = &plants.params().tile;
    let plate_j_k =
        tile.plate_m2() * tile.ceramic_m * tile.ceramic_j_m3k + tile.tabs_j_k + tile.legs_j_k / 3.0;
    let leak_1_s = (tile.conductance_w_k() + tile.film_w_m2k * tile.plate_m2()) / plate_j_k;
    for w in [0.7, 1.5, 3.0] {
        let response = FrequencyResponse::measure(&plants, w).expect("a plant");
        let expected =
            tile.seebeck_v_k() * (24.0 + 273.15) / plate_j_k / response.w.hypot(leak_1_s);
        println!("{response:?}, expected {expected:.4}");
        assert!((response.k_a / expected - 1.0).abs() < 0.04, "{response:?}, expected {expected}");
        let trailing = response.w.atan2(leak_1_s);
        assert!((response.phase_lag_rad - trailing).abs() < 0.06, "{response:?}, {trailing}");
    }
}
