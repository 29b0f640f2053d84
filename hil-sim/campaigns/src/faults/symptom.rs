//! Deviations of the plant from which on a fault can be noticed.
//!
//! All are told from the plant's truth: what the thermistors read and the mirror shows before the converter, the level of
//! the fault line, and the current that the device says it asks for.
//!
//! What a device compares has been calibrated and has noise. So a temperature counts here from 0.1 K beyond the device's
//! limit on, which is more than a calibrated thermistor is off: its thermometer is off by 0.02 K at most, the rest is
//! converter and curve. A difference counts from what two sensors are apart when they are sound: 0.1 K of the display's,
//! 0.5 K of skin and room, 0.2 K of two that are exchanged. A dose is one that the device has counted even if it reads 0.1 K
//! too little: at 42 °C that is an eighth of it. A deviation that takes its time counts from its begin, if it lasts for as
//! long as a device must wait to tell it from what a sound one does.

use thermal_plant::STEP_S;
use thermal_sim::dose::cem43_rate;
use thermal_sim::trace::TraceRow;

/// A deviation that counts as detectable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Symptom {
    /// From the injection on.
    Injection,
    /// So long after it, s.
    After(f64),
    /// The display's thermistors read 3.1 K apart.
    DisplaySensorsDiffer,
    /// The display's thermistor reads 4 K more or less than in the same scene without the fault, for 40 ms; where the
    /// tile was tuned.
    DisplayDeviates,
    /// Display, its second thermistor or the sink reads 0.7 K more or less than 4 ms before.
    ReadingJump,
    /// The room reads 8.5 K more than the skin.
    RoomAboveSkin,
    /// The mirror shows a current that is off by more than 1.05 A and a quarter of what was asked for a tick before, for 32 ms
    /// more than not; from 32 ms before that.
    CurrentOff,
    /// The mirror shows more than 9.2 A, for 2 ms: what is shorter may be half in one of the device's ticks and half in the next.
    OverCurrent,
    /// The display's thermistor has gone back by 2.6 K, farther from the set-point, while a mean of 1 A drove it there, and the
    /// current that is asked for still does. What follows a current that has turned, or goes to the set-point from the other
    /// side as the current eases off, is no deviation.
    WrongWay,
    /// A thermistor of the display reads less than 13.4 or more than 43.1 °C.
    DisplayLimit,
    /// That of the sink reads more than 42.1 °C.
    SinkLimit,
    /// The fault line gets low while current flows.
    FaultLine,
    /// Half a minute of CEM43 by what the display's thermistor reads, less 0.1 K.
    Dose,
    /// The self-test, which the host asks for with the fault there, is so old, s: the comparator's part is through at 0.02, the current's at
    /// 0.304, the display's answer at 0.504, all at 0.704. What follows the comparator's part begins anew a second after a
    /// finger lands or lifts, and a second later with one that rests.
    SelfTest(f64),
}

const APART_K: f64 = 3.1;
/// The device's limit is 3.75 K from a model that is up to a quarter of a kelvin off; for what its lag of 20 ms costs the feedback that it
/// counts makes up.
const ASTRAY_K: f64 = 4.0;
const ASTRAY_ROWS: usize = 40;
const JUMP_K: f64 = 0.7;
const JUMP_ROWS: usize = 4;
const ROOM_ABOVE_K: f64 = 8.5;
const OFF_A: f64 = 1.05;
const OFF_PART: f64 = 0.25;
/// Two more than the device waits for, which samples all through a tick: what is just as long may be one less to it.
const OFF_ROWS: usize = 32;
const OVER_A: f64 = 9.2;
const OVER_ROWS: usize = 2;
const DIRECTED_A: f64 = 1.0;
const MEAN_S: f64 = 0.25;
const BACK_K: f64 = 2.6;
const DISPLAY_C: std::ops::RangeInclusive<f64> = 13.4..=43.1;
const SINK_C: f64 = 42.1;
const DOSE_MIN: f64 = 0.5;
const DOSE_BELOW_K: f64 = 0.1;
/// End of the comparator's part of a self-test, and what it waits for after a finger, ms.
const COMPARATOR_MS: u32 = 40;
const UNTOUCHED_MS: u32 = 1000;

/// Places among the thermistors.
const DISPLAY: usize = 0;
const CHECK: usize = 1;
const SINK: usize = 2;
const SKIN: usize = 3;
const ROOM: usize = 4;

fn read(row: &TraceRow, which: usize) -> Option<f64> {
    row.taken.thermistors_c[which]
}

impl Symptom {
    /// It is told from the same scene without the fault.
    #[must_use]
    pub const fn needs_fault_free_run(self) -> bool {
        matches!(self, Self::DisplayDeviates)
    }

