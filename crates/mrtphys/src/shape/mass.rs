//! Mass properties of homogeneous bodies.

use super::wide::{Wide, difference, triple};
use crate::error::{Error, Result};
use crate::math::{Mat3, Quat, Real, Vec3, max, min};

/// Volume and inertia of a homogeneous shape whose centre of mass is the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// volume \[m3\]
    pub volume: Real,
    /// principal moments of inertia per mass \[m2\]
    pub moments_per_mass: Vec3,
    /// rotation from the principal axes into the shape's axes
    pub axes: Quat,
}

/// Entries or moments that differ by less than this part of the larger one are equal: the rounding of a body's corners
/// gives a rotated cube three moments that differ in the last digits, and axes that mean nothing.
const EQUAL: Real = 16.0 * Real::EPSILON;
/// Largest asymmetry of a tensor given by a user, relative to its largest entry.
const SYMMETRY: Real = 1e-9;
/// How far the largest moment may exceed the sum of the others, relative to it: a thin plate has equality, and its numbers
/// are rounded.
const TRIANGLE: Real = 1e-9;

impl MassProperties {
    /// From the volume and the inertia tensor per mass about the centre of mass, both of a real body.
    pub(crate) fn of_tensor(volume: Real, tensor: &Mat3) -> MassProperties {
        let (moments_per_mass, axes) = decompose(tensor);
        MassProperties { volume, moments_per_mass, axes }
    }
}

/// Integrals over the inside of a closed surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VolumeIntegrals {
    /// volume \[m3\]; negative: the surface is inside out
    pub volume: Real,
    /// centroid \[m\]; the mean of the corners where there is no volume
    pub centroid: Vec3,
    /// inertia tensor about the centroid, per mass \[m2\]
    pub inertia: Mat3,
}

