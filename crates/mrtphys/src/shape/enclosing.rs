//! Smallest enclosing spheres.
//!
//! Welzl's algorithm with move-to-front (E. Welzl, "Smallest enclosing disks (balls and ellipsoids)", LNCS 555 (1991),
//! 359-370), driven by Gärtner's pivot rule, the farthest point first (B. Gärtner, "Fast and robust smallest enclosing
//! balls", ESA 1999, LNCS 1643, 325-338): then the work is a few passes over the points, in a fixed order, without chance.

use crate::bounds::Ball;
use crate::math::{Real, Vec3, max};

/// A point farther outside than this part of the squared radius is not in the ball.
const OUTSIDE: Real = 1e-15;
/// Squared height of a new support point above the hull of the others, as part of the squared extent, below which it adds
/// nothing but noise.
const DEPENDENT: Real = 1e-26;
/// Passes over the points: each makes the ball grow; in practice there are about ten.
const MAX_PASSES: usize = 1000;

/// Smallest sphere that holds all the points: its centre is right to about 10^-14 of its radius (less where its support
/// is nearly degenerate), and its radius is the largest distance from that centre made larger by a few units in the last
/// place, so that `|p - center|^2 <= radius^2` holds for every point as computed.
///
/// No points: [`Ball::EMPTY`]. All points equal: radius 0. A point that is not finite: infinite radius.
pub fn smallest_enclosing_sphere(points: &[Vec3]) -> Ball {
    let Some(&origin) = points.first() else { return Ball::EMPTY };
    if !points.iter().all(|p| p.is_finite()) {
        return Ball { center: Vec3::ZERO, radius: Real::INFINITY };
    }
    let extent = super::extent(points);
    if extent == 0.0 {
        return Ball { center: origin, radius: 0.0 };
    }
    // Numbers near 1: no square over- or underflows, and scaling by 2^k scales the result exactly.
    let scale = super::power_of_two(extent);
    let local: Vec<Vec3> = points.iter().map(|&p| (p - origin) * (1.0 / scale)).collect();
    around(points, origin + grow(&local).center * scale)
}

/// Smallest sphere of a body whose centre of mass is the origin: a centre that is the origin but for rounding is the origin.
pub(crate) fn body_ball(points: &[Vec3]) -> Ball {
    let ball = smallest_enclosing_sphere(points);
    if ball.center.max_abs() <= 16.0 * Real::EPSILON * ball.radius { around(points, Vec3::ZERO) } else { ball }
}

/// The sphere about a given centre that certainly holds all the points: one part in 2^50 larger than computed, since the
/// distance of a point and the square of the radius are each rounded by some 2^-52.
pub(crate) fn around(points: &[Vec3], center: Vec3) -> Ball {
    let farthest = points.iter().fold(0.0, |r, &p| max(r, (p - center).length()));
    Ball { center, radius: farthest * (1.0 + 4.0 * Real::EPSILON) }
}

/// A ball that holds the chosen points so far; squared radius below zero: no point.
#[derive(Clone, Copy)]
struct Sphere {
    center: Vec3,
    squared: Real,
}

impl Sphere {
    fn outside(&self, p: Vec3) -> bool {
        (p - self.center).length_squared() - self.squared > OUTSIDE * self.squared
    }
}

/// Gärtner's pivoting: as long as a point lies outside, the farthest one joins the chosen points, in front.
fn grow(points: &[Vec3]) -> Sphere {
    let mut chosen = vec![points[0]];
    let mut ball = Sphere { center: points[0], squared: 0.0 };
    for _ in 0..MAX_PASSES {
        let (mut far, mut distance) = (points[0], -1.0);
        for &p in points {
            let d = (p - ball.center).length_squared();
            if d > distance {
                (far, distance) = (p, d);
            }
        }
        if !ball.outside(far) {
            break;
        }
        let n = chosen.len();
        let larger = welzl(&mut chosen, n, &mut Support::default().with(far));
        if larger.squared <= ball.squared {
            break; // nothing but rounding
        }
        ball = larger;
        chosen.insert(0, far);
    }
    ball
}

/// The smallest ball round the first `n` chosen points with the support on its surface. Depth of recursion: at most 4.
fn welzl(chosen: &mut [Vec3], n: usize, support: &mut Support) -> Sphere {
    let mut ball = support.sphere();
    if support.count == 4 {
        return ball;
    }
    for k in 0..n {
        let p = chosen[k];
        if !ball.outside(p) {
            continue;
        }
        let mut larger = support.clone().with(p);
        if larger.count > support.count {
            ball = welzl(chosen, k, &mut larger);
            chosen[..=k].rotate_right(1);
        }
    }
    ball
}

