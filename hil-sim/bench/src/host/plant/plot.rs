//! Three panels: cost of a finger against their number, error against run time over meshes and over steps.
use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::ranged1d::Ranged;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::bodies::Errors;
use super::figures::{Cost, CutFigures, Figures};

const SIZE: (u32, u32) = (1100, 900);
/// Height of the upper panel.
const UPPER: u32 = 400;
const FONT: i32 = 15;
const CAPTION: (&str, i32) = ("sans-serif", 19);
const RADIUS: i32 = 5;
/// Required real-time factor.
const WANTED: f64 = 300.0;
/// Range of the number of fingers.
const FINGERS: Range<f64> = 0.85..48.0;

const GUIDE: RGBColor = RGBColor(0x77, 0x77, 0x77);
const RED: RGBColor = RGBColor(0xd6, 0x27, 0x28);
const BLUE: RGBColor = RGBColor(0x1f, 0x77, 0xb4);
const GREEN: RGBColor = RGBColor(0x2c, 0xa0, 0x2c);
const ORANGE: RGBColor = RGBColor(0xe3, 0x9c, 0x2b);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b, X, Y> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, Y>>;

/// A named series of points.
struct Series {
    name: &'static str,
    color: RGBColor,
    dots: Dots,
    points: Vec<(f64, f64)>,
}

/// Marker of a point.
#[derive(Clone, Copy)]
enum Dots {
    Full,
    /// Wide and hollow, visible around other markers.
    Rings,
}

impl Dots {
    fn radius(self) -> i32 {
        match self {
            Self::Full => RADIUS,
            Self::Rings => RADIUS + 3,
        }
    }

    fn style(self, color: RGBColor) -> ShapeStyle {
        match self {
            Self::Full => color.filled(),
            Self::Rings => color.stroke_width(2),
        }
    }
}

/// The picture as an SVG document.
///
/// # Errors
/// It cannot be drawn.
pub fn draw(figures: &Figures) -> anyhow::Result<String> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let (upper, lower) = root.split_vertically(UPPER);
        fingers(&upper, figures)?;
        let (left, right) = lower.split_horizontally(SIZE.0 / 2);
        let growth = |cut: &CutFigures| format!("{:.2}", cut.growth);
        let step = |cut: &CutFigures| format!("{} ms", cut.step_ms);
        errors(&left, "The bodies on other meshes (growth of the cells)", &figures.meshes, growth)?;
        errors(&right, "The bodies in other steps (step)", &figures.steps, step)?;
        root.present()?;
    }
    Ok(svg)
}

/// Cost of a finger against their number.
fn fingers(area: &Area<'_>, figures: &Figures) -> anyhow::Result<()> {
    let points = |of: fn(&Cost) -> f64| {
        let fingers = figures.fingers.iter();
        fingers.map(|f| (f.fingers as f64, of(&f.cost) * 1e-3)).collect()
    };
    let series = [
        Series {
            name: "median of the rounds",
            color: RED,
            dots: Dots::Full,
            points: points(|cost| cost.ns),
        },
        Series {
            name: "fastest round",
            color: BLUE,
            dots: Dots::Full,
            points: points(|cost| cost.least_ns),
        },
    ];
    let wanted_us = 1e3 / WANTED;
    let all = series.iter().flat_map(|s| &s.points);
    let top_us = all.fold(wanted_us, |top, p| top.max(p.1));
    let numbers = figures.fingers.iter().map(|f| f.fingers as f64).collect();
    let mut chart = ChartBuilder::on(area)
        .margin(14)
        .margin_right(30)
        .caption(
            "A finger's millisecond on one core: plant, truth, sensors, firmware's logic",
            CAPTION,
        )
        .x_label_area_size(46)
        .y_label_area_size(70)
        .build_cartesian_2d(FINGERS.log_scale().with_key_points(numbers), 0.0..1.25 * top_us)?;
    chart
        .configure_mesh()
        .x_desc("fingers on the core")
        .y_desc("us a finger and ms")
        .x_label_formatter(&|x| format!("{x}"))
        .y_label_formatter(&|y| format!("{y}"))
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.12))
        .label_style(("sans-serif", FONT))
        .axis_desc_style(("sans-serif", 17))
        .draw()?;
    let name = format!("wanted: {WANTED} times real time");
    guide(&mut chart, (FINGERS.start, FINGERS.end), wanted_us, name)?;
    rows(&mut chart, &series)?;
    legend(&mut chart, SeriesLabelPosition::LowerRight)
}

