//! Every broad phase finds what the slow twin finds: nothing twice, nothing too much, and everything that any pair routine
//! could call a contact; in scenes that move, grow, shrink, lose bodies and let bodies through their walls.

use mrtphys::bounds::{Aabb, Ball, BoundaryBounds};
use mrtphys::broad::{AdaptiveTree, BoundsView, BroadPhase, BruteForce, Candidates, RegularGrid, SortedGrid};
use mrtphys::math::Vec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// All broad phases, with parameters that bring out their branches. A new one is one line.
fn phases() -> Vec<Box<dyn BroadPhase>> {
    vec![
        Box::new(BruteForce),
        Box::new(RegularGrid::new(None)),
        Box::new(RegularGrid::new(Some(1))),
        Box::new(RegularGrid::new(Some(7))),
        Box::new(RegularGrid::new(Some(1024))),
        Box::new(AdaptiveTree::new(1, 48)),
        Box::new(AdaptiveTree::new(4, 16)),
        Box::new(AdaptiveTree::new(2, 3)),
        Box::new(AdaptiveTree::new(16, 0)),
        Box::new(SortedGrid::default()),
    ]
}

/// Random numbers that are the same everywhere (SplitMix64).
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    /// From 0 to 1.
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
    fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }
    fn point(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit())
    }
}

#[derive(Clone, Copy, Debug)]
enum Layout {
    Uniform,
    Clustered,
    OneCell,
    Line,
    Polydisperse,
    FarAway,
    TouchingLattice,
    Points,
}

const LAYOUTS: [Layout; 8] = [
    Layout::Uniform,
    Layout::Clustered,
    Layout::OneCell,
    Layout::Line,
    Layout::Polydisperse,
    Layout::FarAway,
    Layout::TouchingLattice,
    Layout::Points,
];

fn ball(layout: Layout, index: usize, bodies: usize, dice: &mut Dice) -> Ball {
    let spacing = 1.0 / libm::cbrt(bodies as f64);
    let (p, small) = (dice.point(), spacing * (0.1 + 0.6 * dice.unit()));
    let (center, radius) = match layout {
        Layout::Uniform => (p, small),
        Layout::Clustered => (Vec3::splat((index % 3) as f64 * 0.4) + p * 0.05, small * 0.05),
        Layout::OneCell => (Vec3::splat(0.5) + p * 1e-9, 1e-10),
        Layout::Line => (Vec3::new(0.3, p.y, 0.7), 0.3 * small * small),
        Layout::Polydisperse => (p * 1000.0, libm::pow(10.0, 6.0 * dice.unit() - 3.0)),
        Layout::FarAway if index % 9 == 4 => ((p - Vec3::splat(0.5)) * 2e15, small),
        Layout::FarAway => (p, small),
        Layout::TouchingLattice => {
            let at = |k: usize| 1e5 / 3.0 + 0.1 * k as f64;
            (Vec3::new(at(index % 4), at(index / 4 % 4), at(index / 16)), 0.05)
        }
        Layout::Points => (Vec3::new((p.x * 3.0).floor(), 0.0, 0.25), 0.0),
    };
    if dice.one_in(25) { Ball::EMPTY } else { Ball { center, radius } }
}

fn unit(axis: usize, sign: f64) -> Vec3 {
    let mut v = Vec3::ZERO;
    v[axis] = sign;
    v
}

