//! Surfaces as triangles, and their edges as lines.

use mrtphys::math::Quat;
use mrtphys::shape::{Polyhedron, Quadrangle};
use mrtphys::{Real, Vec3};
use std::collections::BTreeMap;

/// Finest triangulation of a sphere.
pub const FINEST: u8 = 6;
/// Half the angle that an edge of the icosahedron spans, seen from its centre \[radians\]: atan(2) / 2.
const HALF_EDGE: Real = 0.553_574_358_897_045_3;

/// A corner of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Vertex {
    /// where it is, in units of the shape's reach
    pub position: [f32; 3],
    /// outward unit normal
    pub normal: [f32; 3],
}

/// A surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// corners; those of plane faces are not shared with other faces
    pub vertices: Vec<Vertex>,
    /// vertex numbers, counter-clockwise seen from outside
    pub triangles: Vec<[u32; 3]>,
    /// lines of a wireframe drawing, each once
    pub edges: Vec<[[f32; 3]; 2]>,
}

fn single(v: Vec3) -> [f32; 3] {
    v.to_array().map(|x| x as f32)
}

/// Level of triangulation at which a sphere of this radius in the picture is round to `tolerance` (both in pixels): the
/// middle of an edge lies r (1 - cos(half the angle it spans)) inside the circle, and each level halves the angle.
pub fn level_for(radius: Real, tolerance: Real) -> u8 {
    let mut half_angle = HALF_EDGE;
    for level in 0..FINEST {
        if radius * (1.0 - half_angle.cos()) <= tolerance {
            return level;
        }
        half_angle *= 0.5;
    }
    FINEST
}

impl Mesh {
    /// A sphere of radius 1: an icosahedron whose triangles are cut into four `level` times (20 x 4^level triangles), the
    /// corners on the sphere and the normals those of the sphere. Levels beyond [`FINEST`] are not drawn any finer.
    pub fn sphere(level: u8) -> Mesh {
        let (mut points, mut triangles) = icosahedron();
        for _ in 0..level.min(FINEST) {
            triangles = cut_in_four(&mut points, &triangles);
        }
        let vertex = |p: &Vec3| Vertex { position: single(*p), normal: single(*p) };
        let edges = edges_of(&triangles).into_iter().map(|e| e.map(|i| single(points[i as usize]))).collect();
        Mesh { vertices: points.iter().map(vertex).collect(), triangles, edges }
    }

    /// A polyhedron, divided by `reach`.
    pub fn polyhedron(p: &Polyhedron, reach: Real) -> Mesh {
        let corner = |i: u32| p.corners()[i as usize] / reach;
        let mut mesh = Mesh::default();
        for t in p.triangles() {
            mesh.face(&t.map(corner));
        }
        mesh.edges = p.edges().iter().map(|e| e.ends.map(|i| single(corner(i)))).collect();
        mesh
    }

    /// A quadrangle, divided by `reach`: two faces back to back.
    pub fn quadrangle(q: &Quadrangle, reach: Real) -> Mesh {
        let mut c = q.corners().map(|c| c / reach);
        let edges = (0..4).map(|i| [single(c[i]), single(c[(i + 1) % 4])]).collect();
        let mut mesh = Mesh { edges, ..Mesh::default() };
        mesh.face(&c);
        c.reverse();
        mesh.face(&c);
        mesh
    }

    /// A plane convex face with corners of its own.
    fn face(&mut self, corners: &[Vec3]) {
        // Twice the vector area: right for any plane polygon, however its first corners lie.
        let area = (1..corners.len() - 1)
            .fold(Vec3::ZERO, |sum, i| sum + (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]));
        let normal = single(area.try_normalize().unwrap_or(Vec3::Y));
        let first = self.vertices.len() as u32;
        self.vertices.extend(corners.iter().map(|&c| Vertex { position: single(c), normal }));
        self.triangles.extend((1..corners.len() as u32 - 1).map(|i| [first, first + i, first + i + 1]));
    }
}

/// The twelve corners and twenty faces of an icosahedron on the unit sphere.
fn icosahedron() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    // Two poles and two rings of five, at heights +-1/sqrt 5.
    let (height, ring) = (0.2f64.sqrt(), 0.8f64.sqrt());
    let turn = |k: u32, offset: Real| (Real::from(k) + offset) * std::f64::consts::TAU / 5.0;
    let on_ring = |k: u32, offset: Real, y: Real| {
        let rotation = Quat::from_axis_angle(Vec3::Y, turn(k, offset));
        rotation.rotate(Vec3::X) * ring + Vec3::Y * y
    };
    let mut points = vec![Vec3::Y];
    points.extend((0..5).map(|k| on_ring(k, 0.0, height)));
    points.extend((0..5).map(|k| on_ring(k, 0.5, -height)));
    points.push(-Vec3::Y);
    let mut faces = Vec::with_capacity(20);
    for k in 0..5 {
        let (a, b) = (1 + k, 1 + (k + 1) % 5);
        let (c, d) = (a + 5, b + 5);
        faces.extend([[0, a, b], [a, c, b], [b, c, d], [11, d, c]]);
    }
    (points, faces)
}

