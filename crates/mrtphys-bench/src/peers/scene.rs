//! A scene without an engine: what every engine of a comparison is given, and the file that carries it.
//!
//! All engines read the same bytes. Layout of the file, little-endian, no padding:
//!
//! | bytes | what |
//! |---|---|
//! | 8 | the letters `MRTSCENE` |
//! | 4 x u32 | version (1), number of shapes, number of bodies, 1 if there is a container and 0 otherwise |
//! | 13 x f64 | time step, length unit, restitution, friction, gravity (3), lower corner (3) and upper corner (3) of the container |
//! | per shape: u32, u32, 3 f64 a point | kind (0 sphere, 1 box, 2 hull), number of points, points: (radius, 0, 0), half the edges, or the corners |
//! | per body: u32, u32, 13 f64 | shape, 1 if fixed, position (3), orientation (x, y, z, w), velocity (3), angular velocity (3) |

use mrtphys::Vec3;
use mrtphys::shape::{MassProperties, Polyhedron, Shape, Sphere};
use std::path::Path;
use std::sync::Arc;

/// Three numbers.
pub type Triple = [f64; 3];

/// A shape, its centre of mass at the origin.
#[derive(Clone, Debug, PartialEq)]
pub enum NeutralShape {
    /// a sphere
    Sphere {
        /// radius \[m\]
        radius: f64,
    },
    /// a box
    Box {
        /// half of its edges \[m\]
        half: Triple,
    },
    /// the convex hull of points
    Hull {
        /// the points \[m\]
        points: Vec<Triple>,
    },
}

/// A body at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct NeutralBody {
    /// which of the scene's shapes
    pub shape: u32,
    /// whether it never moves
    pub fixed: bool,
    /// position of the centre of mass \[m\]
    pub position: Triple,
    /// orientation: x, y, z, w
    pub orientation: [f64; 4],
    /// velocity \[m/s\]
    pub velocity: Triple,
    /// angular velocity \[rad/s\], world axes
    pub spin: Triple,
}

/// A scene. Every body has density 1.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneData {
    /// length of a step \[s\]
    pub dt: f64,
    /// the length \[m\] that engines with absolute tolerances are to see as 1: they are given the scene divided by it
    pub unit: f64,
    /// coefficient of restitution of every surface
    pub restitution: f64,
    /// friction coefficient of every surface
    pub friction: f64,
    /// uniform gravity \[m/s2\]
    pub gravity: Triple,
    /// lower and upper corner of the box whose walls keep the bodies in, if any
    pub container: Option<(Triple, Triple)>,
    /// shapes
    pub shapes: Vec<NeutralShape>,
    /// bodies, in the order in which engines create them
    pub bodies: Vec<NeutralBody>,
}

const MAGIC: &[u8; 8] = b"MRTSCENE";
const VERSION: u32 = 1;

impl NeutralShape {
    /// Radius of the sphere about the centre of mass that holds the shape \[m\].
    pub fn radius(&self) -> f64 {
        match self {
            NeutralShape::Sphere { radius } => *radius,
            NeutralShape::Box { half } => norm(*half),
            NeutralShape::Hull { points } => points.iter().map(|&p| norm(p)).fold(0.0, f64::max),
        }
    }

    /// The shape as our library knows it.
    ///
    /// # Errors
    /// The shape is none: in words.
    pub fn ours(&self) -> Result<Arc<dyn Shape>, String> {
        let vector = |p: &Triple| Vec3::new(p[0], p[1], p[2]);
        Ok(match self {
            NeutralShape::Sphere { radius } => Arc::new(Sphere::new(*radius).map_err(words)?),
            NeutralShape::Box { half } => Arc::new(Polyhedron::cuboid(vector(half) * 2.0).map_err(words)?),
            NeutralShape::Hull { points } => {
                let points: Vec<Vec3> = points.iter().map(vector).collect();
                Arc::new(Polyhedron::convex_hull(&points).map_err(words)?)
            }
        })
    }

    /// Mass \[kg\] at density 1 and principal moments of inertia \[kg m2\] with their axes.
    ///
    /// # Errors
    /// The shape has no volume: in words.
    pub fn mass(&self) -> Result<(f64, MassProperties), String> {
        let properties = self.ours()?.mass_properties().ok_or("a shape without mass")?;
        Ok((properties.volume, properties))
    }

    fn points(&self) -> (u32, Vec<Triple>) {
        match self {
            NeutralShape::Sphere { radius } => (0, vec![[*radius, 0.0, 0.0]]),
            NeutralShape::Box { half } => (1, vec![*half]),
            NeutralShape::Hull { points } => (2, points.clone()),
        }
    }

    fn of_points(kind: u32, points: Vec<Triple>) -> Result<NeutralShape, String> {
        match (kind, points.as_slice()) {
            (0, &[[radius, _, _]]) => Ok(NeutralShape::Sphere { radius }),
            (1, &[half]) => Ok(NeutralShape::Box { half }),
            (2, [_, _, _, _, ..]) => Ok(NeutralShape::Hull { points }),
            _ => Err(format!("a shape of kind {kind} with {} points", points.len())),
        }
    }
}

fn words(error: mrtphys::Error) -> String {
    error.to_string()
}

/// Length of a vector.
pub fn norm(v: Triple) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

