//! Free rotation, in closed form. The state is the orientation and the angular momentum in world axes; the latter is
//! constant, so only the orientation is asked for, at any time after, however fast the body spins.
//!
//! Notation: n is the unit vector of the angular momentum in principal axes, I1, I2, I3 the principal moments. n moves
//! along the curve where the sphere |n| = 1 and the ellipsoid of energy sum n_i^2/I_i meet. That curve goes round the axis
//! of the smallest or the largest moment; this axis is called 3 here, the intermediate one 2.
//!
//! * I1 = I2 = I3: rotation about L at the rate L/I.
//! * I1 = I2: rotation about L at the rate L/I1, after one about the axis of symmetry at L n3 (1/I3 - 1/I1).
//! * otherwise Jacobi's solution (van Zon & Schofield, J. Comput. Phys. 225 (2007) 145; Landau & Lifshitz, Mechanics,
//!   section 37), taken relative to the present n by the addition theorems, so that no phase has to be found, and small
//!   steps keep all digits.

use super::elliptic::{carlson_rj, jacobi, quarter_period};
use crate::math::{Quat, ROUNDING, Real, Vec3};
use crate::model::Inertia;
use std::f64::consts::FRAC_PI_2;

/// Orientation after free rotation for a time `dt` \[s\] (of either sign) of a body with the orientation `q` and the angular
/// momentum `l` \[Js\] in world axes, which stays what it is.
///
/// The energy of rotation is conserved to round-off, as the new orientation is built from a point of the same curve of
/// energy. The cost does not grow with the spin: whole periods are taken at once. What is not finite gives an orientation
/// that is not finite.
pub fn rotate_free(q: Quat, l: Vec3, inertia: &Inertia, dt: Real) -> Quat {
    if l == Vec3::ZERO || dt == 0.0 || inertia.inverse == Vec3::ZERO {
        return q;
    }
    let inverse = inertia.inverse;
    if inertia.spherical {
        return (Quat::from_rotation_vector(l * (inverse.x * dt)) * q).renormalize();
    }
    let Some(direction) = l.try_normalize() else {
        return Quat::new(Real::NAN, Real::NAN, Real::NAN, Real::NAN);
    };
    let length_dt = l.dot(direction) * dt;
    let n = inertia.principal_rotation(q).transpose_mul(direction);
    let (about_l, in_body) = if inverse.x == inverse.y {
        symmetric(n.z, inverse.x, inverse.z, Vec3::Z, length_dt)
    } else if inverse.y == inverse.z {
        symmetric(n.x, inverse.y, inverse.x, Vec3::X, length_dt)
    } else if inverse.z == inverse.x {
        symmetric(n.y, inverse.z, inverse.y, Vec3::Y, length_dt)
    } else {
        asymmetric(n, inertia.moments, length_dt)
    };
    let in_body = if inertia.aligned {
        in_body
    } else {
        let v = inertia.axes.rotate(Vec3::new(in_body.x, in_body.y, in_body.z));
        Quat::new(v.x, v.y, v.z, in_body.w)
    };
    let turned = (Quat::from_axis_angle(direction, about_l) * q * in_body).renormalize();
    onto_energy(turned, l, inertia, inertia.energy(q, l))
}

/// The last bits of the orientation, chosen such that the energy, as [`Inertia::energy`] computes it, is `target`.
///
/// Without this round-off adds up wherever a step nearly repeats: at a bias of 1e-16 per step, 1e-10 in 1e6 steps. First a
/// micro-rotation: turning the body by d (body axes) turns n by -d x n and changes E = 1/2 n.Jn by -d.(n x Jn), so
/// d = (E - target) (n x Jn)/|n x Jn|^2. Below the spacing of doubles only trial is left: neighbours of the quaternion
/// until one has the energy to the last bit, or the best of them.
fn onto_energy(q: Quat, l: Vec3, inertia: &Inertia, target: Real) -> Quat {
    let error = inertia.energy(q, l) - target;
    if error == 0.0 || !error.is_finite() {
        return q;
    }
    let mut best = (error.abs(), q);
    let n = inertia.principal_rotation(q).transpose_mul(l);
    let across = n.cross(n.mul_elements(inertia.inverse));
    let d = across * (error / across.length_squared());
    // Near a permanent axis the energy is stationary, and no small rotation changes it.
    if d.max_abs() < LARGEST_CORRECTION {
        let d = if inertia.aligned { d } else { inertia.axes.rotate(d) } * 0.5;
        let candidate = q * Quat::new(d.x, d.y, d.z, 1.0);
        best = nearer(best, ((inertia.energy(candidate, l) - target).abs(), candidate));
    }
    for spacing in SPACINGS {
        for k in [spacing, -spacing] {
            if best.0 == 0.0 {
                return best.1;
            }
            // Four at a time, without a branch between them.
            let Quat { x, y, z, w } = best.1;
            let candidates = [
                Quat::new(x + k * x, y, z, w),
                Quat::new(x, y + k * y, z, w),
                Quat::new(x, y, z + k * z, w),
                Quat::new(x, y, z, w + k * w),
            ];
            let errors = candidates.map(|c| (inertia.energy(c, l) - target).abs());
            for i in 0..4 {
                best = nearer(best, (errors[i], candidates[i]));
            }
        }
    }
    best.1
}

