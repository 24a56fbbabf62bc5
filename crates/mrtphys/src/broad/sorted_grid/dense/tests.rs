//! The sort in blocks against a plain stable sort, and the scan over lanes against the comparison of all with all, for every
//! way to cut the work and every number of threads.

use super::*;
use crate::bounds::BoundaryBounds;
use crate::broad::BroadPhase;
use crate::broad::sorted_grid::SortedGrid;
use crate::broad::sorted_grid::cells::cell_of;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Balls of one level: radii within a factor of four, a third of them exactly touching their predecessor.
fn balls() -> impl Strategy<Value = Vec<Ball>> {
    let one = (prop::array::uniform3(0.0..1.0), 0.25..1.0_f64, 0..3_u8);
    (prop::collection::vec(one, 1..400), 0.005..0.2_f64, prop::array::uniform3(-1e3..1e3)).prop_map(
        |(list, size, origin)| {
            let mut out: Vec<Ball> = Vec::new();
            for (at, radius, touches) in list {
                let mut ball = Ball { center: Vec3::from(at) + Vec3::from(origin), radius: radius * size };
                if let (Some(last), 0) = (out.last(), touches) {
                    ball.center = last.center + Vec3::new(0.0, last.radius + ball.radius, 0.0);
                }
                out.push(ball);
            }
            out
        },
    )
}

fn frame(balls: &[Ball]) -> Frame {
    Frame::new(&super::super::Extent::of(balls), None, balls)
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
}

type Pairs = Vec<[u32; 2]>;

/// Scans in blocks of `block`.
fn scanned(dense: &Dense, balls: &[Ball], block: usize) -> (Pairs, u64) {
    let view = BoundsView { balls, boxes: &[], fixed: &[], boundaries: &[], epoch: 0 };
    let mut found = Found::default();
    for first in (0..dense.len()).step_by(block) {
        dense.scan(first, (first + block).min(dense.len()), &view, &mut found);
    }
    (found.pairs, found.tests)
}

fn sorted(pairs: &[[u32; 2]]) -> Pairs {
    let mut out: Pairs = pairs.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
    out.sort_unstable();
    out
}

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, rng_seed: RngSeed::Fixed(20), failure_persistence: None, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(config(48))]

    #[test]
    fn any_cut_and_any_number_of_threads_is_one_stable_sort(
        balls in balls(),
        block in 1_usize..90,
        widest in prop::option::of(prop_oneof![0_usize..3000, Just(usize::MAX)]),
        every in 1_usize..4,
    ) {
        let frame = frame(&balls);
        let members: Vec<u32> = (0..balls.len() as u32).step_by(every).collect();
        let members = (every > 1).then_some(&members[..]);
        let stride = [frame.count[0] as u32 + 1, (frame.count[0] as u32 + 1) * (frame.count[1] as u32 + 1)];
        let cell = |slot: u32| {
            let place = frame.place(balls[slot as usize].center).map(|c| i64::from(cell_of(c) as i32));
            let at = [0, 1, 2].map(|axis| (place[axis] - frame.first[axis]) as u32);
            at[0] + 1 + (at[1] + 1) * stride[0] + at[2] * stride[1]
        };
        let mut twin: Vec<u32> = members.map_or_else(|| (0..balls.len() as u32).collect(), <[u32]>::to_vec);
        twin.sort_by_key(|&slot| cell(slot));
        // Scratch of an earlier, larger sort is in the way.
        let mut dense = Dense::default();
        let twice: Vec<Ball> = balls.iter().chain(&balls).copied().collect();
        dense.rebuild(frame, None, &twice, Parts { block: 7, widest: Some(usize::MAX) });
        for threads in [1, 2, 3, 8] {
            pool(threads).install(|| dense.rebuild(frame, members, &balls, Parts { block, widest }));
            prop_assert_eq!(&dense.slots, &twin);
            let cells: Vec<u32> = twin.iter().map(|&slot| cell(slot)).collect();
            prop_assert_eq!(&dense.cells, &cells);
            for (c, &start) in dense.start.iter().enumerate() {
                prop_assert_eq!(start as usize, cells.partition_point(|&of| (of as usize) < c));
            }
            let points = dense.points.axes().map(|axis| axis.to_vec());
            for (at, &slot) in twin.iter().enumerate() {
                let [x, y, z] = frame.place(balls[slot as usize].center).map(|c| c as u16);
                prop_assert_eq!(points[0][at], u32::from(x) | u32::from(y) << 16);
                prop_assert_eq!(points[1][at], u32::from(z));
            }
        }
    }

    #[test]
    fn the_scan_finds_what_meets(balls in balls(), block in 1_usize..300) {
        let mut dense = Dense::default();
        dense.rebuild(frame(&balls), None, &balls, Parts { block: 50, widest: None });
        let (pairs, tests) = scanned(&dense, &balls, block);
        let mut all = Vec::new();
        for i in 0..balls.len() {
            all.extend((0..i).filter(|&k| balls[i].meets(&balls[k])).map(|k| [k as u32, i as u32]));
        }
        prop_assert_eq!(sorted(&pairs), sorted(&all));
        let by_runs: u64 = (0..dense.len()).flat_map(|i| dense.runs(i)).map(|(from, to)| u64::from(to - from)).sum();
        prop_assert_eq!(tests, by_runs);
    }

    #[test]
    fn lanes_of_any_kind_find_the_same(balls in balls(), first in 0_usize..200) {
        let mut dense = Dense::default();
        dense.rebuild(frame(&balls), None, &balls, Parts::of(balls.len()));
        let limit = Frame::limit();
        let (stride, first) = (dense.stride, first.min(dense.len()));
        let grid = lanes::Grid { start: &dense.start, stride, cells: &dense.cells, points: &dense.points, limit };
        let (mut one, mut other) = (Vec::new(), Vec::new());
        let tests = [
            lanes::scan(&grid, first, dense.len(), &mut one),
            lanes::scan_portable(&grid, first, dense.len(), &mut other),
        ];
        prop_assert_eq!(one, other);
        prop_assert_eq!(tests[0], tests[1]);
    }
}