impl SceneData {
    /// The six walls of the container as boxes half as thick as it is wide, to engines that have no half-spaces: centre
    /// and half edges.
    pub fn walls(&self) -> Vec<(Triple, Triple)> {
        let Some((low, high)) = self.container else { return Vec::new() };
        let middle = |k: usize| 0.5 * (low[k] + high[k]);
        let mut walls = Vec::new();
        for axis in 0..3 {
            let thickness = 0.5 * (high[axis] - low[axis]);
            for (face, sign) in [(low[axis], -1.0), (high[axis], 1.0)] {
                let mut centre = [middle(0), middle(1), middle(2)];
                // The walls overlap along the edges of the container: no seam to slip through.
                let mut half = [0, 1, 2].map(|k| 0.5 * (high[k] - low[k]) + thickness);
                centre[axis] = face + sign * 0.5 * thickness;
                half[axis] = 0.5 * thickness;
                walls.push((centre, half));
            }
        }
        walls
    }

    /// The bytes of the file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(128 + 112 * self.bodies.len());
        out.extend_from_slice(MAGIC);
        let container = u32::from(self.container.is_some());
        put_u32(&mut out, &[VERSION, self.shapes.len() as u32, self.bodies.len() as u32, container]);
        put(&mut out, &[self.dt, self.unit, self.restitution, self.friction]);
        put(&mut out, &self.gravity);
        let (low, high) = self.container.unwrap_or_default();
        put(&mut out, &low);
        put(&mut out, &high);
        for shape in &self.shapes {
            let (kind, points) = shape.points();
            put_u32(&mut out, &[kind, points.len() as u32]);
            points.iter().for_each(|p| put(&mut out, p));
        }
        for body in &self.bodies {
            put_u32(&mut out, &[body.shape, u32::from(body.fixed)]);
            put(&mut out, &body.position);
            put(&mut out, &body.orientation);
            put(&mut out, &body.velocity);
            put(&mut out, &body.spin);
        }
        out
    }

    /// Reads the bytes of a file.
    ///
    /// # Errors
    /// What is wrong with them, in words.
    pub fn from_bytes(bytes: &[u8]) -> Result<SceneData, String> {
        let mut from = Reader(bytes);
        if from.take(8)? != MAGIC {
            return Err("not a scene file".into());
        }
        let [version, shapes, bodies, container] = from.u32s()?;
        if version != VERSION {
            return Err(format!("a scene file of version {version}; this program reads {VERSION}"));
        }
        let [dt, unit, restitution, friction] = from.f64s()?;
        let gravity = from.f64s()?;
        let corners = (from.f64s()?, from.f64s()?);
        let mut scene = SceneData {
            dt,
            unit,
            restitution,
            friction,
            gravity,
            container: flag(container)?.then_some(corners),
            shapes: Vec::new(),
            bodies: Vec::new(),
        };
        if !(dt > 0.0 && unit > 0.0) {
            return Err("the time step and the unit of length are not positive".into());
        }
        for _ in 0..shapes {
            let [kind, count] = from.u32s()?;
            let points = (0..count).map(|_| from.f64s()).collect::<Result<_, _>>()?;
            scene.shapes.push(NeutralShape::of_points(kind, points)?);
        }
        for _ in 0..bodies {
            scene.bodies.push(from.body(shapes)?);
        }
        if from.0.is_empty() { Ok(scene) } else { Err(format!("{} bytes too many", from.0.len())) }
    }

    /// Writes the file.
    ///
    /// # Errors
    /// In words.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        std::fs::write(path, self.to_bytes()).map_err(|e| format!("{}: {e}", path.display()))
    }

    /// Reads the file.
    ///
    /// # Errors
    /// In words.
    pub fn read(path: &Path) -> Result<SceneData, String> {
        let bytes = std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
        SceneData::from_bytes(&bytes).map_err(|e| format!("{}: {e}", path.display()))
    }
}

fn put(out: &mut Vec<u8>, values: &[f64]) {
    values.iter().for_each(|x| out.extend_from_slice(&x.to_le_bytes()));
}

fn put_u32(out: &mut Vec<u8>, values: &[u32]) {
    values.iter().for_each(|x| out.extend_from_slice(&x.to_le_bytes()));
}

/// A number that says yes or no. Any other means something that this program does not know.
fn flag(value: u32) -> Result<bool, String> {
    match value {
        0 | 1 => Ok(value == 1),
        _ => Err(format!("the flag {value}, which is neither 0 nor 1")),
    }
}

struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, n: usize) -> Result<&'a [u8], String> {
        let (head, rest) = self.0.split_at_checked(n).ok_or("the file ends too early")?;
        self.0 = rest;
        Ok(head)
    }

    fn u32s<const N: usize>(&mut self) -> Result<[u32; N], String> {
        let mut out = [0; N];
        for x in &mut out {
            *x = u32::from_le_bytes(self.take(4)?.try_into().map_err(|_| "four bytes")?);
        }
        Ok(out)
    }

    fn f64s<const N: usize>(&mut self) -> Result<[f64; N], String> {
        let mut out = [0.0; N];
        for x in &mut out {
            *x = f64::from_le_bytes(self.take(8)?.try_into().map_err(|_| "eight bytes")?);
            if !x.is_finite() {
                return Err("a number that is not finite".into());
            }
        }
        Ok(out)
    }

    fn body(&mut self, shapes: u32) -> Result<NeutralBody, String> {
        let [shape, fixed] = self.u32s()?;
        if shape >= shapes {
            return Err(format!("a body of shape {shape}, of {shapes}"));
        }
        Ok(NeutralBody {
            shape,
            fixed: flag(fixed)?,
            position: self.f64s()?,
            orientation: self.f64s()?,
            velocity: self.f64s()?,
            spin: self.f64s()?,
        })
    }
}
