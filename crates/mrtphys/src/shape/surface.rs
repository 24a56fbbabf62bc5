//! The closed surface of a polyhedron: validation, plane regions, faces, edges, triangles.
//!
//! Polygons that lie in one plane and hang together are one region. A region with one simple rim is one face; one with
//! holes stays the polygons that were given. Corners in the middle of an edge or of a face are dropped: what is left are
//! the thesis's polyhedra (section A.14), whose edges are those between faces that are not coplanar.

use super::edges::{edges_between, is_reflex};
use super::polyhedron::{Edge, Face, MAX_CORNERS};
use super::{crossing, mass, planar};
use crate::error::{Error, Result};
use crate::math::{Real, Vec3, max};

/// Most polygon corners of a surface in all.
pub(super) const MAX_POLYGON_CORNERS: usize = 1 << 18;
/// Most corners of a face that is not convex: ears are clipped in O(k^2) to O(k^3).
pub(super) const MAX_RIM: usize = 1024;
/// How far a corner may lie off the plane of its face, as part of the body's extent.
pub(super) const PLANE_TOLERANCE: Real = 1e-9;
/// Polygons this close to one plane, as part of the body's extent, are one face: a thousand times the rounding of a
/// rotated body, a thousandth of the thickness of a needle of 1 : 10^6.
pub(super) const FLAT_TOLERANCE: Real = 1e-12;
/// A volume below this part of the cubed extent is none.
const NO_VOLUME: Real = 1e-16;
const NONE: u32 = u32::MAX;

/// Where polygons come from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Origin {
    /// from outside: everything is checked
    Author,
    /// from [`hull`](super::hull): known to be simple, closed and convex; tolerances are those of a body of this size \[m\]
    Hull { size: Real },
}

/// A closed surface.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub corners: Vec<Vec3>,
    pub faces: Vec<Face>,
    pub edges: Vec<Edge>,
    pub triangles: Vec<[u32; 3]>,
    /// edges at which the inside has more than 180 degrees
    pub reflex: Vec<Edge>,
    /// largest extent \[m\]
    pub size: Real,
}

/// An error about a mesh.
pub(super) fn invalid(object: &str, face: Option<usize>, edge: Option<[u32; 2]>, reason: impl Into<String>) -> Error {
    let edge = edge.map(|e| e.map(|i| i as usize));
    let reason = match edge {
        Some([a, b]) => format!("{} (points {a} and {b})", reason.into()),
        None => reason.into(),
    };
    Error::InvalidMesh { object: object.into(), face, edge, reason }
}

/// The polygons as given, with planes and neighbours.
struct Mesh<'a> {
    object: &'a str,
    points: &'a [Vec3],
    faces: &'a [Vec<u32>],
    size: Real,
    /// known to be a convex hull
    convex: bool,
    normal: Vec<Vec3>,
    area: Vec<Real>,
    /// number of each face's first half-edge
    first: Vec<u32>,
    /// face of each half-edge
    face_of: Vec<u32>,
    /// the half-edge of the neighbour that runs the other way
    twin: Vec<u32>,
}

impl Surface {
    /// From polygons, counter-clockwise seen from outside.
    pub fn build(object: &str, points: &[Vec3], faces: &[Vec<u32>], origin: Origin) -> Result<Surface> {
        if points.len() < 4 {
            return Err(Error::TooFewPoints { object: object.into(), given: points.len(), needed: 4 });
        }
        let mut size = super::check_points(object, points)?;
        let hull = match origin {
            Origin::Author => false,
            Origin::Hull { size: whole } => {
                size = max(size, whole);
                true
            }
        };
        let total: usize = faces.iter().map(Vec::len).sum();
        if total > MAX_POLYGON_CORNERS {
            let (given, limit) = (total as u64, MAX_POLYGON_CORNERS as u64);
            return Err(Error::LimitExceeded { object: object.into(), what: "corners of faces", given, limit });
        }
        if size == 0.0 {
            return Err(Error::Degenerate { object: object.into(), rank: 0 });
        }
        let mut mesh = Mesh::new(object, points, faces, size, hull)?;
        mesh.find_planes()?;
        mesh.find_twins()?;
        if !hull {
            mesh.check_manifold()?;
        }
        let regions = Regions::of(&mesh);
        let surface = mesh.assemble(&regions)?;
        if surface.corners.len() > MAX_CORNERS {
            let (given, limit) = (surface.corners.len() as u64, MAX_CORNERS as u64);
            return Err(Error::LimitExceeded { object: object.into(), what: "corners", given, limit });
        }
        surface.check_solid(object, hull)?;
        Ok(surface)
    }

