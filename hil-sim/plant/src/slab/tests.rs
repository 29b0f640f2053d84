//! Single slabs against closed-form solutions.

use std::f64::consts::PI;

use contact_model::material::SKIN;
use documented_figures::assert_figure;

use super::*;

const TISSUE: Medium = Medium {
    conductivity_w_mk: 0.37,
    capacity_j_m3k: 3.6e6,
    perfusion_w_m3k: 20e3,
    metabolism_w_m3: 1000.0,
};

fn layer(thickness_m: f64, medium: Medium) -> Layer {
    Layer { thickness_m, medium }
}

/// Isothermal core at the deepest face.
const CORE: BackBoundary = BackBoundary::Film { film_w_m2k: f64::INFINITY, temperature_c: 0.0 };

/// One slab whose surface is held at a temperature, or insulated.
struct HeldSlab {
    slab: SlabBatch<1>,
    surface_w_m2k: f64,
    surface_c: f64,
}

impl HeldSlab {
    fn step(&mut self, index: usize) {
        let flux = self.surface_w_m2k * (self.surface_c - self.slab.surface_c(0));
        let close = |row: SurfaceEquation, u: f64| [row.rhs / (row.pivot + u)];
        let [row] = self.slab.first_stage(index, [flux]);
        let [row] = self.slab.second_stage(index, close(row, self.surface_w_m2k));
        self.slab.finish_step(index, close(row, self.surface_w_m2k));
    }
}

#[test]
fn temperature_step_of_a_half_space_follows_the_error_function() {
    let slab = Slab::new(
        &[layer(f64::INFINITY, Medium::without_blood(&SKIN))],
        BackBoundary::Insulated,
        10.0,
        &Grading::STANDARD,
    );
    let step_s = 1e-3;
    let lengths_s: Vec<f64> = (0..13).map(|k| step_s / f64::from(1 << k)).collect();
    let mut held = HeldSlab {
        slab: SlabBatch::new([&slab], [34.0], &lengths_s),
        surface_w_m2k: 1.0 / slab.surface_m2k_w,
        surface_c: 24.0,
    };
    // One step in sub-steps that double, two of each length.
    held.step(11);
    (0..11).rev().for_each(|k| {
        held.step(k + 2);
        held.step(k + 2);
    });
    let mut t_s = step_s;
    for k in 0..10_000 {
        for (at_s, allowed) in [(0.02, 2e-3), (0.2, 2e-4), (2.0, 1e-4), (9.0, 1e-4)] {
            if (t_s - at_s).abs() < 0.5 * step_s {
                let flux = held.surface_w_m2k * (held.slab.surface_c(0) - held.surface_c);
                let exact = SKIN.effusivity() * 10.0 / (PI * t_s).sqrt();
                assert!(
                    (flux / exact - 1.0).abs() < allowed,
                    "flux {flux} is not {exact} after {t_s} s"
                );
                for node in 0..slab.cells() {
                    let z = slab.depth_m[node] / (2.0 * (SKIN.diffusivity_m2_s() * t_s).sqrt());
                    let exact_c = 24.0 + 10.0 * libm::erf(z);
                    // At the end of the run the insulated back is at z = 2.1.
                    if z > 1.0 {
                        break;
                    }
                    let off_c = held.slab.node_c(0, node) - exact_c;
                    assert!(off_c.abs() < 6e-3, "off by {off_c} at z = {z} after {t_s} s");
                }
            }
        }
        held.step(if k < 8 { 1 } else { 0 });
        t_s += if k < 8 { 0.5 * step_s } else { step_s };
    }
}

#[test]
fn layers_in_steady_state_conduct_as_resistances_in_series() {
    let layers = [(0.65e-3, 0.21), (1.2e-3, 0.37), (4e-3, 0.16)];
    let dead =
        |k| Medium { conductivity_w_mk: k, perfusion_w_m3k: 0.0, metabolism_w_m3: 0.0, ..TISSUE };
    let film_w_m2k = 50.0;
    let slab = Slab::new(
        &layers.map(|(l, k)| layer(l, dead(k))),
        BackBoundary::Film { film_w_m2k, temperature_c: 0.0 },
        60.0,
        &Grading::STANDARD,
    );
    let loss_w_m2 = 120.0;
    let steady = steady_state(&slab, 34.0, loss_w_m2).expect("a core");
    let resistance: f64 = layers.iter().map(|(l, k)| l / k).sum::<f64>() + 1.0 / film_w_m2k;
    let core_c = 34.0 + loss_w_m2 * resistance;
    assert!((steady.core_c - core_c).abs() < 1e-11, "{} is not {core_c}", steady.core_c);
    // At every node too.
    for (node, t) in steady.node_c.iter().enumerate() {
        let (mut above, mut left) = (0.0, slab.depth_m[node]);
        for (l, k) in layers {
            above += left.min(l) / k;
            left = (left - l).max(0.0);
        }
        assert!((t - (34.0 + loss_w_m2 * above)).abs() < 1e-11, "node {node}");
    }
}

