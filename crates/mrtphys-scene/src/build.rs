//! From [`Scene`] to a world.

use crate::diagnostics::Diagnostics;
use crate::format::read::Findings;
use crate::names::Names;
use crate::parse;
use crate::scene::{
    BodyDesc, BodyTableDesc, BoundaryDesc, BoundaryKind, Color, Content, LatticeDesc, MassDesc, Material, Placement,
    Scene, ShapeDesc, SubstanceDesc, SurfaceDesc, Turning,
};
use crate::source::Span;
use crate::table::{NO_MATERIAL, TableRow, TableRows, TableShape};
use mrtphys::def::{BodyDef, BoundaryDef, FrictionLaw, Mass, Surface};
use mrtphys::error::Error;
use mrtphys::id::{BodyId, BoundaryId};
use mrtphys::math::{Quat, Real, Vec3};
use mrtphys::shape::{HalfSpace, LimitPlane, LimitQuadrangle, Polyhedron, Quadrangle, Shape, Sphere};
use mrtphys::world::World;
use std::sync::Arc;

/// A world made from a scene, with the names that the world itself does not keep.
#[derive(Clone)]
pub struct Loaded {
    /// the world
    pub world: World,
    /// names of its bodies and boundaries
    pub names: Names,
    /// what it was made from
    pub scene: Scene,
}

impl Scene {
    /// Makes the world.
    ///
    /// # Errors
    /// Something in the scene is wrong that only the world can tell (a degenerate shape, a name that stands for nothing):
    /// what, and where.
    pub fn build(&self) -> Result<Loaded, Diagnostics> {
        let mut found = Findings::default();
        // The description may have been made or changed by a program, so what reading has checked is checked again.
        parse::check_count(&self.contents, &mut found);
        if !found.list.is_empty() {
            return Err(parse::report(&self.source, found));
        }
        let mut names = Names::of(self, &mut found);
        let world = match World::new(self.settings.clone()) {
            Ok(world) => world,
            Err(e) => {
                found.push(Span::default(), format!("scene: {e}"));
                return Err(parse::report(&self.source, found));
            }
        };
        let mut builder = Builder { scene: self, world, found, shapes: Vec::new(), ids: Vec::new() };
        for content in &self.contents {
            builder.content(content);
        }
        let boundaries: Vec<BoundaryId> = self.boundaries.iter().flat_map(|b| builder.boundary(b)).collect();
        if builder.found.list.is_empty() {
            names.set_ids(std::mem::take(&mut builder.ids), boundaries);
            crate::field::add_all(self, &names, &mut builder.world, &mut builder.found);
        }
        if !builder.found.list.is_empty() {
            return Err(parse::report(&self.source, builder.found));
        }
        Ok(Loaded { world: builder.world, names, scene: self.clone() })
    }
}

impl Loaded {
    /// Adds a body to the world and to the end of the scene.
    ///
    /// # Errors
    /// Something about the body is wrong, or its name is taken. Nothing is changed then.
    pub fn add_body(&mut self, body: BodyDesc) -> Result<BodyId, Diagnostics> {
        let fail = |m: String| Diagnostics::from(crate::Diagnostic::without_place(&self.scene.source.name, m));
        let name = &body.name;
        crate::format::value::check_name(name).map_err(|m| fail(format!("body '{name}': {m}")))?;
        if self.names.is_taken(name) {
            return Err(fail(format!("the name '{name}' is there twice")));
        }
        let shape = body.substance.shape.build().map_err(|e| fail(format!("body '{name}': shape: {e}")))?;
        let id = add(&mut self.world, &self.scene.materials, &body, shape).map_err(|e| fail(e.to_string()))?;
        let content = Content::Body(body);
        self.names.push(&content, id);
        self.scene.contents.push(content);
        Ok(id)
    }

    /// The color a body is to be drawn in, where the scene says one.
    pub fn color(&self, id: BodyId) -> Option<Color> {
        let (content, i) = self.names.content_of(id)?;
        match &self.scene.contents[content] {
            Content::Body(b) => b.substance.color,
            Content::Lattice(l) => {
                let [_, ny, nz] = l.count.map(|n| n as usize);
                let kind = (i / (ny * nz) + i / nz % ny + i % nz) % l.bodies.len();
                l.bodies[kind].color
            }
            Content::Table(_) => None,
        }
    }
}

struct Builder<'a> {
    scene: &'a Scene,
    world: World,
    found: Findings,
    /// the latest shapes: bodies of the same shape share it
    shapes: Vec<(ShapeDesc, Arc<dyn Shape>)>,
    ids: Vec<BodyId>,
}

/// How many of the latest shapes are compared.
const SHAPES_KEPT: usize = 32;

