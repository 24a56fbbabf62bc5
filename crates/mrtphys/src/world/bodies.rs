//! Bodies of a world: made, removed, read and changed.

use super::World;
use super::checks::{
    check_surface, check_vector, checked_orientation, checked_spin, energy_factor, given_inertia, homogeneous_inertia,
    mass_value, usable,
};
use crate::bounds::Aabb;
use crate::def::{BodyDef, Mass, Surface};
use crate::error::{Error, Result};
use crate::id::BodyId;
use crate::math::{Quat, Real, Vec3};
use crate::model::{BodyType, Inertia};
use crate::shape::{self, Shape};
use crate::state::{Line, Spin};
use std::sync::Arc;

/// Most bodies ever created in one world: contacts are answered in the order of 31-bit creation numbers.
pub const MOST_BODIES: u64 = (1 << 31) - 1;

/// A body as it is now.
#[derive(Clone, Debug)]
pub struct Body {
    /// handle
    pub id: BodyId,
    /// shape
    pub shape: Arc<dyn Shape>,
    /// name of the shape's kind
    pub kind: String,
    /// mass \[kg\]; infinite for a fixed body
    pub mass: Real,
    /// principal inertia
    pub inertia: Inertia,
    /// volume \[m3\]
    pub volume: Real,
    /// surface
    pub surface: Surface,
    /// position of the centre of mass \[m\]
    pub position: Vec3,
    /// orientation
    pub orientation: Quat,
    /// velocity of the centre of mass \[m/s\]
    pub velocity: Vec3,
    /// angular velocity \[rad/s\], world axes
    pub angular_velocity: Vec3,
    /// angular momentum about the centre of mass \[Js\], world axes
    pub angular_momentum: Vec3,
    /// whether the body was set aside because its motion was no longer finite
    pub set_aside: bool,
}

impl Body {
    /// Momentum \[Ns\], equation (11); zero for infinite mass.
    pub fn momentum(&self) -> Vec3 {
        if self.mass == Real::INFINITY { Vec3::ZERO } else { self.velocity * self.mass }
    }

    /// Energy of translation \[J\], equation (16).
    pub fn linear_energy(&self) -> Real {
        if self.mass == Real::INFINITY { 0.0 } else { 0.5 * self.mass * self.velocity.length_squared() }
    }

    /// Energy of rotation \[J\], equation (29).
    pub fn rotational_energy(&self) -> Real {
        self.inertia.energy(self.orientation, self.angular_momentum)
    }

    /// Moment of inertia about an axis through the centre of mass \[kg m2\], equation (23).
    pub fn inertia_about(&self, axis: Vec3) -> Real {
        let Some(n) = axis.try_normalize() else { return 0.0 };
        let p = self.inertia.principal_rotation(self.orientation).transpose_mul(n);
        p.mul_elements(p).dot(self.inertia.moments)
    }

    /// Density \[kg/m3\]; infinite for infinite mass or no volume.
    pub fn density(&self) -> Real {
        self.mass / self.volume
    }

    /// Velocity of the body's material point at a place in the world \[m/s\], equation (22).
    pub fn point_velocity(&self, point: Vec3) -> Vec3 {
        self.velocity + self.angular_velocity.cross(point - self.position)
    }
}

