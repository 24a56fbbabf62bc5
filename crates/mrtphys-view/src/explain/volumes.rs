//! Bounds and cells.

use super::{Drawn, Pen, opaque, spread};
use crate::dress::Legend;
use crate::overlay::{Block, Bubble, Overlay};
use crate::poses::Poses;
use crate::stage::Stage;
use mrtphys::bounds::Aabb;
use mrtphys::broad::Cell;
use mrtphys::math::Quat;
use mrtphys::{Real, Vec3};

/// Strokes of a circle.
const CIRCLE: usize = 40;
/// Edges of a box.
const BOX: usize = 12;
/// Opacity of a bounding sphere about a body that is none.
const BUBBLE: u8 = 34;
/// Opacity of the faces of a single cell; the more cells, the less.
const CELL: Real = 90.0;

impl Pen {
    /// Bounding spheres: their outlines as seen from the eye, and translucent balls about bodies that are not spheres
    /// themselves.
    pub fn bounding_spheres(&self, overlay: &mut Overlay, stage: &Stage, poses: &Poses) -> Drawn {
        let total = stage.body_count().min(poses.positions.len());
        let mut drawn = 0;
        let [r, g, b] = self.inks.ball;
        for i in spread(total, self.affordable(CIRCLE)) {
            let ball = stage.bounding_sphere(i);
            let center = poses.positions[i] + poses.orientations[i].rotate(ball.center);
            drawn += 1;
            if !(center.is_finite() && ball.radius > 0.0 && ball.radius.is_finite()) {
                continue;
            }
            self.outline_of_ball(overlay, center, ball.radius);
            if !stage.is_sphere(i) {
                overlay.bubbles.push(Bubble { center, radius: ball.radius, color: [r, g, b, BUBBLE] });
            }
        }
        Drawn { drawn, total }
    }

    /// The circle in which lines of sight touch a ball: nearer to the eye by r^2/d than its centre, and smaller.
    fn outline_of_ball(&self, overlay: &mut Overlay, center: Vec3, radius: Real) {
        let to_eye = self.eye - center;
        let d = to_eye.length();
        let Some(axis) = to_eye.try_normalize().filter(|_| d > radius) else { return };
        let Some(u) = axis.any_perpendicular().try_normalize() else { return };
        let sine = radius / d;
        let middle = center + axis * (radius * sine);
        let (u, v) = (u, axis.cross(u));
        // A polygon about the circle: one within it would be hidden by a ball that is drawn there.
        let r = radius * (1.0 - sine * sine).sqrt() / (std::f64::consts::PI / CIRCLE as Real).cos();
        let at = |k: usize| {
            let angle = std::f64::consts::TAU * k as Real / CIRCLE as Real;
            middle + (u * angle.cos() + v * angle.sin()) * r
        };
        for k in 0..CIRCLE {
            let line = self.line(at(k), at((k + 1) % CIRCLE), opaque(self.inks.ball, 255), 1.0);
            overlay.lines.push(crate::overlay::Line { on_top: false, ..line });
        }
    }

    /// Axis-parallel boxes. What is infinite is cut off outside the scene.
    pub fn boxes(&self, overlay: &mut Overlay, boxes: &[Aabb]) -> Drawn {
        let mut drawn = 0;
        for i in spread(boxes.len(), self.affordable(BOX)) {
            drawn += 1;
            if let Some(block) = self.block(&boxes[i]) {
                overlay.frame_of_block(&block, opaque(self.inks.aabb, 255), 0.9 * self.thin);
            }
        }
        Drawn { drawn, total: boxes.len() }
    }

    /// Cells of a regular grid, tinted by the number of objects in them; empty ones are left out and not counted. The legend
    /// says which color is which number.
    pub fn grid(&self, overlay: &mut Overlay, cells: &[Cell]) -> (Drawn, Legend) {
        let full: Vec<&Cell> = cells.iter().filter(|c| c.objects > 0).collect();
        let most = full.iter().map(|c| c.objects).max().unwrap_or(1);
        let legend = Legend::to(Real::from(most), "objects in a cell", "", self.theme);
        let chosen: Vec<&Cell> = spread(full.len(), self.affordable(BOX)).map(|i| full[i]).collect();
        let opacity = (CELL / (chosen.len() as Real).cbrt()).clamp(5.0, 70.0) as u8;
        for cell in &chosen {
            let Some(block) = self.block(&cell.bounds) else { continue };
            let color = legend.color(Real::from(cell.objects));
            overlay.blocks.push(Block { color: opaque(color, opacity), ..block });
            overlay.frame_of_block(&block, opaque(color, 230), 0.8 * self.thin);
        }
        (Drawn { drawn: chosen.len(), total: full.len() }, legend)
    }

    /// Cells of a tree, as frames, tinted by their depth. The legend says which color is which depth. Where there are too many,
    /// the deepest are left out.
    pub fn tree(&self, overlay: &mut Overlay, cells: &[Cell]) -> (Drawn, Legend) {
        let deepest = cells.iter().map(|c| c.depth).max().unwrap_or(0).max(1);
        let legend = Legend::to(Real::from(deepest), "depth of a cell", "", self.theme);
        let mut order: Vec<&Cell> = cells.iter().collect();
        order.sort_by_key(|c| c.depth);
        order.truncate(self.affordable(BOX));
        for cell in &order {
            let Some(block) = self.block(&cell.bounds) else { continue };
            let part = Real::from(cell.depth) / Real::from(deepest);
            let width = (2.0 - 1.2 * part) as f32 * self.thin;
            overlay.frame_of_block(&block, opaque(legend.color(Real::from(cell.depth)), 255), width);
        }
        (Drawn { drawn: order.len(), total: cells.len() }, legend)
    }

