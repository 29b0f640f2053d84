//! Exemptions from the checks, each with its reason. What a compiler makes of a function depends on its version and settings: a
//! loop may be unrolled, a check proven and left out. A panic that is allowed and not there is an error in the recorded build; a loop
//! that is not there is none.

use std::collections::BTreeSet;

/// The control tick.
pub const TICK: &str = "DMA2_STREAM0";
/// The end of sampling.
pub const CONVERTER: &str = "ADC";
/// Reception of bytes from the host.
pub const RECEIVER: &str = "USART2";
/// Transmission of the next line to the host.
pub const REFILL: &str = "DMA1_STREAM6";
/// The dispatcher of the task that learns the finger: the only one that may calculate with floating point.
pub const LEARN: &str = "EXTI1";
/// The dispatcher of the task that answers the host.
pub const HOST: &str = "EXTI0";

/// The handlers of the control path.
pub const CONTROL: [&str; 4] = [TICK, CONVERTER, RECEIVER, REFILL];

/// An exemption.
#[derive(Debug)]
pub struct Entry {
    /// Handlers for which it is allowed.
    pub trees: &'static [&'static str],
    /// Functions, without generic parameters; modules, which end in `::`; or files, if the compiler has merged several locations.
    pub names: &'static [&'static str],
    /// Why it is harmless.
    pub why: &'static str,
}

impl Entry {
    /// Whether the function or file is one of the entry.
    fn covers(&self, name: &str) -> bool {
        (self.names.iter())
            .any(|known| *known == name || known.ends_with("::") && name.starts_with(known))
    }
}

/// A list of exemptions, with the handlers for which each has been used.
pub struct Allowed {
    entries: &'static [Entry],
    used: BTreeSet<(usize, &'static str)>,
}

impl Allowed {
    /// A list of which none has been used.
    pub fn new(entries: &'static [Entry]) -> Self {
        Self { entries, used: BTreeSet::new() }
    }

    /// The reason why a function is allowed for a handler, if it is.
    pub fn why(&mut self, tree: &str, name: &str) -> Option<&'static str> {
        for (index, entry) in
            self.entries.iter().enumerate().filter(|(_, entry)| entry.covers(name))
        {
            if let Some(tree) = entry.trees.iter().find(|known| **known == tree) {
                self.used.insert((index, tree));
                return Some(entry.why);
            }
        }
        None
    }

    /// Descriptions of the exemptions that were not used.
    pub fn unused(&self) -> Vec<String> {
        let all = self.entries.iter().enumerate();
        let each =
            all.flat_map(|(index, entry)| entry.trees.iter().map(move |tree| (index, *tree)));
        each.filter(|one| !self.used.contains(one))
            .map(|(index, tree)| {
                let names = self.entries[index].names.join(" or ");
                format!("{tree}: {names} is allowed, but is not there")
            })
            .collect()
    }
}

/// Panics, all but one in libraries. Each switches the bridges off first, and ends in a reset by the watchdog.
pub static PANICS: [Entry; 8] = [
    Entry {
        trees: &[TICK, REFILL],
        names: &["stm32f4xx_hal::dma::Transfer::next_transfer_common"],
        why: "takes the buffer out of an Option that is Some between any two calls",
    },
    Entry {
        trees: &[TICK, CONVERTER, HOST],
        names: &["defmt_rtt::AtomicRttEncoder::acquire"],
        why: "a nested log entry: no logged value logs while it is formatted",
    },
    Entry {
        trees: &[TICK, RECEIVER, REFILL],
        names: &["heapless::spsc::QueueInner::increment"],
        why: "remainder by the length of a queue, a constant above zero",
    },
    Entry {
        trees: &[HOST],
        names: &[
            "heapless::spsc::QueueInner::increment",
            "heapless::spsc::QueueInner::len",
            "heapless/src/spsc.rs",
        ],
        why: "remainder by, and difference to, the length of a queue, a constant above zero",
    },
    Entry {
        trees: &[HOST],
        names: &["thermal_display::board::console::Console::answer_lines_and_send_telemetry"],
        why: "no panic: `save` ends in a reset, from which nothing returns",
    },
    Entry {
        trees: &[TICK],
        names: &[
            "thermal_display::board::nucleo_f446re::chip_monitor::ChipMonitor::restart_when_clock_has_come",
        ],
        why: "no panic: ends in a reset when the probe's clock has come",
    },
    Entry {
        trees: &[HOST],
        names: &[
            "thermal_display::app::host::{{closure}}",
            "thermal_display::app::host::{closure#0}",
        ],
        why: "the executor polls no future that has ended",
    },
    Entry {
        trees: &[LEARN],
        names: &[
            "thermal_display::app::learn::{{closure}}",
            "thermal_display::app::learn::{closure#0}",
        ],
        why: "the executor polls no future that has ended",
    },
];

