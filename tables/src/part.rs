//! A generated part of a file, between its markers.

use anyhow::{Context, Result};

/// What stands between two markers of a file.
pub struct Part {
    /// The file, from the root of the workspace.
    pub file: &'static str,
    /// Name in the markers.
    pub name: &'static str,
    /// The generated text: in Markdown what is between the markers, elsewhere lines without indentation.
    pub text: String,
}

/// How every part of a file begins, and how it ends.
pub fn markers(file: &str) -> (&'static str, &'static str) {
    if file.ends_with(".md") {
        ("<!-- table ", "<!-- /table -->")
    } else {
        ("# generated: ", "# /generated")
    }
}

impl Part {
    /// The file's content with this part in it.
    pub fn put_into(&self, content: &str) -> Result<String> {
        let (begins, ends) = markers(self.file);
        let is_markdown = self.file.ends_with(".md");
        let begins = format!("{begins}{}{}", self.name, if is_markdown { " -->" } else { "\n" });
        let found = content.split_once(&begins);
        let (before, after) = found.with_context(|| format!("{} has no {begins:?}", self.file))?;
        let (_, after) = after
            .split_once(ends)
            .with_context(|| format!("{}: {begins:?} without {ends:?}", self.file))?;
        let text = if is_markdown { self.text.clone() } else { indented(&self.text, before) };
        Ok([before, &begins, &text, ends, after].concat())
    }
}

/// The lines with the indentation at the end of `before`, also ahead of what follows.
fn indented(lines: &str, before: &str) -> String {
    let indentation = before.rsplit('\n').next().unwrap_or_default();
    let line =
        |line: &str| if line.is_empty() { "\n".into() } else { format!("{indentation}{line}\n") };
    let lines: String = lines.lines().map(line).collect();
    lines + indentation
}

#[cfg(test)]
mod tests {
    use super::*;

    fn put(file: &'static str, content: &str) -> Result<String> {
        Part { file, name: "a", text: "new\nlines\n".into() }.put_into(content)
    }

    #[test]
    fn only_what_is_between_the_markers_changes() {
        let page = |inside: &str| {
            format!("<!-- table ab -->x<!-- /table --> | <!-- table a -->{inside}<!-- /table --> |")
        };
        assert_eq!(put("x.md", &page("old")).unwrap(), page("new\nlines\n"));
        let list =
            |inside: &str| format!("x = [\n    # generated: a\n{inside}    # /generated\n]\n");
        let expected = list("    new\n    lines\n");
        assert_eq!(put("x.py", &list("    old\n")).unwrap(), expected);
        assert_eq!(put("x.py", &expected).unwrap(), expected);
    }

    #[test]
    fn a_missing_marker_is_named_with_its_file() {
        for (file, content, named) in [
            ("x.md", "<!-- table b --><!-- /table -->", "x.md has no \"<!-- table a -->\""),
            ("x.md", "<!-- table a -->", "\"<!-- table a -->\" without \"<!-- /table -->\""),
            ("x.dict", "# generated: b\n# /generated\n", "x.dict has no \"# generated: a\\n\""),
        ] {
            let error = put(file, content).unwrap_err().to_string();
            assert!(error.contains(named), "{error}");
        }
    }
}
