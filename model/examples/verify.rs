//! Checks the kernel over every input where scenes live, and proves a bound for the other octaves:
//! `cargo run --release -p contact-model --example verify`.
//!
//! Uses all cores. What is done is noted in `target/verify`, so that a run that was ended goes on where it was.

#[path = "../tests/verify/mod.rs"]
mod verify;

use contact_model::fixed_point::kernel::OCTAVES;
use std::collections::HashMap;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;
use verify::{INPUTS, LIVED_IN, TRUTH_ERROR, Tally, exhaustive, proof};

/// Pieces of an octave: what is lost when a run is ended.
const PIECES: u64 = 64;

fn main() -> io::Result<()> {
    let pieces: Vec<(i32, u64)> = LIVED_IN
        .flat_map(|octave| (0..PIECES).map(move |piece| (octave, piece)))
        .collect();
    let mut record = Record::open()?;
    let open: Vec<_> = pieces
        .iter()
        .filter(|piece| !record.done.contains_key(piece))
        .collect();
    eprintln!(
        "{} inputs in {} pieces, {} of them done before; notes in {}",
        LIVED_IN.len() as u64 * INPUTS,
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
                        let tally = exhaustive(octave, piece * length..(piece + 1) * length);
                        let mut record = shared.lock().expect("no worker panics");
                        record.add((octave, piece), tally)?;
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
        workers
            .into_iter()
            .try_for_each(|worker| worker.join().expect("no worker panics"))
    })?;
    eprintln!();
    report(&record)
}

/// Pieces that are done, in a file that belongs to one table.
struct Record {
    path: PathBuf,
    done: HashMap<(i32, u64), Tally>,
}

impl Record {
    fn open() -> io::Result<Self> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/verify");
        fs::create_dir_all(&folder)?;
        // All that the result depends on.
        let sources = concat!(
            include_str!("../src/fixed_point/kernel.rs"),
            include_str!("../src/fixed_point/kernel_table.rs"),
            include_str!("../src/fixed_point/mantissa_exponent.rs"),
            include_str!("../src/reference/erfcx.rs"),
            include_str!("../tests/verify/mod.rs"),
        );
        let hash = sources
            .bytes()
            .fold(0xcbf2_9ce4_8422_2325u64, |hash, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
            });
        let path = folder.join(format!("kernel-{hash:016x}.txt"));
        let text = fs::read_to_string(&path).unwrap_or_default();
        // A line that a run could not finish is not parsed, and its piece is checked again.
        let done = text.lines().filter_map(parse).collect();
        Ok(Self { path, done })
    }

    fn add(&mut self, piece: (i32, u64), tally: Tally) -> io::Result<()> {
        let mut file = fs::OpenOptions::new()
            .create(true)
            .append(true)
            .open(&self.path)?;
        let Tally {
            inputs,
            worst,
            correctly_rounded,
            rises,
            largest_rise,
        } = tally;
        let (octave, number) = piece;
        // In one piece, and on a line of its own whatever an ended run has left.
        let line = format!(
            "\n{octave} {number} {inputs} {worst} {correctly_rounded} {rises} {largest_rise} end"
        );
        file.write_all(line.as_bytes())?;
        self.done.insert(piece, tally);
        Ok(())
    }
}

fn parse(line: &str) -> Option<((i32, u64), Tally)> {
    let words: Vec<_> = line.split(' ').collect();
    let [
        octave,
        piece,
        inputs,
        worst,
        correctly_rounded,
        rises,
        largest_rise,
        "end",
    ] = words[..]
    else {
        return None;
    };
    let tally = Tally {
        inputs: inputs.parse().ok()?,
        worst: worst.parse().ok()?,
        correctly_rounded: correctly_rounded.parse().ok()?,
        rises: rises.parse().ok()?,
        largest_rise: largest_rise.parse().ok()?,
    };
    Some(((octave.parse().ok()?, piece.parse().ok()?), tally))
}

fn report(record: &Record) -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(
        out,
        "octave of u   checked   worst error   correctly rounded   rises   largest   proven bound"
    )?;
    let mut all = Tally::default();
    let mut proven = 0.0f64;
    for octave in OCTAVES.start + 1..OCTAVES.end - 1 {
        let bound = proof::bound(octave);
        if !LIVED_IN.contains(&octave) {
            proven = proven.max(bound);
            continue;
        }
        let mut tally = Tally::default();
        for piece in 0..PIECES {
            tally.merge(&record.done[&(octave, piece)]);
        }
        line(&mut out, &format!("2^{octave}"), &tally)?;
        writeln!(out, "   {bound:.4}")?;
        all.merge(&tally);
    }
    line(&mut out, "all of them", &all)?;
    writeln!(
        out,
        "\nunits of 2^-32; the truth is known to {TRUTH_ERROR} units"
    )?;
    writeln!(
        out,
        "the other octaves, 2^{} to 2^{}: at most {proven:.4}, proven",
        OCTAVES.start + 1,
        OCTAVES.end - 1
    )
}

fn line(out: &mut impl Write, name: &str, tally: &Tally) -> io::Result<()> {
    let share = 100.0 * tally.correctly_rounded as f64 / tally.inputs as f64;
    write!(
        out,
        "{name:<11} {:>12}   {:>9.5}   {share:>12.4} %   {:>9}   {:>3}",
        tally.inputs, tally.worst, tally.rises, tally.largest_rise
    )
}
