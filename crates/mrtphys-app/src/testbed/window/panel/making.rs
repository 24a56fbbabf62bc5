//! Bodies made, copied, thrown and colored by hand: changes of a world, as plain functions.

use mrtphys::math::Quat;
use mrtphys::shape::{HalfSpace, LimitQuadrangle, Polyhedron, Sphere};
use mrtphys::world::Body;
use mrtphys::{BodyId, Real, Vec3, World};
use mrtphys_scene::scene::{
    BodyDesc, Color, Content, MassDesc, Placement, ShapeDesc, SubstanceDesc, SurfaceDesc, Turning,
};
use mrtphys_scene::{Loaded, Span};

/// Kinds of body that can be made by hand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// a ball
    #[default]
    Sphere,
    /// regular
    Tetrahedron,
    /// a box
    Box,
    /// regular
    Octahedron,
    /// a thin square
    Plate,
}

impl Kind {
    /// All kinds with their names.
    pub const ALL: [(Kind, &'static str); 5] = [
        (Kind::Sphere, "sphere"),
        (Kind::Tetrahedron, "tetrahedron"),
        (Kind::Box, "box"),
        (Kind::Octahedron, "octahedron"),
        (Kind::Plate, "quadrangle"),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        Kind::ALL.iter().find(|(k, _)| *k == self).map_or("body", |(_, name)| name)
    }
}

/// What is to be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern {
    /// kind
    pub kind: Kind,
    /// radius of the circumscribed sphere \[m\]
    pub radius: Real,
    /// edges of a box \[m\]
    pub edges: Vec3,
    /// mass
    pub mass: MassDesc,
    /// velocity \[m/s\]
    pub velocity: Vec3,
    /// angular velocity \[rad/s\]
    pub spin: Vec3,
}

impl Pattern {
    /// A sphere of this radius \[m\] and 1 kg.
    pub fn sphere(radius: Real) -> Pattern {
        let edges = Vec3::splat(radius);
        Pattern {
            kind: Kind::Sphere,
            radius,
            edges,
            mass: MassDesc::Value(1.0),
            velocity: Vec3::ZERO,
            spin: Vec3::ZERO,
        }
    }

    /// Its shape in the scene language.
    pub fn shape(&self) -> ShapeDesc {
        let r = self.radius;
        match self.kind {
            Kind::Sphere => ShapeDesc::Sphere { radius: r },
            Kind::Tetrahedron => ShapeDesc::Tetrahedron { circumradius: r },
            Kind::Box => ShapeDesc::Cuboid { size: self.edges },
            Kind::Octahedron => {
                let ends = [Vec3::X, Vec3::Y, Vec3::Z].map(|a| [a * r, a * -r]);
                ShapeDesc::ConvexHull { points: ends.concat().into() }
            }
            Kind::Plate => {
                // A square in the xz plane whose corners lie on the circle.
                ShapeDesc::Quadrangle([Vec3::X * r, Vec3::Z * -r, Vec3::X * -r, Vec3::Z * r])
            }
        }
    }

    /// Radius of a ball about the centre that holds it \[m\].
    pub fn reach(&self) -> Real {
        if self.kind == Kind::Box { self.edges.length() / 2.0 } else { self.radius }
    }

    /// What is wrong with it, if anything.
    pub fn complaint(&self) -> Option<&'static str> {
        let good = |x: Real| x > 0.0 && x.is_finite();
        let sizes =
            if self.kind == Kind::Box { self.edges.to_array().into_iter().all(good) } else { good(self.radius) };
        if !sizes {
            return Some("sizes must be positive");
        }
        match self.mass {
            MassDesc::Value(m) | MassDesc::Density(m) if !good(m) => Some("mass and density must be positive"),
            MassDesc::Density(_) if self.kind == Kind::Plate => Some("a quadrangle has no volume: give a mass"),
            _ => None,
        }
    }

    fn body(&self, name: String, center: Vec3) -> BodyDesc {
        let substance = SubstanceDesc {
            shape: self.shape(),
            mass: self.mass,
            material: None,
            surface: SurfaceDesc::default(),
            color: None,
            shape_span: Span::default(),
        };
        BodyDesc {
            name,
            substance,
            placement: Placement::CenterOfMass(center),
            orientation: Quat::IDENTITY,
            velocity: self.velocity,
            turning: Turning::Velocity(self.spin),
            span: Span::default(),
        }
    }
}

/// Makes a body at the free place nearest to `near`.
///
/// # Errors
/// What the world says, or that there is no place.
pub fn add(loaded: &mut Loaded, pattern: &Pattern, near: Vec3) -> Result<BodyId, String> {
    let reach = pattern.reach();
    let place = free_place(&loaded.world, near, reach).ok_or("there is no free place near by for this body")?;
    put(loaded, pattern, place)
}

