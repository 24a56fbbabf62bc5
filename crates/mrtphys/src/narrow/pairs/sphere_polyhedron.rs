//! Sphere against polyhedron, convex or not.

use super::sphere_sphere;
use crate::math::{Real, Vec3};
use crate::narrow::sat::{FLAT, TIE, holds};
use crate::narrow::{Placed, Touch, Touches};
use crate::shape::polyhedron::{ConvexPiece, Face};
use crate::shape::{Polyhedron, Sphere};

/// The point of a convex polygon that is nearest to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    /// the point \[m\]
    pub point: Vec3,
    /// square of the distance \[m2\]
    pub distance_squared: Real,
    /// The corners (by their place in the polygon) between which it lies; the same twice for a corner; `None` inside.
    pub on: Option<(usize, usize)>,
}

/// The point of a convex polygon (counter-clockwise seen from the tip of its unit normal) nearest to `c`. Seen along the
/// normal, `c` is inside all edges, or the nearest point lies on an edge of which `c` is on the outer side.
pub(super) fn nearest_on_polygon(
    count: usize,
    corner: impl Fn(usize) -> Vec3,
    (normal, height): (Vec3, Real),
    c: Vec3,
) -> Nearest {
    let mut nearest: Option<Nearest> = None;
    for i in 0..count {
        let j = if i + 1 == count { 0 } else { i + 1 };
        let (p, q) = (corner(i), corner(j));
        let along = q - p;
        let to = c - p;
        let is_outer = along.cross(normal).dot(to) > 0.0;
        if !is_outer {
            continue;
        }
        let (part, whole) = (along.dot(to), along.length_squared());
        let (point, on) = if part >= whole {
            (q, (j, j))
        } else if part > 0.0 {
            (p + along * (part / whole), (i, j))
        } else {
            (p, (i, i))
        };
        let distance_squared = (c - point).length_squared();
        if nearest.is_none_or(|n| distance_squared < n.distance_squared) {
            nearest = Some(Nearest { point, distance_squared, on: Some(on) });
        }
    }
    nearest.unwrap_or(Nearest { point: c - normal * height, distance_squared: height * height, on: None })
}

/// A place on the surface where the sphere touches, in the polyhedron's axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    piece: usize,
    point: Vec3,
    /// distance from the sphere's centre, not negative \[m\]
    distance: Real,
    /// unit vector out of the polyhedron
    outward: Vec3,
    feature: u32,
}

/// Where the sphere's centre is, as one convex piece sees it.
enum Seen {
    TooFar,
    Inside,
    Near(Place),
}

/// Reports the contacts of a sphere (first) with a polyhedron: the point of the surface nearest to the centre, and every
/// other place where the surface is nearer than all around it and reaches into the sphere (a sphere in a notch touches both
/// walls). With the centre inside, the one nearest point of the surface counts, and the sphere is pushed out there.
///
/// A body that is not a [`Sphere`] is taken as its bounding sphere.
pub fn touch(a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
    let Some(polyhedron) = b.shape.downcast::<Polyhedron>() else { return sphere_sphere::touch(a, b, out) };
    let (center, radius) = match a.shape.downcast::<Sphere>() {
        Some(s) => (a.position, s.radius()),
        None => (a.ball.center, a.ball.radius),
    };
    // An unbounded body has no sphere to be taken for.
    if !radius.is_finite() {
        return;
    }
    let c = b.rotation.transpose_mul(center - b.position);
    if !c.is_finite() || !radius.is_finite() {
        return;
    }
    let pieces = polyhedron.pieces.as_slice();
    let size = radius + polyhedron.ball.radius;
    let mut places = std::mem::take(&mut out.scratch.places);
    places.clear();
    let mut inside = false;
    for (i, piece) in pieces.iter().enumerate() {
        let reach = (radius + piece.ball.radius) * (1.0 + FLAT);
        if (c - piece.ball.center).length_squared() > reach * reach {
            continue;
        }
        match see(pieces, i, c, radius, size) {
            Seen::TooFar => {}
            Seen::Near(place) => places.push(place),
            Seen::Inside => {
                inside = true;
                break;
            }
        }
    }
    let mut report = |place: &Place, depth: Real| {
        let outward = *b.rotation * place.outward;
        push_sphere_contact(out, (center, radius), -(outward / outward.length()), depth, place.feature);
    };
    if inside {
        if let Some((place, depth)) = way_out(pieces, c, size) {
            report(&place, radius + depth);
        }
    } else {
        for (k, place) in places.iter().enumerate() {
            if is_nearest_around(pieces, &places, k, TIE * size) {
                report(place, radius - place.distance);
            }
        }
    }
    out.scratch.places = places;
}

