//! Contacts of bodies made of convex pieces: which pieces meet, along which normal, in which area.

use super::clip::{ClipScratch, clean, order_round, perimeter_centroid, project_cap};
use super::pairs::sphere_polyhedron::Place;
use super::sat::{Axis, AxisScratch, FLAT, Feature, Pair, Solid, TIE, Turned, Whole};
use super::{Placed, Touch, Touches};
use crate::bounds::Ball;
use crate::math::{Mat3, Real, Vec3, max};
use crate::shape::Quadrangle;
use crate::shape::polyhedron::{ConvexPiece, Edge, Face};
use std::sync::LazyLock;

/// Memory of the routines for bodies of convex pieces, kept from call to call.
#[derive(Clone, Debug, Default)]
pub(crate) struct PairScratch {
    a: Turned,
    b: Turned,
    axes: AxisScratch,
    clip: ClipScratch,
    old_list: Vec<Touch>,
    old_points: Vec<Vec3>,
    /// memory for putting points in order
    pub order: Vec<(Real, Real, Vec3)>,
    /// corners at a wall
    pub corners: Vec<Vec3>,
    /// places where a sphere touches
    pub places: Vec<Place>,
}

/// Who meets whom in a quadrangle: a box of height zero. Faces 0 and 1 are its two sides, 2 to 5 its rims, each of two
/// corners; every edge is there twice, once for either side, so that no arc on the Gauss map spans a half-circle.
static FLAT_BOX: LazyLock<ConvexPiece> = LazyLock::new(|| {
    let face = |corners: &[u32]| Face { corners: corners.to_vec(), normal: Vec3::ZERO, offset: 0.0, internal: false };
    let mut faces = vec![face(&[0, 1, 2, 3]), face(&[3, 2, 1, 0])];
    let mut edges = Vec::new();
    for i in 0..4 {
        let ends = [i, (i + 1) % 4];
        faces.push(face(&ends));
        edges.push(Edge { ends, faces: [0, 2 + i] });
        edges.push(Edge { ends, faces: [2 + i, 1] });
    }
    ConvexPiece { corners: Vec::new(), faces, edges, ball: Ball::EMPTY }
});

/// A body made of convex pieces.
#[derive(Clone, Copy)]
pub(crate) enum Pieces<'a> {
    /// those of a polyhedron
    Of(&'a [ConvexPiece]),
    /// a quadrangle: one piece, flat
    Flat(&'a Quadrangle),
}

impl<'a> Pieces<'a> {
    fn count(&self) -> usize {
        match self {
            Pieces::Of(pieces) => pieces.len(),
            Pieces::Flat(_) => 1,
        }
    }

    fn topology(&self, i: usize) -> &'a ConvexPiece {
        match self {
            Pieces::Of(pieces) => &pieces[i],
            Pieces::Flat(_) => &FLAT_BOX,
        }
    }

    fn ball(&self, i: usize) -> Ball {
        match self {
            Pieces::Of(pieces) => pieces[i].ball,
            Pieces::Flat(q) => q.ball,
        }
    }

    fn solid<'s>(&self, i: usize, turned: &'s Turned, rotation: &'s Mat3) -> Solid<'s>
    where
        'a: 's,
    {
        let whole = match self {
            Pieces::Of(pieces) if pieces.len() > 1 => Some(Whole { pieces, number: i, rotation }),
            _ => None,
        };
        Solid { turned, topology: self.topology(i), whole }
    }

    fn is_flat(&self) -> bool {
        matches!(self, Pieces::Flat(_))
    }

    fn turn(&self, i: usize, rotation: &Mat3, out: &mut Turned) {
        match self {
            Pieces::Of(pieces) => out.turn(&pieces[i], rotation),
            Pieces::Flat(q) => turn_flat(q, rotation, out),
        }
    }
}

