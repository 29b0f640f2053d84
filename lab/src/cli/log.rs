//! `thermal-lab log`: telemetry as CSV.

use std::fs::File;
use std::io::{Write, stdout};
use std::path::PathBuf;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use anyhow::Context;
use clap::Args;
use thermal_client::client::{PlainCommand, ReceivedTelemetry, TickTime};
use thermal_client::link::{Link, LinkError};

use super::target::AnyClient;
use super::{Failure, KeptFiles, Target};

/// Interval at which telemetry that does not come is looked for.
const POLL_INTERVAL: Duration = Duration::from_millis(200);

#[derive(Args)]
pub struct Arguments {
    /// Interval of the telemetry, ms
    #[arg(long, value_name = "MS", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=60_000))]
    interval: u32,
    /// Time after which the log ends, s; without it, Ctrl-C ends it and switches the bridge off
    #[arg(long, value_name = "S", value_parser = duration)]
    duration: Option<Duration>,
    /// File to write, instead of standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    kept: KeptFiles,
}

fn duration(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|s| (0.0..=1e6).contains(s));
    seconds.map(Duration::from_secs_f64).ok_or_else(|| "allowed are 0 to 1e6 s".into())
}

/// Columns of the log.
const COLUMNS: [&str; 18] = [
    "received_s",
    "tick_at_s",
    "tick_error_s",
    "lost_before",
    "finger",
    "tick",
    "state",
    "fault",
    "setpoint_c",
    "display_c",
    "sink_c",
    "skin_c",
    "room_c",
    "force_n",
    "demand_a",
    "current_a",
    "evaluations",
    "limited",
];

pub fn run(target: &Target, arguments: &Arguments) -> Result<(), Failure> {
    if let Some(path) = &arguments.out {
        arguments.kept.check(path)?;
    }
    target.with_client(|client| {
        // Only now, so that a device that is not there leaves no empty file.
        let out: Box<dyn Write> = match &arguments.out {
            Some(path) => {
                let file = File::create(path).with_context(|| format!("--out {}", path.display()));
                Box::new(file.map_err(Failure::input)?)
            }
            None => Box::new(stdout()),
        };
        let mut out = csv::Writer::from_writer(out);
        out.write_record(COLUMNS).map_err(Failure::run)?;
        // Virtual time begins with the device; real time is that of the computer.
        let zero_s = if target.simulated {
            0.0
        } else {
            let unix = SystemTime::now().duration_since(UNIX_EPOCH);
            unix.map_err(Failure::run)?.as_secs_f64() - client.link().now().as_secs_f64()
        };
        client.ask(&PlainCommand::stream(arguments.interval)).map_err(Failure::run)?;
        let end = arguments.duration.map(|time| client.link().now() + time);
        let logged = log(client, end, zero_s, &mut out);
        let counts = client.counts();
        eprintln!(
            "thermal-lab: {} lines of telemetry lost, {} damaged; the device restarted {} times",
            counts.lost + counts.dropped,
            counts.damaged,
            client.clock().restarts()
        );
        logged?;
        client.ask(&PlainCommand::stream(0)).map_err(Failure::run)
    })
}

/// Writes rows until a time or Ctrl-C.
fn log(
    client: &mut AnyClient<'_>,
    end: Option<Duration>,
    zero_s: f64,
    out: &mut csv::Writer<Box<dyn Write>>,
) -> Result<(), Failure> {
    while end.is_none_or(|end| client.link().now() < end) {
        let line = match client.next_telemetry(POLL_INTERVAL) {
            Ok(line) => line,
            Err(LinkError::Interrupted) => break,
            Err(error) => return Err(Failure::run(error)),
        };
        if let Some(line) = line {
            let time = client.clock().time_of_arrived(line.telemetry.tick, line.at);
            out.write_record(row(&line, time, zero_s)).map_err(Failure::run)?;
        }
        out.flush().context("--out").map_err(Failure::run)?;
    }
    Ok(())
}

/// The cells of a row; what is not known is empty.
fn row(line: &ReceivedTelemetry, time: Option<TickTime>, zero_s: f64) -> Vec<String> {
    let telemetry = &line.telemetry;
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    vec![
        format!("{:.4}", zero_s + line.at.as_secs_f64()),
        time.map_or(String::new(), |time| format!("{:.4}", zero_s + time.at_s)),
        time.map_or(String::new(), |time| format!("{:.4}", time.error_s)),
        line.lost_before.to_string(),
        line.finger.map_or(String::new(), |finger| finger.to_string()),
        telemetry.tick.to_string(),
        telemetry.state.name().into(),
        telemetry.fault().map_or("", |fault| fault.name()).into(),
        number(telemetry.setpoint_c),
        number(telemetry.display_c),
        number(telemetry.sink_c),
        number(telemetry.skin_c),
        number(telemetry.room_c),
        number(telemetry.force_n),
        number(telemetry.demand_a),
        number(telemetry.current_a),
        telemetry.evaluations.map_or(String::new(), |count| count.to_string()),
        u8::from(telemetry.limited).to_string(),
    ]
}
