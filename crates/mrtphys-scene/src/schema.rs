//! The JSON schema of the scene format (draft 2020-12), written from the same table of keys that reading checks against.
//! It describes the TOML document as the JSON document with the same tables and values.

use crate::format::keys::{Case, Key, Kind, Range, Table};
use crate::format::tables;
use serde_json::{Map, Value, json};

/// The JSON schema of the scene format.
pub fn schema() -> Value {
    let mut definitions = Map::new();
    let mut root = object_of(&tables::SCENE, &mut definitions);
    root.insert("$schema".into(), json!("https://json-schema.org/draft/2020-12/schema"));
    root.insert("title".into(), json!("mrtphys scene, format 1"));
    root.insert("$defs".into(), Value::Object(definitions));
    Value::Object(root)
}

/// A reference to a table's definition, which is written when it is first needed.
fn reference(table: &'static Table, definitions: &mut Map<String, Value>) -> Value {
    let name = table.name.replace(' ', "_");
    if !definitions.contains_key(&name) {
        definitions.insert(name.clone(), Value::Null);
        let object = object_of(table, definitions);
        definitions.insert(name.clone(), Value::Object(object));
    }
    json!({ "$ref": format!("#/$defs/{name}") })
}

fn object_of(table: &'static Table, definitions: &mut Map<String, Value>) -> Map<String, Value> {
    if table.cases.is_empty() {
        let mut object = properties(table, None, definitions);
        object.insert("description".into(), json!(table.doc));
        return object;
    }
    let cases: Vec<Value> =
        table.cases.iter().map(|c| Value::Object(properties(table, Some(c), definitions))).collect();
    let mut object = Map::new();
    object.insert("description".into(), json!(table.doc));
    object.insert("oneOf".into(), Value::Array(cases));
    object
}

fn properties(
    table: &'static Table,
    case: Option<&'static Case>,
    definitions: &mut Map<String, Value>,
) -> Map<String, Value> {
    let (mut all, mut required) = (Map::new(), Vec::new());
    if let Some(case) = case {
        all.insert("kind".into(), json!({ "const": case.name, "description": case.doc }));
        if table.default_case != Some(case.name) {
            required.push("kind");
        }
    }
    for key in table.keys_with(case) {
        all.insert(key.name.into(), value_of(key, definitions));
        if key.required {
            required.push(key.name);
        }
    }
    let mut rules: Vec<Value> = table.at_most_one.iter().map(|set| json!({ "not": { "required": set } })).collect();
    if let Some(set) = case.map(|c| c.exactly_one).filter(|set| !set.is_empty()) {
        let one: Vec<Value> = set.iter().map(|k| json!({ "required": [k] })).collect();
        rules.push(json!({ "oneOf": one }));
    }
    let mut object = Map::new();
    object.insert("type".into(), json!("object"));
    object.insert("properties".into(), Value::Object(all));
    object.insert("additionalProperties".into(), json!(false));
    if !required.is_empty() {
        object.insert("required".into(), json!(required));
    }
    if !rules.is_empty() {
        object.insert("allOf".into(), Value::Array(rules));
    }
    object
}

fn value_of(key: &'static Key, definitions: &mut Map<String, Value>) -> Value {
    let mut value = kind_of(&key.kind, definitions);
    if let Some(object) = value.as_object_mut() {
        object.insert("description".into(), json!(key.doc));
        if let Some(default) = key.default.and_then(default_value) {
            object.insert("default".into(), default);
        }
    }
    value
}

fn list(items: Value, least: usize, most: Option<usize>) -> Value {
    let mut list = json!({ "type": "array", "items": items, "minItems": least });
    if let (Some(most), Some(object)) = (most, list.as_object_mut()) {
        object.insert("maxItems".into(), json!(most));
    }
    list
}

fn number(range: &Range) -> Value {
    json!({ "type": "number", "minimum": range.low, "maximum": range.high })
}

