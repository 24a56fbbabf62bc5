//! What a step only reads: masses, shapes, surfaces, boundaries, fields, settings, the pair table.

use crate::bounds::{Ball, BoundaryBounds};
use crate::def::{Settings, Surface};
use crate::field::{PlacedFlow, PlacedForce};
use crate::math::{Mat3, Quat, Real, Vec3};
use crate::narrow::kinds::KindId;
use crate::narrow::pair_table::PairTable;
use crate::shape::Shape;
use std::sync::Arc;

/// Principal inertia of a body about its centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// principal moments \[kg m2\]; infinite for a body that never moves
    pub moments: Vec3,
    /// their reciprocals \[1/(kg m2)\]; zero for a body that never moves
    pub inverse: Vec3,
    /// rotation from principal axes into the body's axes
    pub axes: Quat,
    /// all three moments are equal, so that the axes do not matter
    pub spherical: bool,
    /// principal axes are the body's axes
    pub aligned: bool,
}

impl Inertia {
    /// The inertia of what never moves.
    pub const INFINITE: Inertia = Inertia {
        moments: Vec3::splat(Real::INFINITY),
        inverse: Vec3::ZERO,
        axes: Quat::IDENTITY,
        spherical: true,
        aligned: true,
    };

    /// From principal moments \[kg m2\] and the rotation from principal into body axes.
    pub fn new(moments: Vec3, axes: Quat) -> Inertia {
        let spherical = moments.x == moments.y && moments.y == moments.z;
        let aligned = spherical || axes == Quat::IDENTITY;
        Inertia {
            moments,
            inverse: Vec3::new(1.0 / moments.x, 1.0 / moments.y, 1.0 / moments.z),
            axes: if aligned { Quat::IDENTITY } else { axes },
            spherical,
            aligned,
        }
    }

    /// Rotation from principal axes into the world's, for a body of this orientation.
    #[inline]
    pub fn principal_rotation(&self, orientation: Quat) -> Mat3 {
        if self.aligned { orientation.to_matrix() } else { (orientation * self.axes).to_matrix() }
    }

    /// Angular velocity \[rad/s\] of a body with this orientation and angular momentum \[Js\], world axes.
    #[inline]
    pub fn angular_velocity(&self, orientation: Quat, angular_momentum: Vec3) -> Vec3 {
        if self.spherical {
            return angular_momentum * self.inverse.x;
        }
        self.principal_rotation(orientation).conjugate_diagonal_mul(self.inverse, angular_momentum)
    }

    /// Angular momentum \[Js\] of a body with this orientation and angular velocity \[rad/s\]; zero for infinite inertia.
    pub fn angular_momentum(&self, orientation: Quat, angular_velocity: Vec3) -> Vec3 {
        if self.inverse == Vec3::ZERO {
            return Vec3::ZERO;
        }
        if self.spherical {
            return angular_velocity * self.moments.x;
        }
        self.principal_rotation(orientation).conjugate_diagonal_mul(self.moments, angular_velocity)
    }

    /// Inverse inertia tensor in world axes.
    #[inline]
    pub fn inverse_world(&self, orientation: Quat) -> Mat3 {
        if self.spherical {
            return Mat3::diagonal(self.inverse);
        }
        self.principal_rotation(orientation).conjugate_diagonal(self.inverse)
    }

    /// Kinetic energy of rotation \[J\], equation (29) for a tensor.
    #[inline]
    pub fn energy(&self, orientation: Quat, angular_momentum: Vec3) -> Real {
        if angular_momentum == Vec3::ZERO {
            return 0.0;
        }
        if self.spherical {
            return 0.5 * angular_momentum.length_squared() * self.inverse.x;
        }
        let l = self.principal_rotation(orientation).transpose_mul(angular_momentum);
        0.5 * l.mul_elements(l).dot(self.inverse)
    }
}

/// What many bodies have in common: a lattice of a million spheres has one.
#[derive(Clone, Debug)]
pub struct BodyType {
    /// shape
    pub shape: Arc<dyn Shape>,
    /// the shape's kind
    pub kind: KindId,
    /// mass \[kg\]; infinite for a body that never moves
    pub mass: Real,
    /// inertia
    pub inertia: Inertia,
    /// surface
    pub surface: Surface,
    /// volume \[m3\]
    pub volume: Real,
    /// bounding sphere in the shape's coordinates
    pub ball: Ball,
}

impl BodyType {
    /// 1/mass \[1/kg\], 0 for infinite mass.
    #[inline]
    pub fn inverse_mass(&self) -> Real {
        if self.mass == Real::INFINITY { 0.0 } else { 1.0 / self.mass }
    }
}

/// A boundary.
#[derive(Clone, Debug)]
pub struct Boundary {
    /// the name it was made with
    pub name: String,
    /// shape
    pub shape: Arc<dyn Shape>,
    /// the shape's kind
    pub kind: KindId,
    /// where its origin is \[m\]
    pub position: Vec3,
    /// surface
    pub surface: Surface,
}

/// What a step only reads.
#[derive(Clone, Debug)]
pub struct Model {
    /// settings
    pub settings: Settings,
    /// the resolved pair table
    pub table: PairTable,
    /// the types of body there are
    pub types: Vec<BodyType>,
    /// type of the body in each slot
    pub type_of: Vec<u32>,
    /// creation number of the body in each slot: contacts are answered in its order
    pub serial: Vec<u32>,
    /// whether the body in each slot has infinite mass
    pub fixed: Vec<bool>,
    /// boundaries
    pub boundaries: Vec<Boundary>,
    /// their bounds
    pub wall_bounds: Vec<BoundaryBounds>,
    /// force fields
    pub forces: Vec<PlacedForce>,
    /// flow fields
    pub flows: Vec<PlacedFlow>,
    /// whether every body is a sphere centred on its mass: no rotation matrices are needed for bounds
    pub all_spheres: bool,
    /// whether every body is without friction and elastic
    pub all_smooth: bool,
    /// whether the pair table answers two spheres with the routine of spheres, and not one of the user's
    pub spheres_meet_as_spheres: bool,
    /// grows whenever bodies or boundaries are added, removed, re-ordered or moved by hand
    pub epoch: u64,
}

impl Model {
    /// Slots in order of creation: the order in which everything is summed, saved and reported.
    pub fn order(&self) -> Vec<u32> {
        let mut order: Vec<u32> = (0..self.serial.len() as u32).collect();
        order.sort_unstable_by_key(|&slot| self.serial[slot as usize]);
        order
    }

    /// The type of the body in a slot.
    #[inline]
    pub fn body(&self, slot: usize) -> &BodyType {
        &self.types[self.type_of[slot] as usize]
    }
}
