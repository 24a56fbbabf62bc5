//! What carries a field and what it acts on, changed by hand: in the world and in the scene's description alike.

use super::fields::{Field, Placed, id_of, plain};
use crate::events::split_names;
use crate::testbed::window::desk::Desk;
use eframe::egui;
use mrtphys::World;
use mrtphys::field::Scope;
use mrtphys_scene::Loaded;
use mrtphys_scene::scene::ScopeDesc;

/// Gives a field another scope. It keeps its place among the fields.
///
/// # Errors
/// There is no such field, or nothing of such a name.
pub fn set(loaded: &mut Loaded, number: usize, field: &Field, desc: &ScopeDesc) -> Result<(), String> {
    let id = id_of(loaded, number, field)?;
    let scope = built(loaded, desc)?;
    let world = &mut loaded.world;
    // The world has no field of another scope: it is made anew, and after it those that follow, so that the order stays.
    match field {
        Field::Force(_) => {
            let old = world.forces().get(number..).ok_or("this field is there no more")?.to_vec();
            check(world, old[1..].iter().map(|f| &f.scope))?;
            world.add_force(old[0].field.clone(), scope).map_err(plain)?;
            world.remove_force(id).map_err(plain)?;
            for f in &old[1..] {
                let first = world.force_ids().nth(number).ok_or("this field is there no more")?;
                world.add_force(f.field.clone(), f.scope.clone()).map_err(plain)?;
                world.remove_force(first).map_err(plain)?;
            }
            loaded.scene.force_fields[number].scope = desc.clone();
        }
        Field::Flow(_) => {
            let old = world.flows().get(number..).ok_or("this field is there no more")?.to_vec();
            check(world, old[1..].iter().map(|f| &f.scope))?;
            world.add_flow(old[0].field.clone(), scope).map_err(plain)?;
            world.remove_flow(id).map_err(plain)?;
            for f in &old[1..] {
                let first = world.flow_ids().nth(number).ok_or("this field is there no more")?;
                world.add_flow(f.field.clone(), f.scope.clone()).map_err(plain)?;
                world.remove_flow(first).map_err(plain)?;
            }
            loaded.scene.flow_fields[number].scope = desc.clone();
        }
    }
    Ok(())
}

/// Whether fields of these scopes can be made again.
fn check<'a>(world: &World, mut scopes: impl Iterator<Item = &'a Scope>) -> Result<(), String> {
    let is_there = |s: &Scope| s.carrier.iter().chain(s.only.iter().flatten()).all(|&id| world.body(id).is_ok());
    if scopes.all(is_there) {
        Ok(())
    } else {
        Err("a field below this one names a body that is there no more: change that one first".into())
    }
}

/// The bodies that the names stand for, as far as they are still there.
fn built(loaded: &Loaded, desc: &ScopeDesc) -> Result<Scope, String> {
    let is_there = |id: &mrtphys::BodyId| loaded.world.body(*id).is_ok();
    let carrier = match &desc.carrier {
        None => None,
        Some(name) => {
            let id = loaded.names.body(name).filter(is_there);
            Some(id.ok_or_else(|| format!("there is no body '{name}'"))?)
        }
    };
    let only = desc.only.as_ref().map(|list| {
        let mut bodies = Vec::new();
        for name in list {
            let ids = loaded.names.bodies_of(name);
            let ids = ids.ok_or_else(|| format!("there is no body, lattice or body table '{name}'"))?;
            bodies.extend(ids.iter().copied().filter(is_there));
        }
        bodies.sort_unstable();
        bodies.dedup();
        Ok::<_, String>(bodies)
    });
    Ok(Scope { carrier, only: only.transpose()?, without_reaction: !desc.reaction })
}

/// Shows what carries a field and what it acts on; the new scope, if it was changed.
pub fn show(ui: &mut egui::Ui, desk: &mut Desk, placed: &Placed) -> Option<ScopeDesc> {
    let mut new = placed.scope.clone();
    let mut changed = false;
    ui.horizontal(|ui| {
        ui.label("acts on");
        let hint = "names of bodies, lattices and body tables, separated by commas; nothing: everything";
        let shown = placed.scope.only.as_ref().map_or(String::new(), |only| only.join(", "));
        let (response, text) = line(ui, "only", &shown, "everything", hint);
        desk.probes.mark(&format!("{}.only", placed.field.name()), &response);
        if let Some(text) = text {
            let list: Vec<String> = split_names(&text).into_iter().map(String::from).collect();
            (new.only, changed) = ((!list.is_empty()).then_some(list), true);
        }
    });
    ui.horizontal(|ui| {
        ui.label("carried by");
        let hint = "name of the body that carries the field, so that its points are relative to that; nothing: it stands still";
        let shown = placed.scope.carrier.clone().unwrap_or_default();
        let (_, text) = line(ui, "carrier", &shown, "nothing", hint);
        if let Some(text) = text {
            let name = text.trim().to_string();
            (new.carrier, changed) = ((!name.is_empty()).then_some(name), true);
        }
    });
    if placed.scope.carrier.is_some() && matches!(placed.field, Field::Force(_)) {
        let hint = "the field acts back on the body that carries it";
        changed |= ui.checkbox(&mut new.reaction, "acts back on its carrier").on_hover_text(hint).changed();
    }
    (changed && new != placed.scope).then_some(new)
}

