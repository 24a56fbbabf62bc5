//! Force and flow fields of a scene, changed by hand: in the world and in the scene's description alike.

use mrtphys::field::Scope;
use mrtphys::{FieldId, Real, Vec3};
use mrtphys_scene::Loaded;
use mrtphys_scene::scene::{FlowFieldDesc, FlowKind, ForceFieldDesc, ForceKind, ScopeDesc};

/// Standard gravity \[m/s2\].
pub const STANDARD: Real = mrtphys::field::EarthGravity::STANDARD;

/// A force field or a flow field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Field {
    /// a field of acceleration
    Force(ForceKind),
    /// a motion of the medium
    Flow(FlowKind),
}

impl Field {
    /// Its name in the scene language.
    pub fn name(&self) -> &'static str {
        match self {
            Field::Force(ForceKind::EarthGravity { .. }) => "earth gravity",
            Field::Force(ForceKind::Uniform { .. }) => "uniform force",
            Field::Force(ForceKind::Point { .. }) => "point force",
            Field::Force(ForceKind::Vortex { .. }) => "vortex force",
            Field::Flow(FlowKind::Uniform { .. }) => "uniform flow",
            Field::Flow(FlowKind::Vortex { .. }) => "vortex flow",
            Field::Flow(FlowKind::Sink { .. }) => "sink flow",
        }
    }

    /// What can be added, about this point of a scene of this size \[m\].
    pub fn choices(at: Vec3, size: Real) -> [Field; 6] {
        let g = STANDARD;
        // Strengths with which the field is felt at the edge of the scene as gravity is, or a speed that crosses it in a second.
        [
            Field::Force(ForceKind::Uniform { acceleration: Vec3::X * g }),
            Field::Force(ForceKind::Point { position: at, strength: g * size * size, exponent: 2 }),
            Field::Force(ForceKind::Vortex { point: at, axis: Vec3::Y, strength: g * size }),
            Field::Flow(FlowKind::Uniform { velocity: Vec3::X * size }),
            Field::Flow(FlowKind::Vortex { point: at, axis: Vec3::Y, circulation: size * size }),
            Field::Flow(FlowKind::Sink { point: at, strength: size * size * size }),
        ]
    }
}

/// A field of the scene, and what it acts on.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// what it is
    pub field: Field,
    /// its number among the force fields, or among the flow fields
    pub number: usize,
    /// what carries it and what it acts on
    pub scope: ScopeDesc,
}

/// All fields: forces first.
pub fn all(loaded: &Loaded) -> Vec<Placed> {
    let scene = &loaded.scene;
    let forces = scene.force_fields.iter().enumerate();
    let forces = forces.map(|(number, f)| Placed { field: Field::Force(f.kind), number, scope: f.scope.clone() });
    let flows = scene.flow_fields.iter().enumerate();
    let flows = flows.map(|(number, f)| Placed { field: Field::Flow(f.kind), number, scope: f.scope.clone() });
    forces.chain(flows).collect()
}

/// Replaces a field.
///
/// # Errors
/// A value is not finite or out of range, or there is no such field.
pub fn set(loaded: &mut Loaded, number: usize, field: Field) -> Result<(), String> {
    let id = id_of(loaded, number, &field)?;
    match field {
        Field::Force(kind) => {
            let built = kind.build().map_err(plain)?;
            loaded.world.set_force(id, built).map_err(plain)?;
            loaded.scene.force_fields[number].kind = kind;
        }
        Field::Flow(kind) => {
            let built = kind.build().map_err(plain)?;
            loaded.world.set_flow(id, built).map_err(plain)?;
            loaded.scene.flow_fields[number].kind = kind;
        }
    }
    Ok(())
}

/// Adds a field that stands still and acts on everything.
///
/// # Errors
/// A value is not finite or out of range.
pub fn add(loaded: &mut Loaded, field: Field) -> Result<(), String> {
    let scope = ScopeDesc { reaction: true, ..ScopeDesc::default() };
    match field {
        Field::Force(kind) => {
            loaded.world.add_force(kind.build().map_err(plain)?, Scope::default()).map_err(plain)?;
            loaded.scene.force_fields.push(ForceFieldDesc { kind, scope });
        }
        Field::Flow(kind) => {
            loaded.world.add_flow(kind.build().map_err(plain)?, Scope::default()).map_err(plain)?;
            loaded.scene.flow_fields.push(FlowFieldDesc { kind, scope });
        }
    }
    Ok(())
}

/// Removes a field.
///
/// # Errors
/// There is no such field.
pub fn remove(loaded: &mut Loaded, number: usize, field: &Field) -> Result<(), String> {
    let id = id_of(loaded, number, field)?;
    match field {
        Field::Force(_) => {
            loaded.world.remove_force(id).map_err(plain)?;
            loaded.scene.force_fields.remove(number);
        }
        Field::Flow(_) => {
            loaded.world.remove_flow(id).map_err(plain)?;
            loaded.scene.flow_fields.remove(number);
        }
    }
    Ok(())
}