/// The one with the smaller error, the first if they are equal.
fn nearer(a: (Real, Quat), b: (Real, Quat)) -> (Real, Quat) {
    if b.0 < a.0 { b } else { a }
}

/// Relative distances of the neighbours that are tried.
const SPACINGS: [Real; 8] = [
    2.0 * ROUNDING,
    4.0 * ROUNDING,
    6.0 * ROUNDING,
    8.0 * ROUNDING,
    10.0 * ROUNDING,
    12.0 * ROUNDING,
    14.0 * ROUNDING,
    16.0 * ROUNDING,
];
/// The closed form's own error stays below this angle \[rad\]; what asks for more is not round-off.
const LARGEST_CORRECTION: Real = 1e-12;

/// Symmetric top: angle about L, and rotation in the body. `n3`: component of n along the axis; `across`, `along`:
/// reciprocal moments; `axis`: the axis of symmetry.
fn symmetric(n3: Real, across: Real, along: Real, axis: Vec3, length_dt: Real) -> (Real, Quat) {
    (length_dt * across, Quat::from_axis_angle(axis, n3 * length_dt * (along - across)))
}

/// Principal axes in the order 1, 2, 3 of this module: which they are, and the sign of the first, chosen so that the three
/// are right-handed.
struct Frame {
    order: [usize; 3],
    sign: Real,
}

impl Frame {
    /// The frame with the intermediate axis `middle` and the curve round `round`.
    fn new(first: usize, middle: usize, round: usize) -> Frame {
        let sign = if (first + 1) % 3 == middle { 1.0 } else { -1.0 };
        Frame { order: [first, middle, round], sign }
    }

    fn take(&self, v: Vec3) -> [Real; 3] {
        [self.sign * v[self.order[0]], v[self.order[1]], v[self.order[2]]]
    }

    fn give(&self, v: [Real; 3]) -> Vec3 {
        let mut out = Vec3::ZERO;
        out[self.order[0]] = self.sign * v[0];
        out[self.order[1]] = v[1];
        out[self.order[2]] = v[2];
        out
    }
}

/// Numbers of the axes by ascending moment.
fn sorted(moments: Vec3) -> [usize; 3] {
    let mut order = [0, 1, 2];
    if moments[order[1]] < moments[order[0]] {
        order.swap(0, 1);
    }
    if moments[order[2]] < moments[order[1]] {
        order.swap(1, 2);
    }
    if moments[order[1]] < moments[order[0]] {
        order.swap(0, 1);
    }
    order
}

/// Asymmetric top: angle about L, and rotation in the body's principal axes.
fn asymmetric(n: Vec3, moments: Vec3, length_dt: Real) -> (Real, Quat) {
    let [small, middle, large] = sorted(moments);
    let (ia, ib, ic) = (moments[small], moments[middle], moments[large]);
    // h for a curve round the axis of the largest moment; round that of the smallest it is the reciprocal. The curve goes
    // round the former where L^2 > 2 E I2, which is n_c^2 > h n_a^2.
    let h = (ic / ia) * ((ib - ia) / (ic - ib));
    let (nc, na) = (n[large], n[small]);
    let (frame, h) = if nc * nc >= h * na * na {
        (Frame::new(small, middle, large), h)
    } else {
        (Frame::new(large, middle, small), 1.0 / h)
    };
    let n = frame.take(n);
    let inverse = [1.0 / moments[frame.order[0]], 1.0 / moments[frame.order[2]]];
    match Curve::new(n, h, inverse, length_dt) {
        Some(curve) => {
            let (angle, turned) = curve.advance(n, inverse[0] * length_dt, length_dt / ib);
            let b = between(n, turned);
            let v = frame.give([b.x, b.y, b.z]);
            (angle, Quat::new(v.x, v.y, v.z, b.w))
        }
        // Rotation about a principal axis, but for less than the square root of the smallest number: n stays.
        None => {
            let rate = n[0] * n[0] * inverse[0] + n[1] * n[1] / ib + n[2] * n[2] * inverse[1];
            (rate * length_dt, Quat::IDENTITY)
        }
    }
}

