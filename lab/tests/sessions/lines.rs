//! The executor on a line that breaks, and on one with garbage.

use std::collections::VecDeque;
use std::fs;
use std::path::Path;
use std::time::Duration;

use serde_json::Value;
use thermal_client::client::Client;
use thermal_lab::link::{Link, LinkError, ReceivedLine};
use thermal_participant::{Bench, BenchOptions};
use thermal_session::dataset::{Entry, Folder, Recorder, recorded_sessions};
use thermal_session::{Executor, Phase, Plan, Schedule, Session, SessionEnd, Update};

use crate::folder::{assert_equal, with_session, with_skin_sensors};

const WHO: (&str, u64) = ("01", 1);

/// What a line does to a session.
#[derive(Clone, Copy)]
enum Defect {
    None,
    /// The cable is pulled at this time.
    Pulled(Duration),
    /// Every so many lines a line of garbage comes before one.
    Garbage(u32),
    /// The computer stands still from the first time on, for the second one: lines come in and wait, and nothing is sent.
    Frozen(Duration, Duration),
}

/// The line of a bench with a defect.
struct DefectiveLink<L> {
    link: L,
    defect: Defect,
    lines: u32,
    waiting: VecDeque<ReceivedLine>,
}

impl<L: Link> DefectiveLink<L> {
    fn new(link: L, defect: Defect) -> Self {
        Self { link, defect, lines: 0, waiting: VecDeque::new() }
    }

    fn freeze(&mut self, time: Duration) -> Result<(), LinkError> {
        let end = self.now() + time;
        while self.now() < end {
            let line = self.link.receive(end - self.now())?;
            // The program sees them when it runs again.
            self.waiting.extend(line.map(|line| ReceivedLine { at: end, ..line }));
        }
        Ok(())
    }
}

impl<L: Link> Link for DefectiveLink<L> {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.link.send(bytes)
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        if let Defect::Pulled(at) = self.defect
            && self.now() >= at
        {
            return Err(LinkError::Gone("the cable was pulled".into()));
        }
        if let Defect::Frozen(at, time) = self.defect
            && self.now() >= at
        {
            self.defect = Defect::None;
            self.freeze(time)?;
        }
        if let Some(line) = self.waiting.pop_front() {
            return Ok(Some(line));
        }
        let received = self.link.receive(timeout)?;
        if let (Defect::Garbage(interval), Some(line)) = (self.defect, &received) {
            self.lines += 1;
            if self.lines.is_multiple_of(interval) {
                let garbage = ReceivedLine { text: "\u{fffd}T 12\u{0}3 arm".into(), at: line.at };
                self.waiting.extend(received);
                return Ok(Some(garbage));
            }
        }
        Ok(received)
    }

    fn now(&self) -> Duration {
        self.link.now()
    }
}

/// Runs or resumes the session, and returns how it has ended.
fn run(session: &Path, out: &Path, resumes: bool, defect: Defect) -> Result<(), SessionEnd> {
    run_at(session, out, resumes, defect, BenchOptions::default())
}

/// The same at a bench with these options.
fn run_at(
    session: &Path,
    out: &Path,
    resumes: bool,
    defect: Defect,
    options: BenchOptions,
) -> Result<(), SessionEnd> {
    let session = Session::read(session).unwrap();
    let plan = Plan::new(&session, WHO.0, WHO.1).unwrap();
    let mut recorder = if resumes {
        Recorder::resume(out, &session, &plan, WHO, true).unwrap()
    } else {
        Recorder::create(out, &session, &plan, WHO, true).unwrap()
    };
    let records = recorder.records().to_vec();
    let schedule = Schedule::after(&session, &plan, &records).unwrap();
    let bench = Bench::new(&session, &plan, WHO.0, WHO.1, options).unwrap();
    let link = DefectiveLink::new(bench.link(), defect);
    let mut people = bench.people();
    Executor::new(&session, Client::new(link), &mut people, &mut recorder).run(&plan, schedule)
}

#[test]
fn a_pulled_cable_ends_the_session_and_loses_the_running_trial_only() {
    for (folder, session) in [with_session("pulled"), with_skin_sensors("pulled-skin")] {
        pull_and_resume(&folder, &session);
    }
}

fn pull_and_resume(folder: &Path, session: &Path) {
    let [whole, pulled] = ["whole", "pulled"].map(|name| folder.join(name));
    run(session, &whole, false, Defect::None).unwrap();
    let end = run(session, &pulled, false, Defect::Pulled(Duration::from_secs(30))).unwrap_err();
    let words = end.to_string();
    assert!(matches!(end, SessionEnd::Gone(_)), "{words}");
    assert!(words.contains("Check cable and power") && words.contains("--resume"), "{words}");
    run(session, &pulled, true, Defect::None).unwrap();
    assert_equal(&whole, &pulled);
}

