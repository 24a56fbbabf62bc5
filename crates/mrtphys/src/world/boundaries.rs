//! Boundaries of a world.

use super::World;
use super::checks::{check_surface, check_vector};
use crate::def::{BoundaryDef, Surface};
use crate::error::{Error, Result};
use crate::id::BoundaryId;
use crate::math::Vec3;
use crate::model::Boundary;
use crate::shape::{self, Shape};
use std::sync::Arc;

/// Most boundaries of a world: their numbers share 31 bits with the creation numbers of bodies.
pub const MOST_BOUNDARIES: usize = 1 << 20;

/// A boundary as it is now.
#[derive(Clone, Debug)]
pub struct BoundaryView {
    /// handle
    pub id: BoundaryId,
    /// the name it was made with
    pub name: String,
    /// shape
    pub shape: Arc<dyn Shape>,
    /// name of the shape's kind
    pub kind: String,
    /// where the shape's origin is \[m\]
    pub position: Vec3,
    /// surface
    pub surface: Surface,
}

impl World {
    /// Makes a boundary.
    ///
    /// # Errors
    /// A value is not finite or out of range, or the kind is not registered. The world is then unchanged.
    pub fn add_boundary(&mut self, def: BoundaryDef) -> Result<BoundaryId> {
        let index = self.model.boundaries.len();
        let object = if def.name.is_empty() { format!("boundary {index}") } else { format!("boundary '{}'", def.name) };
        if index >= MOST_BOUNDARIES {
            let (given, limit) = (index as u64 + 1, MOST_BOUNDARIES as u64);
            return Err(Error::LimitExceeded { object, what: "boundaries", given, limit });
        }
        let name = def.shape.kind();
        let kind = self.kinds.id(name).ok_or_else(|| Error::UnknownKind { name: name.to_string() })?;
        check_vector(&object, "position", def.position)?;
        check_surface(&object, &def.surface)?;
        let bounds = shape::half_space::boundary_bounds(&*def.shape, def.position);
        self.model.boundaries.push(Boundary {
            name: def.name,
            shape: def.shape,
            kind,
            position: def.position,
            surface: def.surface,
        });
        self.model.wall_bounds.push(bounds);
        self.model.epoch += 1;
        Ok(BoundaryId { index: index as u32, world: self.tag })
    }

    /// Makes the six faces of a limit box (thesis, section 6.7.3), named `NAME.-x`, `NAME.+x` ... `NAME.+z`.
    ///
    /// # Errors
    /// The corners are not finite, the box is empty, or the surface is out of range.
    pub fn add_box(&mut self, name: &str, min: Vec3, max: Vec3, surface: Surface) -> Result<[BoundaryId; 6]> {
        let faces = shape::limit_box(min, max)?;
        check_surface(&format!("boundary '{name}'"), &surface)?;
        let mut ids = [BoundaryId { index: 0, world: self.tag }; 6];
        for (id, (face, position, quadrangle)) in ids.iter_mut().zip(faces) {
            let name = format!("{name}.{face}");
            *id = self.add_boundary(BoundaryDef { name, shape: Arc::new(quadrangle), position, surface })?;
        }
        Ok(ids)
    }

    /// Handles of all boundaries, in order of creation.
    pub fn boundaries(&self) -> impl ExactSizeIterator<Item = BoundaryId> + '_ {
        (0..self.model.boundaries.len() as u32).map(|index| BoundaryId { index, world: self.tag })
    }

    /// A boundary as it is now.
    ///
    /// # Errors
    /// The handle is not valid.
    pub fn boundary(&self, id: BoundaryId) -> Result<BoundaryView> {
        let b = &self.model.boundaries[self.boundary_index(id)?];
        Ok(BoundaryView {
            id,
            name: b.name.clone(),
            shape: b.shape.clone(),
            kind: self.kinds.name(b.kind).to_string(),
            position: b.position,
            surface: b.surface,
        })
    }

    /// Sets the surface of a boundary.
    ///
    /// # Errors
    /// The handle is not valid, or a value is out of range.
    pub fn set_boundary_surface(&mut self, id: BoundaryId, surface: Surface) -> Result<()> {
        check_surface("boundary", &surface)?;
        let index = self.boundary_index(id)?;
        self.model.boundaries[index].surface = surface;
        Ok(())
    }

    fn boundary_index(&self, id: BoundaryId) -> Result<usize> {
        let valid = id.world == self.tag && (id.index as usize) < self.model.boundaries.len();
        if valid { Ok(id.index as usize) } else { Err(Error::InvalidHandle { what: "boundary" }) }
    }
}
