//! Measures the kernel's error over every input of the practical octaves, and proves a bound for the others:
//! `cargo run --release -p contact-model --example verify`.
//!
//! Uses all cores. Results are recorded in `target/verify`, so that an interrupted run continues where it ended.

#[path = "../tests/verify/mod.rs"]
mod verify;

use contact_model::fixed_point::kernel::{OCTAVES, PRACTICAL_OCTAVES};
use std::collections::HashMap;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;
use verify::{INPUTS, REFERENCE_ERROR, Statistics, exhaustive, proof};

/// Pieces of an octave; an interrupted run loses at most one per core.
const PIECES: u64 = 64;

fn main() -> io::Result<()> {
    let pieces: Vec<(i32, u64)> = PRACTICAL_OCTAVES
        .flat_map(|octave| (0..PIECES).map(move |piece| (octave, piece)))
        .collect();
    let mut record = Record::open()?;
    let open: Vec<_> = pieces.iter().filter(|piece| !record.done.contains_key(piece)).collect();
    eprintln!(
        "{} inputs in {} pieces, {} of them done before; recorded in {}",
        PRACTICAL_OCTAVES.len() as u64 * INPUTS,
        pieces.len(),
        pieces.len() - open.len(),
        record.path.display()
    );

    let next = AtomicUsize::new(0);
    let begun = Instant::now();
    let shared = Mutex::new(&mut record);
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..std::thread::available_parallelism().map_or(1, usize::from))
            .map(|_| {
                scope.spawn(|| -> io::Result<()> {
                    while let Some(&&(octave, piece)) =
                        open.get(next.fetch_add(1, Ordering::Relaxed))
                    {
                        let length = INPUTS / PIECES;
                        let statistics = exhaustive(octave, piece * length..(piece + 1) * length);
                        let mut record = shared.lock().expect("no worker panics");
                        record.add((octave, piece), statistics)?;
                        let new = record.done.len() + open.len() - pieces.len();
                        let left_s =
                            begun.elapsed().as_secs_f64() / new as f64 * (open.len() - new) as f64;
                        eprint!(
                            "\r{} of {} pieces, {left_s:.0} s left ",
                            record.done.len(),
                            pieces.len()
                        );
                    }
                    Ok(())
                })
            })
            .collect();
        workers.into_iter().try_for_each(|worker| worker.join().expect("no worker panics"))
    })?;
    eprintln!();
    report(&record)
}

/// Pieces that are done, in a file that is named after the sources.
struct Record {
    path: PathBuf,
    done: HashMap<(i32, u64), Statistics>,
}

impl Record {
    fn open() -> io::Result<Self> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/verify");
        fs::create_dir_all(&folder)?;
        // Everything that the result depends on.
        let sources = concat!(
            include_str!("../src/fixed_point/kernel.rs"),
            include_str!("../src/fixed_point/kernel_table.rs"),
            include_str!("../src/fixed_point/mantissa_exponent.rs"),
            include_str!("../src/reference/erfcx.rs"),
            include_str!("../tests/verify/mod.rs"),
        );
        let hash = sources.bytes().fold(0xcbf2_9ce4_8422_2325u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
        });
        let path = folder.join(format!("kernel-{hash:016x}.txt"));
        let text = fs::read_to_string(&path).unwrap_or_default();
        // The unfinished line of an interrupted run is ignored, and its piece is checked again.
        let done = text.lines().filter_map(parse).collect();
        Ok(Self { path, done })
    }

    fn add(&mut self, piece: (i32, u64), statistics: Statistics) -> io::Result<()> {
        let mut file = fs::OpenOptions::new().create(true).append(true).open(&self.path)?;
        let Statistics { inputs, worst, correctly_rounded, increases, largest_increase } =
            statistics;
        let (octave, number) = piece;
        // In one write, and on a new line even if the last one is unfinished.
        let line = format!(
            "\n{octave} {number} {inputs} {worst} {correctly_rounded} {increases} {largest_increase} end"
        );
        file.write_all(line.as_bytes())?;
        self.done.insert(piece, statistics);
        Ok(())
    }
}

fn parse(line: &str) -> Option<((i32, u64), Statistics)> {
    let words: Vec<_> = line.split(' ').collect();
    let [octave, piece, inputs, worst, correctly_rounded, increases, largest_increase, "end"] =
        words[..]
    else {
        return None;
    };
    let statistics = Statistics {
        inputs: inputs.parse().ok()?,
        worst: worst.parse().ok()?,
        correctly_rounded: correctly_rounded.parse().ok()?,
        increases: increases.parse().ok()?,
        largest_increase: largest_increase.parse().ok()?,
    };
    Some(((octave.parse().ok()?, piece.parse().ok()?), statistics))
}

fn report(record: &Record) -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(
        out,
        "octave of u   checked   worst error   correctly rounded   increases   largest   proven bound"
    )?;
    let mut all = Statistics::default();
    let mut proven = 0.0f64;
    for octave in OCTAVES.start + 1..OCTAVES.end - 1 {
        let bound = proof::bound(octave);
        if !PRACTICAL_OCTAVES.contains(&octave) {
            proven = proven.max(bound);
            continue;
        }
        let mut statistics = Statistics::default();
        for piece in 0..PIECES {
            statistics.merge(&record.done[&(octave, piece)]);
        }
        line(&mut out, &format!("2^{octave}"), &statistics)?;
        writeln!(out, "   {bound:.4}")?;
        all.merge(&statistics);
    }
    line(&mut out, "all of them", &all)?;
    writeln!(out, "\nin units of 2^-32; the reference is exact to {REFERENCE_ERROR} units")?;
    writeln!(
        out,
        "the other octaves, 2^{} to 2^{}: at most {proven:.4}, proven",
        OCTAVES.start + 1,
        OCTAVES.end - 1
    )
}

fn line(out: &mut impl Write, name: &str, statistics: &Statistics) -> io::Result<()> {
    let percent = 100.0 * statistics.correctly_rounded as f64 / statistics.inputs as f64;
    write!(
        out,
        "{name:<11} {:>12}   {:>9.5}   {percent:>12.4} %   {:>9}   {:>3}",
        statistics.inputs, statistics.worst, statistics.increases, statistics.largest_increase
    )
}
