//! Force fields and flow fields of a world.

use super::World;
use super::ids::IdTable;
use crate::error::{Error, Result};
use crate::field::{FlowField, ForceField, PlacedFlow, PlacedForce, Reach, Scope};
use crate::id::FieldId;
use crate::model::Model;
use std::sync::Arc;

impl World {
    /// Adds a force field; its potential energy, once the world has lived, is booked to `user`.
    ///
    /// # Errors
    /// A body that the scope names is not in this world.
    pub fn add_force(&mut self, field: Arc<dyn ForceField>, scope: Scope) -> Result<FieldId> {
        self.check_scope(&scope)?;
        let index = self.model.forces.len() as u32;
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
        let index = self.model.flows.len() as u32;
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
        let index = id.index as usize;
        if id.world != self.tag || id.flow || index >= self.model.forces.len() {
            return Err(Error::InvalidHandle { what: "field" });
        }
        self.booking_all(|world| world.model.forces[index].field = field);
        Ok(())
    }

    /// Replaces a flow field, keeping its scope.
    ///
    /// # Errors
    /// The handle is not one of a flow field of this world.
    pub fn set_flow(&mut self, id: FieldId, field: Arc<dyn FlowField>) -> Result<()> {
        let index = id.index as usize;
        if id.world != self.tag || !id.flow || index >= self.model.flows.len() {
            return Err(Error::InvalidHandle { what: "field" });
        }
        self.model.flows[index].field = field;
        Ok(())
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