/// Up to four points on the surface, as q_i = p_i - p_0 = sum_k r_ik e_k with orthonormal e_k (Gram-Schmidt). The centre
/// c = p_0 + sum_k y_k e_k has equal distance from all of them where 2 q_i . (c - p_0) = q_i . q_i: a triangular system.
#[derive(Clone, Default)]
struct Support {
    count: usize,
    first: Vec3,
    basis: [Vec3; 3],
    y: [Real; 3],
}

impl Support {
    /// With one more point, unless it depends on the others.
    fn with(mut self, p: Vec3) -> Support {
        if self.count == 0 {
            self.first = p;
            self.count = 1;
            return self;
        }
        let k = self.count - 1;
        let q = p - self.first;
        let mut rest = q;
        // Twice: after one pass the rest is orthogonal only to the rounding of the whole.
        for _ in 0..2 {
            for e in &self.basis[..k] {
                rest = rest - *e * e.dot(rest);
            }
        }
        let height = rest.length_squared();
        if height <= DEPENDENT {
            return self;
        }
        let e = rest / height.sqrt();
        let known: Real = (0..k).map(|i| q.dot(self.basis[i]) * self.y[i]).sum();
        self.y[k] = (0.5 * q.length_squared() - known) / q.dot(e);
        self.basis[k] = e;
        self.count += 1;
        self
    }

    fn sphere(&self) -> Sphere {
        if self.count == 0 {
            return Sphere { center: Vec3::ZERO, squared: -1.0 };
        }
        let d = (0..self.count - 1).fold(Vec3::ZERO, |c, k| c + self.basis[k] * self.y[k]);
        Sphere { center: self.first + d, squared: d.length_squared() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn small_cases() {
        assert!(smallest_enclosing_sphere(&[]).is_empty());
        let p = Vec3::new(1.0, 2.0, 3.0);
        assert_eq!(smallest_enclosing_sphere(&[p, p]), Ball { center: p, radius: 0.0 });
        let b = smallest_enclosing_sphere(&[Vec3::ZERO, Vec3::X * 2.0, Vec3::X, Vec3::X * 0.5]);
        assert!((b.center - Vec3::X).length() < 1e-15 && (b.radius - 1.0).abs() < 1e-14);
        // an obtuse triangle: the two far ends alone
        let b = smallest_enclosing_sphere(&[Vec3::ZERO, Vec3::X * 2.0, Vec3::new(1.0, 0.1, 0.0)]);
        assert!((b.radius - 1.0).abs() < 1e-14);
        assert_eq!(smallest_enclosing_sphere(&[Vec3::new(Real::NAN, 0.0, 0.0)]).radius, Real::INFINITY);
    }

    /// The slow twin: the smallest of the spheres through two, three or four points that hold all.
    fn slow_radius(points: &[Vec3]) -> Real {
        let n = points.len();
        let mut best = Real::INFINITY;
        for subset in 1u32..1 << n {
            if !(2..=4).contains(&subset.count_ones()) {
                continue;
            }
            let mut s = Support::default();
            for (i, &p) in points.iter().enumerate() {
                if subset >> i & 1 == 1 {
                    s = s.with(p);
                }
            }
            let b = s.sphere();
            if points.iter().all(|&p| (p - b.center).length_squared() <= b.squared * (1.0 + 1e-12)) {
                best = crate::math::min(best, b.squared.sqrt());
            }
        }
        best
    }

    fn point() -> impl Strategy<Value = Vec3> {
        // a coarse lattice part of the time: ties, duplicates, cospherical and coplanar points
        prop_oneof![
            (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64).prop_map(|(x, y, z)| Vec3::new(x, y, z)),
            (-1..2i32, -1..2i32, -1..2i32).prop_map(|(x, y, z)| Vec3::new(x.into(), y.into(), z.into())),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::default() })]
        #[test]
        fn is_minimal_and_holds_all(points in prop::collection::vec(point(), 2..9), k in -40..40i32) {
            let b = smallest_enclosing_sphere(&points);
            for &p in &points {
                prop_assert!((p - b.center).length_squared() <= b.radius * b.radius);
            }
            if super::super::extent(&points) > 0.0 {
                let slow = slow_radius(&points);
                prop_assert!((b.radius - slow).abs() <= 1e-9 * slow, "{} {slow}", b.radius);
            }
            let s = libm::ldexp(1.0, k);
            let scaled: Vec<Vec3> = points.iter().map(|&p| p * s).collect();
            let c = smallest_enclosing_sphere(&scaled);
            prop_assert_eq!(c, Ball { center: b.center * s, radius: b.radius * s });
        }
    }
}
