//! Converters with much and with little noise.

use super::{Fault, FrozenSampleDetector, MONITORED_CHANNEL_COUNT};
use crate::sense::{DigitalInputs, SCANS_PER_TICK, Samples, Scan};

/// Six signals behind a converter with almost normal noise.
struct Converter {
    /// Standard deviation of one conversion, counts.
    noise_counts: f64,
    levels: [f64; MONITORED_CHANNEL_COUNT],
    last: Scan,
    random: u64,
    detector: FrozenSampleDetector,
}

impl Converter {
    fn new(noise_counts: f64, levels: [f64; MONITORED_CHANNEL_COUNT]) -> Self {
        Self {
            noise_counts,
            levels,
            last: Scan::default(),
            random: 1,
            detector: FrozenSampleDetector::default(),
        }
    }

    /// A number from 0 to 1 (Numerical Recipes' generator).
    fn uniform(&mut self) -> f64 {
        self.random = (self.random.wrapping_mul(6_364_136_223_846_793_005))
            .wrapping_add(1_442_695_040_888_963_407);
        (self.random >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Advances by a tick in which the channels of `stuck` repeat their last code.
    fn tick(&mut self, stuck: u8, driven: bool) -> Result<(), Fault> {
        let mut scans = [self.last; SCANS_PER_TICK];
        for scan in &mut scans {
            for channel in (0..MONITORED_CHANNEL_COUNT).filter(|i| stuck >> i & 1 == 0) {
                let sum: f64 = (0..4).map(|_| self.uniform()).sum();
                // Their variance is a third.
                let normal = (sum - 2.0) * 3f64.sqrt();
                let level = self.levels[channel] + self.noise_counts * normal;
                self.last[channel] = level.round() as u16;
            }
            *scan = self.last;
        }
        let needs_scatter = self.detector.needs_scatter();
        let samples = Samples::from_scans(&scans, DigitalInputs::default(), needs_scatter);
        self.detector.check_samples(&samples, driven)
    }

    /// Ticks from now on until a fault, at most 1000.
    fn ticks_to_fault(&mut self, stuck: u8) -> Option<(u32, Fault)> {
        (1..=1000).find_map(|tick| Some((tick, self.tick(stuck, true).err()?)))
    }
}

const LEVELS: [f64; MONITORED_CHANNEL_COUNT] = [2000.1, 2010.4, 2100.8, 1800.2, 2200.5, 410.7];

#[test]
fn a_frozen_channel_is_found_within_50_ms_if_the_converter_has_noise() {
    for noise_counts in [0.4, 0.7, 1.2] {
        for (channel, fault) in super::FROZEN_CHANNEL_FAULTS.into_iter().enumerate() {
            let mut converter = Converter::new(noise_counts, LEVELS);
            assert!((0..2000).all(|_| converter.tick(0, true).is_ok()));
            let found = converter.ticks_to_fault(1 << channel).expect("found");
            assert!(found.0 <= 47 && found.1 == fault, "{noise_counts} {found:?}");
        }
    }
}

#[test]
fn a_frozen_converter_is_found_within_50_ms_if_it_had_noise() {
    for noise_counts in [0.4, 0.7, 1.2] {
        let mut converter = Converter::new(noise_counts, LEVELS);
        assert!((0..2000).all(|_| converter.tick(0, true).is_ok()));
        let found = converter.ticks_to_fault(0x3f).expect("found");
        assert!(found.0 <= 47 && found.1 == Fault::SamplesFrozen, "{noise_counts} {found:?}");
    }
}

/// At rest, moving as fast as the bridge can, and resting again; with the bridge turned on and off; with a disturbance that moves
/// all channels at once.
#[test]
fn a_quiet_converter_trips_nothing() {
    for noise_counts in [0.0, 0.05, 0.1, 0.15, 0.2, 0.3] {
        for start in (0..5).map(|part| f64::from(part) / 5.0) {
            let mut converter = Converter::new(noise_counts, LEVELS.map(|level| level + start));
            for tick in 0..6000u32 {
                let moves = (1000..2000).contains(&(tick % 3000));
                if moves {
                    converter.levels[0] += if tick < 3000 { 0.7 } else { -0.7 };
                    converter.levels[1] += if tick < 3000 { 0.65 } else { -0.65 };
                    converter.levels[5] += f64::from(tick % 50) - 24.5;
                }
                let resting = converter.levels;
                if tick % 700 == 0 {
                    converter.levels = resting.map(|level| level + 5.0);
                }
                let checked = converter.tick(0, tick % 2000 < 1500);
                assert_eq!(checked, Ok(()), "{noise_counts} counts, tick {tick}");
                converter.levels = resting;
            }
        }
    }
}

/// Counted from the freeze on, or from when the bridge is turned on.
#[test]
fn what_has_frozen_before_the_bridge_is_turned_on_or_off_is_found_too() {
    for driven_before in [true, false] {
        // The first of these ticks has a last new sum.
        for before in [2, 5, 20, 45] {
            for (stuck, fault) in [(1 << 2, Fault::SinkFrozen), (0x3f, Fault::SamplesFrozen)] {
                let mut converter = Converter::new(0.7, LEVELS);
                assert!((0..2000).all(|_| converter.tick(0, driven_before).is_ok()));
                assert!((0..before).all(|_| converter.tick(stuck, driven_before).is_ok()));
                let found = (1..=48).find_map(|tick| {
                    let fault = converter.tick(stuck, !driven_before).err()?;
                    Some((tick, fault))
                });
                let (tick, found) = found.expect("found");
                let at_most = if driven_before { 47 - before } else { 47 };
                assert!(
                    tick <= at_most && found == fault,
                    "{driven_before} {before}: {tick} {found:?}"
                );
            }
        }
    }
}

/// Noise that comes from the bridge comes and goes with it.
#[test]
fn a_bridge_whose_noise_ends_when_it_is_turned_off_trips_nothing() {
    for quiet_counts in [0.0, 0.05, 0.1] {
        let mut converter = Converter::new(quiet_counts, LEVELS);
        for tick in 0..20_000 {
            let driven = tick % 2000 < 1000;
            converter.noise_counts = if driven { 0.7 } else { quiet_counts };
            let checked = converter.tick(0, driven);
            assert_eq!(checked, Ok(()), "{quiet_counts} counts, tick {tick}");
        }
    }
}
