//! Elliptic functions and integrals for the free rotation: Jacobi's sn, cn, dn by descending Landen transformations,
//! the quarter period by the arithmetic-geometric mean, Carlson's symmetric integral of the third kind by duplication.
//! All arguments are pure numbers.

use crate::math::{Real, max, sin_cos};
use std::f64::consts::PI;

/// More Landen steps than any modulus needs: from k' = 1e-150 it takes 13.
const MOST_STEPS: usize = 24;

/// sn, cn and dn of `u` for the parameter m = k^2 = 1 - `m1`.
///
/// Both `m` and `m1` are given, because near 0 and near 1 only one of the two has all its digits.
/// Descending Landen (Gauss) transformation, Abramowitz & Stegun 16.12: with k1 = (1 - k')/(1 + k') and v = u/(1 + k1)
/// sn(u, k) = (1 + k1) sn(v, k1) / (1 + k1 sn^2(v, k1)), cn(u, k) = cn(v, k1) dn(v, k1) / (1 + k1 sn^2(v, k1)).
/// k1 < k^2, so a few steps lead to k = 0, where sn is the sine. dn is always taken from dn^2 = cn^2 + m1 sn^2, which
/// adds two positive numbers.
pub(super) fn jacobi(u: Real, m: Real, m1: Real) -> (Real, Real, Real) {
    if m1 == 0.0 {
        let sech = 1.0 / libm::cosh(u);
        return (libm::tanh(u), sech, sech);
    }
    let mut moduli = [(0.0, 0.0); MOST_STEPS];
    let (mut v, mut m, mut m1, mut steps) = (u, m, m1, 0);
    // sn(v, k) = sin v - k^2 (v - sin v cos v) cos v / 4 + ...: below half a unit of the last place the rest is the sine.
    // The bracket is at most 2/3 v^3 and at most v + 1, hence the two bounds.
    while steps < MOST_STEPS && m > 1e-17 && m * v * v > 1e-16 {
        let k1_prime = m1.sqrt();
        let k1 = m / ((1.0 + k1_prime) * (1.0 + k1_prime));
        moduli[steps] = (k1, m1);
        steps += 1;
        v /= 1.0 + k1;
        m = k1 * k1;
        m1 = 4.0 * k1_prime / ((1.0 + k1_prime) * (1.0 + k1_prime));
    }
    let (mut sn, mut cn) = sin_cos(v);
    let mut dn = (cn * cn + m1 * sn * sn).sqrt();
    for &(k1, m1) in moduli[..steps].iter().rev() {
        let inverse = 1.0 / (1.0 + k1 * sn * sn);
        cn = cn * dn * inverse;
        sn = (1.0 + k1) * sn * inverse;
        dn = (cn * cn + m1 * sn * sn).sqrt();
    }
    (sn, cn, dn)
}

