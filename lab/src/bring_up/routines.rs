//! What the program does with the device between the checks.

use std::time::Duration;

use thermal_client::client::{
    DeviceRequest, Identity, QueryBoard, QueryIdentity, QueryRaw, QueryState, RawReadings,
    StationRequest,
};
use thermal_client::commissioning::{CommissioningEvent, arm, commission};
use thermal_client::link::Link;
use thermal_device::safety::ThermistorId;
use thermal_settings::Settings;

use super::bench::{Bench, BenchError};
use super::check::{Expected, ManualStep, Routine, Stage, StageId};
use super::procedure::{Interruption, OtherDevice, Procedure};
use super::report::{Record, Verdict};
use super::unit::Unit;

/// Counts of the converter.
const CODES: f64 = 4096.0;
/// Pull-up of each thermistor's divider, ohm.
const PULL_UP_OHM: f64 = 10e3;
/// Allowed difference of a known resistor's counts: 1 % of the resistor is 10, of pull-up and converter 6.
const KNOWN_COUNTS: f64 = 16.0;
/// Counts of the current measurement per ampere.
const COUNTS_PER_A: f64 = 400.0;
/// Counts of the sensed supply per volt: 3.3 V are 4096 counts, behind 33 and 10 kΩ.
const COUNTS_PER_V: f64 = CODES / 3.3 * 10.0 / 43.0;
/// Time in which the driver alone discharges the capacitors of the bridge supply.
const STOP_DECAY: Duration = Duration::from_millis(300);
/// Thermistors with their names and the pins of their inputs, in the order of the converter's channels.
const INPUTS: [(ThermistorId, &str, &str); 5] = [
    (ThermistorId::Display, "display", "PA0, A0"),
    (ThermistorId::Check, "second display", "PA1, A1"),
    (ThermistorId::Sink, "sink", "PA4, A2"),
    (ThermistorId::Skin, "skin", "PB0, A3"),
    (ThermistorId::Room, "room", "PC1, A4"),
];
/// Time that the display takes for a change of a degree, and to settle then, ms.
const MS_PER_DEGREE: f64 = 1000.0;
const SETTLE_MS: u64 = 6000;
/// Largest distance of a held temperature from where the display is, K.
const DISTANCE_MAX_K: f64 = 30.0;
/// Interval of telemetry while the display is held, ms.
const HOLD_STREAM_MS: u32 = 20;
/// Longest time in which the emergency stop must show, and interval of polling, ms.
const STOP_MS: u64 = 2000;
const STOP_POLL_MS: u64 = 5;

