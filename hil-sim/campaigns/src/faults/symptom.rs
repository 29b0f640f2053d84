//! Symptoms: deviations of the plant that make a fault detectable.
//!
//! They are derived from the true state of the plant: sensor outputs before the converter, force, supply and the level of the
//! fault line; and from the telemetry: demanded current, set-point, state and tick.
//!
//! The readings of a device are calibrated and noisy. Therefore the thresholds here exceed those of the device by the
//! largest error of sound sensors. A temperature counts from 0.1 K beyond the device's limit, which is more than the error
//! of a calibrated thermistor: 0.02 K from the reference thermometer, the rest from converter and curve. A difference has a
//! margin of 0.1 K between the thermistors of the display, 0.5 K between skin and room, and 0.2 K between two exchanged
//! ones. A dose is computed from readings reduced by 0.1 K, which is an eighth less at 42 °C. A deviation that must last to
//! be detectable counts from its start, if it lasts as long as the device must wait.

use serde::Deserialize;
use thermal_plant::STEP_S;
use thermal_sim::dose::cem43_rate;
use thermal_sim::trace::TraceRow;

/// A deviation that makes a fault detectable.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Symptom {
    /// The injection itself.
    Injection,
    /// A time after the injection, s.
    After(f64),
    /// The finger presses with less than this, N, for 32 ms.
    ForceBelow(f64),
    /// The readings of the display's thermistors differ by more than 3.1 K.
    DisplaySensorsDiffer,
    /// The reading of the display differs by more than 4 K from that of the fault-free run, for 40 ms; only for a tuned tile.
    DisplayDeviates,
    /// The reading of a display thermistor or of the sink changes by more than 0.7 K within 4 ms.
    ReadingJump,
    /// The reading of the room exceeds that of the skin by more than 8.5 K.
    RoomAboveSkin,
    /// The measured current differs by more than 1.05 A plus a quarter from the demand of the previous tick. A counter of such
    /// rows, decremented by other rows, reaches 32; the onset is 32 ms earlier.
    CurrentOff,
    /// The measured current exceeds 9.2 A for 2 ms; a shorter excess could be split between two ticks of the device.
    OverCurrent,
    /// The reading of the display has moved by 2.6 K against the direction of the current and away from the set-point, while
    /// both the mean demand, at least 1 A, and the present demand drive it to the set-point.
    WrongWay,
    /// A reading of the display is below 13.4 °C or above 43.1 °C.
    DisplayLimit,
    /// The reading of the sink is above 42.1 °C.
    SinkLimit,
    /// The fault line is low while current flows.
    FaultLine,
    /// The sensed supply of the bridge is outside of 10.6 to 13.4 V in a state after the self-test. A counter of such rows,
    /// decremented by other rows, reaches 12; the onset is 12 ms earlier.
    SupplyOff,
    /// The dose of the display's reading less 0.1 K reaches half a minute of CEM43.
    Dose,
    /// The age of a self-test that started after the fault, s, without its wait for a tick whose number is a multiple of
    /// 64: its test of the comparator's hot side ends at 0.02 and the pause after it at 0.04, the test of the cold side at
    /// 0.06, of the current at 0.344, of the response of the display at 0.544, and the whole at 0.744. The part after the
    /// comparator restarts one second after a finger lands or lifts, and is delayed by one second under a resting finger.
    SelfTest(f64),
}

