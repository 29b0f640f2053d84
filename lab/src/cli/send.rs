//! `thermal-lab send`: lines to the device, and its answers.

use std::io::{self, BufReader, ErrorKind, stdin};
use std::sync::mpsc::RecvTimeoutError;
use std::time::Duration;

use anyhow::anyhow;
use clap::Args;
use serde_json::json;
use thermal_client::client::ClientError;
use thermal_lab::bench_operator::lines;

use super::target::AnyClient;
use super::{Failure, Target, print};

/// Time between two looks at the device while standard input is silent.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

#[derive(Args)]
pub struct Arguments {
    /// Lines to send, each as one argument; `-` for those of standard input
    #[arg(required = true, value_name = "LINE")]
    lines: Vec<String>,
    /// Print one JSON object a line: line, answer, ok
    #[arg(long)]
    json: bool,
}

pub fn run(target: &Target, arguments: &Arguments) -> Result<(), Failure> {
    target.with_client(|client| {
        for line in &arguments.lines {
            if line != "-" {
                send(client, line, arguments.json)?;
                continue;
            }
            let entered = lines(BufReader::new(stdin()));
            loop {
                match entered.recv_timeout(POLL_INTERVAL) {
                    Ok(line) => {
                        let line = line.map_err(|error| match error.kind() {
                            ErrorKind::InvalidData => Failure::input(unreadable(&error)),
                            _ => Failure::run(unreadable(&error)),
                        })?;
                        if !line.trim().is_empty() {
                            send(client, line.trim(), arguments.json)?;
                        }
                    }
                    Err(RecvTimeoutError::Disconnected) => break,
                    Err(RecvTimeoutError::Timeout) => {
                        client.wait(POLL_INTERVAL).map_err(Failure::run)?
                    }
                }
            }
        }
        Ok(())
    })
}

fn unreadable(error: &io::Error) -> anyhow::Error {
    anyhow!("standard input: {error}")
}

/// Sends a line and prints its answer. A refusal is an error, so that no further line is sent.
fn send(client: &mut AnyClient<'_>, line: &str, json: bool) -> Result<(), Failure> {
    let answer = client.query(line).map_err(|error| match error {
        ClientError::Unsendable { .. } => Failure::input(error),
        error => Failure::run(error),
    })?;
    let ok = !answer.split(' ').take(2).any(|word| word == "err");
    if json {
        print(&json!({ "line": line, "answer": answer, "ok": ok }).to_string())?;
    } else {
        print(&answer)?;
    }
    if ok { Ok(()) } else { Err(Failure::run(anyhow!("the device refuses '{line}'"))) }
}
