//! Polyhedra (thesis, sections 6.6.2, A.14, A.15), convex and not.

use super::surface::{Origin, Surface};
use super::{MassProperties, Shape, decompose, enclosing, hull, mass, planar};
use crate::bounds::{Aabb, Ball};
use crate::error::{Error, Result};
use crate::math::{Mat3, Quat, Real, Vec3};
use std::sync::Arc;

/// Most corners of a polyhedron. Contacts between polyhedra compare all edges of one with all of the other, so that some
/// hundred are the sensible number; this is what memory and the checks of a surface allow.
pub const MAX_CORNERS: usize = 1 << 15;

/// A plane polygon of a polyhedron's surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// corner numbers, counter-clockwise seen from outside
    pub corners: Vec<u32>,
    /// outward unit normal
    pub normal: Vec3,
    /// normal . x on the face \[m\]
    pub offset: Real,
    /// inside of the body: a cut between two convex pieces, which nothing outside can touch
    pub internal: bool,
}

/// An edge of a polyhedron between two faces that are not coplanar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// the two corners
    pub ends: [u32; 2],
    /// the two faces that meet in it
    pub faces: [u32; 2],
}

/// A convex polyhedron, or a convex piece of one that is not.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexPiece {
    /// corners \[m\], in the coordinates of the whole body
    pub corners: Vec<Vec3>,
    /// faces; coplanar triangles are one face
    pub faces: Vec<Face>,
    /// edges
    pub edges: Vec<Edge>,
    /// smallest enclosing sphere, in the coordinates of the whole body
    pub ball: Ball,
}

/// A rigid polyhedron; its centre of mass is the origin of its coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyhedron {
    /// corners \[m\]
    pub(crate) corners: Vec<Vec3>,
    /// triangles of the surface, counter-clockwise seen from outside
    pub(crate) triangles: Vec<[u32; 3]>,
    /// faces of the surface: coplanar triangles are one face
    pub(crate) faces: Vec<Face>,
    /// edges between faces that are not coplanar
    pub(crate) edges: Vec<Edge>,
    /// convex pieces; exactly one where the polyhedron is convex
    pub(crate) pieces: Vec<ConvexPiece>,
    pub(crate) ball: Ball,
    pub(crate) mass: MassProperties,
    pub(crate) author_origin: Vec3,
    pub(crate) kind: &'static str,
}

impl Polyhedron {
    /// From a closed surface of plane polygons, given by point numbers, counter-clockwise seen from outside. Convex or not;
    /// polygons may be non-convex, but have no holes (cut a face with a hole into several). Points that no face uses are
    /// ignored, coplanar neighbours become one face, and the coordinates are moved so that the centroid is the origin.
    ///
    /// Tolerances, relative to the largest extent: a corner may lie 10^-9 off the plane of its face; faces within 10^-12
    /// of one plane are one face; a body whose edges rise less than 10^-9 above their neighbours is convex.
    ///
    /// # Errors
    /// [`Error::InvalidMesh`] naming the face or edge: a point number out of range or repeated, points that coincide, a
    /// face without area, not plane, or whose outline meets itself; an edge with one or more than two faces, or two faces
    /// of opposite sense; parts that touch in a point, several surfaces, a surface that meets itself or is inside out, no
    /// volume. [`Error::NonFinite`], [`Error::OutOfRange`], [`Error::TooFewPoints`] for the points;
    /// [`Error::LimitExceeded`] above [`MAX_CORNERS`] and the limits of [`decompose`].
    pub fn from_mesh(points: &[Vec3], faces: &[Vec<u32>]) -> Result<Polyhedron> {
        let surface = Surface::build("polyhedron", points, faces, Origin::Author)?;
        Polyhedron::of_surface("polyhedron", "polyhedron", surface)
    }

    /// The convex hull of some points; moved so that its centroid is the origin.
    ///
    /// # Errors
    /// Those of [`hull::convex_hull`]; [`Error::LimitExceeded`] above [`MAX_CORNERS`] corners of the hull;
    /// [`Error::Degenerate`] for points that are coplanar to 10^-12 of their extent.
    pub fn convex_hull(points: &[Vec3]) -> Result<Polyhedron> {
        let hull = hull::convex_hull(points)?;
        let surface = Surface::build("convex hull", points, &hull.faces, Origin::Hull { size: super::extent(points) })
            .map_err(|e| match e {
                Error::InvalidMesh { object, .. } => Error::Degenerate { object, rank: 2 },
                other => other,
            })?;
        Polyhedron::of_surface("convex hull", "polyhedron", surface)
    }

