//! The pair table against the thesis's algorithm (section 6.5, Fig. 12), and the tables of this crate as they print.

use mrtphys::Error;
use mrtphys::def::ContactMode;
use mrtphys::narrow::kinds::{KindId, Kinds};
use mrtphys::narrow::pair_table::{Hierarchy, PairTable, resolve_two};
use mrtphys::narrow::{Placed, Touches};
use proptest::prelude::*;
use serde_json::Value;

fn cases(mode: &str) -> Vec<Value> {
    let text = include_str!("vectors/dispatch.json");
    let all: Value = serde_json::from_str(text).unwrap();
    let found: Vec<Value> = all["cases"].as_array().unwrap().iter().filter(|c| c["mode"] == mode).cloned().collect();
    assert!(found.len() >= 2, "{mode}");
    found
}

fn int(v: &Value) -> usize {
    v.as_u64().unwrap() as usize
}

fn hierarchy(parents: &Value) -> Hierarchy {
    let mut h = Hierarchy::root();
    for p in &parents.as_array().unwrap()[1..] {
        h.add(int(p)).unwrap();
    }
    h
}

#[test]
fn two_hierarchies_after_each_registration() {
    for case in cases("two_hierarchies") {
        let (a, b) = (hierarchy(&case["parents_a"]), hierarchy(&case["parents_b"]));
        let registrations = case["registrations"].as_array().unwrap();
        let functions: Vec<usize> = registrations.iter().map(|r| int(&r[2])).collect();
        let declared: Vec<(usize, usize)> = registrations.iter().map(|r| (int(&r[0]), int(&r[1]))).collect();
        let tables = case["table_rows_b_cols_a_after_each"].as_array().unwrap();
        assert_eq!(tables.len(), declared.len());
        for (step, table) in tables.iter().enumerate() {
            let ours = resolve_two(&a, &b, &declared[..=step]);
            for i in 0..a.len() {
                for j in 0..b.len() {
                    let function = ours[i][j].map(|w| functions[w.declaration]);
                    let expected = table[j][i].as_u64().map(|f| f as usize);
                    assert_eq!(function, expected, "{} after {step}: (a{i}, b{j})", case["name"]);
                }
            }
        }
    }
}

fn nothing(_: &Placed<'_>, _: &Placed<'_>, _: &mut Touches) {}

fn leaked(name: &str) -> &'static str {
    Box::leak(name.to_owned().into_boxed_str())
}

fn symmetric_table(case: &Value) -> (PairTable, Vec<KindId>) {
    let mut kinds = Kinds::none();
    let mut names = vec!["body".to_owned()];
    for op in case["ops"].as_array().unwrap() {
        if op[0] == "class" {
            let name = format!("kind {}", names.len());
            kinds.add(name.clone(), &names[int(&op[1])]).unwrap();
            names.push(name);
        } else {
            let (a, b) = (&names[int(&op[1])], &names[int(&op[2])]);
            kinds.declare(a, b, leaked(op[3].as_str().unwrap()), nothing).unwrap();
        }
    }
    let ids = names.iter().map(|n| kinds.id(n).unwrap()).collect();
    (kinds.resolve(), ids)
}

/// Ours is the "sound" column. The "printed" one, in which the mirrored entry is never cleared, sends a half-space and a
/// polyhedron to the routine for a half-space and a bounding sphere: ours must differ from it there.
#[test]
fn one_hierarchy_is_sound_and_not_as_printed() {
    for case in cases("symmetric") {
        let (table, ids) = symmetric_table(&case);
        let (mut differs, n) = (0, ids.len());
        assert_eq!(case["lookup"]["sound"].as_array().unwrap().len(), n);
        for i in 0..n {
            for j in 0..n {
                let ours = table.lookup(ids[i], ids[j]);
                let sound = &case["lookup"]["sound"][i][j];
                assert_eq!((ours.name, ours.swapped), (sound[0].as_str().unwrap(), sound[1].as_bool().unwrap()));
                differs += usize::from(case["lookup"]["printed"][i][j] != *sound);
            }
        }
        assert!(differs > 0, "{}", case["name"]);
    }
    let thesis = &cases("symmetric")[0];
    let (table, ids) = symmetric_table(thesis);
    let (half_space, polyhedron) = (ids[1], ids[3]);
    assert_eq!(thesis["lookup"]["printed"][1][3][0], "halfspace_any");
    assert_eq!(table.lookup(half_space, polyhedron).name, "poly_halfspace");
    assert!(table.lookup(half_space, polyhedron).swapped);
}

