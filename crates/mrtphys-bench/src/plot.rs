//! Line plots as SVG: axes with ticks, logarithmic where wanted, markers that differ by shape as well as by color.

use std::fmt::Write;

/// How an axis is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// evenly
    Linear,
    /// by powers of ten
    Log,
    /// into equal fields about 0, 1, 2 and so on, one for each tick
    Fields,
}

/// Where an axis has its ticks.
#[derive(Clone, Debug)]
pub enum Ticks {
    /// decided by the range
    Auto,
    /// at these values
    At(Vec<f64>),
    /// at 0, 1, 2 and so on, with these names of one or more lines
    Named(Vec<String>),
}

/// An axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// quantity and unit
    pub label: String,
    /// division
    pub scale: Scale,
    /// values that must be within the axis, besides the data
    pub include: Vec<f64>,
    /// ticks that are wanted
    pub ticks: Ticks,
}

/// A line with markers.
#[derive(Clone, Debug)]
pub struct Series {
    /// name in the legend
    pub name: String,
    /// color as in SVG
    pub color: &'static str,
    /// shape of the markers
    pub marker: Marker,
    /// whether the points are joined
    pub line: bool,
    /// x, y, and whether the marker is open
    pub points: Vec<(f64, f64, bool)>,
}

/// Shape of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// disc
    Circle,
    /// square
    Square,
    /// triangle pointing up
    Triangle,
    /// square on its tip
    Diamond,
    /// triangle pointing down
    Wedge,
    /// two crossed strokes
    Cross,
    /// five-pointed star
    Star,
}

/// A plot.
#[derive(Clone, Debug)]
pub struct Plot {
    /// what stands above
    pub title: String,
    /// abscissa
    pub x: Axis,
    /// ordinate
    pub y: Axis,
    /// lines
    pub series: Vec<Series>,
    /// what is shaded
    pub band: Option<Band>,
}

/// A range that is shaded from edge to edge.
#[derive(Clone, Copy, Debug)]
pub struct Band {
    /// whether it is a range of x; else of y
    pub of_x: bool,
    /// its ends
    pub range: (f64, f64),
    /// what it is
    pub name: &'static str,
}

/// How plots are arranged.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// plots in a row
    pub columns: usize,
    /// width of the frame of a plot
    pub width: f64,
    /// height of the frame of a plot
    pub height: f64,
}

impl Layout {
    /// This many plots side by side.
    pub const fn row(columns: usize) -> Layout {
        Layout { columns, width: 420.0, height: 310.0 }
    }
}

const LEFT: f64 = 78.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 62.0;
const GAP: f64 = 22.0;
const LEGEND: f64 = 168.0;
const LINE: f64 = 16.0;
const SHADE: &str = "#ecece4";

/// The frame of a plot in the picture.
#[derive(Clone, Copy)]
struct Frame {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

/// Plots in rows, one legend for all, lines of text below.
pub fn figure(plots: &[Plot], layout: Layout, notes: &[String]) -> String {
    let columns = layout.columns.clamp(1, plots.len().max(1));
    let lines = plots.iter().map(|p| p.x.lines_of_ticks()).max().unwrap_or(1);
    let below = BOTTOM + LINE * (lines - 1) as f64;
    let (panel, row) = (LEFT + layout.width + GAP, TOP + layout.height + below);
    let foot = row * plots.len().div_ceil(columns) as f64;
    let width = panel * columns as f64 + LEGEND;
    let height = foot + LINE * notes.len() as f64 + 8.0;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\" font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\" \
         font-size=\"12\" fill=\"#222\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    for (i, plot) in plots.iter().enumerate() {
        let (left, top) = (panel * (i % columns) as f64 + LEFT, row * (i / columns) as f64 + TOP);
        draw(plot, Frame { left, top, right: left + layout.width, bottom: top + layout.height }, &mut out);
    }
    legend(plots, panel * columns as f64, &mut out);
    for (i, note) in notes.iter().enumerate() {
        let y = foot + LINE * i as f64;
        let _ = writeln!(
            out,
            "<text x=\"{}\" y=\"{y}\" font-size=\"11\" fill=\"#555\">{}</text>",
            LEFT - 60.0,
            escape(note)
        );
    }
    out + "</svg>\n"
}

