//! Draws the netlists: every block with its parts, values and net names, as one SVG picture.
//!
//! Parts stand in the order of the netlist. A terminal shows the name of its net; neighbours on the same net are joined by
//! a wire. Ground and supplies have their symbols.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::iter;

use anyhow::{Context, Result};

use crate::netlist::{FILES, Netlists, folder};
use crate::quantity::Short;

/// Nets that are drawn as a supply.
const SUPPLIES: [&str; 7] = ["v3", "v5", "v12", "vf", "vbr", "vm", "vstop"];
/// Size of the cell of a part with two or three terminals, and gap between rows.
const CELL: f64 = 96.0;
const HEIGHT: f64 = 120.0;
/// Cells in a row.
const COLUMNS: f64 = 14.0;
/// Height of a pin of a box.
const PIN: f64 = 14.0;

/// The only P-channel MOSFET of the netlists.
const P_CHANNEL: &str = "ipd90p03";

/// What the colours mean.
const KEY: [&str; 5] = [
    "Terminals of the same name within a block are connected. Red names leave the block; green ones do not. Ground is the block's own: power board or analog board (ground.cir).",
    "Grey, dashed: no part, but what the simulation has in its place. Numbers at boxes: pins of the usual package, recalled, check with the data sheet of the package that you buy.",
    "To be built, a grey resistor or inductor is a wire that joins its two names, and a grey capacitor is nothing. 0 is ground.",
    "Not drawn: 100 nF at every supply pin of an integrated circuit, capacitors of the gate driver (bom.csv); inputs of unused gates and amplifiers go to ground. Blocks of one finger come first, then those of five.",
    "Values: ohm, farad, henry; m is milli, M is mega.",
];

/// A part of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Part {
    name: String,
    nets: Vec<String>,
    /// Value, or the part's type.
    value: String,
    /// What a line that is no part stands for: the words behind `; model`.
    model: Option<String>,
    /// Of a MOSFET.
    is_p_channel: bool,
}

/// A block: a `.subckt` with its parts.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Block {
    title: String,
    /// What the ports are: the comment above the `.subckt` line.
    description: Vec<String>,
    ports: Vec<String>,
    parts: Vec<Part>,
}

/// An integrated circuit: a `.subckt` of `parts.cir` with the `*@` line above it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Kind {
    pins: Vec<String>,
    /// Name of the part to buy; empty if the line is missing.
    part: String,
    /// Pin numbers of the usual package, or the part's own names, by the netlist's name.
    numbers: BTreeMap<String, String>,
    /// What else is connected.
    note: String,
}

/// The picture of all files but `parts.cir`.
///
/// # Errors
/// A file cannot be read, or a value has no parameter.
pub fn draw() -> Result<String> {
    let netlists = Netlists::load()?;
    let kinds = kinds(&netlists.text());
    let (mut body, mut y) = (String::new(), 40.0);
    for line in KEY {
        text(&mut body, 20.0, y, "note", "start", line);
        y += 13.0;
    }
    y += 20.0;
    for name in FILES.iter().filter(|name| **name != "parts") {
        let path = folder().join(name).with_extension("cir");
        let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        let block = block(&text).with_context(|| path.display().to_string())?;
        y = draw_block(&mut body, y, &block, &netlists, &kinds)?;
    }
    let (width, height) = (COLUMNS * CELL + 60.0, y + 10.0);
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"sans-serif\" font-size=\"10\" stroke=\"black\" fill=\"none\">\n\
         <style>text{{stroke:none;fill:black}} .net{{fill:#0a5}} .port{{fill:#b30;font-weight:bold}} .note{{fill:#666;font-size:9px}} .model{{stroke:#aaa;stroke-dasharray:3 2}} \
         .model text{{fill:#888}} .value{{fill:#05a}} .title{{font-size:15px;font-weight:bold}}</style>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"white\" stroke=\"none\"/>\n{body}</svg>\n"
    ))
}

