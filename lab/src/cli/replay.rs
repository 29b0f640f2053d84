//! `thermal-lab replay`: a recorded session once more, on the screen.

use std::io::stderr;
use std::path::PathBuf;
use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::anyhow;
use clap::Args;
use thermal_lab::watched::Progress;
use thermal_session::People;
use thermal_session::dataset::{RecordedSession, recorded_sessions};
use thermal_window::{SessionView, StopFlag};

use super::target::stop_on_signals;
use super::{Failure, notice, window};

/// Longest time for which nothing is looked at, so that a stop is seen.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

#[derive(Args)]
pub struct Arguments {
    /// Folder of the data set
    folder: PathBuf,
    /// Code of the participant, where there are several
    #[arg(long, value_name = "CODE")]
    participant: Option<String>,
    /// Name of the task, where there are several
    #[arg(long, value_name = "TASK")]
    task: Option<String>,
    /// Number of the trial at which it begins
    #[arg(long, value_name = "N", default_value_t = 1)]
    from: u32,
    /// How many times faster than real time
    #[arg(long, value_name = "X", default_value_t = 1.0, value_parser = speed)]
    speed: f64,
    /// Without windows: a line for each trial
    #[arg(long)]
    headless: bool,
}

fn speed(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|x| (0.01..=10_000.0).contains(x));
    number.ok_or_else(|| "allowed are 0.01 to 10000".into())
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let session = chosen(arguments)?;
    let stop = StopFlag::default();
    stop_on_signals(&stop)?;
    if arguments.headless {
        let mut screen = stderr();
        return show(&session, arguments, &stop, &mut Progress::new(&mut screen, &stop));
    }
    let session_view = SessionView::from(&session.session);
    let title = format!("{} (recorded)", session.info.title);
    window::show(&title, Some(session_view), &stop, |people| {
        show(&session, arguments, &stop, people)
    })
}

/// The session that is meant.
fn chosen(arguments: &Arguments) -> Result<RecordedSession, Failure> {
    let data = recorded_sessions(&arguments.folder).map_err(Failure::input)?;
    for left_out in &data.left_out {
        notice(&format!("left out: {left_out}"));
    }
    let mut all = data.sessions;
    let is_meant =
        |wanted: &Option<String>, name: &str| wanted.as_deref().is_none_or(|word| word == name);
    all.retain(|session| {
        is_meant(&arguments.participant, session.folder.participant())
            && is_meant(&arguments.task, session.folder.task())
    });
    match all.len() {
        1 => Ok(all.remove(0)),
        _ => {
            let names = all.iter().map(|session| {
                format!(
                    "--participant {} --task {}",
                    session.folder.participant(),
                    session.folder.task()
                )
            });
            let names: Vec<_> = names.collect();
            let which = if names.is_empty() { "none" } else { &names.join(", ") };
            Err(Failure::input(anyhow!(
                "{}: one session can be replayed; these match: {which}",
                arguments.folder.display()
            )))
        }
    }
}

/// Tells what happened, in its time.
fn show(
    session: &RecordedSession,
    arguments: &Arguments,
    stop: &StopFlag,
    people: &mut dyn People,
) -> Result<(), Failure> {
    let from_s = (session.records.iter())
        .find(|record| record.trial >= arguments.from)
        .map_or(0.0, |record| record.begin_s);
    let began = Instant::now();
    for (t_s, update) in session.updates().map_err(Failure::run)? {
        if t_s < from_s {
            continue;
        }
        let due = Duration::from_secs_f64((t_s - from_s) / arguments.speed);
        while let Some(rest) = due.checked_sub(began.elapsed()).filter(|rest| !rest.is_zero()) {
            if stop.is_pressed() {
                return Ok(());
            }
            sleep(rest.min(POLL_INTERVAL));
        }
        people.inform(&update);
    }
    people.inform(&thermal_session::Update::Ended(None));
    Ok(())
}
