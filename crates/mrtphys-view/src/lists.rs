//! A frame sorted into what is drawn at once: instances by surface, lines, walls. The lists are kept from picture to picture
//! and allocate nothing once they have grown.

use crate::frame::{Frame, Highlighted, Instance, Mode, Quality, Wall};
use crate::mesh::{FINEST, level_for};
use crate::overlay::{Block, Line};
use mrtphys::Vec3;
use mrtphys::math::Quat;
use std::ops::Range;

/// Opacity of a boundary's faces.
const WALL_OPACITY: u8 = 150;
/// Width of a boundary's edges, to that of the edges of wireframe drawings.
const WALL_EDGE: f32 = 1.0;
/// Spheres above this number are triangulated more coarsely: what is lost in each is lost in the crowd.
const CROWD: usize = 20_000;
/// A body of a smaller radius \[pixels\] is outlined as if it had this one.
const SMALLEST_OUTLINED: f64 = 3.0;
/// Spheres smaller than these radii \[pixels\] in a line drawing get so many levels fewer.
const LINE_LEVELS: [(f64, u8); 3] = [(5.0, 0), (22.0, 1), (120.0, 2)];

/// A line as the shader takes it.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Stroke {
    start: [f32; 3],
    width: f32,
    end: [f32; 3],
    color: [u8; 4],
}

/// A face as the shader takes it.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Face {
    corners: [[f32; 4]; 4],
    color: [u8; 4],
}

/// The surface of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// a sphere of this level
    Sphere(u8),
    /// of the frame's batch of this number
    Batch(usize),
}

/// Instances of one surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// the surface
    pub form: Form,
    /// which of the instances
    pub range: Range<u32>,
}

/// The lists.
#[derive(Default)]
pub struct Lists {
    /// bodies, then translucent spheres
    pub instances: Vec<Instance>,
    /// bodies by surface
    pub draws: Vec<Draw>,
    /// translucent spheres
    pub bubbles: Range<u32>,
    /// bodies that are outlined
    pub outlined: Vec<Draw>,
    /// what the outlines are within: left, top, right, bottom \[pixels\]
    pub outline: [u32; 4],
    /// lines and dots: those behind bodies hidden, then those on top
    pub strokes: Vec<Stroke>,
    /// where those on top begin
    pub on_top: u32,
    /// walls, then the faces of translucent boxes
    pub faces: Vec<Face>,
    /// where those of boxes begin
    pub boxes: u32,
    levels: Vec<u8>,
    wall_edges: Vec<Stroke>,
}

/// What the lists depend on beside the frame.
#[derive(Clone, Copy, Debug)]
pub struct Detail {
    /// width of the picture \[pixels\]
    pub width: u32,
    /// height of the picture \[pixels\]
    pub height: u32,
    /// how far a sphere may be from round \[pixels\]
    pub tolerance: f64,
    /// width of lines \[pixels\]
    pub line_width: f32,
}

impl Lists {
    /// Sorts a frame.
    pub fn collect(&mut self, frame: &Frame, detail: Detail) {
        self.instances.clear();
        self.draws.clear();
        self.strokes.clear();
        self.faces.clear();
        self.spheres(frame, detail);
        for (i, batch) in frame.batches.iter().enumerate().filter(|(_, b)| !b.instances.is_empty()) {
            self.push_draw(Form::Batch(i), &batch.instances);
        }
        self.bubbles(frame);
        self.outlines(frame, detail);
        self.walls(frame, detail);
        self.boxes = self.faces.len() as u32;
        frame.overlay.blocks.iter().for_each(|b| self.block(frame, b));
        self.overlay_lines(frame);
    }

    fn push_draw(&mut self, form: Form, instances: &[Instance]) {
        let start = self.instances.len() as u32;
        self.instances.extend_from_slice(instances);
        self.draws.push(Draw { form, range: start..self.instances.len() as u32 });
    }

    /// Spheres by level, each level in the frame's order.
    fn spheres(&mut self, frame: &Frame, detail: Detail) {
        let eye = frame.place(frame.camera.eye);
        let pixels = f64::from(detail.height) / 2.0 / frame.camera.tan_half_fov();
        let crowd = (frame.spheres.len() as f64 / CROWD as f64).max(1.0).sqrt();
        let radius_of = |s: &Instance| {
            let d = [0, 1, 2].map(|k| f64::from(s.position[k] - eye[k]));
            let distance = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
            f64::from(s.scale) * pixels / distance.max(f64::from(s.scale))
        };
        let level_of = |s: &Instance| match frame.look.quality {
            Quality::Level(level) => level.min(FINEST),
            Quality::Auto if frame.look.mode.has_lines() => line_level(radius_of(s)),
            // Each triangle is seen as one: more of them would only look like Gouraud's.
            Quality::Auto if frame.look.mode == Mode::Flat => level_for(radius_of(s), detail.tolerance * crowd).min(3),
            Quality::Auto => level_for(radius_of(s), detail.tolerance * crowd),
        };
        self.levels.clear();
        self.levels.extend(frame.spheres.iter().map(level_of));
        for level in 0..=FINEST {
            let start = self.instances.len() as u32;
            let of_level = frame.spheres.iter().zip(&self.levels).filter(|(_, l)| **l == level);
            self.instances.extend(of_level.map(|(s, _)| *s));
            let range = start..self.instances.len() as u32;
            if !range.is_empty() {
                self.draws.push(Draw { form: Form::Sphere(level), range });
            }
        }
    }

