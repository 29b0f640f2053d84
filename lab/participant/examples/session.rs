//! Runs a session with simulated participants in virtual time:
//! `cargo run --release -p thermal-participant --example session -- SESSION.toml PARTICIPANTS FOLDER`.

use std::path::Path;
use std::time::Instant;

use thermal_client::client::Client;
use thermal_client::link::Link;
use thermal_participant::{Bench, BenchOptions};
use thermal_session::dataset::Recorder;
use thermal_session::{Executor, Plan, Schedule, Session};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, participants, folder] = arguments.as_slice() else {
        return Err("SESSION.toml, number of participants and folder of the data set".into());
    };
    let session = Session::read(Path::new(file))?;
    let seed = 1;
    let (mut trials, mut virtual_s, mut void) = (0, 0.0, 0);
    let begin = Instant::now();
    for number in 1..=participants.parse::<u32>()? {
        let code = format!("{number:02}");
        let plan = Plan::new(&session, &code, seed)?;
        let bench = Bench::new(&session, &plan, &code, seed, BenchOptions::default())?;
        let who = (code.as_str(), seed);
        let mut recorder = Recorder::create(Path::new(folder), &session, &plan, who, true)?;
        let mut people = bench.people();
        Executor::new(&session, Client::new(bench.link()), &mut people, &mut recorder)
            .run(&plan, Schedule::new(&session, &plan))?;
        let records = recorder.records();
        trials += records.len();
        void += records.iter().filter(|record| record.void.is_some()).count();
        let judged = || records.iter().filter_map(|record| record.is_correct);
        let correct = judged().filter(|is_correct| *is_correct).count();
        println!("{code}: {correct} of {} correct", judged().count());
        virtual_s += bench.link().now().as_secs_f64();
    }
    let real_s = begin.elapsed().as_secs_f64();
    println!(
        "{trials} trials ({void} void) of {:.1} h in {real_s:.1} s: {:.1} trials/s, {:.0} times real time",
        virtual_s / 3600.0,
        trials as f64 / real_s,
        virtual_s / real_s
    );
    Ok(())
}