/// A line of text that holds from Enter on; the new text, if it was changed. Escape leaves it as it was.
fn line(ui: &mut egui::Ui, salt: &str, shown: &str, empty: &str, hint: &str) -> (egui::Response, Option<String>) {
    let id = ui.scope_id().with(salt);
    let mut text = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| shown.into());
    let edit = egui::TextEdit::singleline(&mut text).id(id.with("text")).hint_text(empty);
    let response = ui.add(edit.desired_width(ui.available_width())).on_hover_text(hint);
    let mut entered = None;
    if response.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id));
        entered = (text != shown && !ui.input(|i| i.key_pressed(egui::Key::Escape))).then_some(text);
    } else if response.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, text));
    }
    (response, entered)
}

#[cfg(test)]
mod tests {
    use super::super::fields::all;
    use super::*;
    use mrtphys_scene::{Scene, to_toml};

    const TEXT: &str = "format = 1\n[[force_field]]\nkind = \"uniform\"\nacceleration = [1, 0, 0]\n\
        [[force_field]]\nkind = \"uniform\"\nacceleration = [0, 2, 0]\nonly = [\"b\"]\n\
        [[flow_field]]\nkind = \"uniform\"\nvelocity = [1, 0, 0]\n\
        [[body]]\nname = \"a\"\nshape = { kind = \"sphere\", radius = 0.5 }\n\
        [[body]]\nname = \"b\"\nshape = { kind = \"sphere\", radius = 0.5 }\nposition = [0, 0, 9]\n";

    fn only(list: &[&str]) -> ScopeDesc {
        let only = (!list.is_empty()).then(|| list.iter().map(|s| s.to_string()).collect());
        ScopeDesc { only, reaction: true, ..ScopeDesc::default() }
    }

    #[test]
    fn a_field_acts_on_what_was_named_and_keeps_its_place() {
        let mut l = Scene::from_text("test", TEXT).unwrap().build().unwrap();
        let fields = all(&l);
        set(&mut l, 0, &fields[0].field, &only(&["b", "a", "b"])).unwrap();
        set(&mut l, 0, &fields[0].field, &only(&["a"])).unwrap();
        set(&mut l, 0, &fields[2].field, &only(&["b"])).unwrap();
        let now = all(&l);
        assert_eq!(now.iter().map(|p| p.field).collect::<Vec<_>>(), fields.iter().map(|p| p.field).collect::<Vec<_>>());
        assert_eq!(now[0].scope.only, Some(vec!["a".to_string()]));
        assert!(l.world.ledger().user.abs() == 0.0, "nothing has lived yet");
        (0..480).for_each(|_| l.world.step().unwrap());
        let v = |l: &Loaded, name| l.world.body(l.names.body(name).unwrap()).unwrap().velocity.to_array();
        let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
        assert!(near(v(&l, "a"), [1.0, 0.0, 0.0]), "{:?}", v(&l, "a"));
        assert!(near(v(&l, "b"), [0.0, 2.0, 0.0]), "{:?}", v(&l, "b"));
        let again = Scene::from_text("again", &to_toml(&l).unwrap()).unwrap().build().unwrap();
        assert_eq!(all(&again)[0].scope.only, now[0].scope.only);
    }

    #[test]
    fn what_does_not_exist_is_said_and_changes_nothing() {
        let mut l = Scene::from_text("test", TEXT).unwrap().build().unwrap();
        let fields = all(&l);
        let why = set(&mut l, 0, &fields[0].field, &only(&["c"])).unwrap_err();
        assert!(why.contains("'c'"), "{why}");
        let carried = ScopeDesc { carrier: Some("nobody".into()), ..only(&[]) };
        assert!(set(&mut l, 0, &fields[0].field, &carried).unwrap_err().contains("'nobody'"));
        assert!(set(&mut l, 7, &fields[0].field, &only(&[])).is_err());
        // A body that has gone: its field cannot be made again, that of others can.
        let b = l.names.body("b").unwrap();
        l.world.remove_body(b).unwrap();
        assert!(set(&mut l, 0, &fields[0].field, &only(&["a"])).unwrap_err().contains("no more"));
        set(&mut l, 1, &fields[1].field, &only(&["a"])).unwrap();
        set(&mut l, 0, &fields[0].field, &only(&["a"])).unwrap();
    }
}
