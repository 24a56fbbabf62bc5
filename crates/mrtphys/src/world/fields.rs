//! Force fields and flow fields of a world.

use super::World;
use super::ids::IdTable;
use crate::error::{Error, Result};
use crate::field::{FlowField, ForceField, PlacedFlow, PlacedForce, Reach, Scope};
use crate::id::FieldId;
use crate::model::Model;
use std::sync::Arc;

/// Names fields for ever: a number is never used again, so that the handle of a field that was removed is an error.
#[derive(Clone, Debug, Default)]
pub(super) struct FieldTable {
    /// numbers of the force fields, in their order: ascending
    forces: Vec<u32>,
    /// numbers of the flow fields, in their order: ascending
    flows: Vec<u32>,
    next: u32,
}

impl FieldTable {
    /// The number of a new field.
    fn push(&mut self, flow: bool) -> u32 {
        let number = self.next;
        self.next += 1;
        if flow {
            self.flows.push(number)
        } else {
            self.forces.push(number)
        }
        number
    }
}

impl World {
    /// Adds a force field; its potential energy, once the world has lived, is booked to `user`.
    ///
    /// # Errors
    /// A body that the scope names is not in this world.
    pub fn add_force(&mut self, field: Arc<dyn ForceField>, scope: Scope) -> Result<FieldId> {
        self.check_scope(&scope)?;
        let index = self.fields.push(false);
        let reach = Reach::default();
        self.booking_all(|world| world.model.forces.push(PlacedForce { field, scope, reach }));
        self.scopes_epoch = None;
        Ok(FieldId { index, flow: false, world: self.tag })
    }

    /// Adds a flow field.
    ///
    /// # Errors
    /// A body that the scope names is not in this world.
    pub fn add_flow(&mut self, field: Arc<dyn FlowField>, scope: Scope) -> Result<FieldId> {
        self.check_scope(&scope)?;
        let index = self.fields.push(true);
        self.scopes_epoch = None;
        self.model.flows.push(PlacedFlow { field, scope, reach: Reach::default() });
        Ok(FieldId { index, flow: true, world: self.tag })
    }

    /// Replaces a force field, keeping its scope: a slider of the gravity, say. The change of potential energy is booked to
    /// `user`.
    ///
    /// # Errors
    /// The handle is not one of a force field of this world.
    pub fn set_force(&mut self, id: FieldId, field: Arc<dyn ForceField>) -> Result<()> {
        let place = self.place_of_field(id, false)?;
        self.booking_all(|world| world.model.forces[place].field = field);
        Ok(())
    }

    /// Replaces a flow field, keeping its scope.
    ///
    /// # Errors
    /// The handle is not one of a flow field of this world.
    pub fn set_flow(&mut self, id: FieldId, field: Arc<dyn FlowField>) -> Result<()> {
        let place = self.place_of_field(id, true)?;
        self.model.flows[place].field = field;
        Ok(())
    }

    /// Removes a force field; its potential energy, once the world has lived, is booked to `user`. The others keep their order
    /// and their handles.
    ///
    /// # Errors
    /// The handle is not one of a force field of this world.
    pub fn remove_force(&mut self, id: FieldId) -> Result<()> {
        let place = self.place_of_field(id, false)?;
        self.booking_all(|world| drop(world.model.forces.remove(place)));
        self.fields.forces.remove(place);
        Ok(())
    }

    /// Removes a flow field. The others keep their order and their handles.
    ///
    /// # Errors
    /// The handle is not one of a flow field of this world.
    pub fn remove_flow(&mut self, id: FieldId) -> Result<()> {
        let place = self.place_of_field(id, true)?;
        self.model.flows.remove(place);
        self.fields.flows.remove(place);
        Ok(())
    }

    /// Handles of the force fields, in the order of [`forces`](World::forces).
    pub fn force_ids(&self) -> impl ExactSizeIterator<Item = FieldId> + '_ {
        self.fields.forces.iter().map(|&index| FieldId { index, flow: false, world: self.tag })
    }

    /// Handles of the flow fields, in the order of [`flows`](World::flows).
    pub fn flow_ids(&self) -> impl ExactSizeIterator<Item = FieldId> + '_ {
        self.fields.flows.iter().map(|&index| FieldId { index, flow: true, world: self.tag })
    }

    fn place_of_field(&self, id: FieldId, flow: bool) -> Result<usize> {
        let numbers = if flow { &self.fields.flows } else { &self.fields.forces };
        let ours = id.world == self.tag && id.flow == flow;
        let place = numbers.binary_search(&id.index).ok().filter(|_| ours);
        place.ok_or(Error::InvalidHandle { what: "field" })
    }

    /// The force fields.
    pub fn forces(&self) -> &[PlacedForce] {
        &self.model.forces
    }

    /// The flow fields.
    pub fn flows(&self) -> &[PlacedFlow] {
        &self.model.flows
    }

    fn check_scope(&self, scope: &Scope) -> Result<()> {
        scope
            .carrier
            .iter()
            .chain(scope.only.iter().flatten())
            .try_for_each(|&id| self.ids.slot(id, self.tag).map(drop))
    }
}

