//! Every client of a device at a line that loses, delays, changes, doubles, reorders and adds lines, and under signals. The device itself
//! is asked afterwards whether it is driven, and that is compared with what the client has said.
#![cfg(unix)]

mod clients;
mod kinds;
mod line;
mod oracle;
mod served;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use clients::{Client, python};
use documented_figures::one_case_in;
use kinds::Kind;
use served::Transport;

/// Runs at a time. They wait most of the time.
const AT_ONCE: usize = 8;
/// Step through the cases in a suite of tests; it has no common divisor with the number of clients, so that each is among them.
const SUITE_STEP: usize = 40;
/// A part of `client | kind`: only these cases are run, and everything that they say is printed.
const ONLY_VARIABLE: &str = "THERMAL_HOSTILE";

/// What was wrong in each case, by kind and client.
type Results = BTreeMap<(String, &'static str), Vec<String>>;

#[test]
fn no_client_says_what_is_not_so_or_waits_for_ever_whatever_its_line_does() {
    let (clients, kinds) = (clients::all(), kinds::all());
    let only = std::env::var(ONLY_VARIABLE).ok();
    let is_chosen = |client: &Client, kind: &Kind| {
        let name = format!("{} | {}", client.name, kind.name);
        let can_be = client.transport != Transport::InStep || kind.keeps_bytes();
        let is_there = !client.is_python() || python().is_some();
        can_be && is_there && only.as_ref().is_none_or(|part| name.contains(part))
    };
    let step = if only.is_some() { 1 } else { one_case_in(SUITE_STEP) };
    let cases: Vec<_> = (kinds.iter())
        .flat_map(|kind| clients.iter().map(move |client| (client, kind)))
        .step_by(step)
        .filter(|(client, kind)| is_chosen(client, kind))
        .collect();
    let next = AtomicUsize::new(0);
    let results = Mutex::new(Results::new());
    thread::scope(|scope| {
        for _ in 0..AT_ONCE {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    let Some((client, kind)) = cases.get(number) else { break };
                    let folder =
                        Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("hostile-{number}"));
                    let outcome = client.run(kind, &folder);
                    let found = oracle::defects(client, kind, &outcome);
                    if !found.is_empty() || only.is_some() {
                        println!("\n{} | {} | {found:?}: {outcome:#?}", client.name, kind.name);
                        println!("{}", outcome.said);
                    }
                    results.lock().unwrap().insert((kind.name.clone(), client.name), found);
                }
            });
        }
    });
    let results = results.into_inner().unwrap();
    print_table(&clients, &kinds, &results);
    let held = results.values().filter(|found| found.is_empty()).count();
    println!("{held} of {} runs held", results.len());
    assert_eq!(held, results.len());
}

/// Prints a Markdown table: kinds of defects, and clients.
fn print_table(clients: &[Client], kinds: &[Kind], results: &Results) {
    let names: Vec<_> = clients.iter().map(|client| client.name).collect();
    println!("| kind | {} |\n|---|{}", names.join(" | "), "---|".repeat(clients.len()));
    for kind in kinds {
        let cell = |client: &Client| match results.get(&(kind.name.clone(), client.name)) {
            Some(found) if found.is_empty() => "held".into(),
            Some(found) => format!("**{}**", found.join("; ")),
            None => String::new(),
        };
        let cells: Vec<_> = clients.iter().map(cell).collect();
        if cells.iter().any(|cell| !cell.is_empty()) {
            println!("| {} | {} |", kind.name, cells.join(" | "));
        }
    }
}
