//! A scene as it was described: plain data, checked, but no world yet.

use crate::source::{Source, Span};
use crate::table::TableRows;
use mrtphys::def::{Combine, Settings};
use mrtphys::math::{Quat, Real, Vec3};
use std::sync::Arc;

/// Most bodies of a scene.
pub const MOST_BODIES: u64 = 10_000_000;

/// A scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// the text it was read from
    pub source: Source,
    /// title for display
    pub title: String,
    /// simulated time \[s\]
    pub seconds: Real,
    /// how it is simulated
    pub settings: Settings,
    /// seed of the lattices' random numbers
    pub seed: u64,
    /// fields of acceleration
    pub force_fields: Vec<ForceFieldDesc>,
    /// fields of flow
    pub flow_fields: Vec<FlowFieldDesc>,
    /// materials, in order of their names
    pub materials: Vec<Material>,
    /// bodies, lattices and body tables in the order of the text, which is the order of creation
    pub contents: Vec<Content>,
    /// boundaries
    pub boundaries: Vec<BoundaryDesc>,
    /// where a viewer looks from; `None`: it is the viewer's choice
    pub camera: Option<Camera>,
    /// lights; none: it is the viewer's choice
    pub lights: Vec<Light>,
}

/// One or many bodies.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// a body
    Body(BodyDesc),
    /// a lattice
    Lattice(LatticeDesc),
    /// bodies from a file
    Table(BodyTableDesc),
}

impl Content {
    /// The name: given, or made from the place in the text.
    pub fn name(&self) -> &str {
        match self {
            Content::Body(b) => &b.name,
            Content::Lattice(l) => &l.name,
            Content::Table(t) => &t.name,
        }
    }

    /// Number of bodies.
    pub fn count(&self) -> u64 {
        match self {
            Content::Body(_) => 1,
            Content::Lattice(l) => l.count.iter().fold(1, |n: u64, &c| n.saturating_mul(c.into())),
            Content::Table(t) => t.rows.len() as u64,
        }
    }

    /// Where it stands in the text.
    pub fn span(&self) -> Span {
        match self {
            Content::Body(b) => b.span,
            Content::Lattice(l) => l.span,
            Content::Table(t) => t.span,
        }
    }
}

/// A color for display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Color {
    /// red, green, blue
    pub rgb: [u8; 3],
}

impl Color {
    /// White.
    pub const WHITE: Color = Color { rgb: [255; 3] };

    /// From `#rrggbb`.
    pub fn parse(s: &str) -> Option<Color> {
        let digits = s.strip_prefix('#').filter(|d| d.len() == 6 && d.bytes().all(|b| b.is_ascii_hexdigit()))?;
        let [_, r, g, b] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
        Some(Color { rgb: [r, g, b] })
    }
}

impl std::fmt::Display for Color {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [r, g, b] = self.rgb;
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

/// Surface values as given; what is missing comes from the material, then from the default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceDesc {
    /// friction coefficient
    pub friction: Option<Real>,
    /// coefficient of restitution
    pub restitution: Option<Real>,
    /// how friction combines
    pub friction_combine: Option<Combine>,
    /// how restitution combines
    pub restitution_combine: Option<Combine>,
}

/// Properties that bodies may share.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// name
    pub name: String,
    /// density \[kg/m3\]
    pub density: Option<Real>,
    /// surface
    pub surface: SurfaceDesc,
}

/// The mass of a body as given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum MassDesc {
    /// nothing given: the material's density, else 1 kg
    #[default]
    Unset,
    /// \[kg\]
    Value(Real),
    /// \[kg/m3\]
    Density(Real),
    /// infinite: the body never moves
    Fixed,
}

/// A shape as given, in the author's coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum ShapeDesc {
    /// about the origin
    Sphere {
        /// \[m\]
        radius: Real,
    },
    /// regular, about the origin
    Tetrahedron {
        /// \[m\]
        circumradius: Real,
    },
    /// any tetrahedron
    TetrahedronPoints([Vec3; 4]),
    /// about the origin
    Cuboid {
        /// edge lengths \[m\]
        size: Vec3,
    },
    /// convex or not
    Polyhedron {
        /// corners \[m\]
        points: Arc<[Vec3]>,
        /// corner numbers of each face, counter-clockwise seen from outside
        faces: Arc<[Vec<u32>]>,
    },
    /// the hull of points
    ConvexHull {
        /// \[m\]
        points: Arc<[Vec3]>,
    },
    /// thin, plane, convex
    Quadrangle([Vec3; 4]),
}

/// What a body is made of: the same for a single body and for those of a lattice.
#[derive(Clone, Debug, PartialEq)]
pub struct SubstanceDesc {
    /// shape
    pub shape: ShapeDesc,
    /// mass
    pub mass: MassDesc,
    /// name of a material
    pub material: Option<String>,
    /// surface
    pub surface: SurfaceDesc,
    /// color for display
    pub color: Option<Color>,
    /// the shape in the text
    pub shape_span: Span,
}

/// Where a body is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Placement {
    /// the origin of the shape's coordinates \[m\]
    Origin(Vec3),
    /// the centre of mass \[m\]
    CenterOfMass(Vec3),
}

/// How a body turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turning {
    /// angular velocity \[rad/s\], world axes
    Velocity(Vec3),
    /// angular momentum about the centre of mass \[Js\], world axes
    Momentum(Vec3),
}