fn put(loaded: &mut Loaded, pattern: &Pattern, place: Vec3) -> Result<BodyId, String> {
    let name = free_name(loaded, pattern.kind.name());
    loaded.add_body(pattern.body(name, place)).map_err(|e| plain(&e))
}

/// Throws a body from the eye along the line of sight: it starts at the first place on that line where it is inside all walls
/// and meets no other body.
///
/// # Errors
/// What the world says, or that the line of sight never gets inside the walls.
pub fn throw(loaded: &mut Loaded, pattern: &Pattern, eye: Vec3, direction: Vec3) -> Result<BodyId, String> {
    let reach = pattern.reach();
    let walls = walls(&loaded.world);
    let (start, end) = stretch(&walls, eye, direction, reach)
        .ok_or("looking from here, the line of sight is nowhere inside the walls: turn the view")?;
    let others = others(&loaded.world);
    let end = end.min(start + reach * 400.0);
    let mut s = start;
    while s <= end {
        let place = eye + direction * s;
        if is_free(&others, place, reach) {
            return put(loaded, pattern, place);
        }
        s += reach;
    }
    Err("there is no free place on the line of sight".into())
}

/// Makes another body like this one beside it, with the same motion.
///
/// # Errors
/// What the world says, that the body cannot be copied, or that there is no place.
pub fn duplicate(loaded: &mut Loaded, id: BodyId) -> Result<BodyId, String> {
    let body = loaded.world.body(id).map_err(|e| e.to_string())?;
    let mut substance = substance_of(loaded, &body)?;
    substance.mass = if body.mass == Real::INFINITY { MassDesc::Fixed } else { MassDesc::Value(body.mass) };
    substance.surface = SurfaceDesc {
        friction: Some(body.surface.friction),
        restitution: Some(body.surface.restitution),
        friction_combine: Some(body.surface.friction_combine),
        restitution_combine: Some(body.surface.restitution_combine),
    };
    let ball = body.shape.bounding_sphere();
    let reach = ball.center.length() + ball.radius;
    let place = free_place(&loaded.world, body.position, reach).ok_or("there is no free place beside it")?;
    let original = loaded.names.body_name(id).unwrap_or_else(|| body.kind.clone());
    let name = free_name(loaded, original.trim_end_matches(|c: char| c.is_ascii_digit() || c == ' '));
    let copy = BodyDesc {
        name,
        substance,
        placement: Placement::CenterOfMass(place),
        orientation: body.orientation,
        velocity: body.velocity,
        turning: Turning::Velocity(body.angular_velocity),
        span: Span::default(),
    };
    loaded.add_body(copy).map_err(|e| plain(&e))
}

/// What a body is made of, in the scene language.
fn substance_of(loaded: &Loaded, body: &Body) -> Result<SubstanceDesc, String> {
    let content = loaded.names.content_of(body.id).map(|(c, i)| (&loaded.scene.contents[c], i));
    match content {
        Some((Content::Body(b), _)) => Ok(b.substance.clone()),
        Some((Content::Lattice(l), i)) => Ok(l.bodies[kind_in_lattice(l.count, l.bodies.len(), i)].clone()),
        _ => {
            let shape = if let Some(s) = body.shape.downcast::<Sphere>() {
                ShapeDesc::Sphere { radius: s.radius() }
            } else if let Some(p) = body.shape.downcast::<Polyhedron>().filter(|p| p.is_convex()) {
                ShapeDesc::ConvexHull { points: p.corners().to_vec().into() }
            } else {
                return Err(format!("a body of kind '{}' cannot be copied", body.kind));
            };
            Ok(SubstanceDesc {
                shape,
                mass: MassDesc::Unset,
                material: None,
                surface: SurfaceDesc::default(),
                color: None,
                shape_span: Span::default(),
            })
        }
    }
}

/// Which of a lattice's kinds its body number `i` is: they alternate like the fields of a chess board.
fn kind_in_lattice(count: [u32; 3], kinds: usize, i: usize) -> usize {
    let [_, ny, nz] = count.map(|n| n as usize);
    (i / (ny * nz) + i / nz % ny + i % nz) % kinds
}

/// Colors a body; in a lattice, all bodies of its kind with it, as the scene language says it.
///
/// # Errors
/// Bodies of a table have no color of their own.
pub fn paint(loaded: &mut Loaded, id: BodyId, rgb: [u8; 3]) -> Result<(), String> {
    let (content, i) = loaded.names.content_of(id).ok_or("this body is not in the scene")?;
    let color = Some(Color { rgb });
    match &mut loaded.scene.contents[content] {
        Content::Body(b) => b.substance.color = color,
        Content::Lattice(l) => {
            let kind = kind_in_lattice(l.count, l.bodies.len(), i);
            l.bodies[kind].color = color;
        }
        Content::Table(_) => return Err("bodies of a table have no color of their own".into()),
    }
    Ok(())
}