/// Text as XML.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

impl Ticks {
    fn count(&self) -> usize {
        match self {
            Ticks::Auto => 0,
            Ticks::At(values) => values.len(),
            Ticks::Named(names) => names.len(),
        }
    }
}

impl Axis {
    fn lines_of_ticks(&self) -> usize {
        let Ticks::Named(names) = &self.ticks else { return 1 };
        names.iter().map(|n| n.split('\n').count()).max().unwrap_or(1)
    }
}

/// From values to places along an axis.
struct Ruler {
    scale: Scale,
    low: f64,
    high: f64,
    from: f64,
    to: f64,
    /// place among the values and text; without text: a minor tick
    ticks: Vec<(f64, Option<String>)>,
}

impl Ruler {
    fn new(axis: &Axis, values: impl Iterator<Item = f64>, from: f64, to: f64) -> Ruler {
        let usable = |v: &f64| v.is_finite() && (axis.scale != Scale::Log || *v > 0.0);
        let all: Vec<f64> = values.chain(axis.include.iter().copied()).filter(usable).collect();
        let (mut low, mut high) =
            all.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
        if low > high {
            (low, high) = (1.0, 10.0);
        }
        match axis.scale {
            // An eighth of a decade of air at least, more on a long axis, so that no marker sits on the frame.
            Scale::Log => {
                let air = (high / low).powf(0.04).max(1.35);
                (low, high) = (low / air, high * air);
            }
            Scale::Linear => {
                let air = if high > low { 0.05 * (high - low) } else { 0.5 * high.abs().max(1.0) };
                (low, high) = (if low == 0.0 { 0.0 } else { low - air }, high + air);
            }
            Scale::Fields => (low, high) = (-0.5, axis.ticks.count() as f64 - 0.5),
        }
        let ticks = match (&axis.ticks, axis.scale) {
            (Ticks::At(values), _) => values.iter().map(|t| (*t, Some(plain(*t)))).collect(),
            (Ticks::Named(names), _) => (0..).map(f64::from).zip(names.iter().cloned().map(Some)).collect(),
            (Ticks::Auto, Scale::Log) => decades(low, high),
            (Ticks::Auto, _) => even(low, high),
        };
        let ticks = ticks.into_iter().filter(|t: &(f64, _)| (low..=high).contains(&t.0)).collect();
        Ruler { scale: axis.scale, low, high, from, to, ticks }
    }

    fn place(&self, v: f64) -> f64 {
        let part = match self.scale {
            Scale::Linear | Scale::Fields => (v - self.low) / (self.high - self.low),
            Scale::Log => (v / self.low).ln() / (self.high / self.low).ln(),
        };
        self.from + part * (self.to - self.from)
    }
}

/// Ticks at powers of ten, minor ones between; over many decades, not every power has a number and nothing is between them.
fn decades(low: f64, high: f64) -> Vec<(f64, Option<String>)> {
    let span = (high / low).log10();
    let every = if span > 8.0 { 2 } else { 1 };
    let mut ticks = Vec::new();
    for power in low.log10().floor() as i32..=high.log10().ceil() as i32 {
        for digit in 1..if span > 8.0 { 2 } else { 10 } {
            let value = f64::from(digit) * 10f64.powi(power);
            let named = match digit {
                1 => power % every == 0,
                2 | 5 => span < 3.2,
                _ => false,
            };
            ticks.push((value, named.then(|| plain(value))));
        }
    }
    ticks
}

/// Ticks at multiples of 1, 2 or 5 times a power of ten.
fn even(low: f64, high: f64) -> Vec<(f64, Option<String>)> {
    let raw = (high - low) / 6.0;
    let power = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|k| k * power).into_iter().find(|s| *s >= raw).unwrap_or(raw);
    let first = (low / step).ceil() as i64;
    (first..=(high / step).floor() as i64).map(|k| (k as f64 * step, Some(plain(k as f64 * step)))).collect()
}

