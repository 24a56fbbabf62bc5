//! A picture before it is drawn: plain data, made from a world by [`Stage`](crate::Stage), or by hand.

use crate::camera::Camera;
use crate::mesh::Mesh;
use crate::overlay::Overlay;
use crate::palette::{Rgb, Theme};
use mrtphys::math::Quat;
use mrtphys::{Real, Vec3};
use std::sync::Arc;

/// How surfaces are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// the edges of all triangles of spheres and of all faces
    Wireframe,
    /// the same, hidden edges left out
    HiddenLine,
    /// one color for each triangle
    Flat,
    /// lit at the corners, colors interpolated between them (Gouraud 1971)
    Gouraud,
    /// lit in every pixel, normals interpolated between the corners (Phong 1975)
    #[default]
    Phong,
}

impl Mode {
    /// All modes with their names.
    pub const ALL: [(Mode, &'static str); 5] = [
        (Mode::Wireframe, "wireframe"),
        (Mode::HiddenLine, "hidden-line"),
        (Mode::Flat, "flat"),
        (Mode::Gouraud, "gouraud"),
        (Mode::Phong, "phong"),
    ];

    /// Whether edges are drawn rather than faces.
    pub fn has_lines(self) -> bool {
        matches!(self, Mode::Wireframe | Mode::HiddenLine)
    }
}

/// The lighting equation: what light does to a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Illumination {
    /// light from everywhere only: no lamp, no shadow
    Ambient,
    /// and diffuse reflection of the lamps (Lambert, *Photometria*, 1760)
    Lambert,
    /// and highlights where the eye meets the mirrored ray of a lamp (Phong, "Illumination for Computer Generated
    /// Pictures", CACM 18, 1975)
    Phong,
    /// and highlights where the normal is half-way between lamp and eye (Blinn, "Models of Light Reflection for Computer
    /// Synthesized Pictures", SIGGRAPH 1977)
    #[default]
    Blinn,
}

impl Illumination {
    /// All equations with their names.
    pub const ALL: [(Illumination, &'static str); 4] = [
        (Illumination::Ambient, "ambient"),
        (Illumination::Lambert, "lambert"),
        (Illumination::Phong, "phong"),
        (Illumination::Blinn, "blinn"),
    ];
}

/// How finely spheres are triangulated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// each sphere as finely as its size in the picture needs to look round
    #[default]
    Auto,
    /// all alike: 20 x 4^level triangles, level 0 to [`FINEST`](crate::mesh::FINEST)
    Level(u8),
}

/// How a picture looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// how surfaces are drawn
    pub mode: Mode,
    /// what light does to a surface
    pub illumination: Illumination,
    /// how finely spheres are triangulated
    pub quality: Quality,
    /// light or dark
    pub theme: Theme,
    /// whether the first light throws shadows
    pub shadows: bool,
    /// whether edges are smoothed by four samples a pixel; `None`: where a graphics card draws, not where software does
    pub smooth: Option<bool>,
    /// whether boundaries are drawn
    pub walls: bool,
    /// whether spheres bear marks, by which one sees them spin
    pub marks: bool,
}

impl Default for Look {
    fn default() -> Look {
        Look {
            mode: Mode::default(),
            illumination: Illumination::default(),
            quality: Quality::default(),
            theme: Theme::default(),
            shadows: true,
            smooth: None,
            walls: true,
            marks: true,
        }
    }
}

/// A light from afar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// where the light goes; any length
    pub direction: Vec3,
    /// color
    pub color: Rgb,
    /// how strong: 1 for the only light of a scene
    pub strength: f32,
}

/// Most lights; those beyond are left out.
pub const MOST_LIGHTS: usize = 4;

/// A body in drawing coordinates.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Instance {
    /// where its origin is: relative to the frame's `origin`, in its `unit`
    pub position: [f32; 3],
    /// how large: the mesh times this, in the frame's `unit`
    pub scale: f32,
    /// how it is turned: x, y, z, w
    pub rotation: [f32; 4],
    /// color in the sRGB encoding, and how opaque
    pub color: [u8; 4],
    /// whether it bears marks, by which one sees it spin: 1, else 0. Only for spheres
    pub marks: f32,
}