fn kind_of(kind: &Kind, definitions: &mut Map<String, Value>) -> Value {
    let any = || json!({ "type": "number" });
    let name = || json!({ "type": "string", "minLength": 1, "maxLength": 256 });
    match kind {
        Kind::Text | Kind::File => json!({ "type": "string" }),
        Kind::Name => name(),
        Kind::Color => json!({ "type": "string", "pattern": "^#[0-9a-fA-F]{6}$" }),
        Kind::Bool => json!({ "type": "boolean" }),
        Kind::Integer { low, high } => json!({ "type": "integer", "minimum": low, "maximum": high }),
        Kind::Number(range) => number(range),
        Kind::Vector(range) => list(number(range), 3, Some(3)),
        Kind::Direction => list(any(), 3, Some(3)),
        Kind::Quaternion => list(any(), 4, Some(4)),
        Kind::Points { least, most } => list(list(any(), 3, Some(3)), *least, Some(*most)),
        Kind::Faces => list(list(json!({ "type": "integer", "minimum": 0 }), 3, None), 0, None),
        Kind::Names => list(name(), 0, None),
        Kind::Counts => list(json!({ "type": "integer", "minimum": 1 }), 3, Some(3)),
        Kind::Choice { names, .. } => json!({ "enum": names() }),
        Kind::BroadPhase => json!({
            "type": "string",
            "pattern": "^(brute-force|sorted-grid|regular-grid(:[0-9]+)?|adaptive-tree(:[0-9]+(:[0-9]+)?)?)$",
        }),
        Kind::Table(of) => reference(of, definitions),
        Kind::Tables { of, least } => list(reference(of, definitions), *least, None),
        Kind::Map(of) => json!({ "type": "object", "additionalProperties": reference(of, definitions) }),
    }
}

/// A default's TOML text as JSON: those of the table are truth values, numbers, strings and lists of numbers, which JSON
/// writes in the same way.
fn default_value(text: &str) -> Option<Value> {
    serde_json::from_str(text).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn each_table(table: &'static Table, seen: &mut Vec<&'static str>, call: &mut dyn FnMut(&'static Table)) {
        if seen.contains(&table.name) {
            return;
        }
        seen.push(table.name);
        call(table);
        let keys = table.keys_with(None).chain(table.cases.iter().flat_map(|c| c.keys));
        for key in keys {
            if let Kind::Table(of) | Kind::Tables { of, .. } | Kind::Map(of) = key.kind {
                each_table(of, seen, call);
            }
        }
    }

    #[test]
    fn every_default_is_json_and_a_value_that_reading_accepts() {
        let mut defaults = 0;
        each_table(&tables::SCENE, &mut Vec::new(), &mut |table| {
            for key in table.keys_with(None).chain(table.cases.iter().flat_map(|c| c.keys)) {
                let Some(text) = key.default else { continue };
                defaults += 1;
                assert!(default_value(text).is_some(), "{}.{}", table.name, key.name);
                let document = format!("{} = {text}", key.name);
                let root = toml::de::DeTable::parse(&document).expect("TOML");
                let mut found = crate::format::read::Findings::default();
                let value = root.get_ref().get(key.name).expect("the key");
                crate::format::read::check_value(key, value.get_ref(), &mut found).expect("accepted");
                assert!(found.list.is_empty());
            }
        });
        assert!(defaults > 40);
    }

    #[test]
    fn names_of_keys_are_unique_and_exclusive_sets_name_keys() {
        each_table(&tables::SCENE, &mut Vec::new(), &mut |table| {
            let cases: Vec<Option<&'static Case>> = match table.cases {
                [] => vec![None],
                cases => cases.iter().map(Some).collect(),
            };
            for case in cases {
                let mut names: Vec<&str> = table.keys_with(case).map(|k| k.name).collect();
                let sets = table.at_most_one.iter().copied().chain(case.map(|c| c.exactly_one));
                sets.flatten().for_each(|k| assert!(names.contains(k), "{}: {k}", table.name));
                let count = names.len();
                names.sort_unstable();
                names.dedup();
                assert_eq!(names.len(), count, "{}", table.name);
            }
        });
    }
}
