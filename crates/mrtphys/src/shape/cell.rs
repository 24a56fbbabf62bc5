//! Convex cells: what planes cut out of space, and the convex pieces that they become.

use super::polyhedron::{ConvexPiece, Face};
use super::surface::{self, Origin, Surface};
use super::{enclosing, hull, mass, planar};
use crate::bounds::Aabb;
use crate::math::{Real, Vec3};

/// A plane and the side behind it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub normal: Vec3,
    pub offset: Real,
}

impl Plane {
    pub fn distance(&self, p: Vec3) -> Real {
        self.normal.dot(p) - self.offset
    }
}

/// A convex polyhedron as its faces.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    faces: Vec<Vec<Vec3>>,
}

impl Cell {
    /// An axis-parallel box.
    pub fn of_box(b: &Aabb) -> Cell {
        let corner = |i: usize| {
            let pick = |bit: usize, low: Real, high: Real| if i >> bit & 1 == 1 { high } else { low };
            Vec3::new(pick(0, b.min.x, b.max.x), pick(1, b.min.y, b.max.y), pick(2, b.min.z, b.max.z))
        };
        let rims = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        Cell { faces: rims.iter().map(|r| r.iter().map(|&i| corner(i)).collect()).collect() }
    }

    /// The parts in front of and behind a plane; `None` for a part no thicker than the tolerance.
    pub fn cut(&self, plane: &Plane, tolerance: Real) -> (Option<Cell>, Option<Cell>) {
        let (mut front, mut back) = (Vec::new(), Vec::new());
        for face in &self.faces {
            let (f, b) = planar::cut(face, plane.normal, plane.offset, tolerance);
            front.extend(Some(f).filter(|p| p.len() >= 3));
            back.extend(Some(b).filter(|p| p.len() >= 3));
        }
        if front.is_empty() || back.is_empty() {
            return (
                Some(Cell { faces: front }).filter(|c| !c.faces.is_empty()),
                Some(Cell { faces: back }).filter(|c| !c.faces.is_empty()),
            );
        }
        let on: Vec<Vec3> = back.iter().flatten().copied().filter(|&p| plane.distance(p).abs() <= tolerance).collect();
        let mut cap = ring(&on, plane.normal);
        if cap.len() >= 3 {
            back.push(cap.clone());
            cap.reverse();
            front.push(cap);
        }
        (Some(Cell { faces: front }), Some(Cell { faces: back }))
    }

    /// The corners, each once: equal to the given ones where they are that but for rounding.
    pub fn corners(&self, given: &[Vec3], tolerance: Real) -> Vec<Vec3> {
        let mut corners: Vec<Vec3> = Vec::new();
        for &p in self.faces.iter().flatten() {
            let snapped = nearest(given, p, tolerance).map_or(p, |i| given[i]);
            if nearest(&corners, snapped, tolerance).is_none() {
                corners.push(snapped);
            }
        }
        corners
    }
}

/// The nearest of some points, if it is within the tolerance.
fn nearest(points: &[Vec3], p: Vec3, tolerance: Real) -> Option<usize> {
    let mut best = (None, tolerance);
    for (i, &q) in points.iter().enumerate() {
        let d = (q - p).max_abs();
        if d <= best.1 {
            best = (Some(i), d);
        }
    }
    best.0
}

/// The convex hull of points of a plane, counter-clockwise seen against the normal (A. Andrew's monotone chain, 1979).
fn ring(points: &[Vec3], normal: Vec3) -> Vec<Vec3> {
    let flat = planar::project(points, normal);
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&i, &j| flat[i].x.total_cmp(&flat[j].x).then(flat[i].y.total_cmp(&flat[j].y)).then(i.cmp(&j)));
    order.dedup_by(|&mut i, &mut j| flat[i] == flat[j]);
    let mut chain: Vec<usize> = Vec::new();
    let mut half = |order: &mut dyn Iterator<Item = usize>| {
        let start = chain.len();
        for i in order {
            while chain.len() >= start + 2
                && robust::orient2d(flat[chain[chain.len() - 2]], flat[chain[chain.len() - 1]], flat[i]) <= 0.0
            {
                chain.pop();
            }
            chain.push(i);
        }
        chain.pop();
    };
    half(&mut order.iter().copied());
    half(&mut order.iter().rev().copied());
    chain.into_iter().map(|i| points[i]).collect()
}

/// A convex solid: the hull of some corners.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    pub surface: Surface,
    pub volume: Real,
    pub bounds: Aabb,
}

impl Solid {
    /// The hull of some corners of a body of this size; `None` if it has no volume.
    pub fn of_corners(corners: &[Vec3], size: Real) -> Option<Solid> {
        let hull = hull::convex_hull(corners).ok()?;
        let surface = Surface::build("piece", corners, &hull.faces, Origin::Hull { size }).ok()?;
        let volume = mass::integrate(&surface.corners, &surface.triangles).volume;
        let bounds = Aabb::of_points(surface.corners.iter().copied());
        Some(Solid { surface, volume, bounds })
    }