    fn bubbles(&mut self, frame: &Frame) {
        let start = self.instances.len() as u32;
        let bubbles = frame.overlay.bubbles.iter();
        self.instances.extend(bubbles.filter_map(|b| frame.instance(b.center, b.radius, Quat::IDENTITY, b.color)));
        self.bubbles = start..self.instances.len() as u32;
    }

    /// Bodies that would be lost in the picture are outlined as if they were larger.
    fn outlines(&mut self, frame: &Frame, detail: Detail) {
        self.outlined.clear();
        self.outline = [detail.width, detail.height, 0, 0];
        let eye = frame.place(frame.camera.eye);
        let pixels = f64::from(detail.height) / 2.0 / frame.camera.tan_half_fov();
        for Highlighted { batch, body } in &frame.highlight {
            let d = [0, 1, 2].map(|k| f64::from(body.position[k] - eye[k]));
            let distance = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
            let scale = body.scale.max((SMALLEST_OUTLINED * distance / pixels) as f32);
            let level = level_for(f64::from(scale) * pixels / distance.max(f64::from(scale)), detail.tolerance);
            let form = match batch {
                Some(i) if *i < frame.batches.len() => Form::Batch(*i),
                Some(_) => continue,
                None => Form::Sphere(level),
            };
            let start = self.instances.len() as u32;
            self.instances.push(Instance { scale, ..*body });
            self.outlined.push(Draw { form, range: start..start + 1 });
            self.widen_outline(frame, detail, body.position, scale);
        }
    }

    /// The outline's part of the picture holds the cube about a body, and the width of its line.
    fn widen_outline(&mut self, frame: &Frame, detail: Detail, position: [f32; 3], scale: f32) {
        let size = [f64::from(detail.width), f64::from(detail.height)];
        let [x, y, z] = position.map(f64::from);
        let (center, half) = (frame.origin + Vec3::new(x, y, z) * frame.unit, f64::from(scale) * frame.unit);
        let cube = Block { center, half: Vec3::splat(half), orientation: Quat::IDENTITY, color: [0; 4] };
        let margin = 8.0 * f64::from(detail.line_width) + 2.0;
        for corner in cube.corners() {
            let place = frame.camera.place(corner, size[0] / size[1]);
            // A corner beside or behind the eye may be anywhere.
            let Some((x, y)) = place else {
                self.outline = [0, 0, detail.width, detail.height];
                return;
            };
            for (k, at) in [x * size[0], y * size[1]].into_iter().enumerate() {
                self.outline[k] = self.outline[k].min((at - margin).clamp(0.0, size[k]) as u32);
                self.outline[k + 2] = self.outline[k + 2].max((at + margin).clamp(0.0, size[k]).ceil() as u32);
            }
        }
    }