    /// Moves the surface.
    pub fn translate(&mut self, by: Vec3) {
        for c in &mut self.corners {
            *c += by;
        }
        for f in &mut self.faces {
            f.offset = planar::plane_offset(f.normal, &polygon(&self.corners, &f.corners));
        }
    }

    /// That the surface encloses a volume, from outside, and does not meet itself.
    fn check_solid(&self, object: &str, hull: bool) -> Result<()> {
        let relative = mass::integrate(&self.corners, &self.triangles).volume / self.size / self.size / self.size;
        if relative < -NO_VOLUME {
            return Err(invalid(object, None, None, "inside out: turn the faces' corners round"));
        }
        if relative <= NO_VOLUME {
            return Err(invalid(object, None, None, "no volume"));
        }
        if hull {
            return Ok(());
        }
        match crossing::first_crossing(&self.corners, &self.triangles) {
            None => Ok(()),
            Some((s, t)) => {
                let [p, q] = [s, t].map(|t| {
                    let [a, b, c] = self.triangles[t].map(|i| self.corners[i as usize].to_array());
                    format!("{a:?} {b:?} {c:?}")
                });
                Err(invalid(object, None, None, format!("the surface meets itself: triangles {p} and {q}")))
            }
        }
    }
}

/// The corners of a polygon.
pub(super) fn polygon(points: &[Vec3], corners: &[u32]) -> Vec<Vec3> {
    corners.iter().map(|&c| points[c as usize]).collect()
}

