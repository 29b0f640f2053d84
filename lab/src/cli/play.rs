//! `thermal-lab play`: a course from a CSV file on the device.

use std::path::PathBuf;
use std::time::Duration;

use anyhow::anyhow;
use clap::Args;
use serde_json::json;
use thermal_client::client::{QueryState, StationRequest};
use thermal_client::course::{Prepared, Selection, read_course};
use thermal_device::StateName;
use thermal_device::stimulus::{CourseEnd, CourseStart, PlayOrder};

use super::target::AnyClient;
use super::{Failure, Target, print};
use thermal_device::Vocabulary as _;

/// Interval at which the state is asked for while the self-test runs, and how many times it is at most: 5 s.
const STATE_POLL_INTERVAL: Duration = Duration::from_millis(100);
const STATE_POLLS_MAX: u32 = 50;
/// Interval of the stream that guards the arming, ms: so long that no line of telemetry comes of it.
const GUARD_STREAM_MS: u32 = 60_000;

#[derive(Args)]
pub struct Arguments {
    /// CSV of two columns, t_s and celsius; or a trace.csv, which is played from landing to lift
    course: PathBuf,
    /// Column of a trace that is played [default: celsius, or display_c]
    #[arg(long, value_name = "NAME")]
    column: Option<String>,
    /// When it begins; until then the display waits on its first point
    #[arg(long, value_parser = start, default_value = "landing")]
    at: CourseStart,
    /// Number of times it is played
    #[arg(long, value_name = "N", default_value_t = 1)]
    repeats: u16,
    /// Play it even if the device's points are more than 5 mK off
    #[arg(long)]
    coarse: bool,
    /// Arm the device first, which drives the display to skin temperature
    #[arg(long)]
    arm: bool,
    /// Finger of a device with five
    #[arg(long)]
    finger: Option<u8>,
    /// Print the points and their error as one JSON object
    #[arg(long)]
    json: bool,
}

/// What begins a course, by its word in the protocol.
fn start(word: &str) -> Result<CourseStart, String> {
    CourseStart::of_word(word)
        .ok_or_else(|| format!("one of {} is allowed", CourseStart::WORDS.words.join(", ")))
}

/// Uploads the course to a device that is armed, and starts it.
pub fn run(target: &Target, arguments: &Arguments) -> Result<(), Failure> {
    let selection = Selection { column: arguments.column.as_deref() };
    let file = read_course(&arguments.course, selection).map_err(Failure::input)?;
    let played =
        Prepared::new(file, arguments.coarse, arguments.repeats).map_err(Failure::input)?;
    let order =
        PlayOrder { start: arguments.at, play_count: arguments.repeats, end: CourseEnd::Hold };
    target.with_client(|client| {
        if arguments.arm {
            // A stream makes the device trip if this program vanishes before the course has begun.
            let guard = StationRequest::stream(GUARD_STREAM_MS);
            (client.ask_finger(arguments.finger, &guard)).map_err(Failure::run)?;
            arm(client, arguments.finger)?;
        }
        for line in &played.points.upload_lines() {
            (client.ask_finger(arguments.finger, line)).map_err(Failure::run)?;
        }
        let play = StationRequest::Play { order };
        (client.ask_finger(arguments.finger, &play)).map_err(Failure::run)?;
        if arguments.arm {
            let no_stream = StationRequest::stream(0);
            (client.ask_finger(arguments.finger, &no_stream)).map_err(Failure::run)?;
        }
        let points = played.points.points().len();
        let error_mk = played.error_k * 1e3;
        if arguments.json {
            let answer = json!({ "points": points, "reduction_error_mk": error_mk, "at": arguments.at.name() });
            return print(&answer.to_string());
        }
        print(&format!(
            "{points} points, reduction error {error_mk:.2} mK, begins at: {}",
            arguments.at.name()
        ))
    })
}

/// Arms the device, and waits for the end of its self-test.
fn arm(client: &mut AnyClient<'_>, finger: Option<u8>) -> Result<(), Failure> {
    (client.ask_finger(finger, &StationRequest::Arm)).map_err(Failure::run)?;
    for _ in 0..STATE_POLLS_MAX {
        let status = client.ask_finger(finger, &QueryState).map_err(Failure::run)?;
        match status.state {
            StateName::Armed => return Ok(()),
            StateName::Tripped(_) => break,
            _ => client.wait(STATE_POLL_INTERVAL).map_err(Failure::run)?,
        }
    }
    Err(Failure::run(anyhow!("the device is not armed; `thermal-lab info` says why")))
}