/// A number for people: thin spaces between thousands, large powers of ten as such.
pub fn plain(v: f64) -> String {
    if v != 0.0 && (v.abs() >= 1e6 || v.abs() < 1e-3) {
        let power = v.abs().log10().floor();
        let digit = v / 10f64.powf(power);
        let superscript: String = format!("{power}").chars().map(raised).collect();
        return if (digit - 1.0).abs() < 1e-9 {
            format!("10{superscript}")
        } else {
            format!("{}·10{superscript}", (digit * 100.0).round() / 100.0)
        };
    }
    let rounded = (v * 1e6).round() / 1e6;
    if rounded.fract() != 0.0 { rounded.to_string() } else { grouped(rounded as i64) }
}

/// A whole number with thin spaces between thousands.
pub fn grouped(v: i64) -> String {
    let digits = v.unsigned_abs().to_string();
    let mut out = String::from(if v < 0 { "-" } else { "" });
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) && digits.len() > 4 {
            out.push('\u{2009}');
        }
        out.push(c);
    }
    out
}

fn raised(c: char) -> char {
    match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' => '⁰',
        d => d.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(d),
    }
}

fn draw(plot: &Plot, frame: Frame, out: &mut String) {
    let Frame { left, top, right, bottom } = frame;
    let points = || plot.series.iter().flat_map(|s| &s.points);
    let x = Ruler::new(&plot.x, points().map(|p| p.0), left, right);
    let y = Ruler::new(&plot.y, points().map(|p| p.1), bottom, top);
    if let Some(band) = plot.band {
        let within = |ruler: &Ruler, v: f64, low: f64, high: f64| ruler.place(v).clamp(low, high);
        let (a, b) = band.range;
        let (x0, x1, y0, y1) = if band.of_x {
            (within(&x, a, left, right), within(&x, b, left, right), top, bottom)
        } else {
            (left, right, within(&y, b, top, bottom), within(&y, a, top, bottom))
        };
        let (width, height) = (x1 - x0, y1 - y0);
        let _ = writeln!(
            out,
            "<rect x=\"{x0:.1}\" y=\"{y0:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{SHADE}\"/>"
        );
    }
    ticks_of_x(&x, frame, out);
    ticks_of_y(&y, frame, out);
    let middle = 0.5 * (left + right);
    let below = 38.0 + LINE * (plot.x.lines_of_ticks() - 1) as f64;
    let _ = writeln!(
        out,
        "<rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#222\"/>\n\
         <text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\" font-size=\"14\" font-weight=\"bold\">{}</text>\n\
         <text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n\
         <text transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
        right - left,
        bottom - top,
        top - 14.0,
        escape(&plot.title),
        bottom + below,
        escape(&plot.x.label),
        left - 58.0,
        0.5 * (top + bottom),
        escape(&plot.y.label)
    );
    for series in &plot.series {
        curve(series, &x, &y, out);
    }
}

fn ticks_of_x(x: &Ruler, frame: Frame, out: &mut String) {
    let Frame { top, bottom, .. } = frame;
    for (value, text) in &x.ticks {
        let at = x.place(*value);
        if x.scale == Scale::Fields {
            // What lies between two fields is a line, what names a field is its middle.
            let border = x.place(*value - 0.5);
            let _ = writeln!(out, "<path d=\"M{border:.1} {top}V{bottom}\" stroke=\"#ddd\"/>");
        } else {
            let length = if text.is_some() { 5.0 } else { 3.0 };
            let _ = writeln!(out, "<path d=\"M{at:.1} {bottom}v-{length}\" stroke=\"#222\"/>");
        }
        for (i, line) in text.iter().flat_map(|t| t.split('\n')).enumerate() {
            let y = bottom + 17.0 + LINE * i as f64;
            let _ = writeln!(out, "<text x=\"{at:.1}\" y=\"{y}\" text-anchor=\"middle\">{}</text>", escape(line));
        }
    }
}

fn ticks_of_y(y: &Ruler, frame: Frame, out: &mut String) {
    let Frame { left, right, .. } = frame;
    for (value, text) in &y.ticks {
        let at = y.place(*value);
        if let Some(text) = text {
            let _ = writeln!(
                out,
                "<path d=\"M{left} {at:.1}H{right}\" stroke=\"#ddd\"/><path d=\"M{left} {at:.1}h5\" stroke=\"#222\"/>\
                 <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                left - 6.0,
                at + 4.0,
                escape(text)
            );
        } else {
            let _ = writeln!(out, "<path d=\"M{left} {at:.1}h3\" stroke=\"#222\"/>");
        }
    }
}

