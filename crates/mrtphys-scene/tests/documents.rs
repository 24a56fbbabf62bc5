//! The schema and the manual say what the code does.

use mrtphys_scene::schema;
use serde_json::Value;

fn root() -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// `MRTPHYS_BLESS=1 cargo test` writes the file anew.
#[test]
fn the_schema_is_the_golden_one() {
    let path = root().join("golden/scene.schema.json");
    let text = serde_json::to_string_pretty(&sorted(schema())).expect("JSON") + "\n";
    if std::env::var_os("MRTPHYS_BLESS").is_some() {
        std::fs::write(&path, &text).expect("written");
    }
    let golden = std::fs::read_to_string(&path).expect("golden/scene.schema.json").replace("\r\n", "\n");
    assert!(golden == text, "golden/scene.schema.json is not what schema() gives; MRTPHYS_BLESS=1 writes it anew");
}

/// With the keys of every object in order. Left alone, their order depends on which other packages are built along with
/// this one (serde_json's `preserve_order`).
fn sorted(value: Value) -> Value {
    match value {
        Value::Object(o) => {
            let mut members: Vec<(String, Value)> = o.into_iter().map(|(k, v)| (k, sorted(v))).collect();
            members.sort_by(|a, b| a.0.cmp(&b.0));
            Value::Object(members.into_iter().collect())
        }
        Value::Array(a) => Value::Array(a.into_iter().map(sorted).collect()),
        other => other,
    }
}

fn each_key(value: &Value, call: &mut impl FnMut(&str)) {
    match value {
        Value::Object(o) => {
            if let Some(Value::Object(properties)) = o.get("properties") {
                properties.keys().for_each(|k| call(k));
            }
            o.values().for_each(|v| each_key(v, call));
        }
        Value::Array(a) => a.iter().for_each(|v| each_key(v, call)),
        _ => {}
    }
}

#[test]
fn every_key_is_in_the_manual() {
    let manual = std::fs::read_to_string(root().join("docs/manual/scene-language.md")).expect("the manual");
    let mut keys = 0;
    each_key(&schema(), &mut |key| {
        keys += 1;
        assert!(manual.contains(&format!("`{key}`")), "docs/manual/scene-language.md does not explain `{key}`");
    });
    assert!(keys > 100, "{keys}");
}

/// The examples of the manual are scenes.
#[test]
fn the_examples_of_the_manual_are_read_and_built() {
    let manual = std::fs::read_to_string(root().join("docs/manual/scene-language.md")).expect("the manual");
    let mut examples = 0;
    for block in manual.split("```toml\n").skip(1) {
        let text = block.split("```").next().unwrap_or_default();
        mrtphys_scene::Scene::from_text("manual", text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"));
        examples += 1;
    }
    assert!(examples >= 2);
}
