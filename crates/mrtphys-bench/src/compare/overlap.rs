//! Which bodies lie in one another, and how deep: found from positions alone, in the same way for every engine.

use crate::peers::State;
use crate::peers::scene::{NeutralShape, SceneData, Triple, norm};

/// Overlaps that count are deeper than this part of the smaller bounding radius. Bodies that have just been separated touch to
/// within rounding, in single precision in most engines.
pub const DEPTH_THAT_COUNTS: f64 = 1e-3;

/// What was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Overlaps {
    /// pairs that overlap
    pub pairs: usize,
    /// greatest depth, in bounding radii of the smaller of the two
    pub worst: f64,
}

/// Finds all overlapping pairs of bodies.
pub fn overlaps(scene: &SceneData, state: &State) -> Overlaps {
    let solids: Vec<Solid> = scene.shapes.iter().map(Solid::new).collect();
    let largest = solids.iter().map(|s| s.radius).fold(0.0, f64::max);
    let mut found = Overlaps::default();
    let mut seen = |i: usize, j: usize| {
        let (a, b) = (&solids[scene.bodies[i].shape as usize], &solids[scene.bodies[j].shape as usize]);
        let between = minus(state.position[j], state.position[i]);
        let mut depth = a.radius + b.radius - norm(between);
        let smaller = a.radius.min(b.radius);
        if depth <= DEPTH_THAT_COUNTS * smaller {
            return;
        }
        if !(a.corners.is_empty() && b.corners.is_empty()) {
            depth = separating_depth(&a.placed(state.orientation[i]), &b.placed(state.orientation[j]), between);
        }
        if depth > DEPTH_THAT_COUNTS * smaller {
            found.pairs += 1;
            found.worst = found.worst.max(depth / smaller);
        }
    };
    near_pairs(&state.position, 2.0 * largest, &mut seen);
    found
}

/// Calls for every pair of points in the same or in adjacent cells of this size.
fn near_pairs(points: &[Triple], cell: f64, seen: &mut dyn FnMut(usize, usize)) {
    let key = |p: Triple| p.map(|x| (x / cell).floor() as i64);
    let mut cells: Vec<([i64; 3], usize)> = points.iter().enumerate().map(|(i, &p)| (key(p), i)).collect();
    cells.sort_unstable();
    let start = |key: [i64; 3]| cells.partition_point(|c| c.0 < key);
    for &([x, y, z], i) in &cells {
        for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
            let row = &cells[start([x + dx, y + dy, z - 1])..];
            for &(at, j) in row.iter().take_while(|c| c.0 <= [x + dx, y + dy, z + 1]) {
                debug_assert!((at[2] - z).abs() <= 1);
                if j > i {
                    seen(i, j);
                }
            }
        }
    }
}

/// A convex body: a ball, or corners with the directions of its faces and edges.
#[derive(Clone, Debug)]
struct Solid {
    radius: f64,
    corners: Vec<Triple>,
    faces: Vec<Triple>,
    edges: Vec<Triple>,
}

impl Solid {
    fn new(shape: &NeutralShape) -> Solid {
        let corners = match shape {
            NeutralShape::Sphere { .. } => Vec::new(),
            NeutralShape::Box { half } => (0..8)
                .map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { -half[axis] } else { half[axis] }))
                .collect(),
            NeutralShape::Hull { points } => points.clone(),
        };
        let (faces, edges) = directions(&corners);
        Solid { radius: shape.radius(), corners, faces, edges }
    }

    fn placed(&self, orientation: [f64; 4]) -> Solid {
        let turned = |v: &Vec<Triple>| v.iter().map(|&p| turn(orientation, p)).collect();
        Solid {
            radius: self.radius,
            corners: turned(&self.corners),
            faces: turned(&self.faces),
            edges: turned(&self.edges),
        }
    }

    /// Lowest and highest place along a unit vector.
    fn span(&self, axis: Triple) -> (f64, f64) {
        if self.corners.is_empty() {
            return (-self.radius, self.radius);
        }
        let along = self.corners.iter().map(|&p| dot(p, axis));
        along.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)))
    }
}

