//! The finger on the real object against Eq. 6-5 to 6-7 and, for changing contacts, against an integral equation.

use std::f64::consts::PI;

use contact_model::material::{MATERIALS, Material, REFERENCE_DISPLAY, SKIN, find};
use contact_model::pressure::pressure_pa;
use contact_model::reference::Contact;
use documented_figures::assert_figure;

use super::{plant, run};
use crate::bridge::BridgeOutputs;
use crate::contact::{ContactLaw, is_abrupt};
use crate::{Finger, Plant, STEP_S};

/// Rows of `tests/data/contact.csv`: material, force and numbers.
fn golden() -> impl Iterator<Item = (&'static str, [f64; 6])> {
    let rows = include_str!("../../tests/data/contact.csv")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .skip(1);
    rows.map(|line| {
        let mut fields = line.split(',');
        let material = fields.next().expect("a material");
        let numbers: Vec<f64> = fields.map(|f| f.parse().expect("a number")).collect();
        (material, numbers.try_into().expect("six numbers"))
    })
}

#[test]
fn finger_on_object_follows_the_contact_equations() {
    let mut running: Option<(&str, f64, Plant)> = None;
    let mut seen = 0;
    for (material, [force_n, resistance_m2k_w, t_s, skin_c, object_c, flux_w_m2]) in golden() {
        let same = running.take().filter(|(name, n, _)| (*name, *n) == (material, force_n));
        let (_, _, plant) = running.insert(same.unwrap_or_else(|| {
            let mut plant = plant(material);
            plant.set_force(force_n);
            (material, force_n, plant)
        }));
        let left_s = t_s - plant.time_s();
        run(plant, left_s, &BridgeOutputs::default());
        let skin_off_mk = 1e3 * (plant.skin_real_c() - skin_c).abs();
        let object_off_mk = 1e3 * (plant.object_c() - object_c).abs();
        let flux_off =
            (plant.heat.flux_w_m2(Finger::OnObject) - flux_w_m2).abs() / (10.0 / resistance_m2k_w);
        let allowed_mk = 1.0;
        let at = format!("{material} at {force_n} N after {t_s} s");
        assert!(skin_off_mk < allowed_mk, "{at}: skin off by {skin_off_mk} mK");
        assert!(object_off_mk < allowed_mk, "{at}: object off by {object_off_mk} mK");
        assert!(flux_off < 1e-4, "{at}: flux off by {flux_off} of its start");
        seen += 1;
    }
    assert_eq!(seen, 120);
}

/// Two half-spaces exchange the flux `q = D/R`, where the difference of their surfaces obeys
/// `D(t) = D0 - (1/e1 + 1/e2)/sqrt(pi) * integral of q(s)/sqrt(t - s)`: solved with `q` linear between nodes that are
/// dense after each change of contact. The method is independent of the mesh and the steps of the plant.
struct Volterra {
    /// Start and end of each interval, and the flux at both.
    pieces: Vec<(f64, f64, f64, f64)>,
}

impl Volterra {
    /// Integral of the flux so far over `sqrt(t - s)`.
    fn memory(&self, t: f64) -> f64 {
        self.pieces
            .iter()
            .map(|&(a, b, qa, qb)| {
                let (start, end) = Self::weights(a, b, t);
                qa * start + qb * end
            })
            .sum()
    }

    /// Weights of a linear flux's values at `a` and `b`.
    fn weights(a: f64, b: f64, t: f64) -> (f64, f64) {
        let (far, near) = ((t - a).sqrt(), (t - b).max(0.0).sqrt());
        let whole = 2.0 * (far - near);
        let end = ((t - a) * whole - 2.0 / 3.0 * (far.powi(3) - near.powi(3))) / (b - a);
        (whole - end, end)
    }

    /// Continues to `to_s` by `nodes` pieces at a constant resistance, or without contact, from an initial difference of
    /// 10 K.
    fn advance(&mut self, to_s: f64, resistance: Option<f64>, nodes: u32, kappa: f64) {
        let from_s = self.pieces.last().map_or(0.0, |p| p.1);
        let mut a = from_s;
        let gap = |memory: f64| 10.0 - kappa * memory;
        let mut flux = resistance.map_or(0.0, |r| gap(self.memory(a)) / r);
        for k in 1..=nodes {
            let b = from_s + (to_s - from_s) * (f64::from(k) / f64::from(nodes)).powi(3);
            let next = resistance.map_or(0.0, |r| {
                let (start, end) = Self::weights(a, b, b);
                gap(self.memory(b) + flux * start) / (r + kappa * end)
            });
            self.pieces.push((a, b, flux, next));
            (a, flux) = (b, next);
        }
    }
}