/// Limits of a box, plus a half-space, a plane, an oblique limit, a two-sided face, as the dice fall.
fn boundaries(low: f64, high: f64, dice: &mut Dice) -> Vec<BoundaryBounds> {
    let size = high - low;
    let mut all = Vec::new();
    if !dice.one_in(3) {
        for (axis, side) in (0..3).flat_map(|axis| [(axis, low), (axis, high)]) {
            let (mut face, mut center) =
                (Aabb { min: Vec3::splat(low), max: Vec3::splat(high) }, Vec3::splat(0.5 * (low + high)));
            (face.min[axis], face.max[axis], center[axis]) = (side, side, side);
            let sign = if side == low { 1.0 } else { -1.0 };
            let ball = Ball { center, radius: 0.5f64.sqrt() * size };
            all.push(BoundaryBounds { ball, face, behind: Some((unit(axis, sign), sign * side)) });
        }
    }
    let endless = Ball { center: Vec3::ZERO, radius: f64::INFINITY };
    if dice.one_in(2) {
        let behind = Some((Vec3::new(0.0, 0.6, 0.8), low + 0.1 * size));
        all.push(BoundaryBounds { ball: endless, face: Aabb::EVERYWHERE, behind });
    }
    if dice.one_in(3) {
        all.push(BoundaryBounds { ball: endless, face: Aabb::EVERYWHERE, behind: None });
    }
    let middle = Vec3::splat(low + 0.4 * size);
    let corner = Vec3::new(0.2 * size, 0.15 * size, 0.1 * size);
    let face = Aabb { min: middle - corner, max: middle + corner };
    let ball = Ball { center: middle, radius: corner.length() };
    if dice.one_in(3) {
        let normal = Vec3::new(-0.48, 0.64, 0.6);
        all.push(BoundaryBounds { ball, face, behind: Some((normal, normal.dot(middle))) });
    }
    if dice.one_in(2) {
        all.push(BoundaryBounds { ball, face, behind: None });
    }
    if dice.one_in(4) {
        // Somebody's shape that knows its sphere but not its box.
        all.push(BoundaryBounds { ball, face: Aabb::EVERYWHERE, behind: None });
    }
    all
}

struct World {
    layout: Layout,
    balls: Vec<Ball>,
    boxes: Vec<Aabb>,
    fixed: Vec<bool>,
    /// box of the body relative to that of its sphere, at most 1
    slim: Vec<f64>,
    boundaries: Vec<BoundaryBounds>,
    epoch: u64,
    dice: Dice,
}

impl World {
    fn new(layout: Layout, bodies: usize, slim: bool, seed: u64) -> World {
        let mut dice = Dice(seed);
        let balls: Vec<Ball> = (0..bodies).map(|k| ball(layout, k, bodies, &mut dice)).collect();
        // In every other world everything can move.
        let all_move = dice.one_in(2);
        let fixed = (0..bodies).map(|_| !all_move && dice.one_in(8)).collect();
        let slim = (0..bodies).map(|_| if slim && dice.one_in(2) { 1.0 / 3f64.sqrt() } else { 1.0 }).collect();
        let boundaries = match layout {
            Layout::Polydisperse => boundaries(0.0, 1000.0, &mut dice),
            Layout::TouchingLattice => boundaries(1e5 / 3.0 - 0.05, 1e5 / 3.0 + 0.35, &mut dice),
            _ => boundaries(0.0, 1.0, &mut dice),
        };
        let mut world = World { layout, balls, boxes: Vec::new(), fixed, slim, boundaries, epoch: 3, dice };
        world.bound();
        world
    }

    fn bound(&mut self) {
        let slim = |(b, s): (&Ball, &f64)| {
            if *s == 1.0 { Aabb::of_ball(b) } else { Aabb::of_ball(&Ball { radius: b.radius * s, ..*b }) }
        };
        self.boxes = self.balls.iter().zip(&self.slim).map(slim).collect();
    }

    /// What does not change the epoch: movable bodies move a little or far, get lost and come back.
    fn advance(&mut self) {
        let drift = (self.dice.point() - Vec3::splat(0.5)) * 0.3;
        let all_drift = self.dice.one_in(3);
        for k in 0..self.balls.len() {
            if self.fixed[k] {
                continue;
            }
            let push = self.dice.point() - Vec3::splat(0.5);
            let b = &mut self.balls[k];
            if b.is_empty() {
                if self.dice.one_in(4) {
                    *b = Ball { center: push, radius: 0.01 };
                }
                continue;
            }
            b.center += push * (0.5 * b.radius);
            if all_drift {
                b.center += drift;
            }
            match self.dice.below(60) {
                0 => b.center += push * (30.0 * b.radius),
                1 => b.center += push,
                2 => b.center = push * 1e4,
                3 if self.dice.one_in(8) => b.center = push * 1e40,
                4 => *b = Ball::EMPTY,
                _ => {}
            }
        }
        self.bound();
    }

