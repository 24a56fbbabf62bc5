//! The plots at the bottom: what happens over time, and the distribution of speeds.

use crate::testbed::window::ask::Inquiry;
use crate::testbed::window::desk::Desk;
use crate::testbed::window::format::{brief, deviation, number};
use crate::testbed::window::plot::{Chart, Gas, Histogram, Trace, csv, curves, grid, power_of_ten};
use eframe::egui::{self, Color32};
use egui_plot::{Bar, BarChart, HoverPosition, Line, LineStyle, Plot, PlotPoints, VLine};
use mrtphys_view::Stage;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Colors of curves (Okabe and Ito 2008), darkened where they would be faint on light.
const ON_LIGHT: [[u8; 3]; 10] = [
    [0x00, 0x72, 0xb2],
    [0xc9, 0x82, 0x00],
    [0x00, 0x8f, 0x68],
    [0xd5, 0x5e, 0x00],
    [0x2b, 0x8c, 0xc4],
    [0xb0, 0x4f, 0x87],
    [0x8a, 0x80, 0x00],
    [0x44, 0x44, 0x44],
    [0x7a, 0x3d, 0x9a],
    [0x00, 0x00, 0x00],
];
/// The same for a dark background.
const ON_DARK: [[u8; 3]; 10] = [
    [0x4a, 0xa8, 0xe8],
    [0xe6, 0x9f, 0x00],
    [0x20, 0xc9, 0x97],
    [0xff, 0x7a, 0x1a],
    [0x9a, 0xd4, 0xf5],
    [0xe5, 0x95, 0xc2],
    [0xf0, 0xe4, 0x42],
    [0xb0, 0xb8, 0xc0],
    [0xc3, 0x9b, 0xe0],
    [0xff, 0xff, 0xff],
];

/// While the scene runs it is looked at this often whether it is a gas.
const LOOK_EVERY: Duration = Duration::from_secs(1);