fn turn_flat(q: &Quadrangle, rotation: &Mat3, out: &mut Turned) {
    let n = *rotation * q.normal;
    out.corners.clear();
    out.corners.extend(q.corners.iter().map(|&c| *rotation * c));
    out.normals.clear();
    out.normals.extend([n, -n]);
    out.offsets.clear();
    let offset = n.dot(out.corners[0]);
    out.offsets.extend([offset, -offset]);
    for i in 0..4 {
        let (p, q) = (out.corners[i], out.corners[(i + 1) % 4]);
        // Corners counter-clockwise seen from the normal's tip. A rim of no length has no outside: zero separates nothing.
        let outward = (q - p).cross(n).try_normalize().unwrap_or(Vec3::ZERO);
        out.normals.push(outward);
        out.offsets.push(outward.dot(p));
    }
    out.finish(&FLAT_BOX);
}

/// Reports the contacts of two bodies made of convex pieces: one for each pair of pieces that overlap, except that pairs
/// that overlap equally deep along one normal make one contact with a common area. So a cut through a body changes nothing
/// where it lands flat.
pub(crate) fn touch_pieces(a: (&Placed<'_>, Pieces<'_>), b: (&Placed<'_>, Pieces<'_>), out: &mut Touches) {
    let ((place_a, a), (place_b, b)) = (a, b);
    let offset = place_b.position - place_a.position;
    if !offset.is_finite() {
        return;
    }
    let first = out.list.len();
    let (count_a, count_b) = (a.count(), b.count());
    let mut turned_b = usize::MAX;
    for i in 0..count_a {
        let ball_a = a.ball(i);
        let center_a = *place_a.rotation * ball_a.center;
        let mut turned_a = false;
        for j in 0..count_b {
            let ball_b = b.ball(j);
            let size = ball_a.radius + ball_b.radius;
            let between = offset + *place_b.rotation * ball_b.center - center_a;
            let reach = size + FLAT * size;
            if between.length_squared() > reach * reach {
                continue;
            }
            if !turned_a {
                a.turn(i, place_a.rotation, &mut out.scratch.a);
                turned_a = true;
            }
            if turned_b != j {
                b.turn(j, place_b.rotation, &mut out.scratch.b);
                turned_b = j;
            }
            let PairScratch { a: ta, b: tb, axes, clip, .. } = &mut out.scratch;
            let mut pair = Pair {
                a: a.solid(i, ta, place_a.rotation),
                b: b.solid(j, tb, place_b.rotation),
                offset,
                size,
                coplanar: false,
            };
            pair.coplanar = a.is_flat() && b.is_flat() && in_one_plane(&pair);
            let Some(axis) = pair.least_overlap(axes, |axis| can_be_normal(&pair, axis, clip)) else { continue };
            let number = i * count_b + j;
            let feature = feature_number(&axis, &pair, number, count_a * count_b);
            let depth = max(-axis.gap, 0.0);
            contact_area(&pair, &axis, depth, clip);
            let point = place_a.position + perimeter_centroid(&clip.area);
            let first_point = out.points.len() as u32;
            out.points.extend(clip.area.iter().map(|&p| place_a.position + p));
            let point_count = clip.area.len() as u32;
            let normal = axis.normal / axis.normal.length();
            out.list.push(Touch { normal, point, depth, feature, first_point, point_count });
        }
    }
    if out.list.len() > first + 1 {
        let size = place_a.ball.radius + place_b.ball.radius;
        merge_equal(out, first, TIE * size);
    }
}

/// Whether an axis can be the normal: whether both bodies face each other along it where they touch. A side of one against
/// a cut through the other may overlap less than anything else, but nothing can come out that way. Where a face goes on
/// as a cut, it depends on the place.
fn can_be_normal(pair: &Pair<'_>, axis: &Axis, clip: &mut ClipScratch) -> bool {
    let (a, b) = (pair.a.whole, pair.b.whole);
    if a.is_none() && b.is_none() {
        return true;
    }
    // Corners of other faces divide an edge into several. They all lie along this axis, but they meet the other only once:
    // least overlap of convex pieces is always where the lines are closest.
    if let Feature::Edges(i, j) = axis.feature
        && !between_edges(pair, i as usize, j as usize).1
    {
        return false;
    }
    let depth = max(-axis.gap, 0.0);
    contact_area(pair, axis, depth, clip);
    let (middle, half) = (perimeter_centroid(&clip.area), axis.normal * (0.5 * depth));
    a.is_none_or(|w| w.faces(middle + half, axis.normal))
        && b.is_none_or(|w| w.faces(middle - half - pair.offset, -axis.normal))
}