    /// A box; where it is infinite it ends outside the scene. `None`: it is empty.
    fn block(&self, bounds: &Aabb) -> Option<Block> {
        let ends = |axis: usize| {
            let (min, max) = (bounds.min[axis], bounds.max[axis]);
            let low = if min == Real::NEG_INFINITY { self.region.min[axis].min(max) } else { min };
            let high = if max == Real::INFINITY { self.region.max[axis].max(low) } else { max };
            (low, high)
        };
        let [x, y, z] = [0, 1, 2].map(ends);
        let (min, max) = (Vec3::new(x.0, y.0, z.0), Vec3::new(x.1, y.1, z.1));
        let half = (max - min) * 0.5;
        let there = half.x >= 0.0 && half.y >= 0.0 && half.z >= 0.0 && half.is_finite();
        there.then(|| Block { center: (min + max) * 0.5, half, orientation: Quat::IDENTITY, color: [0; 4] })
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::pen;
    use super::*;
    use mrtphys_scene::Scene;

    fn cell(x: Real, depth: u32, objects: u32) -> Cell {
        let min = Vec3::new(x, 0.0, 0.0);
        Cell { bounds: Aabb { min, max: min + Vec3::splat(0.5) }, depth, objects }
    }

    #[test]
    fn outlines_are_where_lines_of_sight_touch() {
        let text = "format = 1
[[body]]
shape = { kind = \"sphere\", radius = 1.5 }
position = [1, 2, 0]
[[body]]
shape = { kind = \"box\", size = [1, 1, 2] }
position = [-3, 0, 0]
";
        let loaded = Scene::from_text("test", text).unwrap().build().unwrap();
        let stage = Stage::new(&loaded);
        let mut poses = Poses::default();
        stage.read(&loaded.world, &mut poses);
        let mut o = Overlay::default();
        assert_eq!(pen().bounding_spheres(&mut o, &stage, &poses), Drawn { drawn: 2, total: 2 });
        assert_eq!((o.lines.len(), o.bubbles.len()), (2 * CIRCLE, 1));
        for l in &o.lines[..CIRCLE] {
            let center = Vec3::new(1.0, 2.0, 0.0);
            let touched = (l.from + l.to) * 0.5;
            assert!(((touched - center).length() - 1.5).abs() < 1e-12);
            assert!((touched - center).dot(touched - pen().eye).abs() < 1e-12);
        }
        let radius = 1.5f64.sqrt();
        assert!((o.bubbles[0].radius - radius).abs() < 1e-9 && o.bubbles[0].center == Vec3::X * -3.0);
        let few = Pen { lines: CIRCLE, ..pen() };
        assert_eq!(few.bounding_spheres(&mut o, &stage, &poses), Drawn { drawn: 1, total: 2 });
    }

    #[test]
    fn boxes_are_where_they_are_and_infinite_ones_end() {
        let mut o = Overlay::default();
        let b = Aabb { min: Vec3::new(1.0, 2.0, 3.0), max: Vec3::new(2.0, 4.0, 6.0) };
        let all = [b, Aabb::EVERYWHERE, Aabb::EMPTY];
        assert_eq!(pen().boxes(&mut o, &all), Drawn { drawn: 3, total: 3 });
        assert_eq!(o.lines.len(), 24);
        let ends =
            |o: &Overlay, i: usize| Aabb::of_points(o.lines[12 * i..12 * i + 12].iter().flat_map(|l| [l.from, l.to]));
        assert_eq!(ends(&o, 0), b);
        assert!(ends(&o, 1).max.is_finite());
        o.clear();
        assert_eq!(Pen { lines: 13, ..pen() }.boxes(&mut o, &[b; 5]), Drawn { drawn: 1, total: 5 });
    }

    #[test]
    fn cells_are_tinted_by_what_is_in_them() {
        let mut o = Overlay::default();
        let (drawn, legend) = pen().grid(&mut o, &[cell(0.0, 0, 1), cell(1.0, 0, 0), cell(2.0, 0, 4)]);
        assert_eq!(drawn, Drawn { drawn: 2, total: 2 });
        assert_eq!((o.blocks.len(), o.lines.len(), legend.max), (2, 24, 4.0));
        for (block, n) in o.blocks.iter().zip([1.0, 4.0]) {
            assert_eq!(block.color[..3], legend.color(n));
        }
        assert_ne!(o.blocks[0].color, o.blocks[1].color);
        assert_eq!(o.blocks[1].center, Vec3::new(2.25, 0.25, 0.25));
        let many: Vec<Cell> = (0..50).map(|i| cell(f64::from(i), 0, 1)).collect();
        o.clear();
        assert_eq!(Pen { lines: 120, ..pen() }.grid(&mut o, &many).0, Drawn { drawn: 10, total: 50 });
        assert_eq!(o.lines.len(), 120);
    }

    #[test]
    fn a_tree_is_drawn_from_its_root() {
        let mut o = Overlay::default();
        let cells = [cell(0.0, 2, 3), cell(0.0, 0, 9), cell(0.0, 1, 0)];
        let (drawn, legend) = pen().tree(&mut o, &cells);
        assert_eq!((drawn, legend.max), (Drawn { drawn: 3, total: 3 }, 2.0));
        assert_eq!(o.lines[0].color[..3], legend.color(0.0));
        assert_eq!(o.lines[35].color[..3], legend.color(2.0));
        o.clear();
        assert_eq!(Pen { lines: 24, ..pen() }.tree(&mut o, &cells).0, Drawn { drawn: 2, total: 3 });
        assert!(o.lines.iter().all(|l| l.color[..3] != legend.color(2.0)));
        assert_eq!(pen().tree(&mut o, &[]).0, Drawn::default());
    }
}
