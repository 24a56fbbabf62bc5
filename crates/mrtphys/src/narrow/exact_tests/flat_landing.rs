//! Flat landings: no spin, whatever the bodies are cut into.

use super::bodies::*;
use crate::math::{Mat3, Real, Vec3};
use crate::narrow::pairs::{polyhedron_half_space, polyhedron_polyhedron, quadrangle_half_space};
use crate::narrow::{Placed, Touch};
use crate::shape::Polyhedron;

/// The spin that a push along the normal gives the body, as a lever arm.
fn lever(body: &Placed<'_>, t: &Touch) -> Real {
    (t.point - body.position).cross(t.normal).length()
}

#[test]
fn box_on_box_in_any_attitude() {
    let mut dice = Dice::new(11);
    let (a, b) = (cuboid(1.0, 0.5, 1.0), cuboid(0.4, 0.3, 0.7));
    for round in 0..300 {
        let r = if round == 0 { Mat3::IDENTITY } else { dice.rotation() };
        let base = dice.vector(1.0);
        let depth = if round % 3 == 0 { 1e-10 } else { dice.within(0.0, 0.1) };
        let pa = placed(&a, base, &r);
        // Wholly on top: the point is below the centre of the upper box.
        let aside = Vec3::new(dice.within(-0.5, 0.5), 0.8 - depth, dice.within(-0.2, 0.2));
        let pb = placed(&b, base + r * aside, &r);
        let t = contacts(polyhedron_polyhedron::touch, &pa, &pb);
        assert_eq!((t.list.len(), t.points.len()), (1, 4));
        assert!(close(t.list[0].normal, r * Vec3::Y, 1e-15) && (t.list[0].depth - depth).abs() < 1e-14);
        assert!(lever(&pb, &t.list[0]) < 4e-15, "{:e}", lever(&pb, &t.list[0]));
        // Overhanging: the point is in the middle of the common rectangle.
        let aside = Vec3::new(0.9, 0.8 - depth, -0.6);
        let pb = placed(&b, base + r * aside, &r);
        let t = contacts(polyhedron_polyhedron::touch, &pa, &pb);
        assert_eq!((t.list.len(), t.points.len()), (1, 4), "{depth} {:?}", t.points);
        let middle = Vec3::new(0.5 * (0.5 + 1.0), 0.5 - 0.5 * depth, 0.5 * (-1.0 + 0.1));
        assert!(close(t.list[0].point, base + r * middle, 1e-14), "{t:?}");
    }
}

#[test]
fn cube_on_equal_cube_turned_about_the_normal() {
    let a = cuboid(0.5, 0.5, 0.5);
    let i = Mat3::IDENTITY;
    for k in 0..64 {
        let turn = crate::math::Quat::from_axis_angle(Vec3::Y, k as Real * 0.1).to_matrix();
        let pb = placed(&a, Vec3::new(0.0, 0.99, 0.0), &turn);
        let t = contacts(polyhedron_polyhedron::touch, &placed(&a, Vec3::ZERO, &i), &pb);
        assert_eq!(t.list.len(), 1);
        assert_eq!(t.points.len(), if k == 0 { 4 } else { 8 });
        assert!(close(t.list[0].normal, Vec3::Y, 1e-15) && lever(&pb, &t.list[0]) < 1e-15);
    }
}

/// Tilted ever so little, the contact area goes over from a line to the whole face without a jump in the normal.
#[test]
fn small_tilts_move_the_point_smoothly() {
    let (a, b, i) = (cuboid(2.0, 0.5, 2.0), cuboid(0.5, 0.5, 0.5), Mat3::IDENTITY);
    let mut last = None;
    for k in 0..200 {
        let tilt = 1e-3 * k as Real / 200.0;
        let r = crate::math::Quat::from_axis_angle(Vec3::Z, tilt).to_matrix();
        let pb = placed(&b, Vec3::new(0.0, 1.0 - 1e-4, 0.0), &r);
        let t = contacts(polyhedron_polyhedron::touch, &placed(&a, Vec3::ZERO, &i), &pb).list[0];
        assert!(close(t.normal, Vec3::Y, 1e-2));
        let x = t.point.x;
        assert!(last.is_none_or(|l: Real| (x - l).abs() < 0.02), "{k}: {x} after {last:?}");
        last = Some(x);
    }
    assert!(last.unwrap() < -0.19, "at last it stands on its edge's side: {last:?}");
}