fn curve(series: &Series, x: &Ruler, y: &Ruler, out: &mut String) {
    let usable = |p: &&(f64, f64, bool)| {
        (x.scale != Scale::Log || p.0 > 0.0) && (y.scale != Scale::Log || p.1 > 0.0) && p.1.is_finite()
    };
    let places: Vec<(f64, f64, bool)> =
        series.points.iter().filter(usable).map(|p| (x.place(p.0), y.place(p.1), p.2)).collect();
    if series.line && places.len() > 1 {
        let path: Vec<String> = places.iter().map(|p| format!("{:.1},{:.1}", p.0, p.1)).collect();
        let _ = writeln!(
            out,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>",
            path.join(" "),
            series.color
        );
    }
    for (px, py, open) in places {
        marker(series, px, py, open, out);
    }
}

fn marker(series: &Series, x: f64, y: f64, open: bool, out: &mut String) {
    let color = series.color;
    let fill = if open { "#fff" } else { color };
    let polygon = |corners: &[(f64, f64)]| {
        let text: Vec<String> = corners.iter().map(|(a, b)| format!("{:.1},{:.1}", x + a, y + b)).collect();
        format!("<polygon points=\"{}\" fill=\"{fill}\" stroke=\"{color}\" stroke-width=\"1.3\"/>", text.join(" "))
    };
    let shape = match series.marker {
        Marker::Circle => {
            format!(
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{fill}\" stroke=\"{color}\" stroke-width=\"1.3\"/>"
            )
        }
        Marker::Square => polygon(&[(-3.6, -3.6), (3.6, -3.6), (3.6, 3.6), (-3.6, 3.6)]),
        Marker::Triangle => polygon(&[(0.0, -4.8), (4.4, 3.4), (-4.4, 3.4)]),
        Marker::Wedge => polygon(&[(0.0, 4.8), (4.4, -3.4), (-4.4, -3.4)]),
        Marker::Diamond => polygon(&[(0.0, -5.0), (5.0, 0.0), (0.0, 5.0), (-5.0, 0.0)]),
        Marker::Cross => format!(
            "<path d=\"M{:.1} {:.1}l7 7m0 -7l-7 7\" stroke=\"{color}\" stroke-width=\"1.8\" fill=\"none\"/>",
            x - 3.5,
            y - 3.5
        ),
        Marker::Star => {
            let corner = |k: usize| {
                let (radius, angle) =
                    (if k.is_multiple_of(2) { 7.5 } else { 3.2 }, std::f64::consts::PI * (k as f64 / 5.0 - 0.5));
                (radius * angle.cos(), radius * angle.sin())
            };
            polygon(&(0..10).map(corner).collect::<Vec<_>>())
        }
    };
    out.push_str(&shape);
    out.push('\n');
}

/// Every name once, in order of appearance; the marker is open where all are.
fn legend(plots: &[Plot], left: f64, out: &mut String) {
    let mut named: Vec<&Series> = Vec::new();
    for series in plots.iter().flat_map(|p| &p.series) {
        if !series.points.is_empty() && named.iter().all(|s| s.name != series.name) {
            named.push(series);
        }
    }
    let row = |i: usize| TOP + 12.0 + 22.0 * i as f64;
    if let Some(Band { name, .. }) = plots.iter().find_map(|p| p.band) {
        let y = row(named.len());
        let _ = writeln!(
            out,
            "<rect x=\"{left}\" y=\"{}\" width=\"30\" height=\"14\" fill=\"{SHADE}\" stroke=\"#ccc\"/>\
             <text x=\"{}\" y=\"{}\">{}</text>",
            y - 7.0,
            left + 38.0,
            y + 4.0,
            escape(name)
        );
    }
    for (i, series) in named.into_iter().enumerate() {
        let y = row(i);
        if series.line {
            let _ = writeln!(out, "<path d=\"M{left} {y}h30\" stroke=\"{}\" stroke-width=\"1.6\"/>", series.color);
        }
        marker(series, left + 15.0, y, series.points.iter().all(|p| p.2), out);
        let _ = writeln!(out, "<text x=\"{}\" y=\"{}\">{}</text>", left + 38.0, y + 4.0, escape(&series.name));
    }
}
