//! Edges at the trigger input of a scene.

use std::ops::Range;

use thermal_sim::scene::Scene;
use thermal_sim::trigger_edges::trigger_edges_us;

fn edges(tables: &str, range_us: Range<i64>) -> Vec<i64> {
    let text = format!(
        "duration_s = 9\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"copper\"\n\
         [[trigger]]\nt_s = 1.5\n[[trigger]]\nt_s = 1.0000004\n{tables}"
    );
    let scene = Scene::parse(&text, "edges".as_ref()).expect("a scene");
    trigger_edges_us(&scene, &range_us)
}

#[test]
fn a_sound_input_has_the_edges_of_the_scene_to_a_microsecond() {
    assert_eq!(edges("", 0..2_000_000), [1_000_000, 1_500_000]);
    assert!(edges("", 1_000_001..1_500_000).is_empty());
}

#[test]
fn a_stuck_input_has_one_edge_if_it_is_high_and_none_if_it_is_low() {
    let stuck = |level| {
        format!("[[fault]]\nkind = \"trigger-stuck\"\nt_s = 1.2\nvalue = {level}\nuntil_s = 3\n")
    };
    assert_eq!(edges(&stuck(0), 0..2_000_000), [1_000_000]);
    assert_eq!(edges(&stuck(1), 0..2_000_000), [1_000_000, 1_200_000]);
}

#[test]
fn a_chattering_input_has_edges_at_its_rate_in_each_part_of_its_time() {
    let table = "[[fault]]\nkind = \"trigger-chatter\"\nt_s = 2\nvalue = 3000\nuntil_s = 4\n";
    let whole = edges(table, 1_900_000..5_000_000);
    assert_eq!(whole.len(), 6000);
    assert_eq!(whole[..4], [2_000_000, 2_000_333, 2_000_667, 2_001_000]);
    let parts = (1_900_000..5_000_000).step_by(500);
    let parts: Vec<_> = parts.flat_map(|us| edges(table, us..us + 500)).collect();
    assert_eq!(parts, whole);
}