    /// The union of two solids, if it is convex: its hull has no more volume than the two.
    pub fn union(&self, o: &Solid, size: Real, tolerance: Real) -> Option<Solid> {
        let margin = Vec3::splat(tolerance);
        if !(Aabb { min: self.bounds.min - margin, max: self.bounds.max + margin }).meets(&o.bounds) {
            return None;
        }
        let mut corners = self.surface.corners.clone();
        for &c in &o.surface.corners {
            if nearest(&corners, c, tolerance).is_none() {
                corners.push(c);
            }
        }
        let both = self.volume + o.volume;
        Solid::of_corners(&corners, size).filter(|u| (u.volume - both).abs() <= 1e-12 * both)
    }

    /// The piece, with its faces divided into what lies on the body's surface, given as convex polygons, and what is cut.
    pub fn piece(&self, skin: &[(Plane, Vec<Vec3>)], tolerance: Real) -> Option<ConvexPiece> {
        let mut corners = self.surface.corners.clone();
        let mut faces = Vec::new();
        let mut group = Vec::new();
        for (g, face) in self.surface.faces.iter().enumerate() {
            let rim = surface::polygon(&self.surface.corners, &face.corners);
            for (polygon, internal) in divide(&rim, face.normal, skin, tolerance) {
                let mut numbers: Vec<u32> = Vec::new();
                for p in polygon {
                    let i = nearest(&corners, p, tolerance).unwrap_or_else(|| {
                        corners.push(p);
                        corners.len() - 1
                    });
                    if !numbers.contains(&(i as u32)) {
                        numbers.push(i as u32);
                    }
                }
                if numbers.len() >= 3 {
                    faces.push(Face { corners: numbers, normal: face.normal, offset: face.offset, internal });
                    group.push(g as u32);
                }
            }
        }
        for face in &mut faces {
            face.corners = with_corners_between(&corners, &face.corners, tolerance);
        }
        let edges = super::edges::edges_between(&faces, &group)?;
        Some(ConvexPiece { ball: enclosing::smallest_enclosing_sphere(&corners), corners, faces, edges })
    }
}

/// Divides a face of a piece into convex polygons on the body's skin and inside of it (`true`).
fn divide(rim: &[Vec3], normal: Vec3, skin: &[(Plane, Vec<Vec3>)], tolerance: Real) -> Vec<(Vec<Vec3>, bool)> {
    let mut inner = vec![rim.to_vec()];
    let mut outer: Vec<Vec<Vec3>> = Vec::new();
    for (plane, patch) in skin {
        let on = plane.normal.dot(normal) > 0.0 && rim.iter().all(|&p| plane.distance(p).abs() <= 2.0 * tolerance);
        if !on {
            continue;
        }
        let mut rest = Vec::new();
        for part in inner {
            let (mut inside, mut outside) = (part.clone(), Vec::new());
            for i in 0..patch.len() {
                let (a, b) = (patch[i], patch[(i + 1) % patch.len()]);
                let Some(out) = (b - a).cross(normal).try_normalize() else { continue };
                let (front, back) = planar::cut(&inside, out, out.dot(a), tolerance);
                outside.extend(Some(front).filter(|p| p.len() >= 3));
                inside = back;
            }
            if inside.len() >= 3 {
                outer.push(inside);
                rest.extend(outside);
            } else {
                rest.push(part);
            }
        }
        inner = rest;
    }
    if inner.is_empty() || outer.is_empty() {
        return vec![(rim.to_vec(), outer.is_empty())];
    }
    let merged = |p| planar::merge_convex(p, normal, tolerance);
    let outer = merged(outer).into_iter().map(|p| (p, false));
    outer.chain(merged(inner).into_iter().map(|p| (p, true))).collect()
}

/// The rim with every corner of the piece that lies on one of its edges, so that neighbours share whole edges.
fn with_corners_between(corners: &[Vec3], rim: &[u32], tolerance: Real) -> Vec<u32> {
    let mut out = Vec::with_capacity(rim.len());
    for (i, &u) in rim.iter().enumerate() {
        let v = rim[(i + 1) % rim.len()];
        let (a, b) = (corners[u as usize], corners[v as usize]);
        out.push(u);
        let Some(along) = (b - a).try_normalize() else { continue };
        let length = (b - a).dot(along);
        let mut between: Vec<(Real, u32)> = Vec::new();
        for (c, &p) in corners.iter().enumerate() {
            let t = (p - a).dot(along);
            let off = (p - a - along * t).max_abs();
            if t > tolerance && t < length - tolerance && off <= tolerance && !rim.contains(&(c as u32)) {
                between.push((t, c as u32));
            }
        }
        between.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        out.extend(between.iter().map(|b| b.1));
    }
    out
}
