//! Which body is seen at a place of the picture.

use crate::camera::Ray;
use mrtphys::math::Quat;
use mrtphys::shape::{Polyhedron, Quadrangle, Shape, Sphere};
use mrtphys::{BodyId, Real, Vec3};

/// A body that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// the body
    pub body: BodyId,
    /// its number in the stage and its poses
    pub index: usize,
    /// the point of its surface \[m\]
    pub point: Vec3,
    /// distance of that point from the ray's origin \[m\]
    pub distance: Real,
}

/// Where a ray enters a ball: the distance; `None`: it passes, or begins inside or beyond.
pub fn enters_ball(ray: &Ray, center: Vec3, radius: Real) -> Option<Real> {
    let to = center - ray.origin;
    let along = to.dot(ray.direction);
    // The distance of the centre from the line as a vector: no difference of large squares.
    let off = to - ray.direction * along;
    let rest = radius * radius - off.length_squared();
    let distance = along - if rest >= 0.0 { rest.sqrt() } else { return None };
    (distance >= 0.0).then_some(distance)
}

/// Whether a ray comes within `reach` of a point before it has gone `most` far. Cheaper than exact, and never wrong where it
/// says no.
pub fn comes_near(ray: &Ray, center: Vec3, reach: Real, most: Real) -> bool {
    let to = center - ray.origin;
    let along = to.dot(ray.direction);
    let off = to - ray.direction * along;
    along + reach >= 0.0 && along - reach <= most && off.length_squared() <= reach * reach * (1.0 + 1e-9)
}

/// Where a ray enters the surface that a shape is drawn with: the distance. Shapes that are none of the library's are drawn as
/// a ball of this reach.
pub fn enters(ray: &Ray, shape: &dyn Shape, reach: Real, position: Vec3, orientation: Quat) -> Option<Real> {
    let own = || {
        let back = orientation.conjugate();
        Ray { origin: back.rotate(ray.origin - position), direction: back.rotate(ray.direction) }
    };
    if let Some(s) = shape.downcast::<Sphere>() {
        enters_ball(ray, position, s.radius())
    } else if let Some(p) = shape.downcast::<Polyhedron>() {
        let (own, corners) = (own(), p.corners());
        let corner = |i: u32| corners[i as usize];
        nearest(p.triangles().iter().filter_map(|t| crosses(&own, t.map(corner), false)))
    } else if let Some(q) = shape.downcast::<Quadrangle>() {
        let (own, &[a, b, c, d]) = (own(), q.corners());
        nearest([[a, b, c], [a, c, d]].iter().filter_map(|t| crosses(&own, *t, true)))
    } else {
        enters_ball(ray, position, reach)
    }
}

fn nearest(distances: impl Iterator<Item = Real>) -> Option<Real> {
    distances.min_by(Real::total_cmp)
}

/// Where a ray crosses a triangle from its front, counter-clockwise; or from either side. The volumes of the tetrahedra between
/// the ray and the sides decide, computed so that two triangles with a common side agree about it: a ray through a closed
/// surface never slips between its triangles (Segura and Feito, "Algorithms to test ray-triangle intersection", WSCG 2001).
fn crosses(ray: &Ray, [a, b, c]: [Vec3; 3], both_sides: bool) -> Option<Real> {
    let [a, b, c] = [a, b, c].map(|p| p - ray.origin);
    let [w, u, v] = [side(ray, a, b), side(ray, b, c), side(ray, c, a)];
    let front = u >= 0.0 && v >= 0.0 && w >= 0.0;
    let back = u <= 0.0 && v <= 0.0 && w <= 0.0;
    let sum = u + v + w;
    if !(front || both_sides && back) || sum == 0.0 {
        return None;
    }
    let distance = (a * u + b * v + c * w).dot(ray.direction) / sum;
    (distance >= 0.0).then_some(distance)
}