/// Every `.subckt` by its name.
fn kinds(text: &str) -> BTreeMap<String, Kind> {
    let mut kinds = BTreeMap::new();
    let mut above = "";
    for line in text.lines() {
        if let Some(rest) = line.strip_prefix(".subckt ") {
            let mut words = rest.split_whitespace().filter(|word| !word.contains('='));
            let Some(name) = words.next() else { continue };
            let mut fields = above.strip_prefix("*@ ").unwrap_or("").splitn(3, ';');
            let mut field = || fields.next().unwrap_or("").trim();
            let part = field().to_owned();
            let numbers = field()
                .split_whitespace()
                .filter_map(|pair| pair.split_once('='))
                .map(|(pin, number)| (pin.to_owned(), number.to_owned()));
            let kind = Kind {
                pins: words.map(str::to_owned).collect(),
                part,
                numbers: numbers.collect(),
                note: field().to_owned(),
            };
            kinds.insert(name.to_owned(), kind);
        }
        above = line;
    }
    kinds
}

/// The block of a file: its first `.subckt`, with the file's first line as its title.
fn block(text: &str) -> Option<Block> {
    let title = text.lines().next()?.trim_start_matches(['*', ' ']).to_owned();
    let above: Vec<_> = text.lines().take_while(|line| !line.starts_with(".subckt ")).collect();
    let mut description: Vec<_> =
        above.iter().rev().map_while(|line| line.strip_prefix("* ")).map(str::to_owned).collect();
    description.reverse();
    let mut lines = text.lines().skip_while(|line| !line.starts_with(".subckt "));
    let ports = lines.next()?.split_whitespace().skip(2);
    let ports = ports.map(str::to_owned).collect();
    let parts = lines
        .take_while(|line| !line.starts_with(".ends"))
        .filter(|line| line.starts_with(|c: char| c.is_ascii_alphabetic()))
        .filter_map(part)
        .collect();
    Some(Block { title, description, ports, parts })
}

/// A line of a part: name, nets, value or type.
fn part(line: &str) -> Option<Part> {
    let (line, comment) = line.split_once(';').unwrap_or((line, ""));
    let model = comment.trim().strip_prefix("model ").map(str::to_owned);
    let words: Vec<_> = line.split_whitespace().collect();
    let name = *words.first()?;
    let count = match name.chars().next()? {
        'M' | 'S' => 4,
        'Q' => 3,
        'X' => words.iter().filter(|word| !word.contains('=')).count() - 2,
        _ => 2,
    };
    let nets = words.get(1..=count)?;
    // Of a MOSFET drain, gate, source; of a contact its two ends.
    let nets = match name.chars().next()? {
        'M' => nets.get(..3)?,
        'S' => nets.get(..2)?,
        _ => nets,
    };
    Some(Part {
        name: name.to_owned(),
        nets: nets.iter().map(|net| (*net).to_owned()).collect(),
        value: (*words.get(count + 1)?).to_owned(),
        model,
        is_p_channel: words.get(count + 1) == Some(&P_CHANNEL),
    })
}

