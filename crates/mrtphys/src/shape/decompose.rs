//! Convex pieces of a non-convex polyhedron.
//!
//! A binary space partition of the body's bounding box by the planes of its own faces (B. Naylor, J. Amanatides,
//! W. Thibault, "Merging BSP trees yields polyhedral set operations", SIGGRAPH 1990): its leaves are convex and lie wholly
//! inside or outside. A plane through a reflex edge resolves that edge on both of its sides (B. Chazelle, "Convex
//! partitions of polyhedra", SIAM J. Comput. 13 (1984)), so planes at reflex edges come first, those that resolve most and
//! cut least; once no reflex edge is left, the other planes only peel off what is outside. Inner leaves whose union is
//! convex are merged again. The number of pieces is small, not always the smallest: that problem is NP-hard.

use super::cell::{Cell, Plane, Solid};
use super::planar;
use super::polyhedron::ConvexPiece;
use super::surface::{PLANE_TOLERANCE, Surface, invalid, polygon};
use crate::bounds::Aabb;
use crate::error::{Error, Result};
use crate::math::{Real, Vec3};

/// Most convex pieces of a body.
pub const MAX_PIECES: usize = 2048;
/// Most faces of a body that is not convex.
pub const MAX_FACES: usize = 8192;
/// Most cuts on the way.
pub const MAX_CUTS: usize = 50_000;
/// Most candidates that are compared for one cut.
const MAX_CANDIDATES: usize = 48;
/// Most pieces among which convex unions are looked for.
const MAX_MERGED: usize = 512;
/// Largest difference between the pieces' volumes and the body's, relative.
const VOLUME: Real = 1e-9;

/// A convex part of the body's surface.
#[derive(Clone)]
struct Patch {
    polygon: Vec<Vec3>,
    plane: u32,
    /// +1 where the outside is in front of the plane, else -1
    sign: Real,
}

/// A reflex edge, or the part of it in a cell.
#[derive(Clone)]
struct Reflex {
    ends: [Vec3; 2],
    planes: [u32; 2],
}

/// A cell that is still to be cut.
struct Node {
    cell: Cell,
    /// surface inside
    within: Vec<Patch>,
    /// surface on the cell's own faces; sign +1: the cell is on its inner side
    skin: Vec<Patch>,
    reflex: Vec<Reflex>,
}

struct Cutter<'a> {
    object: &'a str,
    planes: Vec<Plane>,
    tolerance: Real,
}

/// Convex pieces that together are the body. Faces that lie on cuts are marked internal; a face that lies on the surface in
/// part is divided. Geometry below 10^-9 of the body's extent is not resolved.
///
/// # Errors
/// [`Error::LimitExceeded`] for more than [`MAX_FACES`] faces, [`MAX_PIECES`] pieces or [`MAX_CUTS`] cuts;
/// [`Error::InvalidMesh`] where the pieces' volumes do not sum to the body's, since it has features too fine to cut along.
pub(super) fn convex_pieces(object: &str, surface: &Surface, volume: Real) -> Result<Vec<ConvexPiece>> {
    if surface.faces.len() > MAX_FACES {
        return Err(limit(object, "faces of a body that is not convex", surface.faces.len(), MAX_FACES));
    }
    let tolerance = PLANE_TOLERANCE * surface.size;
    let (planes, of_face) = distinct_planes(surface, tolerance);
    let cutter = Cutter { object, planes, tolerance };
    let patches = patches(surface, &of_face, tolerance);
    let reflex = surface
        .reflex
        .iter()
        .map(|e| Reflex {
            ends: e.ends.map(|c| surface.corners[c as usize]),
            planes: e.faces.map(|f| of_face[f as usize].0),
        })
        .collect();
    let margin = Vec3::splat(0.125 * surface.size);
    let b = Aabb::of_points(surface.corners.iter().copied());
    let cell = Cell::of_box(&Aabb { min: b.min - margin, max: b.max + margin });
    let cells = cutter.leaves(Node { cell, within: patches.clone(), skin: vec![], reflex })?;
    let solids =
        cells.iter().filter_map(|c| Solid::of_corners(&c.corners(&surface.corners, tolerance), surface.size)).collect();
    let solids = merge(solids, surface.size, tolerance);
    let sum: Real = solids.iter().map(|s| s.volume).sum();
    if (sum - volume).abs() > VOLUME * volume {
        return Err(invalid(object, None, None, "features too fine to be divided into convex pieces"));
    }
    let skin: Vec<(Plane, Vec<Vec3>)> = patches
        .into_iter()
        .map(|p| {
            let plane = cutter.planes[p.plane as usize];
            (Plane { normal: plane.normal * p.sign, offset: plane.offset * p.sign }, p.polygon)
        })
        .collect();
    let piece = |s: &Solid| {
        s.piece(&skin, tolerance).ok_or_else(|| invalid(object, None, None, "a convex piece of the body is not closed"))
    };
    solids.iter().map(piece).collect()
}

