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
    let views = world.boundaries().filter_map(|id| world.boundary(id).ok()).enumerate();
    views
        .filter_map(|(i, b)| {
            let color = colors.get(i).copied().flatten();
            let wall = wall_of(&*b.shape, b.position, bounds, up)?;
            Some(Wall { color, ..wall })
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

/// `None`: a shape that only its author could draw.
fn wall_of(shape: &dyn Shape, position: Vec3, bounds: &Aabb, up: Vec3) -> Option<Wall> {
    if let Some(face) = shape.downcast::<LimitQuadrangle>() {
        let corners = face.corners().map(|c| c + position);
        return Some(Wall { corners, normal: face.normal(), two_sided: false, endless: None, color: None });
    }
    let half_space = shape.downcast::<HalfSpace>().map(|s| (s.normal(), false));
    let (normal, two_sided) = half_space.or_else(|| shape.downcast::<LimitPlane>().map(|s| (s.normal(), true)))?;
    Some(patch(position, normal, two_sided, bounds, up))
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
    Wall { corners, normal, two_sided, endless: Some(round_down(radius / 3.0)), color: None }
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
}
