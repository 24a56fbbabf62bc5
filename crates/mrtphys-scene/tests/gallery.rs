//! Every scene of the gallery is read, built, free of overlaps, and written back to the same state.

use mrtphys_scene::{Scene, gallery, gallery_scene, to_toml};

/// Scenes that take long to build are checked once, not in every way.
fn is_large(name: &str) -> bool {
    name.contains("100k")
}

#[test]
fn every_scene_of_the_folder_is_in_the_gallery() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut found = Vec::new();
    let mut folders = vec![root.clone()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("the folder of scenes") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "toml") {
                let name = path.strip_prefix(&root).expect("below the root").with_extension("");
                found.push(name.to_str().expect("UTF-8").replace('\\', "/"));
            }
        }
    }
    found.sort();
    let mut listed: Vec<&str> = gallery().iter().map(|(name, _)| *name).collect();
    listed.sort_unstable();
    assert_eq!(found, listed);
}

#[test]
fn scenes_have_a_title_and_a_sentence() {
    for (name, text) in gallery() {
        let first = text.lines().next().unwrap_or_default();
        assert!(first.starts_with("# ") && first.ends_with('.'), "{name}: {first}");
        let scene = Scene::from_text(name, text).unwrap_or_else(|e| panic!("{e}"));
        assert!(!scene.title.is_empty(), "{name}");
        assert!(scene.seconds > 0.0, "{name}");
    }
    assert!(gallery_scene("thesis/cube-8").is_some() && gallery_scene("nonsense").is_none());
}