/// The area.
#[derive(Default)]
pub struct Plots {
    chart: Chart,
    /// the histogram that is shown, and of which report
    speeds: Option<(u64, Histogram)>,
    /// what is shown while the plots are held
    held: Option<Trace>,
    /// the scene that it is about
    opened: u64,
    gas: Inquiry<Option<Gas>>,
    asked: Option<(Arc<Stage>, Instant)>,
    reset: bool,
    /// curves that were switched off
    hidden: Vec<(Chart, &'static str)>,
}

impl Plots {
    /// Shows them.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        if self.opened != desk.opened {
            self.opened = desk.opened;
            (self.held, self.speeds, self.asked) = (None, None, None);
            self.gas.clear();
        }
        ui.horizontal_wrapped(|ui| {
            for (chart, name, _, hint) in Chart::ALL {
                let response = ui.selectable_value(&mut self.chart, chart, name).on_hover_text(hint);
                desk.probes.mark(name, &response);
            }
            ui.separator();
            let mut hold = self.held.is_some();
            let hint = "the plot stands still to be read; the simulation goes on";
            if ui.toggle_value(&mut hold, "Hold").on_hover_text(hint).changed() {
                self.held = hold.then(|| desk.trace.clone());
            }
            if ui.button("Whole").on_hover_text("shows everything again after zooming (double click)").clicked() {
                self.reset = true;
            }
            if ui
                .button("CSV")
                .on_hover_text("writes everything that was plotted into a file, one line a frame")
                .clicked()
            {
                self.write(desk);
            }
        });
        // The area keeps its height, whatever is in it.
        ui.set_min_height(ui.available_height());
        match self.chart {
            Chart::Speeds => self.histogram(ui, desk),
            chart => self.over_time(ui, desk, chart),
        }
    }

    fn over_time(&mut self, ui: &mut egui::Ui, desk: &Desk, chart: Chart) {
        if chart == Chart::Impacts {
            self.ask_for_gas(ui, desk);
        }
        let gas = self.gas.answer().copied().flatten();
        let shown = self.held.as_ref().unwrap_or(&desk.trace);
        let all = curves(chart, shown.moments(), gas.as_ref());
        let colors = if ui.visuals().dark_mode { &ON_DARK } else { &ON_LIGHT };
        let line_of = if ui.visuals().dark_mode { Color32::from_gray(120) } else { Color32::from_gray(150) };
        let now = desk.report().sides[0].numbers.time;
        let mut plot = frame(chart, self.reset).x_axis_label("simulated time [s]");
        if chart == Chart::Drift {
            plot = plot
                .y_axis_formatter(|mark, _| power_of_ten(mark.value))
                .y_grid_spacer(egui_plot::uniform_grid_spacer(|_| [1.0, 3.0, 6.0]))
                .include_y(-16.5)
                .include_y(-13.0);
        }
        plot = plot.label_formatter(move |at| label(chart, at));
        self.reset = false;
        let color = |i: usize| Color32::from(Srgb(colors[i % colors.len()]));
        let entries: Vec<(&'static str, Color32)> = all.iter().map(|c| (c.name, color(c.color))).collect();
        ui.horizontal_wrapped(|ui| self.legend(ui, chart, &entries));
        let hidden = self.hidden.clone();
        plot.show(ui, |ui| {
            for curve in all.into_iter().filter(|c| !hidden.contains(&(chart, c.name))) {
                let style = if curve.dashed { LineStyle::dashed_loose() } else { LineStyle::Solid };
                let line = Line::new(curve.name, PlotPoints::from(curve.points));
                ui.line(line.color(color(curve.color)).style(style).width(1.6));
            }
            ui.vline(VLine::new("", now).color(line_of).width(1.0).allow_hover(false));
        });
    }

    /// Whether the scene is a gas whose rate of collisions theory knows.
    fn ask_for_gas(&mut self, ui: &egui::Ui, desk: &Desk) {
        let stage = &desk.report().sides[0].shot.stage;
        let due = self.asked.as_ref().is_none_or(|(s, at)| !Arc::ptr_eq(s, stage) || at.elapsed() > LOOK_EVERY);
        // A gas of a million is looked at when it comes, and not again every second.
        let again = self.asked.is_none() || stage.body_count() < 50_000;
        if due && again && !self.gas.is_waiting() {
            self.gas.ask(&desk.session, ui.ctx(), |studio| Gas::of(&studio.loaded.world));
            self.asked = Some((stage.clone(), Instant::now()));
        }
    }

    fn histogram(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        desk.wish.speeds = true;
        let number_of_report = desk.report().number;
        if self.held.is_none() && self.speeds.as_ref().is_none_or(|s| s.0 != number_of_report) {
            let found = Histogram::new(&desk.report().sides[0].extras.speeds);
            self.speeds = found.map(|h| (number_of_report, h));
        }
        let Some((_, h)) = self.speeds.take() else {
            ui.weak("Nothing moves.");
            return;
        };
        let colors = if ui.visuals().dark_mode { &ON_DARK } else { &ON_LIGHT };
        let color = |i: usize| Color32::from(Srgb(colors[i]));
        let (chi, bins) = h.chi_squared();
        let (bodies, errors, theory) = ("bodies", "root of their number", "Maxwell and Boltzmann");
        ui.horizontal_wrapped(|ui| {
            let entries = [(bodies, color(0)), (errors, color(7)), (theory, color(3))];
            self.legend(ui, Chart::Speeds, &entries);
            if bins > 2 {
                let hint = "about as large as the number of bins in equilibrium; much larger: no equilibrium yet";
                ui.weak(format!("chi squared {} of {bins} bins", brief(chi))).on_hover_text(hint);
            }
        });
        let shows = |name: &'static str| !self.hidden.contains(&(Chart::Speeds, name));
        let [bodies_on, errors_on, theory_on] = [bodies, errors, theory].map(shows);
        let middle = |i: usize| (i as f64 + 0.5) * h.width;
        let bars: Vec<Bar> = h
            .counts
            .iter()
            .enumerate()
            .map(|(i, n)| Bar::new(middle(i), f64::from(*n)).width(h.width * 0.92))
            .collect();
        let error = |i: usize, n: f64| vec![[middle(i), (n - n.sqrt()).max(0.0)], [middle(i), n + n.sqrt()]];
        let plot = frame(Chart::Speeds, self.reset).x_axis_label("speed [m/s]").include_y(0.0).include_x(0.0);
        self.reset = false;
        plot.label_formatter(|at| label(Chart::Speeds, at)).show(ui, |ui| {
            if bodies_on {
                ui.bar_chart(BarChart::new(bodies, bars).color(color(0).gamma_multiply(0.55)).allow_hover(false));
            }
            for (i, n) in h.counts.iter().enumerate().filter(|(_, n)| errors_on && **n > 0) {
                let bar = Line::new(errors, error(i, f64::from(*n)));
                ui.line(bar.color(color(7)).width(1.2).allow_hover(false));
            }
            if theory_on {
                ui.line(Line::new(theory, h.curve.clone()).color(color(3)).width(2.0));
            }
        });
        self.speeds = Some((number_of_report, h));
    }

    /// The names of the curves; a click switches one off and on.
    fn legend(&mut self, ui: &mut egui::Ui, chart: Chart, entries: &[(&'static str, Color32)]) {
        for (name, color) in entries {
            let key = (chart, *name);
            let on = !self.hidden.contains(&key);
            let faint = if on { *color } else { color.gamma_multiply(0.3) };
            let (rect, line) = ui.allocate_exact_size(egui::vec2(16.0, 14.0), egui::Sense::click());
            ui.painter().rect_filled(rect.shrink2(egui::vec2(0.0, 5.0)), 1.0, faint);
            let text = if on { egui::RichText::new(*name) } else { egui::RichText::new(*name).weak() };
            let label = ui.add(egui::Label::new(text.small()).sense(egui::Sense::click()));
            let hint = if on { "click to hide this curve" } else { "click to show this curve" };
            if line.clicked() || label.on_hover_text(hint).clicked() {
                if on { self.hidden.push(key) } else { self.hidden.retain(|k| *k != key) }
            }
            ui.add_space(6.0);
        }
    }

    /// Writes what was plotted beside where the program was started.
    fn write(&self, desk: &mut Desk) {
        let text = csv(self.held.as_ref().unwrap_or(&desk.trace).moments());
        let path = free_path(&desk.name, |p| p.exists());
        match std::fs::write(&path, text) {
            Ok(()) => desk.say(format!("Plots written to {}", path.display())),
            Err(e) => desk.complain(format!("{}: {e}", path.display())),
        }
    }
}

/// A color as bytes.
struct Srgb([u8; 3]);

impl From<Srgb> for Color32 {
    fn from(Srgb([r, g, b]): Srgb) -> Color32 {
        Color32::from_rgb(r, g, b)
    }
}

/// A plot as all of them are.
fn frame<'a>(chart: Chart, reset: bool) -> Plot<'a> {
    let plot = Plot::new(("plot", chart.unit(), chart as u8))
        .y_axis_label(chart.unit())
        .y_axis_min_width(52.0)
        .y_axis_formatter(|mark, _| number(mark.value))
        .x_grid_spacer(|input| grid::marks(&input, 90.0))
        .y_grid_spacer(|input| grid::marks(&input, 32.0))
        .grid_spacing(egui::Rangef::new(grid::FINEST, 900.0))
        .allow_scroll(false)
        .set_margin_fraction(egui::vec2(0.01, 0.08));
    if reset { plot.reset() } else { plot }
}

/// What stands beside the mouse.
fn label(chart: Chart, at: &HoverPosition<'_>) -> Option<String> {
    let HoverPosition::NearDataPoint { plot_name, position, .. } = at else { return None };
    let value = match chart {
        Chart::Drift => deviation(10f64.powf(position.y)),
        Chart::Speeds => {
            return Some(format!("{plot_name}: {} bodies\nat {} m/s", brief(position.y), brief(position.x)));
        }
        _ => format!("{} {}", number(position.y), chart.unit()),
    };
    Some(format!("{plot_name}: {value}\nat {} s", number(position.x)))
}

/// The first name in a row that no file has: `cube-8-plots.csv`, `cube-8-plots-2.csv`.
fn free_path(scene: &str, exists: impl Fn(&std::path::Path) -> bool) -> PathBuf {
    let stem = scene.rsplit(['/', '\\']).next().unwrap_or(scene).trim_end_matches(".toml");
    let stem = if stem.is_empty() { "scene" } else { stem };
    let name = |n: u32| match n {
        1 => PathBuf::from(format!("{stem}-plots.csv")),
        n => PathBuf::from(format!("{stem}-plots-{n}.csv")),
    };
    (1..10_000).map(name).find(|p| !exists(p)).unwrap_or_else(|| name(10_000))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn no_file_is_overwritten() {
        assert_eq!(free_path("thesis/cube-8", |_| false), Path::new("cube-8-plots.csv"));
        assert_eq!(free_path("/a/b/pile.toml", |p| p == Path::new("pile-plots.csv")), Path::new("pile-plots-2.csv"));
        assert_eq!(free_path("", |_| false), Path::new("scene-plots.csv"));
    }

    #[test]
    fn curves_stand_out_from_their_background() {
        for (colors, dark) in [(ON_LIGHT, false), (ON_DARK, true)] {
            for [r, g, b] in colors {
                let light = mrtphys_view::palette::to_linear(r) * 0.2126
                    + mrtphys_view::palette::to_linear(g) * 0.7152
                    + mrtphys_view::palette::to_linear(b) * 0.0722;
                // Contrast of at least 3 (WCAG 2.1) with white, or with egui's dark grey.
                let contrast = if dark { (light + 0.05) / (0.011 + 0.05) } else { 1.05 / (light + 0.05) };
                assert!(contrast >= 3.0, "{r:x} {g:x} {b:x}: {contrast}");
            }
        }
    }
}