#[test]
fn garbage_between_the_lines_changes_no_answer() {
    let (folder, session) = with_session("garbage");
    let [whole, garbage] = ["whole", "garbage"].map(|name| folder.join(name));
    run(&session, &whole, false, Defect::None).unwrap();
    run(&session, &garbage, false, Defect::Garbage(7)).unwrap();
    // A line of garbage ends a wait, so times differ by a look at the keys; what was presented and answered does not.
    let trials = |folder: &Path| -> Vec<_> {
        let sessions = recorded_sessions(folder).unwrap().sessions;
        let records = sessions[0].records.iter();
        records
            .map(|record| {
                (record.trial, record.void.clone(), record.levels.clone(), record.answer.clone())
            })
            .collect()
    };
    assert_eq!(trials(&whole).len(), 8);
    assert_eq!(trials(&whole), trials(&garbage));
}

/// Without it the columns are those that data sets always had.
#[test]
fn a_heat_flux_sensor_is_in_the_telemetry_of_a_session_and_in_its_physiological_recording() {
    const ALWAYS: &str = "t_s,finger,tick,state,setpoint_c,display_c,sink_c,skin_c,room_c,force_n,demand_a,current_a,\
                          evaluations,remark";
    let (folder, session) = with_session("flux");
    for (has_flux_sensor, header, columns) in [
        (false, format!("{ALWAYS},check_c"), 11),
        (true, format!("{ALWAYS},flux_w_m2,surface_c,known,check_c"), 14),
    ] {
        let out = folder.join(format!("sensor-{has_flux_sensor}"));
        let options = BenchOptions { has_flux_sensor, ..BenchOptions::default() };
        // The cable is pulled between, and the columns go on.
        let pulled = Defect::Pulled(Duration::from_secs(60));
        run_at(&session, &out, false, pulled, options.clone()).unwrap_err();
        run_at(&session, &out, true, Defect::None, options).unwrap();
        let text =
            fs::read_to_string(Folder::new(&out, "01", "p5").source("telemetry.csv")).unwrap();
        assert_eq!(text.lines().next(), Some(&*header));
        assert!(text.lines().all(|line| line.split(',').count() == header.split(',').count()));
        let physio = out.join("sub-01/beh/sub-01_task-p5_recording-finger0_physio.json");
        let about: Value = serde_json::from_slice(&fs::read(physio).unwrap()).unwrap();
        assert_eq!(about["Columns"].as_array().unwrap().len(), columns);
        let recorded = &recorded_sessions(&out).unwrap().sessions[0];
        let fluxes_w_m2: Vec<f64> = (recorded.updates().unwrap().iter())
            .filter_map(|(_, update)| match update {
                Update::Telemetry(line) if line.telemetry.force_n? > 0.5 => {
                    line.telemetry.flux_w_m2
                }
                _ => None,
            })
            .collect();
        // Skin at 34 C on copper or ABS at 24 C: 10 K over more than 1e-3 m2K/W of skin and contact.
        let largest_w_m2 = fluxes_w_m2.iter().copied().reduce(f64::max);
        assert_eq!(largest_w_m2.is_some(), has_flux_sensor);
        assert!(largest_w_m2.is_none_or(|flux| (1e3..1e4).contains(&flux)), "{largest_w_m2:?}");
    }
}

/// With one attempt at each trial. The first trial begins soon after zero; its phases are those of the undisturbed session.
#[test]
fn a_computer_that_stands_still_before_anything_is_presented_uses_up_no_attempt() {
    let (folder, session) = with_session("frozen");
    let text = fs::read_to_string(&session).unwrap();
    assert!(!text.contains("attempts_max"));
    fs::write(&session, text.replace("[void]\n", "[void]\nattempts_max = 1\n")).unwrap();
    let options = || BenchOptions { keeps_device: true, ..BenchOptions::default() };
    let whole = folder.join("whole");
    run_at(&session, &whole, false, Defect::None, options()).unwrap();
    let recorded = &recorded_sessions(&whole).unwrap().sessions[0];
    let begin_s = |wanted: Phase| {
        let mut log = recorded.log.iter();
        let found = log.find(|line| line.entry == Entry::Update(Update::Phase(wanted)));
        found.unwrap().t_s
    };
    for (phase, counts) in [
        (Phase::Rest, false),
        (Phase::Prepare, false),
        (Phase::Reach, false),
        (Phase::Contact, true),
    ] {
        let frozen = folder.join(phase.name());
        // The link's clock is ahead of the session's by the time in which the device is asked who it is.
        let at = Duration::from_secs_f64(begin_s(phase) + 0.5);
        let defect = Defect::Frozen(at, Duration::from_secs(5));
        run_at(&session, &frozen, false, defect, options()).unwrap();
        let recorded = &recorded_sessions(&frozen).unwrap().sessions[0];
        let voids: Vec<_> =
            recorded.records.iter().filter_map(|record| record.void.clone()).collect();
        assert_eq!(voids.len(), 1, "{phase:?}: {voids:?}");
        let s: f64 = voids[0].split(' ').find_map(|word| word.parse().ok()).unwrap();
        assert!(
            voids[0].starts_with("the computer stood still") && (4.9..5.1).contains(&s),
            "{voids:?}"
        );
        assert_eq!(recorded.counted().count(), 8 - usize::from(counts), "{phase:?}: {voids:?}");
    }
}
