//! `cargo xtask tables`: writes tables of the code between markers of documents and of other sources; with `--check` it only compares.
mod answers;
mod faults;
mod materials;
mod part;
mod wire;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use part::{Part, markers};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let check = match &arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => false,
        ["--check"] => true,
        others => bail!("{others:?}; allowed is --check"),
    };
    let (files, differing) = update(check)?;
    ensure!(
        !check || differing.is_empty(),
        "{} differ from the code: cargo xtask tables",
        differing.join(", ")
    );
    println!("{files} files with tables, {} written", differing.len());
    Ok(())
}

/// Number of files with tables, and those whose tables differ from the code. They are written unless `check`.
fn update(check: bool) -> Result<(usize, Vec<&'static str>)> {
    let mut by_file: BTreeMap<&str, Vec<Part>> = BTreeMap::new();
    for part in
        [answers::parts(), faults::parts(), materials::parts(), wire::parts()].into_iter().flatten()
    {
        by_file.entry(part.file).or_default().push(part);
    }
    let mut differing = Vec::new();
    for (file, parts) in &by_file {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(file);
        let content = std::fs::read_to_string(&path).with_context(|| file.to_string())?;
        let marked = content.matches(markers(file).0).count();
        ensure!(marked == parts.len(), "{file} has {marked} markers, of {} tables", parts.len());
        let new =
            parts.iter().try_fold(content.clone(), |content, part| part.put_into(&content))?;
        if new != content {
            differing.push(*file);
            if !check {
                std::fs::write(&path, new).with_context(|| file.to_string())?;
            }
        }
    }
    Ok((by_file.len(), differing))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_those_of_the_code() {
        let (_, differing) = update(true).unwrap();
        assert!(differing.is_empty(), "cargo xtask tables: {differing:?}");
    }
}
