//! Random bit flips: bit, scene and time.

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use thermal_plant::parameters::stream_seed;
use thermal_sim::processor::MachineFault;

use super::{FlipRegion, FlippableMemory, PLACES, WITHIN_S};
use crate::faults::{FaultScene, InjectedFault, InjectionPoint};

/// Time of the control tick within the millisecond, µs. Every other flip comes then, because the core sleeps most of the time.
const TICK_US: std::ops::Range<u32> = 700..900;

/// One bit flip at one time of one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct BitFlip {
    /// Number of the flip, from 0.
    pub number: u64,
    /// Region of the bit.
    pub region: FlipRegion,
    /// The bit.
    pub fault: MachineFault,
    /// Scene and time of the flip; the time has microsecond resolution.
    pub point: InjectionPoint,
}

/// Time range of the flips in a scene, s.
pub(super) fn span(place: FaultScene) -> (f64, f64) {
    let (from_s, to_s) = place.span();
    (from_s, to_s.min(from_s + WITHIN_S))
}

impl BitFlip {
    /// Draws a flip in an image's memory; it depends only on seed and number.
    pub fn new(seed: u64, number: u64, memory: &FlippableMemory) -> Self {
        let mut draw =
            Xoshiro256PlusPlus::seed_from_u64(stream_seed(seed, &format!("flip {number}")));
        let region = FlipRegion::draw(&mut draw);
        let fault = region.bit(memory, &mut draw);
        let place = PLACES[draw.random_range(0..PLACES.len())];
        let (from_s, to_s) = span(place);
        let ms = |t_s: f64| (t_s * 1e3).round() as u32;
        let whole_ms = draw.random_range(ms(from_s)..ms(to_s));
        let us =
            if draw.random() { draw.random_range(TICK_US) } else { draw.random_range(0..1000) };
        Self {
            number,
            region,
            fault,
            point: InjectionPoint { scene: place, t_s: f64::from(whole_ms * 1000 + us) / 1e6 },
        }
    }

    pub(super) const fn injected(&self) -> InjectedFault {
        InjectedFault::Processor(self.fault)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_sim::processor::CoreRegister;
    use thermal_sim::scene::Scene;

    fn memory() -> FlippableMemory {
        FlippableMemory {
            ram: 0x2000_0000..0x2002_0000,
            statics: 0x2001_0000..0x2001_2000,
            stack: 0x2000_f000..0x2001_0000,
        }
    }

    #[test]
    fn flips_repeat_by_seed_and_number_and_differ_between_them() {
        let flip = |seed, number| BitFlip::new(seed, number, &memory());
        assert_eq!(flip(3, 17), flip(3, 17));
        assert_ne!(flip(3, 17).text(), flip(3, 18).text());
        assert_ne!(flip(3, 17).text(), flip(4, 17).text());
    }

    /// 3000 draws miss a scene with a probability below 1e-9, and their 600 core flips miss one of the 17 core registers with
    /// one below 1e-13. Registers of rarer regions are not counted.
    #[test]
    fn all_places_and_core_registers_are_drawn_within_their_regions_and_each_is_a_scene() {
        let memory = memory();
        let (mut scenes, mut core) = (Vec::new(), Vec::new());
        for number in 0..3000 {
            let flip = BitFlip::new(1, number, &memory);
            let (from_s, to_s) = span(flip.point.scene);
            assert!((from_s..to_s).contains(&flip.point.t_s), "{flip:?}");
            if !scenes.contains(&flip.point.scene) {
                scenes.push(flip.point.scene);
            }
            match (flip.region, flip.fault) {
                (FlipRegion::Statics, MachineFault::RamBit { address, .. }) => {
                    assert!(memory.statics.contains(&address));
                }
                (FlipRegion::Stack, MachineFault::RamBit { address, .. }) => {
                    assert!(memory.stack.contains(&address));
                }
                (FlipRegion::Ram, MachineFault::RamBit { .. }) => {}
                (FlipRegion::Core, MachineFault::CoreBit { register, bit }) => {
                    assert!(register.bits() >> bit & 1 != 0, "{flip:?}");
                    if !core.contains(&register) {
                        core.push(register);
                    }
                }
                (FlipRegion::Float, MachineFault::CoreBit { register, .. }) => {
                    assert!(matches!(register, CoreRegister::S(0..32) | CoreRegister::Fpscr));
                }
                (FlipRegion::Device, MachineFault::RegisterBit { .. }) => {}
                other => panic!("{other:?}"),
            }
            if number % 100 == 0 {
                let scene = Scene::parse(&flip.text(), "flip".as_ref()).expect("a scene");
                let injection = scene.injections.last().expect("an injection");
                assert_eq!((injection.fault, injection.t_s), (flip.fault, flip.point.t_s));
            }
        }
        assert_eq!((scenes.len(), core.len()), (PLACES.len(), 17));
    }
}
