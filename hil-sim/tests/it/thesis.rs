//! `hil-sim thesis`: what it prints and writes.

use std::path::PathBuf;
use std::sync::LazyLock;

use thermal_thesis::chapters;
use thermal_thesis::row::Row;

use super::{good, refused, temporary};

/// All rows, computed once.
static ROWS: LazyLock<Vec<Row>> = LazyLock::new(|| {
    let chapters = chapters().into_iter();
    chapters.flat_map(|chapter| chapter.rows).collect()
});

/// What one run of the command prints, and the folder that it writes.
static PRINTED: LazyLock<(String, PathBuf)> = LazyLock::new(|| {
    let folder = temporary("thesis-out");
    let text = good(&["thesis", "--out", folder.to_str().expect("a path")], "");
    (text, folder)
});

fn count_of(rows: &[Row], word: &str) -> usize {
    rows.iter().filter(|row| row.verdict().word() == word).count()
}

#[test]
fn the_table_ends_with_the_counts_of_its_lines() {
    let (text, _) = &*PRINTED;
    let rows = &*ROWS;
    let lines = text.lines().filter(|line| line.starts_with("  ")).count();
    assert_eq!(lines, rows.len());
    assert_eq!(text.lines().filter(|line| line.starts_with("Chapter ")).count(), 9);
    let count = |word: &str| count_of(rows, word);
    // The line after the table names the page.
    let last = text.lines().nth_back(1).expect("a last line");
    let expected = format!(
        "{} numbers: {} agree, {} cut instead of rounded, {} damaged in the text, {} wrong in the thesis, {} differ",
        rows.len(),
        count("agrees"),
        count("cut"),
        count("damaged"),
        count("wrong"),
        count("differs"),
    );
    assert_eq!(last, expected);
    assert!(text.contains(
        "damaged in the text: labels shifted by one row: holds the conductivity; that is 398.00"
    ));
}

#[test]
fn json_is_one_object_with_all_rows() {
    let object: serde_json::Value =
        serde_json::from_str(&good(&["thesis", "--json"], "")).expect("JSON");
    let rows = object["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), ROWS.len());
    for word in ["agrees", "cut", "differs", "damaged", "wrong"] {
        let found = rows.iter().filter(|row| row["verdict"] == word).count();
        assert_eq!(object["counts"][word], found, "{word}");
    }
    let measured = object["measured"].as_array().expect("measurements");
    assert!(measured.len() > 40);
    assert!(measured.iter().all(|row| {
        let plants = row["plant"].as_array().map(Vec::len);
        plants == Some(if row["verdict"] == "not-modelled" { 0 } else { 4 })
    }));
    let g10 = rows
        .iter()
        .find(|row| row["place"] == "Table 3-1" && row["quantity"] == "G10, interface")
        .expect("the row");
    assert_eq!(g10["chapter"], 3);
    assert_eq!(g10["unit"], "°C");
    assert_eq!(g10["stated"], "29.0");
    assert_eq!(g10["verdict"], "wrong");
    let difference = g10["difference"].as_f64().expect("a number");
    assert!((difference - 0.053_124_040_144_6).abs() < 1e-9, "{difference}");
}

#[test]
fn out_writes_a_page_that_needs_no_other_file_and_all_rows_as_csv() {
    let (text, folder) = &*PRINTED;
    assert!(text.ends_with(&format!("report: {}\n", folder.join("thesis.html").display())));
    let rows = &*ROWS;
    let page = std::fs::read_to_string(folder.join("thesis.html")).expect("the page");
    assert_eq!(page.matches("<figure>").count(), 15);
    assert_eq!(page.matches("<svg").count(), 15);
    assert_eq!(page.matches("<td class=\"v ").count(), rows.len());
    assert_eq!(page.matches(">wrong in the thesis<").count(), count_of(rows, "wrong"));
    for link in ["href", "src=", "url(", "@import"] {
        assert!(!page.contains(link), "{link} in the page");
    }
    let mut reader = csv::Reader::from_path(folder.join("thesis.csv")).expect("the table");
    let header = reader.headers().expect("a header").clone();
    assert_eq!(
        header,
        vec!["chapter", "place", "quantity", "unit", "stated", "computed", "verdict", "remark"]
    );
    let records: Vec<_> = reader.records().collect::<Result<_, _>>().expect("records");
    assert_eq!(records.len(), rows.len());
    for (record, row) in records.iter().zip(rows) {
        assert_eq!(&record[2], row.quantity);
        assert_eq!(record[5].parse(), Ok(row.computed), "{}", row.quantity);
        assert_eq!(record[6], row.verdict().to_string());
    }
}

#[test]
fn an_impossible_folder_is_refused_by_name() {
    let file = temporary("thesis-file");
    std::fs::write(&file, "").expect("a file");
    let below = file.join("below");
    let message = refused(&["thesis", "--out", below.to_str().expect("a path")]);
    assert!(message.contains(&format!("--out {}", below.display())), "{message}");
}
