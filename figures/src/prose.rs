//! Results in prose: numbers of a page that were measured, simulated or proven, and stand outside of figures and records.
//!
//! A number is taken for a result, not a constant, if it has one of [`UNITS`] or counts cases (`9 of 12`), and its sentence says that
//! something came out so: by one of [`RESULT_WORDS`], by a unit that only results have here, or by counting cases. In a table the
//! sentence is the row with the head of the cell's column. Times that say when, such as `after 50 ms`, are conditions.

/// Units of results. Forces, lengths, voltages and absolute temperatures are constants and conditions in this documentation.
const UNITS: [&str; 22] = [
    "%",
    "mK",
    "K",
    "µs",
    "us",
    "ms",
    "s",
    "min",
    "h",
    "minutes",
    "hours",
    "instructions",
    "cycles",
    "bytes",
    "KiB",
    "MiB",
    "times",
    "runs",
    "faults",
    "sessions",
    "devices",
    "inputs",
];

/// Units of which constants are rare: a number with one is a result in any sentence.
const UNITS_OF_RESULTS: [&str; 2] = ["mK", "instructions"];

/// Units of time, whose numbers may say when something is.
const TIMES: [&str; 9] = ["µs", "us", "ms", "s", "min", "h", "minutes", "hours", "cycles"];

/// Words before a time that say when, not how long something took.
const WHEN: [&str; 14] = [
    "at", "after", "from", "for", "every", "each", "until", "before", "first", "last", "next",
    "since", "between", "lasts",
];

/// Words by which a sentence says that something came out so.
const RESULT_WORDS: [&str; 44] = [
    "measured",
    "simulated",
    "emulated",
    "proven",
    "recorded",
    "median",
    "medians",
    "worst",
    "percentile",
    "rms",
    "overshoot",
    "overshoots",
    "undershoots",
    "misses",
    "missed",
    "tripped",
    "found",
    "took",
    "cost",
    "costs",
    "gave",
    "had",
    "faster",
    "slower",
    "remain",
    "remains",
    "remained",
    "reached",
    "showed",
    "shows",
    "lasted",
    "was",
    "were",
    "takes",
    "mean",
    "average",
    "off",
    "error",
    "errors",
    "saves",
    "smaller",
    "larger",
    "result",
    "differ",
];

/// A number that is taken for a result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ResultInProse {
    /// Line of the page, from 1.
    pub line: usize,
    /// The heading under which it stands.
    pub section: String,
    /// The number with its unit, such as `12 mK`; `9 of 12`; or alone, in a cell whose column is one of results.
    pub number: String,
}

/// A word and its line.
type Word<'a> = (usize, &'a str);

