//! The tree that is adapted from step to step against the tree that is built anew.

use super::node::{NONE, Node, Span};
use super::*;
use crate::bounds::{Aabb, Ball, BoundaryBounds};
use crate::math::Vec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// A node by its content: cell, depth, axis mark, whether it has children, objects.
type Content = (Vec<u64>, u32, String, bool, Vec<u32>);

fn content(tree: &AdaptiveTree) -> Vec<Content> {
    let node = |(n, depth): (u32, u32)| {
        let node = &tree.arena.nodes[n as usize];
        let mut objects: Vec<u32> = tree.arena.listed(n).collect();
        assert_eq!(objects.len(), node.num as usize);
        objects.sort_unstable();
        let cell = node.cell.low.iter().chain(&node.cell.high).chain(&node.size).map(|x| x.to_bits()).collect();
        (cell, depth, format!("{:?}", node.dir), node.is_leaf(), objects)
    };
    let mut all: Vec<Content> = tree.walk().map(node).collect();
    all.sort();
    all
}

/// The tree built anew in the same root.
fn anew(tree: &AdaptiveTree, view: &BoundsView<'_>) -> AdaptiveTree {
    let mut fresh = tree.clone();
    let root = tree.arena.nodes[ROOT as usize];
    fresh.plant(Node { cell: root.cell, size: root.size, ..Node::EMPTY });
    fresh.move_down(view, false);
    fresh
}

fn tests(tree: &AdaptiveTree, view: &BoundsView<'_>) -> u64 {
    let mut out = Candidates::default();
    tree.compare(view, &mut out);
    out.sphere_tests
}

fn random(seed: &mut u64) -> Real {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*seed >> 33) as Real / (1u64 << 31) as Real
}

fn point(seed: &mut u64) -> Vec3 {
    Vec3::new(random(seed), random(seed), random(seed))
}

fn limits() -> Vec<BoundaryBounds> {
    let side = |axis: usize, at: Real| {
        let (mut face, mut normal) = (Aabb { min: Vec3::ZERO, max: Vec3::splat(1.0) }, Vec3::ZERO);
        (face.min[axis], face.max[axis]) = (at, at);
        normal[axis] = 1.0 - 2.0 * at;
        let ball = Ball { center: (face.min + face.max) * 0.5, radius: 0.75 };
        BoundaryBounds { ball, face, behind: Some((normal, -at)) }
    };
    (0..3).flat_map(|axis| [side(axis, 0.0), side(axis, 1.0)]).collect()
}

fn view_of<'a>(balls: &'a [Ball], fixed: &'a [bool], boundaries: &'a [BoundaryBounds]) -> BoundsView<'a> {
    BoundsView { balls, boxes: &[], fixed, boundaries, epoch: 0 }
}

fn find(tree: &mut AdaptiveTree, view: &BoundsView<'_>) -> Candidates {
    let mut out = Candidates::default();
    tree.find(view, &mut out);
    out
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300, rng_seed: RngSeed::Fixed(533), failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn the_adapted_tree_equals_a_new_one(
        bodies in 1usize..60, walled: bool, wind: bool, per_cell in 1u32..6, max_depth in 0u32..20, seed: u64,
    ) {
        let mut dice = seed;
        let limits = if walled { limits() } else { Vec::new() };
        let mut balls: Vec<Ball> =
            (0..bodies).map(|_| Ball { center: point(&mut dice), radius: 0.1 * random(&mut dice) }).collect();
        let fixed: Vec<bool> = (0..bodies).map(|_| random(&mut dice) < 0.2).collect();
        let mut tree = AdaptiveTree::new(per_cell, max_depth);
        for _ in 0..12 {
            let view = view_of(&balls, &fixed, &limits);
            find(&mut tree, &view);
            let fresh = anew(&tree, &view);
            prop_assert_eq!(content(&tree), content(&fresh));
            prop_assert_eq!(tests(&tree, &view), tests(&fresh, &view));
            prop_assert_eq!(tree.node_count(), fresh.node_count());
            prop_assert!(tree.depth() <= max_depth);
            let drift = (point(&mut dice) - Vec3::splat(0.5)) * if wind { 3.0 } else { 0.0 };
            for (ball, _) in balls.iter_mut().zip(&fixed).filter(|(_, fixed)| !**fixed) {
                let far = if random(&mut dice) < 0.05 { 20.0 } else { 0.3 };
                ball.center += (point(&mut dice) - Vec3::splat(0.5)) * far + drift;
                if random(&mut dice) < 0.05 {
                    ball.radius = if ball.is_empty() { 0.05 } else { -1.0 };
                }
            }
        }
    }
}

/// The number of times a tree was built is not visible from outside; its frame is.
fn same_frame(a: &Frame, b: &Frame) -> bool {
    format!("{a:?}") == format!("{b:?}")
}

