//! The numbers of bounding-sphere tests and of detected pairs (thesis, section 5.3.4) for scenes whose counts are known.

use mrtphys::bounds::{Aabb, Ball, BoundaryBounds};
use mrtphys::broad::{AdaptiveTree, BoundsView, BroadPhase, BruteForce, Candidates, RegularGrid};
use mrtphys::math::Vec3;
use serde_json::Value;

/// The six limits of the unit cube: flat faces, bounding sphere of the four corners.
fn unit_box() -> Vec<BoundaryBounds> {
    let mut limits = Vec::new();
    for axis in 0..3 {
        for side in [0.0, 1.0] {
            let (mut min, mut max, mut center) = (Vec3::ZERO, Vec3::splat(1.0), Vec3::splat(0.5));
            (min[axis], max[axis], center[axis]) = (side, side, side);
            let mut normal = Vec3::ZERO;
            normal[axis] = 1.0 - 2.0 * side;
            limits.push(BoundaryBounds {
                ball: Ball { center, radius: 0.5f64.sqrt() },
                face: Aabb { min, max },
                behind: Some((normal, -side)),
            });
        }
    }
    limits
}

struct Case {
    balls: Vec<Ball>,
    boxes: Vec<Aabb>,
    value: Value,
}

fn cases() -> Vec<Case> {
    let file: Value = serde_json::from_str(include_str!("vectors/counts.json")).unwrap();
    file["cases"].as_array().unwrap().iter().map(case).collect()
}

fn case(value: &Value) -> Case {
    let (n, radius) = (value["n"].as_u64().unwrap(), value["r"].as_f64().unwrap());
    let mut balls = Vec::new();
    let mut boxes = Vec::new();
    if let Some(centers) = value["centres"].as_array() {
        for c in centers {
            let center = Vec3::new(c[0].as_f64().unwrap(), c[1].as_f64().unwrap(), c[2].as_f64().unwrap());
            balls.push(Ball { center, radius });
            boxes.push(Aabb::of_ball(&Ball { center, radius }));
        }
    } else {
        let at = |i: u64| (i as f64 + 0.5) / n as f64;
        for i in 0..n {
            for j in 0..n {
                for k in 0..n {
                    let center = Vec3::new(at(i), at(j), at(k));
                    // Spheres and regular tetrahedra by turns; these are corners of a cube in the sphere.
                    let half = if (i + j + k) % 2 == 0 { radius } else { radius / 3f64.sqrt() };
                    balls.push(Ball { center, radius });
                    boxes.push(Aabb { min: center - Vec3::splat(half), max: center + Vec3::splat(half) });
                }
            }
        }
    }
    assert_eq!(balls.len() as u64, value["m"].as_u64().unwrap());
    Case { balls, boxes, value: value.clone() }
}

/// Tests and detected pairs.
fn count(phase: &mut dyn BroadPhase, case: &Case, scale: f64) -> [u64; 2] {
    let balls: Vec<Ball> =
        case.balls.iter().map(|b| Ball { center: b.center * scale, radius: b.radius * scale }).collect();
    let resized = |b: &Aabb| Aabb { min: b.min * scale, max: b.max * scale };
    let boxes: Vec<Aabb> = case.boxes.iter().map(resized).collect();
    let mut boundaries = unit_box();
    for b in &mut boundaries {
        b.ball = Ball { center: b.ball.center * scale, radius: b.ball.radius * scale };
        b.face = resized(&b.face);
        b.behind = b.behind.map(|(normal, offset)| (normal, offset * scale));
    }
    let view = BoundsView { balls: &balls, boxes: &boxes, fixed: &[], boundaries: &boundaries, epoch: 1 };
    let mut out = Candidates::default();
    phase.find(&view, &mut out);
    [out.sphere_tests, (out.pairs.len() + out.walls.len()) as u64]
}

fn expected(v: &Value, tests: &str, detect: &str) -> [u64; 2] {
    [v[tests].as_u64().unwrap(), v[detect].as_u64().unwrap()]
}

/// No scale, and scales that are powers of two: counts must not change.
const SCALES: [f64; 3] = [1.0, 1.0 / (1u64 << 40) as f64, (1u64 << 40) as f64];

#[test]
fn brute_force_compares_every_pair() {
    for case in cases() {
        let m = case.balls.len() as u64;
        for scale in SCALES {
            let found = count(&mut BruteForce, &case, scale);
            assert_eq!(found, expected(&case.value, "brute_tests", "brute_detect"), "{}", case.value["name"]);
            assert_eq!(found[0], (11 * m + m * m) / 2);
        }
    }
}

#[test]
fn the_regular_grid_compares_what_shares_a_cell() {
    for case in cases() {
        let resolution = case.value["grid_res"].as_u64().unwrap() as u32;
        for scale in SCALES {
            for chosen in [None, Some(resolution)] {
                let mut grid = RegularGrid::new(chosen);
                let found = count(&mut grid, &case, scale);
                assert_eq!(found, expected(&case.value, "grid_tests", "grid_detect"), "{}", case.value["name"]);
                assert_eq!(grid.resolution_for(case.balls.len()), resolution);
                // Once more, with the walls left where they are.
                assert_eq!(count(&mut grid, &case, scale), found);
            }
        }
    }
}

#[test]
fn the_adaptive_tree_compares_what_shares_a_branch() {
    for case in cases() {
        for (objects_per_cell, v) in case.value["adaptive"].as_object().unwrap() {
            for scale in SCALES {
                let mut tree = AdaptiveTree::new(objects_per_cell.parse().unwrap(), 16);
                let what = format!("{} with {objects_per_cell} per cell", case.value["name"]);
                for _ in 0..2 {
                    let found = count(&mut tree, &case, scale);
                    let shape = [tree.node_count() as u64, u64::from(tree.depth())];
                    assert_eq!(
                        (found, shape),
                        (expected(v, "tests", "detect"), expected(v, "nodes", "depth")),
                        "{what}"
                    );
                    assert_eq!(tree.cells().iter().map(|c| c.objects as usize).sum::<usize>(), case.balls.len() + 6);
                }
            }
        }
    }
}
