//! Section Bodies: all of them in a list, found by name, and a form that makes new ones.

use super::making::{self, Kind, Pattern};
use crate::testbed::session::Studio;
use crate::testbed::window::ask::Inquiry;
use crate::testbed::window::desk::Desk;
use crate::testbed::window::format::count;
use crate::testbed::window::quantity::Entry;
use eframe::egui;
use mrtphys::{BodyId, Real, Vec3};
use mrtphys_scene::scene::MassDesc;
use mrtphys_view::Stage;
use std::sync::Arc;

/// A body in the list.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// handle
    pub id: BodyId,
    /// name
    pub name: String,
    /// kind of shape
    pub kind: String,
    /// whether it never moves
    pub fixed: bool,
}

/// More bodies are not listed: nobody scrolls through them, and their names would cost the simulation time.
const MOST_ROWS: usize = 50_000;
/// Rows that are seen at once.
const VISIBLE: f32 = 8.0;

/// The bodies of a scene.
#[derive(Clone, Debug, Default)]
struct Roster {
    rows: Vec<Row>,
    /// how many there are in all
    all: usize,
}

impl Roster {
    fn of(studio: &Studio<'_>) -> Roster {
        let world = &studio.loaded.world;
        let row = |id: BodyId| {
            let body = world.body(id).ok()?;
            let name = studio.loaded.names.body_name(id).unwrap_or_else(|| body.kind.clone());
            Some(Row { id, name, fixed: body.mass == Real::INFINITY, kind: body.kind })
        };
        Roster { rows: world.bodies().take(MOST_ROWS).filter_map(row).collect(), all: world.body_count() }
    }
}

/// Numbers of the rows whose name or kind contains every word of the filter, whatever its case.
pub fn found(rows: &[Row], filter: &str) -> Vec<usize> {
    let words: Vec<String> = filter.split_whitespace().map(str::to_lowercase).collect();
    let has = |row: &Row, word: &String| {
        let state = if row.fixed { "fixed" } else { "" };
        row.name.to_lowercase().contains(word) || row.kind.contains(word.as_str()) || state == word
    };
    (0..rows.len()).filter(|&i| words.iter().all(|w| has(&rows[i], w))).collect()
}

/// The section.
pub struct Bodies {
    roster: Inquiry<Roster>,
    /// the stage that the roster was asked for
    asked: Option<Arc<Stage>>,
    filter: String,
    /// rows that match, for this filter and this many rows
    matching: (String, usize, Vec<usize>),
    /// the selection that the list last showed
    shown: Option<BodyId>,
    form: Form,
}

impl Default for Bodies {
    fn default() -> Bodies {
        Bodies {
            roster: Inquiry::default(),
            asked: None,
            filter: String::new(),
            matching: (String::new(), usize::MAX, Vec::new()),
            shown: None,
            form: Form::default(),
        }
    }
}

impl Bodies {
    /// Shows it.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let stage = desk.report().sides[0].shot.stage.clone();
        if self.asked.as_ref().is_none_or(|s| !Arc::ptr_eq(s, &stage)) {
            self.roster.ask(&desk.session, ui.ctx(), Roster::of);
            self.asked = Some(stage);
            self.matching.1 = usize::MAX;
        }
        let field = egui::TextEdit::singleline(&mut self.filter).hint_text("name, kind or 'fixed'");
        ui.add(field.desired_width(f32::INFINITY))
            .on_hover_text("shows only bodies whose name or kind has these words");
        self.list(ui, desk);
        ui.add_space(4.0);
        let form = egui::CollapsingHeader::new("Add a body").default_open(false);
        let shown = form.show_unindented(ui, |ui| self.form.show(ui, desk));
        let header = shown.header_response.on_hover_text("a form for a new body");
        desk.probes.mark("bodies.add", &header);
    }

    fn list(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let waiting = self.roster.is_waiting();
        let Some(roster) = self.roster.answer() else {
            ui.weak("...");
            return;
        };
        if waiting || self.matching.0 != self.filter || self.matching.1 != roster.rows.len() {
            self.matching = (self.filter.clone(), roster.rows.len(), found(&roster.rows, &self.filter));
        }
        let matching = &self.matching.2;
        ui.weak(told(matching.len(), roster.rows.len(), roster.all));
        let height = ui.text_style_height(&egui::TextStyle::Body) + 2.0;
        let mut area = egui::ScrollArea::vertical().id_salt("bodies").max_height(VISIBLE * (height + 3.0));
        // What was selected elsewhere is scrolled to.
        if desk.selected != self.shown {
            self.shown = desk.selected;
            let row = matching.iter().position(|&i| Some(roster.rows[i].id) == desk.selected);
            if let Some(row) = row {
                let offset = (row as f32 - VISIBLE / 2.0) * (height + ui.spacing().item_spacing.y);
                area = area.vertical_scroll_offset(offset.max(0.0));
            }
        }
        area.auto_shrink([false, true]).show_rows(ui, height, matching.len(), |ui, range| {
            for row in range.filter_map(|r| matching.get(r)).map(|&i| &roster.rows[i]) {
                let label = if row.fixed { format!("{} (fixed)", row.name) } else { row.name.clone() };
                let response = ui.selectable_label(desk.selected == Some(row.id), label).on_hover_text(&row.kind);
                if response.clicked() {
                    desk.selected = if desk.selected == Some(row.id) { None } else { Some(row.id) };
                    self.shown = desk.selected;
                }
                if response.double_clicked() {
                    (desk.selected, self.shown) = (Some(row.id), Some(row.id));
                    desk.seeing.look_at = Some(row.id);
                }
            }
        });
    }
}