/// What one convex piece sees of the sphere. Only faces that have the centre in front of them can hold the nearest point.
fn see(pieces: &[ConvexPiece], number: usize, c: Vec3, radius: Real, size: Real) -> Seen {
    let piece = &pieces[number];
    let mut best: Option<(Nearest, usize)> = None;
    let mut inside = true;
    for (f, face) in piece.faces.iter().enumerate() {
        let height = face.normal.dot(c) - face.offset;
        if height > radius {
            return Seen::TooFar;
        }
        if height <= 0.0 {
            continue;
        }
        inside = false;
        if best.is_some_and(|(n, _)| height * height >= n.distance_squared) {
            continue;
        }
        let nearest = nearest_on_face(piece, face, height, c);
        if nearest.on.is_none() {
            // The foot on a face of a convex body: nothing of the body is nearer.
            let feature = face_feature(pieces, number, f);
            return Seen::Near(Place {
                piece: number,
                point: nearest.point,
                distance: height,
                outward: face.normal,
                feature,
            });
        }
        if best.is_none_or(|(n, _)| nearest.distance_squared < n.distance_squared) {
            best = Some((nearest, f));
        }
    }
    let Some((nearest, f)) = best else { return if inside { Seen::Inside } else { Seen::TooFar } };
    if nearest.distance_squared > radius * radius {
        return Seen::TooFar;
    }
    let distance = nearest.distance_squared.sqrt();
    let away = c - nearest.point;
    // On the edge itself the direction to the centre is rounding; the middle of the faces there is not.
    let outward = if distance > FLAT * size { away.try_normalize() } else { middle_of_faces(piece, c, FLAT * size) };
    let feature = edge_feature(pieces, number, &piece.faces[f], nearest.on);
    Seen::Near(Place {
        piece: number,
        point: nearest.point,
        distance,
        outward: outward.unwrap_or(piece.faces[f].normal),
        feature,
    })
}

fn nearest_on_face(piece: &ConvexPiece, face: &Face, height: Real, c: Vec3) -> Nearest {
    let corner = |i: usize| piece.corners[face.corners[i] as usize];
    nearest_on_polygon(face.corners.len(), corner, (face.normal, height), c)
}

fn middle_of_faces(piece: &ConvexPiece, c: Vec3, tolerance: Real) -> Option<Vec3> {
    let near = |f: &&Face| !f.internal && (f.normal.dot(c) - f.offset).abs() <= tolerance;
    let mut sum = Vec3::ZERO;
    for (i, face) in piece.faces.iter().enumerate().filter(|(_, f)| near(f)) {
        // Several faces in one plane count once.
        if !piece.faces[..i].iter().any(|f| near(&f) && f.normal.dot(face.normal) >= 1.0 - TIE) {
            sum += face.normal;
        }
    }
    sum.try_normalize()
}

/// Whether no other piece comes nearer to the centre in the neighbourhood of a place, and no earlier place is the same. A
/// convex piece that holds the point and comes nearer elsewhere comes nearer all along the way there: then the point is not
/// a place where the surface of the whole body is nearest, but one on a cut through it.
fn is_nearest_around(pieces: &[ConvexPiece], places: &[Place], k: usize, tolerance: Real) -> bool {
    let place = &places[k];
    places.iter().enumerate().all(|(i, other)| {
        if i == k {
            return true;
        }
        if (other.point - place.point).max_abs() <= tolerance {
            return i > k;
        }
        let nearer = other.distance < place.distance || (other.distance == place.distance && i < k);
        !(nearer && holds(&pieces[other.piece], place.point, tolerance))
    })
}