    fn walls(&mut self, frame: &Frame, detail: Detail) {
        let colors = frame.look.theme.colors();
        for wall in &frame.walls {
            let from_eye = wall.corners[0] - frame.camera.eye;
            let front = from_eye.dot(wall.normal) < 0.0;
            if wall.endless.is_none() {
                self.edges_of(frame, wall, opaque(colors.wall_edge), detail.line_width * WALL_EDGE, front);
            }
            if !(front || wall.two_sided) || frame.look.mode == Mode::Wireframe {
                continue;
            }
            let [r, g, b] = wall.color.unwrap_or(colors.wall);
            let color = [r, g, b, WALL_OPACITY];
            // The shader takes the normal from the corners: counter-clockwise seen from the front.
            let mut corners = wall.corners;
            if (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(wall.normal) < 0.0 {
                corners.reverse();
            }
            let kind = [f32::from(wall.endless.is_some()), 1.0, (wall.endless.unwrap_or(0.0) / frame.unit) as f32, 0.0];
            self.face(frame, corners, kind, color);
        }
        self.shared_edges();
    }

    /// Edges of a wall; behind the scene a little fainter.
    fn edges_of(&mut self, frame: &Frame, wall: &Wall, color: [u8; 4], width: f32, front: bool) {
        let [r, g, b, a] = color;
        let color = [r, g, b, if front { a } else { a / 2 }];
        for i in (0..4).filter(|i| wall.edges[*i]) {
            let (start, end) = (frame.place(wall.corners[i]), frame.place(wall.corners[(i + 1) % 4]));
            if start != end {
                self.wall_edges.push(Stroke { start, width, end, color });
            }
        }
    }

    /// An edge that walls share is drawn once, as that of the nearest to the front.
    fn shared_edges(&mut self) {
        // Adding zero makes a negative zero positive.
        let bits = |p: [f32; 3]| p.map(|x| (x + 0.0).to_bits());
        let ends = |s: &Stroke| {
            let (a, b) = (bits(s.start), bits(s.end));
            (a.min(b), a.max(b))
        };
        let mut edges = std::mem::take(&mut self.wall_edges);
        edges.sort_by_key(|s| (ends(s), std::cmp::Reverse(s.color[3])));
        edges.dedup_by_key(|s| ends(s));
        edges.drain(..).for_each(|s| self.stroke(s));
        self.wall_edges = edges;
    }

    fn block(&mut self, frame: &Frame, block: &Block) {
        let corners = block.corners();
        for face in Block::FACES {
            self.face(frame, face.map(|i| corners[i]), [0.0; 4], block.color);
        }
    }

    fn face(&mut self, frame: &Frame, corners: [Vec3; 4], kind: [f32; 4], color: [u8; 4]) {
        let place = |i: usize| {
            let [x, y, z] = frame.place(corners[i]);
            [x, y, z, kind[i]]
        };
        let corners = [0, 1, 2, 3].map(place);
        if corners.iter().flatten().all(|x| x.is_finite()) {
            self.faces.push(Face { corners, color });
        }
    }

    fn overlay_lines(&mut self, frame: &Frame) {
        for on_top in [false, true] {
            if on_top {
                self.on_top = self.strokes.len() as u32;
            }
            let lines = frame.overlay.lines.iter().filter(|l| l.on_top == on_top);
            for Line { from, to, color, width, .. } in lines {
                self.stroke(Stroke { start: frame.place(*from), width: *width, end: frame.place(*to), color: *color });
            }
            let points = frame.overlay.points.iter().filter(|p| p.on_top == on_top);
            for p in points {
                let at = frame.place(p.at);
                self.stroke(Stroke { start: at, width: p.size, end: at, color: p.color });
            }
        }
    }

    fn stroke(&mut self, s: Stroke) {
        let numbers = s.start.iter().chain(&s.end).chain([&s.width]);
        if numbers.into_iter().all(|x| x.is_finite()) {
            self.strokes.push(s);
        }
    }
}

/// Sorts frames as a renderer does before it hands them to the driver: to measure what that takes.
#[derive(Default)]
pub struct Sorting(Lists);

impl Sorting {
    /// Sorts a frame for a picture of this size on a graphics card; returns how many triangles bodies are drawn with.
    pub fn triangles(&mut self, frame: &Frame, width: u32, height: u32) -> usize {
        self.0.collect(frame, Detail { width, height, tolerance: 0.15, line_width: 1.0 });
        let each = |d: &Draw| match d.form {
            Form::Sphere(level) => 20 << (2 * level),
            Form::Batch(i) => frame.batches[i].mesh.triangles.len(),
        };
        self.0.draws.iter().map(|d| each(d) * d.range.len()).sum()
    }
}

fn line_level(radius: f64) -> u8 {
    LINE_LEVELS.iter().find(|(r, _)| radius < *r).map_or(3, |(_, level)| *level)
}

fn opaque([r, g, b]: [u8; 3]) -> [u8; 4] {
    [r, g, b, 255]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::frame::Look;
    use crate::overlay::{Bubble, Point};

    const DETAIL: Detail = Detail { width: 1280, height: 720, tolerance: 0.25, line_width: 1.0 };

    fn frame() -> Frame {
        let camera = Camera { eye: Vec3::new(0.0, 0.0, 4.0), look_at: Vec3::ZERO, up: Vec3::Y, fov_deg: 45.0 };
        let mut frame = Frame::new(camera, Look::default());
        let ball = |z: f64| frame.instance(Vec3::new(0.0, 0.0, z), 0.5, Quat::IDENTITY, [255; 4]);
        frame.spheres = [-400.0, 3.3, 0.0, -400.0].into_iter().filter_map(ball).collect();
        frame
    }

    #[test]
    fn near_spheres_are_finer_and_none_is_lost() {
        let mut lists = Lists::default();
        lists.collect(&frame(), DETAIL);
        assert_eq!(lists.instances.len(), 4);
        let levels: Vec<u8> = lists
            .draws
            .iter()
            .filter_map(|d| match d.form {
                Form::Sphere(level) => Some(level),
                Form::Batch(_) => None,
            })
            .collect();
        assert!(levels.is_sorted() && levels.len() == 3, "{levels:?}");
        assert_eq!(lists.draws[0].range, 0..2);
        let mut fixed = frame();
        fixed.look.quality = Quality::Level(200);
        lists.collect(&fixed, DETAIL);
        assert_eq!(lists.draws, [Draw { form: Form::Sphere(FINEST), range: 0..4 }]);
    }

    #[test]
    fn walls_are_drawn_from_their_front_only() {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|p| Vec3::new(p[0], p[1], -1.0));
        let wall = Wall { corners, normal: Vec3::Z, two_sided: false, endless: None, edges: [true; 4], color: None };
        let mut frame = frame();
        let back = Wall { normal: -Vec3::Z, ..wall };
        frame.walls = vec![wall, back, Wall { two_sided: true, ..back }];
        let mut lists = Lists::default();
        lists.collect(&frame, DETAIL);
        assert_eq!((lists.faces.len(), lists.strokes.len()), (2, 4));
    }

