//! Body tables: many bodies at once, from a CSV or a binary file beside the scene.

mod binary;
mod csv;

use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::scene::Material;
use crate::source::Source;
use mrtphys::math::{Quat, Real, Vec3};
use std::fs::File;

pub use binary::write as write_binary;
pub use csv::write as write_csv;

/// Shapes that a body table can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum TableShape {
    /// `radius` is its radius
    Sphere = 0,
    /// `radius` is its circumradius
    Tetrahedron = 1,
}

impl TableShape {
    /// Every shape with its name in the column `kind`.
    pub const ALL: [(&'static str, TableShape); 2] =
        [("sphere", TableShape::Sphere), ("tetrahedron", TableShape::Tetrahedron)];
}

/// No material.
pub const NO_MATERIAL: u32 = u32::MAX;

/// A body of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableRow {
    /// shape
    pub shape: TableShape,
    /// number of the material in [`TableRows::materials`], or [`NO_MATERIAL`]
    pub material: u32,
    /// radius or circumradius \[m\]
    pub radius: Real,
    /// \[kg\]; 0: the material's density, else 1 kg
    pub mass: Real,
    /// position of the centre of mass \[m\]
    pub position: Vec3,
    /// orientation
    pub orientation: Quat,
    /// velocity \[m/s\]
    pub velocity: Vec3,
    /// angular velocity \[rad/s\]
    pub angular_velocity: Vec3,
}

impl TableRow {
    /// A sphere of radius 1 m at rest at the origin.
    pub const PLAIN: TableRow = TableRow {
        shape: TableShape::Sphere,
        material: NO_MATERIAL,
        radius: 1.0,
        mass: 0.0,
        position: Vec3::ZERO,
        orientation: Quat::IDENTITY,
        velocity: Vec3::ZERO,
        angular_velocity: Vec3::ZERO,
    };

    /// What is wrong with it, if anything.
    fn check(&self) -> Result<(), String> {
        const LARGEST: Real = 1e150;
        let number = |name: &str, x: Real, good: bool, expected: &str| match good {
            _ if !x.is_finite() => Err(format!("{name} is not a finite number")),
            true => Ok(()),
            false => Err(format!("{name} = {x:?} is out of range: {expected}")),
        };
        let vector = |names: [&str; 3], v: Vec3| {
            let pairs = names.into_iter().zip(v.to_array());
            pairs.into_iter().try_for_each(|(n, x)| number(n, x, x.abs() <= LARGEST, "at most 1e150 in size"))
        };
        number("radius", self.radius, (1e-50..=1e50).contains(&self.radius), "a size from 1e-50 to 1e50 m")?;
        let mass_good = self.mass == 0.0 || (1e-100..=1e100).contains(&self.mass);
        number("mass", self.mass, mass_good, "0, or 1e-100 to 1e100 kg")?;
        vector(["px", "py", "pz"], self.position)?;
        vector(["vx", "vy", "vz"], self.velocity)?;
        vector(["wx", "wy", "wz"], self.angular_velocity)?;
        let q = self.orientation;
        vector(["qx", "qy", "qz"], Vec3::new(q.x, q.y, q.z))?;
        number("qw", q.w, q.w.abs() <= LARGEST, "at most 1e150 in size")?;
        match [q.x, q.y, q.z, q.w] == [0.0; 4] {
            true => Err("qx, qy, qz, qw must not all be 0".into()),
            false => Ok(()),
        }
    }
}

/// The contents of a body table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TableRows {
    /// the bodies
    pub rows: Vec<TableRow>,
    /// names of the materials
    pub materials: Vec<String>,
    /// names of the bodies; empty: `NAME[0]`, `NAME[1]` ...
    pub names: Texts,
}

impl TableRows {
    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}

/// Many texts in one allocation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Texts {
    all: String,
    ends: Vec<u64>,
}

impl Texts {
    /// Appends a text.
    pub fn push(&mut self, text: &str) {
        self.all.push_str(text);
        self.ends.push(self.all.len() as u64);
    }

    /// Number of texts.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// A text; empty beyond the end.
    pub fn get(&self, i: usize) -> &str {
        let Some(&end) = self.ends.get(i) else { return "" };
        let start = if i == 0 { 0 } else { self.ends[i - 1] };
        &self.all[start as usize..end as usize]
    }
}

/// What a table is read for.
struct Reading<'a> {
    /// the name in messages
    name: String,
    /// the scene's materials, in order of their names
    materials: &'a [Material],
    /// bodies that the scene may still take
    left: u64,
}

impl Reading<'_> {
    fn knows(&self, material: &str) -> bool {
        self.materials.binary_search_by(|m| m.name.as_str().cmp(material)).is_ok()
    }

    fn fail(&self, message: String) -> Diagnostics {
        Diagnostic::without_place(&self.name, message).into()
    }

    fn too_many(&self) -> Diagnostics {
        self.fail(format!("more bodies than the {} that a scene may hold", crate::scene::MOST_BODIES))
    }
}

/// Reads a table's file.
pub(crate) fn load(
    source: &Source,
    table: &crate::scene::BodyTableDesc,
    materials: &[Material],
    left: u64,
) -> Result<TableRows, Diagnostics> {
    let object = format!("body_table '{}'", table.name);
    let fail = |m: String| Diagnostics::from(source.diagnostic(table.span, format!("{object}: file: {m}")));
    let Some(folder) = &source.folder else {
        return Err(fail("this scene has no folder, so it can name no files".into()));
    };
    let path = folder.join(&table.file);
    // Links are followed before the comparison, so that a link out of the folder is found too.
    let real = |p: &std::path::Path| p.canonicalize().map_err(|e| fail(format!("'{}': {e}", table.file)));
    let (inside, real_path) = (real(folder)?, real(&path)?);
    if !real_path.starts_with(&inside) {
        return Err(fail(format!("'{}' is not in the scene's folder or below", table.file)));
    }
    if !real_path.is_file() {
        return Err(fail(format!("'{}' is not a file", table.file)));
    }
    let file = File::open(&real_path).map_err(|e| fail(format!("'{}': {e}", table.file)))?;
    let reading = Reading { name: path.display().to_string(), materials, left };
    match real_path.extension().and_then(|e| e.to_str()) {
        Some("csv") => csv::read(file, &reading),
        Some("bin") => binary::read(file, &reading),
        _ => Err(fail(format!("'{}' ends in neither .csv nor .bin", table.file))),
    }
}

#[cfg(test)]
mod tests;