    /// When it is reached first, s; `from` is the row at which the fault begins, `sound` the rows without it if
    /// [`Self::needs_fault_free_run`], and `tested_from_s` when the device is told to test itself, if it is.
    #[must_use]
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
            Self::DisplaySensorsDiffer => {
                first(&|row| match (read(row, DISPLAY), read(row, CHECK)) {
                    (Some(display_c), Some(check_c)) => (display_c - check_c).abs() > APART_K,
                    _ => false,
                })
            }
            Self::DisplayDeviates => astray(after, sound.get(from..)?),
            Self::ReadingJump => jump(rows, from),
            Self::RoomAboveSkin => first(&|row| match (read(row, ROOM), read(row, SKIN)) {
                (Some(room_c), Some(skin_c)) => room_c - skin_c > ROOM_ABOVE_K,
                _ => false,
            }),
            Self::CurrentOff => current_off(&rows[from.saturating_sub(1)..]),
            Self::OverCurrent => over_current(after),
            Self::WrongWay => wrong_way(after),
            Self::DisplayLimit => first(&|row| {
                let beyond = |c: f64| !DISPLAY_C.contains(&c);
                [DISPLAY, CHECK]
                    .into_iter()
                    .filter_map(|which| read(row, which))
                    .any(beyond)
            }),
            Self::SinkLimit => first(&|row| read(row, SINK).is_some_and(|sink_c| sink_c > SINK_C)),
            // By the row's own tick the device may have seen it.
            Self::FaultLine => (from.max(1)..rows.len())
                .find(|&i| rows[i].fault_line && rows[i - 1].current_a != 0.0)
                .map(|i| rows[i].t_s),
            Self::Dose => dose(rows, from),
            Self::SelfTest(age_s) => self_test(rows, from, tested_from_s?, age_s),
        }
    }
}

fn astray(rows: &[TraceRow], sound: &[TraceRow]) -> Option<f64> {
    let so_far =
        |(row, sound): (&TraceRow, &TraceRow)| match (read(row, DISPLAY), read(sound, DISPLAY)) {
            (Some(display_c), Some(sound_c)) if (display_c - sound_c).abs() > ASTRAY_K => {
                Some(row.t_s)
            }
            _ => None,
        };
    let far: Vec<_> = rows.iter().zip(sound).map(so_far).collect();
    let lasts = far
        .windows(ASTRAY_ROWS)
        .find(|rows| rows.iter().all(Option::is_some))?;
    lasts[0]
}