    #[test]
    fn the_edges_of_a_box_are_drawn_once() {
        let text = "format = 1\n[[boundary]]\nkind = \"box\"\nmin = [-1, -1, -1]\nmax = [1.1, 1.2, 1.3]\n[camera]\neye = [2, 3, 5]\nlook_at = [0, 0, 0]\n";
        let loaded = mrtphys_scene::Scene::from_text("test", text).unwrap().build().unwrap();
        let frame = crate::frame_of(&loaded, Look::default());
        let mut lists = Lists::default();
        lists.collect(&frame, DETAIL);
        assert_eq!(lists.strokes.len(), 12);
        // Nine edges border a face whose front is seen, and are drawn in full.
        assert_eq!(lists.strokes.iter().filter(|s| s.color[3] == 255).count(), 9);
        lists.collect(&frame, DETAIL);
        assert_eq!(lists.strokes.len(), 12, "and nothing is left of the last picture");
    }

    #[test]
    fn an_outline_lies_within_its_part_of_the_picture() {
        let mut frame = frame();
        let near = frame.spheres[1];
        let tiny = Instance { position: [20.0, 20.0, -100.0], scale: 1e-4, ..near };
        for (body, full) in [(near, true), (tiny, false)] {
            frame.highlight = vec![Highlighted { batch: None, body }];
            let mut lists = Lists::default();
            lists.collect(&frame, DETAIL);
            let [l, t, r, b] = lists.outline;
            let (width, height) = (r - l, b - t);
            assert_eq!(width > 600 && height > 600, full, "{:?}", lists.outline);
            assert!(l < r && t < b && r <= 1280 && b <= 720);
            assert!(full || (l > 640 && b < 360 && (20..60).contains(&width)), "{:?}", lists.outline);
            assert_eq!(lists.outlined.len(), 1);
            let drawn = lists.instances[lists.outlined[0].range.start as usize];
            assert_eq!(drawn.scale > body.scale, !full, "what would be lost is outlined larger");
        }
        frame.highlight[0].batch = Some(7);
        let mut lists = Lists::default();
        lists.collect(&frame, DETAIL);
        assert!(lists.outlined.is_empty(), "there is no such surface");
    }

    #[test]
    fn the_overlay_is_sorted_and_what_is_not_finite_left_out() {
        let mut frame = frame();
        let line = Line { from: Vec3::ZERO, to: Vec3::X, color: [9; 4], width: 1.0, on_top: true };
        let nowhere = Vec3::splat(f64::NAN);
        frame.overlay.lines = vec![line, Line { on_top: false, ..line }, Line { to: nowhere, ..line }];
        frame.overlay.points.push(Point { at: Vec3::ZERO, color: [9; 4], size: 3.0, on_top: false });
        let half = Vec3::splat(1.0);
        frame.overlay.blocks.push(Block { center: nowhere, half, orientation: Quat::IDENTITY, color: [9; 4] });
        frame.overlay.blocks.push(Block { center: Vec3::X, half, orientation: Quat::IDENTITY, color: [9; 4] });
        frame.overlay.bubbles.push(Bubble { center: Vec3::X, radius: 1.0, color: [9; 4] });
        let mut lists = Lists::default();
        lists.collect(&frame, DETAIL);
        assert_eq!((lists.strokes.len(), lists.on_top, lists.faces.len(), lists.boxes), (3, 2, 6, 0));
        assert_eq!(lists.bubbles, 4..5);
    }
}
