//! What is in the picture of one world: the same in the window, in pictures and in films.

use super::seeing::{Layer, Sight};
use crate::testbed::session::Extras;
use mrtphys::def::{BroadPhaseKind, Settings};
use mrtphys::{BodyId, Vec3};
use mrtphys_view::{Camera, Drawn, Dress, Frame, Image, Legend, Look, Pen, Poses, Scale, Stage, Theme};

/// How a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// from where
    pub camera: Camera,
    /// how
    pub look: Look,
    /// what is drawn over it
    pub sight: Sight,
    /// the outlined body
    pub selected: Option<BodyId>,
    /// the spring of the hand: from the body to the mouse \[m\]
    pub spring: Option<(Vec3, Vec3)>,
    /// width and height \[pixels\]
    pub size: (u32, u32),
    /// part of the pixels, across, that it is shown with
    pub part: f32,
}

/// A world at one moment, as far as it is known: what was not recorded of the past is not there.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// what the bodies look like
    pub stage: &'a Stage,
    /// where they are
    pub poses: &'a Poses,
    /// what else is known
    pub extras: &'a Extras,
    /// whether its cells are those of a tree
    pub is_tree: bool,
}

/// Whether the cells of a world with these settings are those of a tree.
pub fn is_tree(settings: &Settings) -> bool {
    matches!(settings.broad_phase, BroadPhaseKind::AdaptiveTree { .. })
}

/// What is to be said of a picture.
#[derive(Clone, Debug, Default)]
pub struct Told {
    /// what was drawn of what there is
    pub drawn: Vec<(Layer, Drawn)>,
    /// what the colors mean
    pub legends: Vec<Legend>,
}

/// Lengths of arrows, steady from picture to picture: impulses, velocities, angular velocities.
pub type Scales = [Scale; 3];

/// Fills a picture. Every picture of the testbed is made here.
pub fn fill(frame: &mut Frame, moment: &Moment<'_>, view: &View, scales: &mut Scales) -> Told {
    let chosen = view.selected.and_then(|id| moment.stage.index(id));
    let outlined: Vec<usize> = chosen.into_iter().collect();
    let dress = Dress {
        coloring: view.sight.coloring,
        velocities: &moment.extras.velocities,
        contacts: &moment.extras.touches,
        most: None,
        highlight: &outlined,
    };
    let legend = moment.stage.fill_dressed(view.camera, view.look, &dress, moment.poses, frame);
    frame.overlay.clear();
    let mut told = Told { drawn: Vec::new(), legends: legend.into_iter().collect() };
    frame.part = view.part;
    let pen = Pen::new(&view.camera, &moment.stage.bounds(), view.look.theme, view.size.1);
    let pen = pen.reduced(view.size.1, view.part);
    explain(frame, moment, (view.sight, chosen), (&pen, scales), &mut told);
    if let Some((held, hand)) = view.spring {
        pen.grip(&mut frame.overlay, held, hand);
    }
    told
}

/// Draws what explains the scene.
fn explain(
    frame: &mut Frame,
    &Moment { stage, poses, extras, is_tree }: &Moment<'_>,
    (sight, chosen): (Sight, Option<usize>),
    (pen, [impulses, speeds, spins]): (&Pen, &mut Scales),
    told: &mut Told,
) {
    let overlay = &mut frame.overlay;
    let mut note = |layer: Layer, d: Drawn| told.drawn.push((layer, d));
    if sight.has(Layer::Cells) {
        let (d, legend) = if is_tree { pen.tree(overlay, &extras.cells) } else { pen.grid(overlay, &extras.cells) };
        note(Layer::Cells, d);
        told.legends.push(legend);
    }
    if sight.has(Layer::Boxes) {
        note(Layer::Boxes, pen.boxes(overlay, &extras.boxes));
    }
    if sight.has(Layer::Balls) {
        note(Layer::Balls, pen.bounding_spheres(overlay, stage, poses));
    }
    if sight.has(Layer::Trails) {
        note(Layer::Trails, pen.trails(overlay, stage, &extras.trail, poses, None));
    } else if sight.trail_of_selected && chosen.is_some() {
        pen.trails(overlay, stage, &extras.trail, poses, chosen);
    }
    if sight.has(Layer::Velocities) {
        note(Layer::Velocities, pen.velocities(overlay, speeds, &poses.positions, &extras.velocities));
    }
    if sight.has(Layer::Spins) {
        note(Layer::Spins, pen.spins(overlay, spins, &poses.positions, &extras.velocities));
    }
    if sight.has(Layer::Impulses) {
        note(Layer::Impulses, pen.impulses(overlay, impulses, &extras.impacts));
    }
    if sight.has(Layer::Contacts) {
        note(Layer::Contacts, pen.contacts(overlay, &extras.contacts));
    }
}

/// Left edge and width of each of so many pictures next to each other \[pixels\], with a line between them where there is room.
pub fn split(width: u32, count: usize) -> Vec<(u32, u32)> {
    let count = (count.max(1) as u32).min(width.max(1));
    let edge = |i: u32| (u64::from(width) * u64::from(i) / u64::from(count)) as u32;
    let wide = |i: u32| edge(i + 1) - edge(i);
    let pane = |i: u32| (edge(i), wide(i) - u32::from(i + 1 < count && wide(i) > 1));
    (0..count).map(pane).collect()
}

