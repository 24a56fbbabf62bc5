//! How values are written.

use crate::scene::{FlowKind, ForceKind, MassDesc, ShapeDesc, SubstanceDesc, SurfaceDesc};
use mrtphys::math::{Real, Vec3};
use std::borrow::Cow;
use std::fmt::{Display, Write as _};

// `{:?}` of a number is the shortest text that reads back bit for bit.

pub(super) struct Vector(pub Vec3);

impl Display for Vector {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Vec3 { x, y, z, .. } = self.0;
        write!(f, "[{x:?}, {y:?}, {z:?}]")
    }
}

pub(super) struct Number(pub Real);

impl Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

pub(super) struct Text<'a>(pub &'a str);

impl Display for Text<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_char('"')?;
        for c in self.0.chars() {
            match c {
                '"' => f.write_str("\\\"")?,
                '\\' => f.write_str("\\\\")?,
                c if c.is_control() => write!(f, "\\U{:08X}", c as u32)?,
                c => f.write_char(c)?,
            }
        }
        f.write_char('"')
    }
}

pub(super) fn points(points: &[Vec3]) -> String {
    format!("[{}]", points.iter().map(|p| Vector(*p).to_string()).collect::<Vec<_>>().join(", "))
}

pub(super) fn texts<'a>(all: impl Iterator<Item = Cow<'a, str>>) -> String {
    format!("[{}]", all.map(|t| Text(&t).to_string()).collect::<Vec<_>>().join(", "))
}

/// `key = value` pairs, for a table of its own or for one in a line.
#[derive(Default)]
pub(super) struct Pairs(pub Vec<(&'static str, String)>);

impl Pairs {
    pub fn add(&mut self, key: &'static str, value: impl Display) {
        self.0.push((key, value.to_string()));
    }

    /// Adds what is not the default.
    pub fn differing<T: PartialEq>(&mut self, key: &'static str, value: T, default: T, show: impl FnOnce(T) -> String) {
        if value != default {
            self.0.push((key, show(value)));
        }
    }

    pub fn lines(&self) -> String {
        self.0.iter().fold(String::new(), |mut s, (k, v)| {
            let _ = writeln!(s, "{k} = {v}");
            s
        })
    }

    pub fn line(&self) -> String {
        format!("{{ {} }}", self.0.iter().map(|(k, v)| format!("{k} = {v}")).collect::<Vec<_>>().join(", "))
    }
}

pub(super) fn shape(s: &ShapeDesc) -> String {
    let mut p = Pairs::default();
    let kind = |k| Text(k).to_string();
    match s {
        ShapeDesc::Sphere { radius } => {
            p.add("kind", kind("sphere"));
            p.add("radius", Number(*radius));
        }
        ShapeDesc::Tetrahedron { circumradius } => {
            p.add("kind", kind("tetrahedron"));
            p.add("circumradius", Number(*circumradius));
        }
        ShapeDesc::TetrahedronPoints(four) => {
            p.add("kind", kind("tetrahedron"));
            p.add("points", points(four));
        }
        ShapeDesc::Cuboid { size } => {
            p.add("kind", kind("box"));
            p.add("size", Vector(*size));
        }
        ShapeDesc::Polyhedron { points: all, faces } => {
            p.add("kind", kind("polyhedron"));
            p.add("points", points(all));
            p.add("faces", format!("{faces:?}"));
        }
        ShapeDesc::ConvexHull { points: all } => {
            p.add("kind", kind("convex-hull"));
            p.add("points", points(all));
        }
        ShapeDesc::Quadrangle(four) => {
            p.add("kind", kind("quadrangle"));
            p.add("points", points(four));
        }
    }
    p.line()
}

pub(super) fn surface(p: &mut Pairs, s: &SurfaceDesc) {
    let combine = |c: mrtphys::def::Combine| Text(c.name()).to_string();
    let number = |x: Real| Number(x).to_string();
    p.0.extend(s.friction.map(|x| ("friction", number(x))));
    p.0.extend(s.restitution.map(|x| ("restitution", number(x))));
    p.0.extend(s.friction_combine.map(|c| ("friction_combine", combine(c))));
    p.0.extend(s.restitution_combine.map(|c| ("restitution_combine", combine(c))));
}

pub(super) fn substance(p: &mut Pairs, s: &SubstanceDesc) {
    p.add("shape", shape(&s.shape));
    match s.mass {
        MassDesc::Unset => {}
        MassDesc::Value(m) => p.add("mass", Number(m)),
        MassDesc::Density(d) => p.add("density", Number(d)),
        MassDesc::Fixed => p.add("fixed", true),
    }
    p.0.extend(s.material.as_ref().map(|m| ("material", Text(m).to_string())));
    surface(p, &s.surface);
    p.0.extend(s.color.map(|c| ("color", Text(&c.to_string()).to_string())));
}

pub(super) fn force(kind: &ForceKind, carried: bool) -> Pairs {
    let mut p = Pairs::default();
    match *kind {
        ForceKind::EarthGravity { g, direction } => {
            p.add("kind", Text("earth-gravity"));
            p.add("g", Number(g));
            p.differing("direction", direction, Vec3::new(0.0, -1.0, 0.0), |d| Vector(d).to_string());
        }
        ForceKind::Uniform { acceleration } => {
            p.add("kind", Text("uniform"));
            p.add("acceleration", Vector(acceleration));
        }
        ForceKind::Point { position, strength, exponent } => {
            p.add("kind", Text("point"));
            if !carried {
                p.add("position", Vector(position));
            }
            p.add("strength", Number(strength));
            p.add("exponent", exponent);
        }
        ForceKind::Vortex { point, axis, strength } => {
            p.add("kind", Text("vortex"));
            p.add("point", Vector(point));
            p.add("axis", Vector(axis));
            p.add("strength", Number(strength));
        }
    }
    p
}

pub(super) fn flow(kind: &FlowKind) -> Pairs {
    let mut p = Pairs::default();
    match *kind {
        FlowKind::Uniform { velocity } => {
            p.add("kind", Text("uniform"));
            p.add("velocity", Vector(velocity));
        }
        FlowKind::Vortex { point, axis, circulation } => {
            p.add("kind", Text("vortex"));
            p.add("point", Vector(point));
            p.add("axis", Vector(axis));
            p.add("circulation", Number(circulation));
        }
        FlowKind::Sink { point, strength } => {
            p.add("kind", Text("sink"));
            p.add("point", Vector(point));
            p.add("strength", Number(strength));
        }
    }
    p
}