/// Bodies of one surface.
#[derive(Clone, Debug)]
pub struct Batch {
    /// the surface
    pub mesh: Arc<Mesh>,
    /// the bodies
    pub instances: Vec<Instance>,
}

/// A plane face of a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// corners in order \[m\]
    pub corners: [Vec3; 4],
    /// into the allowed side; a face is drawn only where its front is seen
    pub normal: Vec3,
    /// whether both sides are fronts
    pub two_sided: bool,
    /// goes on beyond what is drawn: fades out, with a grid of this width \[m\] to show how far
    pub endless: Option<Real>,
    /// which edges are drawn, from each corner to the next; those of endless faces are not
    pub edges: [bool; 4],
    /// color; `None`: the theme's
    pub color: Option<Rgb>,
}

/// Everything in a picture. Kept and filled again for the next one, it allocates nothing once it has grown.
#[derive(Clone, Debug)]
pub struct Frame {
    /// from where
    pub camera: Camera,
    /// lights; the first throws shadows
    pub lights: Vec<Light>,
    /// how it looks
    pub look: Look,
    /// origin of the drawing coordinates \[m\]
    pub origin: Vec3,
    /// unit of the drawing coordinates \[m\]
    pub unit: Real,
    /// spheres
    pub spheres: Vec<Instance>,
    /// other bodies
    pub batches: Vec<Batch>,
    /// boundaries
    pub walls: Vec<Wall>,
    /// bodies that are outlined
    pub highlight: Vec<Highlighted>,
    /// what explains it
    pub overlay: Overlay,
}

/// A body that is outlined, whatever is before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Highlighted {
    /// which of the frame's batches has its surface; `None`: a sphere
    pub batch: Option<usize>,
    /// the body
    pub body: Instance,
}

/// Beyond this many units from the point looked at nothing is drawn: single precision would no longer hold it, and it
/// would be smaller than any pixel.
const FARTHEST: Real = 1e9;

impl Frame {
    /// An empty picture.
    pub fn new(camera: Camera, look: Look) -> Frame {
        let (origin, unit) = coordinates(&camera);
        Frame {
            camera,
            lights: Vec::new(),
            look,
            origin,
            unit,
            spheres: Vec::new(),
            batches: Vec::new(),
            walls: Vec::new(),
            highlight: Vec::new(),
            overlay: Overlay::default(),
        }
    }

    /// Empties the picture but for its overlay, and moves the camera. Batches stay, without bodies.
    pub fn restart(&mut self, camera: Camera, look: Look) {
        (self.origin, self.unit) = coordinates(&camera);
        (self.camera, self.look) = (camera, look);
        self.lights.clear();
        self.spheres.clear();
        self.batches.iter_mut().for_each(|b| b.instances.clear());
        self.walls.clear();
        self.highlight.clear();
    }

    /// A body in drawing coordinates; `None` where it cannot be drawn (not finite, or too far away).
    pub fn instance(&self, position: Vec3, reach: Real, orientation: Quat, color: [u8; 4]) -> Option<Instance> {
        let p = (position - self.origin) / self.unit;
        let scale = reach / self.unit;
        // Written so that a NaN is not drawn either.
        if !(p.max_abs() < FARTHEST && scale < FARTHEST && orientation.is_finite()) {
            return None;
        }
        let q = orientation;
        Some(Instance {
            position: p.to_array().map(|x| x as f32),
            scale: scale as f32,
            rotation: [q.x, q.y, q.z, q.w].map(|x| x as f32),
            color,
            marks: 0.0,
        })
    }

    /// A point in drawing coordinates.
    pub(crate) fn place(&self, p: Vec3) -> [f32; 3] {
        ((p - self.origin) / self.unit).to_array().map(|x| x as f32)
    }

    /// All bodies.
    pub(crate) fn bodies(&self) -> impl Iterator<Item = &Instance> {
        self.spheres.iter().chain(self.batches.iter().flat_map(|b| &b.instances))
    }
}

/// Drawing coordinates are relative to the point looked at, in units of its distance from the eye: single precision then
/// suffices for scenes of atoms, of planets, and of a ball far from the origin.
fn coordinates(camera: &Camera) -> (Vec3, Real) {
    let origin = if camera.look_at.is_finite() { camera.look_at } else { Vec3::ZERO };
    (origin, camera.distance())
}