fn limit(object: &str, what: &'static str, given: usize, limit: usize) -> Error {
    Error::LimitExceeded { object: object.into(), what, given: given as u64, limit: limit as u64 }
}

/// The different planes of the faces, and for every face its plane's number and the sign of its normal in it.
fn distinct_planes(surface: &Surface, tolerance: Real) -> (Vec<Plane>, Vec<(u32, Real)>) {
    let mut planes: Vec<Plane> = Vec::new();
    let mut of_face = Vec::with_capacity(surface.faces.len());
    for face in &surface.faces {
        let known = planes.iter().position(|p| {
            let parallel = p.normal.dot(face.normal).abs() > 0.999;
            parallel && face.corners.iter().all(|&c| p.distance(surface.corners[c as usize]).abs() <= tolerance)
        });
        let number = known.unwrap_or_else(|| {
            planes.push(Plane { normal: face.normal, offset: face.offset });
            planes.len() - 1
        });
        let sign = if planes[number].normal.dot(face.normal) > 0.0 { 1.0 } else { -1.0 };
        of_face.push((number as u32, sign));
    }
    (planes, of_face)
}

/// The surface as convex polygons.
fn patches(surface: &Surface, of_face: &[(u32, Real)], tolerance: Real) -> Vec<Patch> {
    let mut out = Vec::new();
    for (face, &(plane, sign)) in surface.faces.iter().zip(of_face) {
        let rim = polygon(&surface.corners, &face.corners);
        let flat = planar::project(&rim, face.normal);
        let parts = if planar::is_strictly_convex(&flat) {
            vec![rim]
        } else {
            let triangles = planar::triangulate(&flat).unwrap_or_default();
            let triangles = triangles.iter().map(|t| t.iter().map(|&i| rim[i as usize]).collect()).collect();
            planar::merge_convex(triangles, face.normal, tolerance)
        };
        out.extend(parts.into_iter().map(|polygon| Patch { polygon, plane, sign }));
    }
    out
}