#[test]
fn steady_state_with_blood_and_metabolism_follows_the_hyperbolic_solution() {
    let (thickness_m, surface_c, loss_w_m2) = (8e-3, 33.0, 90.0);
    let m = (TISSUE.perfusion_w_m3k / TISSUE.conductivity_w_mk).sqrt();
    let warmth_c = TISSUE.metabolism_w_m3 / TISSUE.perfusion_w_m3k;
    // Above the core: -loss sinh(m (L - x))/(k m cosh(m L)) + warmth (1 - cosh(m x)/cosh(m L)).
    let above_c = |x: f64| {
        let cosh = (m * thickness_m).cosh();
        warmth_c * (1.0 - (m * x).cosh() / cosh)
            - loss_w_m2 * (m * (thickness_m - x)).sinh() / (TISSUE.conductivity_w_mk * m * cosh)
    };
    let mut last_c = f64::INFINITY;
    for (growth, name) in [(1.2, "coarse"), (1.0954, "middle"), (1.0466, "fine")] {
        let grading = Grading { growth, ..Grading::STANDARD };
        let slab = Slab::new(&[layer(thickness_m, TISSUE)], CORE, 60.0, &grading);
        let steady = steady_state(&slab, surface_c, loss_w_m2).expect("a core");
        let core_c = surface_c - above_c(0.0);
        let mut worst_c = (steady.core_c - core_c).abs();
        for (x, t) in slab.depth_m.iter().zip(&steady.node_c) {
            worst_c = worst_c.max((t - core_c - above_c(*x)).abs());
        }
        assert_figure(&format!("plant.blood_at_rest_{name}"), 1e3 * worst_c);
        assert!(worst_c < last_c / 3.0, "{growth}: {worst_c}");
        last_c = worst_c;

        // The steady state does not drift.
        let mut held = HeldSlab {
            slab: SlabBatch::new([&slab], [0.0], &[10.0]),
            surface_w_m2k: 0.0,
            surface_c,
        };
        held.slab.set_core_c(0, steady.core_c);
        for (node, t) in steady.node_c.iter().enumerate() {
            held.slab.set_node_c(0, node, *t);
        }
        for _ in 0..10 {
            let [row] = held.slab.first_stage(0, [-loss_w_m2]);
            let [row] = held.slab.second_stage(0, [row.rhs / row.pivot]);
            held.slab.finish_step(0, [row.rhs / row.pivot]);
        }
        for (node, t) in steady.node_c.iter().enumerate() {
            assert!((held.slab.node_c(0, node) - t).abs() < 1e-9, "node {node} drifts");
        }
    }
}

#[test]
fn slab_without_heat_source_has_only_the_uniform_steady_state() {
    let dead = [layer(f64::INFINITY, Medium::without_blood(&SKIN))];
    let slab = Slab::new(&dead, BackBoundary::Insulated, 60.0, &Grading::STANDARD);
    assert_eq!(steady_state(&slab, 34.0, 1.0), None);
    let even = steady_state(&slab, 34.0, 0.0).expect("even");
    assert!(even.core_c == 34.0 && even.node_c.iter().all(|t| *t == 34.0));
}

/// Eigenmode of layered tissue with blood: `exp(-rate t) cos(pi r/R)` relative to the blood, with the thermal resistance
/// `r` from the surface and `R` of all layers. It solves Pennes' equation if every layer has
/// `perfusion = c rate - (pi/R)^2/k`.
struct Mode {
    layers: Vec<Layer>,
    rate: f64,
    total_m2k_w: f64,
}

/// A mesh whose cells, and their subdivisions, fill the layers of [`Mode`] exactly.
const COARSE: Grading = Grading { first: 0.0103, growth: 1.078, depth: 4.0 };
/// Number of cells in each layer.
const CELLS: [i32; 3] = [32, 20, 16];

