//! Self-contained HTML pages.

use std::path::Path;

use anyhow::Context;

const STYLE: &str = "body{font:16px/1.5 sans-serif;max-width:62rem;margin:2rem auto;padding:0 1rem;color:#222}\
table{border-collapse:collapse}td,th{padding:.2rem .8rem;border-bottom:1px solid #ddd;text-align:left}\
svg{max-width:100%;height:auto}code{background:#f3f3f3}";

/// A self-contained page: `title` is text, `style` is CSS in addition to the common style, `body` is HTML.
pub fn document(title: &str, style: &str, body: &str) -> String {
    let title = escape(title);
    format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>{title}</title>\
         <style>{STYLE}{style}</style><h1>{title}</h1>{body}</html>\n"
    )
}

/// The `<svg>` element of an SVG document for use in a page; empty if there is none.
pub fn svg_element(svg: &str) -> &str {
    svg.find("<svg").map_or("", |start| &svg[start..])
}

/// Text with HTML's special characters escaped.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Writes a file of a report into an existing folder.
///
/// # Errors
/// The file cannot be written; the error names its path.
pub fn write(folder: &Path, name: &str, bytes: impl AsRef<[u8]>) -> anyhow::Result<()> {
    let path = folder.join(name);
    std::fs::write(&path, bytes).with_context(|| path.display().to_string())
}
