//! Prints the predictions: `cargo run --release -p thermal-participant --example predict`, `-- --json` for JSON.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let report = thermal_participant::predictions::report()?;
    if std::env::args().any(|argument| argument == "--json") {
        println!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        print!("{report}");
    }
    Ok(())
}