/// A value as it is printed: that of its parameter with a suffix, or the type.
fn shown(value: &str, netlists: &Netlists) -> Result<String> {
    let Some(name) = value.strip_prefix('{').and_then(|name| name.strip_suffix('}')) else {
        return Ok(value.to_owned());
    };
    let number = netlists.param(name)?;
    let (scale, suffix) =
        [(1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p")]
            .into_iter()
            .find(|(scale, _)| number >= 0.9999 * scale)
            .unwrap_or((1.0, ""));
    Ok(format!("{}{suffix}", Short(number / scale)))
}

/// Draws a block below `y`; the lower end of it.
fn draw_block(
    svg: &mut String,
    y: f64,
    block: &Block,
    netlists: &Netlists,
    kinds: &BTreeMap<String, Kind>,
) -> Result<f64> {
    text(svg, 20.0, y, "title", "start", &block.title);
    let ports = format!("Connects to other blocks by: {}", block.ports.join(", "));
    let mut top = y + 16.0;
    for (class, line) in
        iter::once(("port", &ports)).chain(block.description.iter().map(|line| ("note", line)))
    {
        text(svg, 20.0, top, class, "start", line);
        top += 13.0;
    }
    top += 12.0;
    let is_port = |net: &str| block.ports.iter().any(|port| port == net);
    let (mut x, mut row, mut tallest) = (30.0, top, HEIGHT);
    let mut before: Option<(f64, [String; 2])> = None;
    for part in &block.parts {
        let wide = part.name.starts_with('X');
        let width = match part.name.chars().next() {
            Some('X') => 2.0 * CELL,
            // Beside a transistor stand its type and the net of its control terminal.
            Some('M' | 'Q') => 1.4 * CELL,
            _ => CELL,
        };
        if x + width > COLUMNS * CELL + 30.0 {
            (x, row) = (30.0, row + tallest + 14.0);
            (before, tallest) = (None, HEIGHT);
        }
        let value = shown(&part.value, netlists)?;
        if wide {
            let kind = kinds.get(&part.value);
            let kind = kind.with_context(|| format!("no .subckt {}", part.value))?;
            tallest = f64::max(tallest, draw_box(svg, x, row, part, kind, &is_port));
            before = None;
        } else {
            let ends = draw_part(svg, x + width / 2.0, row, part, &value, &is_port);
            if let Some((before_x, before_ends)) = &before {
                for (end, at) in [(0, row + 18.0), (1, row + HEIGHT - 18.0)] {
                    if ends[end] == before_ends[end] && ends[end] != "0" {
                        line(svg, &[(*before_x, at), (x + width / 2.0, at)]);
                    }
                }
            }
            before = Some((x + width / 2.0, ends));
        }
        x += width;
    }
    Ok(row + tallest + 44.0)
}

/// Draws a part with two or three terminals in the middle of a cell; its upper and lower net.
fn draw_part(
    svg: &mut String,
    x: f64,
    y: f64,
    part: &Part,
    value: &str,
    is_port: &dyn Fn(&str) -> bool,
) -> [String; 2] {
    if part.model.is_some() {
        svg.push_str("<g class=\"model\">\n");
    }
    let (top, bottom, middle) = (y + 18.0, y + HEIGHT - 18.0, y + HEIGHT / 2.0);
    let kind = part.name.chars().next().unwrap_or('R');
    let mut ends = match kind {
        // Drain above the source, collector above the emitter; of a P channel the source is above.
        'M' if part.is_p_channel => [part.nets[2].clone(), part.nets[0].clone()],
        'M' | 'Q' => [part.nets[0].clone(), part.nets[2].clone()],
        _ => [part.nets[0].clone(), part.nets[1].clone()],
    };
    // Ground below, supplies above.
    let is_supply = |net: &str| SUPPLIES.contains(&net);
    let upside_down = ends[0] == "0" || (is_supply(&ends[1]) && !is_supply(&ends[0]));
    let turned = upside_down && !matches!(kind, 'M' | 'Q');
    if turned {
        ends.reverse();
    }
    for (net, at, towards) in [(&ends[0], top, middle - 18.0), (&ends[1], bottom, middle + 18.0)] {
        line(svg, &[(x, at), (x, towards)]);
        terminal(svg, x, at, net, at < middle, is_port(net));
    }
    match kind {
        'R' => rect(svg, x - 6.0, middle - 18.0, 12.0, 36.0),
        'C' => {
            for at in [middle - 4.0, middle + 4.0] {
                line(svg, &[(x - 12.0, at), (x + 12.0, at)]);
            }
            line(svg, &[(x, middle - 18.0), (x, middle - 4.0)]);
            line(svg, &[(x, middle + 4.0), (x, middle + 18.0)]);
        }
        'L' => {
            let _ = write!(svg, "<path d=\"M{x} {}", middle - 18.0);
            for _ in 0..3 {
                svg.push_str(" a6 6 0 0 1 0 12");
            }
            svg.push_str("\"/>\n");
        }
        'D' => {
            // The anode is the first net.
            let (anode, cathode) =
                if turned { (middle + 9.0, middle - 9.0) } else { (middle - 9.0, middle + 9.0) };
            line(svg, &[(x - 9.0, anode), (x + 9.0, anode), (x, cathode), (x - 9.0, anode)]);
            line(svg, &[(x - 9.0, cathode), (x + 9.0, cathode)]);
            line(svg, &[(x, middle - 18.0), (x, middle - 9.0)]);
            line(svg, &[(x, middle + 9.0), (x, middle + 18.0)]);
        }
        'S' => line(svg, &[(x, middle - 18.0), (x + 12.0, middle + 12.0), (x, middle + 18.0)]),
        _ => {
            // Transistor: channel or base bar, control terminal on the left.
            line(svg, &[(x - 12.0, middle - 16.0), (x - 12.0, middle + 16.0)]);
            line(svg, &[(x, middle - 18.0), (x, middle - 10.0), (x - 8.0, middle - 10.0)]);
            line(svg, &[(x, middle + 18.0), (x, middle + 10.0), (x - 8.0, middle + 10.0)]);
            line(svg, &[(x - 8.0, middle - 16.0), (x - 8.0, middle + 16.0)]);
            line(svg, &[(x - 26.0, middle), (x - 12.0, middle)]);
            if kind == 'Q' {
                // The emitter's arrow.
                line(svg, &[(x - 5.0, middle + 6.0), (x, middle + 10.0), (x - 5.0, middle + 14.0)]);
            } else {
                // Source: arrow into the channel of an N channel, out of that of a P channel.
                let (at, tip, tail) = if part.is_p_channel {
                    (middle - 10.0, x - 2.0, x - 7.0)
                } else {
                    (middle + 10.0, x - 7.0, x - 2.0)
                };
                line(svg, &[(tail, at - 3.0), (tip, at), (tail, at + 3.0)]);
            }
            let class = if is_port(&part.nets[1]) { "port" } else { "net" };
            text(svg, x - 24.0, middle - 3.0, class, "end", &part.nets[1]);
        }
    }
    text(svg, x + 15.0, middle - 2.0, "", "start", &part.name);
    text(svg, x + 15.0, middle + 10.0, "value", "start", value);
    if let Some(model) = &part.model {
        // In two lines beside the part.
        let (first, second) = model
            .match_indices(' ')
            .map(|(at, _)| model.split_at(at))
            .find(|(first, _)| first.len() > 8)
            .unwrap_or((model, ""));
        text(svg, x + 15.0, middle + 22.0, "note", "start", first);
        text(svg, x + 15.0, middle + 33.0, "note", "start", second.trim());
        svg.push_str("</g>\n");
    }
    ends
}

/// Draws an integrated circuit as a box with its pins, half of them on each side; its height.
fn draw_box(
    svg: &mut String,
    x: f64,
    y: f64,
    part: &Part,
    kind: &Kind,
    is_port: &dyn Fn(&str) -> bool,
) -> f64 {
    let pins = &kind.pins;
    let rows = pins.len().div_ceil(2);
    let height = f64::max(HEIGHT - 40.0, PIN * (rows as f64 + 2.5));
    let (left, right, top) = (x + 48.0, x + 2.0 * CELL - 48.0, y + 22.0);
    rect(svg, left, top, right - left, height - 22.0 + 8.0);
    let bought = if kind.part.is_empty() { &part.value } else { &kind.part };
    let title = format!("{} {bought}", part.name);
    text(svg, 0.5 * (left + right), top - 5.0, "value", "middle", &title);
    for (index, (pin, net)) in pins.iter().zip(&part.nets).enumerate() {
        let at = top + PIN * ((index % rows) as f64 + 1.0);
        let (edge, out, inner, anchors) = if index < rows {
            (left, -10.0, 3.0, ("start", "end"))
        } else {
            (right, 10.0, -3.0, ("end", "start"))
        };
        line(svg, &[(edge, at), (edge + out, at)]);
        let label = match kind.numbers.get(pin) {
            // A pin that the part itself names.
            Some(own) if own.starts_with(|c: char| c.is_ascii_alphabetic()) => own.clone(),
            Some(number) if index < rows => format!("{number}: {pin}"),
            Some(number) => format!("{pin}: {number}"),
            None => pin.clone(),
        };
        let class = if is_port(net) { "port" } else { "net" };
        text(svg, edge + inner, at + 3.0, "", anchors.0, &label);
        text(svg, edge + 1.2 * out, at + 3.0, class, anchors.1, net);
    }
    let middle = 0.5 * (left + right);
    let below = top + height - 22.0 + 8.0 + 12.0;
    text(svg, middle, below, "note", "middle", &kind.note);
    height + 34.0
}

/// The end of a part: ground, supply, or the name of the net.
fn terminal(svg: &mut String, x: f64, y: f64, net: &str, above: bool, is_port: bool) {
    if net == "0" {
        for (half, down) in [(9.0, 0.0), (6.0, 3.0), (3.0, 6.0)] {
            line(svg, &[(x - half, y + down), (x + half, y + down)]);
        }
        return;
    }
    if SUPPLIES.contains(&net) {
        line(svg, &[(x - 8.0, y), (x + 8.0, y)]);
    }
    text(
        svg,
        x + 3.0,
        if above { y - 3.0 } else { y + 10.0 },
        if is_port { "port" } else { "net" },
        "start",
        net,
    );
}

fn text(svg: &mut String, x: f64, y: f64, class: &str, anchor: &str, content: &str) {
    let content = content.replace('&', "&amp;").replace('<', "&lt;");
    let _ = writeln!(
        svg,
        "<text x=\"{x:.0}\" y=\"{y:.0}\" class=\"{class}\" text-anchor=\"{anchor}\">{content}</text>"
    );
}

fn line(svg: &mut String, points: &[(f64, f64)]) {
    let points: Vec<_> = points.iter().map(|(x, y)| format!("{x:.0},{y:.0}")).collect();
    let _ = writeln!(svg, "<polyline points=\"{}\"/>", points.join(" "));
}

fn rect(svg: &mut String, x: f64, y: f64, width: f64, height: f64) {
    let _ = writeln!(
        svg,
        "<rect x=\"{x:.0}\" y=\"{y:.0}\" width=\"{width:.0}\" height=\"{height:.0}\"/>"
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picture_in_the_repository_is_that_of_the_netlists() {
        let committed = fs::read_to_string(folder().join("schematic.svg")).unwrap();
        let drawn = draw().unwrap();
        assert!(committed == drawn, "cargo xtask hardware --schematic hardware/schematic.svg");
    }

    #[test]
    fn every_part_of_a_block_is_drawn_with_its_value() {
        let netlists = Netlists::from_text(".param r_in=4.7k");
        let text = "* Filter\n.subckt filter in out\nR1 in out {r_in}\nD1 0 out bav199\n.ends";
        let mut svg = String::new();
        let block = block(text).unwrap();
        draw_block(&mut svg, 0.0, &block, &netlists, &BTreeMap::new()).unwrap();
        for expected in [">R1<", ">4.7k<", ">D1<", ">bav199<", ">Filter<", ">out<"] {
            assert!(svg.contains(expected), "{expected}: {svg}");
        }
        assert!(shown("{r_out}", &netlists).is_err());
    }
}