impl<'a> Mesh<'a> {
    fn new(object: &'a str, points: &'a [Vec3], faces: &'a [Vec<u32>], size: Real, convex: bool) -> Result<Mesh<'a>> {
        if faces.is_empty() {
            return Err(invalid(object, None, None, "no faces"));
        }
        let mut first = Vec::with_capacity(faces.len());
        let mut face_of = Vec::new();
        for (f, corners) in faces.iter().enumerate() {
            let refuse = |reason: String| Err(invalid(object, Some(f), None, reason));
            if corners.len() < 3 {
                return refuse(format!("{} corners", corners.len()));
            }
            if let Some(c) = corners.iter().find(|&&c| c as usize >= points.len()) {
                return refuse(format!("point {c} does not exist: there are {}", points.len()));
            }
            let mut sorted = corners.clone();
            sorted.sort_unstable();
            if let Some(w) = sorted.windows(2).find(|w| w[0] == w[1]) {
                return refuse(format!("point {} is used twice", w[0]));
            }
            first.push(face_of.len() as u32);
            face_of.extend(std::iter::repeat_n(f as u32, corners.len()));
        }
        let mesh =
            Mesh { object, points, faces, size, convex, normal: vec![], area: vec![], first, face_of, twin: vec![] };
        mesh.check_distinct()?;
        Ok(mesh)
    }

    /// That no two points that are used coincide.
    fn check_distinct(&self) -> Result<()> {
        let mut used: Vec<u32> = self.faces.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        // adding zero makes -0 equal to 0 in the total order too
        let key = |c: u32| (self.points[c as usize] + Vec3::ZERO).to_array();
        used.sort_by(|&a, &b| {
            let (p, q) = (key(a), key(b));
            (0..3).map(|i| p[i].total_cmp(&q[i])).find(|o| o.is_ne()).unwrap_or(a.cmp(&b))
        });
        match used.windows(2).find(|w| key(w[0]) == key(w[1])) {
            Some(w) => Err(invalid(self.object, None, Some([w[0], w[1]]), "two points coincide")),
            None => Ok(()),
        }
    }

    fn find_planes(&mut self) -> Result<()> {
        for (f, corners) in self.faces.iter().enumerate() {
            let refuse = |reason: String| Err(invalid(self.object, Some(f), None, reason));
            let p = polygon(self.points, corners);
            let vector = planar::area_vector_wide(&p);
            let extent = super::extent(&p);
            // An area whose height is below the rounding of its coordinates is none.
            let Some(normal) =
                vector.try_normalize().filter(|_| vector.max_abs() > 4.0 * Real::EPSILON * extent * extent)
            else {
                return refuse("no area".into());
            };
            let offset = planar::plane_offset(normal, &p);
            let off = p.iter().fold(0.0, |m, &c| max(m, (normal.dot(c) - offset).abs()));
            if off > PLANE_TOLERANCE * self.size {
                return refuse(format!(
                    "not plane: corners lie off it by up to {off:e} m; split the face into triangles"
                ));
            }
            let flat = planar::project(&p, normal);
            if !self.convex && !planar::is_convex_ring(&flat) {
                if corners.len() > MAX_RIM {
                    let (given, what) = (corners.len() as u64, "corners of a face that is not convex");
                    return Err(Error::LimitExceeded {
                        object: self.object.into(),
                        what,
                        given,
                        limit: MAX_RIM as u64,
                    });
                }
                if !planar::is_simple(&flat) {
                    return refuse("the face's outline meets itself".into());
                }
            }
            self.normal.push(normal);
            self.area.push(vector.length());
        }
        Ok(())
    }

    /// First and last point of a half-edge.
    fn ends(&self, h: u32) -> [u32; 2] {
        let f = self.face_of[h as usize] as usize;
        let k = (h - self.first[f]) as usize;
        [self.faces[f][k], self.faces[f][(k + 1) % self.faces[f].len()]]
    }

    /// The next half-edge round a face.
    fn next(&self, h: u32) -> u32 {
        let f = self.face_of[h as usize] as usize;
        self.first[f] + (h - self.first[f] + 1) % self.faces[f].len() as u32
    }

    /// The half-edge before, round a face.
    fn previous(&self, h: u32) -> u32 {
        let f = self.face_of[h as usize] as usize;
        let n = self.faces[f].len() as u32;
        self.first[f] + (h - self.first[f] + n - 1) % n
    }

    /// Every edge must have two faces that run along it in opposite directions.
    fn find_twins(&mut self) -> Result<()> {
        let mut edges: Vec<([u32; 2], u32)> = (0..self.face_of.len() as u32)
            .map(|h| {
                let [u, v] = self.ends(h);
                ([u.min(v), u.max(v)], h)
            })
            .collect();
        edges.sort_unstable();
        self.twin = vec![NONE; self.face_of.len()];
        for group in edges.chunk_by(|a, b| a.0 == b.0) {
            let (edge, h) = group[0];
            let face = Some(self.face_of[h as usize] as usize);
            let refuse = |reason: &str| Err(invalid(self.object, face, Some(edge), reason));
            match group {
                [_] => return refuse("open: an edge has one face only"),
                &[(_, g), (_, h)] if self.ends(g) != self.ends(h) => {
                    self.twin[g as usize] = h;
                    self.twin[h as usize] = g;
                }
                [_, _] => return refuse("two faces run along an edge in the same direction: one is turned round"),
                _ => return refuse("not a surface: an edge has more than two faces"),
            }
        }
        Ok(())
    }

    /// That the faces at every point form one ring, and that all faces hang together.
    fn check_manifold(&self) -> Result<()> {
        let mut count = vec![0u32; self.points.len()];
        let mut start = vec![NONE; self.points.len()];
        for h in 0..self.face_of.len() as u32 {
            let [u, _] = self.ends(h);
            count[u as usize] += 1;
            start[u as usize] = h;
        }
        for (p, &h) in start.iter().enumerate().filter(|(_, h)| **h != NONE) {
            let (mut at, mut ring) = (h, 0);
            while ring == 0 || at != h {
                ring += 1;
                at = self.twin[self.previous(at) as usize];
            }
            if ring != count[p] {
                let face = Some(self.face_of[h as usize] as usize);
                return Err(invalid(self.object, face, None, format!("two parts of the surface touch in point {p}")));
            }
        }
        let mut reached = vec![false; self.faces.len()];
        let mut stack = vec![0u32];
        reached[0] = true;
        while let Some(f) = stack.pop() {
            for h in self.half_edges(f) {
                let g = self.face_of[self.twin[h as usize] as usize];
                if !std::mem::replace(&mut reached[g as usize], true) {
                    stack.push(g);
                }
            }
        }
        match reached.iter().position(|r| !r) {
            Some(f) => {
                Err(invalid(self.object, Some(f), None, "several surfaces: the face is not connected to the first one"))
            }
            None => Ok(()),
        }
    }

    fn half_edges(&self, f: u32) -> std::ops::Range<u32> {
        let first = self.first[f as usize];
        first..first + self.faces[f as usize].len() as u32
    }

    /// Whether a point may go: its regions are at most two, and it lies on the line of its neighbours on their rims.
    fn superfluous(&self, regions: &Regions) -> Vec<bool> {
        // neighbours along the rims, and number of rims, at every point
        let mut rims: Vec<(u32, Option<[u32; 2]>)> = vec![(0, None); self.points.len()];
        let mut fixed = vec![false; self.points.len()];
        for face in &regions.faces {
            let n = face.rim.len();
            for i in 0..n {
                let here = &mut rims[face.rim[i] as usize];
                here.0 += 1;
                here.1 = Some([face.rim[(i + n - 1) % n], face.rim[(i + 1) % n]]);
                fixed[face.rim[i] as usize] |= !face.whole;
            }
        }
        (0..self.points.len())
            .map(|p| match rims[p] {
                (0, _) => true,
                (2, Some([u, v])) if !fixed[p] => {
                    let [u, p, v] = [u as usize, p, v as usize].map(|i| self.points[i]);
                    let chord = (v - u).try_normalize().unwrap_or(Vec3::ZERO);
                    chord.cross(p - u).length() <= FLAT_TOLERANCE * self.size
                }
                _ => false,
            })
            .collect()
    }

    fn assemble(&self, regions: &Regions) -> Result<Surface> {
        let drop = self.superfluous(regions);
        let mut number = vec![NONE; self.points.len()];
        let mut corners = Vec::new();
        for (p, &point) in self.points.iter().enumerate() {
            if !drop[p] {
                number[p] = corners.len() as u32;
                corners.push(point);
            }
        }
        let (mut faces, mut triangles, mut given) = (Vec::new(), Vec::new(), Vec::new());
        for region_face in &regions.faces {
            let rim: Vec<u32> = region_face.rim.iter().map(|&p| number[p as usize]).filter(|&c| c != NONE).collect();
            let p = polygon(&corners, &rim);
            let flat =
                || invalid(self.object, Some(region_face.seed as usize), None, "the face and its neighbours are flat");
            let normal = planar::area_vector_wide(&p).try_normalize().ok_or_else(flat)?;
            let parts = planar::triangulate(&planar::project(&p, normal)).ok_or_else(flat)?;
            triangles.extend(parts.iter().map(|t| t.map(|i| rim[i as usize])));
            faces.push(Face { offset: planar::plane_offset(normal, &p), corners: rim, normal, internal: false });
            given.push(region_face.region);
        }
        if faces.len() < 4 {
            return Err(invalid(self.object, None, None, "no volume: fewer than four planes"));
        }
        let edges = edges_between(&faces, &given).ok_or_else(|| invalid(self.object, None, None, "not closed"))?;
        let size = super::extent(&corners);
        let reflex = edges.iter().filter(|e| is_reflex(&corners, &faces, e, size)).copied().collect();
        Ok(Surface { corners, faces, edges, triangles, reflex, size })
    }
}

/// A polygon of the result: a whole region, or a given polygon of a region with holes.
struct RegionFace {
    rim: Vec<u32>,
    region: u32,
    /// a given face that it holds
    seed: u32,
    whole: bool,
}

/// Plane regions of a mesh.
struct Regions {
    faces: Vec<RegionFace>,
}

impl Regions {
    fn of(mesh: &Mesh<'_>) -> Regions {
        let (region, count) = grow_regions(mesh);
        let mut members: Vec<Vec<u32>> = vec![Vec::new(); count as usize];
        for (f, &r) in region.iter().enumerate() {
            members[r as usize].push(f as u32);
        }
        // in the order of the first polygon given
        members.sort_by_key(|m| m[0]);
        let mut faces = Vec::new();
        for (number, m) in members.iter().enumerate() {
            let number = number as u32;
            match single_rim(mesh, &region, m) {
                Some(rim) => faces.push(RegionFace { rim, region: number, seed: m[0], whole: true }),
                None => faces.extend(m.iter().map(|&f| RegionFace {
                    rim: mesh.faces[f as usize].clone(),
                    region: number,
                    seed: f,
                    whole: false,
                })),
            }
        }
        Regions { faces }
    }
}

/// Number of the region of every polygon. Regions grow from the largest polygons, whose planes are the best known.
fn grow_regions(mesh: &Mesh<'_>) -> (Vec<u32>, u32) {
    let n = mesh.faces.len();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&f, &g| mesh.area[g].total_cmp(&mesh.area[f]).then(f.cmp(&g)));
    let mut region = vec![NONE; n];
    let mut count = 0;
    for seed in order {
        if region[seed] != NONE {
            continue;
        }
        let normal = mesh.normal[seed];
        let offset = planar::plane_offset(normal, &polygon(mesh.points, &mesh.faces[seed]));
        let coplanar = |g: usize| {
            mesh.normal[g].dot(normal) > 0.0
                && mesh.faces[g]
                    .iter()
                    .all(|&c| (normal.dot(mesh.points[c as usize]) - offset).abs() <= FLAT_TOLERANCE * mesh.size)
        };
        region[seed] = count;
        let mut stack = vec![seed as u32];
        while let Some(f) = stack.pop() {
            for h in mesh.half_edges(f) {
                let g = mesh.face_of[mesh.twin[h as usize] as usize] as usize;
                if region[g] == NONE && coplanar(g) {
                    region[g] = count;
                    stack.push(g as u32);
                }
            }
        }
        count += 1;
    }
    (region, count)
}

/// The rim of a region as one ring of different points, if it is one.
fn single_rim(mesh: &Mesh<'_>, region: &[u32], members: &[u32]) -> Option<Vec<u32>> {
    let mine = region[members[0] as usize];
    let inner = |h: u32| region[mesh.face_of[mesh.twin[h as usize] as usize] as usize] == mine;
    let borders: Vec<u32> = members.iter().flat_map(|&f| mesh.half_edges(f)).filter(|&h| !inner(h)).collect();
    let first = *borders.first()?;
    let (mut rim, mut at) = (Vec::new(), first);
    while rim.is_empty() || at != first {
        rim.push(mesh.ends(at)[0]);
        at = mesh.next(at);
        while inner(at) {
            at = mesh.next(mesh.twin[at as usize]);
        }
    }
    let mut sorted = rim.clone();
    sorted.sort_unstable();
    sorted.dedup();
    let small = rim.len() <= MAX_RIM || members.len() == 1 || mesh.convex;
    (small && rim.len() == borders.len() && sorted.len() == rim.len()).then_some(rim)
}
