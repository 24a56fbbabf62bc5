//! Boundaries as faces: finite ones as they are, endless ones as patches about the scene.

use crate::frame::Wall;
use crate::palette::Rgb;
use crate::scale::round_down;
use mrtphys::bounds::Aabb;
use mrtphys::shape::{HalfSpace, LimitPlane, LimitQuadrangle, Shape};
use mrtphys::{Real, Vec3};
use mrtphys_scene::Loaded;
use mrtphys_scene::scene::BoundaryKind;

/// An endless wall is drawn to this multiple of the radius of the scene; a floor farther than one that stands.
const STANDING: Real = 1.3;
const FLOOR: Real = 4.0;

/// The faces of a loaded scene. Endless ones are drawn about the bounds of what is finite, given by `bounds`.
pub fn walls_of(loaded: &Loaded, bounds: &Aabb, up: Vec3) -> Vec<Wall> {
    let colors = colors_of(loaded);
    let world = &loaded.world;
    let around = Aabb::of_points(finite_corners(loaded));
    let views = world.boundaries().filter_map(|id| world.boundary(id).ok()).enumerate();
    views
        .flat_map(|(i, b)| {
            let color = colors.get(i).copied().flatten();
            let walls = walls_of_one(&*b.shape, b.position, bounds, &around, up);
            walls.into_iter().map(move |w| Wall { color, ..w })
        })
        .collect()
}

/// The corners of all finite faces.
pub fn finite_corners(loaded: &Loaded) -> impl Iterator<Item = Vec3> {
    let world = &loaded.world;
    world.boundaries().filter_map(|id| world.boundary(id).ok()).flat_map(|b| {
        let face = b.shape.downcast::<LimitQuadrangle>();
        let corners = face.map(|f| f.corners().map(|c| c + b.position));
        corners.into_iter().flatten().collect::<Vec<_>>()
    })
}

/// The colors that a scene gives its boundaries, in the order of the world's.
fn colors_of(loaded: &Loaded) -> Vec<Option<Rgb>> {
    let faces = |kind: &BoundaryKind| if matches!(kind, BoundaryKind::Box { .. }) { 6 } else { 1 };
    let of = |b: &mrtphys_scene::scene::BoundaryDesc| std::iter::repeat_n(b.color.map(|c| c.rgb), faces(&b.kind));
    loaded.scene.boundaries.iter().flat_map(of).collect()
}

/// Nothing for a shape that only its author could draw. A membrane in a box, `around`, ends at it.
fn walls_of_one(shape: &dyn Shape, position: Vec3, bounds: &Aabb, around: &Aabb, up: Vec3) -> Vec<Wall> {
    if let Some(face) = shape.downcast::<LimitQuadrangle>() {
        let corners = face.corners().map(|c| c + position);
        let (normal, edges) = (face.normal(), [true; 4]);
        return vec![Wall { corners, normal, two_sided: false, endless: None, edges, color: None }];
    }
    if let Some(half_space) = shape.downcast::<HalfSpace>() {
        return vec![patch(position, half_space.normal(), false, bounds, up)];
    }
    let Some(plane) = shape.downcast::<LimitPlane>() else { return Vec::new() };
    let cut = section(position, plane.normal(), around);
    if cut.is_empty() { vec![patch(position, plane.normal(), true, bounds, up)] } else { cut }
}