/// Whether two quadrangles lie in one plane. They then meet at their rims: the common normal separates nothing, and no
/// side of the plane is the side of either.
fn in_one_plane(pair: &Pair<'_>) -> bool {
    let tolerance = FLAT * pair.size;
    let (a, b) = (pair.a.turned, pair.b.turned);
    let off = |t: &Turned, p: Vec3| (t.normals[0].dot(p) - t.offsets[0]).abs() > tolerance;
    !b.corners.iter().any(|&c| off(a, c + pair.offset)) && !a.corners.iter().any(|&c| off(b, c - pair.offset))
}

/// A number for what touches: the same while the same features touch, different for different pairs of pieces. Kinds of
/// feature, their numbers, and pairs of pieces in a mixed radix; folded to 32 bits, which loses nothing below 2^32.
fn feature_number(axis: &Axis, pair: &Pair<'_>, pieces: usize, piece_pairs: usize) -> u32 {
    let (kind, index) = match axis.feature {
        Feature::FaceA(i) => (0, i as u64),
        Feature::FaceB(i) => (1, i as u64),
        Feature::Edges(i, j) => (2, i as u64 * pair.b.topology.edges.len() as u64 + j as u64),
        Feature::Several(i) => (3, i as u64),
    };
    let number = (kind + 4 * index) * piece_pairs as u64 + pieces as u64;
    (number ^ (number >> 32)) as u32
}

/// Leaves the contact area in `clip.area`, relative to the first body's centre of mass, in the plane half-way between the
/// two surfaces.
fn contact_area(pair: &Pair<'_>, axis: &Axis, depth: Real, clip: &mut ClipScratch) {
    let n = axis.normal;
    let (a, b) = (pair.a, pair.b);
    let top_a = a.turned.high(n);
    let level = top_a - 0.5 * depth;
    let tolerance = FLAT * pair.size;
    match axis.feature {
        Feature::Edges(i, j) => {
            clip.area.clear();
            clip.area.push(between_edges(pair, i as usize, j as usize).0);
            return;
        }
        Feature::FaceA(f) if a.topology.faces[f as usize].corners.len() > 2 => {
            a.rim(f as usize, &mut clip.frame);
            if a.whole.is_some() {
                clip.round_frame(n, pair.size);
            }
            project_cap(&b, pair.offset, (n, top_a, level), tolerance, &mut clip.area);
            clip.round_area(n, pair.size);
            clip.clip_by_frame(n, pair.size);
        }
        Feature::FaceB(f) if b.topology.faces[f as usize].corners.len() > 2 => {
            b.rim(f as usize, &mut clip.frame);
            clip.frame.iter_mut().for_each(|c| *c += pair.offset);
            if b.whole.is_some() {
                clip.round_frame(-n, pair.size);
            }
            project_cap(&a, Vec3::ZERO, (-n, depth - top_a, -level), tolerance, &mut clip.area);
            clip.round_area(n, pair.size);
            clip.clip_by_frame(-n, pair.size);
        }
        _ => clip.area.clear(),
    }
    if clip.area.is_empty() {
        between_caps(pair, n, (top_a, depth, level), clip);
    }
    clip.clean_area(pair.size);
}

/// Where no single face carries the contact: what both pieces have in common of their caps over the other's plane. Empty
/// caps' meeting (a deep overlap of slanting pieces): the point between what reaches furthest on either side.
fn between_caps(pair: &Pair<'_>, n: Vec3, (top_a, depth, level): (Real, Real, Real), clip: &mut ClipScratch) {
    let tolerance = FLAT * pair.size;
    let (a, b) = (&pair.a, &pair.b);
    project_cap(a, Vec3::ZERO, (-n, depth - top_a, -level), tolerance, &mut clip.frame);
    clip.round_frame(n, pair.size);
    project_cap(b, pair.offset, (n, top_a, level), tolerance, &mut clip.area);
    clip.round_area(n, pair.size);
    if clip.area.len() > clip.frame.len() {
        // A line clipped by a polygon, not the other way round.
        std::mem::swap(&mut clip.area, &mut clip.frame);
    }
    clip.clip_by_frame(n, pair.size);
    if clip.area.is_empty() {
        project_cap(a, Vec3::ZERO, (-n, -top_a, -level), tolerance, &mut clip.frame);
        clip.round_frame(n, pair.size);
        project_cap(b, pair.offset, (n, top_a - depth, level), tolerance, &mut clip.area);
        clip.round_area(n, pair.size);
        let middle = 0.5 * (perimeter_centroid(&clip.frame) + perimeter_centroid(&clip.area));
        clip.area.clear();
        clip.area.push(middle);
    }
}