const DIFFERENCE_K: f64 = 3.1;
/// The limit of the device is 3.75 K from its model, which is up to 0.25 K off. Its lag of 20 ms is compensated by the
/// feedback that it includes.
const DEVIATION_K: f64 = 4.0;
const DEVIATION_ROWS: usize = 40;
const JUMP_K: f64 = 0.7;
const JUMP_ROWS: usize = 4;
const ROOM_ABOVE_K: f64 = 8.5;
const OFF_A: f64 = 1.05;
const OFF_FRACTION: f64 = 0.25;
/// Two more than the debounce of the device: it samples during the whole tick and may count one tick less.
const OFF_ROWS: usize = 32;
/// The device's limits are 10.8 and 13.2 V; divider and reference are 2 % off at most.
const SUPPLY_V: std::ops::RangeInclusive<f64> = 10.6..=13.4;
/// Two more than the debounce of the device.
const SUPPLY_ROWS: usize = 12;
/// Two more than the debounce of the device.
const FORCE_ROWS: usize = 32;
const OVER_A: f64 = 9.2;
const OVER_ROWS: usize = 2;
const DIRECTED_A: f64 = 1.0;
const MEAN_S: f64 = 0.25;
const BACK_K: f64 = 2.6;
const DISPLAY_C: std::ops::RangeInclusive<f64> = 13.4..=43.1;
const SINK_C: f64 = 42.1;
const DOSE_MIN: f64 = 0.5;
const DOSE_BELOW_K: f64 = 0.1;
/// Ticks whose numbers are multiples of this begin a self-test.
const BEGIN_TICKS: u32 = 64;
/// End of the comparator's part of a self-test, and the wait after a change of contact, ms.
const COMPARATOR_MS: u32 = 80;
const UNTOUCHED_MS: u32 = 1000;

/// Indices of the thermistors.
const DISPLAY: usize = 0;
const CHECK: usize = 1;
const SINK: usize = 2;
const SKIN: usize = 3;
const ROOM: usize = 4;

fn read(row: &TraceRow, which: usize) -> Option<f64> {
    row.taken.thermistors_c[which]
}

impl Symptom {
    /// Whether it needs the run of the same scene without the fault.
    pub const fn needs_fault_free_run(self) -> bool {
        matches!(self, Self::DisplayDeviates)
    }

    /// Time of its first occurrence, s. The fault starts at the row `from`; `sound` are the rows of the fault-free run if
    /// [`Self::needs_fault_free_run`]; `tested_from_s` is the time at which a self-test is requested, if any.
    pub fn onset_s(
        self,
        rows: &[TraceRow],
        sound: &[TraceRow],
        from: usize,
        tested_from_s: Option<f64>,
    ) -> Option<f64> {
        let after = rows.get(from..)?;
        let first = |level: &dyn Fn(&TraceRow) -> bool| {
            after.iter().find(|row| level(row)).map(|row| row.t_s)
        };
        let begin_s = after.first()?.t_s;
        let end_s = after.last()?.t_s;
        match self {
            Self::Injection => Some(begin_s),
            Self::After(s) => Some(begin_s + s).filter(|t_s| *t_s <= end_s),
            Self::ForceBelow(force_n) => {
                let below = |row: &TraceRow| row.force_n < force_n;
                let lasts = after.windows(FORCE_ROWS).find(|rows| rows.iter().all(below))?;
                Some(lasts[0].t_s)
            }
            Self::DisplaySensorsDiffer => {
                first(&|row| match (read(row, DISPLAY), read(row, CHECK)) {
                    (Some(display_c), Some(check_c)) => (display_c - check_c).abs() > DIFFERENCE_K,
                    _ => false,
                })
            }
            Self::DisplayDeviates => display_deviates(after, sound.get(from..)?),
            Self::ReadingJump => reading_jump(rows, from),
            Self::RoomAboveSkin => first(&|row| match (read(row, ROOM), read(row, SKIN)) {
                (Some(room_c), Some(skin_c)) => room_c - skin_c > ROOM_ABOVE_K,
                _ => false,
            }),
            Self::CurrentOff => current_off(&rows[from.saturating_sub(1)..]),
            Self::OverCurrent => over_current(after),
            Self::WrongWay => wrong_way(after),
            Self::DisplayLimit => first(&|row| {
                let beyond = |c: f64| !DISPLAY_C.contains(&c);
                [DISPLAY, CHECK].into_iter().filter_map(|which| read(row, which)).any(beyond)
            }),
            Self::SinkLimit => first(&|row| read(row, SINK).is_some_and(|sink_c| sink_c > SINK_C)),
            // The tick of the row itself may have seen it, so the current of the row before counts.
            Self::FaultLine => (from.max(1)..rows.len())
                .find(|&i| rows[i].fault_line && rows[i - 1].current_a != 0.0)
                .map(|i| rows[i].t_s),
            Self::SupplyOff => supply_off(after),
            Self::Dose => dose(rows, from),
            Self::SelfTest(age_s) => self_test(rows, from, tested_from_s?, age_s),
        }
    }
}