/// A U on its feet and upside down, cut in two ways: into three bars symmetrically, and into a column and an L's two bars.
fn u_shapes() -> Vec<Polyhedron> {
    let v = Vec3::new;
    let cut = |x: Real, y: Real, n: Vec3| [(v(x, y, 0.0), n), (v(x, y, 0.0), -n)];
    let symmetric = boxes(
        &[
            (v(-1.5, -1.0, -0.5), v(-0.5, 1.0, 0.5)),
            (v(-0.5, -1.0, -0.5), v(0.5, 0.0, 0.5)),
            (v(0.5, -1.0, -0.5), v(1.5, 1.0, 0.5)),
        ],
        &[cut(-0.5, 0.0, Vec3::X), cut(0.5, 0.0, Vec3::X)].concat(),
    );
    let lopsided = boxes(
        &[
            (v(-1.5, -1.0, -0.5), v(-0.5, 1.0, 0.5)),
            (v(-0.5, -1.0, -0.5), v(1.5, 0.0, 0.5)),
            (v(0.5, 0.0, -0.5), v(1.5, 1.0, 0.5)),
        ],
        &[cut(-0.5, 0.0, Vec3::X), cut(0.0, 0.0, Vec3::Y)].concat(),
    );
    vec![symmetric, lopsided]
}

#[test]
fn u_shape_on_plane_and_on_box() {
    let mut dice = Dice::new(12);
    let floor_box = cuboid(3.0, 0.5, 3.0);
    for (kind, u) in u_shapes().iter().enumerate() {
        for upside_down in [false, true] {
            let flip = if upside_down { Mat3::from_columns(-Vec3::X, -Vec3::Y, Vec3::Z) } else { Mat3::IDENTITY };
            for round in 0..50 {
                let r = if round == 0 { Mat3::IDENTITY } else { dice.rotation() };
                let n = (r * Vec3::Y).try_normalize().unwrap();
                let (floor, turned) = (wall(n), r * flip);
                let depth = 0.01;
                let pu = placed(u, n * (1.0 - depth), &turned);
                let t = contacts(polyhedron_half_space::touch, &pu, &placed(&floor, Vec3::ZERO, &Mat3::IDENTITY));
                assert_eq!(t.list.len(), 1);
                assert!((t.list[0].depth - depth).abs() < 1e-14 && close(t.list[0].normal, -n, 1e-15));
                assert!(lever(&pu, &t.list[0]) < 4e-15, "{kind} {upside_down}: {:e}", lever(&pu, &t.list[0]));
                let ground = placed(&floor_box, n * -0.5, &r);
                for t in [
                    contacts(polyhedron_polyhedron::touch, &pu, &ground),
                    contacts(polyhedron_polyhedron::touch, &ground, &pu),
                ] {
                    assert_eq!(t.list.len(), 1, "{kind} {upside_down}: {t:?}");
                    assert!((t.list[0].depth - depth).abs() < 1e-14);
                    assert!(lever(&pu, &t.list[0]) < 4e-15, "{kind} {upside_down}: {:?}", t.list);
                    assert_eq!(t.points.len(), 4, "{kind} {upside_down}: {t:?}");
                }
            }
        }
    }
}

/// A small box on a flat surface across a cut: the cut must not show.
#[test]
fn a_cut_below_the_contact_does_not_show() {
    let v = Vec3::new;
    let cuts = [(Vec3::ZERO, Vec3::X), (Vec3::ZERO, -Vec3::X)];
    let ground = boxes(&[(v(-2.0, -1.0, -2.0), v(0.0, 0.0, 2.0)), (v(0.0, -1.0, -2.0), v(2.0, 0.0, 2.0))], &cuts);
    let (b, i) = (cuboid(0.2, 0.2, 0.2), Mat3::IDENTITY);
    for k in -30..=30 {
        let pb = placed(&b, v(k as Real * 0.01, 0.2 - 0.003, 0.1), &i);
        let t = contacts(polyhedron_polyhedron::touch, &pb, &placed(&ground, Vec3::ZERO, &i));
        assert_eq!(t.list.len(), 1, "{k}: {:?}", t.list);
        assert!(close(t.list[0].normal, -Vec3::Y, 1e-15) && (t.list[0].depth - 0.003).abs() < 1e-15);
        assert!(lever(&pb, &t.list[0]) < 1e-15 && t.points.len() == 4, "{k}: {t:?}");
    }
}