impl<L: Link, B: Bench<L>> Procedure<'_, L, B> {
    pub(super) fn routine(&mut self, stage: &Stage, routine: &Routine) -> Result<(), Interruption> {
        match *routine {
            Routine::Identify => self.identify(stage),
            Routine::SelfTest => self.self_test(stage),
            Routine::Edge { keep, ohm } => self.edge(stage, keep, ohm),
            Routine::KnownResistors(ohm) => self.known_resistors(stage, &ohm),
            Routine::SerialLine(ms) => self.serial_line(ms),
            Routine::Thermistors => self.thermistors(),
            Routine::Hold { keep, celsius } => self.hold(keep, celsius),
            Routine::Commission => self.commission(stage),
            Routine::StopWhileDriving => self.stop_while_driving(),
        }
    }

    /// Forgets telemetry that belongs to an earlier stream.
    fn discard_telemetry(&mut self) -> Result<(), Interruption> {
        while self.client.next_telemetry(Duration::ZERO)?.is_some() {}
        Ok(())
    }

    fn keep(&mut self, name: impl Into<String>, value: f64) {
        self.kept.insert(name.into(), value);
    }

    /// Reads what the device is. Refuses it if the report keeps results of another one.
    pub(super) fn same_device(&mut self) -> Result<(Identity, String), Interruption> {
        let identity = self.client.ask(&QueryIdentity)?;
        let chip = match identity.can("board") {
            true => self.client.ask(&QueryBoard)?.uid,
            false => None,
        };
        let text = format!(
            "{} {}, {} finger(s), protocol {}, {}",
            identity.name,
            identity.version,
            identity.fingers,
            identity.protocol.unwrap_or_default(),
            identity.capabilities.join(" ")
        );
        let device = Some(text.clone());
        let report = &mut self.report;
        let depends_on_firmware = report.depends_on_firmware();
        let is_other_chip = report.chip != chip && (report.chip.is_some() || depends_on_firmware);
        if is_other_chip || (depends_on_firmware && report.device != device) {
            return Err(Interruption::OtherDevice(OtherDevice {
                then: described(report.chip.as_deref(), report.device.as_deref()),
                now: described(chip.as_deref(), device.as_deref()),
            }));
        }
        (report.device, report.chip) = (device, chip);
        Ok((identity, text))
    }

    fn identify(&mut self, stage: &Stage) -> Result<(), Interruption> {
        let (identity, text) = self.same_device()?;
        let needed = ["self-test", "raw", "board", "checksum"];
        let missing: Vec<_> = needed.into_iter().filter(|one| !identity.can(one)).collect();
        let finding = (!missing.is_empty() || identity.fingers != 1).then(|| {
            format!(
                "firmware: found '{text}'; needed is one for one finger with {}: flash that of this repository",
                needed.join(", ")
            )
        });
        let record = Record {
            stage: stage.name.into(),
            check: "firmware".into(),
            what: "firmware".into(),
            expected: format!("one finger, with {}", needed.join(", ")),
            found: text,
            basis: "this procedure".into(),
            verdict: verdict(finding.is_none()),
            finding,
        };
        self.add(record, Some(StageId::Reset));
        Ok(())
    }

    /// Clears the latch, and turns the resistor until nFAULT falls.
    fn edge(
        &mut self,
        stage: &Stage,
        keep: &'static str,
        ohm: (f64, f64),
    ) -> Result<(), Interruption> {
        self.act(&ManualStep {
            say: "Set the variable resistor to 10 kΩ.",
            lines: &["fit resistor check 10000"],
            wait_ms: 300,
        })?;
        self.self_test(stage)?;
        if self.client.ask(&QueryRaw)?.fault_line {
            // The latch cannot be cleared; the check finds no value, and the self-test's own checks say why.
            return Ok(());
        }
        let mut tripped = |client: &mut thermal_client::client::Client<L>| {
            let raw = client.ask(&QueryRaw);
            raw.map(|raw| raw.fault_line).map_err(|error| BenchError::Failed(error.to_string()))
        };
        if let Some(at_ohm) = self.bench.turn(self.client, ohm, &mut tripped)? {
            self.keep(keep, at_ohm);
        }
        Ok(())
    }

    fn known_resistors(
        &mut self,
        stage: &Stage,
        known_ohm: &[f64; INPUTS.len()],
    ) -> Result<(), Interruption> {
        let found = counts(&self.client.ask(&QueryRaw)?);
        let expected = known_ohm.map(|ohm| CODES * ohm / (ohm + PULL_UP_OHM));
        let fits = |found: f64, expected: f64| (found - expected).abs() <= KNOWN_COUNTS;
        for (index, (thermistor, name, pin)) in INPUTS.iter().enumerate() {
            let (counts, ohm) = (found[index], known_ohm[index]);
            let swapped = (0..INPUTS.len()).find(|other| {
                let is_its = fits(counts, expected[*other]);
                *other != index && is_its && fits(found[*other], expected[index])
            });
            let is_good = fits(counts, expected[index]);
            let finding = (!is_good).then(|| {
                let at = format!("input of the {name} thermistor ({pin})");
                let shown = Unit::Ohm.text(ohm);
                match swapped {
                    Some(other) => {
                        let (_, other, its_pin) = INPUTS[other];
                        format!(
                            "{at}: it shows the resistor of the {other} thermistor ({its_pin}): the wires of {name} and {other} \
                             are swapped"
                        )
                    }
                    None if counts > CODES - KNOWN_COUNTS => {
                        format!("{at}: open, with {shown} connected: wire, connector, R2 (1 kΩ, block dividers)")
                    }
                    None if counts < KNOWN_COUNTS => format!(
                        "{at}: at ground, with {shown} connected: short, or its pull-up R1 (10 kΩ, block dividers) is missing"
                    ),
                    None => format!(
                        "{at}: {counts:.0} counts with {shown}, as of a pull-up of {}: R1 (10 kΩ 0.1 %, block dividers) at this \
                         input is wrong, or the resistor that you have connected",
                        Unit::Ohm.text(ohm * (CODES - counts) / counts)
                    ),
                }
            });
            let range = Expected::Range(
                (expected[index] - KNOWN_COUNTS).round(),
                (expected[index] + KNOWN_COUNTS).round(),
                Unit::Count,
            );
            let record = Record {
                stage: stage.name.into(),
                check: format!("known-{}", thermistor.name()),
                what: format!("{name} input with {}", Unit::Ohm.text(ohm)),
                expected: range.to_string(),
                found: Unit::Count.text(counts),
                basis: "4096 R/(R + 10 kΩ): 1 % of the resistor, 0.1 % of the pull-up, 5 counts of the converter".into(),
                verdict: verdict(is_good),
                finding,
            };
            self.add(record, Some(StageId::Tile));
        }
        Ok(())
    }

    fn serial_line(&mut self, ms: u64) -> Result<(), Interruption> {
        self.client.ask(&DeviceRequest::Checksum { switch: true.into() })?;
        self.discard_telemetry()?;
        let before = self.client.counts();
        self.client.ask(&StationRequest::stream(1))?;
        let end = self.client.link().now() + Duration::from_millis(ms);
        let mut lines = 0;
        loop {
            let left = end.saturating_sub(self.client.link().now());
            if left.is_zero() || self.client.next_telemetry(left)?.is_none() {
                break;
            }
            lines += 1;
        }
        self.client.ask(&StationRequest::stream(0))?;
        let after = self.client.counts();
        self.client.ask(&DeviceRequest::Checksum { switch: false.into() })?;
        self.keep("lines", f64::from(lines));
        self.keep("lines-lost", (after.lost - before.lost) as f64);
        self.keep("lines-damaged", (after.damaged - before.damaged) as f64);
        Ok(())
    }

    fn reference_c(&mut self, thermistor: ThermistorId) -> Result<f64, Interruption> {
        let shown = self.bench.reference_c(self.client, thermistor);
        shown.map_err(|error| thermal_client::commissioning::CommissionError::from(error).into())
    }

    /// Compares all thermistors, by the curve of their class, with the reference thermometer.
    fn thermistors(&mut self) -> Result<(), Interruption> {
        for (index, (thermistor, ..)) in INPUTS.iter().enumerate() {
            self.bench.notice(&CommissioningEvent::StepStarted("read the reference thermometer"));
            let reference_c = self.reference_c(*thermistor)?;
            let found_c = class_c(counts(&self.client.ask(&QueryRaw)?)[index]);
            let name = format!("{}-at-rest", thermistor.name());
            self.keep(name, found_c - reference_c);
        }
        Ok(())
    }

    /// Holds the display at a temperature, and compares its thermistors with the reference thermometer.
    fn hold(&mut self, keep: &'static str, celsius: f64) -> Result<(), Interruption> {
        arm(self.client, None)?;
        self.client.ask(&StationRequest::hold(celsius, None))?;
        self.bench.notice(&CommissioningEvent::HoldStarted(celsius));
        self.discard_telemetry()?;
        self.client.ask(&StationRequest::stream(HOLD_STREAM_MS))?;
        let start = self.client.next_telemetry(Duration::from_secs(1))?;
        let start_c = start.and_then(|line| line.telemetry.display_c);
        let distance_k = start_c.map_or(DISTANCE_MAX_K, |start_c| (celsius - start_c).abs());
        let settle_ms = (distance_k * MS_PER_DEGREE) as u64 + SETTLE_MS;
        let end = self.client.link().now() + Duration::from_millis(settle_ms);
        let mut last = None;
        let mut highest_c = f64::NEG_INFINITY;
        loop {
            let left = end.saturating_sub(self.client.link().now());
            let Some(line) = self.client.next_telemetry(left)? else {
                break;
            };
            if let Some(fault) = line.telemetry.fault() {
                let fault = fault.name();
                let why = super::fault_words::explanation(fault);
                let why = why.as_deref().unwrap_or("see docs/safety.md");
                self.client.ask(&StationRequest::stream(0))?;
                return Err(Interruption::Bench(format!(
                    "the device has tripped by `{fault}` while it held {celsius} °C: {why}"
                )));
            }
            highest_c = highest_c.max(line.telemetry.display_c.unwrap_or(f64::NEG_INFINITY));
            last = Some(line.telemetry);
        }
        // The stream goes on while the person reads: the device trips if this program or its computer stops.
        let reference_c = self.reference_c(ThermistorId::Display)?;
        let check_c = class_c(self.client.ask(&QueryRaw)?.check);
        self.client.ask(&StationRequest::stream(0))?;
        self.keep(format!("{keep}-check"), check_c - reference_c);
        self.keep(format!("{keep}-highest"), highest_c);
        let Some(last) = last else { return Ok(()) };
        if let Some(display_c) = last.display_c {
            self.keep(format!("{keep}-display"), display_c - reference_c);
        }
        if let (Some(sink_c), Some(room_c)) = (last.sink_c, last.room_c) {
            self.keep(format!("{keep}-sink"), sink_c - room_c);
        }
        Ok(())
    }

    fn commission(&mut self, stage: &Stage) -> Result<(), Interruption> {
        match commission(self.client, None, self.bench) {
            Ok(done) => {
                let mut last: Vec<(&str, f64)> = Vec::new();
                for point in &done.points {
                    last.retain(|(sensor, _)| *sensor != point.sensor);
                    last.push((point.sensor, point.worst_mk));
                }
                let worst_mk = last.iter().map(|(_, mk)| *mk).fold(0.0, f64::max);
                self.keep("calibration", worst_mk * 1e-3);
                self.keep("phase-margin", done.tile.phase_deg);
                self.keep("gain-margin", done.tile.gain_margin);
                self.report.settings = done.settings;
                Ok(())
            }
            Err(error) if is_interrupted(&error) => Err(Interruption::Aborted),
            Err(error) => {
                let finding = format!(
                    "{error}: compare with the table `What can go wrong` of docs/commissioning.md; a thermistor that no \
                     correction fits is one of another type (beta is not 3950 K), or not where it should be"
                );
                let record = Record {
                    stage: stage.name.into(),
                    check: "commissioned".into(),
                    what: "the device is calibrated and has identified its tile".into(),
                    expected: "yes".into(),
                    found: "no".into(),
                    basis: "docs/commissioning.md".into(),
                    verdict: Verdict::Failed,
                    finding: Some(finding),
                };
                self.add(record, Some(StageId::Run));
                Ok(())
            }
        }
    }

    fn stop_while_driving(&mut self) -> Result<(), Interruption> {
        let start = self.client.link().now();
        for _ in 0..STOP_MS / STOP_POLL_MS {
            let state = self.client.ask(&QueryState)?.state;
            if state.fault().is_some_and(|fault| fault.name() == "emergency-stop") {
                let after = self.client.link().now() - start;
                self.keep("stop-driving", after.as_secs_f64() * 1e3);
                break;
            }
            self.client.wait(Duration::from_millis(STOP_POLL_MS))?;
        }
        self.client.wait(Duration::from_millis(20))?;
        let current = self.client.ask(&QueryRaw)?.current;
        self.keep("stop-current", current / COUNTS_PER_A);
        self.client.wait(STOP_DECAY)?;
        let supply = self.client.ask(&QueryRaw)?.supply;
        self.keep("stop-supply", supply / COUNTS_PER_V);
        Ok(())
    }
}

fn is_interrupted(error: &thermal_client::commissioning::CommissionError) -> bool {
    use thermal_client::commissioning::{CommissionError, SurroundingsError};
    matches!(error, CommissionError::Surroundings(SurroundingsError::Interrupted))
}

fn described(chip: Option<&str>, device: Option<&str>) -> String {
    let unknown = "not known";
    format!("microcontroller {}, firmware {}", chip.unwrap_or(unknown), device.unwrap_or(unknown))
}

const fn verdict(is_good: bool) -> Verdict {
    if is_good { Verdict::Passed } else { Verdict::Failed }
}

/// Counts of the five thermistors in the order of the converter's channels.
const fn counts(raw: &RawReadings) -> [f64; 5] {
    [raw.display, raw.check, raw.sink, raw.skin, raw.room]
}

/// Temperature by the curve of the thermistors' class, °C.
fn class_c(counts: f64) -> f64 {
    Settings::default().thermistor.temperature_c(counts * 16.0)
}
