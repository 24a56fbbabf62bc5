//! Fields of a scene, put into its world.

use crate::format::read::{self, Findings};
use crate::names::Names;
use crate::scene::{FlowKind, ForceKind, Scene, ScopeDesc};
use mrtphys::error::Error;
use mrtphys::field::{
    EarthGravity, FlowField, ForceField, PointField, Scope, SinkFlow, UniformField, UniformFlow, VortexField,
    VortexFlow,
};
use mrtphys::math::Vec3;
use mrtphys::world::World;
use std::sync::Arc;

/// Adds all fields of the scene.
pub(crate) fn add_all(scene: &Scene, names: &Names, world: &mut World, found: &mut Findings) {
    for (i, f) in scene.force_fields.iter().enumerate() {
        let object = format!("force_field {i}");
        let Some(scope) = scope(&object, &f.scope, (scene, names), found) else { continue };
        let added = f.kind.build().and_then(|field| world.add_force(field, scope));
        if let Err(e) = added {
            found.push(f.scope.span, format!("{object}: {e}"));
        }
    }
    for (i, f) in scene.flow_fields.iter().enumerate() {
        let object = format!("flow_field {i}");
        let Some(scope) = scope(&object, &f.scope, (scene, names), found) else { continue };
        let added = f.kind.build().and_then(|field| world.add_flow(field, scope));
        if let Err(e) = added {
            found.push(f.scope.span, format!("{object}: {e}"));
        }
    }
}

/// The bodies that a field's names stand for.
fn scope(object: &str, desc: &ScopeDesc, (scene, names): (&Scene, &Names), found: &mut Findings) -> Option<Scope> {
    let mut scope = Scope { without_reaction: !desc.reaction, ..Scope::default() };
    let mut good = true;
    if let Some(name) = &desc.carrier {
        scope.carrier = names.body(name);
        if scope.carrier.is_none() {
            found.push(desc.span, format!("{object}: body: there is no body '{name}'{}", tip(name, scene)));
            good = false;
        }
    }
    if let Some(only) = &desc.only {
        let mut bodies = Vec::new();
        for name in only {
            match names.bodies_of(name) {
                Some(ids) => bodies.extend_from_slice(ids),
                None => {
                    let tip = tip(name, scene);
                    let what = format!("{object}: only: there is no body, lattice or body table '{name}'{tip}");
                    found.push(desc.span, what);
                    good = false;
                }
            }
        }
        bodies.sort_unstable();
        bodies.dedup();
        scope.only = Some(bodies);
    }
    good.then_some(scope)
}

/// The body, lattice or table that was probably meant.
fn tip(name: &str, scene: &Scene) -> String {
    // Nobody reads through a million names to find a slip of the finger.
    let known: Vec<&str> = scene.contents.iter().take(MOST_COMPARED).map(|c| c.name()).collect();
    read::tip(name, &known)
}

/// How many names are looked at for a suggestion.
const MOST_COMPARED: usize = 10_000;

impl ForceKind {
    /// The field.
    ///
    /// # Errors
    /// A value is not finite or out of range.
    pub fn build(&self) -> Result<Arc<dyn ForceField>, Error> {
        Ok(match *self {
            ForceKind::EarthGravity { g, direction } if direction == Vec3::new(0.0, -1.0, 0.0) => {
                Arc::new(EarthGravity::new(g)?)
            }
            ForceKind::EarthGravity { g, direction } => {
                Arc::new(UniformField::new(direction.try_normalize().unwrap_or(Vec3::ZERO) * g)?)
            }
            ForceKind::Uniform { acceleration } => Arc::new(UniformField::new(acceleration)?),
            ForceKind::Point { position, strength, exponent } => {
                Arc::new(PointField::new(position, strength, exponent)?)
            }
            ForceKind::Vortex { point, axis, strength } => Arc::new(VortexField::new(point, axis, strength)?),
        })
    }
}

impl FlowKind {
    /// The field.
    ///
    /// # Errors
    /// A value is not finite or out of range.
    pub fn build(&self) -> Result<Arc<dyn FlowField>, Error> {
        Ok(match *self {
            FlowKind::Uniform { velocity } => Arc::new(UniformFlow::new(velocity)?),
            FlowKind::Vortex { point, axis, circulation } => Arc::new(VortexFlow::new(point, axis, circulation)?),
            FlowKind::Sink { point, strength } => Arc::new(SinkFlow::new(point, strength)?),
        })
    }
}
