//! `thermal-lab run`: a session with a participant, or with a simulated one.

use std::io::{BufReader, stderr, stdin};
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::Args;
use thermal_client::client::Client;
use thermal_client::link::{Interruptible, Link};
use thermal_lab::bench_operator::lines;
use thermal_lab::link::{LazyLink, PacedLink};
use thermal_lab::terminal_people::TerminalPeople;
use thermal_lab::watched::{Progress, Watched};
use thermal_participant::{Bench, BenchOptions};
use thermal_session::dataset::{Folder, Recorder, RecordingError};
use thermal_session::{
    DoseReached, Executor, People, Plan, Schedule, Session, SessionEnd, check_device,
    check_participant,
};
use thermal_window::{SessionView, StopFlag, Tones};

use super::participants::NewPerson;
use super::target::{attach, stop_on_signals};
use super::{Failure, Target, print_text, window};

/// Text after the options in the help.
const USAGE: &str = "\
Sessions are TOML files; those of lab/sessions/ are ready to be used and to be copied (docs/sessions.md). The data set has the
layout of BIDS, and grows by a whole trial at a time: after a crash, a power cut or a stop, --resume goes on.

  thermal-lab run lab/sessions/p5-real-and-simulated.toml --participant 01 --plan
  thermal-lab run lab/sessions/p5-real-and-simulated.toml --participant 01 --port /dev/ttyACM0 --out data
  thermal-lab run lab/sessions/p5-real-and-simulated.toml --participant 01 --simulated --headless --out data";

#[derive(Args)]
#[command(after_help = USAGE)]
pub struct Arguments {
    /// Session file
    session: PathBuf,
    /// Code of the participant, of letters and digits; never a name
    #[arg(long, value_name = "CODE")]
    participant: String,
    /// Seed of the order of the trials; with --simulated also of participant and device
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    new_person: NewPerson,
    /// Print the trials as CSV, and run nothing
    #[arg(long)]
    plan: bool,
    /// Folder of the data set, which may have data of other participants and tasks
    #[arg(long, value_name = "DIR", default_value = "data")]
    out: PathBuf,
    /// Go on with a session that was interrupted
    #[arg(long)]
    resume: bool,
    /// Without windows: plain lines at a terminal
    #[arg(long)]
    headless: bool,
    /// With --simulated: in real time, to look at it
    #[arg(long, requires = "simulated")]
    real_time: bool,
}

impl Arguments {
    /// The code with which the plan is drawn: that which the participant had when the session was begun.
    fn plan_code(&self, session: &Session) -> Result<String, Failure> {
        check_participant(&self.participant).map_err(Failure::input)?;
        if !self.resume {
            return Ok(self.participant.clone());
        }
        Folder::new(&self.out, &self.participant, &session.task).plan_code().map_err(refused)
    }
}

pub fn run(target: &Target, arguments: &Arguments) -> Result<(), Failure> {
    let session = Session::read(&arguments.session).map_err(Failure::input)?;
    let code = arguments.plan_code(&session)?;
    let plan = Plan::new(&session, &code, arguments.seed)
        .with_context(|| arguments.session.display().to_string())
        .map_err(Failure::input)?;
    let warnings = warnings(&arguments.session, &session, &plan);
    for warning in &warnings {
        eprintln!("thermal-lab: warning: {warning}");
    }
    if arguments.plan {
        return print_text(&plan.csv());
    }
    if !arguments.resume {
        arguments.new_person.check(&arguments.out, &arguments.participant, None)?;
    }
    let stop = StopFlag::default();
    stop_on_signals(&stop)?;
    let all = Run { arguments, session: &session, plan: &plan, plan_code: &code };
    if arguments.headless {
        let tones = (!target.simulated).then(Tones::start);
        let mut screen = stderr();
        let input = lines(BufReader::new(stdin()));
        let stations = session.stations.len();
        if target.simulated {
            all.run(target, &stop, &mut Progress::new(&mut screen, &stop))
        } else {
            let mut people =
                TerminalPeople::of_session(input, &mut screen, stop.clone(), tones, stations);
            all.run(target, &stop, &mut people)
        }
    } else {
        let session_view = SessionView { warnings, ..SessionView::from(&session) };
        window::show(&session.title, Some(session_view), &stop, |people| {
            all.run(target, &stop, people)
        })
    }
}