/// On which side of the line from p to q the ray passes: exactly opposite for the line from q to p.
fn side(ray: &Ray, p: Vec3, q: Vec3) -> Real {
    ray.direction.dot(q.cross(p))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    fn ray(origin: Vec3, direction: Vec3) -> Ray {
        Ray { origin, direction: direction.try_normalize().unwrap() }
    }

    #[test]
    fn a_ball_is_entered_at_its_surface() {
        let r = ray(Vec3::new(0.0, 0.6, 5.0), -Vec3::Z);
        assert!((enters_ball(&r, Vec3::ZERO, 1.0).unwrap() - 4.2).abs() < 1e-12);
        assert_eq!(enters_ball(&r, Vec3::ZERO, 0.5), None);
        assert_eq!(enters_ball(&r, Vec3::Z * 5.0, 1.0), None, "from inside nothing is seen");
        assert_eq!(enters_ball(&r, Vec3::Z * 9.0, 1.0), None, "behind");
        assert_eq!(enters_ball(&r, Vec3::splat(Real::NAN), 1.0), None);
        // A small ball far away: a difference of squares would lose it.
        let far = ray(Vec3::Z * 1e9, -Vec3::Z);
        assert!(enters_ball(&far, Vec3::new(0.9e-3, 0.0, 0.0), 1e-3).is_some());
        assert!(enters_ball(&far, Vec3::new(1.1e-3, 0.0, 0.0), 1e-3).is_none());
    }

    #[test]
    fn the_walls_of_a_turned_box_are_entered_where_they_are() {
        let cube: Arc<dyn Shape> = Arc::new(Polyhedron::cuboid(Vec3::new(2.0, 4.0, 6.0)).unwrap());
        let turned = Quat::from_axis_angle(Vec3::Z, std::f64::consts::FRAC_PI_2);
        let from = Vec3::new(10.0, 0.3, 0.2);
        let at = |q| enters(&ray(from, -Vec3::X), &*cube, 4.0, Vec3::X, q).unwrap();
        assert!((at(Quat::IDENTITY) - 8.0).abs() < 1e-12 && (at(turned) - 7.0).abs() < 1e-12);
        assert_eq!(enters(&ray(Vec3::X, Vec3::Y), &*cube, 4.0, Vec3::X, turned), None, "from inside");
        assert_eq!(enters(&ray(from, Vec3::X), &*cube, 4.0, Vec3::X, turned), None, "behind");
    }

    #[test]
    fn no_ray_slips_between_the_triangles_of_a_closed_surface() {
        let cube: Arc<dyn Shape> = Arc::new(Polyhedron::cuboid(Vec3::splat(2.0)).unwrap());
        // Rays at the diagonals and edges, where two triangles meet.
        for i in -10..=10i32 {
            let t = f64::from(i) / 10.0;
            for target in [Vec3::new(t, t, 1.0), Vec3::new(t, -t, 1.0), Vec3::new(t, 0.999_999_999, 1.0)] {
                let from = Vec3::new(0.31, 0.2, 7.0);
                assert!(
                    enters(&ray(from, target * 0.999_999 - from), &*cube, 1.8, Vec3::ZERO, Quat::IDENTITY).is_some()
                );
            }
        }
    }

    #[test]
    fn a_plate_is_met_from_both_sides() {
        let c = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|p| Vec3::new(p[0], p[1], 0.0));
        let plate: Arc<dyn Shape> = Arc::new(Quadrangle::new(c).unwrap());
        for z in [3.0, -3.0] {
            let hit = enters(&ray(Vec3::new(0.5, 0.2, z), Vec3::Z * -z), &*plate, 1.5, Vec3::ZERO, Quat::IDENTITY);
            assert!((hit.unwrap() - 3.0).abs() < 1e-12);
            let miss = enters(&ray(Vec3::new(1.1, 0.2, z), Vec3::Z * -z), &*plate, 1.5, Vec3::ZERO, Quat::IDENTITY);
            assert_eq!(miss, None);
        }
    }
}