impl Builder<'_> {
    fn shape(&mut self, desc: &ShapeDesc) -> Result<Arc<dyn Shape>, Error> {
        if let Some((_, shape)) = self.shapes.iter().find(|(d, _)| d == desc) {
            return Ok(shape.clone());
        }
        let shape = desc.build()?;
        if self.shapes.len() == SHAPES_KEPT {
            self.shapes.remove(0);
        }
        self.shapes.push((desc.clone(), shape.clone()));
        Ok(shape)
    }

    fn content(&mut self, content: &Content) {
        match content {
            Content::Body(b) => self.body(b),
            Content::Lattice(l) => self.lattice(l),
            Content::Table(t) => self.table(t),
        }
    }

    /// Friction is checked again: the law may have been changed after the scene was read.
    fn friction_is_good(&mut self, surface: &SurfaceDesc, material: Option<&str>, object: &str, span: Span) -> bool {
        let law = self.scene.settings.friction_law;
        let value = effective_surface(&self.scene.materials, material, surface).friction;
        if law == FrictionLaw::Coulomb || value <= parse::LARGEST_FRICTION {
            return true;
        }
        self.found.push(span, format!("{object}: {}", parse::friction_message(value, law)));
        false
    }

    fn substance_shape(&mut self, s: &SubstanceDesc, object: &str, span: Span) -> Option<Arc<dyn Shape>> {
        if !self.friction_is_good(&s.surface, s.material.as_deref(), object, span) {
            return None;
        }
        match self.shape(&s.shape) {
            Ok(shape) => Some(shape),
            Err(e) => {
                self.found.push(s.shape_span, format!("{object}: shape: {e}"));
                None
            }
        }
    }

    fn body(&mut self, b: &BodyDesc) {
        let object = format!("body '{}'", b.name);
        let Some(shape) = self.substance_shape(&b.substance, &object, b.span) else { return };
        match add(&mut self.world, &self.scene.materials, b, shape) {
            Ok(id) => self.ids.push(id),
            Err(e) => self.found.push(b.span, e.to_string()),
        }
    }

    fn lattice(&mut self, l: &LatticeDesc) {
        let mut prototypes = Vec::with_capacity(l.bodies.len());
        for (i, s) in l.bodies.iter().enumerate() {
            let object = format!("lattice '{}': body[{i}]", l.name);
            let Some(shape) = self.substance_shape(s, &object, l.span) else { return };
            prototypes.push(substance(&self.scene.materials, s, shape));
        }
        let reach: Vec<Real> = prototypes.iter().map(|p| reach(&*p.shape)).collect();
        self.ids.reserve(l.count.iter().map(|&n| n as usize).product());
        for p in l.points(self.scene.seed, &reach) {
            let def = BodyDef {
                position: p.center,
                velocity: p.velocity,
                angular_velocity: p.angular_velocity,
                ..prototypes[p.kind].clone()
            };
            match self.world.add_body(def) {
                Ok(id) => self.ids.push(id),
                Err(e) => return self.found.push(l.span, format!("lattice '{}': {e}", l.name)),
            }
        }
    }

    fn table(&mut self, t: &BodyTableDesc) {
        self.ids.reserve(t.rows.len());
        for (i, row) in t.rows.rows.iter().enumerate() {
            let s = row_substance(&t.rows, row);
            let object = format!("body_table '{}': body {i}", t.name);
            let Some(shape) = self.substance_shape(&s, &object, t.span) else { return };
            let def = BodyDef {
                position: row.position,
                orientation: row.orientation,
                velocity: row.velocity,
                angular_velocity: row.angular_velocity,
                ..substance(&self.scene.materials, &s, shape)
            };
            match self.world.add_body(def) {
                Ok(id) => self.ids.push(id),
                Err(e) => return self.found.push(t.span, format!("{object}: {e}")),
            }
        }
    }

    fn boundary(&mut self, b: &BoundaryDesc) -> Vec<BoundaryId> {
        let object = format!("boundary '{}'", b.name);
        if !self.friction_is_good(&b.surface, b.material.as_deref(), &object, b.span) {
            return Vec::new();
        }
        let surface = effective_surface(&self.scene.materials, b.material.as_deref(), &b.surface);
        add_boundary(&mut self.world, b, surface).unwrap_or_else(|e| {
            self.found.push(b.span, format!("{object}: {e}"));
            Vec::new()
        })
    }
}

/// Largest distance of a point of the shape from its centre of mass \[m\].
fn reach(shape: &dyn Shape) -> Real {
    let ball = shape.bounding_sphere();
    ball.center.length() + ball.radius
}

fn add_boundary(world: &mut World, b: &BoundaryDesc, surface: Surface) -> Result<Vec<BoundaryId>, Error> {
    let (position, shape): (Vec3, Arc<dyn Shape>) = match b.kind {
        BoundaryKind::Box { min, max } => return world.add_box(&b.name, min, max, surface).map(|ids| ids.to_vec()),
        BoundaryKind::HalfSpace { point, normal } => (point, Arc::new(HalfSpace::new(normal)?)),
        BoundaryKind::Plane { point, normal } => (point, Arc::new(LimitPlane::new(normal)?)),
        BoundaryKind::Quadrangle { points, normal } => {
            let (center, face) = LimitQuadrangle::new(points, normal)?;
            (center, Arc::new(face))
        }
    };
    world.add_boundary(BoundaryDef { name: b.name.clone(), shape, position, surface }).map(|id| vec![id])
}

