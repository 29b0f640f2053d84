//! What keeps a finger safe: faults, their detectors, the limits of what may be commanded, and the self-test.
//!
//! The bridge is driven in the states self-test, armed, preset, contact and stimulus. In all others, and in the tick that sees a
//! fault, both of its legs are high-impedance; only that is called "off". Off is safe only while the sink is cool
//! enough, because heat flows back from the sink to the display; so the sink has the lowest upper limit of all.
//!
//! **Detection.** Every detector looks at every tick in every state, or, if it counts over 30 ms or more, at every second
//! one, so that a fault that was present before `arm` refuses
//! it, and one that is still present after a trip refuses `clear`. Faults that one tick does not show have detectors
//! that count ticks; these need valid readings, except for frozen signals and the thermal dose. Only the bridge's fault
//! line and its supply are ignored while the bridge is off and untested, or tripped: the comparator pulls the line, too,
//! and keeps the supply off until the next self-test.
//!
//! **Latch.** The first fault latches, with the readings of its tick, as [`TripCause`]; later ones do not replace it. A
//! second fault that the board has raised is reported when the first is cleared. The cause and the dose survive every
//! reset except the loss of power. The comparator latches by itself, in hardware.
//!
//! **Clear.** `clear` is accepted once no fault is present, and leads to off, not to ready: the self-test comes next.
//! Faults of the program and resets clear the same way.
//!
//! | detector                     | faults                                 | trips when                                    |
//! |------------------------------|----------------------------------------|-----------------------------------------------|
//! | [`validate_readings()`]       | emergency stop                         | pressed                                       |
//! |                              | open, short, excitation, force sensor  | a signal is outside of its possible range     |
//! |                              | display hot, display cold              | 43 °C, 13.5 °C by either thermistor           |
//! |                              | sink hot                               | 42 °C                                         |
//! |                              | over-current                           | 3 A above the largest demand                  |
//! | bridge fault line            | bridge                                 | the driver or the comparator pulls it         |
//! | `FrozenSampleDetector`             | one channel frozen, or all             | a sum repeats 46 times, although there is noise |
//! | `JumpDetector`               | display, second display or sink jump   | 0.5 K in 4 ms                                 |
//! | [`FaultDetectors`]           | display thermistors disagree           | 3 K for 40 ms                                 |
//! |                              | room above skin                        | 8 K for 40 ms                                 |
//! |                              | unlike its model                       | residual of 3.75 K (8 K before it is identified) for 30 ms |
//! |                              | supply of the bridge                   | outside of 10.8 to 13.2 V for 10 ms           |
//! |                              | host silent                            | 2 s without a line while telemetry streams    |
//! | `CurrentMismatchDetector`    | current high, current low              | 1 A and a quarter of the demand, for 30 ms    |
//! | `WrongWayDetector`           | polarity, runaway                      | 2.5 K against a mean current of 1 A           |
//! | [`ThermalDose`]              | dose                                   | half a minute of CEM43                        |
//! | [`TickRateMonitor`]          | sampling                               | a tick is off by a quarter of its period      |
//! | [`SelfTest`]                 | comparator, supply switch, polarity, … | before the first current for a finger         |
//!
//! Independent of this program, the window watchdog resets a device whose tick does not run for 47 ms, the independent
//! watchdog one whose tasks do not check in for 68 to 188 ms, and the comparator cuts the supply at 10 and 45 °C of the
//! second display thermistor.

mod comparator_test;
mod current_mismatch;
mod debounce;
mod detectors;
mod fault;
mod fault_latch;
mod frozen_sample_detector;
mod jump_detector;
pub mod limits;
mod self_test;
mod self_test_report;
mod setpoint;
mod thermal_dose;
mod tick_rate;
mod trip_cause;
mod validate_readings;
mod wrong_way_detector;

pub(crate) use debounce::UpDownDebounceCounter;
pub use detectors::{FaultDetectors, PreviousDemandAndResidual};
pub use fault::{Fault, ThermistorId};
pub use fault_latch::FaultLatch;
pub use self_test::{SelfTest, SelfTestStep};
pub use self_test_report::{ComparatorSideReport, SelfTestReport, SelfTestResult, SideLine};
pub use setpoint::Setpoint;
pub use thermal_dose::{PredictedDose, ThermalDose};
pub use tick_rate::TickRateMonitor;
pub use trip_cause::TripCause;
pub use validate_readings::{ValidReadings, validate_readings};