/// A picture of this size for panes to be put into.
pub fn board((width, height): (u32, u32), theme: Theme) -> Image {
    Image::filled(width, height, theme.colors().wall_edge)
}

/// Puts a picture of the same height into another one, from this column on.
pub fn put(board: &mut Image, left: u32, pane: &Image) {
    let row = |image: &Image| 4 * image.width as usize;
    let (from, to, start) = (row(pane).max(4), row(board).max(4), 4 * left as usize);
    for (line, pixels) in board.rgba.chunks_exact_mut(to).zip(pane.rgba.chunks_exact(from)) {
        if let Some(place) = line.get_mut(start..start + from) {
            place.copy_from_slice(pixels);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys_scene::{Scene, gallery_scene};
    use mrtphys_view::Coloring;
    use std::sync::Arc;

    fn view(stage: &Stage) -> View {
        View {
            camera: stage.camera(),
            look: Look::default(),
            sight: Sight::default(),
            selected: None,
            spring: None,
            size: (640, 480),
            part: 1.0,
        }
    }

    #[test]
    fn everything_that_is_switched_on_is_in_the_picture_and_nothing_else() {
        let text = gallery_scene("thesis/cube-3").unwrap();
        let mut loaded = Scene::from_text("test", text).unwrap().build().unwrap();
        loaded.world.record_events(true);
        (0..40).for_each(|_| loaded.world.frame().unwrap());
        let stage = Stage::new(&loaded);
        let mut poses = Poses::default();
        stage.read(&loaded.world, &mut poses);
        let mut earlier = poses.clone();
        earlier.positions.iter_mut().for_each(|x| x.y += 0.1);
        let world = &mut loaded.world;
        let extras = Extras {
            contacts: world.contacts().list.clone(),
            impacts: world.drain_events().collect(),
            velocities: stage.bodies().map(|id| world.motion(id).unwrap()).collect(),
            boxes: stage.bodies().map(|id| world.bounding_box(id).unwrap()).collect(),
            cells: world.cells(),
            trail: vec![Arc::new(earlier)],
            ..Extras::default()
        };
        let moment = Moment { stage: &stage, poses: &poses, extras: &extras, is_tree: is_tree(world.settings()) };
        let mut frame = Frame::new(stage.camera(), Look::default());
        let bare = fill(&mut frame, &moment, &view(&stage), &mut Scales::default());
        assert!(frame.overlay == Default::default() && bare.drawn.is_empty() && bare.legends.is_empty());
        for (layer, name, _) in Layer::ALL {
            let mut view = view(&stage);
            view.sight.set(layer, true);
            let told = fill(&mut frame, &moment, &view, &mut Scales::default());
            let is_empty = layer == Layer::Contacts && extras.contacts.is_empty();
            assert_eq!(frame.overlay == Default::default(), is_empty, "{name}");
            assert_eq!(told.drawn.iter().map(|d| d.0).collect::<Vec<_>>(), [layer]);
            // Of a moment that is past: what is recorded, and no more.
            let past = Extras { trail: extras.trail.clone(), ..Extras::default() };
            fill(&mut frame, &Moment { extras: &past, ..moment }, &view, &mut Scales::default());
            assert_eq!(frame.overlay == Default::default(), !layer.is_recorded(), "{name}");
        }
        let mut view = view(&stage);
        view.selected = stage.body(1);
        view.sight.coloring = Coloring::Speed;
        let told = fill(&mut frame, &moment, &view, &mut Scales::default());
        assert_eq!((frame.highlight.len(), told.legends[0].title), (1, "speed"));
    }

    #[test]
    fn pictures_next_to_each_other_fill_the_width() {
        assert_eq!(split(100, 1), [(0, 100)]);
        assert_eq!(split(100, 0), [(0, 100)]);
        assert_eq!(split(100, 2), [(0, 49), (50, 50)]);
        assert_eq!(split(101, 2), [(0, 49), (50, 51)]);
        assert_eq!((split(2, 2), split(1, 2)), (vec![(0, 1), (1, 1)], vec![(0, 1)]));
    }

    #[test]
    fn a_pane_is_put_where_it_belongs() {
        let mut whole = board((7, 3), Theme::Light);
        let line = Theme::Light.colors().wall_edge;
        for ((left, width), rgb) in split(7, 2).into_iter().zip([[1, 2, 3], [4, 5, 6]]) {
            put(&mut whole, left, &Image::filled(width, 3, rgb));
        }
        let row = |image: &Image, y: u32| (0..7).map(|x| image.pixel(x, y).unwrap()).collect::<Vec<_>>();
        let right = [[1, 2, 3], [1, 2, 3], line, [4, 5, 6], [4, 5, 6], [4, 5, 6], [4, 5, 6]];
        assert!((0..3).all(|y| row(&whole, y) == right));
        put(&mut whole, 6, &Image::filled(5, 3, [9; 3]));
        assert_eq!(row(&whole, 0), right, "what does not fit is left out");
    }
}
