//! Worst error against estimated cycles.
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use model_bench::kernels::OURS;

use super::figures::Figures;

const SIZE: (u32, u32) = (1100, 760);
const FONT: i32 = 15;
const RADIUS: i32 = 6;

const FIRMWARE: RGBColor = RGBColor(0xd6, 0x27, 0x28);
const PEER: RGBColor = RGBColor(0x1f, 0x77, 0xb4);
const GUIDE: RGBColor = RGBColor(0x77, 0x77, 0x77);

/// A rectangle of pixels.
#[derive(Clone, Copy)]
struct Frame {
    left: i32,
    top: i32,
    right: i32,
    bottom: i32,
}

impl Frame {
    fn around((x, y): (i32, i32), half: i32) -> Self {
        Self { left: x - half, top: y - half, right: x + half, bottom: y + half }
    }

    /// Room of `text` whose left end is at `left` and whose middle is at the height `y`.
    fn of_text(text: &str, left: i32, y: i32) -> Self {
        Self { left, top: y - FONT / 2 - 1, right: left + width(text), bottom: y + FONT / 2 + 1 }
    }

    fn meets(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    fn lies_in(&self, other: &Self) -> bool {
        self.left >= other.left
            && self.right <= other.right
            && self.top >= other.top
            && self.bottom <= other.bottom
    }
}

/// Room that a text takes, generously: the backend draws letters smaller than their nominal size.
fn width(text: &str) -> i32 {
    text.chars().count() as i32 * FONT * 44 / 100
}

/// The plot as an SVG document.
///
/// # Errors
/// It cannot be drawn.
pub fn draw(figures: &Figures) -> anyhow::Result<String> {
    let points = |of: fn((f64, f64)) -> f64| {
        figures.kernels.iter().map(move |k| of((k.cost.cycles_max as f64, k.accuracy.worst_units)))
    };
    let range = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, 0f64), |(low, high), v| (low.min(v), high.max(v)))
    };
    let (x_low, x_high) = range(&mut points(|(x, _)| x));
    let (y_low, y_high) = range(&mut points(|(_, y)| y));
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&root)
            .margin(16)
            .margin_right(30)
            .caption(
                "E = erfcx(sqrt(n K)) on a Cortex-M4F: worst error against run time",
                ("sans-serif", 22),
            )
            .x_label_area_size(56)
            .y_label_area_size(84)
            .build_cartesian_2d(
                (x_low / 2.0..x_high * 3.0).log_scale(),
                (y_low / 20.0..y_high * 20.0).log_scale(),
            )?;
        chart
            .configure_mesh()
            .x_desc("most cycles of a call on the emulated STM32F446 (estimated)")
            .y_desc("worst error of E / 2^-32")
            .x_label_formatter(&|x| format!("{x}"))
            .y_label_formatter(&|y| format!("1e{}", y.log10().round() as i32))
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .label_style(("sans-serif", FONT))
            .axis_desc_style(("sans-serif", 17))
            .draw()?;
        let (xs, ys) = chart.plotting_area().get_pixel_range();
        let inside = Frame { left: xs.start, top: ys.start, right: xs.end, bottom: ys.end };
        let pixel = |x: f64, y: f64| chart.backend_coord(&(x, y));
        let mut taken = Vec::new();
        for (name, units) in [
            ("0.5 mK of set-point at 60 K", 0.5e-3 / figures.step_k * 2f64.powi(32)),
            ("half a unit: correctly rounded", 0.5),
        ] {
            let (_, y) = pixel(x_low, units);
            let text = Frame::of_text(name, inside.right - width(name) - 4, y - 10);
            root.draw(&PathElement::new(
                [(inside.left, y), (inside.right, y)],
                GUIDE.mix(0.7).stroke_width(1),
            ))?;
            write(&root, name, text, &GUIDE)?;
            let line = Frame { top: y, bottom: y + 1, ..inside };
            taken.extend([text, line]);
        }
        let better = "better: sooner done and closer";
        let corner = Frame::of_text(better, inside.left + 30, inside.bottom - 18);
        let tip = (inside.left + 8, inside.bottom - 8);
        for tail in [(tip.0 + 9, tip.1), (tip.0, tip.1 - 9), (tip.0 + 15, tip.1 - 15)] {
            root.draw(&PathElement::new([tip, tail], GUIDE.stroke_width(2)))?;
        }
        write(&root, better, corner, &GUIDE)?;
        let hollow = "hollow: NaN, infinite or off by more than 1 % at some z";
        let note = Frame::of_text(hollow, inside.right - width(hollow) - 8, inside.top + 16);
        write(&root, hollow, note, &GUIDE)?;
        taken.extend([corner, note]);
        let places: Vec<_> = figures
            .kernels
            .iter()
            .map(|k| pixel(k.cost.cycles_max as f64, k.accuracy.worst_units))
            .collect();
        taken.extend(places.iter().map(|place| Frame::around(*place, RADIUS + 2)));
        // The firmware's first: it gets the best place.
        for (kernel, place) in figures.kernels.iter().zip(places) {
            let color = if kernel.id == OURS { FIRMWARE } else { PEER };
            let style = match kernel.accuracy.breaks_at_z {
                Some(_) => color.stroke_width(2),
                None => color.filled(),
            };
            let radius = if kernel.id == OURS { RADIUS + 2 } else { RADIUS };
            let label = free_place(kernel.title, place, &inside, &taken);
            root.draw(&PathElement::new(
                [place, label.nearest(place)],
                color.mix(0.5).stroke_width(1),
            ))?;
            root.draw(&Circle::new(place, radius, WHITE.filled()))?;
            root.draw(&Circle::new(place, radius, style))?;
            write(&root, kernel.title, label, &color)?;
            taken.push(label);
        }
        root.present()?;
    }
    Ok(svg)
}