impl Mode {
    fn new() -> Self {
        // Conductivity and volumetric heat capacity; thickness in diffusion lengths, the coordinate of the mesh.
        let reached =
            |cells: i32| COARSE.first * (COARSE.growth.powi(cells) - 1.0) / (COARSE.growth - 1.0);
        let mut above = 0;
        let tissue = [(0.21, 4.0e6), (0.37, 3.6e6), (0.16, 2.2e6)];
        let tissue: [(f64, f64, f64); 3] = std::array::from_fn(|i| {
            let (k, c): (f64, f64) = tissue[i];
            let thickness = reached(above + CELLS[i]) - reached(above);
            above += CELLS[i];
            (thickness * (k / c).sqrt(), k, c)
        });
        let total_m2k_w: f64 = tissue.iter().map(|(l, k, _)| l / k).sum();
        let wave = (PI / total_m2k_w).powi(2);
        let rate = 1.2 * tissue.iter().map(|(_, k, c)| wave / (k * c)).fold(0.0, f64::max);
        let layers = tissue.map(|(thickness_m, k, c)| {
            let medium = Medium {
                conductivity_w_mk: k,
                capacity_j_m3k: c,
                perfusion_w_m3k: c * rate - wave / k,
                metabolism_w_m3: 0.0,
            };
            layer(thickness_m, medium)
        });
        Self { layers: layers.to_vec(), rate, total_m2k_w }
    }

    fn shape(&self, depth_m: f64) -> f64 {
        let (mut above, mut left) = (0.0, depth_m);
        for Layer { thickness_m, medium } in &self.layers {
            above += left.min(*thickness_m) / medium.conductivity_w_mk;
            left = (left - thickness_m).max(0.0);
        }
        (PI * above / self.total_m2k_w).cos()
    }

    /// Number of cells and largest error of a node after one time constant, for a mesh and a number of steps.
    fn error(&self, grading: &Grading, steps: u32) -> (usize, f64) {
        let slab = Slab::new(&self.layers, BackBoundary::Insulated, 60.0, grading);
        let step_s = 1.0 / (self.rate * f64::from(steps));
        let mut batch = SlabBatch::new([&slab], [0.0], &[step_s]);
        for (node, depth_m) in slab.depth_m.iter().enumerate() {
            batch.set_node_c(0, node, self.shape(*depth_m));
        }
        for _ in 0..steps {
            let [row] = batch.first_stage(0, [0.0]);
            let [row] = batch.second_stage(0, [row.rhs / row.pivot]);
            batch.finish_step(0, [row.rhs / row.pivot]);
        }
        let decayed = (-1.0f64).exp();
        let off = slab.depth_m.iter().enumerate();
        let worst = off.map(|(node, x)| (batch.node_c(0, node) - decayed * self.shape(*x)).abs());
        (slab.cells(), worst.fold(0.0, f64::max))
    }
}

#[test]
fn space_converges_at_second_order_across_layers() {
    let mode = Mode::new();
    // Each cell is divided in two: the growth factor becomes its square root.
    let mut grading = COARSE;
    let (mut cells, mut error) = mode.error(&grading, 1000);
    assert_eq!(cells, CELLS.iter().sum::<i32>() as usize);
    let mut least = f64::INFINITY;
    for _ in 0..3 {
        let growth = grading.growth.sqrt();
        grading = Grading { first: grading.first / (1.0 + growth), growth, ..grading };
        let (finer, less) = mode.error(&grading, 1000);
        assert_eq!(finer, 2 * cells);
        let order = f64::log2(error / less);
        println!("{cells} to {finer} cells: {error:.2e} to {less:.2e}, order {order:.3}");
        assert!((order - 2.0).abs() < 0.1, "order {order} from {cells} to {finer} cells");
        least = least.min(order);
        (cells, error) = (finer, less);
    }
    assert_figure("plant.order_in_space", least);
}

#[test]
fn time_converges_at_second_order() {
    let mode = Mode::new();
    let fine = Grading { first: 0.002, growth: 1.01, depth: 4.0 };
    let (mut last, mut least) = (None, f64::INFINITY);
    for steps in [4, 8, 16, 32] {
        let (_, error) = mode.error(&fine, steps);
        if let Some(before) = last {
            let order = f64::log2(before / error);
            println!("{steps} steps: {error:.2e}, order {order:.3}");
            assert!((order - 2.0).abs() < 0.1, "order {order} at {steps} steps");
            least = least.min(order);
        }
        last = Some(error);
    }
    assert_figure("plant.order_in_time", least);
}
