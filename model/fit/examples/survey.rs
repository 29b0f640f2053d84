use contact_model::material::{MATERIALS, SKIN};
use relaxation_fit::*;
fn main() {
    let depths = [
        0.5e-3,
        1e-3,
        2e-3,
        3e-3,
        5e-3,
        10e-3,
        20e-3,
        50e-3,
        f64::INFINITY,
    ];
    let mut worst = 0.0f64;
    let mut most = 0;
    let t0 = std::time::Instant::now();
    let mut n = 0;
    for (name, m) in MATERIALS {
        for d in depths {
            for (bn, back) in [
                ("ins", Back::Insulated),
                ("held", Back::Film(f64::INFINITY)),
                ("film", Back::Film(10.0)),
            ] {
                if d.is_infinite() && bn != "ins" {
                    continue;
                }
                let layers = [Layer {
                    thickness_m: d,
                    conductivity_w_mk: m.surface.conductivity_w_mk,
                    capacity_j_m3k: m.volumetric_heat_j_m3k(),
                    perfusion_w_m3k: 0.0,
                }];
                let z = |s: f64| impedance(&layers, back, s);
                let es = SKIN.effusivity();
                let ro = contact_model::reference::contact_resistance(
                    &SKIN.surface,
                    &m.surface,
                    contact_model::pressure::pressure_pa(2.0),
                );
                let f = fit(
                    z,
                    |s, z| {
                        let zf = 1.0 / (es * s.sqrt());
                        zf / (zf + ro + z).powi(2)
                    },
                    14,
                );
                // time-domain error of the skin for 10 K: by W * Z error is in K per ... report weighted error x 10 K
                worst = worst.max(f.weighted_error * 10.0);
                most = most.max(f.relaxations.len());
                n += 1;
                let fast = f.relaxations.iter().filter(|r| r.rate_1_s > 12.5).count();
                println!(
                    "{name} {:.1} mm {bn}: {} ({} fast) error {:.3} mK direct {:.2e}",
                    d * 1e3,
                    f.relaxations.len(),
                    fast,
                    1e4 * f.weighted_error,
                    f.direct_m2k_w
                );
            }
        }
    }
    println!(
        "{n} worst {} mK most {most} {:?}",
        worst * 1e3,
        t0.elapsed()
    );
}