/// Volume, centroid and inertia of what a closed, consistently oriented triangle mesh encloses.
///
/// Every triangle a, b, c spans a tetrahedron with a reference point o, the mean of the corners; with a, b, c taken from o
/// and d = a . (b x c), its volume is d/6, its first moment d/24 (a + b + c), and its second moments
/// integral x x^T = d/120 (s s^T + a a^T + b b^T + c c^T), s = a + b + c. (B. Mirtich's integrals give the same by surface
/// terms; J. Graphics Tools 1(2), 1996.) Terms of opposite sign cancel where a body is thin and lies askew, so all of it is
/// done in twice the precision. What remains is the rounding of the corners themselves.
pub(crate) fn integrate(corners: &[Vec3], triangles: &[[u32; 3]]) -> VolumeIntegrals {
    let mean = mean(corners);
    let scale = super::power_of_two(super::extent(corners));
    let shrink = Wide::from(1.0 / scale); // a power of two: exact
    let local: Vec<[Wide; 3]> = corners.iter().map(|&c| difference(c, mean).map(|w| w * shrink)).collect();
    let (mut v, mut first, mut second) = (Wide::ZERO, [Wide::ZERO; 3], [[Wide::ZERO; 3]; 3]);
    for t in triangles {
        let [a, b, c] = t.map(|i| local[i as usize]);
        let d = triple(a, b, c);
        v = v + d;
        let s: [Wide; 3] = std::array::from_fn(|i| a[i] + b[i] + c[i]);
        for i in 0..3 {
            first[i] = first[i] + d * s[i];
            for j in 0..=i {
                second[i][j] = second[i][j] + d * (s[i] * s[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
            }
        }
    }
    let volume = v.round() / 6.0 * scale * scale * scale;
    if v.round() == 0.0 {
        return VolumeIntegrals { volume: 0.0, centroid: mean, inertia: Mat3::ZERO };
    }
    // centroid = first/24 / (v/6); covariance = second/120 / (v/6) - centroid centroid^T
    let center: [Wide; 3] = std::array::from_fn(|i| first[i].divide(v) * Wide::from(0.25));
    let covariance = |i: usize, j: usize| {
        let (i, j) = (i.max(j), i.min(j));
        second[i][j].divide(v).divide(Wide::from(20.0)) - center[i] * center[j]
    };
    let moment = |i: usize, j: usize| (covariance(i, i) + covariance(j, j)).round() * scale * scale;
    let product = |i: usize, j: usize| -covariance(i, j).round() * scale * scale;
    let (xy, yz, zx) = (product(0, 1), product(1, 2), product(2, 0));
    VolumeIntegrals {
        volume,
        centroid: mean + Vec3::new(center[0].round(), center[1].round(), center[2].round()) * scale,
        inertia: Mat3::from_columns(
            Vec3::new(moment(1, 2), xy, zx),
            Vec3::new(xy, moment(2, 0), yz),
            Vec3::new(zx, yz, moment(0, 1)),
        ),
    }
}

/// The mean of some points, summed from the first one, so that a distant cluster keeps its digits.
pub(crate) fn mean(points: &[Vec3]) -> Vec3 {
    let Some(&origin) = points.first() else { return Vec3::ZERO };
    origin + points.iter().map(|&p| p - origin).sum::<Vec3>() / points.len() as Real
}

/// Principal moments and axes (rotation from principal into body axes) of an inertia tensor \[kg m2\] given by a user.
///
/// # Errors
/// [`Error::InvalidInertia`] for a tensor that is not finite, not symmetric (to 10^-9 of its largest entry), not positive
/// definite, or whose moments break the triangle inequality, i.e. one exceeds the sum of the two others (by more than
/// 10^-9): no distribution of mass has such a tensor.
pub fn principal(tensor: &Mat3) -> Result<(Vec3, Quat)> {
    let refuse = |reason| Err(Error::InvalidInertia { object: "inertia".into(), reason });
    if !tensor.is_finite() {
        return refuse("not finite");
    }
    let largest = tensor.c.iter().fold(0.0, |m, c| max(m, c.max_abs()));
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        if (tensor.at(i, j) - tensor.at(j, i)).abs() > SYMMETRY * largest {
            return refuse("not symmetric");
        }
    }
    if largest == 0.0 {
        return refuse("not positive definite");
    }
    let half = tensor.transpose();
    let symmetric = Mat3 { c: std::array::from_fn(|i| tensor.c[i] * 0.5 + half.c[i] * 0.5) };
    let (moments, axes) = decompose(&symmetric);
    let (a, b, c) = (moments.x, moments.y, moments.z);
    let smallest = min(min(a, b), c);
    // A tensor that is not diagonal has moments only to the rounding of its largest entry.
    let noise = if axes == Quat::IDENTITY { 0.0 } else { 4.0 * Real::EPSILON * largest };
    if smallest <= noise || !(1.0 / smallest).is_finite() {
        return refuse("not positive definite");
    }
    let most = max(max(a, b), c);
    // written without the sum of all three, which may overflow
    let others = if most == a {
        (b, c)
    } else if most == b {
        (a, c)
    } else {
        (a, b)
    };
    if most * (1.0 - TRIANGLE) - others.0 > others.1 {
        return refuse("one principal moment exceeds the sum of the others");
    }
    Ok((moments, axes))
}

/// Moments and axes of a symmetric tensor. A tensor that is diagonal but for rounding keeps its axes and their order;
/// moments that are equal but for rounding are made equal, and where all three are, the axes are the body's.
fn decompose(tensor: &Mat3) -> (Vec3, Quat) {
    let diagonal = Vec3::new(tensor.at(0, 0), tensor.at(1, 1), tensor.at(2, 2));
    let products = Vec3::new(tensor.at(0, 1), tensor.at(1, 2), tensor.at(2, 0));
    if products.max_abs() <= EQUAL * diagonal.max_abs() {
        return (equalize(diagonal), Quat::IDENTITY);
    }
    let scale = super::power_of_two(diagonal.max_abs());
    let mut a = [0, 1, 2].map(|i| [0, 1, 2].map(|j| tensor.at(i, j) / scale));
    let axes = jacobi(&mut a);
    let moments = equalize(Vec3::new(a[0][0], a[1][1], a[2][2]) * scale);
    let round = moments.x == moments.y && moments.y == moments.z;
    (moments, if round { Quat::IDENTITY } else { Quat::from_matrix(&axes) })
}

/// Moments that agree to a few units in the last place are equal.
fn equalize(m: Vec3) -> Vec3 {
    let close = |a: Real, b: Real| (a - b).abs() <= EQUAL * max(a.abs(), b.abs());
    let (low, high) = (min(min(m.x, m.y), m.z), max(max(m.x, m.y), m.z));
    if close(low, high) {
        return Vec3::splat(max(min(m.x, m.y), min(max(m.x, m.y), m.z))); // the middle one
    }
    if close(m.x, m.y) {
        Vec3::new(m.x, m.x, m.z)
    } else if close(m.y, m.z) {
        Vec3::new(m.x, m.y, m.y)
    } else if close(m.z, m.x) {
        Vec3::new(m.x, m.y, m.x)
    } else {
        m
    }
}

/// Cyclic Jacobi rotations (G. Golub, C. Van Loan, "Matrix Computations", 8.5): leaves the eigenvalues on the diagonal and
/// returns the eigenvectors as columns of a rotation. Stops where every product is negligible against its two moments, so
/// that small moments keep their digits (J. Demmel, K. Veselic, SIAM J. Matrix Anal. 13 (1992), 1204-1245).
fn jacobi(a: &mut [[Real; 3]; 3]) -> Mat3 {
    let mut v = Mat3::IDENTITY;
    for _ in 0..50 {
        let mut rotated = false;
        for (p, q) in [(0, 1), (1, 2), (0, 2)] {
            let apq = a[p][q];
            if apq == 0.0 || apq * apq <= 1e-36 * (a[p][p] * a[q][q]).abs() {
                continue;
            }
            rotated = true;
            let theta = (a[q][q] - a[p][p]) / (2.0 * apq);
            // tan of the smaller angle: t^2 + 2 t theta - 1 = 0
            let t = if theta.abs() > 1e150 {
                0.5 / theta
            } else {
                (1.0 / (theta.abs() + (theta * theta + 1.0).sqrt())) * if theta < 0.0 { -1.0 } else { 1.0 }
            };
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            a[p][p] -= t * apq;
            a[q][q] += t * apq;
            (a[p][q], a[q][p]) = (0.0, 0.0);
            let r = 3 - p - q;
            let (arp, arq) = (a[r][p], a[r][q]);
            (a[r][p], a[r][q]) = (c * arp - s * arq, s * arp + c * arq);
            (a[p][r], a[q][r]) = (a[r][p], a[r][q]);
            (v.c[p], v.c[q]) = (v.c[p] * c - v.c[q] * s, v.c[p] * s + v.c[q] * c);
        }
        if !rotated {
            break;
        }
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rotation() -> Quat {
        Quat::new(0.3, -0.5, 0.7, 0.4).try_normalize().unwrap()
    }

    #[test]
    fn turned_tensor_gives_its_moments_back() {
        for d in
            [Vec3::new(1.0, 2.0, 2.5), Vec3::new(3.0, 3.0, 1.0), Vec3::new(1e-9, 1.0, 1.0), Vec3::new(5e80, 7e80, 6e80)]
        {
            let r = rotation().to_matrix();
            let mut t = r.conjugate_diagonal(d);
            // rounding makes the product slightly asymmetric
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                t.c[i][j] = t.c[j][i];
            }
            let (m, q) = principal(&t).unwrap();
            let back = q.to_matrix().conjugate_diagonal(m);
            for i in 0..3 {
                assert!((back.c[i] - t.c[i]).max_abs() <= 4e-15 * d.max_abs(), "{d:?}");
            }
            let mut got = m.to_array();
            let mut want = d.to_array();
            got.sort_by(Real::total_cmp);
            want.sort_by(Real::total_cmp);
            for k in 0..3 {
                assert!((got[k] - want[k]).abs() <= 4e-15 * d.max_abs(), "{got:?} {want:?}");
            }
        }
    }

    #[test]
    fn diagonal_tensors_keep_their_axes() {
        let d = Vec3::new(3.0, 2.0, 2.5);
        assert_eq!(principal(&Mat3::diagonal(d)), Ok((d, Quat::IDENTITY)));
        let r = rotation().to_matrix();
        let (m, q) = principal(&r.conjugate_diagonal(Vec3::splat(0.7))).unwrap();
        assert_eq!((m.x, m.y, q), (m.y, m.z, Quat::IDENTITY));
    }

    #[test]
    fn impossible_tensors_are_refused() {
        let refused = |t: &Mat3, why: &str| match principal(t) {
            Err(Error::InvalidInertia { reason, .. }) => assert!(reason.contains(why), "{reason}"),
            other => panic!("{other:?}"),
        };
        refused(&Mat3::diagonal(Vec3::new(1.0, 1.0, 3.0)), "exceeds");
        refused(&Mat3::diagonal(Vec3::new(1.0, -1.0, 1.0)), "definite");
        refused(&Mat3::diagonal(Vec3::new(1.0, 0.0, 1.0)), "definite");
        refused(&Mat3::ZERO, "definite");
        refused(&Mat3::diagonal(Vec3::new(1.0, Real::NAN, 1.0)), "finite");
        let mut t = Mat3::IDENTITY;
        t.c[0].y = 0.1;
        refused(&t, "symmetric");
        t.c[1].x = 0.1;
        assert!(principal(&t).is_ok());
        (t.c[0].y, t.c[1].x) = (2.0, 2.0);
        refused(&t, "definite");
        // singular, not diagonal
        let r = rotation().to_matrix();
        refused(&r.conjugate_diagonal(Vec3::new(1.0, 1.0, 0.0)), "definite");
        // a plate: equality, to rounding
        assert!(principal(&r.conjugate_diagonal(Vec3::new(0.1, 0.2, 0.1 + 0.2))).is_ok());
    }
}