    /// What changes the epoch: bodies are removed, others come in, boundaries go.
    fn rearrange(&mut self) {
        self.epoch += 1;
        if self.dice.one_in(2) {
            // As many as before, but others: only the epoch tells.
            for k in 0..self.balls.len() {
                let other = self.dice.below(self.balls.len());
                self.balls.swap(k, other);
                self.slim.swap(k, other);
            }
            self.bound();
            return;
        }
        for _ in 0..self.dice.below(1 + self.balls.len()) {
            let k = self.dice.below(self.balls.len());
            self.balls.swap_remove(k);
            self.fixed.swap_remove(k);
            self.slim.swap_remove(k);
        }
        if self.dice.one_in(2) {
            self.balls.push(ball(self.layout, self.dice.below(64), 20, &mut self.dice));
            self.fixed.push(self.dice.one_in(4));
            self.slim.push(1.0);
        }
        if self.dice.one_in(3) && !self.boundaries.is_empty() {
            self.boundaries.remove(self.dice.below(self.boundaries.len()));
        }
        self.bound();
    }

    fn view(&self) -> BoundsView<'_> {
        BoundsView {
            balls: &self.balls,
            boxes: &self.boxes,
            // As the step does: nothing fixed is said by an empty list, and has a faster way of its own.
            fixed: if self.fixed.contains(&true) { &self.fixed } else { &[] },
            boundaries: &self.boundaries,
            epoch: self.epoch,
        }
    }

    /// The contract, written down pair by pair: what may be found, and whether it must be.
    fn expect(&self) -> (Pairs, Pairs, u64) {
        let (mut pairs, mut walls, mut tests) = (Vec::new(), Vec::new(), 0);
        let n = self.balls.len();
        for i in 0..n {
            for j in i + 1..n {
                let taking_part = !self.balls[i].is_empty() && !self.balls[j].is_empty();
                if taking_part && !(self.fixed[i] && self.fixed[j]) {
                    tests += 1;
                    if self.balls[i].meets(&self.balls[j]) {
                        let exact = self.slim[i] == 1.0 && self.slim[j] == 1.0;
                        pairs.push(([i as u32, j as u32], exact || self.boxes[i].meets(&self.boxes[j])));
                    }
                }
            }
            for (k, b) in self.boundaries.iter().enumerate() {
                if !self.fixed[i] && !self.balls[i].is_empty() {
                    tests += 1;
                    if b.reaches(&self.balls[i]) {
                        // Nothing touches a limit without reaching behind it.
                        let must = b.behind.map_or(b.face.meets(&self.boxes[i]), |_| b.reaches_behind(&self.balls[i]));
                        walls.push(([i as u32, k as u32], must));
                    }
                }
            }
        }
        (pairs, walls, tests)
    }
}

type Pairs = Vec<([u32; 2], bool)>;

fn check(what: &str, mut found: Vec<[u32; 2]>, allowed: &Pairs, ordered: bool) -> Result<(), TestCaseError> {
    if !ordered {
        found.iter_mut().for_each(|p| p.sort_unstable());
    }
    found.sort_unstable();
    for two in found.windows(2) {
        prop_assert!(two[0] != two[1], "{what} {:?} found twice", two[0]);
    }
    for pair in &found {
        prop_assert!(allowed.binary_search_by_key(pair, |p| p.0).is_ok(), "{what} {pair:?} does not meet");
    }
    for (pair, must) in allowed {
        prop_assert!(!must || found.binary_search(pair).is_ok(), "{what} {pair:?} was missed");
    }
    Ok(())
}

fn search(phase: &mut dyn BroadPhase, world: &World) -> Candidates {
    let mut out = Candidates::default();
    phase.find(&world.view(), &mut out);
    out
}

