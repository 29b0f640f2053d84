//! Errors of the set-points against Eq. 6-12 and 3-1 in double precision.
use contact_model::material::{MATERIALS, Material, REFERENCE_DISPLAY, SKIN};
use contact_model::pressure::pressure_pa;
use contact_model::reference::{Contact, interface_temperature};
use model_bench::job::Checksum;
use model_bench::scenes::{
    FINGERS, FORCE_N, OBJECT_C, SKIN_C, Scene, Station, TICK_S, TICKS, kind, streaming_n,
};

/// Results of a scene on this host.
pub struct Judgement {
    /// Largest error, mK, of the set-points that are numbers.
    pub worst_mk: f64,
    /// Time of the first set-point that is not a number, s.
    pub breaks_at_s: Option<f64>,
    /// Checksum of the set-points as `f64`.
    pub checksum: Checksum,
}

/// Runs all ticks of a scene.
///
/// # Errors
/// None for these materials.
pub fn judge(scene: &Scene) -> anyhow::Result<Judgement> {
    let mut station = Station::new()?;
    let mut judgement =
        Judgement { worst_mk: 0.0, breaks_at_s: None, checksum: Checksum::default() };
    for tick in 1..=TICKS {
        let bits = (scene.step)(&mut station, tick);
        let found = station.set_point_c(scene.arithmetic, bits);
        judgement.checksum.add(found.to_bits());
        if found.is_finite() {
            let error_mk = (found - exact_c(scene.kind, tick)).abs() * 1e3;
            judgement.worst_mk = judgement.worst_mk.max(error_mk);
        } else {
            judgement.breaks_at_s.get_or_insert(f64::from(tick) * TICK_S);
        }
    }
    Ok(judgement)
}

/// Set-point of the first finger, °C.
fn exact_c(kind: &str, tick: u32) -> f64 {
    let object: &Material = &MATERIALS[FINGERS[0]].1;
    let display_c = |force_n: f64, tick: u32| {
        Contact::new((&SKIN, SKIN_C), (object, OBJECT_C), &REFERENCE_DISPLAY, pressure_pa(force_n))
            .at(f64::from(tick) * TICK_S)
            .display_c
    };
    match kind {
        kind::SEMI_INFINITE => interface_temperature(&SKIN, SKIN_C, object, OBJECT_C),
        kind::IDLE => display_c(FORCE_N, 0),
        kind::STREAMING | kind::REFERENCE_STREAMING => display_c(streaming_n(tick), tick),
        _ => display_c(FORCE_N, tick),
    }
}