impl Cutter<'_> {
    /// The convex cells inside of the body.
    fn leaves(&self, root: Node) -> Result<Vec<Cell>> {
        let mut stack = vec![root];
        let mut inside = Vec::new();
        let mut cuts = 0;
        while let Some(node) = stack.pop() {
            let Some(plane) = self.choose(&node) else {
                // The surface on its faces says whether the cell is inside; areas outvote slivers.
                let vote: Real = node.skin.iter().map(|p| p.sign * planar::area_vector(&p.polygon).length()).sum();
                if vote > 0.0 {
                    inside.push(node.cell);
                }
                continue;
            };
            cuts += 1;
            if inside.len() > MAX_PIECES {
                return Err(limit(self.object, "convex pieces", inside.len(), MAX_PIECES));
            }
            if cuts > MAX_CUTS {
                return Err(limit(self.object, "cuts into convex pieces", cuts, MAX_CUTS));
            }
            let (front, back) = self.cut(node, plane);
            // the side behind is done first
            stack.extend(front);
            stack.extend(back);
        }
        Ok(inside)
    }

    /// The side of a plane on which points lie: +1, -1, 0 on it, `None` on both sides.
    fn side(&self, plane: u32, points: &[Vec3]) -> Option<i8> {
        let p = &self.planes[plane as usize];
        let mut side = 0;
        for &x in points {
            let s = planar::classify(p.distance(x), self.tolerance);
            if s * side < 0 {
                return None;
            }
            side = if s == 0 { side } else { s };
        }
        Some(side)
    }

    /// The plane for the next cut: one of a surface inside the cell; none left: `None`.
    fn choose(&self, node: &Node) -> Option<u32> {
        let mut present: Vec<u32> = node.within.iter().map(|p| p.plane).collect();
        present.sort_unstable();
        present.dedup();
        let mut candidates: Vec<u32> = node.reflex.iter().flat_map(|r| r.planes).collect();
        candidates.sort_unstable();
        candidates.dedup();
        candidates.retain(|p| present.binary_search(p).is_ok());
        if candidates.is_empty() {
            candidates = present;
        }
        let stride = candidates.len().div_ceil(MAX_CANDIDATES).max(1);
        let mut best: Option<(i64, u32)> = None;
        for &plane in candidates.iter().step_by(stride) {
            let resolved = node.reflex.iter().filter(|r| r.planes.contains(&plane)).count() as i64;
            let crossed = node.reflex.iter().filter(|r| self.side(plane, &r.ends).is_none()).count() as i64;
            let split =
                node.within.iter().filter(|p| p.plane != plane && self.side(plane, &p.polygon).is_none()).count();
            let score = 8 * (resolved - crossed) - split as i64;
            if best.is_none_or(|b| score > b.0) {
                best = Some((score, plane));
            }
        }
        best.map(|b| b.1)
    }

    fn cut(&self, node: Node, number: u32) -> (Option<Node>, Option<Node>) {
        let plane = &self.planes[number as usize];
        let (front, back) = node.cell.cut(plane, self.tolerance);
        let make = |cell| Node { cell, within: vec![], skin: vec![], reflex: vec![] };
        let (mut front, mut back) = (front.map(make), back.map(make));
        for (patch, within) in
            node.within.into_iter().map(|p| (p, true)).chain(node.skin.into_iter().map(|p| (p, false)))
        {
            let parts = planar::cut(&patch.polygon, plane.normal, plane.offset, self.tolerance);
            let on = (within && patch.plane == number) || (parts.0.is_empty() && parts.1.is_empty());
            let put = |node: &mut Option<Node>, polygon: Vec<Vec3>, sign: Real, within: bool| {
                if let Some(n) = node.as_mut().filter(|_| polygon.len() >= 3) {
                    let list = if within { &mut n.within } else { &mut n.skin };
                    list.push(Patch { polygon, plane: patch.plane, sign });
                }
            };
            if on && within {
                // The body is behind the patch's outer normal: on the plane's back where they agree.
                let outer = self.planes[patch.plane as usize].normal * patch.sign;
                let sign = if outer.dot(plane.normal) > 0.0 { 1.0 } else { -1.0 };
                put(&mut back, patch.polygon.clone(), sign, false);
                put(&mut front, patch.polygon.clone(), -sign, false);
            } else if !on {
                put(&mut front, parts.0, patch.sign, within);
                put(&mut back, parts.1, patch.sign, within);
            }
        }
        for r in node.reflex {
            if !r.planes.contains(&number) {
                let (f, b) = self.cut_edge(&r, plane);
                front.iter_mut().for_each(|n| n.reflex.extend(f.clone()));
                back.iter_mut().for_each(|n| n.reflex.extend(b.clone()));
            }
        }
        (front, back)
    }

    /// The parts of an edge in front of and behind a plane; an edge in the plane is in neither.
    fn cut_edge(&self, r: &Reflex, plane: &Plane) -> (Option<Reflex>, Option<Reflex>) {
        let [a, b] = r.ends;
        let (da, db) = (plane.distance(a), plane.distance(b));
        let (sa, sb) = (planar::classify(da, self.tolerance), planar::classify(db, self.tolerance));
        if sa * sb >= 0 {
            return match sa + sb {
                0 => (None, None),
                s if s > 0 => (Some(r.clone()), None),
                _ => (None, Some(r.clone())),
            };
        }
        let x = a + (b - a) * (da / (da - db));
        let part = |end| Some(Reflex { ends: [end, x], planes: r.planes });
        if sa > 0 { (part(a), part(b)) } else { (part(b), part(a)) }
    }
}

/// Merges solids whose union is convex, first come, first served.
fn merge(mut solids: Vec<Solid>, size: Real, tolerance: Real) -> Vec<Solid> {
    if solids.len() > MAX_MERGED {
        return solids;
    }
    let mut i = 0;
    while i < solids.len() {
        let union = (i + 1..solids.len()).find_map(|j| solids[i].union(&solids[j], size, tolerance).map(|u| (j, u)));
        match union {
            Some((j, u)) => {
                solids[i] = u;
                solids.remove(j);
                i = 0;
            }
            None => i += 1,
        }
    }
    solids
}