/// Errors against run time.
fn errors(
    area: &Area<'_>,
    caption: &str,
    cuts: &[CutFigures],
    name: impl Fn(&CutFigures) -> String,
) -> anyhow::Result<()> {
    let points =
        |of: fn(&CutFigures) -> f64| cuts.iter().map(|cut| (cut.cost.ns * 1e-3, of(cut))).collect();
    let series = [
        Series {
            name: "flux / (1e-4 dT/R)",
            color: BLUE,
            dots: Dots::Rings,
            points: points(|cut| cut.errors.counted.flux * 1e4),
        },
        Series {
            name: "surfaces / mK",
            color: RED,
            dots: Dots::Full,
            points: points(|cut| cut.errors.counted.surface_mk),
        },
        Series {
            name: "receptors / mK",
            color: GREEN,
            dots: Dots::Full,
            points: points(|cut| cut.errors.counted.inside_mk),
        },
        Series {
            name: "surfaces, 1 to 20 ms / mK",
            color: ORANGE,
            dots: Dots::Full,
            points: points(|cut| cut.errors.before.surface_mk),
        },
    ];
    let x = range(series[0].points.iter().map(|p| p.0));
    let y = range(series.iter().flat_map(|s| &s.points).map(|p| p.1).chain([1.0]));
    let x = x.start / 1.4..x.end * 1.4;
    let mut chart = ChartBuilder::on(area)
        .margin(14)
        .caption(caption, CAPTION)
        .x_label_area_size(46)
        .y_label_area_size(70)
        .build_cartesian_2d(
            x.clone().log_scale().with_key_points(round_numbers(&x)),
            (y.start / 3.0..y.end * 60.0).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc("us a simulated ms, bodies alone")
        .y_desc("largest error (from 20 ms on unless said)")
        .x_label_formatter(&|x| format!("{x}"))
        .y_label_formatter(&|y| format!("{y}"))
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.12))
        .label_style(("sans-serif", FONT))
        .axis_desc_style(("sans-serif", 17))
        .draw()?;
    guide(&mut chart, (x.start, x.end), 1.0, "wanted".into())?;
    rows(&mut chart, &series)?;
    let style =
        ("sans-serif", FONT).into_font().color(&BLACK).pos(Pos::new(HPos::Center, VPos::Bottom));
    chart.draw_series(cuts.iter().map(|cut| {
        let Errors { surface_mk, inside_mk, flux } = cut.errors.counted;
        let top = [surface_mk, inside_mk, flux * 1e4]
            .into_iter()
            .fold(cut.errors.before.surface_mk, f64::max);
        EmptyElement::at((cut.cost.ns * 1e-3, top)) + Text::new(name(cut), (0, -12), style.clone())
    }))?;
    legend(&mut chart, SeriesLabelPosition::UpperRight)
}

/// Smallest and largest value.
fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
    values.fold(f64::INFINITY..0.0, |all, v| all.start.min(v)..all.end.max(v))
}

/// 1, 2 and 5 times powers of ten in a range.
fn round_numbers(range: &Range<f64>) -> Vec<f64> {
    (-6..9)
        .flat_map(|power| [1.0, 2.0, 5.0].map(|lead| format!("{lead}e{power}")))
        .filter_map(|text| text.parse().ok())
        .filter(|number| range.contains(number))
        .collect()
}

/// A labelled reference level.
fn guide<X, Y>(
    chart: &mut Chart<'_, '_, X, Y>,
    (from, to): (f64, f64),
    level: f64,
    name: String,
) -> anyhow::Result<()>
where
    X: Ranged<ValueType = f64>,
    Y: Ranged<ValueType = f64>,
{
    chart.draw_series([PathElement::new([(from, level), (to, level)], GUIDE.stroke_width(2))])?;
    let style =
        ("sans-serif", FONT).into_font().color(&GUIDE).pos(Pos::new(HPos::Right, VPos::Bottom));
    chart.draw_series([EmptyElement::at((to, level)) + Text::new(name, (-8, -5), style)])?;
    Ok(())
}

/// Points joined by lines.
fn rows<X, Y>(chart: &mut Chart<'_, '_, X, Y>, series: &[Series]) -> anyhow::Result<()>
where
    X: Ranged<ValueType = f64>,
    Y: Ranged<ValueType = f64>,
{
    for one in series {
        let (style, radius) = (one.dots.style(one.color), one.dots.radius());
        chart.draw_series([PathElement::new(one.points.clone(), one.color.stroke_width(2))])?;
        chart
            .draw_series(one.points.iter().map(|p| Circle::new(*p, radius, style)))?
            .label(one.name)
            .legend(move |(x, y)| Circle::new((x + 12, y), radius, style));
    }
    Ok(())
}

fn legend<'a, 'b: 'a, X, Y>(
    chart: &mut Chart<'a, 'b, X, Y>,
    at: SeriesLabelPosition,
) -> anyhow::Result<()>
where
    X: Ranged<ValueType = f64>,
    Y: Ranged<ValueType = f64>,
{
    chart
        .configure_series_labels()
        .position(at)
        .legend_area_size(28)
        .margin(8)
        .background_style(WHITE)
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", FONT))
        .draw()?;
    Ok(())
}
