//! Conservation and direction of heat between finger, tile and room.

use contact_model::material::{REFERENCE_DISPLAY, SKIN};

use super::*;

const STEP_S: f64 = 0.5e-3;
const SKIN_C: f64 = 34.0;
const ROOM_C: f64 = 24.0;

struct Bench {
    display: FingerOnDisplay,
    skin: HalfSpace,
    touch: Option<Touch>,
}

impl Bench {
    fn new() -> Self {
        let skin = HalfSpace::new(&SKIN, 60.0);
        let display = FingerOnDisplay::new(TileParams::CLASS, &skin, SKIN_C, ROOM_C);
        Self {
            display,
            skin,
            touch: Touch::under(2.0, &SKIN.surface, &REFERENCE_DISPLAY),
        }
    }

    /// A step with a mean voltage at the tile, V, and a tenth of its current's square as ripple.
    fn drive(&mut self, step_s: f64, volts: f64) {
        let load = self.display.load();
        let mean_a = (volts - load.seebeck_v) / load.resistance_ohm;
        let current = Current {
            mean_a,
            ripple_a2: 0.1 * mean_a * mean_a,
            mirror_a: 0.0,
        };
        self.display.step(step_s, &current);
    }

    /// Heat above the start in the finger, J/m2, and in the tile, J.
    fn gained(&self) -> (f64, f64) {
        let warmth = |i: usize, start_c: f64| self.display.chain.temperature_c(i) - start_c;
        let cells = self.skin.cells();
        let finger = (0..cells)
            .map(|i| self.skin.capacity_j_m2k[cells - 1 - i] * warmth(i, SKIN_C))
            .sum();
        let tile = TileParams::CLASS.capacities_j_k();
        (
            finger,
            tile.iter()
                .enumerate()
                .map(|(i, c)| c * warmth(cells + i, ROOM_C))
                .sum(),
        )
    }
}

#[test]
fn energy_closes_over_a_minute_with_two_contacts() {
    let mut bench = Bench::new();
    for k in 0..120_000 {
        let t_s = f64::from(k) * STEP_S;
        let touching = (5.0..25.0).contains(&t_s) || (35.0..55.0).contains(&t_s);
        bench.display.touch(bench.touch.filter(|_| touching));
        let volts = if t_s < 50.0 {
            2.0 * (0.7 * t_s).sin() + 0.5
        } else {
            0.0
        };
        bench.drive(STEP_S, volts);
    }
    let Energy {
        electrical_j,
        from_finger_j,
        to_room_j,
    } = bench.display.energy();
    let (finger_j_m2, tile_j) = bench.gained();
    let area_m2 = bench.touch.map_or(0.0, |t| t.area_m2);
    assert!(
        electrical_j > 50.0 && from_finger_j.abs() > 1.0,
        "{electrical_j} J, {from_finger_j} J"
    );
    let opened_j = tile_j - (electrical_j + from_finger_j - to_room_j);
    assert!(
        opened_j.abs() < 1e-10 * electrical_j,
        "tile opens by {opened_j} J of {electrical_j} J"
    );
    let opened_j = finger_j_m2 * area_m2 + from_finger_j;
    assert!(
        opened_j.abs() < 1e-10 * from_finger_j.abs(),
        "finger opens by {opened_j} J of {from_finger_j} J"
    );
}

#[test]
fn without_current_heat_only_flows_down() {
    let mut bench = Bench::new();
    bench.display.touch(bench.touch);
    let mut given_j = 0.0;
    for _ in 0..20_000 {
        bench.display.step(STEP_S, &Current::default());
        let energy = bench.display.energy();
        assert!(energy.from_finger_j > given_j && energy.electrical_j == 0.0);
        given_j = energy.from_finger_j;
        for i in 0..bench.skin.cells() + tile::NODES {
            let c = bench.display.chain.temperature_c(i);
            assert!((ROOM_C - 1e-9..=SKIN_C + 1e-9).contains(&c), "node {i} at {c}");
        }
        assert!(bench.display.skin_c() > bench.display.display_c());
    }
    for _ in 0..10 {
        bench.display.step(1e9, &Current::default());
    }
    for i in 0..bench.skin.cells() + tile::NODES {
        let c = bench.display.chain.temperature_c(i);
        assert!((c - ROOM_C).abs() < 1e-6, "node {i} at {c}");
    }
}

#[test]
fn flux_is_what_the_resistance_lets_through() {
    let mut bench = Bench::new();
    bench.display.touch(bench.touch);
    for _ in 0..200 {
        bench.drive(STEP_S, 3.0);
    }
    let fall_c = bench.display.skin_c() - bench.display.display_c();
    let resistance_m2k_w = bench.touch.map_or(f64::NAN, |t| t.resistance_m2k_w);
    assert!((bench.display.flux_w_m2() * resistance_m2k_w / fall_c - 1.0).abs() < 1e-9);
}

#[test]
fn lifted_finger_keeps_its_heat() {
    let mut bench = Bench::new();
    bench.display.touch(bench.touch);
    for _ in 0..2000 {
        bench.drive(STEP_S, 6.0);
    }
    bench.display.touch(None);
    let (before_j_m2, _) = bench.gained();
    let cooled_c = bench.display.skin_c();
    for _ in 0..20_000 {
        bench.drive(STEP_S, 6.0);
    }
    let (after_j_m2, _) = bench.gained();
    assert!((after_j_m2 / before_j_m2 - 1.0).abs() < 1e-10);
    assert!(
        bench.display.skin_c() > cooled_c + 1.0,
        "its surface warms from within"
    );
}