/// What the operator should know of the session of this file before its first trial.
fn warnings(file: &Path, session: &Session, plan: &Plan) -> Vec<String> {
    let finger = session.contradiction_of_finger_and_rest();
    let finger = finger.map(|why| format!("{}: {why}", file.display()));
    let dose = DoseReached::in_plan(session, plan).map(|reached| {
        let DoseReached { trial, device_finger, plan_min } = reached;
        format!(
            "if every trial takes its longest time, the skin at display {device_finger} reaches the dose by which the device \
             trips, {:.1} min (CEM43), in trial {trial}; the whole plan gives {plan_min:.2} min",
            DoseReached::LIMIT_MIN
        )
    });
    finger.into_iter().chain(dose).collect()
}

/// A folder that is not fit for the session is a wrong argument.
pub(super) fn refused(error: RecordingError) -> Failure {
    match error {
        RecordingError::Exists(_)
        | RecordingError::AlikeCode { .. }
        | RecordingError::Missing(_)
        | RecordingError::OtherFile { .. }
        | RecordingError::OtherSession { .. } => Failure::input(error),
        RecordingError::File { .. }
        | RecordingError::FileOfTrials { .. }
        | RecordingError::Unreadable { .. }
        | RecordingError::InUse(_)
        | RecordingError::Content { .. } => Failure::run(error),
    }
}

/// A device that cannot run the session is a wrong argument.
fn ended_early(end: SessionEnd) -> Failure {
    match end {
        SessionEnd::Unsuitable(_) => Failure::input(anyhow!(end)),
        SessionEnd::NotOff(_)
        | SessionEnd::Stopped
        | SessionEnd::Gone(_)
        | SessionEnd::Recording(_) => Failure::run(anyhow!(end)),
    }
}

/// What is run.
struct Run<'a> {
    arguments: &'a Arguments,
    session: &'a Session,
    plan: &'a Plan,
    /// The code with which it was drawn, and a simulated participant with it.
    plan_code: &'a str,
}

impl Run<'_> {
    /// Runs the session with these persons, or with a simulated participant whom they watch.
    fn run(
        &self,
        target: &Target,
        stop: &StopFlag,
        people: &mut dyn People,
    ) -> Result<(), Failure> {
        if target.simulated {
            let who = (self.plan_code, self.arguments.seed);
            let options = BenchOptions::of_session(self.session);
            let bench = Bench::new(self.session, self.plan, who.0, who.1, options)
                .map_err(Failure::input)?;
            let mut watched = Watched::new(bench.people(), people);
            let link: Box<dyn Link> = if self.arguments.real_time {
                Box::new(PacedLink::new(bench.link()))
            } else {
                Box::new(bench.link())
            };
            let client = Client::new(Interruptible::new(link, stop.interrupts_link()));
            return self.execute(client, &mut watched, true);
        }
        if !self.session.needs_device() {
            let link = LazyLink::new(|| Err("this session needs no device".into()));
            let client = Client::new(Interruptible::new(link, stop.interrupts_link()));
            return self.execute(client, people, false);
        }
        let link = target.open().map_err(Failure::input)?;
        let link = Interruptible::new(link, stop.interrupts_link());
        let client = attach(link)?;
        self.execute(client, people, false)
    }

    /// Runs the session at a device that is there and can run it. Nothing is written before.
    fn execute<L: Link>(
        &self,
        mut client: Client<L>,
        people: &mut dyn People,
        is_simulated: bool,
    ) -> Result<(), Failure> {
        let Self { arguments, session, plan, .. } = *self;
        let who = (arguments.participant.as_str(), arguments.seed);
        if session.needs_device() {
            let checked = check_device(&mut client, session, plan);
            if let Err(SessionEnd::Stopped) = checked {
                client.switch_off().map_err(Failure::run)?;
            }
            checked.map_err(ended_early)?;
        }
        let recorder = if arguments.resume {
            Recorder::resume(&arguments.out, session, plan, who, is_simulated)
        } else {
            Recorder::create(&arguments.out, session, plan, who, is_simulated)
        };
        let recorder = &mut recorder.map_err(refused)?;
        let commit = Some(env!("THERMAL_LAB_COMMIT")).filter(|commit| !commit.is_empty());
        recorder.program_of(commit).map_err(refused)?;
        if let Some(recorded) = recorder.differs_from(session) {
            eprintln!(
                "thermal-lab: {} differs from the recorded {} in comments or spaces only; the recorded file is used",
                arguments.session.display(),
                recorded.display()
            );
        }
        let records = recorder.records().to_vec();
        let schedule =
            Schedule::after(self.session, self.plan, &records).map_err(Failure::input)?;
        let folder = recorder.folder().clone();
        let executor = Executor::new(self.session, client, people, recorder);
        let ended = executor.run(self.plan, schedule);
        eprintln!("thermal-lab: data set: {}", folder.root().display());
        ended.map_err(ended_early)
    }
}
