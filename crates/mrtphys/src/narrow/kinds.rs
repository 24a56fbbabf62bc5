//! The inventory of kinds: what exists, what it descends from, and which routine was declared for which pair.
//!
//! Kinds form a tree (thesis, section 6.5). The root `body` behaves as its bounding sphere; a kind inherits the routines of
//! its parent. All kinds are known before the first body is made, in a fixed order: the thesis numbered its classes in the
//! order of first use, so that ties depended on the scene.
//!
//! A new shape is one `add` and as many `declare` as it has routines of its own:
//!
//! ```
//! use mrtphys::def::ContactMode;
//! use mrtphys::narrow::kinds::Kinds;
//! use mrtphys::narrow::{Placed, Touches};
//!
//! fn capsule_sphere(capsule: &Placed<'_>, any: &Placed<'_>, out: &mut Touches) {
//!     # let _ = (capsule, any, out);
//!     // ... out.push(normal from capsule to any, point, depth, feature, &[point]);
//! }
//! let mut kinds = Kinds::standard(ContactMode::Exact);
//! kinds.add("capsule", "body")?;
//! kinds.declare("capsule", "body", "capsule-sphere", capsule_sphere)?;
//! let table = kinds.resolve();
//! let (capsule, cube) = (kinds.id("capsule").unwrap(), kinds.id("box").unwrap());
//! assert_eq!(table.lookup(capsule, capsule).name, "capsule-sphere");
//! // A box behaves towards the capsule as declared for its ancestors: the tie is reported, the first declared stands.
//! assert!(!table.ambiguities().is_empty());
//! # let _ = cube;
//! # Ok::<(), mrtphys::Error>(())
//! ```

use super::Routine;
use super::pair_table::{Declaration, Hierarchy, PairTable};
use super::pairs;
use crate::def::ContactMode;
use crate::error::{Error, Result};

/// Number of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct KindId(pub(crate) u16);

impl KindId {
    /// The root, `body`.
    pub const BODY: KindId = KindId(0);

