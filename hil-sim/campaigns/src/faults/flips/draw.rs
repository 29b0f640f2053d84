//! Which bit, where and when.

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use thermal_plant::parameters::stream_seed;
use thermal_sim::processor::MachineFault;

use super::{Memory, PLACES, Region, WITHIN_S};
use crate::faults::{Injected, Moment, Place};

/// When the control tick runs, µs of the millisecond: every other flip comes then, else the core would sleep in most.
const TICK_US: std::ops::Range<u32> = 700..900;

/// One flip at one moment of one place.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    /// Its number, from 0.
    pub number: u64,
    /// Where the bit is.
    pub region: Region,
    /// The bit.
    pub fault: MachineFault,
    /// Where and when, to the microsecond.
    pub moment: Moment,
}

/// From when to when flips come in a place, s.
pub(super) fn span(place: Place) -> (f64, f64) {
    let (from_s, to_s) = place.span();
    (from_s, to_s.min(from_s + WITHIN_S))
}

impl Flip {
    /// The flip of a number and a seed in an image's memory; no other one is needed for it.
    #[must_use]
    pub fn new(seed: u64, number: u64, memory: &Memory) -> Self {
        let mut draw =
            Xoshiro256PlusPlus::seed_from_u64(stream_seed(seed, &format!("flip {number}")));
        let region = Region::draw(&mut draw);
        let fault = region.bit(memory, &mut draw);
        let place = PLACES[draw.random_range(0..PLACES.len())];
        let (from_s, to_s) = span(place);
        let ms = |t_s: f64| (t_s * 1e3).round() as u32;
        let whole_ms = draw.random_range(ms(from_s)..ms(to_s));
        let us = if draw.random() {
            draw.random_range(TICK_US)
        } else {
            draw.random_range(0..1000)
        };
        Self {
            number,
            region,
            fault,
            moment: Moment {
                place,
                t_s: f64::from(whole_ms * 1000 + us) / 1e6,
            },
        }
    }

    pub(super) const fn injected(&self) -> Injected {
        Injected::Processor(self.fault)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_sim::processor::CoreRegister;
    use thermal_sim::scene::Scene;

    fn memory() -> Memory {
        Memory {
            ram: 0x2000_0000..0x2002_0000,
            statics: 0x2001_0000..0x2001_2000,
            stack: 0x2000_f000..0x2001_0000,
        }
    }

    #[test]
    fn flips_repeat_by_seed_and_number_and_differ_between_them() {
        let flip = |seed, number| Flip::new(seed, number, &memory());
        assert_eq!(flip(3, 17), flip(3, 17));
        assert_ne!(flip(3, 17).text(), flip(3, 18).text());
        assert_ne!(flip(3, 17).text(), flip(4, 17).text());
    }

    /// 3000 draws miss a place with a probability below 1e-9, a register of a region of a twentieth with one below 1e-1;
    /// so those of the core are looked for, of which 600 flips miss one of 17 with less than 1e-13.
    #[test]
    fn all_places_and_core_registers_are_drawn_within_their_regions_and_each_is_a_scene() {
        let memory = memory();
        let (mut places, mut core) = (Vec::new(), Vec::new());
        for number in 0..3000 {
            let flip = Flip::new(1, number, &memory);
            let (from_s, to_s) = span(flip.moment.place);
            assert!((from_s..to_s).contains(&flip.moment.t_s), "{flip:?}");
            if !places.contains(&flip.moment.place) {
                places.push(flip.moment.place);
            }
            match (flip.region, flip.fault) {
                (Region::Statics, MachineFault::RamBit { address, .. }) => {
                    assert!(memory.statics.contains(&address));
                }
                (Region::Stack, MachineFault::RamBit { address, .. }) => {
                    assert!(memory.stack.contains(&address));
                }
                (Region::Ram, MachineFault::RamBit { .. }) => {}
                (Region::Core, MachineFault::CoreBit { register, bit }) => {
                    assert!(register.bits() >> bit & 1 != 0, "{flip:?}");
                    if !core.contains(&register) {
                        core.push(register);
                    }
                }
                (Region::Float, MachineFault::CoreBit { register, .. }) => {
                    assert!(matches!(
                        register,
                        CoreRegister::S(0..32) | CoreRegister::Fpscr
                    ));
                }
                (Region::Device, MachineFault::RegisterBit { .. }) => {}
                other => panic!("{other:?}"),
            }
            if number % 100 == 0 {
                let scene = Scene::parse(&flip.text(), "flip".as_ref()).expect("a scene");
                let injection = scene.injections.last().expect("an injection");
                assert_eq!(
                    (injection.fault, injection.t_s),
                    (flip.fault, flip.moment.t_s)
                );
            }
        }
        assert_eq!((places.len(), core.len()), (PLACES.len(), 17));
    }
}