/// The curve of n = (A cn, A g sn, B dn) of argument u, parameter m:
/// h = I3 (I1 - I2) / (I1 (I2 - I3)) >= 0, g^2 = 1 + h, A^2 = n1^2 + n2^2/g^2, B^2 = n3^2 + n2^2 h/g^2, m = h A^2/B^2,
/// 1 - m = (n3^2 - h n1^2)/B^2, du/dt = L B (1/I1 - 1/I3)/g: from Euler's equations. Written like this, only 1 - m
/// subtracts, and that is inherent: the period is infinite where it vanishes.
struct Curve {
    h: Real,
    g: Real,
    /// A
    a: Real,
    /// B, with the sign of n3
    b: Real,
    m: Real,
    m1: Real,
    /// change of u
    du: Real,
}

/// Below this 1 - m is round-off of numbers that cancel, and the motion is that on the separatrix.
const SEPARATRIX: Real = 1e-60;
/// On the separatrix n is nearer than 1e-40 to the intermediate axis after this change of u, and stays there.
const SETTLED: Real = 100.0;
/// n nearer than this to axis 3 stays there: squares of anything smaller would lose digits.
const ON_AXIS: Real = 1e-140;

impl Curve {
    /// `None`: n is on an axis, or as good as.
    fn new(n: [Real; 3], h: Real, inverse: [Real; 2], length_dt: Real) -> Option<Curve> {
        let [n1, n2, n3] = n;
        let off_axis = n1.abs() > ON_AXIS || n2.abs() > ON_AXIS;
        let off_middle = n1.abs() > ON_AXIS || n3.abs() > ON_AXIS;
        if !(off_axis && off_middle) {
            return None;
        }
        let gg = 1.0 + h;
        let bb = n3 * n3 + n2 * n2 * (h / gg);
        let m1 = (n3 * n3 - h * (n1 * n1)) / bb;
        let m1 = if m1 < SEPARATRIX { 0.0 } else { m1 };
        let aa = n1 * n1 + n2 * n2 / gg;
        let m = if m1 == 0.0 { 1.0 } else { h * aa / bb };
        let (g, b) = (gg.sqrt(), if n3 < 0.0 { -bb.sqrt() } else { bb.sqrt() });
        Some(Curve { h, g, a: aa.sqrt(), b, m, m1, du: b * length_dt * (inverse[0] - inverse[1]) / g })
    }

    /// Angle of precession about L, and n, after `du`. `first`, `second`: L dt/I1 and L dt/I2.
    ///
    /// Axis 3 goes round L at the rate L (n1^2/I1 + n2^2/I2)/(n1^2 + n2^2) = L/I1 - L (1/I1 - 1/I3) h sn^2/(1 + h sn^2).
    /// With the change of u in place of time the angle is L dt/I1 - (g h/B) * integral of sn^2/(1 + h sn^2).
    fn advance(&self, n: [Real; 3], first: Real, second: Real) -> (Real, [Real; 3]) {
        let scale = self.g * self.h / self.b;
        let mut du = self.du;
        if self.m1 == 0.0 && du.abs() > SETTLED {
            let done = SETTLED / du.abs();
            let (third, turned) = self.third_kind(n, if du < 0.0 { -SETTLED } else { SETTLED });
            return (first * done - scale * third + second * (1.0 - done), turned);
        }
        let mut whole = 0.0;
        let mut flip = 1.0;
        // K >= pi/2: shorter than that there is nothing to reduce.
        if du.abs() > FRAC_PI_2 {
            let k = quarter_period(self.m1);
            let half_periods = libm::rint(du / (2.0 * k));
            if half_periods != 0.0 {
                du -= half_periods * (2.0 * k);
                // sn and cn change sign with every half period 2 K; dn does not.
                flip = if libm::fmod(half_periods, 2.0) == 0.0 { 1.0 } else { -1.0 };
                whole = half_periods * (2.0 / 3.0) * carlson_rj(0.0, self.m1, 1.0, 1.0 + self.h);
            }
        }
        let (part, [n1, n2, n3]) = self.third_kind(n, du);
        (first - scale * (whole + part), [flip * n1, flip * n2, n3])
    }