/// Each triangle becomes four; new corners are put on the sphere.
fn cut_in_four(points: &mut Vec<Vec3>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            let m = points[a as usize] + points[b as usize];
            points.push(m.try_normalize().unwrap_or(Vec3::Y));
            points.len() as u32 - 1
        })
    };
    let mut out = Vec::with_capacity(4 * triangles.len());
    for &[a, b, c] in triangles {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        out.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    out
}

/// The edges of a closed surface, each once.
fn edges_of(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    sides.filter(|[a, b]| a < b).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vector(p: [f32; 3]) -> Vec3 {
        Vec3::new(p[0].into(), p[1].into(), p[2].into())
    }

    /// Volume by the divergence theorem: right, and positive, only for a closed surface whose triangles face outward.
    fn volume(mesh: &Mesh) -> Real {
        let at = |i: u32| vector(mesh.vertices[i as usize].position);
        mesh.triangles.iter().map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0).sum()
    }

    /// Every directed side of a triangle has its reverse in exactly one other triangle, by position.
    fn assert_closed(mesh: &Mesh) {
        let key = |i: u32| mesh.vertices[i as usize].position.map(|x| (x * 1e5).round() as i64);
        let mut sides: BTreeMap<_, i32> = BTreeMap::new();
        for &[a, b, c] in &mesh.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *sides.entry((key(from), key(to))).or_default() += 1;
            }
        }
        assert!(sides.iter().all(|((from, to), n)| *n == 1 && sides.get(&(*to, *from)) == Some(&1)));
    }

    fn assert_normals_face_outward(mesh: &Mesh) {
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| vector(mesh.vertices[i as usize].position));
            let across = (b - a).cross(c - a);
            for i in t {
                let n = vector(mesh.vertices[*i as usize].normal);
                assert!((n.length() - 1.0).abs() < 1e-6);
                assert!(n.dot(across) > 0.0);
            }
        }
    }

    #[test]
    fn spheres_are_closed_round_and_of_the_right_counts() {
        let mut before = 0.0;
        for level in 0..=4u8 {
            let mesh = Mesh::sphere(level);
            let n = 4usize.pow(level.into());
            assert_eq!((mesh.triangles.len(), mesh.edges.len(), mesh.vertices.len()), (20 * n, 30 * n, 10 * n + 2));
            assert_closed(&mesh);
            assert_normals_face_outward(&mesh);
            assert!(mesh.vertices.iter().all(|v| (vector(v.position).length() - 1.0).abs() < 1e-6));
            let v = volume(&mesh);
            assert!(v > before && v < 4.0 / 3.0 * std::f64::consts::PI);
            before = v;
        }
        assert!(before > 4.17, "{before}");
    }

    #[test]
    fn polyhedra_keep_their_volume_and_lose_no_face() {
        let u =
            [[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [1.0, 3.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 3.0], [-3.0, 3.0]];
        let points: Vec<Vec3> = [-1.0, 1.0].iter().flat_map(|&z| u.map(|p| Vec3::new(p[0], p[1], z))).collect();
        let mut faces = vec![(0..8).rev().collect::<Vec<u32>>(), (8..16).collect()];
        faces.extend((0..8u32).map(|i| vec![i, (i + 1) % 8, (i + 1) % 8 + 8, i + 8]));
        let u = Polyhedron::from_mesh(&points, &faces).unwrap();
        let cuboid = Polyhedron::cuboid(Vec3::new(1.0, 2.0, 3.0)).unwrap();
        for (p, edges, its_volume) in [(u, 24, 56.0), (cuboid, 12, 6.0)] {
            let mesh = Mesh::polyhedron(&p, 2.0);
            assert_closed(&mesh);
            assert_normals_face_outward(&mesh);
            assert_eq!(mesh.edges.len(), edges);
            assert!((volume(&mesh) * 8.0 - its_volume).abs() < 1e-5, "{}", volume(&mesh));
        }
    }

    #[test]
    fn a_quadrangle_has_two_sides() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]].map(|p| Vec3::new(p[0], 0.0, p[1]));
        let mesh = Mesh::quadrangle(&Quadrangle::new(corners).unwrap(), 1.0);
        assert_eq!((mesh.triangles.len(), mesh.edges.len()), (4, 4));
        assert_normals_face_outward(&mesh);
        let up = mesh.vertices.iter().filter(|v| v.normal[1] > 0.99).count();
        let down = mesh.vertices.iter().filter(|v| v.normal[1] < -0.99).count();
        assert_eq!((up, down), (4, 4));
    }

    #[test]
    fn larger_spheres_are_triangulated_finer() {
        let levels: Vec<u8> = [0.5, 3.0, 10.0, 50.0, 200.0, 800.0, 1e9].map(|r| level_for(r, 0.25)).to_vec();
        assert!(levels.is_sorted() && levels[0] == 0 && levels[6] == FINEST, "{levels:?}");
        // What the level promises, measured: the smallest distance of an edge's middle from the centre.
        for radius in [10.0, 50.0, 200.0] {
            let mesh = Mesh::sphere(level_for(radius, 0.25));
            let middle = |e: &[[f32; 3]; 2]| ((vector(e[0]) + vector(e[1])) * 0.5).length();
            let flattest = mesh.edges.iter().map(middle).fold(1.0, f64::min);
            // Triangles in the middle of a face are up to a fifth larger than the mean.
            assert!(radius * (1.0 - flattest) < 0.25 * 1.5, "{radius}: {flattest}");
        }
    }
}