/// Loops of the control path and of the learner. Loops that repeat an exclusive access need no entry: they repeat once for each exception
/// between its load and its store.
pub static LOOPS: [Entry; 14] = [
    Entry {
        trees: &[TICK, CONVERTER, REFILL],
        names: &["stm32f4xx_hal::dma::stream_disable"],
        why: "waits until a stream has ended its transfer, a few bus cycles; otherwise the watchdog resets the device",
    },
    Entry {
        trees: &[TICK, CONVERTER],
        names: &["defmt::encoding::inner::Encoder::write"],
        why: "bytes of one value of a log line, at most some tens",
    },
    Entry {
        trees: &[TICK],
        names: &[
            "thermal_device::sense::scattering_thermistors",
            "thermal_device::sense::channel_sums",
        ],
        why: "16 scans of 8 channels",
    },
    Entry {
        trees: &[TICK],
        names: &["thermal_device::stimulus::player::Place::temperature"],
        why: "a binary search among at most 128 points",
    },
    Entry {
        trees: &[TICK],
        names: &["thermal_display::board::control_loop::ControlLoop::queue_events"],
        why: "at most the eight events that a station keeps",
    },
    Entry {
        trees: &[TICK],
        names: &["contact_model::fixed_point::chord_interpolation::lengths_per_octave"],
        why: "a constant range",
    },
    Entry {
        trees: &[TICK],
        names: &[
            "contact_model::fixed_point::relaxation_bank::updated_slow",
            "contact_model::fixed_point::relaxation_bank::RelaxationBank::step",
            "contact_model::fixed_point::relaxation_bank::RelaxationBank::scaled_flux_to_match",
            "contact_model::fixed_point::relaxation_bank::RelaxationBank::rescale",
            "contact_model::fixed_point::relaxation_bank::StateFactors::new",
        ],
        why: "at most one iteration for each relaxation of a body, whose states are arrays of constant length",
    },
    Entry {
        trees: &[TICK],
        names: &[
            "contact_model::fixed_point::body::weights::TissueWeights::",
            "thermal_learner::output::LearnerOutput::",
        ],
        why: "weights and parameters of a finger, arrays of constant length",
    },
    Entry {
        trees: &[LEARN],
        names: &[
            "thermal_learner::estimate::Estimate::",
            "thermal_learner::output::LearnerOutput::",
            "thermal_learner::parameters::",
            "thermal_learner::person::",
            "thermal_learner::regressors::",
            "thermal_learner::signals::",
        ],
        why: "the parameters, rates or weights of a finger, arrays of constant length",
    },
    Entry {
        trees: &[TICK],
        names: &[
            "thermal_device::identification::normal_equations::NormalEquationAccumulator::add_equation",
        ],
        why: "arrays of constant length",
    },
    Entry {
        trees: &[TICK, CONVERTER, RECEIVER, LEARN],
        names: &["compiler_builtins::mem::", "compiler_builtins::arm::"],
        why: "moves and clears values, whose sizes are those of their types",
    },
    Entry {
        trees: &[TICK],
        names: &["compiler_builtins::int::"],
        why: "a division: at most one iteration for each of 64 bits",
    },
    Entry {
        trees: &[TICK, CONVERTER],
        names: &[
            "thermal_device::device::Device::earliest_trip_cause",
            "thermal_device::device::Device::note_host_activity",
            "thermal_device::device::Device::note_trigger_edge",
            "thermal_device::device::Device::trip_all",
            "thermal_display::board::control_loop::ControlLoop::run_finger_tick",
            "thermal_display::board::control_loop::ControlLoop::stop_and_trip_all",
        ],
        why: "one iteration for each finger",
    },
    Entry {
        trees: &[TICK, CONVERTER],
        names: &["thermal_display::board::nucleo_f446re::trip_cause_recorder::"],
        why: "the words of a trip cause, an array of constant length",
    },
];
