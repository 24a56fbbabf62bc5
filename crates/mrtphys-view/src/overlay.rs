//! What is drawn over the bodies to explain them: contact points and normals, velocities, trails, cells.

use mrtphys::math::Quat;
use mrtphys::{Real, Vec3};

/// Red, green, blue in the sRGB encoding, and how opaque.
pub type Rgba = [u8; 4];

/// A line of the same width at any distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// one end \[m\]
    pub from: Vec3,
    /// the other end \[m\]
    pub to: Vec3,
    /// color
    pub color: Rgba,
    /// width \[pixels\]
    pub width: f32,
    /// whether it shows through what is before it
    pub on_top: bool,
}

/// A round dot of the same size at any distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// where \[m\]
    pub at: Vec3,
    /// color
    pub color: Rgba,
    /// diameter \[pixels\]
    pub size: f32,
    /// whether it shows through what is before it
    pub on_top: bool,
}

/// A box, usually translucent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// centre \[m\]
    pub center: Vec3,
    /// half its edges \[m\]
    pub half: Vec3,
    /// how it is turned
    pub orientation: Quat,
    /// color
    pub color: Rgba,
}

/// A sphere, usually translucent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bubble {
    /// centre \[m\]
    pub center: Vec3,
    /// radius \[m\]
    pub radius: Real,
    /// color
    pub color: Rgba,
}

/// Everything that is drawn over the bodies. Kept and cleared rather than made anew, it allocates nothing once it has grown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlay {
    /// lines
    pub lines: Vec<Line>,
    /// dots
    pub points: Vec<Point>,
    /// boxes
    pub blocks: Vec<Block>,
    /// spheres
    pub bubbles: Vec<Bubble>,
}

impl Overlay {
    /// Nothing to draw.
    pub fn clear(&mut self) {
        self.lines.clear();
        self.points.clear();
        self.blocks.clear();
        self.bubbles.clear();
    }

    /// An arrow: a line with a head of two strokes in the plane that faces the eye at `eye`.
    pub fn arrow(&mut self, line: Line, eye: Vec3) {
        self.lines.push(line);
        let along = line.to - line.from;
        let Some(across) = along.cross(eye - line.to).try_normalize() else { return };
        for side in [1.0, -1.0] {
            let back = along * -0.18 + across * (side * 0.09 * along.length());
            self.lines.push(Line { from: line.to, to: line.to + back, ..line });
        }
    }

    /// The twelve edges of a box.
    pub fn frame_of_block(&mut self, block: &Block, color: Rgba, width: f32) {
        let corner = block.corners();
        for i in 0..8usize {
            for axis in [1, 2, 4] {
                if i & axis == 0 {
                    self.lines.push(Line { from: corner[i], to: corner[i | axis], color, width, on_top: false });
                }
            }
        }
    }
}

impl Block {
    /// The corners: bit 0 of the number says +x, bit 1 +y, bit 2 +z.
    pub fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            let sign = |axis: usize| if i >> axis & 1 == 1 { 1.0 } else { -1.0 };
            let corner = Vec3::new(sign(0) * self.half.x, sign(1) * self.half.y, sign(2) * self.half.z);
            self.center + self.orientation.rotate(corner)
        })
    }

    /// The faces, as corner numbers in order round each.
    pub const FACES: [[usize; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_faces_of_a_block_face_outward() {
        let half = Vec3::new(1.0, 2.0, 3.0);
        let block = Block { center: Vec3::X, half, orientation: Quat::IDENTITY, color: [0; 4] };
        let c = block.corners();
        for f in Block::FACES {
            let normal = (c[f[1]] - c[f[0]]).cross(c[f[2]] - c[f[0]]);
            let center = (c[f[0]] + c[f[2]]) * 0.5 - block.center;
            assert!(normal.dot(center) > 0.0);
            assert!(((c[f[0]] + c[f[2]]) - (c[f[1]] + c[f[3]])).length() < 1e-12, "in order round the face");
        }
        let mut overlay = Overlay::default();
        overlay.frame_of_block(&block, [0; 4], 1.0);
        let total: Real = overlay.lines.iter().map(|l| (l.to - l.from).length()).sum();
        assert_eq!((overlay.lines.len(), total), (12, 8.0 * (1.0 + 2.0 + 3.0)));
    }

    #[test]
    fn an_arrow_has_a_head_unless_it_points_at_the_eye() {
        let line = Line { from: Vec3::ZERO, to: Vec3::X, color: [0; 4], width: 1.0, on_top: false };
        let mut overlay = Overlay::default();
        overlay.arrow(line, Vec3::Z * 5.0);
        assert_eq!(overlay.lines.len(), 3);
        assert!(overlay.lines[1..].iter().all(|l| l.from == Vec3::X && l.to.x < 1.0 && l.to.z == 0.0));
        overlay.clear();
        overlay.arrow(line, Vec3::X * 5.0);
        assert_eq!(overlay.lines.len(), 1);
    }
}