/// Normals of the faces and directions of the edges of the hull of points, found slowly and simply: three points make a face
/// if all others lie on one side of it, and each of its sides counts as an edge: the diagonals of a box's faces among them are
/// axes too many, and no axis makes two bodies overlap that do not, or less than they do.
fn directions(points: &[Triple]) -> (Vec<Triple>, Vec<Triple>) {
    let size = points.iter().map(|&p| norm(p)).fold(0.0, f64::max);
    let (mut faces, mut edges) = (Vec::new(), Vec::new());
    for (i, &a) in points.iter().enumerate() {
        for (j, &b) in points.iter().enumerate().skip(i + 1) {
            for &c in &points[j + 1..] {
                let normal = cross(minus(b, a), minus(c, a));
                let Some(normal) = unit(normal, size * size * 1e-9) else { continue };
                let side = |&p: &Triple| dot(normal, minus(p, a));
                let (low, high) =
                    points.iter().map(side).fold((0.0, 0.0), |(l, h): (f64, f64), x| (l.min(x), h.max(x)));
                if high > 1e-9 * size && low < -1e-9 * size {
                    continue;
                }
                faces.push(normal);
                for (p, q) in [(a, b), (b, c), (a, c)] {
                    edges.extend(unit(minus(q, p), size * 1e-9));
                }
            }
        }
    }
    (distinct(faces), distinct(edges))
}

fn distinct(directions: Vec<Triple>) -> Vec<Triple> {
    let mut kept: Vec<Triple> = Vec::new();
    for d in directions {
        if kept.iter().all(|&k| dot(k, d).abs() < 1.0 - 1e-12) {
            kept.push(d);
        }
    }
    kept
}

/// Least depth over the axes of the separating-axis theorem: normals of faces, products of edges, and for a ball the direction
/// to the nearest corner; negative if the two are apart. `between` leads from the centre of a to that of b.
fn separating_depth(a: &Solid, b: &Solid, between: Triple) -> f64 {
    let mut least = f64::MAX;
    let mut consider = |axis: Triple| {
        let ((a_low, a_high), (b_low, b_high)) = (a.span(axis), b.span(axis));
        let shift = dot(between, axis);
        least = least.min((a_high - b_low - shift).min(b_high + shift - a_low));
    };
    a.faces.iter().chain(&b.faces).for_each(|&n| consider(n));
    for &e in &a.edges {
        for &f in &b.edges {
            if let Some(axis) = unit(cross(e, f), 1e-6) {
                consider(axis);
            }
        }
    }
    if a.corners.is_empty() || b.corners.is_empty() {
        let corners = a.corners.iter().map(|&p| minus(between, p)).chain(b.corners.iter().map(|&p| plus(between, p)));
        corners.filter_map(|d| unit(d, f64::MIN_POSITIVE)).for_each(consider);
    }
    least
}

fn plus(a: Triple, b: Triple) -> Triple {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn minus(a: Triple, b: Triple) -> Triple {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Triple, b: Triple) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Triple, b: Triple) -> Triple {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: Triple, least: f64) -> Option<Triple> {
    let length = norm(v);
    (length > least).then(|| v.map(|x| x / length))
}