/// Begin of the fault included: what it does to a reading at once is a jump.
fn jump(rows: &[TraceRow], from: usize) -> Option<f64> {
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

/// The device's own words tell what it asks for; while it says nothing nothing is told.
/// What flows in a row was asked for in the one before.
fn current_off(rows: &[TraceRow]) -> Option<f64> {
    let mut wrong = 0;
    for (i, (asking, row)) in rows.iter().zip(rows.iter().skip(1)).enumerate() {
        let asked_a = asking.device.as_ref().and_then(|device| device.demand_a);
        let off = asked_a.is_some_and(|asked_a| {
            let asked_a = asked_a.abs();
            (row.taken.mirror_a - asked_a).abs() > OFF_A + OFF_PART * asked_a
        });
        wrong = if off {
            wrong + 1
        } else {
            usize::saturating_sub(wrong, 1)
        };
        if wrong >= OFF_ROWS {
            return Some(rows[i + 2 - OFF_ROWS].t_s);
        }
    }
    None
}

fn wrong_way(rows: &[TraceRow]) -> Option<f64> {
    let (mut mean_a, mut best_c) = (0.0f64, None::<f64>);
    for row in rows {
        let asked_a = row.device.as_ref().and_then(|device| device.demand_a);
        mean_a += (asked_a.unwrap_or(0.0) - mean_a) * STEP_S / MEAN_S;
        let setpoint_c = row.device.as_ref().and_then(|device| device.setpoint_c);
        let driven = |display_c: &f64| {
            let from_setpoint_k = setpoint_c.map_or(0.0, |setpoint_c| display_c - setpoint_c);
            mean_a.abs() >= DIRECTED_A
                && asked_a.unwrap_or(0.0) * mean_a > 0.0
                && from_setpoint_k * mean_a > 0.0
        };
        let Some(display_c) = read(row, DISPLAY).filter(driven) else {
            best_c = None;
            continue;
        };
        // Mirrored, so that lower is better.
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

fn dose(rows: &[TraceRow], from: usize) -> Option<f64> {
    let mut minutes = 0.0;
    let mut doses = rows.iter().enumerate().map(|(i, row)| {
        minutes += read(row, DISPLAY).map_or(0.0, |display_c| cem43_rate(display_c - DOSE_BELOW_K))
            * STEP_S
            / 60.0;
        (i, row.t_s, minutes)
    });
    doses
        .find(|(i, _, minutes)| *i >= from && *minutes >= DOSE_MIN)
        .map(|(_, t_s, _)| t_s)
}

/// When the self-test is so old, s, landings and what they add left out, if it begins with the fault there.
fn self_test(rows: &[TraceRow], from: usize, tested_from_s: f64, age_s: f64) -> Option<f64> {
    let begin = rows.partition_point(|row| row.t_s < tested_from_s - 1e-9);
    if begin < from {
        return None;
    }
    let (mut age_ms, mut wait_ms, mut touched) = (0, 0, false);
    for row in &rows[begin..] {
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
    use thermal_sim::World;
    use thermal_sim::scene::Scene;
    use thermal_sim::telemetry::Telemetry;

    /// A row each millisecond for 4 s; `at` makes of it what it shall be.
    fn rows(at: impl Fn(f64, &mut TraceRow, &mut Telemetry)) -> Vec<TraceRow> {
        let text = "duration_s = 1\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"copper\"\n";
        let scene = Scene::parse(text, "rows".as_ref()).expect("a scene");
        let world = World::new(&scene).expect("a plant");
        let row = |ms: u32| {
            let mut row = TraceRow::capture(f64::from(ms) / 1e3, world.plant(), None);
            let mut device = Telemetry::parse("T 1 armed - - - - - - - - 0 -").expect("telemetry");
            at(row.t_s, &mut row, &mut device);
            row.device = Some(device);
            row
        };
        (0..4000).map(row).collect()
    }

    fn about(onset_s: Option<f64>, expected_s: f64) {
        let off_s = onset_s.map(|onset_s| (onset_s - expected_s).abs());
        assert!(
            off_s.is_some_and(|off_s| off_s < 2e-3),
            "{onset_s:?}, not {expected_s} s"
        );
    }

    /// Parts at 20, 304, 504 and 704 ms; a finger adds a second to what follows the first 40 ms.
    #[test]
    fn a_self_test_is_as_old_as_a_finger_lets_it_be() {
        let with_finger_from = |from_s: f64| {
            rows(move |t_s, row, device| {
                row.force_n = if t_s >= from_s { 2.0 } else { 0.0 };
                device.state = if t_s >= 1.0 { "self-test" } else { "off" }.into();
            })
        };
        for (from_s, age_s, expected_s) in [
            (9.0, 0.02, 1.02),
            (9.0, 0.304, 1.304),
            (0.0, 0.02, 1.02),
            (0.0, 0.304, 2.304),
            (1.2, 0.304, 1.2 + 1.0 + 0.264),
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
    fn a_display_goes_the_wrong_way_only_from_its_set_point_and_against_the_current() {
        about(
            Symptom::WrongWay.onset_s(&rising(20.0, 9.0), &[], 500, None),
            2.0 + 2.6 / 2.0,
        );
        assert_eq!(
            Symptom::WrongWay.onset_s(&rising(30.0, 9.0), &[], 500, None),
            None
        );
        assert_eq!(
            Symptom::WrongWay.onset_s(&rising(20.0, 2.1), &[], 500, None),
            None
        );
    }

    /// A current that swings from tick to tick flows a tick after it was asked for.
    #[test]
    fn a_current_is_off_from_what_was_asked_for_in_the_tick_before() {
        let swings = |t_s: f64| {
            if (t_s * 1e3).round() % 2.0 < 1.0 {
                6.0
            } else {
                -2.0
            }
        };
        let until = |end_s: f64| {
            rows(move |t_s, row, device| {
                let asked_a: f64 = swings(t_s - 1e-3);
                row.taken.mirror_a = if t_s < end_s { asked_a.abs() } else { 0.0 };
                device.demand_a = Some(swings(t_s));
            })
        };
        assert_eq!(
            Symptom::CurrentOff.onset_s(&until(9.0), &[], 500, None),
            None
        );
        for from in [500, 2000] {
            assert_eq!(
                Symptom::CurrentOff.onset_s(&until(2.0), &[], from, None),
                Some(2.0)
            );
        }
    }

    /// A second at 47 °C is worth 16 at 43 °C: half a minute takes 1.875 s.
    #[test]
    fn a_dose_is_counted_from_a_tenth_of_a_kelvin_less() {
        let warm = rows(|t_s, row, _| {
            row.taken.thermistors_c[DISPLAY] = Some(if t_s < 1.0 { 30.0 } else { 47.1 });
        });
        about(Symptom::Dose.onset_s(&warm, &[], 500, None), 1.0 + 1.875);
    }
}