fn display_deviates(rows: &[TraceRow], sound: &[TraceRow]) -> Option<f64> {
    let so_far =
        |(row, sound): (&TraceRow, &TraceRow)| match (read(row, DISPLAY), read(sound, DISPLAY)) {
            (Some(display_c), Some(sound_c)) if (display_c - sound_c).abs() > DEVIATION_K => {
                Some(row.t_s)
            }
            _ => None,
        };
    let far: Vec<_> = rows.iter().zip(sound).map(so_far).collect();
    let lasts = far.windows(DEVIATION_ROWS).find(|rows| rows.iter().all(Option::is_some))?;
    lasts[0]
}

/// Includes the start of the fault: an immediate change of a reading is a jump.
fn reading_jump(rows: &[TraceRow], from: usize) -> Option<f64> {
    (from..rows.len()).find_map(|i| {
        let before = rows.get(i.checked_sub(JUMP_ROWS)?)?;
        let jumped = [DISPLAY, CHECK, SINK].into_iter().any(|which| {
            match (read(before, which), read(&rows[i], which)) {
                (Some(before_c), Some(now_c)) => (now_c - before_c).abs() > JUMP_K,
                _ => false,
            }
        });
        jumped.then(|| rows[i].t_s)
    })
}

/// The demand is that of the telemetry; rows without telemetry count as correct. The current in a row follows the demand of
/// the row before.
fn current_off(rows: &[TraceRow]) -> Option<f64> {
    let mut wrong = 0;
    for (i, (asking, row)) in rows.iter().zip(rows.iter().skip(1)).enumerate() {
        let demand_a = asking.device.as_ref().and_then(|device| device.demand_a);
        let off = demand_a.is_some_and(|demand_a| {
            let demand_a = demand_a.abs();
            (row.taken.mirror_a - demand_a).abs() > OFF_A + OFF_FRACTION * demand_a
        });
        wrong = if off { wrong + 1 } else { usize::saturating_sub(wrong, 1) };
        if wrong >= OFF_ROWS {
            return Some(rows[i + 2 - OFF_ROWS].t_s);
        }
    }
    None
}

fn wrong_way(rows: &[TraceRow]) -> Option<f64> {
    let (mut mean_a, mut best_c) = (0.0f64, None::<f64>);
    for row in rows {
        let demand_a = row.device.as_ref().and_then(|device| device.demand_a);
        mean_a += (demand_a.unwrap_or(0.0) - mean_a) * STEP_S / MEAN_S;
        let setpoint_c = row.device.as_ref().and_then(|device| device.setpoint_c);
        let driven = |display_c: &f64| {
            let from_setpoint_k = setpoint_c.map_or(0.0, |setpoint_c| display_c - setpoint_c);
            mean_a.abs() >= DIRECTED_A
                && demand_a.unwrap_or(0.0) * mean_a > 0.0
                && from_setpoint_k * mean_a > 0.0
        };
        let Some(display_c) = read(row, DISPLAY).filter(driven) else {
            best_c = None;
            continue;
        };
        // The sign makes lower values better for both directions.
        let display_c = display_c * mean_a.signum();
        let best = best_c.map_or(display_c, |best_c| best_c.min(display_c));
        if display_c - best > BACK_K {
            return Some(row.t_s);
        }
        best_c = Some(best);
    }
    None
}

fn over_current(rows: &[TraceRow]) -> Option<f64> {
    let over = |row: &TraceRow| row.taken.mirror_a > OVER_A;
    let lasts = rows.windows(OVER_ROWS).find(|rows| rows.iter().all(over))?;
    Some(lasts[0].t_s)
}

