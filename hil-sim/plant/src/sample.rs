//! A finger on a sample of a real material, without display and electronics: what a participant touches beside the display,
//! or in place of it.

use contact_model::material::Surface;

use super::config::{self, ConfigError, PlantConfig};
use super::contact::{self, ContactLaw, SkinContact};
use super::finger::Vessels;
use super::slab::{DepthProbe, Grading, Slab, SlabBatch, SurfaceEquation, steady_state};
use super::{RECEPTORS_M, STEP_S, substeps};

/// Number of slabs: finger and sample.
const SLABS: usize = 2;
const FINGER: usize = 0;
const SAMPLE: usize = 1;

/// A finger that lands on a sample, presses on it with a varying force, and lifts, any number of times.
///
/// It solves the same equations on the same mesh and with the same steps as the finger on the real object of a
/// [`Plant`](super::Plant), so both give the same temperatures.
#[derive(Clone, Debug)]
pub struct SampleTouch {
    slabs: SlabBatch<SLABS>,
    skin: Surface,
    sample: Surface,
    contact_law: ContactLaw,
    resistance_factor: f64,
    vessels: Option<Vessels>,
    receptors: [Option<DepthProbe>; RECEPTORS_M.len()],
    room_c: f64,
    /// Resistance from each slab's surface to its first node, m2 K/W.
    surface_m2k_w: [f64; SLABS],
    /// Conductance from that node to the air at a surface without contact, W/(m2 K).
    lifted_w_m2k: [f64; SLABS],
    force_n: f64,
    /// Force, N, for which the contact was last updated.
    updated_for_n: f64,
    contact: Option<SkinContact>,
    /// Conductance between the nodes next to the contact, W/(m2 K); zero without contact.
    contact_w_m2k: f64,
    /// Number of steps since the last abrupt change of contact.
    steps_since_change: u32,
    steps: u64,
}

impl SampleTouch {
    /// The finger and the object of a plant, the finger in steady state without contact. The object is present from the start.
    ///
    /// # Errors
    /// If the configuration does not pass its [check](PlantConfig::check).
    pub fn new(config: &PlantConfig) -> Result<Self, ConfigError> {
        config.check()?;
        let params = &config.params.finger;
        let mesh = |layers: &[_], back| {
            Slab::new(layers, back, config.duration_s - config.start_s, &Grading::STANDARD)
        };
        let finger = mesh(&params.layers, params.back());
        let sample = mesh(&config.object.layers, config.object.back);
        let loss_w_m2 = params.air_w_m2k * (config.skin_c - config.room_c);
        let steady = steady_state(&finger, config.skin_c, loss_w_m2)
            .ok_or_else(|| ConfigError::cold_finger(params.air_w_m2k))?;
        config::check_core(steady.core_c)?;
        let lengths_s: [f64; substeps::LENGTHS] =
            std::array::from_fn(|index| substeps::length_s(STEP_S, index));
        let start_c = [config.skin_c, config.object.start_c];
        let mut slabs = SlabBatch::new([&finger, &sample], start_c, &lengths_s);
        for (node, temperature_c) in steady.node_c.iter().enumerate() {
            slabs.set_node_c(FINGER, node, *temperature_c);
        }
        slabs.set_core_c(FINGER, steady.core_c);
        let surface_m2k_w = [finger.surface_m2k_w, sample.surface_m2k_w];
        Ok(Self {
            slabs,
            skin: params.surface,
            sample: config.object.surface,
            contact_law: config.params.contact,
            resistance_factor: params.resistance_factor,
            vessels: params.vessels,
            receptors: RECEPTORS_M.map(|depth_m| DepthProbe::at(&finger, depth_m)),
            room_c: config.room_c,
            surface_m2k_w,
            lifted_w_m2k: surface_m2k_w.map(|m2k_w| 1.0 / (m2k_w + 1.0 / params.air_w_m2k)),
            force_n: 0.0,
            updated_for_n: 0.0,
            contact: None,
            contact_w_m2k: 0.0,
            steps_since_change: u32::MAX,
            steps: 0,
        })
    }

    /// Sets the force of the finger, N, from the next step on; zero and negative forces lift it.
    pub fn set_force(&mut self, force_n: f64) {
        self.force_n = force_n.max(0.0);
    }