    /// Integral of sn^2/(1 + h sn^2) from the present u over `du`, at most a quarter period, and n after it.
    ///
    /// n by the addition theorems of sn, cn, dn (Abramowitz & Stegun 16.17), their common denominator
    /// 1 - m sn0^2 s^2 written as c^2 + s^2 dn0^2, which does not cancel. The integral from 0 over `du` is
    /// s^3/3 R_J(c^2, d^2, 1, 1 + h s^2) (DLMF 19.25.14); shifting its start to u adds
    /// arctan(sqrt(e) sn0 s sn1 / (1 + h sn1^2 - h sn0 s cn1 dn1)) / sqrt(e), e = h (1 + h) (h + m)
    /// (Byrd & Friedman 116.03 with alpha^2 = -h).
    fn third_kind(&self, n: [Real; 3], du: Real) -> (Real, [Real; 3]) {
        let Curve { h, g, a, b, m, m1, .. } = *self;
        let (s, c, d) = jacobi(du, m, m1);
        let [n1, n2, n3] = n;
        let dn0 = n3 / b;
        let inverse = 1.0 / (c * c + s * s * (dn0 * dn0));
        if !inverse.is_finite() {
            // On the separatrix's far end: n is on the intermediate axis.
            return (du / (1.0 + h), n);
        }
        let turned = [
            (n1 * c - n2 / g * (s * dn0 * d)) * inverse,
            (n2 * (c * d) + g * n1 * (s * dn0)) * inverse,
            (n3 * d - h * (n1 * n2) / (g * b) * (s * c)) * inverse,
        ];
        let hs = h * s;
        let from_zero = s * s * s / 3.0 * carlson_rj(c * c, d * d, 1.0, 1.0 + hs * s);
        let (sn0, sn1) = (n2 / (a * g), turned[1] / (a * g));
        let root = (h * (1.0 + h) * (h + m)).sqrt();
        let below = 1.0 + h * (sn1 * sn1) - hs * sn0 * (turned[0] / a) * (turned[2] / b);
        let shift = libm::atan2(root * sn0 * s * sn1, below) / root;
        (from_zero + shift, turned)
    }
}

/// The rotation in the body that belongs to n going from `n0` to `n1` while axis 3 keeps its azimuth about L:
/// T(n0) T(n1)^-1, where T(n) = Rz(longitude) Ry(colatitude) takes axis 3 to n.
///
/// = Rz(a0) Ry(t0 - t1) Rz(-a1), as a quaternion built of half-angles: those of the colatitudes from
/// tan(x/2) = sin x/(1 + cos x), those of the longitudes from the sum or the difference of their unit vectors, whichever is
/// longer.
fn between(n0: [Real; 3], n1: [Real; 3]) -> Quat {
    let (r0, r1) = ((n0[0] * n0[0] + n0[1] * n0[1]).sqrt(), (n1[0] * n1[0] + n1[1] * n1[1]).sqrt());
    let (x0, y0, x1, y1) = (n0[0] / r0, n0[1] / r0, n1[0] / r1, n1[1] / r1);
    let (tilt_cos, tilt_sin) = (1.0 + n0[2] * n1[2] + r0 * r1, r0 * n1[2] - n0[2] * r1);
    let cross = y0 * x1 - x0 * y1;
    // (sx, sy): along the half-sum of the longitudes; (half_cos, half_sin): of half their difference, times |(sx, sy)|.
    let (sx, sy, half_cos, half_sin) = if x0 * x1 + y0 * y1 >= 0.0 {
        let (sx, sy) = (x0 + x1, y0 + y1);
        (sx, sy, 0.5 * (sx * sx + sy * sy), cross)
    } else {
        let (sx, sy) = (y0 - y1, x1 - x0);
        (sx, sy, cross, 0.5 * (sx * sx + sy * sy))
    };
    let q = Quat::new(-tilt_sin * sy, tilt_sin * sx, tilt_cos * half_sin, tilt_cos * half_cos);
    let k = 1.0 / q.dot(q).sqrt();
    Quat::new(q.x * k, q.y * k, q.z * k, q.w * k)
}