impl World {
    /// Makes a body.
    ///
    /// # Errors
    /// A value is not finite or out of range, the inertia tensor is none, the kind is not registered, or there are too many
    /// bodies. The world is then unchanged.
    pub fn add_body(&mut self, def: BodyDef) -> Result<BodyId> {
        let serial = self.next_serial;
        let object = if def.name.is_empty() { format!("body {serial}") } else { format!("body '{}'", def.name) };
        if serial >= MOST_BODIES {
            return Err(Error::LimitExceeded { object, what: "bodies created", given: serial, limit: MOST_BODIES });
        }
        let kind_of = self.type_from(&def, &object)?;
        let finite = |v: Vec3, field| check_vector(&object, field, v);
        finite(def.position, "position")?;
        finite(def.velocity, "velocity")?;
        finite(def.angular_velocity, "angular_velocity")?;
        let orientation = checked_orientation(&object, def.orientation)?;

        let moves = kind_of.mass != Real::INFINITY;
        let line = Line {
            x: def.position,
            radius: kind_of.ball.radius,
            v: if moves { def.velocity } else { Vec3::ZERO },
            inverse_mass: kind_of.inverse_mass(),
        };
        let l = checked_spin(&object, &kind_of.inertia, orientation, def.angular_velocity)?;
        let spin = Spin { q: orientation, l };
        self.model.all_spheres &= kind_of.is_plain_sphere();
        let type_index = self.intern(kind_of);
        self.model.type_of.push(type_index);
        self.model.serial.push(serial as u32);
        self.model.fixed.push(!moves);
        self.model.epoch += 1;
        self.state.lines.push(line);
        self.state.spins.push(spin);
        self.work.nothing_spins = false;
        self.work.storage_is_new = true;
        self.next_serial = serial + 1;
        let id = self.ids.push(self.tag);
        self.book_created(self.state.lines.len() - 1);
        Ok(id)
    }

    /// Removes a body; its energy is booked to `created_removed`.
    ///
    /// # Errors
    /// The handle is not valid.
    pub fn remove_body(&mut self, id: BodyId) -> Result<()> {
        let slot = self.ids.slot(id, self.tag)?;
        self.book_removed(slot);
        let serial = self.model.serial[slot];
        self.state.contacts.forget(serial, self.model.settings.contact);
        self.state.let_back.forget(serial);
        self.ids.swap_remove(slot);
        self.model.type_of.swap_remove(slot);
        self.model.serial.swap_remove(slot);
        self.model.fixed.swap_remove(slot);
        self.state.lines.swap_remove(slot);
        self.state.spins.swap_remove(slot);
        if self.state.lines.is_empty() {
            // The memory of a million bodies goes back when the last is gone.
            self.state.lines.shrink_to_fit();
            self.state.spins.shrink_to_fit();
        }
        self.model.epoch += 1;
        Ok(())
    }

    /// Number of bodies.
    pub fn body_count(&self) -> usize {
        self.state.lines.len()
    }

