//! The finger of the bound is that of the plant, and the bound is what theory says of a known finger.

use super::*;

/// A first contact of each object.
fn cases() -> Vec<PopulationCase> {
    Population::DesignedSensor.cases(1, 2).expect("cases")
}

/// The readings of the sensor in the plant, from the surface of the display there: another solver with a tile, and noise.
#[test]
fn a_finger_alone_has_the_readings_and_the_skin_of_the_plant() {
    for case in cases() {
        let scene = case.scene(Way::AsItIs).expect("a scene");
        let (outcome, _) = run_until(&scene, 0.5).expect("runs");
        let rows = outcome.trace.rows().iter();
        let rows: Vec<_> = rows.skip_while(|row| row.force_n == 0.0).collect();
        let display_c: Vec<_> = rows.iter().map(|row| row.display_c).collect();
        let touch = touch(&scene).expect("a sensor");
        let readings = touch.readings_w_m2(&display_c);
        let skin_c = touch.on_display(&display_c).skin_c;
        for ms in [10, 20, 50, 200, 499] {
            let off_k = skin_c[ms] - rows[ms].skin_c;
            assert!(off_k.abs() < 5e-3, "{}, {ms} ms: {off_k} K", case.name);
        }
        // 450 readings with a noise of 7 W/m².
        let off = readings[50..].iter().zip(&rows[51..]).map(|(own, row)| {
            let [_, reading] = row.flux_w_m2.expect("a sensor");
            reading - own
        });
        let (count, sum) = off.fold((0.0, 0.0), |(count, sum), off| (count + 1.0, sum + off));
        let largest = readings.iter().fold(0.0, |most: f64, one| most.max(one.abs()));
        let off = sum / count;
        assert!(off.abs() < 2.0 + 1e-3 * largest, "{}: {off} W/m²", case.name);
    }
}
