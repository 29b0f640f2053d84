//! Wrong scenes: file, line, value, what is allowed.

use std::path::Path;

use thermal_sim::scene::Scene;

const HEAD: &str = "duration_s = 1\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"copper\"\n";

#[test]
fn wrong_tables_are_refused_with_line_value_and_what_is_allowed() {
    let blocks = include_str!("refused.txt").split("\n\n").skip(1);
    for block in blocks {
        let lines = block.lines().filter(|line| !line.starts_with('#'));
        let lines: Vec<_> = lines.collect();
        let (arrow, tables) = lines.split_last().expect("lines");
        let expected = arrow.strip_prefix("-> ").expect("an arrow");
        let (line, expected) = expected.split_once(": ").expect("a line and a message");
        let tables = tables.join("\n");
        let text = format!("{HEAD}{tables}\n");
        let Err(error) = Scene::parse(&text, Path::new("bad.toml")) else {
            panic!("{tables} is accepted");
        };
        let message = error.to_string();
        assert!(message.starts_with(&format!("bad.toml:{line}: ")), "{tables}: {message}");
        assert!(message.contains(expected), "{tables}: {message}");
    }
}

#[test]
fn an_unknown_law_is_refused_with_line_and_the_known_ones() {
    let error = Scene::parse(&format!("law = \"pid\"\n{HEAD}"), Path::new("bad.toml"))
        .expect_err("no such law");
    let message = error.to_string();
    assert!(message.starts_with("bad.toml:1: law = \"pid\"; known are pi-10hz, pi"), "{message}");
}

/// The file reader would take stack for each level: 80 brackets times 80 words are more than a thread has.
#[test]
fn what_nests_too_deeply_is_refused_with_its_line() {
    let words = |count: usize| vec!["a"; count].join(".");
    let nested = |count: usize, key: &str| {
        format!("x = {}1{}", format!("{{{key} = ").repeat(count), "}".repeat(count))
    };
    let key = |words: &str| format!("{words} begins a key of more than 8 words; allowed is 1 to 8");
    let brackets = "9 brackets in each other; allowed is 0 to 8".to_owned();
    for (rest, line, expected) in [
        (format!("[plant]\n{} = 1", words(9)), 7, key("a.a.a.a.a.a.a.a.")),
        (format!("[plant]\n'b' . {} = 1", words(82)), 7, key("'b' . a.a.a.a.a.a.a.")),
        (format!("[{}]\nx = 1", words(100)), 6, key("a.a.a.a.a.a.a.a.")),
        (format!("[plant]\nx = [1,\n{}", nested(80, &words(79))), 8, key("a.a.a.a.a.a.a.a.")),
        (format!("[plant]\n{}", nested(80, "a")), 7, brackets.clone()),
        (format!("x = [{}", "\n[".repeat(80)), 14, brackets),
        // As deep as may be, and no parameter.
        (
            format!("[plant]\n{}", nested(8, &words(8))),
            7,
            format!("no parameter is called x.{}", words(64)),
        ),
    ] {
        let text = format!("{HEAD}{rest}\n");
        let error = Scene::parse(&text, Path::new("bad.toml")).expect_err(&rest);
        let message = error.to_string();
        assert!(message.starts_with(&format!("bad.toml:{line}: {expected}")), "{rest}: {message}");
    }
}

#[test]
fn dots_and_brackets_in_text_and_comments_do_not_nest() {
    let text = format!(
        "# a.b.c.d.e.f.g.h.i.j [[[[[[[[[\n{HEAD}[[host]]\nt_s = 0.5 # {{{{{{{{{{{{{{{{{{\nline = \"a.b.c.d.e.f.g.h.i.j [[[[[[[[[\"\n"
    );
    let scene = Scene::parse(&text, Path::new("good.toml")).expect("a good scene");
    assert_eq!(scene.host[0].line, "a.b.c.d.e.f.g.h.i.j [[[[[[[[[");
}