fn compare(phases: &mut [Box<dyn BroadPhase>], world: &World) -> Result<(), TestCaseError> {
    let (pairs, walls, all) = world.expect();
    for phase in phases {
        let out = search(phase.as_mut(), world);
        let name = phase.name();
        prop_assert!(out.sphere_tests <= all, "{name}: more tests than pairs");
        prop_assert!(out.sphere_tests >= (out.pairs.len() + out.walls.len()) as u64, "{name}: found without a test");
        if name == "brute-force" {
            let [p, w] = [&pairs, &walls].map(|l| l.iter().map(|p| p.0).collect::<Vec<_>>());
            let mut found = (out.pairs.clone(), out.walls.clone());
            found.0.iter_mut().for_each(|p| p.sort_unstable());
            found.0.sort_unstable();
            found.1.sort_unstable();
            prop_assert_eq!(found, (p, w));
            prop_assert_eq!(out.sphere_tests, all);
        }
        check(&format!("{name}: pair"), out.pairs, &pairs, false)?;
        check(&format!("{name}: wall"), out.walls, &walls, true)?;
    }
    Ok(())
}

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, rng_seed: RngSeed::Fixed(1998), failure_persistence: None, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(config(600))]

    #[test]
    fn every_broad_phase_finds_every_contact(
        layout in 0..LAYOUTS.len(), bodies in 0usize..70, slim: bool, steps in 1usize..9, seed: u64,
    ) {
        let mut world = World::new(LAYOUTS[layout], bodies, slim, seed);
        let mut phases = phases();
        for _ in 0..steps {
            compare(&mut phases, &world)?;
            if world.dice.one_in(4) { world.rearrange() } else { world.advance() }
        }
    }

    #[test]
    fn memory_saves_time_only(layout in 0..LAYOUTS.len(), bodies in 1usize..70, seed: u64) {
        // The grid counts the same with and without what it remembers: the counts are those of the scene.
        let mut world = World::new(LAYOUTS[layout], bodies, true, seed);
        let mut kept = RegularGrid::new(None);
        for _ in 0..4 {
            let with = search(&mut kept, &world);
            let without = search(&mut RegularGrid::new(None), &world);
            prop_assert_eq!((with.sphere_tests, with.pairs, with.walls),
                (without.sphere_tests, without.pairs, without.walls));
            world.advance();
        }
    }

    #[test]
    fn powers_of_two_change_nothing(layout in 0..LAYOUTS.len(), bodies in 1usize..70, seed: u64, k in -40i32..=40) {
        let scale = libm::ldexp(1.0, k);
        let mut world = World::new(LAYOUTS[layout], bodies, true, seed);
        let (mut phases, mut twins) = (phases(), phases());
        for _ in 0..3 {
            let big = scaled(&world, scale);
            for (phase, twin) in phases.iter_mut().zip(&mut twins) {
                let [a, b] = [search(phase.as_mut(), &world), search(twin.as_mut(), &big)];
                prop_assert_eq!((a.sphere_tests, a.pairs, a.walls), (b.sphere_tests, b.pairs, b.walls));
            }
            world.advance();
        }
    }
}

fn scaled(world: &World, scale: f64) -> World {
    let ball = |b: &Ball| Ball { center: b.center * scale, radius: b.radius * scale };
    let resized = |b: &Aabb| Aabb { min: b.min * scale, max: b.max * scale };
    let boundary = |b: &BoundaryBounds| BoundaryBounds {
        ball: ball(&b.ball),
        face: resized(&b.face),
        behind: b.behind.map(|(normal, offset)| (normal, offset * scale)),
    };
    World {
        balls: world.balls.iter().map(ball).collect(),
        boxes: world.boxes.iter().map(resized).collect(),
        fixed: world.fixed.clone(),
        slim: world.slim.clone(),
        boundaries: world.boundaries.iter().map(boundary).collect(),
        dice: Dice(0),
        ..*world
    }
}

/// A body far outside, diagonally past an edge of the box, meets none of the faces' boxes and is behind two of them.
#[test]
fn crossed_limits_are_found_wherever_the_body_is() {
    let mut dice = Dice(0);
    let limits = loop {
        let all = boundaries(0.0, 1.0, &mut dice);
        if all.len() >= 6 && all[0].behind.is_some() && all[0].face.max.x == 0.0 {
            break all[..6].to_vec();
        }
    };
    let outside = Ball { center: Vec3::new(-3.0, 7.0, 0.5), radius: 0.125 };
    let balls = [outside, Ball { center: Vec3::splat(0.5), radius: 0.125 }];
    let boxes = balls.map(|b| Aabb::of_ball(&b));
    for mut phase in phases() {
        let mut out = Candidates::default();
        let view = BoundsView { balls: &balls, boxes: &boxes, fixed: &[], boundaries: &limits, epoch: 0 };
        phase.find(&view, &mut out);
        let mut behind: Vec<u32> = out.walls.iter().filter(|w| w[0] == 0).map(|w| w[1]).collect();
        behind.sort_unstable();
        assert_eq!(behind, [0, 3], "{}", phase.name());
    }
}