    /// Advances by [`STEP_S`] under a constant force.
    pub fn step(&mut self) {
        self.update_contact();
        for index in substeps::of_step(self.steps_since_change) {
            self.sub_step(index);
        }
        self.steps += 1;
        self.steps_since_change = self.steps_since_change.saturating_add(1);
    }

    fn update_contact(&mut self) {
        if self.force_n == self.updated_for_n {
            return;
        }
        self.updated_for_n = self.force_n;
        let contact =
            self.contact_law.at_force(self.force_n, &self.skin, &self.sample).map(|contact| {
                SkinContact {
                    resistance_m2k_w: self.resistance_factor * contact.resistance_m2k_w,
                    ..contact
                }
            });
        if contact::is_abrupt(self.contact, contact) {
            self.steps_since_change = 0;
        }
        let [finger, sample] = self.surface_m2k_w;
        self.contact_w_m2k =
            contact.map_or(0.0, |touch| 1.0 / (finger + touch.resistance_m2k_w + sample));
        self.contact = contact;
        if let Some(vessels) = &self.vessels {
            self.slabs.set_flow(FINGER, vessels.flow(self.force_n));
        }
    }

    /// Conductance to the air at each surface: none in contact.
    fn air_w_m2k(&self) -> [f64; SLABS] {
        match self.contact {
            Some(_) => [0.0; SLABS],
            None => self.lifted_w_m2k,
        }
    }

    fn sub_step(&mut self, index: usize) {
        let air_w_m2k = self.air_w_m2k();
        let into_sample_w_m2 = self.flux_w_m2();
        let into = [-into_sample_w_m2, into_sample_w_m2];
        let inflow: [f64; SLABS] = std::array::from_fn(|slab| {
            into[slab] - air_w_m2k[slab] * (self.slabs.surface_c(slab) - self.room_c)
        });
        let equations = self.slabs.first_stage(index, inflow);
        let equations = self.slabs.second_stage(index, self.increments(equations, air_w_m2k));
        self.slabs.finish_step(index, self.increments(equations, air_w_m2k));
    }

    /// Increments of both surface cells, which the contact couples.
    fn increments(
        &self,
        [finger, sample]: [SurfaceEquation; SLABS],
        [of_finger, of_sample]: [f64; SLABS],
    ) -> [f64; SLABS] {
        let (a, b) = (finger.pivot + of_finger, sample.pivot + of_sample);
        let u = self.contact_w_m2k;
        // Cramer's rule; all terms are positive, so nothing cancels.
        let determinant = a * b + u * (a + b);
        let shared = u * (finger.rhs + sample.rhs);
        [(finger.rhs * b + shared) / determinant, (sample.rhs * a + shared) / determinant]
    }

    /// Simulated time since the start, s.
    pub fn time_s(&self) -> f64 {
        self.steps as f64 * STEP_S
    }

    /// Heat flux out of the skin into the sample, W/m2.
    pub fn flux_w_m2(&self) -> f64 {
        self.contact_w_m2k * (self.slabs.surface_c(FINGER) - self.slabs.surface_c(SAMPLE))
    }

    /// Surface temperature of the skin, deg C.
    pub fn skin_c(&self) -> f64 {
        self.surface_c(FINGER)
    }

    /// Surface temperature of the sample, deg C.
    pub fn sample_c(&self) -> f64 {
        self.surface_c(SAMPLE)
    }

    fn surface_c(&self, slab: usize) -> f64 {
        let node_c = self.slabs.surface_c(slab);
        let sign = if slab == FINGER { 1.0 } else { -1.0 };
        let outward_w_m2 =
            sign * self.flux_w_m2() + self.air_w_m2k()[slab] * (node_c - self.room_c);
        node_c - outward_w_m2 * self.surface_m2k_w[slab]
    }

    /// Skin temperature at the depth of the cold and warm receptors ([`RECEPTORS_M`]), deg C; none if the finger is
    /// thinner.
    pub fn receptors_c(&self) -> [Option<f64>; RECEPTORS_M.len()] {
        self.receptors
            .map(|probe| probe.map(|probe| probe.read(|node| self.slabs.node_c(FINGER, node))))
    }
}

#[cfg(test)]
mod tests;
