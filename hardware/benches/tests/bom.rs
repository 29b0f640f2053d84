//! The bill of materials has every part of the netlists, with the netlists' values.

use std::fs;

use hardware_benches::netlist::{FILES, Netlists, folder};
use hardware_benches::number;

/// Rows of `bom.csv`: block, references, part, values.
fn rows() -> Vec<[String; 4]> {
    let text = fs::read_to_string(folder().join("bom.csv")).unwrap();
    let rows = text.lines().skip(1).map(|line| {
        let fields: Vec<_> = line.split(',').collect();
        assert_eq!(fields.len(), 7, "{line}");
        assert!(!fields[6].is_empty(), "no source: {line}");
        [fields[0], fields[1], fields[3], fields[5]].map(str::to_owned)
    });
    rows.collect()
}

/// Name and value of each part of a block; lines that only model something are no parts.
fn parts(file: &str) -> Vec<(String, String)> {
    let text = fs::read_to_string(folder().join(file).with_extension("cir")).unwrap();
    text.lines()
        .skip_while(|line| !line.starts_with(".subckt "))
        .skip(1)
        .take_while(|line| !line.starts_with(".ends"))
        .filter(|line| line.starts_with(|c: char| c.is_ascii_alphabetic()))
        .filter(|line| !line.contains("; model"))
        .filter_map(|line| {
            let mut words = line.split_whitespace();
            Some((words.next()?.to_owned(), words.nth(2)?.to_owned()))
        })
        .collect()
}

#[test]
fn every_part_of_a_block_is_in_the_bill_of_materials() {
    let (rows, netlists) = (rows(), Netlists::load().unwrap());
    let mut values = 0;
    for file in FILES.iter().filter(|name| **name != "parts") {
        for (name, value) in parts(file) {
            let row = rows.iter().find(|[block, references, ..]| {
                block == file && references.split_whitespace().any(|word| word == name)
            });
            let [_, _, part, listed] =
                row.unwrap_or_else(|| panic!("{file}.cir: bom.csv has no row for {name}"));
            let parameter = value.strip_prefix('{').and_then(|v| v.strip_suffix('}'));
            if let (true, Some(parameter)) = (part.contains(" 0603 "), parameter) {
                let listed = number::parse(&listed.replace(" M", "meg").replace(' ', ""));
                let simulated = netlists.param(parameter).unwrap();
                let ratio = listed.unwrap_or(0.0) / simulated;
                assert!((ratio - 1.0).abs() < 1e-9, "{file}.cir, {name}: {listed:?}");
                values += 1;
            }
        }
    }
    assert!(values > 60, "{values}");
}
