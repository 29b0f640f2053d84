//! The ready sessions, and plans of trials.

mod any_file;
mod data_sets;
mod participants;
mod plans;
mod ready_sessions;

use std::path::{Path, PathBuf};

use thermal_session::{Plan, Session};

/// The folder of the ready sessions.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../sessions")
}

/// A ready session.
fn ready(name: &str) -> Session {
    Session::read(&folder().join(format!("{name}.toml"))).expect(name)
}

/// A session of this text, which a ready one has after a change.
fn changed(name: &str, from: &str, to: &str) -> Session {
    let text = ready(name).text;
    assert!(text.contains(from), "{from:?}");
    Session::parse(&text.replace(from, to), Path::new(name)).expect(to)
}

fn plan(session: &Session, participant: &str, seed: u64) -> Plan {
    Plan::new(session, participant, seed).expect("a plan")
}
