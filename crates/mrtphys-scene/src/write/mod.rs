//! From a world back to scene text.

mod values;

use crate::build::{Loaded, row_substance};
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::scene::{
    BodyDesc, BoundaryDesc, BoundaryKind, Camera, Content, LatticeDesc, Light, MassDesc, Placement, Scene, ScopeDesc,
    SubstanceDesc, SurfaceDesc, Turning,
};
use crate::source::LARGEST_TEXT;
use mrtphys::def::{BroadPhaseKind, Settings, Surface};
use mrtphys::id::BodyId;
use mrtphys::math::{Quat, Real, Vec3};
use mrtphys::world::Body;
use std::borrow::Cow;
use std::fmt::Write as _;
use values::{Number, Pairs, Text, Vector, flow, force, points, substance, surface, texts};

/// Scene text of a world as it is now. What has not changed since the scene was built is written as it was described; a
/// body that has changed is written with its state, bit for bit; a lattice or body table of which a body has changed is
/// written as single bodies. Reading the text and building it gives the same state; only time, contacts in progress and the
/// creation numbers of removed bodies are not part of a scene (a snapshot has them).
///
/// # Errors
/// The text is larger than [`LARGEST_TEXT`], so that it could not be read back.
pub fn to_toml(loaded: &Loaded) -> Result<String, Diagnostics> {
    let mut w = Writer { loaded, fresh: loaded.scene.build().ok(), out: String::new(), whole: Vec::new(), lattices: 0 };
    w.head();
    for i in 0..loaded.scene.contents.len() {
        w.content(i);
        if w.out.len() as u64 > LARGEST_TEXT {
            let message =
                format!("the scene as text would be larger than {} MiB; write a snapshot instead", LARGEST_TEXT >> 20);
            return Err(Diagnostic::without_place(&loaded.scene.source.name, message).into());
        }
    }
    w.boundaries();
    w.fields();
    w.view();
    Ok(w.out)
}

struct Writer<'a> {
    loaded: &'a Loaded,
    /// the world as the scene describes it, to see what has changed
    fresh: Option<Loaded>,
    out: String,
    /// for each content, whether it was written as it was described
    whole: Vec<bool>,
    /// lattices written
    lattices: u64,
}

fn explicit(s: &Surface) -> SurfaceDesc {
    SurfaceDesc {
        friction: Some(s.friction),
        restitution: Some(s.restitution),
        friction_combine: Some(s.friction_combine),
        restitution_combine: Some(s.restitution_combine),
    }
}

fn body_pairs(b: &BodyDesc) -> Pairs {
    let mut p = Pairs::default();
    p.add("name", Text(&b.name));
    substance(&mut p, &b.substance);
    match b.placement {
        Placement::Origin(at) => p.add("position", Vector(at)),
        Placement::CenterOfMass(at) => p.add("center_of_mass", Vector(at)),
    }
    let q = b.orientation;
    p.differing("orientation", q, Quat::IDENTITY, |q| format!("[{:?}, {:?}, {:?}, {:?}]", q.x, q.y, q.z, q.w));
    p.differing("velocity", b.velocity, Vec3::ZERO, |v| Vector(v).to_string());
    match b.turning {
        Turning::Velocity(w) => p.differing("angular_velocity", w, Vec3::ZERO, |w| Vector(w).to_string()),
        Turning::Momentum(l) => p.add("angular_momentum", Vector(l)),
    }
    p
}

/// A body with the state it has now.
fn present(name: String, described: &SubstanceDesc, now: &Body) -> BodyDesc {
    let mass = if now.mass == Real::INFINITY { MassDesc::Fixed } else { MassDesc::Value(now.mass) };
    BodyDesc {
        name,
        substance: SubstanceDesc { mass, material: None, surface: explicit(&now.surface), ..described.clone() },
        placement: Placement::CenterOfMass(now.position),
        orientation: now.orientation,
        velocity: now.velocity,
        turning: Turning::Momentum(now.angular_momentum),
        span: described.shape_span,
    }
}

fn same_state(a: &Body, b: &Body) -> bool {
    let same_vectors = a.position == b.position
        && a.velocity == b.velocity
        && a.angular_momentum == b.angular_momentum
        && a.orientation == b.orientation;
    same_vectors && a.mass == b.mass && a.surface == b.surface && a.set_aside == b.set_aside
}

/// What the body with this number in a lattice is made of.
fn lattice_substance(l: &LatticeDesc, i: usize) -> &SubstanceDesc {
    let [_, ny, nz] = l.count.map(|n| n as usize);
    &l.bodies[(i / (ny * nz) + i / nz % ny + i % nz) % l.bodies.len()]
}

