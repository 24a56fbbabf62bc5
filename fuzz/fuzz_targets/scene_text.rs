//! Any bytes are a scene or an error with a place in the text; a scene that builds runs.
#![no_main]

use libfuzzer_sys::fuzz_target;
use mrtphys_scene::Scene;

fuzz_target!(|text: &str| {
    match Scene::from_text("fuzz.toml", text) {
        Err(diagnostics) => assert!(!diagnostics.to_string().is_empty()),
        Ok(scene) => {
            if let Ok(mut loaded) = scene.build() {
                if loaded.world.body_count() < 1000 {
                    let _ = loaded.world.step();
                    assert!(!loaded.world.energy().total().is_nan());
                }
            }
        }
    }
});