#[test]
fn force_steps_lifting_and_landing_again_follow_the_integral_equation() {
    // From each time on, s, a force, N.
    let script = [(0.0, 0.5), (0.4, 2.0), (1.2, 0.1), (1.6, 0.0), (2.1, 2.0), (3.0, 0.0)];
    let mut worst_mk = 0.0f64;
    for material in ["copper", "granite", "abs", "foam"] {
        let object: &Material = find(material).expect("known");
        let per_skin = 1.0 / (SKIN.effusivity() * PI.sqrt());
        let kappa = per_skin + 1.0 / (object.effusivity() * PI.sqrt());
        let mut exact = Volterra { pieces: Vec::new() };
        let mut plant = plant(material);
        for span in script.windows(2) {
            let ((from_s, force_n), (to_s, _)) = (span[0], span[1]);
            let touch = ContactLaw::NOMINAL.at_force(force_n, &SKIN.surface, &object.surface);
            plant.set_force(force_n);
            for after_s in [0.02, 0.05, 0.2, to_s - from_s] {
                let t_s = from_s + after_s;
                let left_s = t_s - plant.time_s();
                run(&mut plant, left_s, &BridgeOutputs::default());
                let mut to_here = Volterra { pieces: exact.pieces.clone() };
                to_here.advance(t_s, touch.map(|t| t.resistance_m2k_w), 250, kappa);
                let skin_c = 34.0 - per_skin * to_here.memory(t_s);
                let off_mk = 1e3 * (plant.skin_real_c() - skin_c).abs();
                worst_mk = worst_mk.max(off_mk);
            }
            exact.advance(to_s, touch.map(|t| t.resistance_m2k_w), 250, kappa);
        }
        assert!((plant.time_s() - 3.0).abs() < STEP_S / 2.0);
    }
    assert_figure("truth.force_steps", worst_mk);
}

#[test]
fn slow_force_ramp_needs_no_sub_steps() {
    let object: &Material = find("copper").expect("known");
    let touch = |force_n| ContactLaw::NOMINAL.at_force(force_n, &SKIN.surface, &object.surface);
    let per_skin = 1.0 / (SKIN.effusivity() * PI.sqrt());
    let kappa = per_skin + 1.0 / (object.effusivity() * PI.sqrt());
    let mut exact = Volterra { pieces: Vec::new() };
    let mut plant = plant("copper");
    // Half a second at 1 N, then 50 steps of 2 % each.
    plant.set_force(1.0);
    run(&mut plant, 0.5, &BridgeOutputs::default());
    exact.advance(0.5, touch(1.0).map(|t| t.resistance_m2k_w), 250, kappa);
    for k in 1..=50 {
        let force_n = 1.0 + 0.02 * f64::from(k);
        assert!(!is_abrupt(touch(force_n - 0.02), touch(force_n)));
        plant.set_force(force_n);
        plant.step(&BridgeOutputs::default());
        let t_s = plant.time_s();
        exact.advance(t_s, touch(force_n).map(|t| t.resistance_m2k_w), 10, kappa);
        let off_mk = 1e3 * (plant.skin_real_c() - (34.0 - per_skin * exact.memory(t_s))).abs();
        assert!(off_mk < 1.0, "at {force_n} N: off by {off_mk} mK");
    }
}

#[test]
fn first_steps_after_landing_are_resolved() {
    for material in ["copper", "granite", "abs", "foam"] {
        let object = find(material).expect("known");
        for force_n in [0.1, 0.5, 2.0] {
            let exact = Contact::new(
                (&SKIN, 34.0),
                (object, 24.0),
                &REFERENCE_DISPLAY,
                pressure_pa(force_n),
            );
            let mut plant = plant(material);
            plant.set_force(force_n);
            for k in 1..=40 {
                plant.step(&BridgeOutputs::default());
                let want = exact.at(f64::from(k) * STEP_S);
                let skin_off_mk = 1e3 * (plant.skin_real_c() - want.skin_c).abs();
                let object_off_mk = 1e3 * (plant.object_c() - want.object_c).abs();
                let off_mk = skin_off_mk.max(object_off_mk);
                assert!(off_mk < 1.0, "{material} at {force_n} N, step {k}: off by {off_mk} mK");
            }
        }
    }
}

/// All materials, five forces, every step of 60 s.
#[test]
fn every_material_at_every_force_follows_equations_6_5_to_6_7() {
    let mut worst = [[0.0f64; 3]; 2];
    for (name, material) in MATERIALS {
        for force_n in [0.1, 0.25, 0.5, 1.0, 2.0] {
            let (finger, object) = ((&SKIN, 34.0), (&material, 24.0));
            let exact = Contact::new(finger, object, &REFERENCE_DISPLAY, pressure_pa(force_n));
            let first_w_m2 = exact.at(0.0).flux_w_m2;
            let mut plant = plant(name);
            plant.set_force(force_n);
            for k in 1..=60_000u32 {
                plant.step(&BridgeOutputs::default());
                let want = exact.at(f64::from(k) * STEP_S);
                let off = [
                    1e3 * (plant.skin_real_c() - want.skin_c),
                    1e3 * (plant.object_c() - want.object_c),
                    (plant.heat.flux_w_m2(Finger::OnObject) - want.flux_w_m2) / first_w_m2,
                ];
                let early = usize::from(k < 20);
                for (worst, off) in worst[early].iter_mut().zip(off) {
                    *worst = worst.max(off.abs());
                }
            }
        }
    }
    let keys = ["truth.skin", "truth.object", "truth.flux"];
    let early = ["truth.skin_before", "truth.object_before", "truth.flux_before"];
    for (key, worst) in keys.into_iter().chain(early).zip(worst.concat()) {
        assert_figure(key, worst);
    }
}
