//! Edges of a closed surface of plane polygons.

use super::polyhedron::{Edge, Face};
use super::surface::PLANE_TOLERANCE;
use crate::math::{Real, Vec3, max};

/// Whether the inside has more than 180 degrees at an edge: the second face rises above the plane of the first.
pub(super) fn is_reflex(corners: &[Vec3], faces: &[Face], e: &Edge, size: Real) -> bool {
    let [u, v] = e.ends.map(|c| corners[c as usize]);
    let [f, g] = e.faces.map(|f| &faces[f as usize]);
    // The first face runs from u to v, the second from v to u: its inside is to the left of that.
    let Some(inward) = g.normal.cross(u - v).try_normalize() else { return false };
    let width = g.corners.iter().fold(0.0, |m, &c| max(m, inward.dot(corners[c as usize] - u)));
    inward.dot(f.normal) * width > PLANE_TOLERANCE * size
}

/// Edges between faces of different groups; `None` where a face's edge has no partner.
pub(super) fn edges_between(faces: &[Face], group: &[u32]) -> Option<Vec<Edge>> {
    let mut directed: Vec<([u32; 2], u32)> = Vec::new();
    for (f, face) in faces.iter().enumerate() {
        let n = face.corners.len();
        directed.extend((0..n).map(|i| ([face.corners[i], face.corners[(i + 1) % n]], f as u32)));
    }
    directed.sort_unstable();
    let mut edges = Vec::new();
    for &([u, v], f) in &directed {
        let twin = directed.binary_search_by(|e| e.0.cmp(&[v, u])).ok()?;
        let g = directed[twin].1;
        if u < v && group[f as usize] != group[g as usize] {
            edges.push(Edge { ends: [u, v], faces: [f, g] });
        }
    }
    Some(edges)
}
