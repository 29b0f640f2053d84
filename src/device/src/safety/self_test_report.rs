//! What a self-test has measured.

use contact_model::fixed_point::Celsius;
use thermal_settings::vocabulary;

use super::Fault;
use crate::drive::Current;
use crate::learning::FluxSensorTest;
use crate::sense::SupplyVoltage;

/// What the last self-test has measured, whether it has passed or not; `None` for what it has not reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SelfTestReport {
    /// Line that selects the side of the comparator's tests.
    pub side_line: Option<SideLine>,
    /// Test of the comparator's hot side.
    pub hot: ComparatorSideReport,
    /// Test of the comparator's cold side.
    pub cold: ComparatorSideReport,
    /// Supply of the bridge 19 ms after the last test of the comparator that has ended.
    pub supply: Option<SupplyVoltage>,
    /// Mean measured current of the cooling pulse of 1 A, A.
    pub cooling_current: Option<Current>,
    /// Mean measured current of the warming pulse of 1 A, A.
    pub warming_current: Option<Current>,
    /// Fall of the readings of the display's first and second thermistor by the cooling pulse, K.
    pub responses: [Option<Celsius>; 2],
    /// Result.
    pub result: SelfTestResult,
    /// Heat-flux sensor, at the end of a self-test that has passed; `None` without one. It trips nothing, as the device works
    /// without.
    pub flux_sensor: Option<FluxSensorTest>,
}

/// What the test of one side of the comparator has measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ComparatorSideReport {
    /// Time from the begin of the test until the bridge's fault line was pulled, ms, rounded up.
    pub cut_ms: Option<u8>,
    /// Supply of the bridge 19 ms after the begin of the test.
    pub cut_supply: Option<SupplyVoltage>,
    /// Time from the end of the test until the fault line was released, ms, rounded up.
    pub release_ms: Option<u8>,
}

vocabulary! {
    /// What the tests of the comparator have shown of the line that selects their side.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum SideLine: "side" {
        /// It has had the levels of the tests so far.
        Follows = "ok",
        /// It is low in a test of the cold side.
        StuckLow = "low",
        /// It is high in a test of the hot side.
        StuckHigh = "high",
    }
}

/// Result of the last self-test.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SelfTestResult {
    /// No self-test since the start, or the last one was ended by `abort`.
    #[default]
    None,
    /// The self-test runs.
    Running,
    /// The self-test has passed.
    Passed,
    /// This fault, found by the self-test or by another detector, has ended the self-test.
    Failed(Fault),
}

impl SelfTestResult {
    /// Its word in lines to the host; of a failed self-test that of its fault.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Running => "running",
            Self::Passed => "passed",
            Self::Failed(fault) => fault.name(),
        }
    }
}