/// Where a plane cuts a box: faces that together are the polygon of three to six corners; none where it passes the box.
fn section(point: Vec3, normal: Vec3, b: &Aabb) -> Vec<Wall> {
    let corner = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { b.min[axis] } else { b.max[axis] };
        Vec3::new(pick(0), pick(1), pick(2))
    };
    let height = |i: usize| (corner(i) - point).dot(normal);
    let mut corners: Vec<Vec3> = Vec::new();
    for (i, axis) in (0..8usize).flat_map(|i| [1usize, 2, 4].map(|axis| (i, axis))) {
        let (low, high) = (height(i), height(i | axis));
        // An edge that begins in the plane is cut there; one that ends in it, by the next.
        if i & axis == 0 && (low < 0.0) != (high < 0.0) {
            corners.push(corner(i) + (corner(i | axis) - corner(i)) * (low / (low - high)));
        }
    }
    let middle = corners.iter().fold(Vec3::ZERO, |sum, c| sum + *c) / corners.len().max(1) as Real;
    let Some(u) = normal.any_perpendicular().try_normalize() else { return Vec::new() };
    let v = normal.cross(u);
    let angle = |c: &Vec3| (*c - middle).dot(v).atan2((*c - middle).dot(u));
    corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    // A plane through corners cuts several edges in one point.
    let size = (b.max - b.min).max_abs();
    corners.dedup_by(|a, b| (*a - *b).max_abs() < 1e-9 * size);
    let n = corners.len();
    if n < 3 || !corners.iter().all(|c| c.is_finite()) {
        return Vec::new();
    }
    // Quadrangles of a fan about the first corner; only the polygon's own edges are drawn.
    let quad = |k: usize| Wall {
        corners: [corners[0], corners[k], corners[k + 1], corners[(k + 2).min(n - 1)]],
        normal,
        two_sided: true,
        endless: None,
        edges: [k == 1, true, k + 2 < n, k + 3 >= n],
        color: None,
    };
    (1..n - 1).step_by(2).map(quad).collect()
}

/// A square of an endless plane, below the middle of the scene.
fn patch(point: Vec3, normal: Vec3, two_sided: bool, bounds: &Aabb, up: Vec3) -> Wall {
    let middle = (bounds.min + bounds.max) * 0.5;
    let radius = 0.5 * (bounds.max - bounds.min).length();
    let foot = middle - normal * (middle - point).dot(normal);
    let half = radius * if normal.dot(up) > 0.7 { FLOOR } else { STANDING };
    // One edge of a standing wall is level: its grid stands upright.
    let level = normal.cross(up);
    let u = if level.length() > 1e-3 { level } else { normal.any_perpendicular() };
    let u = u.try_normalize().unwrap_or(Vec3::X) * half;
    let v = normal.cross(u);
    let corners = [foot - u - v, foot + u - v, foot + u + v, foot - u + v];
    let endless = Some(round_down(radius / 3.0));
    Wall { corners, normal, two_sided, endless, edges: [false; 4], color: None }
}

/// An endless face goes on as far as the bodies do that are within this many of its own half widths.
const FOLLOWS: Real = 6.0;
/// It grows by this factor at a time: seldom, rather than in every picture.
const GROWS: Real = 1.3;