/// What the list shows.
fn told(matching: usize, listed: usize, all: usize) -> String {
    let bodies = |n: usize| format!("{} bod{}", count(n as u64), if n == 1 { "y" } else { "ies" });
    let mut text =
        if matching == listed { bodies(listed) } else { format!("{} of {}", count(matching as u64), bodies(listed)) };
    if listed < all {
        text += &format!(" (the first of {})", count(all as u64));
    }
    text
}

/// Where a new body is put.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Where {
    LookPoint,
    Position,
}

/// The form for a new body.
struct Form {
    /// `None`: sizes that suit the scene were not found yet
    pattern: Option<Pattern>,
    place: Where,
    position: Vec3,
    /// speed of a throw \[m/s\]; `None`: as suits the scene
    speed: Option<Real>,
    /// the scene that the sizes suit
    opened: u64,
    changed: Option<u64>,
}

impl Default for Form {
    fn default() -> Form {
        Form { pattern: None, place: Where::LookPoint, position: Vec3::ZERO, speed: None, opened: 0, changed: None }
    }
}

impl Form {
    fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        if self.opened != desk.opened {
            (self.opened, self.pattern, self.speed) = (desk.opened, None, None);
        }
        let distance = desk.camera.distance();
        let mut pattern = self.pattern.unwrap_or_else(|| Pattern::sphere(usual_size(distance)));
        egui::Grid::new("new body").num_columns(2).spacing([6.0, 4.0]).show(ui, |ui| {
            sizes(ui, &mut pattern);
            mass(ui, &mut pattern);
            ui.label("Velocity");
            let entry = Entry::any("m/s", distance * 0.2, "velocity of a body that is added");
            pattern.velocity = entry.vector(ui, pattern.velocity).unwrap_or(pattern.velocity);
            ui.end_row();
            ui.label("Angular vel.");
            let entry = Entry::any("rad/s", 1.0, "angular velocity of a new body");
            pattern.spin = entry.vector(ui, pattern.spin).unwrap_or(pattern.spin);
            ui.end_row();
            ui.label("Where");
            ui.horizontal(|ui| {
                ui.selectable_value(&mut self.place, Where::LookPoint, "look point")
                    .on_hover_text("at the point in the middle of the picture that the camera turns about");
                ui.selectable_value(&mut self.place, Where::Position, "position")
                    .on_hover_text("at a place given here");
            });
            ui.end_row();
            if self.place == Where::Position {
                ui.label("Position");
                let entry = Entry::any("m", distance * 0.1, "centre of mass");
                self.position = entry.vector(ui, self.position).unwrap_or(self.position);
                ui.end_row();
            }
            ui.label("Throw speed");
            let usual = short_speed(distance);
            let entry = Entry::positive("m/s", usual, "speed of a body thrown from the eye");
            self.speed = entry.show(ui, self.speed.unwrap_or(usual)).or(self.speed);
            ui.end_row();
        });
        self.pattern = Some(pattern);
        self.buttons(ui, desk, pattern);
    }

    fn buttons(&mut self, ui: &mut egui::Ui, desk: &mut Desk, pattern: Pattern) {
        let complaint = pattern.complaint();
        let (camera, place) = (desk.camera, self.place);
        let near = if place == Where::Position { self.position } else { camera.look_at };
        ui.add_enabled_ui(complaint.is_none(), |ui| {
            ui.horizontal(|ui| {
                let hint = "makes the body at the free place nearest to the one chosen";
                let added = ui.button("Add").on_hover_text(hint);
                desk.probes.mark("add-body", &added);
                if added.clicked() {
                    self.changed = Some(desk.report().troubles);
                    desk.edit(true, move |loaded| making::add(loaded, &pattern, near).map(drop));
                }
                let hint =
                    "shoots the body from the eye along the middle line of sight, from where that enters the walls (B)";
                if ui.button("Throw from the eye").on_hover_text(hint).clicked() {
                    self.changed = Some(desk.report().troubles);
                    let speed = self.speed.unwrap_or(short_speed(camera.distance()));
                    throw(desk, pattern, speed);
                }
            });
        });
        let trouble = self.changed.filter(|n| desk.report().troubles > *n).and(desk.report().trouble.clone());
        if let Some(text) = complaint.map(str::to_string).or(trouble) {
            ui.colored_label(ui.visuals().error_fg_color, text);
        }
    }
}

