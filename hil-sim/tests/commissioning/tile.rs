//! What tuning finds over the box of plants, against the plants' parameters and against how they answer sines.

use documented_figures::assert_figure;
use hil_sim::commission::{QUANTITIES, Response, Surveyed, of_device, survey, table};
use hil_sim::plant::Params;

use super::{ROOM_C, device};

/// Devices.
const DRAWS: std::ops::Range<u64> = 1..11;
/// The largest deviation of each quantity in any of them. Which part of what delays the reading is lag and which dead
/// time is known less well than what counts for the loop: gain and phase at its crossover.
const ALLOWED: [(usize, f64); 7] = [
    (0, 4.0),
    (1, 25.0),
    (2, 20.0),
    (4, 20.0),
    (5, 8.0),
    (6, 15.0),
    (9, 2.5),
];

#[test]
fn tile_is_identified_over_the_box() {
    let all: Vec<Surveyed> = DRAWS.map(|draw| survey(draw).expect("a tile")).collect();
    println!("{}", table(&all));
    for surveyed in &all {
        for (place, allowed) in ALLOWED {
            let (value, (name, unit)) = (surveyed.values[place], QUANTITIES[place]);
            assert!(
                value.abs() < allowed,
                "draw {}: {name} is off by {value:.2} {unit}; {:?}",
                surveyed.draw,
                surveyed.tile
            );
        }
    }
    // They do differ: knowing the class alone would not do.
    let gains = || all.iter().map(|surveyed| surveyed.tile.gain_k_s_a);
    let (low, high) = (
        gains().fold(f64::MAX, f64::min),
        gains().fold(0.0, f64::max),
    );
    assert!(high > 1.3 * low, "{low} to {high}");
}

/// What the mirror shows too much or too little of any current, to the ends of its class.
#[test]
fn the_mirrors_zero_is_not_taken_for_the_tiles_answer() {
    let gain_k_s_a = |zero_a: f64| -> f64 {
        let mut params = Params::nominal();
        params.sensors.mirror.offset_a = zero_a;
        let settings = of_device(&params, ROOM_C, 1).expect("a commissioned device");
        let tile = settings
            .iter()
            .find_map(|line| line.strip_prefix("set tile "));
        let gain = tile.and_then(|values| values.split(' ').next());
        gain.and_then(|gain| gain.parse().ok()).expect("a gain")
    };
    let sound = gain_k_s_a(0.0);
    let off = [-0.05, 0.05].map(|zero_a| (gain_k_s_a(zero_a) / sound - 1.0).abs());
    assert_figure("tuning.mirror_gain", 100.0 * off[0].max(off[1]));
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
        let response = Response::of(&plants, w).expect("a plant");
        let expected =
            tile.seebeck_v_k() * (24.0 + 273.15) / plate_j_k / response.w.hypot(leak_1_s);
        println!("{response:?}, expected {expected:.4}");
        assert!(
            (response.k_a / expected - 1.0).abs() < 0.04,
            "{response:?}, expected {expected}"
        );
        let trailing = response.w.atan2(leak_1_s);
        assert!(
            (response.behind_rad - trailing).abs() < 0.06,
            "{response:?}, {trailing}"
        );
    }
}