#[test]
fn scenes_build_and_no_body_overlaps_another_or_a_wall() {
    for (name, text) in gallery() {
        let mut loaded = Scene::from_text(name, text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"));
        assert!(loaded.world.body_count() > 0, "{name}");
        let overlaps = loaded.world.overlaps();
        let names: Vec<_> = overlaps.iter().map(|o| (loaded.names.body_name(o.a), o.b, o.depth)).collect();
        assert!(names.is_empty(), "{name}: {names:?}");
    }
}

#[test]
fn the_fastest_body_of_a_scene_moves_at_most_a_quarter_of_its_size_in_a_step() {
    for (name, text) in gallery() {
        let loaded = Scene::from_text(name, text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"));
        let dt = loaded.world.time_step();
        for id in loaded.world.bodies() {
            let b = loaded.world.body(id).expect("a body of this world");
            let diameter = 2.0 * b.shape.bounding_sphere().radius;
            assert!(b.velocity.length() * dt <= 0.25 * diameter, "{name}: {:?}", loaded.names.body_name(id));
        }
    }
}

#[test]
fn the_thesis_lattices_are_those_of_the_counts() {
    for n in 2..=8_u32 {
        let name = format!("thesis/cube-{n}");
        let scene = Scene::from_text(&name, gallery_scene(&name).expect("in the gallery")).expect("a scene");
        let loaded = scene.build().expect("a world");
        assert_eq!(loaded.world.body_count(), n.pow(3) as usize);
        assert_eq!(loaded.world.boundaries().len(), 6);
        for (index, id) in loaded.world.bodies().enumerate() {
            let body = loaded.world.body(id).expect("a body");
            let (i, j, k) = (index as u32 / (n * n), index as u32 / n % n, index as u32 % n);
            let sphere = body.kind == "sphere";
            assert_eq!(sphere, (i + j + k) % 2 == 0, "{name} {index}");
            let radius = body.shape.bounding_sphere().radius;
            assert!((radius - 0.3 / f64::from(n)).abs() < 1e-15, "{name}: {radius}");
            for (x, at) in body.position.to_array().into_iter().zip([i, j, k]) {
                assert!((x - (f64::from(at) + 0.5) / f64::from(n)).abs() < 1e-15);
            }
            assert!((body.velocity.length() - 0.5).abs() < 1e-15);
        }
    }
}

#[test]
fn writing_and_reading_gives_the_same_state() {
    for (name, text) in gallery().iter().filter(|(name, _)| !is_large(name)) {
        let loaded = Scene::from_text(name, text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"));
        let written = to_toml(&loaded).unwrap_or_else(|e| panic!("{e}"));
        let again = Scene::from_text(name, &written).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(loaded.world.state_hash(), again.world.state_hash(), "{name}");
        assert_eq!(loaded.world.settings(), again.world.settings(), "{name}");
        assert_eq!(loaded.world.boundaries().len(), again.world.boundaries().len(), "{name}");
        assert_eq!(loaded.world.forces().len(), again.world.forces().len(), "{name}");
        assert_eq!(loaded.world.flows().len(), again.world.flows().len(), "{name}");
        // What is written is a fixed point: writing it again changes nothing.
        assert_eq!(to_toml(&again).unwrap_or_else(|e| panic!("{e}")), written, "{name}");
    }
}

fn load(name: &str) -> mrtphys_scene::Loaded {
    let text = gallery_scene(name).expect("in the gallery");
    Scene::from_text(name, text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"))
}

/// Runs to a time \[s\] and gives the body's state.
fn body_at(loaded: &mut mrtphys_scene::Loaded, time: f64, name: &str) -> mrtphys::world::Body {
    while loaded.world.time() < time {
        loaded.world.step().expect("a step");
    }
    loaded.world.body(loaded.names.body(name).expect("a name")).expect("a body")
}

// What the scenes' descriptions promise.

#[test]
fn an_overlap_would_be_found() {
    let text = gallery_scene("cradle")
        .expect("in the gallery")
        .replace("position = [-0.125, 0, 0]", "position = [-0.126, 0, 0]");
    let mut loaded = Scene::from_text("cradle", &text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"));
    let overlaps = loaded.world.overlaps();
    assert_eq!(overlaps.len(), 1);
    assert!((overlaps[0].depth - 0.001).abs() < 1e-12, "{overlaps:?}");
}

#[test]
fn the_last_ball_of_the_cradle_leaves_with_the_speed_of_the_first() {
    let mut loaded = load("cradle");
    // The striker needs 0.625 s to the row, the last ball 0.9375 s from there to the wall.
    assert_eq!(body_at(&mut loaded, 1.25, "ball4").velocity.to_array(), [1.0, 0.0, 0.0]);
    for name in ["striker", "ball0", "ball1", "ball2", "ball3"] {
        assert_eq!(body_at(&mut loaded, 1.25, name).velocity.length(), 0.0, "{name}");
    }
}

#[test]
fn the_sliding_ball_rolls_at_five_sevenths() {
    // Sliding ends after 2/7 v0 / (mu g) = 0.19 s.
    let ball = body_at(&mut load("slide-to-roll"), 1.0, "ball");
    assert!((ball.velocity.x - 10.0 / 7.0).abs() < 1e-3, "{:?}", ball.velocity);
    assert!((ball.velocity.x + ball.angular_velocity.z * 0.125).abs() < 1e-3);
}

#[test]
fn the_superball_comes_back() {
    let mut loaded = load("superball");
    let start = body_at(&mut loaded, 0.0, "ball").velocity;
    let end = body_at(&mut loaded, 1.5, "ball").velocity;
    assert!(start.x > 1.0 && end.x < -1.0 && end.y > 1.0, "{end:?}");
}

#[test]
fn the_middle_axis_flips_and_the_others_do_not() {
    let mut loaded = load("tops");
    let mut lowest = [1.0_f64; 3];
    for frame in 0..600 {
        let time = f64::from(frame) / 60.0;
        for (low, (name, axis)) in lowest.iter_mut().zip([("smallest", 0), ("middle", 1), ("largest", 2)]) {
            let body = body_at(&mut loaded, time, name);
            // The spin's share along the axis of the body that it began along.
            let own = body.orientation.conjugate().rotate(body.angular_velocity).to_array()[axis];
            *low = low.min(own / body.angular_velocity.length());
        }
    }
    assert!(lowest[0] > 0.99 && lowest[1] < -0.9 && lowest[2] > 0.99, "{lowest:?}");
}

#[test]
fn light_balls_rise_and_heavy_ones_sink() {
    let mut loaded = load("buoyancy");
    let height = |loaded: &mut _, name| body_at(loaded, 10.0, name).position.y;
    for (name, low, high) in
        [("cork-ball", 0.89, 0.91), ("oak-ball", 0.89, 0.91), ("water-ball", 0.499, 0.501), ("iron-ball", 0.09, 0.11)]
    {
        let y = height(&mut loaded, name);
        assert!((low..high).contains(&y), "{name}: {y}");
    }
}

#[test]
fn the_gases_stay_apart_and_the_moon_with_its_planet() {
    let mut loaded = load("two-gases");
    let _ = body_at(&mut loaded, 2.0, "hot[0,0,0]");
    for (lattice, side) in [("hot", -1.0), ("cold", 1.0)] {
        for &id in loaded.names.bodies_of(lattice).expect("a lattice") {
            let x = loaded.world.body(id).expect("a body").position.x;
            assert!(x * side > 0.0, "{lattice}: {x}");
        }
    }
    let mut loaded = load("planets");
    let planet = body_at(&mut loaded, 20.0, "earth").position;
    let moon = body_at(&mut loaded, 20.0, "moon").position;
    assert!(((planet - moon).length() - 0.03).abs() < 0.006, "{}", (planet - moon).length());
}
