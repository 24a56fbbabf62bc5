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
            assert!((body.velocity.length() - 1.0).abs() < 1e-15);
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