    /// Place in the inventory, counted from 0.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The kinds there are, with the pair routines declared for them.
#[derive(Clone, Debug)]
pub struct Kinds {
    names: Vec<String>,
    tree: Hierarchy,
    declarations: Vec<Declaration>,
}

/// Two kinds, the routine's name, the routine.
type Row = (&'static str, &'static str, &'static str, Routine);

/// The kinds with their parents.
const TREE: [(&str, &str); 8] = [
    ("sphere", "body"),
    ("polyhedron", "body"),
    ("tetrahedron", "polyhedron"),
    ("box", "polyhedron"),
    ("quadrangle", "body"),
    ("half-space", "body"),
    ("limit-quadrangle", "half-space"),
    ("plane", "body"),
];

/// Routines of both modes.
const SHARED: [Row; 5] = [
    ("half-space", "body", "half-space-sphere", pairs::half_space_sphere::touch),
    ("plane", "body", "plane-sphere", pairs::plane::sphere),
    ("half-space", "half-space", "never", pairs::never::touch),
    ("plane", "half-space", "never", pairs::never::touch),
    ("plane", "plane", "never", pairs::never::touch),
];

/// True normals and manifolds.
const EXACT: [Row; 9] = [
    ("body", "polyhedron", "sphere-polyhedron", pairs::sphere_polyhedron::touch),
    ("body", "quadrangle", "sphere-quadrangle", pairs::sphere_quadrangle::touch),
    ("polyhedron", "polyhedron", "polyhedron-polyhedron", pairs::polyhedron_polyhedron::touch),
    ("polyhedron", "quadrangle", "polyhedron-quadrangle", pairs::polyhedron_quadrangle::touch),
    ("polyhedron", "half-space", "polyhedron-half-space", pairs::polyhedron_half_space::touch),
    ("polyhedron", "plane", "polyhedron-plane", pairs::plane::polyhedron),
    ("quadrangle", "quadrangle", "quadrangle-quadrangle", pairs::quadrangle_quadrangle::touch),
    ("quadrangle", "half-space", "quadrangle-half-space", pairs::quadrangle_half_space::touch),
    ("quadrangle", "plane", "quadrangle-plane", pairs::plane::quadrangle),
];

/// The thesis's own routines (sections 6.3.6, 6.6.2, 6.6.3, 6.7). It has none for a quadrangle and a polyhedron, or for two
/// quadrangles: the second is then taken as its bounding sphere.
const THESIS: [Row; 9] = [
    ("body", "body", "thesis-sphere-sphere", pairs::thesis_sphere_sphere::touch),
    ("polyhedron", "body", "thesis-polyhedron-sphere", pairs::thesis_polyhedron_sphere::touch),
    ("polyhedron", "polyhedron", "thesis-polyhedron-polyhedron", pairs::thesis_polyhedron_polyhedron::touch),
    ("polyhedron", "quadrangle", "thesis-polyhedron-sphere", pairs::thesis_polyhedron_sphere::touch),
    ("polyhedron", "half-space", "thesis-polyhedron-half-space", pairs::thesis_polyhedron_half_space::touch),
    ("polyhedron", "plane", "thesis-polyhedron-plane", pairs::plane::thesis_polyhedron),
    ("quadrangle", "body", "thesis-quadrangle-sphere", pairs::thesis_quadrangle_sphere::touch),
    ("quadrangle", "half-space", "thesis-quadrangle-half-space", pairs::thesis_quadrangle_half_space::touch),
    ("quadrangle", "plane", "thesis-quadrangle-plane", pairs::plane::thesis_quadrangle),
];

impl Kinds {
    /// Only the root `body`, whose routine is that of two bounding spheres: so every pair always has an answer. Declare
    /// another routine for (`body`, `body`) to replace it.
    pub fn none() -> Kinds {
        let routine: Routine = pairs::sphere_sphere::touch;
        Kinds {
            names: vec!["body".into()],
            tree: Hierarchy::root(),
            declarations: vec![Declaration { kinds: (0, 0), known: 1, name: "sphere-sphere", routine }],
        }
    }

    /// The kinds and routines of this crate.
    pub fn standard(mode: ContactMode) -> Kinds {
        let mut kinds = Kinds::none();
        for (name, parent) in TREE {
            let added = kinds.add(name, parent);
            debug_assert!(added.is_ok());
        }
        let own: &[Row] = match mode {
            ContactMode::Exact => &EXACT,
            ContactMode::Thesis => &THESIS,
        };
        for &(a, b, name, routine) in own.iter().chain(&SHARED) {
            let declared = kinds.declare(a, b, name, routine);
            debug_assert!(declared.is_ok());
        }
        kinds
    }

    /// Most kinds there may be: the table is dense.
    pub const LIMIT: usize = 256;

    /// Adds a kind below another one.
    ///
    /// # Errors
    /// [`Error::UnknownKind`] where there is no such parent, [`Error::DuplicateKind`] where the name is taken,
    /// [`Error::LimitExceeded`] past [`Kinds::LIMIT`] kinds.
    pub fn add(&mut self, name: impl Into<String>, parent: &str) -> Result<KindId> {
        let name = name.into();
        let parent = self.find(parent)?;
        if self.id(&name).is_some() {
            return Err(Error::DuplicateKind { name });
        }
        let (given, limit) = (self.names.len() as u64 + 1, Self::LIMIT as u64);
        if given > limit {
            return Err(Error::LimitExceeded { object: format!("kind '{name}'"), what: "kinds", given, limit });
        }
        // The parent was found a moment ago, so the number is that of the new name.
        let number = self.tree.add(parent.index()).unwrap_or(0);
        self.names.push(name);
        Ok(KindId(number as u16))
    }

    /// Declares the routine that answers a pair of kinds, and of kinds below them unless those have a nearer one. It is
    /// called with a shape of kind `a` first, whatever the order of the pair.
    ///
    /// # Errors
    /// [`Error::UnknownKind`] where a kind is not in the inventory.
    pub fn declare(&mut self, a: &str, b: &str, routine_name: &'static str, routine: Routine) -> Result<()> {
        let kinds = (self.find(a)?.index(), self.find(b)?.index());
        self.declarations.push(Declaration { kinds, known: self.names.len(), name: routine_name, routine });
        Ok(())
    }

    /// The number of the kind of this name.
    pub fn id(&self, name: &str) -> Option<KindId> {
        self.names.iter().position(|n| n == name).map(|i| KindId(i as u16))
    }

    /// Name of a kind.
    pub fn name(&self, kind: KindId) -> &str {
        &self.names[kind.index()]
    }

    /// Whether two spheres are answered by the routine of spheres: it may then be called without asking the table. Comparing
    /// addresses may say no where it should say yes: that costs time and changes nothing.
    pub(crate) fn has_plain_spheres(&self) -> bool {
        let plain: Routine = pairs::sphere_sphere::touch;
        self.id("sphere").is_some_and(|s| std::ptr::fn_addr_eq(self.resolve().lookup(s, s).routine, plain))
    }

    /// The kinds with their names, ascending.
    pub fn iter(&self) -> impl Iterator<Item = (KindId, &str)> {
        self.names.iter().enumerate().map(|(i, n)| (KindId(i as u16), n.as_str()))
    }

    /// The pair table of what was added and declared.
    pub fn resolve(&self) -> PairTable {
        PairTable::resolve(&self.names, &self.tree, &self.declarations)
    }

    fn find(&self, name: &str) -> Result<KindId> {
        self.id(name).ok_or_else(|| Error::UnknownKind { name: name.into() })
    }
}