impl World {
    pub(super) fn scopes_are_fresh(&self) -> bool {
        self.scopes_epoch == Some(self.model.epoch)
    }

    /// The model as it will be when the scopes are turned into slots again.
    pub(super) fn with_fresh_scopes(&self) -> Model {
        let mut model = self.model.clone();
        resolve_scopes(&mut model, &self.ids, self.tag);
        model
    }

    /// Turns the fields' scopes into slots, if bodies have come, gone or changed their slots since.
    pub(super) fn refresh_scopes(&mut self) {
        if !self.scopes_are_fresh() {
            self.scopes_epoch = Some(self.model.epoch);
            resolve_scopes(&mut self.model, &self.ids, self.tag);
        }
    }
}

fn resolve_scopes(model: &mut Model, ids: &IdTable, world: u32) {
    let count = model.serial.len();
    let forces = model.forces.iter_mut().map(|f| (&f.scope, &mut f.reach));
    let flows = model.flows.iter_mut().map(|f| (&f.scope, &mut f.reach));
    for (scope, reach) in forces.chain(flows) {
        *reach = resolve(scope, count, ids, world);
    }
}

fn resolve(scope: &Scope, count: usize, ids: &IdTable, world: u32) -> Reach {
    let carrier = scope.carrier.map(|id| ids.slot(id, world).map(|slot| slot as u32));
    let only = scope.only.as_ref().map(|bodies| {
        let mut acts = vec![false; count];
        // A body that is gone is no longer acted on.
        bodies.iter().filter_map(|&id| ids.slot(id, world).ok()).for_each(|slot| acts[slot] = true);
        acts
    });
    let gone = matches!(carrier, Some(Err(_)));
    Reach { carrier: carrier.and_then(Result::ok), only, gone }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::def::{BodyDef, Settings};
    use crate::field::{EarthGravity, UniformField, UniformFlow};
    use crate::math::Vec3;
    use crate::shape::Sphere;

    fn uniform(x: f64) -> Arc<dyn ForceField> {
        Arc::new(UniformField::new(Vec3::X * x).unwrap())
    }

    #[test]
    fn a_removed_field_acts_no_more_and_its_handle_is_an_error_for_ever() {
        let mut world = World::new(Settings::default()).unwrap();
        let body = world.add_body(BodyDef::new(Sphere::new(0.5).unwrap())).unwrap();
        let a = world.add_force(uniform(1.0), Scope::default()).unwrap();
        let b = world.add_force(uniform(4.0), Scope::default()).unwrap();
        world.remove_force(a).unwrap();
        assert!(world.remove_force(a).is_err() && world.set_force(a, uniform(9.0)).is_err());
        let c = world.add_force(uniform(16.0), Scope::default()).unwrap();
        assert!(c != a && world.remove_force(a).is_err());
        assert!(world.force_ids().eq([b, c]));
        world.set_force(b, uniform(2.0)).unwrap();
        (0..480).for_each(|_| world.step().unwrap());
        let speed = world.body(body).unwrap().velocity.x;
        assert!((speed - 18.0).abs() < 1e-9, "{speed}");
    }

    #[test]
    fn the_potential_energy_of_a_removed_field_is_booked() {
        let mut world = World::new(Settings::default()).unwrap();
        world.add_body(BodyDef { position: Vec3::Y * 3.0, ..BodyDef::new(Sphere::new(0.5).unwrap()) }).unwrap();
        let gravity = world.add_force(Arc::new(EarthGravity::default()), Scope::default()).unwrap();
        world.step().unwrap();
        let before = world.energy();
        world.remove_force(gravity).unwrap();
        assert!(before.potential > 29.0 && world.energy().potential == 0.0);
        assert_eq!(world.ledger().user, -before.potential);
    }

    #[test]
    fn flows_and_forces_have_handles_of_their_own() {
        let mut world = World::new(Settings::default()).unwrap();
        let flow = || -> Arc<dyn FlowField> { Arc::new(UniformFlow::new(Vec3::Z).unwrap()) };
        let a = world.add_flow(flow(), Scope::default()).unwrap();
        let b = world.add_force(uniform(1.0), Scope::default()).unwrap();
        assert!(world.remove_force(a).is_err() && world.remove_flow(b).is_err());
        assert!(world.flow_ids().eq([a]) && world.force_ids().eq([b]));
        world.remove_flow(a).unwrap();
        assert!(world.flows().is_empty() && world.set_flow(a, flow()).is_err());
        let copy = world.clone();
        assert!(copy.force_ids().eq([b]));
    }
}