fn supply_off(rows: &[TraceRow]) -> Option<f64> {
    let mut wrong = 0;
    for (i, row) in rows.iter().enumerate() {
        let is_tested = row.device.as_ref().is_some_and(|device| {
            matches!(device.state.name(), "ready" | "armed" | "preset" | "contact" | "stimulus")
        });
        wrong = if is_tested && !SUPPLY_V.contains(&row.supply_v) {
            wrong + 1
        } else {
            usize::saturating_sub(wrong, 1)
        };
        if wrong >= SUPPLY_ROWS {
            return Some(rows[i + 1 - SUPPLY_ROWS].t_s);
        }
    }
    None
}

fn dose(rows: &[TraceRow], from: usize) -> Option<f64> {
    let mut minutes = 0.0;
    let mut doses = rows.iter().enumerate().map(|(i, row)| {
        minutes += read(row, DISPLAY).map_or(0.0, |display_c| cem43_rate(display_c - DOSE_BELOW_K))
            * STEP_S
            / 60.0;
        (i, row.t_s, minutes)
    });
    doses.find(|(i, _, minutes)| *i >= from && *minutes >= DOSE_MIN).map(|(_, t_s, _)| t_s)
}

/// Time at which the self-test reaches an age, s, with restarts by a finger excluded; `None` if it started before the fault.
fn self_test(rows: &[TraceRow], from: usize, tested_from_s: f64, age_s: f64) -> Option<f64> {
    let begin = rows.partition_point(|row| row.t_s < tested_from_s - 1e-9);
    if begin < from {
        return None;
    }
    let (mut age_ms, mut wait_ms, mut touched) = (0, 0, false);
    let waits = |row: &&TraceRow| {
        let device = row.device.as_ref();
        device.is_some_and(|device| !device.tick.is_multiple_of(BEGIN_TICKS))
    };
    for row in rows[begin..].iter().skip_while(waits) {
        if f64::from(age_ms) * 1e-3 >= age_s - 1e-9 {
            return Some(row.t_s);
        }
        if (row.force_n > 0.0) != touched {
            touched = !touched;
            (age_ms, wait_ms) = (age_ms.min(COMPARATOR_MS), UNTOUCHED_MS);
        }
        if age_ms == COMPARATOR_MS && wait_ms > 0 {
            wait_ms -= 1;
        } else {
            age_ms += 1;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_client::client::Telemetry;
    use thermal_device::StateName;
    use thermal_sim::World;
    use thermal_sim::scene::Scene;

    /// One row per millisecond for 4 s, each changed by `at`.
    fn rows(at: impl Fn(f64, &mut TraceRow, &mut Telemetry)) -> Vec<TraceRow> {
        let text = "duration_s = 1\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"copper\"\n";
        let scene = Scene::parse(text, "rows".as_ref()).expect("a scene");
        let world = World::new(&scene).expect("a plant");
        let row = |ms: u32| {
            let mut row = TraceRow::capture(f64::from(ms) / 1e3, world.plant(), None);
            let mut device = Telemetry::parse("T 0 armed - - - - - - - - 0 -").expect("telemetry");
            at(row.t_s, &mut row, &mut device);
            row.device = Some(device);
            row
        };
        (0..4000).map(row).collect()
    }

    fn about(onset_s: Option<f64>, expected_s: f64) {
        let off_s = onset_s.map(|onset_s| (onset_s - expected_s).abs());
        assert!(off_s.is_some_and(|off_s| off_s < 2e-3), "{onset_s:?}, not {expected_s} s");
    }

    /// A force that is low for less than the device waits is no sign, and one that lasts counts from its start.
    #[test]
    fn a_low_force_counts_from_its_start_if_it_lasts() {
        let with = |force_n: fn(f64) -> f64| rows(move |t_s, row, _| row.force_n = force_n(t_s));
        let onset = |rows: &[TraceRow]| Symptom::ForceBelow(9.2).onset_s(rows, &[], 1000, None);
        about(onset(&with(|t_s| if t_s < 2.0 { 9.8 } else { 9.0 })), 2.0);
        about(onset(&with(|_| 0.0)), 1.0);
        let short = with(|t_s| if (1.5..1.53).contains(&t_s) { 0.0 } else { 9.8 });
        assert_eq!(onset(&short), None);
    }

    /// A finger adds a second to the parts after the first 80 ms.
    #[test]
    fn a_finger_delays_the_self_test() {
        let with_finger_from = |from_s: f64| {
            rows(move |t_s, row, device| {
                row.force_n = if t_s >= from_s { 2.0 } else { 0.0 };
                device.state = if t_s >= 1.0 { StateName::SelfTest } else { StateName::Off };
            })
        };
        for (from_s, age_s, expected_s) in [
            (9.0, 0.02, 1.02),
            (9.0, 0.304, 1.304),
            (0.0, 0.02, 1.02),
            (0.0, 0.304, 2.304),
            (1.2, 0.304, 1.2 + 1.0 + 0.224),
        ] {
            about(
                Symptom::SelfTest(age_s).onset_s(&with_finger_from(from_s), &[], 500, Some(1.0)),
                expected_s,
            );
        }
        let rows = with_finger_from(0.0);
        assert_eq!(
            Symptom::SelfTest(0.02).onset_s(&rows, &[], 1100, Some(1.0)),
            None,
            "the fault came later"
        );
    }

    /// A reading that rises by 2 K/s from 2 s on, while 6 A cool until `turns_s`.
    fn rising(setpoint_c: f64, turns_s: f64) -> Vec<TraceRow> {
        rows(move |t_s, row, device| {
            row.taken.thermistors_c[DISPLAY] = Some(24.0 + 2.0 * (t_s - 2.0).max(0.0));
            device.setpoint_c = Some(setpoint_c);
            device.demand_a = Some(if t_s < turns_s { 6.0 } else { -6.0 });
        })
    }

    #[test]
    fn the_wrong_way_is_away_from_the_set_point_and_against_the_current() {
        about(Symptom::WrongWay.onset_s(&rising(20.0, 9.0), &[], 500, None), 2.0 + 2.6 / 2.0);
        assert_eq!(Symptom::WrongWay.onset_s(&rising(30.0, 9.0), &[], 500, None), None);
        assert_eq!(Symptom::WrongWay.onset_s(&rising(20.0, 2.1), &[], 500, None), None);
    }

    /// The current alternates from tick to tick and follows the demand one tick later.
    #[test]
    fn a_current_is_compared_with_the_demand_of_the_previous_tick() {
        let swings = |t_s: f64| {
            if (t_s * 1e3).round() % 2.0 < 1.0 { 6.0 } else { -2.0 }
        };
        let until = |end_s: f64| {
            rows(move |t_s, row, device| {
                let demand_a: f64 = swings(t_s - 1e-3);
                row.taken.mirror_a = if t_s < end_s { demand_a.abs() } else { 0.0 };
                device.demand_a = Some(swings(t_s));
            })
        };
        assert_eq!(Symptom::CurrentOff.onset_s(&until(9.0), &[], 500, None), None);
        for from in [500, 2000] {
            assert_eq!(Symptom::CurrentOff.onset_s(&until(2.0), &[], from, None), Some(2.0));
        }
    }

    /// One second at 47 °C equals 16 s at 43 °C, so half a minute takes 1.875 s.
    #[test]
    fn the_dose_is_that_of_the_reading_less_a_tenth_of_a_kelvin() {
        let warm = rows(|t_s, row, _| {
            row.taken.thermistors_c[DISPLAY] = Some(if t_s < 1.0 { 30.0 } else { 47.1 });
        });
        about(Symptom::Dose.onset_s(&warm, &[], 500, None), 1.0 + 1.875);
    }
}