#[test]
fn the_standard_tables_are_unambiguous() {
    for mode in [ContactMode::Exact, ContactMode::Thesis] {
        assert_eq!(Kinds::standard(mode).resolve().ambiguities(), []);
    }
}

#[test]
fn ties_are_reported_and_the_first_declared_stands() {
    let mut kinds = Kinds::none();
    kinds.add("a", "body").unwrap();
    kinds.add("b", "body").unwrap();
    kinds.declare("a", "body", "a first", nothing).unwrap();
    kinds.declare("b", "body", "b second", nothing).unwrap();
    let table = kinds.resolve();
    let (a, b) = (kinds.id("a").unwrap(), kinds.id("b").unwrap());
    assert_eq!((table.lookup(a, b).name, table.lookup(b, a).name), ("a first", "a first"));
    assert_eq!((table.lookup(a, b).swapped, table.lookup(b, a).swapped), (false, true));
    let [tie] = table.ambiguities() else { panic!("{:?}", table.ambiguities()) };
    assert_eq!(
        (tie.kinds.0.as_str(), tie.kinds.1.as_str(), tie.stands, tie.against),
        ("a", "b", "a first", "b second")
    );
    kinds.declare("b", "a", "settled", nothing).unwrap();
    assert_eq!(kinds.resolve().ambiguities(), []);
    assert!(kinds.resolve().lookup(a, b).swapped);
}

#[test]
fn a_kind_added_outside_falls_back_to_its_nearest_ancestor() {
    let mut kinds = Kinds::standard(ContactMode::Thesis);
    let prism = kinds.add("prism", "polyhedron").unwrap();
    let blob = kinds.add("blob", "body").unwrap();
    kinds.declare("blob", "box", "blob-box", nothing).unwrap();
    let table = kinds.resolve();
    let id = |n: &str| kinds.id(n).unwrap();
    assert_eq!(table.lookup(prism, id("box")).name, "thesis-polyhedron-polyhedron");
    assert_eq!(table.lookup(id("limit-quadrangle"), prism).name, "thesis-polyhedron-half-space");
    assert_eq!(table.lookup(blob, blob).name, "thesis-sphere-sphere");
    assert_eq!(table.lookup(id("box"), blob).name, "blob-box");
    assert!(table.lookup(id("box"), blob).swapped);
    assert_eq!(table.lookup(blob, id("tetrahedron")).name, "thesis-polyhedron-sphere");
    assert_eq!(table.ambiguities(), []);
}

#[test]
fn every_pair_has_an_answer_even_without_any_declaration() {
    let mut kinds = Kinds::none();
    kinds.add("stone", "body").unwrap();
    let table = kinds.resolve();
    let stone = kinds.id("stone").unwrap();
    assert_eq!(table.lookup(stone, stone).name, "sphere-sphere");
    kinds.declare("body", "body", "mine", nothing).unwrap();
    assert_eq!(kinds.resolve().lookup(stone, KindId::BODY).name, "mine");
}

#[test]
fn bad_kinds_are_typed_errors() {
    let mut kinds = Kinds::standard(ContactMode::Exact);
    let unknown = |name: &str| Error::UnknownKind { name: name.into() };
    assert_eq!(kinds.add("x", "nobody"), Err(unknown("nobody")));
    assert_eq!(kinds.add("box", "body"), Err(Error::DuplicateKind { name: "box".into() }));
    assert_eq!(kinds.declare("box", "boks", "r", nothing), Err(unknown("boks")));
    for i in kinds.iter().count()..Kinds::LIMIT {
        kinds.add(format!("kind {i}"), "box").unwrap();
    }
    assert!(matches!(kinds.add("one too many", "body"), Err(Error::LimitExceeded { limit: 256, .. })));
    kinds.resolve();
}

