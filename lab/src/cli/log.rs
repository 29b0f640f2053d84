//! `thermal-lab log`: telemetry as CSV.

use std::fs::File;
use std::io::{Write, stdout};
use std::path::PathBuf;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use anyhow::Context;
use clap::Args;
use thermal_client::client::{
    AvailableFields, ClientError, QueryIdentity, ReceivedTelemetry, StationRequest,
    TelemetryColumn, TickTime,
};
use thermal_client::link::{Link, LinkError};
use thermal_sim::commissioning::flux_sensor_line;

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

/// What the rows of a log depend on.
struct Table {
    /// Time of the link's zero, s.
    zero_s: f64,
    /// The fields that a finger of the device has; the columns of those that not every line has come last.
    fields: AvailableFields,
}

/// Columns before those of every line, and between them and the further ones.
const BEFORE: [&str; 8] =
    ["received_s", "tick_at_s", "tick_error_s", "lost_before", "finger", "tick", "state", "fault"];
const AFTER: [&str; 1] = ["limited"];

impl Table {
    fn header(&self) -> impl Iterator<Item = &'static str> {
        let name = |column: &'static TelemetryColumn| column.name;
        (BEFORE.into_iter())
            .chain(TelemetryColumn::default_ones().iter().map(name))
            .chain(AFTER)
            .chain(self.fields.further_columns().map(name))
    }

    /// The cells of a row; what is not known is empty.
    fn row(&self, line: &ReceivedTelemetry, time: Option<TickTime>) -> Vec<String> {
        let telemetry = &line.telemetry;
        let before = [
            format!("{:.4}", self.zero_s + line.at.as_secs_f64()),
            time.map_or(String::new(), |time| format!("{:.4}", self.zero_s + time.at_s)),
            time.map_or(String::new(), |time| format!("{:.4}", time.error_s)),
            line.lost_before.to_string(),
            line.finger.map_or(String::new(), |finger| finger.to_string()),
            telemetry.tick.to_string(),
            telemetry.state.name().into(),
            telemetry.fault().map_or("", |fault| fault.name()).into(),
        ];
        let after = [u8::from(telemetry.limited).to_string()];
        let cell = |column: &TelemetryColumn| column.text(telemetry).unwrap_or_default();
        (before.into_iter())
            .chain(TelemetryColumn::default_ones().iter().map(cell))
            .chain(after)
            .chain(self.fields.further_columns().map(cell))
            .collect()
    }
}

pub fn run(target: &Target, arguments: &Arguments) -> Result<(), Failure> {
    if let Some(path) = &arguments.out {
        arguments.kept.check(path)?;
    }
    target.with_client(|client| {
        // A simulated device has no settings; a sensor that its scene says is fitted has to be set.
        if target.simulated
            && let Some(line) = flux_sensor_line(target.simulated_setup()?.params())
        {
            client.command(&line).map_err(Failure::run)?;
        }
        let fields = available_fields(client).map_err(Failure::run)?;
        // Only now, so that a device that is not there leaves no empty file.
        let out: Box<dyn Write> = match &arguments.out {
            Some(path) => {
                let file = File::create(path).with_context(|| format!("--out {}", path.display()));
                Box::new(file.map_err(Failure::input)?)
            }
            None => Box::new(stdout()),
        };
        let mut out = csv::Writer::from_writer(out);
        // Virtual time begins with the device; real time is that of the computer.
        let zero_s = if target.simulated {
            0.0
        } else {
            let unix = SystemTime::now().duration_since(UNIX_EPOCH);
            unix.map_err(Failure::run)?.as_secs_f64() - client.link().now().as_secs_f64()
        };
        let table = Table { zero_s, fields };
        out.write_record(table.header()).map_err(Failure::run)?;
        client.ask(&fields.stream(arguments.interval)).map_err(Failure::run)?;
        let end = arguments.duration.map(|time| client.link().now() + time);
        let logged = log(client, end, &table, &mut out);
        let counts = client.counts();
        eprintln!(
            "thermal-lab: {} lines of telemetry lost, {} damaged; the device restarted {} times",
            counts.lost + counts.dropped,
            counts.damaged,
            client.clock().restarts()
        );
        match logged? {
            LogEnd::Time => client.ask(&StationRequest::stream(0)).map_err(Failure::run),
            // The bridge is switched off first.
            LogEnd::Interrupted => Ok(()),
        }
    })
}

/// What has ended a log.
enum LogEnd {
    Time,
    Interrupted,
}

/// Writes rows until a time or Ctrl-C.
fn log(
    client: &mut AnyClient<'_>,
    end: Option<Duration>,
    table: &Table,
    out: &mut csv::Writer<Box<dyn Write>>,
) -> Result<LogEnd, Failure> {
    while end.is_none_or(|end| client.link().now() < end) {
        let line = match client.next_telemetry(POLL_INTERVAL) {
            Ok(line) => line,
            Err(LinkError::Interrupted) => return Ok(LogEnd::Interrupted),
            Err(error) => return Err(Failure::run(error)),
        };
        if let Some(line) = line {
            let time = client.clock().time_of_arrived(line.telemetry.tick, line.at);
            out.write_record(table.row(&line, time)).map_err(Failure::run)?;
        }
        out.flush().context("--out").map_err(Failure::run)?;
    }
    Ok(LogEnd::Time)
}

/// The fields that any finger of the device has.
fn available_fields(client: &mut AnyClient<'_>) -> Result<AvailableFields, ClientError> {
    let identity = client.ask(&QueryIdentity)?;
    let mut has_flux_sensor = false;
    for finger in 0..identity.fingers {
        let address = (identity.fingers > 1).then_some(finger);
        has_flux_sensor = has_flux_sensor || client.flux_report(address)?.is_some();
    }
    Ok(AvailableFields::of(&identity, has_flux_sensor))
}
