//! Energies, momenta, and the booking of changes made from outside.

use super::World;
use crate::field::sum::{potential_energy, potential_round};
use crate::ledger::{Energy, Ledger, Sums};
use crate::math::{Real, Vec3};

impl World {
    /// Energies now \[J\], summed in order of creation.
    pub fn energy(&self) -> Energy {
        let mut energy = Energy::default();
        for slot in self.model.order() {
            let (linear, rotational) = self.kinetic_of(slot as usize);
            energy.linear += linear;
            energy.rotational += rotational;
        }
        energy.potential = self.potential();
        energy
    }

    /// Energies, momentum and angular momentum at once: bit for bit what [`World::energy`], [`World::momentum`] and
    /// [`World::angular_momentum`] return, each summed in order of creation, with that order found once.
    pub fn sums(&self) -> Sums {
        let mut sums = Sums::default();
        for slot in self.model.order() {
            let slot = slot as usize;
            let (linear, rotational) = self.kinetic_of(slot);
            sums.energy.linear += linear;
            sums.energy.rotational += rotational;
            sums.momentum += self.momentum_of(slot);
            sums.angular_momentum += self.angular_momentum_of(slot);
        }
        sums.energy.potential = self.potential();
        sums
    }

    /// Potential energy \[J\]. Bodies may have come since the fields' scopes were last turned into slots.
    fn potential(&self) -> Real {
        if self.scopes_are_fresh() {
            return potential_energy(&self.model, &self.state);
        }
        potential_energy(&self.with_fresh_scopes(), &self.state)
    }

    /// Energies when the first step began \[J\]; before it, those now.
    pub fn initial_energy(&self) -> Energy {
        self.books.initial.unwrap_or_else(|| self.energy())
    }

    /// Where the energy went since the first step.
    pub fn ledger(&self) -> &Ledger {
        &self.books.ledger
    }

    /// Momentum of all bodies \[Ns\], equation (11).
    pub fn momentum(&self) -> Vec3 {
        self.model.order().into_iter().map(|slot| self.momentum_of(slot as usize)).sum()
    }

    /// Angular momentum of all bodies about the origin \[Js\], equation (20) and the spins.
    pub fn angular_momentum(&self) -> Vec3 {
        self.model.order().into_iter().map(|slot| self.angular_momentum_of(slot as usize)).sum()
    }

    fn angular_momentum_of(&self, slot: usize) -> Vec3 {
        self.state.lines[slot].x.cross(self.momentum_of(slot)) + self.state.spins[slot].l
    }

    fn momentum_of(&self, slot: usize) -> Vec3 {
        if self.model.fixed[slot] { Vec3::ZERO } else { self.state.lines[slot].v * self.model.body(slot).mass }
    }

    /// Energy of translation and of rotation of the body in a slot \[J\].
    fn kinetic_of(&self, slot: usize) -> (Real, Real) {
        if self.model.fixed[slot] {
            return (0.0, 0.0);
        }
        let (body, line, spin) = (self.model.body(slot), &self.state.lines[slot], &self.state.spins[slot]);
        (0.5 * body.mass * line.v.length_squared(), body.inertia.energy(spin.q, spin.l))
    }

    /// Kinetic energy of one body and the potential energy that its place decides: what a change to this body can change.
    fn energy_round(&self, slot: usize) -> Real {
        let (linear, rotational) = self.kinetic_of(slot);
        linear + rotational + potential_round(&self.model, &self.state, slot)
    }

    /// Makes a change to one body; once the world has lived, books the energy to `user`.
    pub(super) fn booking_one(&mut self, slot: usize, change: impl FnOnce(&mut World)) {
        if self.books.initial.is_none() {
            return change(self);
        }
        // Bodies may have come and gone since the last step: their fields must find them before the change, too.
        self.refresh_scopes();
        let before = self.energy_round(slot);
        change(self);
        self.refresh_scopes();
        self.books.ledger.user += self.energy_round(slot) - before;
    }

    /// Makes a change to the fields or the medium; once the world has lived, books the energy to `user`.
    pub(super) fn booking_all(&mut self, change: impl FnOnce(&mut World)) {
        if self.books.initial.is_none() {
            return change(self);
        }
        self.refresh_scopes();
        let before = potential_energy(&self.model, &self.state);
        change(self);
        self.scopes_epoch = None;
        self.refresh_scopes();
        self.books.ledger.user += potential_energy(&self.model, &self.state) - before;
    }

    /// Books a body just made.
    pub(super) fn book_created(&mut self, slot: usize) {
        if self.books.initial.is_some() {
            self.books.ledger.created_removed += self.energy_with_and_without(slot);
        }
    }

    /// Books a body about to go.
    pub(super) fn book_removed(&mut self, slot: usize) {
        if self.books.initial.is_some() {
            self.books.ledger.created_removed -= self.energy_with_and_without(slot);
        }
    }

    /// What the world's energy owes to one body.
    fn energy_with_and_without(&mut self, slot: usize) -> Real {
        self.refresh_scopes();
        let with = self.energy_round(slot);
        let radius = std::mem::replace(&mut self.state.lines[slot].radius, -1.0);
        let without = potential_round(&self.model, &self.state, slot);
        self.state.lines[slot].radius = radius;
        with - without
    }
}