    /// Handles of all bodies, in order of creation.
    pub fn bodies(&self) -> impl ExactSizeIterator<Item = BodyId> + '_ {
        self.model.order().into_iter().map(|slot| self.ids.id(slot as usize, self.tag))
    }

    /// A body as it is now.
    ///
    /// # Errors
    /// The handle is not valid.
    pub fn body(&self, id: BodyId) -> Result<Body> {
        let slot = self.ids.slot(id, self.tag)?;
        let (kind_of, line, spin) = (self.model.body(slot), &self.state.lines[slot], &self.state.spins[slot]);
        Ok(Body {
            id,
            shape: kind_of.shape.clone(),
            kind: self.kinds.name(kind_of.kind).to_string(),
            mass: kind_of.mass,
            inertia: kind_of.inertia,
            volume: kind_of.volume,
            surface: kind_of.surface,
            position: line.x,
            orientation: spin.q,
            velocity: line.v,
            angular_velocity: kind_of.inertia.angular_velocity(spin.q, spin.l),
            angular_momentum: spin.l,
            set_aside: line.radius < 0.0,
        })
    }

    /// Position of the centre of mass \[m\] and orientation: what a picture needs, without the rest of [`Body`].
    ///
    /// # Errors
    /// The handle is not valid.
    pub fn pose(&self, id: BodyId) -> Result<(Vec3, Quat)> {
        let slot = self.ids.slot(id, self.tag)?;
        Ok((self.state.lines[slot].x, self.state.spins[slot].q))
    }

    /// Velocity of the centre of mass \[m/s\] and angular velocity \[rad/s\], without the rest of [`Body`].
    ///
    /// # Errors
    /// The handle is not valid.
    pub fn motion(&self, id: BodyId) -> Result<(Vec3, Vec3)> {
        let slot = self.ids.slot(id, self.tag)?;
        let spin = &self.state.spins[slot];
        Ok((self.state.lines[slot].v, self.model.body(slot).inertia.angular_velocity(spin.q, spin.l)))
    }

    /// Mass \[kg\], without the rest of [`Body`]; infinite for a fixed body.
    ///
    /// # Errors
    /// The handle is not valid.
    pub fn mass(&self, id: BodyId) -> Result<Real> {
        self.ids.slot(id, self.tag).map(|slot| self.model.body(slot).mass)
    }

    /// Axis-parallel box round a body where it is now \[m\].
    ///
    /// # Errors
    /// The handle is not valid.
    pub fn bounding_box(&self, id: BodyId) -> Result<Aabb> {
        let slot = self.ids.slot(id, self.tag)?;
        Ok(self.model.body(slot).shape.bounding_box(self.state.lines[slot].x, &self.state.spins[slot].q.to_matrix()))
    }

    /// Puts a body elsewhere. The change of its potential energy is booked to `user`.
    ///
    /// # Errors
    /// The handle is not valid, or the position is not finite.
    pub fn set_position(&mut self, id: BodyId, position: Vec3) -> Result<()> {
        self.change(id, "position", position, |world, slot| {
            world.state.lines[slot].x = position;
            let serial = world.model.serial[slot];
            world.state.let_back.forget(serial);
            world.model.epoch += 1;
        })
    }

    /// Turns a body. Its angular velocity in its own axes turns with it.
    ///
    /// # Errors
    /// The handle is not valid, or the quaternion is zero or not finite.
    pub fn set_orientation(&mut self, id: BodyId, orientation: Quat) -> Result<()> {
        let q = checked_orientation("body", orientation)?;
        self.change(id, "orientation", Vec3::ZERO, |world, slot| {
            let spin = &mut world.state.spins[slot];
            if spin.l != Vec3::ZERO {
                spin.l = q.to_matrix() * spin.q.to_matrix().transpose_mul(spin.l);
            }
            spin.q = q;
        })
    }

    /// Sets the velocity of the centre of mass \[m/s\]; a fixed body keeps zero.
    ///
    /// # Errors
    /// The handle is not valid, or the velocity is not finite.
    pub fn set_velocity(&mut self, id: BodyId, velocity: Vec3) -> Result<()> {
        self.change(id, "velocity", velocity, |world, slot| {
            if !world.model.fixed[slot] {
                world.state.lines[slot].v = velocity;
            }
        })
    }

    /// Sets the angular velocity \[rad/s\], world axes; a fixed body keeps zero.
    ///
    /// # Errors
    /// The handle is not valid, or the angular velocity is not finite.
    pub fn set_angular_velocity(&mut self, id: BodyId, angular_velocity: Vec3) -> Result<()> {
        let slot = self.ids.slot(id, self.tag)?;
        check_vector("body", "angular_velocity", angular_velocity)?;
        let (q, inertia) = (self.state.spins[slot].q, &self.model.body(slot).inertia);
        let l = checked_spin("body", inertia, q, angular_velocity)?;
        self.change(id, "angular_velocity", angular_velocity, |world, slot| world.state.spins[slot].l = l)
    }

    /// Sets the momentum \[Ns\].
    ///
    /// # Errors
    /// The handle is not valid, or the momentum is not finite.
    pub fn set_momentum(&mut self, id: BodyId, momentum: Vec3) -> Result<()> {
        self.change(id, "momentum", momentum, |world, slot| {
            let line = &mut world.state.lines[slot];
            line.v = momentum * line.inverse_mass;
        })
    }

    /// Sets the angular momentum about the centre of mass \[Js\], world axes; a fixed body keeps zero.
    ///
    /// # Errors
    /// The handle is not valid, or the angular momentum is not finite.
    pub fn set_angular_momentum(&mut self, id: BodyId, angular_momentum: Vec3) -> Result<()> {
        self.change(id, "angular_momentum", angular_momentum, |world, slot| {
            if !world.model.fixed[slot] {
                world.state.spins[slot].l = angular_momentum;
            }
        })
    }

    /// Scales the velocity so that the energy of translation becomes this \[J\].
    ///
    /// # Errors
    /// The handle is not valid, the energy is negative or not finite, or the body is at rest, so that there is no direction.
    pub fn set_linear_energy(&mut self, id: BodyId, energy: Real) -> Result<()> {
        let body = self.body(id)?;
        let factor = energy_factor("linear_energy", energy, body.linear_energy())?;
        self.set_velocity(id, body.velocity * factor)
    }

    /// Scales the angular momentum so that the energy of rotation becomes this \[J\].
    ///
    /// # Errors
    /// As [`set_linear_energy`](World::set_linear_energy).
    pub fn set_rotational_energy(&mut self, id: BodyId, energy: Real) -> Result<()> {
        let body = self.body(id)?;
        let factor = energy_factor("rotational_energy", energy, body.rotational_energy())?;
        self.set_angular_momentum(id, body.angular_momentum * factor)
    }

    /// Gives a body an impulse \[Ns\] at a point of the world \[m\].
    ///
    /// # Errors
    /// The handle is not valid, or a value is not finite.
    pub fn apply_impulse(&mut self, id: BodyId, impulse: Vec3, point: Vec3) -> Result<()> {
        check_vector("body", "point", point)?;
        self.change(id, "impulse", impulse, |world, slot| {
            if !world.model.fixed[slot] {
                let line = &mut world.state.lines[slot];
                line.v += impulse * line.inverse_mass;
                world.state.spins[slot].l += (point - line.x).cross(impulse);
            }
        })
    }

    /// Sets the mass; velocities stay. A user-given inertia tensor is scaled with it.
    ///
    /// # Errors
    /// The handle is not valid, or the mass is out of range.
    pub fn set_mass(&mut self, id: BodyId, mass: Mass) -> Result<()> {
        let body = self.body(id)?;
        let object = "body";
        let value = mass_value(object, mass, body.volume)?;
        let mut kind_of = self.model.body(self.ids.slot(id, self.tag)?).clone();
        kind_of.inertia = if value == Real::INFINITY {
            Inertia::INFINITE
        } else if kind_of.mass == Real::INFINITY {
            homogeneous_inertia(object, &*kind_of.shape, value, self.model.settings.inertia)?
        } else {
            usable(object, Inertia::new(kind_of.inertia.moments * (value / kind_of.mass), kind_of.inertia.axes))?
        };
        checked_spin(object, &kind_of.inertia, body.orientation, body.angular_velocity)?;
        kind_of.mass = value;
        self.replace_type(id, kind_of, body.angular_velocity)
    }

    /// Sets the surface.
    ///
    /// # Errors
    /// The handle is not valid, or a value is out of range.
    pub fn set_surface(&mut self, id: BodyId, surface: Surface) -> Result<()> {
        check_surface("body", &surface)?;
        let body = self.body(id)?;
        let mut kind_of = self.model.body(self.ids.slot(id, self.tag)?).clone();
        kind_of.surface = surface;
        self.replace_type(id, kind_of, body.angular_velocity)
    }

    fn replace_type(&mut self, id: BodyId, kind_of: BodyType, angular_velocity: Vec3) -> Result<()> {
        let moves = kind_of.mass != Real::INFINITY;
        let inverse_mass = kind_of.inverse_mass();
        let inertia = kind_of.inertia;
        let index = self.intern(kind_of);
        self.change(id, "mass", Vec3::ZERO, |world, slot| {
            world.model.type_of[slot] = index;
            world.model.fixed[slot] = !moves;
            world.model.epoch += 1;
            let (line, spin) = (&mut world.state.lines[slot], &mut world.state.spins[slot]);
            line.inverse_mass = inverse_mass;
            if !moves {
                line.v = Vec3::ZERO;
            }
            spin.l = inertia.angular_momentum(spin.q, angular_velocity);
        })
    }

    /// Applies a change to one body and books its energy.
    fn change(
        &mut self,
        id: BodyId,
        field: &'static str,
        value: Vec3,
        apply: impl FnOnce(&mut World, usize),
    ) -> Result<()> {
        let slot = self.ids.slot(id, self.tag)?;
        check_vector("body", field, value)?;
        self.work.nothing_spins = false;
        self.booking_one(slot, |world| apply(world, slot));
        Ok(())
    }

    /// The type of a definition, checked.
    fn type_from(&self, def: &BodyDef, object: &str) -> Result<BodyType> {
        let kind =
            self.kinds.id(def.shape.kind()).ok_or_else(|| Error::UnknownKind { name: def.shape.kind().to_string() })?;
        check_surface(object, &def.surface)?;
        let volume = def.shape.volume();
        let mass = mass_value(object, def.mass, volume)?;
        let inertia = if mass == Real::INFINITY {
            Inertia::INFINITE
        } else if let Some(tensor) = &def.inertia {
            given_inertia(object, tensor)?
        } else {
            homogeneous_inertia(object, &*def.shape, mass, self.model.settings.inertia)?
        };
        let ball = def.shape.bounding_sphere();
        if !ball.radius.is_finite() || ball.is_empty() {
            return Err(Error::OutOfRange {
                object: object.into(),
                field: "shape",
                value: ball.radius,
                expected: "a bounded shape: an unbounded one is a boundary",
            });
        }
        Ok(BodyType { shape: def.shape.clone(), kind, mass, inertia, surface: def.surface, volume, ball })
    }

    /// Index of a type, shared with bodies made before where it is the same. Only the latest types are compared: a lattice
    /// alternates between a few.
    fn intern(&mut self, kind_of: BodyType) -> u32 {
        const LOOK_BACK: usize = 16;
        let first = self.model.types.len().saturating_sub(LOOK_BACK);
        if let Some(i) = self.model.types[first..].iter().position(|t| t.is_same(&kind_of)) {
            return (first + i) as u32;
        }
        if self.model.types.len() > 2 * self.model.type_of.len() + LOOK_BACK {
            self.drop_unused_types();
        }
        self.model.all_smooth &= kind_of.surface.friction == 0.0 && kind_of.surface.restitution == 1.0;
        self.model.types.push(kind_of);
        (self.model.types.len() - 1) as u32
    }

    fn drop_unused_types(&mut self) {
        let mut used = vec![false; self.model.types.len()];
        self.model.type_of.iter().for_each(|&t| used[t as usize] = true);
        let mut next = 0;
        let renumbered: Vec<u32> = used
            .iter()
            .map(|&u| {
                next += u32::from(u);
                next.wrapping_sub(1)
            })
            .collect();
        let mut keep = used.iter();
        self.model.types.retain(|_| *keep.next().unwrap_or(&false));
        self.model.type_of.iter_mut().for_each(|t| *t = renumbered[*t as usize]);
    }
}

impl BodyType {
    /// Whether the body is a sphere about its own centre of mass, so that it needs no rotation matrix.
    pub(crate) fn is_plain_sphere(&self) -> bool {
        self.shape.downcast::<shape::Sphere>().is_some()
    }

    fn is_same(&self, o: &BodyType) -> bool {
        let same_shape = Arc::ptr_eq(&self.shape, &o.shape)
            || match (self.shape.downcast::<shape::Sphere>(), o.shape.downcast::<shape::Sphere>()) {
                (Some(a), Some(b)) => a == b,
                _ => false,
            };
        same_shape
            && self.kind == o.kind
            && self.mass == o.mass
            && self.inertia == o.inertia
            && self.surface == o.surface
    }
}