/// A face as it is to be drawn when the bodies are in a box: an endless one goes on as far as they have come.
pub fn grown(wall: &Wall, bodies: &Aabb) -> Wall {
    let (half, middle) = ((wall.corners[1] - wall.corners[0]) * 0.5, (wall.corners[0] + wall.corners[2]) * 0.5);
    let size = half.length();
    if wall.endless.is_none() || !(size > 0.0) {
        return *wall;
    }
    let to = [bodies.min - middle, bodies.max - middle];
    // The distance in the plane of the farthest corner, as far as bodies are followed.
    let mut farthest: Real = 0.0;
    for i in 0..8usize {
        let d = Vec3::new(to[i & 1].x, to[i >> 1 & 1].y, to[i >> 2].z);
        let along = d - wall.normal * d.dot(wall.normal);
        farthest = farthest.max(along.length());
    }
    let needed = (1.5 * farthest / size).min(FOLLOWS);
    let mut factor: Real = 1.0;
    while factor < needed {
        factor *= GROWS;
    }
    Wall { corners: wall.corners.map(|c| middle + (c - middle) * factor), ..*wall }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_patch_lies_in_its_plane_below_the_scene() {
        let bounds = Aabb { min: Vec3::new(2.0, 1.0, 2.0), max: Vec3::new(4.0, 3.0, 4.0) };
        let normal = Vec3::new(1.0, 5.0, 2.0).try_normalize().unwrap();
        let w = patch(Vec3::splat(-1.0), normal, false, &bounds, Vec3::Y);
        assert!(w.corners.iter().all(|c| ((*c + Vec3::splat(1.0)).dot(normal)).abs() < 1e-12));
        let center = (w.corners[0] + w.corners[2]) * 0.5;
        assert!((Vec3::new(3.0, 2.0, 3.0) - center).cross(normal).length() < 1e-12);
        let around = (w.corners[1] - w.corners[0]).cross(w.corners[2] - w.corners[0]);
        assert!(around.dot(normal) > 0.0);
    }

    /// Area and corners of what walls cover together.
    fn area(walls: &[Wall]) -> Real {
        let triangle = |a: Vec3, b: Vec3, c: Vec3| 0.5 * (b - a).cross(c - a).length();
        walls
            .iter()
            .map(|w| (w.corners[0], w.corners[1], w.corners[2], w.corners[3]))
            .fold(0.0, |sum, (a, b, c, d)| sum + triangle(a, b, c) + triangle(a, c, d))
    }

    #[test]
    fn a_membrane_ends_at_the_box() {
        let b = Aabb { min: Vec3::new(-1.0, 0.0, 0.0), max: Vec3::new(1.0, 1.0, 1.0) };
        let unit = |x: Real, y: Real, z: Real| Vec3::new(x, y, z).try_normalize().unwrap();
        let cube = Aabb { min: Vec3::ZERO, max: Vec3::splat(1.0) };
        let half = Vec3::splat(0.5);
        // Hexagon across the middle of a cube: side sqrt(1/2).
        for (point, normal, b, right, edges) in [
            (Vec3::ZERO, Vec3::X, b, 1.0, 4),
            (half, unit(1.0, 1.0, 1.0), cube, 0.75 * 3f64.sqrt(), 6),
            (Vec3::new(0.1, 0.0, 0.0), unit(1.0, 1.0, 1.0), cube, 3f64.sqrt() / 2.0 * 0.01, 3),
            (half, unit(1.0, 1.0, 0.0), cube, 2f64.sqrt(), 4),
            (half, unit(3.0, 2.0, 1.0), cube, 14f64.sqrt() / 3.0, 4),
        ] {
            let walls = section(point, normal, &b);
            assert!((area(&walls) - right).abs() < 1e-9, "{normal:?}: {} for {right}", area(&walls));
            let drawn = |w: &Wall| (0..4).filter(|i| w.edges[*i] && w.corners[*i] != w.corners[(i + 1) % 4]).count();
            assert_eq!(walls.iter().map(drawn).sum::<usize>(), edges, "{normal:?}");
            for c in walls.iter().flat_map(|w| w.corners) {
                assert!((c - point).dot(normal).abs() < 1e-12);
                assert!((c - c.max(b.min).min(b.max)).length() < 1e-12, "{c:?} is outside");
            }
        }
        assert!(section(Vec3::X * 3.0, Vec3::X, &b).is_empty());
        assert!(section(Vec3::ZERO, Vec3::X, &Aabb::EMPTY).is_empty());
    }

    #[test]
    fn an_endless_floor_goes_on_as_far_as_the_bodies() {
        let bounds = Aabb { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };
        let floor = patch(Vec3::Y * -1.0, Vec3::Y, false, &bounds, Vec3::Y);
        let size = |w: &Wall| (w.corners[1] - w.corners[0]).length();
        assert_eq!(grown(&floor, &bounds), floor);
        let rolled = Aabb { min: bounds.min, max: Vec3::new(20.0, 1.0, 0.0) };
        let larger = grown(&floor, &rolled);
        assert!(size(&larger) > 2.0 * 20.0 && larger.endless == floor.endless, "{}", size(&larger));
        assert!(larger.corners.iter().all(|c| (c.y + 1.0).abs() < 1e-12));
        let lost = Aabb { min: bounds.min, max: Vec3::new(1e30, 1.0, 0.0) };
        assert!(size(&grown(&floor, &lost)) < 2.0 * FOLLOWS * size(&floor));
        assert_eq!(grown(&floor, &Aabb::EMPTY).endless, floor.endless);
    }
}