/// Makes one body.
fn add(world: &mut World, materials: &[Material], b: &BodyDesc, shape: Arc<dyn Shape>) -> Result<BodyId, Error> {
    let position = match b.placement {
        Placement::CenterOfMass(c) => c,
        Placement::Origin(p) => p - rotated(b.orientation, shape.author_origin()),
    };
    let angular_velocity = match b.turning {
        Turning::Velocity(w) => w,
        Turning::Momentum(_) => Vec3::ZERO,
    };
    let def = BodyDef {
        name: b.name.clone(),
        position,
        orientation: b.orientation,
        velocity: b.velocity,
        angular_velocity,
        ..substance(materials, &b.substance, shape)
    };
    let id = world.add_body(def)?;
    if let Turning::Momentum(l) = b.turning {
        world.set_angular_momentum(id, l)?;
    }
    Ok(id)
}

/// A vector of the body's axes in the world's.
fn rotated(orientation: Quat, v: Vec3) -> Vec3 {
    // Most shapes have their origin at the centre of mass, and no rotation may add round-off to a position then.
    if v == Vec3::ZERO {
        return Vec3::ZERO;
    }
    orientation.try_normalize().unwrap_or(Quat::IDENTITY).rotate(v)
}

fn material<'a>(materials: &'a [Material], name: Option<&str>) -> Option<&'a Material> {
    let name = name?;
    materials.binary_search_by(|m| m.name.as_str().cmp(name)).ok().map(|i| &materials[i])
}

/// Values given win over the material's, those over the default.
pub(crate) fn effective_surface(materials: &[Material], name: Option<&str>, given: &SurfaceDesc) -> Surface {
    let m = material(materials, name).map(|m| m.surface).unwrap_or_default();
    let d = Surface::default();
    Surface {
        friction: given.friction.or(m.friction).unwrap_or(d.friction),
        restitution: given.restitution.or(m.restitution).unwrap_or(d.restitution),
        friction_combine: given.friction_combine.or(m.friction_combine).unwrap_or(d.friction_combine),
        restitution_combine: given.restitution_combine.or(m.restitution_combine).unwrap_or(d.restitution_combine),
    }
}

/// A body of this substance at rest at the origin.
fn substance(materials: &[Material], s: &SubstanceDesc, shape: Arc<dyn Shape>) -> BodyDef {
    let density = material(materials, s.material.as_deref()).and_then(|m| m.density);
    let mass = match (s.mass, density) {
        (MassDesc::Fixed, _) => Mass::Infinite,
        (MassDesc::Value(m), _) => Mass::Value(m),
        (MassDesc::Density(d), _) | (MassDesc::Unset, Some(d)) => Mass::Density(d),
        (MassDesc::Unset, None) => Mass::Value(1.0),
    };
    let surface = effective_surface(materials, s.material.as_deref(), &s.surface);
    BodyDef { mass, surface, ..BodyDef::new(shape) }
}

/// What a body of a table is made of.
pub(crate) fn row_substance(table: &TableRows, row: &TableRow) -> SubstanceDesc {
    SubstanceDesc {
        shape: match row.shape {
            TableShape::Sphere => ShapeDesc::Sphere { radius: row.radius },
            TableShape::Tetrahedron => ShapeDesc::Tetrahedron { circumradius: row.radius },
        },
        mass: if row.mass == 0.0 { MassDesc::Unset } else { MassDesc::Value(row.mass) },
        material: (row.material != NO_MATERIAL).then(|| table.materials[row.material as usize].clone()),
        surface: SurfaceDesc::default(),
        color: None,
        shape_span: Span::default(),
    }
}

impl ShapeDesc {
    /// The shape, its centre of mass at the origin.
    ///
    /// # Errors
    /// No such body is possible: degenerate points, a surface that is not closed, a size out of range.
    pub fn build(&self) -> Result<Arc<dyn Shape>, Error> {
        Ok(match self {
            ShapeDesc::Sphere { radius } => Arc::new(Sphere::new(*radius)?),
            ShapeDesc::Tetrahedron { circumradius } => Arc::new(Polyhedron::tetrahedron(*circumradius)?),
            ShapeDesc::TetrahedronPoints(points) => Arc::new(Polyhedron::tetrahedron_from_points(*points)?),
            ShapeDesc::Cuboid { size } => Arc::new(Polyhedron::cuboid(*size)?),
            ShapeDesc::Polyhedron { points, faces } => Arc::new(Polyhedron::from_mesh(points, faces)?),
            ShapeDesc::ConvexHull { points } => Arc::new(Polyhedron::convex_hull(points)?),
            ShapeDesc::Quadrangle(points) => Arc::new(Quadrangle::new(*points)?),
        })
    }
}