/// The table as printed is a file that a change must change too: `UPDATE_GOLDEN=1 cargo test` writes it anew.
#[test]
fn the_printed_tables_are_golden() {
    for (mode, file) in [(ContactMode::Exact, "pair_table_exact"), (ContactMode::Thesis, "pair_table_thesis")] {
        let path = format!("{}/../../golden/{file}.txt", env!("CARGO_MANIFEST_DIR"));
        let printed = Kinds::standard(mode).resolve().to_string();
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(&path, &printed).unwrap();
        }
        let golden = std::fs::read_to_string(&path).unwrap();
        assert_eq!(printed, golden, "{path}");
    }
}

/// A random tree of some kinds with random declarations.
fn inventory() -> impl Strategy<Value = (Vec<usize>, Vec<(usize, usize)>)> {
    let parents = prop::collection::vec(any::<prop::sample::Index>(), 1..8);
    let declared = prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 0..8);
    (parents, declared).prop_map(|(parents, declared)| {
        let n = parents.len() + 1;
        let parents = parents.iter().enumerate().map(|(i, p)| p.index(i + 1)).collect();
        (parents, declared.iter().map(|(a, b)| (a.index(n), b.index(n))).collect())
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// The order of a pair only decides who is swapped; an answer is for ancestors; nothing that covers the pair is nearer in
    /// both kinds; where a declaration is nearer in one, the tie is reported.
    #[test]
    fn any_table_is_consistent((parents, declared) in inventory()) {
        let name = |i: usize| if i == 0 { "body".to_owned() } else { format!("kind {i}") };
        let mut kinds = Kinds::none();
        let mut tree = Hierarchy::root();
        for (i, &p) in parents.iter().enumerate() {
            kinds.add(name(i + 1), &name(p)).unwrap();
            tree.add(p).unwrap();
        }
        let routines: Vec<&'static str> = (0..declared.len()).map(|k| ROUTINES[k]).collect();
        for (k, &(a, b)) in declared.iter().enumerate() {
            kinds.declare(&name(a), &name(b), routines[k], nothing).unwrap();
        }
        let table = kinds.resolve();
        let all: Vec<(KindId, String)> = kinds.iter().map(|(id, n)| (id, n.to_owned())).collect();
        let of = |r: &str| routines.iter().position(|&n| n == r).map_or((0, 0), |k| declared[k]);
        for (a, (ida, _)) in all.iter().enumerate() {
            for (b, (idb, _)) in all.iter().enumerate() {
                let (one, other) = (table.lookup(*ida, *idb), table.lookup(*idb, *ida));
                prop_assert_eq!(one.name, other.name);
                let near = |(i, j): (usize, usize)| Some((tree.distance(a, i)?, tree.distance(b, j)?));
                let ways = |(i, j): (usize, usize)| -> Vec<(u32, u32)> {
                    [near((i, j)), near((j, i))].into_iter().flatten().collect()
                };
                let (i, j) = of(one.name);
                let as_called = near(if one.swapped { (j, i) } else { (i, j) });
                prop_assert!(as_called.is_some(), "{} does not cover ({}, {})", one.name, a, b);
                let stands = ways((i, j));
                let reported = |r: &str| table.ambiguities().iter().any(|t| {
                    t.against == r && t.kinds == (all[a.min(b)].1.clone(), all[a.max(b)].1.clone())
                });
                for (k, &d) in declared.iter().enumerate().filter(|&(k, _)| routines[k] != one.name) {
                    let covers = ways(d);
                    let as_near = |n: &(u32, u32), s: &(u32, u32)| n.0 <= s.0 && n.1 <= s.1;
                    let better = stands.iter().all(|s| covers.iter().any(|n| as_near(n, s) && n != s));
                    prop_assert!(!better, "({}, {}): {}", a, b, routines[k]);
                    let beaten = covers.iter().any(|n| stands.iter().any(|s| as_near(s, n)));
                    let tie = !covers.is_empty() && !beaten;
                    prop_assert_eq!(tie, reported(routines[k]), "({}, {}): {}", a, b, routines[k]);
                }
            }
        }
    }
}

const ROUTINES: [&str; 8] = ["r0", "r1", "r2", "r3", "r4", "r5", "r6", "r7"];