impl Frame {
    /// The point of the frame that is nearest to `place`.
    fn nearest(&self, (x, y): (i32, i32)) -> (i32, i32) {
        (x.clamp(self.left, self.right), y.clamp(self.top, self.bottom))
    }
}

/// Room for a label beside `place` that nothing else takes: the nearest of rings of candidates.
fn free_place(text: &str, place: (i32, i32), inside: &Frame, taken: &[Frame]) -> Frame {
    let (x, y) = place;
    let right = x + RADIUS + 5;
    let left = x - RADIUS - 5 - width(text);
    let middle = x - width(text) / 2;
    let candidates = (0..20).flat_map(|ring| {
        let far = ring * (FONT + 2);
        [
            (right, y - far),
            (right, y + far),
            (left, y - far),
            (left, y + far),
            (middle, y - far - 18),
            (middle, y + far + 18),
        ]
    });
    let frames = candidates.map(|(x, y)| Frame::of_text(text, x, y));
    frames
        .into_iter()
        .find(|frame| frame.lies_in(inside) && !taken.iter().any(|other| other.meets(frame)))
        .unwrap_or(Frame::of_text(text, right, y))
}

fn write(
    root: &DrawingArea<SVGBackend<'_>, Shift>,
    text: &str,
    frame: Frame,
    color: &RGBColor,
) -> anyhow::Result<()> {
    let style =
        ("sans-serif", FONT).into_font().color(color).pos(Pos::new(HPos::Center, VPos::Center));
    let middle = ((frame.left + frame.right) / 2, (frame.top + frame.bottom) / 2);
    root.draw(&Text::new(text.to_owned(), middle, style))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_at_one_point_do_not_overlap_and_stay_inside() {
        let inside = Frame { left: 0, top: 0, right: 600, bottom: 400 };
        for place in [(300, 200), (5, 5), (595, 395)] {
            let mut taken = vec![Frame::around(place, RADIUS)];
            for _ in 0..12 {
                let label = free_place("a label of some length", place, &inside, &taken);
                assert!(label.lies_in(&inside), "{place:?}");
                assert!(!taken.iter().any(|other| other.meets(&label)), "{place:?}");
                taken.push(label);
            }
        }
    }
}
