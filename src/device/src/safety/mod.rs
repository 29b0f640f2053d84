//! What keeps a finger safe: states, faults, and the limits of what may be asked for.
//!
//! ```text
//!                   arm                    passed                   start
//!     power-up --> off ----> self-test -----------------> armed ------------> preset <--> contact
//!                   ^            |                        ^   |                | lands / lifts |
//!                   |            |           arm          |   | abort          |               |
//!                   |            |       ready -----------+   v                | arm: armed    |
//!                   |            |         ^------------------+----------------+-- abort ------+
//!                   |            v
//!                   +- clear - tripped <--- any fault, from any state; a reset by a watchdog
//! ```
//!
//! The bridge is driven in self-test, armed, preset and contact. Everywhere else, and in the very tick that sees a
//! fault, both of its legs are high-impedance; nothing else is ever called off. Off is safe as long as the sink is:
//! heat flows back from it to the display, which is why the sink's limit is the lowest of all.
//!
//! **Faults are levels.** What one tick shows is looked at on every tick in every state, so that what was wrong before
//! `arm` keeps it from being obeyed, and what is wrong after a trip keeps `clear` from it. Where one tick is not enough to
//! know, the detector says for how long a thing must last, and looks at every tick in which no reading is at an end of its
//! range or beyond its limit; signals that stand still and the dose are followed even then. Only the fault line of the bridge
//! is not looked at while the bridge is off and untested, or tripped: the comparator pulls it too, and keeps pulling until
//! the next self-test.
//!
//! **What latches.** The first fault does, with the readings of its tick, as [`Cause`]; later ones do not replace it. A
//! later one that no sample shows comes to light when the first is cleared. Until it is cleared the cause
//! survives every reset but the loss of power, and the dose does too. The comparator latches on its own, in hardware.
//!
//! **What clears it.** `clear`, once no level is there any more, leads to off, not to ready: what comes next is the
//! self-test. Faults of the program and resets clear the same way.
//!
//! **Who looks at what**
//!
//! | detector       | faults                                   | trips when                                           |
//! |----------------|------------------------------------------|------------------------------------------------------|
//! | [`check`]      | open, short, excitation, force sensor    | in the tick whose last conversion is at an end       |
//! |                | display hot, cold                        | 43, 13.5 °C by either thermistor                     |
//! |                | sink hot                                 | 42 °C                                                |
//! |                | over-current                             | 3 A above what is ever asked for                     |
//! | bridge         | its fault line, the comparator           | in that tick; of one finger, a pulse between, too    |
//! | `frozen`       | a channel, or all                        | a sum repeats itself 46 times                        |
//! | `jump`         | display, its second thermistor, sink     | 0.5 K in 4 ms                                        |
//! | `apart`        | the display's thermistors                | 3 K for 40 ms                                        |
//! | `room`         | room above skin                          | 8 K for 40 ms                                        |
//! | `electrical`   | current high, low                        | 1 A and a quarter for 30 ms                          |
//! | law            | unlike model                             | residual of 3.75 K, 8 untuned, for 30 ms             |
//! | `response`     | polarity, runaway                        | 2.5 K the wrong way at a mean of 1 A                 |
//! | `dose`         | dose                                     | half a minute of CEM43 by the display                |
//! | `watch`        | host silent                              | 2 s without a line while telemetry streams           |
//! | [`Pace`]       | sampling                                 | a tick is off by a quarter of its period             |
//! | [`SelfTest`]   | comparator, polarity, no response, …     | before the first current for a finger                |
//!
//! Beside these, without this program: the window watchdog resets a device whose tick does not come for 47 ms, the
//! independent one a device whose tasks do not check in for 68 to 188 ms, and the comparator cuts the supply at 10 and
//! 45 °C of the second thermistor.

mod cause;
mod dose;
mod electrical;
mod fault;
mod frozen;
mod jump;
mod lasting;
mod limits;
mod pace;
mod response;
mod self_test;
mod setpoint;
mod state;
mod watch;

pub use cause::Cause;
pub use dose::Dose;
pub use fault::{Fault, Thermistor};
pub use limits::{Sound, check};
pub use pace::Pace;
pub use self_test::{Progress, SelfTest};
pub use setpoint::Setpoint;
pub use state::State;
pub use watch::{Before, Watch};