/// The first free name of this kind: `sphere 1`, `sphere 2`.
fn free_name(loaded: &Loaded, stem: &str) -> String {
    let stem = stem.split('[').next().unwrap_or(stem).trim();
    let stem = if stem.is_empty() { "body" } else { stem };
    // There are finitely many names, so that one of these is free.
    let taken = loaded.names.bodies().len() + 1;
    let name = |n: usize| format!("{stem} {n}");
    (1..=taken).map(name).find(|n| !loaded.names.is_taken(n)).unwrap_or_else(|| name(taken + 1))
}

/// Every body's centre and a radius that holds it \[m\].
fn others(world: &World) -> Vec<(Vec3, Real)> {
    let ball = |id: BodyId| {
        let body = world.body(id).ok()?;
        let ball = body.shape.bounding_sphere();
        Some((body.position, ball.center.length() + ball.radius))
    };
    world.bodies().filter_map(ball).collect()
}

fn is_free(others: &[(Vec3, Real)], place: Vec3, reach: Real) -> bool {
    others.iter().all(|(x, r)| (*x - place).length() > r + reach)
}

/// A wall that has an inner side: a point of it, and its normal inwards.
struct Wall {
    point: Vec3,
    normal: Vec3,
}

fn walls(world: &World) -> Vec<Wall> {
    let wall = |id| {
        let b = world.boundary(id).ok()?;
        let half_space = b.shape.downcast::<HalfSpace>().map(|h| h.normal());
        let normal = half_space.or_else(|| b.shape.downcast::<LimitQuadrangle>().map(|q| q.normal()))?;
        Some(Wall { point: b.position, normal })
    };
    world.boundaries().filter_map(wall).collect()
}

/// The part of a half-line on which a ball is inside all walls: distances \[m\].
fn stretch(walls: &[Wall], from: Vec3, direction: Vec3, reach: Real) -> Option<(Real, Real)> {
    let (mut start, mut end): (Real, Real) = (0.0, Real::INFINITY);
    for wall in walls {
        // Inside while room + s speed >= 0.
        let (room, speed) = ((from - wall.point).dot(wall.normal) - reach, direction.dot(wall.normal));
        if speed > 0.0 {
            start = start.max(-room / speed);
        } else if speed < 0.0 {
            end = end.min(room / -speed);
        } else if room < 0.0 {
            return None;
        }
    }
    (start <= end).then_some((start, end))
}

/// How many shells of places are tried round the wanted one.
const SHELLS: u32 = 24;

/// The place nearest to `near` where a ball of this radius is inside all walls and meets no body.
fn free_place(world: &World, near: Vec3, reach: Real) -> Option<Vec3> {
    let (walls, others) = (walls(world), others(world));
    let inside = |p: Vec3| walls.iter().all(|w| (p - w.point).dot(w.normal) >= reach);
    let good = |p: Vec3| inside(p) && is_free(&others, p, reach);
    if good(near) {
        return Some(near);
    }
    let signs = [0.0, 1.0, -1.0];
    let mut directions = Vec::new();
    for y in [0.0, 1.0, -1.0] {
        for x in signs {
            directions.extend(signs.map(|z| Vec3::new(x, y, z)).into_iter().filter_map(Vec3::try_normalize));
        }
    }
    let shells = (1..=SHELLS).map(|k| Real::from(k) * reach * 1.05);
    shells.flat_map(|s| directions.iter().map(move |d| near + *d * s)).find(|p| good(*p))
}

