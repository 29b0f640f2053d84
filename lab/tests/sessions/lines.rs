//! The executor on a line that breaks, and on one with garbage.

use std::fs;
use std::path::Path;
use std::time::Duration;

use serde_json::Value;
use thermal_client::client::Client;
use thermal_lab::link::{Link, LinkError, ReceivedLine};
use thermal_participant::{Bench, BenchOptions};
use thermal_session::dataset::{Folder, Recorder, recorded_sessions};
use thermal_session::{Executor, Plan, Schedule, Session, SessionEnd, Update};

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
}

/// The line of a bench with a defect.
struct DefectiveLink<L> {
    link: L,
    defect: Defect,
    lines: u32,
    waiting: Option<ReceivedLine>,
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
        if self.waiting.is_some() {
            return Ok(self.waiting.take());
        }
        let received = self.link.receive(timeout)?;
        if let (Defect::Garbage(interval), Some(line)) = (self.defect, &received) {
            self.lines += 1;
            if self.lines.is_multiple_of(interval) {
                let garbage = ReceivedLine { text: "\u{fffd}T 12\u{0}3 arm".into(), at: line.at };
                self.waiting = received;
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
    let link = DefectiveLink { link: bench.link(), defect, lines: 0, waiting: None };
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
    for (has_flux_sensor, header, columns) in
        [(false, ALWAYS.to_owned(), 10), (true, format!("{ALWAYS},flux_w_m2,surface_c,known"), 13)]
    {
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
