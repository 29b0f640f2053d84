//! Writes the golden values of the contact model as Rust source, and adds the list of tests to the image.

use std::collections::HashMap;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::{env, fs};

/// Of the golden contacts, one in this many: the flash holds them beside the program.
const EVERY: usize = 4;

type Row = HashMap<String, String>;

fn rows(name: &str) -> Result<Vec<Row>, Box<dyn Error>> {
    let path = format!("{}/../../model/tests/data/{name}.csv", env::var("CARGO_MANIFEST_DIR")?);
    println!("cargo::rerun-if-changed={path}");
    let rows = csv::Reader::from_path(path)?.into_deserialize().collect::<Result<_, _>>()?;
    Ok(rows)
}

fn number(row: &Row, column: &str) -> Result<f64, Box<dyn Error>> {
    let text = row.get(column).ok_or_else(|| format!("no column {column}"))?;
    Ok(text.parse()?)
}

/// Pairs of `u = x²` and `erfcx(x)`, for all `u` of the kernel's stated domain.
fn erfcx(source: &mut String) -> Result<(), Box<dyn Error>> {
    writeln!(source, "pub const ERFCX: &[(f64, f64)] = &[")?;
    for row in rows("erfcx")? {
        let u = number(&row, "x")?.powi(2);
        if (2f64.powi(-24)..2f64.powi(16)).contains(&u) {
            writeln!(source, "    ({u:e}, {:e}),", number(&row, "erfcx")?)?;
        }
    }
    writeln!(source, "];")?;
    Ok(())
}

fn contacts(source: &mut String) -> Result<(), Box<dyn Error>> {
    writeln!(source, "pub const CONTACTS: &[GoldenContact] = &[")?;
    let rows = rows("contact")?;
    // At landing nothing is evaluated.
    let later = rows.iter().filter(|row| number(row, "t_s").is_ok_and(|t_s| t_s > 0.0));
    for row in later.step_by(EVERY) {
        writeln!(
            source,
            "    GoldenContact {{ material: {:?}, pressure_pa: {:e}, t_s: {:e}, skin_before_c: {:e}, \
             object_before_c: {:e}, skin_c: {:e}, object_c: {:e}, display_c: {:e} }},",
            row["material"],
            number(row, "P_Pa")?,
            number(row, "t_s")?,
            number(row, "T_skin_i_C")?,
            number(row, "T_object_i_C")?,
            number(row, "T_skin_s_C")?,
            number(row, "T_object_s_C")?,
            number(row, "T_display_C")?,
        )?;
    }
    writeln!(source, "];")?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rustc-link-arg-tests=-Tembedded-test.x");
    // The macros of embedded-test ask for it.
    println!("cargo::rustc-check-cfg=cfg(rust_analyzer)");
    let mut source = String::new();
    erfcx(&mut source)?;
    contacts(&mut source)?;
    fs::write(Path::new(&env::var("OUT_DIR")?).join("golden.rs"), source)?;
    Ok(())
}
