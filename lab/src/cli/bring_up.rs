//! `thermal-lab bring-up`: from a bare board to sign-off, by a person or unattended on an emulated board.

use std::fs;
use std::io::{BufReader, Write, stderr, stdin};
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::Args;
use thermal_client::client::Client;
use thermal_client::text;
use thermal_lab::bench_operator::{BenchOperator, lines};
use thermal_lab::bring_up::{
    EmulatedBench, Report, STAGES, SimulatedBoard, Stage, Terminal, bring_up, page,
};
use thermal_settings::CRC_32;
use thermal_sim::board::{BROKEN_BOARDS, Board, BoardBench, LossyLine, SOUND};
use thermal_sim::engine::NativeEngine;

use super::{Failure, KeptFiles, Target, print};

/// Text after the options in the help.
const USAGE: &str = "\
Each step says what to connect, what the board measures by itself, and what a meter or an oscilloscope must show. Type `?`
for an explanation, `abort` to end with the bridge off. Every value is written to bring-up.html and bring-up.json, after each
stage; an interrupted bring-up goes on with --from. Exit status 1 if not everything has passed.

  thermal-lab bring-up --port /dev/ttyACM0
  thermal-lab bring-up --port /dev/ttyACM0 --from edges
  thermal-lab bring-up --simulated --board reversed-tile     # unattended, the device's logic without its microcontroller";

#[derive(Args)]
#[command(after_help = USAGE)]
pub struct Arguments {
    /// Go on at this stage; results of earlier ones, of the same microcontroller and image, are read from bring-up.json in
    /// the folder of --out
    #[arg(long, value_name = "STAGE", value_parser = stage)]
    from: Option<&'static Stage>,
    /// Folder for the page and the record
    #[arg(long, value_name = "DIR", default_value = "bring-up")]
    out: PathBuf,
    #[command(flatten)]
    kept: KeptFiles,
    /// The flashed image, whose checksum goes onto the page
    #[arg(long, value_name = "FILE")]
    image: Option<PathBuf>,
    /// Print one JSON object: passed, findings
    #[arg(long)]
    json: bool,
    /// Surroundings of an emulated board that `hil-sim serve --board --surroundings` serves at `--tcp`; nobody is asked
    #[arg(long, value_name = "ADDR")]
    surroundings: Option<String>,
    /// Board of `--simulated`: sound, or one of --list-broken
    #[arg(long, value_name = "NAME")]
    board: Option<String>,
    /// Draws the parts of that board from their tolerances
    #[arg(long, value_name = "SEED")]
    draw: Option<u64>,
    /// Print the names of the broken boards, one a line
    #[arg(long, exclusive = true)]
    list_broken: bool,
}

fn stage(name: &str) -> Result<&'static Stage, String> {
    let found = STAGES.iter().find(|stage| stage.name == name);
    found.ok_or_else(|| {
        let known: Vec<_> = STAGES.iter().map(|stage| stage.name).collect();
        format!("known: {}", known.join(", "))
    })
}

pub fn run(target: &Target, arguments: &Arguments) -> Result<(), Failure> {
    if arguments.list_broken {
        for board in BROKEN_BOARDS {
            print(board.name)?;
        }
        return Ok(());
    }
    for (name, given, needs, there) in [
        ("--surroundings", arguments.surroundings.is_some(), "--tcp", target.tcp.is_some()),
        ("--board", arguments.board.is_some(), "--simulated", target.simulated),
        ("--draw", arguments.draw.is_some(), "--simulated", target.simulated),
    ] {
        if given && !there {
            return Err(Failure::input(anyhow!("{name} is for {needs} only")));
        }
    }
    if arguments.from.is_none() {
        [RECORD, PAGE]
            .iter()
            .try_for_each(|name| arguments.kept.check(&arguments.out.join(name)))?;
    }
    let report = first_report(arguments).map_err(Failure::input)?;
    fs::create_dir_all(&arguments.out)
        .with_context(|| arguments.out.display().to_string())
        .map_err(Failure::input)?;
    let mut unsaved = None;
    let mut saved = |report: &Report| {
        unsaved = save(&arguments.out, report).err();
    };
    let report = match &arguments.surroundings {
        Some(surroundings) => served(target, surroundings, report, arguments, &mut saved)?,
        _ if target.simulated => simulated(report, arguments, &mut saved)?,
        _ => by_a_person(target, report, arguments, &mut saved)?,
    };
    if let Some(error) = unsaved {
        return Err(Failure::run(error));
    }
    if arguments.json {
        print(&report.json().to_string())?;
    } else {
        print(&summary(&report))?;
    }
    let path = arguments.out.join(PAGE);
    eprintln!("page: {}", path.display());
    if report.passed() { Ok(()) } else { Err(Failure::run(anyhow!("the bring-up has not passed"))) }
}