/// Gives the scene this gravity \[m/s2\]: that of its first uniform field that acts on everything; where there is none, one is
/// added.
///
/// # Errors
/// It is not finite.
pub fn set_gravity(loaded: &mut Loaded, gravity: Vec3) -> Result<(), String> {
    let everywhere = |f: &ForceFieldDesc| f.scope.carrier.is_none() && f.scope.only.is_none();
    let uniform = |k: &ForceKind| matches!(k, ForceKind::EarthGravity { .. } | ForceKind::Uniform { .. });
    let place = loaded.scene.force_fields.iter().position(|f| uniform(&f.kind) && everywhere(f));
    let kind = match place.map(|i| loaded.scene.force_fields[i].kind) {
        Some(ForceKind::Uniform { .. }) => ForceKind::Uniform { acceleration: gravity },
        Some(ForceKind::EarthGravity { direction, .. }) => earth(gravity, direction),
        _ => earth(gravity, Vec3::Y * -1.0),
    };
    match place {
        Some(number) => set(loaded, number, Field::Force(kind)),
        None => add(loaded, Field::Force(kind)),
    }
}

/// Earth gravity; zero keeps its direction.
fn earth(gravity: Vec3, before: Vec3) -> ForceKind {
    match gravity.try_normalize() {
        Some(direction) => ForceKind::EarthGravity { g: gravity.length(), direction },
        None => ForceKind::EarthGravity { g: gravity.length(), direction: before },
    }
}

/// The world's handle of a field of the scene: both keep the same order.
pub fn id_of(loaded: &Loaded, number: usize, field: &Field) -> Result<FieldId, String> {
    let id = match field {
        Field::Force(_) => loaded.world.force_ids().nth(number),
        Field::Flow(_) => loaded.world.flow_ids().nth(number),
    };
    id.ok_or_else(|| "this field is there no more".into())
}

/// In words.
pub fn plain(e: mrtphys::Error) -> String {
    e.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys_scene::{Scene, to_toml};

    fn loaded(text: &str) -> Loaded {
        let body = "[[body]]\nname = \"ball\"\nshape = { kind = \"sphere\", radius = 0.5 }\nposition = [0, 3, 0]\n";
        Scene::from_text("test", &format!("format = 1\n{text}{body}")).unwrap().build().unwrap()
    }

    fn speed_after_a_second(loaded: &mut Loaded) -> Vec3 {
        let id = loaded.names.body("ball").unwrap();
        (0..480).for_each(|_| loaded.world.step().unwrap());
        loaded.world.body(id).unwrap().velocity
    }

    #[test]
    fn gravity_is_set_turned_and_switched_off() {
        for text in [
            "",
            "[[force_field]]\nkind = \"earth-gravity\"\n",
            "[[force_field]]\nkind = \"uniform\"\nacceleration = [1, 0, 0]\n",
        ] {
            let mut l = loaded(text);
            set_gravity(&mut l, Vec3::new(0.0, -1.62, 0.0)).unwrap();
            assert_eq!(l.world.forces().len(), 1);
            let v = speed_after_a_second(&mut l);
            assert!((v - Vec3::Y * -1.62).length() < 1e-9, "{text}: {v:?}");
            set_gravity(&mut l, Vec3::ZERO).unwrap();
            assert!((speed_after_a_second(&mut l) - v).length() < 1e-12);
            set_gravity(&mut l, Vec3::X * 2.0).unwrap();
            assert!((speed_after_a_second(&mut l) - v - Vec3::X * 2.0).length() < 1e-9);
            assert!(set_gravity(&mut l, Vec3::splat(Real::NAN)).is_err());
        }
    }

    #[test]
    fn gravity_of_some_bodies_is_not_the_scene_s() {
        let mut l = loaded("[[force_field]]\nkind = \"uniform\"\nacceleration = [1, 0, 0]\nonly = [\"ball\"]\n");
        set_gravity(&mut l, Vec3::Y * -2.0).unwrap();
        assert_eq!(l.world.forces().len(), 2);
        assert!((speed_after_a_second(&mut l) - Vec3::new(1.0, -2.0, 0.0)).length() < 1e-9);
        assert_eq!(all(&l)[0].scope.only, Some(vec!["ball".to_string()]));
    }

    #[test]
    fn every_field_can_be_added_changed_and_removed_and_is_saved() {
        let choices = Field::choices(Vec3::new(5.0, 0.0, 0.0), 4.0);
        let mut l = loaded("");
        for field in choices {
            add(&mut l, field).unwrap();
        }
        let there: Vec<Field> = all(&l).iter().map(|p| p.field).collect();
        assert_eq!(there, choices);
        let text = to_toml(&l).unwrap();
        let again = Scene::from_text("again", &text).unwrap().build().unwrap();
        assert_eq!(all(&again).iter().map(|p| p.field).collect::<Vec<_>>(), choices);
        set(&mut l, 0, Field::Force(ForceKind::Uniform { acceleration: Vec3::Z })).unwrap();
        assert!(
            set(&mut l, 1, Field::Force(ForceKind::Point { position: Vec3::ZERO, strength: 1.0, exponent: 99 }))
                .is_err()
        );
        assert_eq!(all(&l)[1].field, choices[1], "what is refused changes nothing");
        for placed in all(&l).into_iter().rev() {
            remove(&mut l, placed.number, &placed.field).unwrap();
            assert!(remove(&mut l, placed.number, &placed.field).is_err());
        }
        assert!(l.world.forces().is_empty() && l.world.flows().is_empty());
        assert_eq!(speed_after_a_second(&mut l), Vec3::ZERO);
    }
}