/// Throws a body along the middle line of sight with this speed \[m/s\].
pub fn throw(desk: &Desk, pattern: Pattern, speed: Real) {
    let (eye, direction) = (desk.camera.eye, desk.camera.axes().forward);
    let pattern = Pattern { velocity: direction * speed, ..pattern };
    desk.session.edit(true, move |loaded| making::throw(loaded, &pattern, eye, direction).map(drop));
}

/// Throws a ball of a size and a speed that suit what is seen.
pub fn throw_ball(desk: &Desk) {
    let distance = desk.camera.distance();
    throw(desk, Pattern::sphere(usual_size(distance)), short_speed(distance));
}

fn sizes(ui: &mut egui::Ui, pattern: &mut Pattern) {
    ui.label("Shape");
    egui::ComboBox::from_id_salt("new shape").selected_text(pattern.kind.name()).show_ui(ui, |ui| {
        for (kind, name) in Kind::ALL {
            ui.selectable_value(&mut pattern.kind, kind, name);
        }
    });
    ui.end_row();
    if pattern.kind == Kind::Box {
        ui.label("Edges");
        let entry = Entry::positive("m", pattern.radius, "length of the edge along this axis");
        pattern.edges = entry.vector(ui, pattern.edges).unwrap_or(pattern.edges);
    } else {
        let (label, hint) = match pattern.kind {
            Kind::Sphere => ("Radius", "radius of the sphere"),
            _ => ("Circumradius", "radius of the sphere through the corners"),
        };
        ui.label(label);
        pattern.radius = Entry::positive("m", pattern.radius, hint).show(ui, pattern.radius).unwrap_or(pattern.radius);
    }
    ui.end_row();
}

fn mass(ui: &mut egui::Ui, pattern: &mut Pattern) {
    ui.label("Mass by");
    ui.horizontal(|ui| {
        let (value, hint) = ("value", "mass in kg");
        let is = |m: &MassDesc| matches!(m, MassDesc::Value(_));
        if ui.selectable_label(is(&pattern.mass), value).on_hover_text(hint).clicked() && !is(&pattern.mass) {
            pattern.mass = MassDesc::Value(1.0);
        }
        let is = |m: &MassDesc| matches!(m, MassDesc::Density(_));
        let hint = "mass is density times volume";
        if ui.selectable_label(is(&pattern.mass), "density").on_hover_text(hint).clicked() && !is(&pattern.mass) {
            pattern.mass = MassDesc::Density(1000.0);
        }
        let hint = "infinite mass: it never moves";
        if ui.selectable_label(pattern.mass == MassDesc::Fixed, "fixed").on_hover_text(hint).clicked() {
            pattern.mass = MassDesc::Fixed;
        }
    });
    ui.end_row();
    match &mut pattern.mass {
        MassDesc::Value(m) => {
            ui.label("Mass");
            *m = Entry::positive("kg", 1.0, "mass").show(ui, *m).unwrap_or(*m);
            ui.end_row();
        }
        MassDesc::Density(d) => {
            ui.label("Density");
            *d = Entry::positive("kg/m3", 1000.0, "mass by volume").show(ui, *d).unwrap_or(*d);
            ui.end_row();
        }
        MassDesc::Fixed | MassDesc::Unset => {}
    }
}

/// A size that is seen well from this distance \[m\]: a round number.
fn usual_size(distance: Real) -> Real {
    round(distance / 30.0)
}

/// A speed that crosses the scene in about a third of a second: a round number.
fn short_speed(distance: Real) -> Real {
    round(distance * 3.0)
}

/// One significant digit.
fn round(x: Real) -> Real {
    format!("{x:.0e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(name: &str, kind: &str, fixed: bool) -> Row {
        Row { id: BodyId::from_parts(0, 0, 0), name: name.into(), kind: kind.into(), fixed }
    }

    #[test]
    fn bodies_are_found_by_words_of_name_and_kind() {
        let rows =
            [row("Ball 1", "sphere", false), row("ball 2", "tetrahedron", false), row("floor", "polyhedron", true)];
        assert_eq!(found(&rows, ""), [0, 1, 2]);
        assert_eq!(found(&rows, "BALL"), [0, 1]);
        assert_eq!(found(&rows, "ball sph"), [0]);
        assert_eq!(found(&rows, " fixed "), [2]);
        assert!(found(&rows, "nobody").is_empty());
    }

    #[test]
    fn the_list_says_what_it_leaves_out() {
        assert_eq!(told(1, 1, 1), "1 body");
        assert_eq!(told(512, 512, 512), "512 bodies");
        assert_eq!(told(2, 512, 512), "2 of 512 bodies");
        assert_eq!(told(50_000, 50_000, 1_000_000), "50 000 bodies (the first of 1 000 000)");
    }

    #[test]
    fn sizes_suit_the_scene_in_round_numbers() {
        assert_eq!((usual_size(3.1), short_speed(3.1)), (0.1, 9.0));
        assert_eq!(usual_size(2.9e9), 1e8);
        assert!(usual_size(Real::MIN_POSITIVE) >= 0.0);
    }
}
