//! Coulomb's friction with a normal impulse that friction does not change.

use super::{Encounter, ImpactLaw, Impulse};
use crate::math::{Real, Vec3};

/// `|jt| <= mu jn`, the tangential impulse opposing the sliding that is left after the impact.
///
/// The normal impulse is the frictionless one, `jn = (1 + e) a/B(N)`, not the one that Newton's hypothesis asks for when
/// friction feeds back into the normal direction: that one can gain energy at an eccentric body (Kane and Levinson 1985;
/// Stronge, Proc. R. Soc. A 431, 169, 1990). The tangential impulse then minimises the kinetic energy
///
/// `E(jt) = g.jt + jt.T.jt/2`, `|jt| <= mu jn`,
///
/// T the tangential block of K and g the sliding velocity that the normal impulse alone would leave. That is maximum
/// dissipation: inside the disc the point sticks (T jt = -g), on its rim it slides against jt, `(T + lambda) jt = -g` with
/// lambda >= 0. Since jt = 0 is allowed, E <= 0; and since E is convex, every shorter impulse s jt, 0 <= s <= 1, has E <= 0 too.
/// So friction never adds energy, and the impulse is shortened by the largest s with which the pair separates:
/// `-e a + s N.K.jt <= 0`. Where that leaves nothing (s = 0), the impulse is the frictionless one, marked as a fallback.
#[derive(Clone, Copy, Debug)]
pub struct Coulomb;

impl ImpactLaw for Coulomb {
    fn is_frictionless_at_zero(&self) -> bool {
        true
    }

    fn is_dry_friction(&self) -> bool {
        true
    }

    fn name(&self) -> &str {
        "coulomb"
    }

    fn impulse(&self, e: &Encounter) -> Option<Impulse> {
        let normal = e.frictionless_impulse()?;
        let plain = Impulse { on_a: normal, fallback: false };
        if e.friction == 0.0 {
            return Some(plain);
        }
        let jn = normal.length();
        let Some(jt) = tangential(e, normal, e.friction * jn) else {
            return Some(Impulse { fallback: true, ..plain });
        };
        let pull = e.response(jt).dot(e.normal);
        let room = e.restitution * e.approach();
        let s = if pull > room { room / pull } else { 1.0 };
        // Round-off only: a pull that is nothing but cancellation must not switch friction off at e = 0.
        let s = if s < 1.0 && pull - room <= e.round_off(jt) { 1.0 } else { s };
        let on_a = normal + jt * s;
        if !on_a.is_finite() {
            return Some(plain);
        }
        Some(Impulse { on_a, fallback: s == 0.0 })
    }
}

/// The tangential impulse of maximum dissipation inside the disc of radius `limit`.
fn tangential(e: &Encounter, normal_impulse: Vec3, limit: Real) -> Option<Vec3> {
    let after = e.relative_velocity() + e.response(normal_impulse);
    let sliding = after - e.normal * after.dot(e.normal);
    // Any frame of the tangential plane gives the same impulse; this one needs no second orthogonalisation.
    let x = e.normal.any_perpendicular();
    let y = e.normal.cross(x);
    let (kx, ky) = (e.response(x), e.response(y));
    let t = [kx.dot(x), 0.5 * (kx.dot(y) + ky.dot(x)), ky.dot(y)];
    let [px, py] = disc_minimum(t, [sliding.dot(x), sliding.dot(y)], limit)?;
    let j = x * px + y * py;
    j.is_finite().then_some(j)
}

/// Solves `(T + shift) p = -g`; `None` where T + shift is not positive definite to working precision.
fn solve([a, b, d]: [Real; 3], shift: Real, [gx, gy]: [Real; 2]) -> Option<[Real; 2]> {
    let a = a + shift;
    let l = b / a;
    let c = d + shift - l * b;
    if !(a > 0.0 && c > 0.0) {
        return None;
    }
    let y = -(gy - l * gx) / c;
    Some([-gx / a - l * y, y])
}

/// Minimises `g.p + p.T.p/2` over `|p| <= limit`; T = [xx, xy, yy], positive definite.
///
/// On the rim, `1/|p(lambda)|` is concave and nearly linear in lambda, so Newton's method on `1/|p| = 1/limit` climbs from
/// lambda = 0 monotonically to the root (More and Sorensen, SIAM J. Sci. Stat. Comput. 4, 553, 1983).
fn disc_minimum(t: [Real; 3], g: [Real; 2], limit: Real) -> Option<[Real; 2]> {
    if !(limit > 0.0) {
        return None;
    }
    let mut p = solve(t, 0.0, g)?;
    let mut length = (p[0] * p[0] + p[1] * p[1]).sqrt();
    if length <= limit {
        return Some(p);
    }
    let mut lambda: Real = 0.0;
    // Quadratic convergence: a dozen steps do from any start; the cap only ends a last-digit limit cycle.
    for _ in 0..64 {
        let q = solve(t, lambda, [-p[0], -p[1]])?;
        let curvature = p[0] * q[0] + p[1] * q[1];
        let next = lambda + length * length / curvature * ((length - limit) / limit);
        if !(next > lambda) || !next.is_finite() {
            break;
        }
        lambda = next;
        p = solve(t, lambda, g)?;
        length = (p[0] * p[0] + p[1] * p[1]).sqrt();
        if length <= limit {
            break;
        }
    }
    // Onto the rim, whatever the last digits of lambda.
    let k = limit / length;
    Some([p[0] * k, p[1] * k])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The disc's minimum against a fine scan of rim and inside.
    #[test]
    fn no_point_of_the_disc_has_less_energy() {
        let cases = [
            ([2.0, 0.3, 0.7], [1.0, -2.0], 0.5),
            ([1.0, 0.999, 1.0], [1.0, 1.0], 3.0),
            ([1e6, 0.0, 1.0], [3.0, 4.0], 0.1),
            ([1.0, 0.0, 1.0], [1e-9, 0.0], 1.0),
            ([5.0, -2.0, 1.0], [0.1, 7.0], 1e-6),
        ];
        for (t, g, limit) in cases {
            let energy = |p: [Real; 2]| {
                g[0] * p[0] + g[1] * p[1] + 0.5 * (t[0] * p[0] * p[0] + t[2] * p[1] * p[1]) + t[1] * p[0] * p[1]
            };
            let best = disc_minimum(t, g, limit).unwrap();
            assert!(best[0].hypot(best[1]) <= limit * (1.0 + 1e-15));
            let scale = energy(best).abs();
            assert!(energy(best) < 0.0);
            for i in 0..720 {
                for k in 1..=20 {
                    let (s, c) = crate::math::sin_cos(f64::from(i) * std::f64::consts::PI / 360.0);
                    let r = limit * f64::from(k) / 20.0;
                    assert!(energy([r * c, r * s]) >= energy(best) - 1e-14 * scale);
                }
            }
        }
    }
}