/// Quarter period K for the complementary parameter `m1` = k'^2: pi / (2 agm(1, k')); infinite for 0.
pub(super) fn quarter_period(m1: Real) -> Real {
    if m1 == 0.0 {
        return Real::INFINITY;
    }
    let (mut a, mut b) = (1.0, m1.sqrt());
    for _ in 0..MOST_STEPS {
        if (a - b).abs() <= 1e-8 * a {
            break;
        }
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    // One more mean: the error squares with every step.
    PI / (a + b)
}

/// Carlson's R_J(x, y, z, p) for non-negative arguments, at most one of x, y, z zero, and p no smaller than any of them.
///
/// Duplication until the arguments are close, then the Taylor series about their mean up to seventh order: Carlson,
/// Numerical Algorithms 10 (1995) 13, algorithm for R_J; the terms of sixth and seventh order from DLMF 19.36.2.
pub(super) fn carlson_rj(x: Real, y: Real, z: Real, p: Real) -> Real {
    let mean = (x + y + z + 2.0 * p) / 5.0;
    let (dx, dy, dz) = (mean - x, mean - y, mean - z);
    let spread = max(max(dx.abs(), dy.abs()), max(dz.abs(), (mean - p).abs()));
    let product = (p - x) * (p - y) * (p - z);
    let (mut x, mut y, mut z, mut p, mut a) = (x, y, z, p, mean);
    let (mut scale, mut sum) = (1.0, 0.0);
    // The first neglected term is of eighth order: 0.01^8 = 1e-16. A spread beyond the range of doubles needs 512 steps.
    for _ in 0..600 {
        if spread * scale <= 0.01 * a {
            break;
        }
        let (rx, ry, rz, rp) = (x.sqrt(), y.sqrt(), z.sqrt(), p.sqrt());
        let lambda = rx * ry + rx * rz + ry * rz;
        let d = (rp + rx) * (rp + ry) * (rp + rz);
        sum += scale / d * arctan_over((scale * scale * scale) * product / d / d);
        x = 0.25 * (x + lambda);
        y = 0.25 * (y + lambda);
        z = 0.25 * (z + lambda);
        p = 0.25 * (p + lambda);
        a = 0.25 * (a + lambda);
        scale *= 0.25;
    }
    let k = scale / a;
    let (x, y, z) = (dx * k, dy * k, dz * k);
    scale * series(x, y, z) / (a * a.sqrt()) + 6.0 * sum
}

/// The Taylor series of R_J about equal arguments, for relative deviations x, y, z of the first three.
fn series(x: Real, y: Real, z: Real) -> Real {
    let p = -0.5 * (x + y + z);
    let (xyz, pp) = (x * y * z, p * p);
    let e2 = x * y + x * z + y * z - 3.0 * pp;
    let e3 = xyz + 2.0 * e2 * p + 4.0 * pp * p;
    let e4 = (2.0 * xyz + e2 * p + 3.0 * pp * p) * p;
    let e5 = xyz * pp;
    let low = 1.0 - 3.0 / 14.0 * e2 + e3 / 6.0 + 9.0 / 88.0 * e2 * e2 - 3.0 / 22.0 * e4;
    let middle = -9.0 / 52.0 * e2 * e3 + 3.0 / 26.0 * e5 - e2 * e2 * e2 / 16.0 + 3.0 / 40.0 * e3 * e3;
    low + middle + 3.0 / 20.0 * e2 * e4 + 45.0 / 272.0 * e2 * e2 * e3 - 9.0 / 68.0 * (e3 * e4 + e2 * e5)
}

/// R_C(1, 1 + e) = arctan(sqrt e) / sqrt e for e >= 0.
fn arctan_over(e: Real) -> Real {
    if e < 1e-4 {
        return 1.0 - e * (1.0 / 3.0 - e * (0.2 - e * (1.0 / 7.0 - e / 9.0)));
    }
    let r = e.sqrt();
    libm::atan(r) / r
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reference values: mpmath, 40 digits.
    #[test]
    fn jacobi_functions() {
        for (u, m, sn, cn, dn) in JACOBI {
            let (s, c, d) = jacobi(u, m, 1.0 - m);
            // The argument itself is rounded a few times.
            let bound = 2e-16 * (3.0 + u.abs());
            assert!((s - sn).abs() < bound, "sn({u}|{m}) = {s}, not {sn}");
            assert!((c - cn).abs() < bound, "cn({u}|{m}) = {c}, not {cn}");
            assert!((d - dn).abs() < bound, "dn({u}|{m}) = {d}, not {dn}");
        }
        let (s, c, d) = jacobi(3.0, 1.0, 0.0);
        assert!((s - libm::tanh(3.0)).abs() < 1e-16 && c == d && (c - 1.0 / libm::cosh(3.0)).abs() < 1e-17);
    }

    #[test]
    fn quarter_periods() {
        assert_eq!(quarter_period(0.0), Real::INFINITY);
        for (m1, k) in QUARTER {
            assert!((quarter_period(m1) / k - 1.0).abs() < 1e-15, "K(m1 = {m1}) = {}", quarter_period(m1));
        }
    }

    #[test]
    fn third_kind() {
        for (x, y, z, p, rj) in THIRD {
            assert!(
                (carlson_rj(x, y, z, p) / rj - 1.0).abs() < 1e-15,
                "R_J({x}, {y}, {z}, {p}) = {}",
                carlson_rj(x, y, z, p)
            );
        }
    }

    const JACOBI: [(Real, Real, Real, Real, Real); 10] = [
        (0.001, 0.3, 0.0009999997833333774, 0.9999995000000916, 0.9999998500000538),
        (0.1, 0.5, 0.09975068547462485, 0.9950124626090582, 0.9975093485144243),
        (0.7, 0.01, 0.6438213282028562, 0.7651758604079915, 0.9979253183347495),
        (1.2, 0.9, 0.8451782688050348, 0.5344845123478551, 0.597583738521851),
        (2.0, 0.5, 0.9946623253580177, -0.10318361552776183, 0.7108610477840873),
        (5.0, 0.99, 0.985572808289661, -0.16925200016552566, 0.19585652188382902),
        (-3.0, 0.999999, -0.9950549950479006, 0.09932550946369494, 0.09933049362942757),
        (0.3, 1e-09, 0.29552020665711726, 0.9553364891269122, 0.9999999999563339),
        (1.0, 0.0, 0.8414709848078965, 0.5403023058681398, 1.0),
        (9.0, 0.75, 0.3593873347239049, 0.9331884823764425, 0.9503318145416557),
    ];

    const QUARTER: [(Real, Real); 6] = [
        (1.0, PI / 2.0),
        (0.5, 1.8540746773013719),
        (0.1, 2.5780921133481733),
        (0.001, 4.841132560550297),
        (1e-10, 12.899219826387599),
        (1e-30, 35.92507075603058),
    ];

    const THIRD: [(Real, Real, Real, Real, Real); 7] = [
        (1.0, 1.0, 1.0, 1.0, 1.0),
        (0.999, 0.9995, 1.0, 1.0007, 1.0000302394980694),
        (0.5, 0.8, 1.0, 1.3, 1.0942905492922816),
        (0.0, 0.5, 1.0, 2.0, 1.7428419316550683),
        (0.01, 0.02, 1.0, 50.0, 0.1572865959454841),
        (1e-10, 2e-09, 1.0, 1000000.0, 3.359394302656848e-05),
        (0.0, 1e-12, 1.0, 1.5, 28.662770335450446),
    ];
}