/// The middle of the closest points of two edges that are not parallel. With w = q - p, the points p + s u and q + t v are
/// closest where (p + s u - q - t v) is perpendicular to u and v: s = ((w.u)(v.v) - (w.v)(u.v)) / D, t = ((w.u)(u.v) -
/// (w.v)(u.u)) / D, D = (u.u)(v.v) - (u.v)^2. And whether these lie on the edges: otherwise only the lines come as close.
fn between_edges(pair: &Pair<'_>, i: usize, j: usize) -> (Vec3, bool) {
    let (a, b) = (pair.a, pair.b);
    let p = a.turned.corners[a.topology.edges[i].ends[0] as usize];
    let q = b.turned.corners[b.topology.edges[j].ends[0] as usize] + pair.offset;
    // Lengths of about one: their fourth powers must not underflow.
    let scale = 1.0 / pair.size;
    let (u, v, w) = (a.turned.edges[i] * scale, b.turned.edges[j] * scale, (q - p) * scale);
    let (uu, uv, vv, wu, wv) = (u.dot(u), u.dot(v), v.dot(v), w.dot(u), w.dot(v));
    // |u x v|^2, not (u.u)(v.v) - (u.v)^2: for nearly parallel edges the difference is rounding.
    let d = u.cross(v).length_squared();
    let (s, t) = ((wu * vv - wv * uv) / d, (wu * uv - wv * uu) / d);
    let (on_a, on_b) = (s.clamp(0.0, 1.0), t.clamp(0.0, 1.0));
    let past = max((s - on_a).abs(), (t - on_b).abs());
    (0.5 * ((p + a.turned.edges[i] * on_a) + (q + b.turned.edges[j] * on_b)), past <= TIE)
}

/// Makes one contact of those from `first` on whose normals agree and whose depths differ by no more than `tolerance`. The
/// common area is the convex hull of the areas: its point does not depend on how the bodies are cut into pieces.
fn merge_equal(out: &mut Touches, first: usize, tolerance: Real) {
    let Touches { list, points, scratch } = out;
    let same = |s: &Touch, t: &Touch| (s.normal - t.normal).max_abs() <= TIE && (s.depth - t.depth).abs() <= tolerance;
    if !(first..list.len()).any(|i| (first..i).any(|k| same(&list[k], &list[i]))) {
        return;
    }
    let start = list[first].first_point as usize;
    scratch.old_list.clear();
    scratch.old_list.extend(list.drain(first..));
    scratch.old_points.clear();
    scratch.old_points.extend(points.drain(start..));
    let points_of = |t: &Touch| t.first_point as usize - start..(t.first_point + t.point_count) as usize - start;
    for (i, t) in scratch.old_list.iter().enumerate() {
        if scratch.old_list[..i].iter().any(|s| same(s, t)) {
            continue;
        }
        let area = &mut scratch.clip.area;
        area.clear();
        let mut number = 0;
        for s in scratch.old_list[i..].iter().filter(|s| same(s, t)) {
            area.extend_from_slice(&scratch.old_points[points_of(s)]);
            number += 1;
        }
        let mut merged = Touch { first_point: points.len() as u32, ..*t };
        if number > 1 {
            order_round(area, t.normal, tolerance, &mut scratch.order);
            clean(area, tolerance);
            merged.point = perimeter_centroid(area);
            merged.point_count = area.len() as u32;
        }
        points.extend_from_slice(area);
        list.push(merged);
    }
}
