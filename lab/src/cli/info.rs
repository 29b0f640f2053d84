//! `thermal-lab info`: what the device is, and how it is.

use clap::Args;
use serde_json::{Map, Value};
use thermal_client::client::{
    ClientError, Command, QueryBoard, QueryCause, QueryFlux, QueryIdentity, QueryMargins, QueryRaw,
    QuerySelfTest, QueryState,
};
use thermal_client::commissioning::settings;

use super::target::AnyClient;
use super::{Failure, Target, print};

#[derive(Args)]
pub struct Arguments {
    /// The finger, on a device with several
    #[arg(long, value_name = "N")]
    finger: Option<u8>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

pub fn run(target: &Target, arguments: &Arguments) -> Result<(), Failure> {
    let info =
        target.with_client(|client| collect(client, arguments.finger).map_err(Failure::run))?;
    if arguments.json {
        let all: Map<_, _> = info.into_iter().map(|(what, value)| (what.into(), value)).collect();
        return print(&Value::Object(all).to_string());
    }
    for (what, value) in &info {
        print(what)?;
        match value {
            Value::Object(fields) => {
                for (name, value) in fields {
                    print(&format!("  {name:20} {}", text(value)))?;
                }
            }
            Value::Array(lines) => {
                for line in lines {
                    print(&format!("  {}", text(line)))?;
                }
            }
            other => print(&format!("  {}", text(other)))?,
        }
    }
    Ok(())
}

/// A value as a person reads it.
fn text(value: &Value) -> String {
    match value {
        Value::Null => "-".into(),
        Value::String(text) => text.clone(),
        Value::Array(all) => all.iter().map(text).collect::<Vec<_>>().join(" "),
        other => other.to_string(),
    }
}

/// What the device reports; without what its firmware does not know.
fn collect(
    client: &mut AnyClient<'_>,
    finger: Option<u8>,
) -> Result<Vec<(&'static str, Value)>, ClientError> {
    let identity = client.ask(&QueryIdentity)?;
    let mut info = Vec::new();
    let mut put = |what, value: Result<Value, serde_json::Error>| {
        info.push((what, value.unwrap_or_default()));
    };
    put("device", serde_json::to_value(&identity));
    put("state", ask(client, finger, &QueryState)?);
    put("cause", ask(client, finger, &QueryCause)?);
    if identity.can("self-test") {
        put("self-test", ask(client, finger, &QuerySelfTest)?);
    }
    if identity.can("raw") {
        put("raw", ask(client, finger, &QueryRaw)?);
    }
    if identity.can("board") {
        put("board", ask(client, None, &QueryBoard)?);
    }
    if identity.can("flux") {
        put("flux", ask(client, finger, &QueryFlux)?);
    }
    put("tile", ask(client, finger, &QueryMargins)?);
    put("settings", Ok(settings(client, finger)?.into()));
    Ok(info)
}

/// The reply to a query as JSON.
fn ask<C: Command<Answer: serde::Serialize>>(
    client: &mut AnyClient<'_>,
    finger: Option<u8>,
    query: &C,
) -> Result<Result<Value, serde_json::Error>, ClientError> {
    Ok(serde_json::to_value(client.ask_finger(finger, query)?))
}
