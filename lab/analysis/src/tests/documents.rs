//! The page, JSON and CSV.

use super::data;
use crate::analyses::of_task;
use crate::report::rounded;
use crate::{Analysis, Cell, Simulated};
use thermal_session::dataset::DataSet;

/// Elements without an end.
const VOID: [&str; 3] = ["meta", "br", "!doctype"];

/// Checks that all elements end in the order in which they begin; returns the names of all.
pub fn elements(page: &str) -> Vec<String> {
    let (mut open, mut all) = (Vec::new(), Vec::new());
    let mut rest = page;
    while let Some(begin) = rest.find('<') {
        let end = begin + rest[begin..].find('>').expect("an end of the tag");
        let tag = &rest[begin + 1..end];
        assert!(!tag.contains('<'), "{tag}");
        rest = &rest[end + 1..];
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(name), "ends where another element is open");
            continue;
        }
        let name = tag.split([' ', '\n', '/']).next().unwrap_or_default().to_owned();
        if !tag.ends_with('/') && !VOID.contains(&&*name) {
            open.push(name.clone());
        }
        all.push(name);
    }
    assert!(open.is_empty(), "{open:?} do not end");
    all
}

fn analysis() -> Analysis {
    let tasks =
        [data::discrimination(2, 0.4), data::identification(2, 0.5), data::thresholds(2, 0.14)];
    Analysis { left_out: Vec::new(), tasks: tasks.iter().map(of_task).collect() }
}

#[test]
fn the_page_has_every_table_and_picture_and_needs_no_other_file() {
    let analysis = analysis();
    let page = analysis.page();
    let elements = elements(&page);
    let count = |name: &str| elements.iter().filter(|one| *one == name).count();
    let sections = || analysis.tasks.iter().flat_map(|task| &task.sections);
    assert_eq!(count("table"), sections().map(|section| section.tables.len()).sum::<usize>());
    assert_eq!(count("svg"), sections().map(|section| section.pictures.len()).sum::<usize>());
    assert!(count("svg") >= 6);
    for section in sections() {
        assert!(page.contains(&format!(">{}</h3>", section.title)), "{}", section.title);
    }
    for word in ["src=", "<script", "<link", "@import", "url("] {
        assert!(!page.contains(word), "{word}");
    }
    assert!(!page.contains("NaN") && !page.contains(">inf"));
}

#[test]
fn words_of_a_session_cannot_become_elements_of_the_page() {
    let mut task = data::discrimination(1, 0.4);
    task.title = "<script>alert(1)</script>".into();
    task.question = Some("a < b & \"c\"".into());
    task.participants[0].code = "<b>".into();
    task.analyses.push("no such \"word\"><i>".into());
    let page = Analysis { left_out: vec!["<i>.json".into()], tasks: vec![of_task(&task)] }.page();
    let names = elements(&page);
    assert!(!names.iter().any(|name| ["script", "b", "i"].contains(&&**name)));
    assert!(page.contains("this version knows no such analysis"));
    assert!(page.contains("<li>&lt;i&gt;.json</li>"));
}

#[test]
fn csv_has_a_file_for_each_table_with_all_its_rows() {
    let analysis = analysis();
    let files = analysis.csv();
    let mut names: Vec<_> = files.iter().map(|(name, _)| name).collect();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), files.len(), "names are unique");
    let tables = analysis
        .tasks
        .iter()
        .flat_map(|task| task.sections.iter().flat_map(|section| &section.tables));
    for ((name, text), table) in files.iter().zip(tables) {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let rows = reader.records().collect::<Result<Vec<_>, _>>().expect(name);
        assert_eq!(rows.len(), table.rows.len(), "{name}");
    }
}

#[test]
fn json_has_the_numbers_of_the_tables() {
    let analysis = analysis();
    let value: serde_json::Value = serde_json::from_str(&analysis.json()).expect("JSON");
    let row = &value["tasks"][0]["sections"][2]["tables"][0]["rows"][0];
    assert_eq!(row[0], "copper / bronze");
    let table = analysis.tasks[0].table("pairs");
    assert_eq!(Cell::from(row[4].as_f64().expect("a number")), table.rows[0][4]);
}

#[test]
fn a_data_set_without_sessions_has_a_page() {
    let empty = crate::analyse(&DataSet::default(), Simulated::Apart);
    elements(&empty.page());
    assert_eq!(empty.json().replace(char::is_whitespace, ""), "{\"left_out\":[],\"tasks\":[]}");
}

#[test]
fn files_have_seven_significant_digits() {
    assert_eq!(rounded(0.1 + 0.2), 0.3);
    assert_eq!(rounded(7_234.567_89), 7_234.568);
    assert_eq!(rounded(-1.234_567_89e-12), -1.234_568e-12);
    assert!(rounded(-0.0).is_sign_positive());
    let analysis = analysis();
    for (name, text) in analysis.csv() {
        for word in text.split([',', '\n']) {
            let digits = word.trim_start_matches(['-', '0', '.']);
            let digits = digits.split('e').next().unwrap_or_default();
            let digits = digits.bytes().filter(u8::is_ascii_digit).count();
            assert!(word.parse::<f64>().is_err() || digits <= 7, "{name}: {word}");
        }
    }
}