impl Writer<'_> {
    fn scene(&self) -> &Scene {
        &self.loaded.scene
    }

    fn section(&mut self, header: &str, pairs: &Pairs) {
        let _ = write!(self.out, "\n{header}\n{}", pairs.lines());
    }

    fn head(&mut self) {
        let scene = &self.loaded.scene;
        let _ = writeln!(self.out, "format = 1\ntitle = {}", Text(&scene.title));
        let settings = self.loaded.world.settings();
        self.section("[simulation]", &simulation(scene, settings));
        let mut medium = Pairs::default();
        medium.differing("viscosity", settings.viscosity, 0.0, |x| Number(x).to_string());
        medium.differing("density", settings.medium_density, 0.0, |x| Number(x).to_string());
        if !medium.0.is_empty() {
            self.section("[medium]", &medium);
        }
        for m in &scene.materials {
            let mut p = Pairs::default();
            p.0.extend(m.density.map(|d| ("density", Number(d).to_string())));
            surface(&mut p, &m.surface);
            self.section(&format!("[material.{}]", Text(&m.name)), &p);
        }
    }

    /// The body as it is, if it is still there.
    fn now(&self, id: BodyId) -> Option<Body> {
        self.loaded.world.body(id).ok()
    }

    /// Whether all bodies of a content are what the scene describes.
    fn is_whole(&self, content: usize) -> bool {
        let Some(fresh) = &self.fresh else { return false };
        let pairs = self.loaded.names.ids_in(content).iter().zip(fresh.names.ids_in(content));
        pairs.into_iter().all(|(&id, &as_described)| match (self.now(id), fresh.world.body(as_described)) {
            (Some(now), Ok(described)) => same_state(&now, &described),
            _ => false,
        })
    }

    fn content(&mut self, i: usize) {
        let whole = self.is_whole(i);
        self.whole.push(whole);
        let loaded = self.loaded;
        match (&loaded.scene.contents[i], whole) {
            (Content::Body(b), true) => self.section("[[body]]", &body_pairs(b)),
            (Content::Lattice(l), true) => self.lattice(l),
            (Content::Table(t), true) => {
                let mut p = Pairs::default();
                p.add("name", Text(&t.name));
                p.add("file", Text(&t.file));
                self.section("[[body_table]]", &p);
            }
            (content, false) => {
                for (k, &id) in loaded.names.ids_in(i).iter().enumerate() {
                    let described = match content {
                        Content::Body(b) => Cow::Borrowed(&b.substance),
                        Content::Lattice(l) => Cow::Borrowed(lattice_substance(l, k)),
                        Content::Table(t) => Cow::Owned(row_substance(&t.rows, &t.rows.rows[k])),
                    };
                    self.changed_body(id, loaded.names.name_in(i, k), &described);
                }
            }
        }
    }

    fn changed_body(&mut self, id: BodyId, name: String, described: &SubstanceDesc) {
        let Some(now) = self.now(id) else { return };
        if now.set_aside {
            let _ = writeln!(self.out, "\n# left out: {} (its motion was no longer finite)", Text(&name));
            return;
        }
        self.section("[[body]]", &body_pairs(&present(name, described, &now)));
    }

    fn lattice(&mut self, l: &LatticeDesc) {
        let mut p = Pairs::default();
        p.add("name", Text(&l.name));
        p.add("count", format!("{:?}", l.count));
        p.add("min", Vector(l.min));
        p.add("max", Vector(l.max));
        let number = |x: Real| Number(x).to_string();
        p.differing("jitter", l.jitter, 0.0, number);
        p.add("speed", Number(l.speed));
        p.differing("spin", l.spin, 0.0, number);
        if l.seed.is_some() || l.place != self.lattices {
            p.add("seed", l.stream_seed(self.scene().seed));
        }
        let bodies = l.bodies.iter().map(|s| {
            let mut p = Pairs::default();
            substance(&mut p, s);
            p.line()
        });
        p.add("body", format!("[{}]", bodies.collect::<Vec<_>>().join(", ")));
        self.section("[[lattice]]", &p);
        self.lattices += 1;
    }

    fn boundaries(&mut self) {
        let loaded = self.loaded;
        let mut first = 0;
        for b in &loaded.scene.boundaries {
            let count = if matches!(b.kind, BoundaryKind::Box { .. }) { 6 } else { 1 };
            let ids = &loaded.names.boundaries()[first..first + count];
            first += count;
            let described = crate::build::effective_surface(&loaded.scene.materials, b.material.as_deref(), &b.surface);
            let surfaces: Vec<Surface> =
                ids.iter().map(|&id| loaded.world.boundary(id).map_or(described, |view| view.surface)).collect();
            if surfaces.iter().all(|s| *s == described) {
                self.boundary(b);
            } else if surfaces.iter().all(|s| *s == surfaces[0]) {
                self.boundary(&BoundaryDesc { surface: explicit(&surfaces[0]), material: None, ..b.clone() });
            } else {
                self.faces(b, &surfaces);
            }
        }
    }

    fn boundary(&mut self, b: &BoundaryDesc) {
        let mut p = Pairs::default();
        p.add("name", Text(&b.name));
        let mut add = |kind, pairs: [(&'static str, String); 2]| {
            p.add("kind", Text(kind));
            p.0.extend(pairs);
        };
        let vector = |v: Vec3| Vector(v).to_string();
        match b.kind {
            BoundaryKind::Box { min, max } => add("box", [("min", vector(min)), ("max", vector(max))]),
            BoundaryKind::HalfSpace { point, normal } => {
                add("half-space", [("point", vector(point)), ("normal", vector(normal))])
            }
            BoundaryKind::Plane { point, normal } => {
                add("plane", [("point", vector(point)), ("normal", vector(normal))])
            }
            BoundaryKind::Quadrangle { points: four, normal } => {
                add("quadrangle", [("points", points(&four)), ("normal", vector(normal))])
            }
        }
        surface(&mut p, &b.surface);
        p.0.extend(b.material.as_ref().map(|m| ("material", Text(m).to_string())));
        p.0.extend(b.color.map(|c| ("color", Text(&c.to_string()).to_string())));
        self.section("[[boundary]]", &p);
    }

    /// A box whose faces have surfaces of their own, as six quadrangles.
    fn faces(&mut self, b: &BoundaryDesc, surfaces: &[Surface]) {
        let BoundaryKind::Box { min, max } = b.kind else { return };
        for (face, s) in surfaces.iter().enumerate() {
            let (axis, upper) = (face / 2, face % 2 == 1);
            let corner = |u: bool, v: bool| {
                let mut along = [upper; 3];
                (along[(axis + 1) % 3], along[(axis + 2) % 3]) = (u, v);
                let (low, high) = (min.min(max).to_array(), min.max(max).to_array());
                let [x, y, z] = std::array::from_fn(|i| if along[i] { high[i] } else { low[i] });
                Vec3::new(x, y, z)
            };
            let mut normal = [0.0; 3];
            normal[axis] = if upper { -1.0 } else { 1.0 };
            let kind = BoundaryKind::Quadrangle {
                points: [corner(false, false), corner(true, false), corner(true, true), corner(false, true)],
                normal: Vec3::new(normal[0], normal[1], normal[2]),
            };
            let name = format!("{}.{}", b.name, crate::names::BOX_FACES[face]);
            self.boundary(&BoundaryDesc { name, kind, surface: explicit(s), material: None, ..b.clone() });
        }
    }

    /// What carries a field and what it acts on, with what is still there; `None`: its carrier is gone.
    fn scope(&self, p: &mut Pairs, scope: &ScopeDesc) -> Option<()> {
        let names = &self.loaded.names;
        if let Some(carrier) = &scope.carrier {
            names.body(carrier).and_then(|id| self.now(id))?;
            p.add("body", Text(carrier));
        }
        if let Some(only) = &scope.only {
            let mut all = Vec::new();
            for name in only {
                let ids = names.bodies_of(name).unwrap_or_default();
                let content = ids.first().and_then(|&id| names.content_of(id)).map_or(0, |(c, _)| c);
                if self.whole.get(content) == Some(&true) {
                    all.push(Cow::Borrowed(name.as_str()));
                    continue;
                }
                let there = ids.iter().filter(|&&id| self.now(id).is_some_and(|b| !b.set_aside));
                all.extend(there.filter_map(|&id| names.body_name(id)).map(Cow::Owned));
            }
            p.add("only", texts(all.into_iter()));
        }
        if !scope.reaction {
            p.add("reaction", false);
        }
        Some(())
    }

    fn fields(&mut self) {
        let scene = &self.loaded.scene;
        for f in &scene.force_fields {
            let mut p = force(&f.kind, f.scope.carrier.is_some());
            if self.scope(&mut p, &f.scope).is_some() {
                self.section("[[force_field]]", &p);
            }
        }
        for f in &scene.flow_fields {
            let mut p = flow(&f.kind);
            if self.scope(&mut p, &f.scope).is_some() {
                self.section("[[flow_field]]", &p);
            }
        }
    }

    fn view(&mut self) {
        if let Some(Camera { eye, look_at, up, fov_deg }) = self.scene().camera {
            let mut p = Pairs::default();
            p.add("eye", Vector(eye));
            p.add("look_at", Vector(look_at));
            p.add("up", Vector(up));
            p.add("fov_deg", Number(fov_deg));
            self.section("[camera]", &p);
        }
        for Light { direction, color } in &self.loaded.scene.lights {
            let mut p = Pairs::default();
            p.add("direction", Vector(*direction));
            p.add("color", Text(&color.to_string()));
            self.section("[[light]]", &p);
        }
    }
}

fn simulation(scene: &Scene, s: &Settings) -> Pairs {
    let d = Settings::default();
    let mut p = Pairs::default();
    p.add("seconds", Number(scene.seconds));
    p.add("fps", s.fps);
    p.add("steps_per_frame", s.steps_per_frame);
    let mut name = |key, value: &str, default: &str| p.differing(key, value, default, |v| Text(v).to_string());
    name("algorithm", s.algorithm.name(), d.algorithm.name());
    name("broad_phase", &s.broad_phase.to_string(), &BroadPhaseKind::SortedGrid.to_string());
    name("friction_law", s.friction_law.name(), d.friction_law.name());
    name("impact", s.impact.name(), d.impact.name());
    name("contact", s.contact.name(), d.contact.name());
    name("inertia", s.inertia.name(), d.inertia.name());
    name("integrator", s.integrator.name(), d.integrator.name());
    p.differing("viscous_spin", s.viscous_spin, false, |v| v.to_string());
    p.add("seed", scene.seed);
    p
}
