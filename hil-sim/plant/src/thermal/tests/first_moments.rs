//! In the first milliseconds of a contact the display plate is a half-space of ceramic: Eq. 6-5 and 6-6.

use documented_figures::assert_figure;

use super::*;

#[test]
fn display_plate_follows_a_ceramic_half_space_after_contact() {
    let tile = TileParams {
        patch_m2: contact_model::pressure::contact_area_m2(2.0),
        ..TileParams::NOMINAL
    };
    let mut bench =
        Bench::new(&FingerParams::homogeneous(), &ObjectConfig::half_space(SKIN, ROOM_C), tile);
    let touch =
        ContactLaw::NOMINAL.at_force(2.0, &SKIN.surface, &REFERENCE_DISPLAY).expect("pressed");
    let exact = |t_s: f64| {
        let (finger, plate) = (SKIN.effusivity(), (tile.ceramic_w_mk * tile.ceramic_j_m3k).sqrt());
        let z = (1.0 / finger + 1.0 / plate) / touch.resistance_m2k_w * t_s.sqrt();
        let made = 1.0 - contact_model::reference::erfcx(z);
        let w = plate / (plate + finger);
        (SKIN_C - 10.0 * w * made, ROOM_C + 10.0 * (1.0 - w) * made)
    };
    bench.touch(Some(touch), None);
    let (mut skin_mk, mut plate_mk) = (0.0f64, 0.0f64);
    for k in 1..=10 {
        bench.step(None);
        // Until heat reaches the back of the plate, 0.8 mm away.
        let (skin_c, plate_c) = exact(f64::from(k) * STEP_S);
        let skin_off_mk = 1e3 * (bench.heat.skin_c(Finger::OnDisplay) - skin_c);
        let plate_off_mk = 1e3 * (bench.heat.display_c() - plate_c);
        skin_mk = skin_mk.max(skin_off_mk.abs());
        plate_mk = plate_mk.max(plate_off_mk.abs());
    }
    assert_figure("truth.first_skin", skin_mk);
    assert_figure("truth.first_display", plate_mk);
}