    /// The regular tetrahedron with this circumradius \[m\]: (1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1) times
    /// r / sqrt 3.
    ///
    /// # Errors
    /// [`Error::NonFinite`], or [`Error::OutOfRange`] for a radius outside of
    /// [`SMALLEST_SIZE`](super::SMALLEST_SIZE) to [`LARGEST_SIZE`](super::LARGEST_SIZE).
    pub fn tetrahedron(circumradius: Real) -> Result<Polyhedron> {
        super::check_size("tetrahedron", "circumradius", circumradius)?;
        let s = circumradius / (3.0 as Real).sqrt();
        let points = [(1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0)]
            .map(|(x, y, z)| Vec3::new(x, y, z) * s);
        let surface =
            Surface::build("tetrahedron", &points, &tetrahedron_faces(&points), Origin::Hull { size: 2.0 * s })?;
        // With the edge a = 2 sqrt 2 s: a^3 / (6 sqrt 2) = 8/3 s^3 and a^2/20 = 2/5 s^2 about every axis.
        let mass = MassProperties {
            volume: 8.0 / 3.0 * s * s * s,
            moments_per_mass: Vec3::splat(0.4 * s * s),
            axes: Quat::IDENTITY,
        };
        Polyhedron::centered("tetrahedron", "tetrahedron", surface, Vec3::ZERO, mass)
    }

    /// The tetrahedron with these corners, in any order; moved so that its centroid is the origin.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::OutOfRange`], or [`Error::Degenerate`] for corners that span no volume.
    pub fn tetrahedron_from_points(points: [Vec3; 4]) -> Result<Polyhedron> {
        let mut body = Polyhedron::convex_hull(&points).map_err(|e| match e {
            Error::Degenerate { rank, .. } => Error::Degenerate { object: "tetrahedron".into(), rank },
            Error::NonFinite { field, .. } => Error::NonFinite { object: "tetrahedron".into(), field },
            Error::OutOfRange { field, value, expected, .. } => {
                Error::OutOfRange { object: "tetrahedron".into(), field, value, expected }
            }
            other => other,
        })?;
        body.kind = "tetrahedron";
        Ok(body)
    }

    /// A box with these edge lengths \[m\], parallel to the axes, its centre at the origin.
    ///
    /// # Errors
    /// [`Error::NonFinite`], or [`Error::OutOfRange`] for a length outside of [`SMALLEST_SIZE`](super::SMALLEST_SIZE) to
    /// [`LARGEST_SIZE`](super::LARGEST_SIZE).
    pub fn cuboid(size: Vec3) -> Result<Polyhedron> {
        for (field, length) in [("size.x", size.x), ("size.y", size.y), ("size.z", size.z)] {
            super::check_size("box", field, length)?;
        }
        let h = size * 0.5;
        let side = |i: u32, bit: u32, h: Real| if i >> bit & 1 == 1 { h } else { -h };
        let corners: Vec<Vec3> = (0..8).map(|i| Vec3::new(side(i, 0, h.x), side(i, 1, h.y), side(i, 2, h.z))).collect();
        let (x, y, z) = (size.x * size.x, size.y * size.y, size.z * size.z);
        // J = m/12 (b^2 + c^2) about the axis of a
        let mass = MassProperties {
            volume: size.x * size.y * size.z,
            moments_per_mass: Vec3::new((y + z) / 12.0, (z + x) / 12.0, (x + y) / 12.0),
            axes: Quat::IDENTITY,
        };
        Polyhedron::centered("box", "box", box_surface(corners, size.max_abs())?, Vec3::ZERO, mass)
    }

    /// Moves a surface to its centroid and completes it. A centroid that is the author's origin but for rounding is that.
    fn of_surface(object: &str, kind: &'static str, mut surface: Surface) -> Result<Polyhedron> {
        let integrals = mass::integrate(&surface.corners, &surface.triangles);
        let noise = 16.0 * Real::EPSILON * surface.size;
        let center = if integrals.centroid.max_abs() <= noise { Vec3::ZERO } else { integrals.centroid };
        let mut mass = MassProperties::of_tensor(integrals.volume, &integrals.inertia);
        if center != Vec3::ZERO {
            surface.translate(-center);
            // of the corners as they are now
            let moved = mass::integrate(&surface.corners, &surface.triangles);
            mass = MassProperties::of_tensor(moved.volume, &moved.inertia);
        }
        Polyhedron::centered(object, kind, surface, Vec3::ZERO - center, mass)
    }