const PAGE: &str = "bring-up.html";
const RECORD: &str = "bring-up.json";

/// The report to which results are added: an empty one, or that of the earlier stages.
fn first_report(arguments: &Arguments) -> anyhow::Result<Report> {
    let image = match &arguments.image {
        Some(path) => {
            let bytes = text::read_bytes(path, text::TABLE_BYTES_MAX)
                .with_context(|| format!("--image {}", path.display()))?;
            Some(format!("{:08x}", CRC_32.checksum(&bytes)))
        }
        None => None,
    };
    let mut report = Report::default();
    if let Some(from) = arguments.from {
        let path = arguments.out.join(RECORD);
        let text = text::read(&path, text::DOCUMENT_BYTES_MAX).with_context(|| {
            format!("--from {}: {}: the results of the earlier stages", from.name, path.display())
        })?;
        report = serde_json::from_str(&text).with_context(|| path.display().to_string())?;
        report.keep_before(from, image)?;
    } else {
        report.image = image;
    }
    Ok(report)
}

fn save(folder: &Path, report: &Report) -> anyhow::Result<()> {
    let record = serde_json::to_string_pretty(report)?;
    for (name, text) in [(RECORD, record + "\n"), (PAGE, page(report))] {
        let path = folder.join(name);
        fs::write(&path, text).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

/// The result as text.
fn summary(report: &Report) -> String {
    let mut text = String::new();
    for finding in report.findings() {
        text += &format!("- {finding}\n");
    }
    text += match (&report.resume, report.passed()) {
        (_, true) => "passed: every check of every stage".to_owned(),
        (None, _) => "not passed".to_owned(),
        (Some(resume), _) => {
            format!("not finished: {}; go on with --from {}", resume.reason, resume.stage)
        }
    }
    .as_str();
    text
}

/// By a person at a bench.
fn by_a_person(
    target: &Target,
    report: Report,
    arguments: &Arguments,
    saved: &mut dyn FnMut(&Report),
) -> Result<Report, Failure> {
    let mut screen = stderr();
    let mut terminal =
        Terminal::new(BenchOperator::new(None, lines(BufReader::new(stdin())), &mut screen));
    target
        .with_late_client(|client| bring_up(client, &mut terminal, report, arguments.from, saved))?
        .map_err(Failure::input)
}

/// On an emulated board that another program serves.
fn served(
    target: &Target,
    surroundings: &str,
    mut report: Report,
    arguments: &Arguments,
    saved: &mut dyn FnMut(&Report),
) -> Result<Report, Failure> {
    report.emulated = true;
    let mut bench = EmulatedBench { watch: &mut watch };
    target.with_served_client(surroundings, |client| {
        bring_up(client, &mut bench, report, arguments.from, saved).map_err(Failure::input)
    })
}

/// On a board that is simulated here.
fn simulated(
    mut report: Report,
    arguments: &Arguments,
    saved: &mut dyn FnMut(&Report),
) -> Result<Report, Failure> {
    let board = Board::named(arguments.board.as_deref().unwrap_or(SOUND), arguments.draw)
        .map_err(|error| Failure::input(anyhow!("--board: {error}")))?;
    report.emulated = true;
    let interval = board.lost_bytes_interval;
    let bench = BoardBench::new(board);
    let world = bench.world().map_err(Failure::input)?;
    let mut engine = LossyLine::new(NativeEngine::new(world), interval);
    let link = SimulatedBoard::new(&mut engine, bench);
    let mut bench = EmulatedBench { watch: &mut watch };
    bring_up(&mut Client::new(link), &mut bench, report, arguments.from, saved)
        .map_err(Failure::input)
}

/// Prints progress on standard error, which may be closed.
fn watch(line: &str) {
    let _ignored = writeln!(stderr(), "{line}");
}
