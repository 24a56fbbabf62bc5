//! Golden state hashes of the gallery: the same under every broad phase and number of threads, today and tomorrow. A change
//! of `golden/state_hashes.txt` is a change of results: CHANGELOG.md says why.

use mrtphys::BroadPhaseKind;
use mrtphys_scene::{Scene, gallery};
use std::fmt::Write;

const PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../golden/state_hashes.txt");

const BROAD_PHASES: [BroadPhaseKind; 4] = [
    BroadPhaseKind::SortedGrid,
    BroadPhaseKind::BruteForce,
    BroadPhaseKind::RegularGrid { resolution: None },
    BroadPhaseKind::AdaptiveTree { objects_per_cell: 4, max_depth: 16 },
];

/// Brute force is asked up to so many bodies.
const BRUTE_FORCE_UP_TO: usize = 4096;

/// Enough steps for many impacts, few enough to be quick.
fn steps(bodies: usize) -> usize {
    match bodies {
        0..=1000 => 640,
        1001..=5000 => 48,
        5001..=50_000 => 16,
        _ => 6,
    }
}

fn hash((name, text): (&str, &str), broad_phase: Option<BroadPhaseKind>, threads: usize) -> Option<(usize, String)> {
    let mut scene = Scene::from_text(name, text).expect("a sound scene");
    if let Some(kind) = broad_phase {
        scene.settings.broad_phase = kind;
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let mut world = scene.build().expect("a scene that builds").world;
        if broad_phase == Some(BroadPhaseKind::BruteForce) && world.body_count() > BRUTE_FORCE_UP_TO {
            return None;
        }
        let steps = steps(world.body_count());
        (0..steps).for_each(|_| world.step().expect("a step"));
        Some((steps, world.state_hash()))
    })
}

#[test]
fn the_gallery_gives_its_golden_hashes() {
    let mut text = String::new();
    for &(name, source) in gallery() {
        let (steps, first) = hash((name, source), None, 1).expect("the scene's own broad phase");
        writeln!(text, "{name} {steps} {first}").expect("text");
        for threads in [2, 8] {
            assert_eq!(
                hash((name, source), None, threads).map(|h| h.1),
                Some(first.clone()),
                "{name} on {threads} threads"
            );
        }
        for kind in BROAD_PHASES {
            if let Some((_, other)) = hash((name, source), Some(kind), 2) {
                assert_eq!(other, first, "{name} with {kind}");
            }
        }
    }
    if std::env::var_os("MRTPHYS_BLESS").is_some() {
        std::fs::write(PATH, &text).expect("written");
    }
    let golden = std::fs::read_to_string(PATH).expect("golden/state_hashes.txt").replace("\r\n", "\n");
    assert!(golden == text, "results changed; MRTPHYS_BLESS=1 writes the hashes anew:\n{text}");
}