/// Bodies that numbers can hardly hold: nothing hangs, nothing is lost.
#[test]
fn boundless_and_huge_bodies_meet_what_they_meet() {
    let at = |x: f64, radius: f64| Ball { center: Vec3::new(x, 0.0, 0.0), radius };
    let inf = f64::INFINITY;
    let balls =
        [at(0.0, 1.0), at(1.5, 1.0), at(9.0, inf), at(1e120, 1e120), at(-1e308, 1.0), at(5.0, inf), at(1e308, 1.0)];
    let mut world = World::new(Layout::Uniform, 0, false, 5);
    world.boundaries.truncate(6);
    world.balls = balls.to_vec();
    world.fixed = vec![false, false, false, false, true, true, false];
    world.slim = vec![1.0; balls.len()];
    for _ in 0..2 {
        world.bound();
        compare(&mut phases(), &world).unwrap();
        world.balls[3] = at(1e15, 1.0);
    }
}

/// The parallel loop over rows gives the same list in the same order for any number of threads.
#[test]
fn brute_force_does_not_depend_on_threads() {
    let world = World::new(Layout::Uniform, 1500, false, 7);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let out = pool.install(|| search(&mut BruteForce, &world));
        (out.pairs, out.walls, out.sphere_tests)
    };
    let one = run(1);
    assert_eq!(one.2, world.expect().2);
    assert!(one.0.len() > 100);
    for threads in [2, 3, 8] {
        assert_eq!(run(threads), one);
    }
}

/// The work stays in proportion where cells are far smaller or bodies far larger than they should be.
#[test]
fn a_grid_of_a_thousand_million_cells_needs_no_memory_for_them() {
    let world = World::new(Layout::Polydisperse, 600, false, 11);
    let mut grid = RegularGrid::new(Some(1024));
    let (pairs, walls, _) = world.expect();
    let out = search(&mut grid, &world);
    check("pair", out.pairs, &pairs, false).unwrap();
    check("wall", out.walls, &walls, true).unwrap();
    assert!(grid.cells().len() < 600 * 40);
}

/// Two spheres whose touching is a matter of rounding: the test of the spheres says yes, their boxes miss each other by a
/// unit in the last place, and the border of two cells lies between.
#[test]
fn rounding_at_the_border_of_cells_loses_no_touching_spheres() {
    let mut dice = Dice(8);
    let corner = |x: f64| Ball { center: Vec3::new(x, 0.0, 0.0), radius: 0.0 };
    let mut hard = 0;
    for _ in 0..200_000 {
        let (r, s) = (0.2 * dice.unit(), 0.2 * dice.unit());
        let nudge = |x: f64, dice: &mut Dice| f64::from_bits(x.to_bits() + dice.below(3) as u64 - 1);
        let a = Ball { radius: r, ..corner(nudge(0.5 - r, &mut dice)) };
        let b = Ball { radius: s, ..corner(nudge(0.5 + s, &mut dice)) };
        let (below, above) = (Aabb::of_ball(&a), Aabb::of_ball(&b));
        if !a.meets(&b) || below.max.x >= 0.5 || above.min.x < 0.5 {
            continue;
        }
        hard += 1;
        let balls = [corner(0.0), corner(1.0), a, b];
        let boxes = balls.map(|b| Aabb::of_ball(&b));
        for mut phase in [RegularGrid::new(Some(2)), RegularGrid::new(Some(64))] {
            let mut out = Candidates::default();
            phase.find(&BoundsView { balls: &balls, boxes: &boxes, fixed: &[], boundaries: &[], epoch: 0 }, &mut out);
            assert_eq!(out.pairs, [[2, 3]], "{a:?} {b:?}");
        }
    }
    assert!(hard > 100, "only {hard} pairs were of this kind");
}