#[test]
fn the_scene_may_grow_and_shrink_without_a_new_tree() {
    let at = |x: Real| Ball { center: Vec3::new(x, 0.0, 0.0), radius: 0.01 };
    let mut balls: Vec<Ball> = (0..8).map(|k| at(k as Real / 8.0)).collect();
    let mut tree = AdaptiveTree::new(1, 16);
    find(&mut tree, &view_of(&balls, &[], &[]));
    let (frame, size) = (tree.frame, tree.arena.nodes[ROOT as usize].size);
    balls[7] = at(100.0);
    find(&mut tree, &view_of(&balls, &[], &[]));
    let grown = tree.arena.nodes[ROOT as usize];
    assert_eq!(grown.size, [size[0] * 128.0, size[1], size[2]], "doubled away from the others until it fitted");
    assert_eq!(grown.cell.low[0], -0.5, "the side that nobody left has stayed");
    balls[7] = at(0.99);
    find(&mut tree, &view_of(&balls, &[], &[]));
    assert!(tree.arena.nodes[ROOT as usize].size[0] <= 2.0 * size[0], "shrunk again");
    assert!(same_frame(&frame, &tree.frame));
    balls[7] = at(1e30);
    find(&mut tree, &view_of(&balls, &[], &[]));
    assert!(!same_frame(&frame, &tree.frame), "too far to double: built anew");
}

#[test]
fn walls_on_the_border_are_inside_the_first_root() {
    let limits = limits();
    let balls = [Ball { center: Vec3::splat(0.5), radius: 0.1 }];
    let mut tree = AdaptiveTree::new(1, 16);
    find(&mut tree, &view_of(&balls, &[], &limits));
    assert_eq!(tree.arena.nodes[ROOT as usize].cell, Span::UNIT);
    // Two walls across the first halving, each in its half; all others and the body lie across it.
    let x_wall = |k: usize| tree.arena.nodes[tree.arena.node_of[k] as usize].dir;
    assert_eq!([x_wall(1), x_wall(2)], [node::Direction::Left, node::Direction::Right]);
}

#[test]
fn what_is_immovable_stays_unless_the_tree_changes_round_it() {
    let mut balls: Vec<Ball> =
        (0..64).map(|k| Ball { center: Vec3::new((k % 8) as Real, (k / 8) as Real, 0.0), radius: 0.25 }).collect();
    let fixed: Vec<bool> = (0..64).map(|k| k % 8 == 0 || k % 8 == 7 || !(8..56).contains(&k)).collect();
    let mut tree = AdaptiveTree::new(4, 16);
    find(&mut tree, &view_of(&balls, &fixed, &[]));
    let before = tree.arena.node_of.clone();
    // A fixed body that is put elsewhere without a new epoch is not noticed: nobody looked at it.
    balls[0].center = Vec3::new(7.0, 7.0, 0.0);
    balls[9].center.x += 0.125;
    find(&mut tree, &view_of(&balls, &fixed, &[]));
    assert_eq!(tree.arena.node_of[0], before[0]);
    assert_ne!(before[0], NONE);
}

#[test]
fn freed_nodes_are_used_again() {
    let mut seed = 5;
    let mut balls: Vec<Ball> = (0..200).map(|_| Ball { center: point(&mut seed), radius: 1e-3 }).collect();
    let corners = [Vec3::ZERO, Vec3::splat(1.0)].map(|center| Ball { center, radius: 1e-3 });
    balls.extend(corners);
    let mut tree = AdaptiveTree::new(1, 40);
    let mut most = 0;
    for _ in 0..300 {
        find(&mut tree, &view_of(&balls, &[], &[]));
        most = most.max(tree.node_count());
        for ball in &mut balls[..200] {
            ball.center = point(&mut seed);
        }
    }
    assert!(tree.arena.nodes.len() <= 4 * most, "{} places for at most {most} nodes", tree.arena.nodes.len());
}

#[test]
fn risen_objects_stop_at_the_first_cell_that_holds_them() {
    let mut seed = 21;
    let mut balls: Vec<Ball> = (0..300).map(|_| Ball { center: point(&mut seed), radius: 1e-3 }).collect();
    balls.extend([Vec3::ZERO, Vec3::splat(1.0)].map(|center| Ball { center, radius: 1e-3 }));
    let mut tree = AdaptiveTree::new(1, 30);
    find(&mut tree, &view_of(&balls, &[], &[]));
    let before = tree.arena.node_of.clone();
    for ball in &mut balls[..300] {
        ball.center = ball.center * 0.9 + point(&mut seed) * 0.1;
    }
    let view = view_of(&balls, &[], &[]);
    tree.place(&view);
    tree.move_up(&view, true);
    let near = node::nearness(&tree.arena.nodes[ROOT as usize]);
    let mut risen = 0;
    for (object, &start) in before.iter().enumerate() {
        let mut n = start;
        while tree.arena.nodes[n as usize].moved(&tree.spans[object], &near) != node::Direction::No {
            n = tree.arena.nodes[n as usize].parent;
        }
        assert_eq!(tree.arena.node_of[object], n);
        risen += u32::from(n != start);
    }
    assert!(risen > 50);
}