/// A row of a thousand cells, where rounding to single precision is coarse: spheres that touch to the last bit pass.
#[test]
fn rounding_never_loses_a_pair() {
    let r = 0.1;
    let balls: Vec<Ball> =
        (0..20_000).map(|k| Ball { center: Vec3::new(2.0 * r * f64::from(k), 1.0 / 3.0, 0.0), radius: r }).collect();
    let touching = balls.windows(2).filter(|b| b[0].meets(&b[1])).count();
    assert!(touching > 5000);
    let mut dense = Dense::default();
    dense.rebuild(frame(&balls), None, &balls, Parts::of(balls.len()));
    assert_eq!(scanned(&dense, &balls, 999).0.len(), touching);
}

/// The order in which a grid without memory sorts bodies.
fn order(view: &BoundsView<'_>) -> Vec<u32> {
    let mut grid = SortedGrid::default();
    grid.find(view, &mut Candidates::default());
    grid.spatial_order().to_vec()
}

/// A step of bodies that drift, a few of which jump out of the box or come back.
fn moved(balls: &[Ball], velocities: &[[f64; 3]], jumps: &[(usize, [f64; 3])]) -> Vec<Ball> {
    let drifted = balls.iter().zip(velocities).map(|(b, &v)| Ball { center: b.center + Vec3::from(v) * 0.01, ..*b });
    let mut out: Vec<Ball> = drifted.collect();
    for &(k, to) in jumps {
        let k = k % out.len();
        out[k].center = Vec3::from(to);
    }
    out
}

fn walls() -> Vec<BoundaryBounds> {
    let wall = |normal: Vec3, offset: f64| BoundaryBounds {
        ball: Ball { center: Vec3::ZERO, radius: f64::INFINITY },
        face: Aabb::EVERYWHERE,
        behind: Some((normal, offset)),
    };
    [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [wall(axis, -1e3), wall(-axis, -1e3 - 1.0)]).collect()
}

proptest! {
    #![proptest_config(config(24))]

    /// What the sort foresees from the step before changes nothing: neither what is found nor what is counted.
    #[test]
    fn memory_of_the_last_step_changes_nothing(
        balls in balls(),
        velocities in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 800),
        jumps in prop::collection::vec(prop::collection::vec((0_usize..400, prop::array::uniform3(-1002.0..1002.0_f64)), 0..3), 6),
    ) {
        let boundaries = walls();
        let mut balls = balls;
        let mut kept = SortedGrid::default();
        let mut foreseen = 0;
        for jumps in &jumps {
            let view = BoundsView { balls: &balls, boxes: &[], fixed: &[], boundaries: &boundaries, epoch: 7 };
            let (mut own, mut twin) = (Candidates::default(), Candidates::default());
            foreseen += usize::from(kept.foreseen(&view).is_some());
            kept.find(&view, &mut own);
            SortedGrid::default().find(&view, &mut twin);
            prop_assert_eq!(sorted(&own.pairs), sorted(&twin.pairs));
            prop_assert_eq!(sorted(&own.walls), sorted(&twin.walls));
            prop_assert_eq!(own.sphere_tests, twin.sphere_tests);
            prop_assert_eq!(kept.spatial_order(), &order(&view)[..]);
            balls = moved(&balls, &velocities, jumps);
        }
        // Radii within a factor of four and a box of few cells: nearly always one dense level, which foresees.
        prop_assume!(foreseen > 0);
    }
}