    fn centered(
        object: &str,
        kind: &'static str,
        surface: Surface,
        author_origin: Vec3,
        mass: MassProperties,
    ) -> Result<Polyhedron> {
        if mass.volume <= 0.0 || !mass.volume.is_finite() {
            let expected = "a volume that a number can hold";
            return Err(Error::OutOfRange { object: object.into(), field: "volume", value: mass.volume, expected });
        }
        let ball = enclosing::body_ball(&surface.corners);
        let pieces = if surface.reflex.is_empty() {
            let (corners, faces, edges) = (surface.corners.clone(), surface.faces.clone(), surface.edges.clone());
            vec![ConvexPiece { corners, faces, edges, ball }]
        } else {
            decompose::convex_pieces(object, &surface, mass.volume)?
        };
        let Surface { corners, triangles, faces, edges, .. } = surface;
        Ok(Polyhedron { corners, triangles, faces, edges, pieces, ball, mass, author_origin, kind })
    }

    /// Corners \[m\].
    #[inline]
    pub fn corners(&self) -> &[Vec3] {
        &self.corners
    }

    /// Triangles of the surface, counter-clockwise seen from outside.
    #[inline]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Faces of the surface. Coplanar neighbours are one face, unless together they have a hole.
    #[inline]
    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// Edges between faces that are not coplanar.
    #[inline]
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Convex pieces; together they are the body, and they do not overlap.
    #[inline]
    pub fn pieces(&self) -> &[ConvexPiece] {
        &self.pieces
    }

    /// Whether the polyhedron is convex.
    #[inline]
    pub fn is_convex(&self) -> bool {
        self.pieces.len() == 1
    }
}

impl ConvexPiece {
    /// The corner farthest in a direction; of equal ones the first. O(corners).
    pub fn support(&self, direction: Vec3) -> usize {
        let mut best = (0, Real::NEG_INFINITY);
        for (i, c) in self.corners.iter().enumerate() {
            let d = direction.dot(*c);
            if d > best.1 {
                best = (i, d);
            }
        }
        best.0
    }

    /// The range that the piece spans along a direction: smallest and largest product with its corners.
    pub fn span(&self, direction: Vec3) -> (Real, Real) {
        self.corners.iter().fold((Real::INFINITY, Real::NEG_INFINITY), |(low, high), c| {
            let d = direction.dot(*c);
            (crate::math::min(low, d), crate::math::max(high, d))
        })
    }

    /// Volume \[m3\].
    pub fn volume(&self) -> Real {
        let fans = self
            .faces
            .iter()
            .flat_map(|f| (1..f.corners.len() - 1).map(|i| [f.corners[0], f.corners[i], f.corners[i + 1]]));
        mass::integrate(&self.corners, &fans.collect::<Vec<_>>()).volume
    }
}

/// The faces of a tetrahedron whichever way round it is given.
fn tetrahedron_faces(p: &[Vec3; 4]) -> Vec<Vec<u32>> {
    let volume = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
    let [b, c] = if volume < 0.0 { [1, 2] } else { [2, 1] };
    vec![vec![0, b, c], vec![0, 3, b], vec![b, 3, c], vec![c, 3, 0]]
}

/// The surface of a box: corner i is on the positive side of x, y, z where bits 0, 1, 2 of i are set; faces in the order
/// -x, +x, -y, +y, -z, +z. Written down rather than built: its planes are exact.
fn box_surface(corners: Vec<Vec3>, size: Real) -> Result<Surface> {
    let rims: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let mut faces = Vec::new();
    let mut triangles = Vec::new();
    for (f, rim) in rims.iter().enumerate() {
        let mut normal = Vec3::ZERO;
        normal[f / 2] = if f % 2 == 0 { -1.0 } else { 1.0 };
        let offset = planar::plane_offset(normal, &[corners[rim[0] as usize]]);
        faces.push(Face { corners: rim.to_vec(), normal, offset, internal: false });
        triangles.extend([[rim[0], rim[1], rim[2]], [rim[0], rim[2], rim[3]]]);
    }
    let edges = super::edges::edges_between(&faces, &[0, 1, 2, 3, 4, 5])
        .ok_or_else(|| super::surface::invalid("box", None, None, "not closed"))?;
    Ok(Surface { corners, faces, edges, triangles, reflex: vec![], size })
}

impl From<Polyhedron> for Arc<dyn Shape> {
    fn from(s: Polyhedron) -> Arc<dyn Shape> {
        Arc::new(s)
    }
}

impl Shape for Polyhedron {
    fn kind(&self) -> &'static str {
        self.kind
    }
    fn bounding_sphere(&self) -> Ball {
        self.ball
    }
    fn bounding_box(&self, position: Vec3, rotation: &Mat3) -> Aabb {
        Aabb::of_points(self.corners.iter().map(|&c| position + *rotation * c))
    }
    fn mass_properties(&self) -> Option<MassProperties> {
        Some(self.mass)
    }
    fn author_origin(&self) -> Vec3 {
        self.author_origin
    }
}
