//! The host, and what it says.

use thermal_display::guard::Fault;
use thermal_sim::scene::FaultKind as Kind;

use crate::faults::entry::broken;
use crate::faults::{Entry, Injected, Place, Sign};

/// Silence, noise, and wrong or unwise lines.
pub const ENTRIES: &[Entry] = &[
    Entry::trips(
        broken(Kind::HostSilent),
        &[Sign::After(2.0)],
        &[Fault::HostSilent],
    )
    .never_at(Place::TESTED),
    Entry::harmless(broken(Kind::HostGarbage)),
    // Off, a flood drowns the line that arms.
    Entry::harmless(broken(Kind::HostFlood)).never_at(&[Place::Off]),
    Entry::harmless(Injected::Line("hold 60")).at(&[Place::Touched]),
    Entry::harmless(Injected::Line("object 900")),
    Entry::harmless(Injected::Line("stream 0")),
    // Without a tuned model the display overshoots the limit of its set-point.
    Entry::harmless(Injected::Line("object -20"))
        .or_trips(&[Fault::DisplayCold])
        .at(&[Place::Slew, Place::Touched]),
    Entry::trips(
        Injected::Line("object 60"),
        &[Sign::Dose],
        &[Fault::Dose, Fault::DisplayHot, Fault::UnlikeModel],
    )
    .at(&[Place::Slew])
    .watched(180.0),
    // By a tile that it is not, a display that is held goes beyond.
    Entry::trips(
        Injected::Line("set tile 0.5 0.02 0.3 0.5 0.02"),
        &[Sign::WrongWay, Sign::DisplayLimit],
        &[
            Fault::Polarity,
            Fault::UnlikeModel,
            Fault::DisplayHot,
            Fault::DisplayCold,
        ],
    ),
];