/// The shortest way out for a centre inside: where and how deep. Ties within [`TIE`] (the centre half-way between two
/// faces) are answered by the middle of their normals, as for two polyhedra, unless they cancel.
fn way_out(pieces: &[ConvexPiece], c: Vec3, size: Real) -> Option<(Place, Real)> {
    let nearer =
        |best: Option<Place>, p: Place| if best.is_none_or(|b| p.distance < b.distance) { Some(p) } else { best };
    let mut place = exits(pieces, c, size).fold(None, nearer)?;
    let mut sum = Vec3::ZERO;
    let tied = |p: &Place| p.distance <= place.distance + TIE * size;
    for (k, p) in exits(pieces, c, size).enumerate().filter(|(_, p)| tied(p)) {
        // The faces of two pieces in one plane are one direction, not two.
        let same = |q: &Place| tied(q) && q.outward.dot(p.outward) >= 1.0 - TIE;
        if !exits(pieces, c, size).take(k).any(|q| same(&q)) {
            sum += p.outward;
        }
    }
    let mut depth = place.distance;
    if sum.length() > 1e-3
        && let Some(middle) = sum.try_normalize()
    {
        // Along the middle, the nearest face is further by the cosine.
        let cosine = middle.dot(place.outward);
        if cosine > 1e-3 && cosine < 1.0 - TIE {
            depth = place.distance / cosine;
            place.outward = middle;
        }
    }
    Some((place, depth))
}

/// For each face of the surface, its point nearest to a centre inside.
fn exits(pieces: &[ConvexPiece], c: Vec3, size: Real) -> impl Iterator<Item = Place> {
    let faces = |piece: &'_ ConvexPiece| piece.faces.len();
    let numbers = pieces.iter().enumerate().flat_map(move |(i, piece)| (0..faces(piece)).map(move |f| (i, f)));
    numbers.filter(|&(i, f)| !pieces[i].faces[f].internal).map(move |(i, f)| {
        let face = &pieces[i].faces[f];
        let height = face.normal.dot(c) - face.offset;
        let nearest = nearest_on_face(&pieces[i], face, height, c);
        let (distance, outward) = match nearest.on {
            None => (height.abs(), face.normal),
            Some(_) => {
                // A reflex edge may be nearest: then the way out leads straight to it.
                let distance = nearest.distance_squared.sqrt();
                let straight = if distance > FLAT * size { (nearest.point - c).try_normalize() } else { None };
                (distance, straight.unwrap_or(face.normal))
            }
        };
        Place { piece: i, point: nearest.point, distance, outward, feature: face_feature(pieces, i, f) }
    })
}

/// Number of a face: equal from step to step.
fn face_feature(pieces: &[ConvexPiece], piece: usize, face: usize) -> u32 {
    ((face * pieces.len() + piece) as u32).wrapping_mul(2)
}

/// Number of an edge or corner: by its corners, so that it does not matter from which of its faces it was found.
fn edge_feature(pieces: &[ConvexPiece], piece: usize, face: &Face, on: Option<(usize, usize)>) -> u32 {
    let (i, j) = on.unwrap_or((0, 0));
    let (i, j) = (face.corners[i], face.corners[j]);
    let number = i.min(j) as usize * pieces[piece].corners.len() + i.max(j) as usize;
    ((number * pieces.len() + piece) as u32).wrapping_mul(2).wrapping_add(1)
}

/// Reports a contact of a sphere, at the middle of the overlap on the line through its centre: it never turns the sphere.
pub(super) fn push_sphere_contact(out: &mut Touches, sphere: (Vec3, Real), normal: Vec3, depth: Real, feature: u32) {
    let (center, radius) = sphere;
    let point = center + normal * (radius - 0.5 * depth);
    let first_point = out.points.len() as u32;
    out.points.push(point);
    out.list.push(Touch { normal, point, depth, feature, first_point, point_count: 1 });
}