/// Turns a vector by a unit quaternion: v + 2 u x (u x v + w v).
pub fn turn([x, y, z, w]: [f64; 4], v: Triple) -> Triple {
    let u = [x, y, z];
    let inner = plus(cross(u, v), v.map(|c| w * c));
    plus(v, cross(u, inner).map(|c| 2.0 * c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::peers::scene::NeutralBody;

    fn tetrahedron(radius: f64) -> NeutralShape {
        let s = radius / 3f64.sqrt();
        let points = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        NeutralShape::Hull { points: points.map(|p| p.map(|x: f64| x * s)).to_vec() }
    }

    fn two(shape: NeutralShape, apart: Triple, orientation: [f64; 4]) -> Overlaps {
        let body = NeutralBody {
            shape: 0,
            fixed: false,
            position: [0.0; 3],
            orientation: [0.0, 0.0, 0.0, 1.0],
            velocity: [0.0; 3],
            spin: [0.0; 3],
        };
        let scene = SceneData {
            dt: 1.0,
            unit: 1.0,
            restitution: 1.0,
            friction: 0.0,
            gravity: [0.0; 3],
            container: None,
            shapes: vec![shape],
            bodies: vec![body.clone(), body],
        };
        let mut state = State::default();
        state.push([0.3, -0.2, 0.1], [0.0, 0.0, 0.0, 1.0], [0.0; 3], [0.0; 3]);
        state.push(plus([0.3, -0.2, 0.1], apart), orientation, [0.0; 3], [0.0; 3]);
        overlaps(&scene, &state)
    }

    const UPRIGHT: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

    #[test]
    fn spheres_overlap_by_the_missing_distance() {
        let sphere = NeutralShape::Sphere { radius: 0.5 };
        assert_eq!(two(sphere.clone(), [1.01, 0.0, 0.0], UPRIGHT), Overlaps::default());
        assert_eq!(two(sphere.clone(), [0.9999, 0.0, 0.0], UPRIGHT).pairs, 0);
        let found = two(sphere, [0.0, -0.9, 0.0], UPRIGHT);
        assert_eq!(found.pairs, 1);
        assert!((found.worst - 0.2).abs() < 1e-12);
    }

    #[test]
    fn boxes_overlap_by_the_least_depth_of_all_axes() {
        let cube = NeutralShape::Box { half: [0.5; 3] };
        assert_eq!(two(cube.clone(), [0.0, 1.01, 0.0], UPRIGHT).pairs, 0);
        let found = two(cube.clone(), [0.3, 0.9, -0.4], UPRIGHT);
        assert!((found.worst * 0.75f64.sqrt() - 0.1).abs() < 1e-12);
        // Turned by 45 degrees, the cube reaches 1/sqrt 2 along x: edge against face.
        let eighth = std::f64::consts::FRAC_PI_8;
        let turned = [0.0, 0.0, eighth.sin(), eighth.cos()];
        assert_eq!(two(cube.clone(), [1.21, 0.0, 0.0], turned).pairs, 0);
        let found = two(cube, [1.2, 0.0, 0.0], turned);
        assert!((found.worst * 0.75f64.sqrt() - (0.5 + 0.5f64.sqrt() - 1.2)).abs() < 1e-12);
    }

    #[test]
    fn tetrahedra_reach_as_far_as_their_corners() {
        let third = 1.0 / 3f64.sqrt();
        let towards = |d: f64| [d * third, d * third, d * third];
        // The corner of one, at 1, against the face of the other, at 1/3.
        assert_eq!(two(tetrahedron(1.0), towards(1.34), UPRIGHT).pairs, 0);
        let found = two(tetrahedron(1.0), towards(1.32), UPRIGHT);
        assert!((found.worst - (4.0 / 3.0 - 1.32)).abs() < 1e-12);
        // A quarter turn about y brings corner against corner.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let found = two(tetrahedron(1.0), towards(1.9), [0.0, half, 0.0, half]);
        assert!(found.pairs == 1 && found.worst < 0.1, "{found:?}");
        // Edge across edge: both reach 1/sqrt 3 along z, and both spheres reach further.
        assert_eq!(two(tetrahedron(1.0), [0.0, 0.0, 2.01 * third], UPRIGHT).pairs, 0);
        let found = two(tetrahedron(1.0), [0.0, 0.0, 1.97 * third], UPRIGHT);
        assert!((found.worst - 0.03 * third).abs() < 1e-12);
    }

    #[test]
    fn a_ball_at_a_corner_is_measured_to_the_corner() {
        let solid = Solid::new(&NeutralShape::Box { half: [1.0; 3] });
        let ball = Solid::new(&NeutralShape::Sphere { radius: 0.5 });
        let at = |d: f64| [1.0 + d / 3f64.sqrt(); 3];
        assert!((separating_depth(&solid, &ball, at(0.6)) + 0.1).abs() < 1e-12);
        assert!((separating_depth(&solid, &ball, at(0.4)) - 0.1).abs() < 1e-12);
        assert!((separating_depth(&ball, &solid, at(0.4).map(|x| -x)) - 0.1).abs() < 1e-12);
    }

    #[test]
    fn every_near_pair_is_seen_once() {
        let points: Vec<Triple> = (0..200).map(|i| [0, 1, 2].map(|k| f64::from(i * (7 + 6 * k) % 31) / 31.0)).collect();
        let mut pairs = Vec::new();
        near_pairs(&points, 0.11, &mut |i, j| pairs.push((i, j)));
        let count = pairs.len();
        pairs.sort_unstable();
        pairs.dedup();
        assert_eq!(pairs.len(), count);
        for i in 0..points.len() {
            for j in i + 1..points.len() {
                if norm(minus(points[i], points[j])) < 0.11 {
                    assert!(pairs.contains(&(i, j)));
                }
            }
        }
    }
}