/// All results in the prose and the tables of a page in Markdown, in its order. Code, comments, addresses of links, and what stands
/// in markers of figures and records are left out.
pub fn results(page: &str) -> Vec<ResultInProse> {
    let text = without_what_is_marked(page);
    let (mut section, mut named) = ("", 0);
    let mut found = Vec::new();
    let (mut paragraph, mut head): (Vec<Word<'_>>, Option<&str>) = (Vec::new(), None);
    for ((line, original), number) in text.lines().zip(page.lines()).zip(1..) {
        let trimmed = line.trim();
        if trimmed.starts_with('|') {
            in_sentences(&std::mem::take(&mut paragraph), &mut found);
            match head {
                None => head = Some(trimmed),
                Some(head) => in_row(number, head, trimmed, &mut found),
            }
            continue;
        }
        head = None;
        if trimmed.is_empty() || starts_block(trimmed) {
            in_sentences(&std::mem::take(&mut paragraph), &mut found);
        }
        if trimmed.starts_with('#') {
            name_section(&mut found[named..], section);
            named = found.len();
            section = original.trim_start_matches('#').trim();
        } else {
            paragraph.extend(trimmed.split_whitespace().map(|word| (number, word)));
        }
    }
    in_sentences(&paragraph, &mut found);
    name_section(&mut found[named..], section);
    found
}

/// Sets the section of results.
fn name_section(found: &mut [ResultInProse], section: &str) {
    found.iter_mut().for_each(|result| section.clone_into(&mut result.section));
}

/// Whether a line begins a heading or an item of a list.
fn starts_block(line: &str) -> bool {
    let mark = line.split(' ').next().unwrap_or_default();
    let number = mark.strip_suffix('.').unwrap_or_default();
    matches!(mark, "-" | "*") || mark.starts_with('#') || number.parse::<u8>().is_ok()
}

/// The text without what is not prose; each omission leaves a mark, and lines keep their numbers.
fn without_what_is_marked(text: &str) -> String {
    const PAIRS: [(&str, &str); 7] = [
        ("```", "```"),
        ("<!-- about figures", "<!-- /about -->"),
        ("<!-- recorded", "<!-- /recorded -->"),
        ("<!-- figure", "<!-- /figure"),
        ("<!--", "-->"),
        ("`", "`"),
        ("](", ")"),
    ];
    let mut kept = String::new();
    let mut rest = text;
    while let Some(next) = rest.chars().next() {
        let pair = PAIRS.iter().find(|(start, _)| rest.starts_with(start));
        let inside = pair.and_then(|(start, end)| {
            let at = rest.get(start.len()..)?.find(end)?;
            Some(start.len() + at + end.len())
        });
        let length = inside.unwrap_or(next.len_utf8());
        let (part, after) = rest.split_at(length);
        match inside {
            None => kept += part,
            // The place of a figure or a word of code, so that its neighbours do not meet.
            Some(_) => {
                kept += "_";
                kept.extend(part.chars().filter(|character| *character == '\n'));
            }
        }
        rest = after;
    }
    kept
}

/// Looks at a paragraph, sentence by sentence.
fn in_sentences(words: &[Word<'_>], found: &mut Vec<ResultInProse>) {
    let ends = |(_, word): &Word<'_>| {
        let word = word.trim_end_matches(['*', ')', '"']);
        word.ends_with(['.', ';', '?', '!']) && !matches!(word, "Eq." | "e.g." | "i.e." | "Fig.")
    };
    for sentence in words.split_inclusive(ends) {
        let says_result = sentence.iter().any(|(_, word)| is_result_word(word));
        in_words(sentence, says_result, found);
    }
}

/// Looks at the cells of a row, each under the head of its column. Rows that name commit and command are records.
fn in_row(line: usize, head: &str, row: &str, found: &mut Vec<ResultInProse>) {
    if is_head_of_records(head) {
        return;
    }
    let of_row = row.split_whitespace().any(is_result_word);
    for (head, cell) in head.split('|').zip(row.split('|')) {
        let says_result = head.split_whitespace().any(is_result_word);
        let has_unit = head.split_whitespace().any(|word| {
            let word = bare(word);
            word == "%" || UNITS_OF_RESULTS.contains(&word)
        });
        let words: Vec<Word<'_>> = cell.split_whitespace().map(|word| (line, word)).collect();
        let begins = words.first().is_some_and(|(_, word)| is_number(bare(word)));
        if begins && (says_result || has_unit) {
            let numbers = words.iter().filter(|(_, word)| is_number(bare(word)));
            found.extend(numbers.map(|(line, word)| result(*line, bare(word))));
        } else {
            in_words(&words, of_row || says_result, found);
        }
    }
}

/// Whether the rows under the head of a table state results with the commit and the command by which they were recorded.
pub fn is_head_of_records(head: &str) -> bool {
    let has = |name: &str| head.split('|').any(|cell| cell.trim() == name);
    has("recorded at") && has("command")
}

/// Looks at a sentence or a cell.
fn in_words(words: &[Word<'_>], says_result: bool, found: &mut Vec<ResultInProse>) {
    for (at, (line, word)) in words.iter().enumerate() {
        let after = |steps: usize| words.get(at + steps).map_or("", |(_, word)| bare(word));
        let number = bare(word);
        if !is_number(number) {
            continue;
        }
        let total = after(if matches!(after(2), "the" | "all" | "its" | "these" | "those") {
            3
        } else {
            2
        });
        let ends_sentence = word.ends_with([',', ';', '.', ')', ':']);
        if after(1) == "of" && is_count(number) && is_count(total) {
            found.push(result(*line, &format!("{number} of {total}")));
        } else if !ends_sentence && UNITS.contains(&after(1)) {
            let unit = after(1);
            let is_condition = TIMES.contains(&unit) && says_when(&words[..at]);
            if UNITS_OF_RESULTS.contains(&unit) || (says_result && !is_condition) {
                found.push(result(*line, &format!("{number} {unit}")));
            }
        }
    }
}

/// Whether the words before a time say when; `from 1 to 11 s` does as a whole.
fn says_when(before: &[Word<'_>]) -> bool {
    match before {
        [before @ .., (_, number), (_, "to" | "or" | "and")] if is_number(bare(number)) => {
            says_when(before)
        }
        [.., (_, word)] => WHEN.contains(&word.to_lowercase().as_str()),
        [] => false,
    }
}

fn result(line: usize, number: &str) -> ResultInProse {
    ResultInProse { line, section: String::new(), number: number.to_owned() }
}

fn is_result_word(word: &str) -> bool {
    RESULT_WORDS.contains(&bare(word).to_lowercase().as_str())
}

/// A word without punctuation and emphasis around it.
fn bare(word: &str) -> &str {
    word.trim_matches(['*', '(', ')', '[', ']', ',', ';', ':', '?', '!', '"', '±', '+'])
        .trim_end_matches('.')
}

/// Whether a word is a number in digits, such as `12`, `0.5`, `-3` or `1.7e11`.
fn is_number(word: &str) -> bool {
    word.starts_with(|first: char| first.is_ascii_digit() || first == '-')
        && word.parse::<f64>().is_ok()
}

fn is_count(word: &str) -> bool {
    word.parse::<u64>().is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(page: &str) -> Vec<String> {
        results(page).into_iter().map(|result| result.number).collect()
    }

    #[test]
    fn a_number_with_a_unit_is_a_result_where_the_sentence_says_so() {
        assert_eq!(numbers("The worst error was 3.2 K."), ["3.2 K"]);
        assert_eq!(numbers("It found\n0.02 to 4 % of them."), ["4 %"]);
        assert!(numbers("Wait until the display is within 3.2 K. The worst was found.").is_empty());
        assert_eq!(numbers("The skin is within 12 mK."), ["12 mK"]);
        assert_eq!(numbers("Of all (9 of 12) and 41 of the 45."), ["9 of 12", "41 of 45"]);
    }

    #[test]
    fn conditions_units_of_constants_and_code_are_no_results() {
        for page in [
            "The error was seen after 50 ms, and from 1 to 11 s.",
            "The error was found at 2 N and 34 °C.",
            "The error was `3 K`, by [a page](errors-3 K.md).",
            "Errors:\n```text\nwas 3 K\n```\n",
            "The error was <!-- figure a.b -->3 K<!-- /figure -->.",
            "<!-- recorded abcdef0 cargo run -->\nThe error was 3 K.\n<!-- at -->\n<!-- /recorded -->",
            "## 9 of 12 were found",
        ] {
            assert!(numbers(page).is_empty(), "{page}");
        }
    }

    #[test]
    fn results_know_the_heading_above_them() {
        let found = results("It is 1 mK.\n# A\nIt is 2 mK.\n## B `b`\n3 mK\n");
        let sections: Vec<_> = found.iter().map(|result| result.section.as_str()).collect();
        assert_eq!(sections, ["", "A", "B `b`"]);
    }

    #[test]
    fn cells_are_results_where_the_head_of_their_column_says_so() {
        let table = "| row | median, K | limit |\n|---|---|---|\n| 1 | 0.5, 7 | 9 s |";
        assert_eq!(numbers(table), ["0.5", "7"]);
        assert_eq!(results(table)[0].line, 3);
        assert!(
            numbers(
                "| median | recorded at | command |\n|---|---|---|\n| 0.5 K | 1234567 | cargo run |"
            )
            .is_empty()
        );
        assert_eq!(numbers("| a | b |\n|---|---|\n| worst | 9 s |"), ["9 s"]);
    }
}