fn plain(e: &mrtphys_scene::Diagnostics) -> String {
    e.list.first().map_or_else(|| e.to_string(), |d| d.message.clone())
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys_scene::Scene;

    fn room() -> Loaded {
        let text = "format = 1\n[[boundary]]\nname = \"room\"\nkind = \"box\"\nmin = [0, 0, 0]\nmax = [4, 4, 4]\n\
                    [[body]]\nname = \"ball\"\nshape = { kind = \"sphere\", radius = 0.5 }\nposition = [2, 2, 2]\nvelocity = [1, 0, 0]\n\
                    [[lattice]]\nname = \"grid\"\ncount = [2, 1, 1]\nmin = [0, 3, 3]\nmax = [2, 4, 4]\n\
                    [[lattice.body]]\nshape = { kind = \"sphere\", radius = 0.2 }\n\
                    [[lattice.body]]\nshape = { kind = \"tetrahedron\", circumradius = 0.2 }\n";
        Scene::from_text("test", text).unwrap().build().unwrap()
    }

    #[test]
    fn every_kind_can_be_made_and_bears_the_first_free_name() {
        let mut loaded = room();
        for (kind, name) in Kind::ALL {
            let pattern = Pattern { kind, velocity: Vec3::Y, ..Pattern::sphere(0.2) };
            assert_eq!(pattern.complaint(), None);
            let id = add(&mut loaded, &pattern, Vec3::splat(1.0)).unwrap();
            assert_eq!(loaded.names.body_name(id), Some(format!("{name} 1")));
            let body = loaded.world.body(id).unwrap();
            assert_eq!((body.mass, body.velocity), (1.0, Vec3::Y));
            let ball = body.shape.bounding_sphere();
            assert!(ball.center.length() + ball.radius <= pattern.reach() * (1.0 + 1e-12), "{name}");
        }
        assert_eq!(
            add(&mut loaded, &Pattern::sphere(0.1), Vec3::splat(3.0)).map(|id| loaded.names.body_name(id)),
            Ok(Some("sphere 2".into()))
        );
        assert!(loaded.world.overlaps().is_empty(), "each has a place of its own");
    }

    #[test]
    fn what_cannot_be_made_is_said() {
        let mut loaded = room();
        let sphere = Pattern::sphere(0.2);
        for bad in [
            Pattern { radius: 0.0, ..sphere },
            Pattern { mass: MassDesc::Value(-1.0), ..sphere },
            Pattern { kind: Kind::Box, edges: Vec3::X, ..sphere },
            Pattern { kind: Kind::Plate, mass: MassDesc::Density(1.0), ..sphere },
        ] {
            assert!(bad.complaint().is_some(), "{bad:?}");
            let before = loaded.world.state_hash();
            assert!(add(&mut loaded, &bad, Vec3::splat(1.0)).is_err(), "{bad:?}");
            assert_eq!(loaded.world.state_hash(), before);
        }
        assert!(add(&mut loaded, &Pattern::sphere(3.0), Vec3::splat(1.0)).unwrap_err().contains("no free place"));
    }

    #[test]
    fn a_body_thrown_from_outside_starts_inside_the_walls() {
        let mut loaded = room();
        let pattern = Pattern { velocity: Vec3::Z * -7.0, ..Pattern::sphere(0.25) };
        let id = throw(&mut loaded, &pattern, Vec3::new(1.0, 1.0, 50.0), Vec3::Z * -1.0).unwrap();
        let body = loaded.world.body(id).unwrap();
        assert_eq!((body.position, body.velocity), (Vec3::new(1.0, 1.0, 3.75), Vec3::Z * -7.0));
        // From inside it starts at the eye.
        let id = throw(&mut loaded, &pattern, Vec3::new(3.0, 1.0, 1.0), Vec3::Z * -1.0).unwrap();
        assert_eq!(loaded.world.body(id).unwrap().position, Vec3::new(3.0, 1.0, 1.0));
        assert!(throw(&mut loaded, &pattern, Vec3::new(1.0, 9.0, 50.0), Vec3::Z * -1.0).is_err());
        assert!(loaded.world.overlaps().is_empty());
    }

    #[test]
    fn a_copy_is_the_same_beside_the_first() {
        let mut loaded = room();
        let ids: Vec<BodyId> = loaded.world.bodies().collect();
        for id in ids {
            let copy = duplicate(&mut loaded, id).unwrap();
            let (a, b) = (loaded.world.body(id).unwrap(), loaded.world.body(copy).unwrap());
            assert_eq!((a.mass, a.velocity, a.surface, a.kind), (b.mass, b.velocity, b.surface, b.kind));
            assert_ne!(a.position, b.position);
        }
        assert!(loaded.names.body("ball 1").is_some() && loaded.names.body("grid 1").is_some());
        assert!(loaded.world.overlaps().is_empty());
    }

    #[test]
    fn a_color_is_a_body_s_or_that_of_its_kind_in_a_lattice() {
        let mut loaded = room();
        let id = |l: &Loaded, name| l.names.body(name).unwrap();
        let (ball, first, second) = (id(&loaded, "ball"), id(&loaded, "grid[0,0,0]"), id(&loaded, "grid[1,0,0]"));
        paint(&mut loaded, ball, [1, 2, 3]).unwrap();
        paint(&mut loaded, second, [4, 5, 6]).unwrap();
        assert_eq!(loaded.color(ball).map(|c| c.rgb), Some([1, 2, 3]));
        assert_eq!(loaded.color(second).map(|c| c.rgb), Some([4, 5, 6]));
        assert_eq!(loaded.color(first), None);
    }
}