#[test]
fn box_and_tetrahedron_on_a_wall() {
    let mut dice = Dice::new(13);
    let b = cuboid(0.4, 0.3, 0.7);
    let s = 0.5;
    let corners = [(s, s, s), (s, -s, -s), (-s, s, -s), (-s, -s, s)].map(|(x, y, z)| Vec3::new(x, y, z));
    let tetrahedron = hull(&corners);
    let down = (-(corners[1] + corners[2] + corners[3])).try_normalize().unwrap();
    for _ in 0..300 {
        let r = dice.rotation();
        let normal = (r * Vec3::X).try_normalize().unwrap();
        let floor = wall(normal);
        let on = dice.vector(2.0);
        let pb = placed(&b, on + normal * 0.39, &r);
        let t = contacts(polyhedron_half_space::touch, &pb, &placed(&floor, on, &Mat3::IDENTITY));
        assert_eq!((t.list.len(), t.points.len()), (1, 4));
        assert!(lever(&pb, &t.list[0]) < 4e-15 && (t.list[0].depth - 0.01).abs() < 1e-14);
        let normal = (r * down).try_normalize().unwrap();
        let floor = wall(normal);
        let height = -corners[1].dot(down) - 0.02;
        let pt = placed(&tetrahedron, on + normal * height, &r);
        let t = contacts(polyhedron_half_space::touch, &pt, &placed(&floor, on, &Mat3::IDENTITY));
        assert_eq!((t.list.len(), t.points.len()), (1, 3));
        assert!(lever(&pt, &t.list[0]) < 4e-15, "{:e}", lever(&pt, &t.list[0]));
    }
}

#[test]
fn against_a_wall_the_deepest_corners_count() {
    let mut dice = Dice::new(14);
    let i = Mat3::IDENTITY;
    for _ in 0..1000 {
        let a = any_body(&mut dice);
        let (r, n) = (dice.rotation(), dice.direction());
        let on = dice.vector(1.0);
        let at = on + n * dice.within(-0.3, 1.5);
        let floor = wall(n);
        let p = placed(&a, at, &r);
        let heights: Vec<Real> = a.corners.iter().map(|&c| n.dot(at + r * c - on)).collect();
        let lowest = heights.iter().copied().fold(Real::INFINITY, Real::min);
        let t = contacts(polyhedron_half_space::touch, &p, &placed(&floor, on, &i));
        if lowest.abs() < 1e-14 {
            continue;
        }
        assert_eq!(t.list.len(), (lowest < 0.0) as usize);
        let Some(touch) = t.list.first() else { continue };
        assert_eq!(touch.normal, -n);
        assert!((touch.depth + lowest).abs() < 1e-14);
        assert_eq!(t.points.len(), heights.iter().filter(|&&h| h < 1e-13).count());
        if n.dot(at - on) < 0.0 {
            assert_eq!(touch.point, at);
        } else {
            assert!((n.dot(touch.point - on) - lowest).abs() < 1e-13);
        }
    }
}

#[test]
fn quadrangle_on_a_wall() {
    let q = plate(1.0, 0.5);
    let i = Mat3::IDENTITY;
    let floor = wall(Vec3::Y);
    let ground = placed(&floor, Vec3::ZERO, &i);
    let flat = placed(&q, Vec3::new(3.0, 0.0, 1.0), &i);
    let t = contacts(quadrangle_half_space::touch, &flat, &ground);
    assert_eq!((t.list.len(), t.points.len(), t.list[0].depth), (1, 4, 0.0));
    assert_eq!(t.list[0].point, flat.position);
    let upright = Mat3::from_columns(Vec3::Y, -Vec3::X, Vec3::Z);
    let edge = placed(&q, Vec3::new(3.0, 0.75, 1.0), &upright);
    let t = contacts(quadrangle_half_space::touch, &edge, &ground);
    assert_eq!((t.list[0].depth, t.points.len()), (0.25, 2));
    assert_eq!(t.list[0].point, Vec3::new(3.0, -0.25, 1.0));
    assert!(
        contacts(quadrangle_half_space::touch, &placed(&q, Vec3::new(0.0, 1e-300, 0.0), &i), &ground).list.is_empty()
    );
}