/// A body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyDesc {
    /// name
    pub name: String,
    /// what it is made of
    pub substance: SubstanceDesc,
    /// where it is
    pub placement: Placement,
    /// orientation
    pub orientation: Quat,
    /// velocity of the centre of mass \[m/s\]
    pub velocity: Vec3,
    /// how it turns
    pub turning: Turning,
    /// where it stands in the text
    pub span: Span,
}

/// Bodies in rows and layers.
#[derive(Clone, Debug, PartialEq)]
pub struct LatticeDesc {
    /// name
    pub name: String,
    /// bodies along x, y, z
    pub count: [u32; 3],
    /// lower corner of the region \[m\]
    pub min: Vec3,
    /// upper corner of the region \[m\]
    pub max: Vec3,
    /// random displacement, as a fraction of the free gap
    pub jitter: Real,
    /// speed of every body \[m/s\]
    pub speed: Real,
    /// angular speed of every body \[rad/s\]
    pub spin: Real,
    /// its own seed; `None`: the scene's plus `place`
    pub seed: Option<u64>,
    /// its place among the lattices of the scene
    pub place: u64,
    /// what the bodies are made of, in turns
    pub bodies: Vec<SubstanceDesc>,
    /// where it stands in the text
    pub span: Span,
}

/// Bodies from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyTableDesc {
    /// name
    pub name: String,
    /// the file, relative to the scene's folder
    pub file: String,
    /// what the file says
    pub rows: Arc<TableRows>,
    /// where it stands in the text
    pub span: Span,
}

/// What carries a field, and what it acts on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScopeDesc {
    /// name of the body that carries it
    pub carrier: Option<String>,
    /// names of bodies, lattices and body tables; `None`: everything
    pub only: Option<Vec<String>>,
    /// whether it acts back on its carrier
    pub reaction: bool,
    /// where the field stands in the text
    pub span: Span,
}

/// Kinds of force fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ForceKind {
    /// gravity at the earth's surface
    EarthGravity {
        /// \[m/s2\]
        g: Real,
        /// where it points; any length
        direction: Vec3,
    },
    /// the same everywhere
    Uniform {
        /// \[m/s2\]
        acceleration: Vec3,
    },
    /// strength / r^exponent towards a point
    Point {
        /// \[m\]; relative to the carrier, where there is one
        position: Vec3,
        /// \[m^(exponent+1)/s2\]
        strength: Real,
        /// exponent of the distance
        exponent: i32,
    },
    /// round an axis
    Vortex {
        /// a point of the axis \[m\]
        point: Vec3,
        /// its direction; any length
        axis: Vec3,
        /// \[m2/s2\]
        strength: Real,
    },
}

/// A force field.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceFieldDesc {
    /// what it is
    pub kind: ForceKind,
    /// what it acts on
    pub scope: ScopeDesc,
}

/// Kinds of flow fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FlowKind {
    /// the same everywhere
    Uniform {
        /// \[m/s\]
        velocity: Vec3,
    },
    /// round an axis
    Vortex {
        /// a point of the axis \[m\]
        point: Vec3,
        /// its direction; any length
        axis: Vec3,
        /// \[m2/s\]
        circulation: Real,
    },
    /// towards a point
    Sink {
        /// \[m\]
        point: Vec3,
        /// \[m3/s\]
        strength: Real,
    },
}

/// A flow field.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowFieldDesc {
    /// what it is
    pub kind: FlowKind,
    /// what it acts on
    pub scope: ScopeDesc,
}

/// Kinds of boundaries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BoundaryKind {
    /// six limit quadrangles facing inward
    Box {
        /// lower corner \[m\]
        min: Vec3,
        /// upper corner \[m\]
        max: Vec3,
    },
    /// everything behind a plane is forbidden
    HalfSpace {
        /// a point of the plane \[m\]
        point: Vec3,
        /// into the allowed side; any length
        normal: Vec3,
    },
    /// reflects from both sides
    Plane {
        /// a point of the plane \[m\]
        point: Vec3,
        /// any length
        normal: Vec3,
    },
    /// a half-space with a finite face
    Quadrangle {
        /// corners in order \[m\]
        points: [Vec3; 4],
        /// into the allowed side; any length
        normal: Vec3,
    },
}

/// A boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryDesc {
    /// name
    pub name: String,
    /// what it is
    pub kind: BoundaryKind,
    /// surface
    pub surface: SurfaceDesc,
    /// name of a material
    pub material: Option<String>,
    /// color for display
    pub color: Option<Color>,
    /// where it stands in the text
    pub span: Span,
}

/// Where a viewer looks from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// position of the eye \[m\]
    pub eye: Vec3,
    /// the point looked at \[m\]
    pub look_at: Vec3,
    /// upwards
    pub up: Vec3,
    /// vertical angle of view \[degrees\]
    pub fov_deg: Real,
}

impl Default for Camera {
    fn default() -> Camera {
        Camera { eye: Vec3::new(2.0, 1.5, 3.0), look_at: Vec3::splat(0.5), up: Vec3::new(0.0, 1.0, 0.0), fov_deg: 45.0 }
    }
}

/// A light from afar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// where the light goes
    pub direction: Vec3,
    /// color
    pub color: Color,
}

impl Default for Light {
    fn default() -> Light {
        Light { direction: Vec3::new(-1.0, -2.0, -1.0), color: Color::WHITE }
    }
}
