//! Who takes part: bodies and boundaries in the order of the scene, with their names.

use crate::choices::closest;
use crate::exit::{Failure, Outcome};
use mrtphys::BodyId;
use mrtphys::event::Partner;
use mrtphys_scene::Names;
use std::borrow::Cow;

/// A body or a boundary by its number, counted from 0 in the order of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Party {
    /// a body
    Body(usize),
    /// a boundary
    Boundary(usize),
}

/// Bodies and boundaries with their names and numbers. None comes or goes while a scene runs.
pub struct Cast {
    names: Names,
    /// number of a body by the index in its handle
    number_of: Vec<u32>,
}

/// Names compared when a wrong one is answered with a guess.
const MOST_COMPARED: usize = 100_000;

impl Cast {
    /// From the names of a scene whose world was just made.
    pub fn new(names: Names) -> Cast {
        let index = |id: &BodyId| id.to_parts().0 as usize;
        let bodies = names.bodies();
        let mut number_of = vec![0; bodies.iter().map(|id| index(id) + 1).max().unwrap_or(0)];
        bodies.iter().enumerate().for_each(|(number, id)| number_of[index(id)] = number as u32);
        Cast { names, number_of }
    }

    /// Bodies in the order of the scene.
    pub fn bodies(&self) -> &[BodyId] {
        self.names.bodies()
    }

    /// How many bodies there are.
    pub fn body_count(&self) -> usize {
        self.names.bodies().len()
    }

    /// How many boundaries there are.
    pub fn boundary_count(&self) -> usize {
        self.names.boundaries().len()
    }

    /// Bodies, then boundaries.
    pub fn parties(&self) -> impl Iterator<Item = Party> {
        (0..self.body_count()).map(Party::Body).chain((0..self.boundary_count()).map(Party::Boundary))
    }

    /// Number of a body.
    pub fn number(&self, id: BodyId) -> usize {
        self.number_of[id.to_parts().0 as usize] as usize
    }

    /// The second party of an impact.
    pub fn party(&self, partner: Partner) -> Party {
        match partner {
            Partner::Body(id) => Party::Body(self.number(id)),
            // Handles of one world ascend in the order of creation.
            Partner::Boundary(id) => Party::Boundary(self.names.boundaries().partition_point(|&b| b < id)),
        }
    }

    /// Name of a party. Those of lattices are made when they are asked for.
    pub fn name(&self, party: Party) -> Cow<'_, str> {
        match party {
            Party::Body(i) => self.names.body_name(self.bodies()[i]).unwrap_or_default().into(),
            Party::Boundary(i) => self.names.boundary_name(self.names.boundaries()[i]).unwrap_or_default().into(),
        }
    }

    /// Number of a party in the records of a binary file: the bodies, then the boundaries.
    pub fn place(&self, party: Party) -> u64 {
        match party {
            Party::Body(i) => i as u64,
            Party::Boundary(i) => (self.body_count() + i) as u64,
        }
    }

    /// The parties of a name: one, or all bodies of a lattice or a table, or all faces of a box.
    pub fn find(&self, name: &str) -> Option<Vec<Party>> {
        if let Some(bodies) = self.names.bodies_of(name) {
            return Some(bodies.iter().map(|&id| Party::Body(self.number(id))).collect());
        }
        let belongs = |party: &Party| {
            let its_name = self.name(*party);
            its_name.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        let walls: Vec<Party> = (0..self.boundary_count()).map(Party::Boundary).filter(belongs).collect();
        (!walls.is_empty()).then_some(walls)
    }

    /// As [`find`](Cast::find); a name that is none is answered with the one that was probably meant.
    pub fn find_for(&self, option: &str, name: &str) -> Outcome<Vec<Party>> {
        self.find(name).ok_or_else(|| {
            let names: Vec<Cow<'_, str>> = self.parties().take(MOST_COMPARED).map(|p| self.name(p)).collect();
            // `gas` of `gas[0,0,0]`, `walls` of `walls.+x`
            let whole = |n: &str| n.find(['[', '.']).unwrap_or(n.len());
            let meant = closest(name, names.iter().flat_map(|n| [&n[..whole(n)], &**n]));
            let tip = meant.map(|m| format!("; did you mean '{m}'?")).unwrap_or_default();
            Failure::Wrong(format!("{option}: no body or boundary is named '{name}'{tip}"))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys_scene::Scene;

    fn cast() -> Cast {
        let shape = "shape = { kind = \"sphere\", radius = 0.1 }";
        let text = format!(
            "format = 1\n[[body]]\nname = \"ball\"\n{shape}\n[[lattice]]\nname = \"l\"\ncount = [1, 1, 2]\nbody = [{{ {shape} }}]\n\
             [[body]]\nname = \"lx\"\n{shape}\n[[boundary]]\nname = \"w\"\nkind = \"box\"\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n\
             [[boundary]]\nname = \"floor\"\nkind = \"half-space\"\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\n"
        );
        Cast::new(Scene::from_text("test", &text).unwrap().build().unwrap().names)
    }

    #[test]
    fn a_name_stands_for_one_or_for_a_whole_lattice_or_box() {
        let cast = cast();
        assert_eq!(cast.find("ball"), Some(vec![Party::Body(0)]));
        assert_eq!(cast.find("l"), Some(vec![Party::Body(1), Party::Body(2)]));
        assert_eq!(cast.find("l[0,0,1]"), Some(vec![Party::Body(2)]));
        assert_eq!(cast.find("w"), Some((0..6).map(Party::Boundary).collect()));
        assert_eq!(cast.find("w.+x"), Some(vec![Party::Boundary(1)]));
        assert_eq!(cast.find("floor"), Some(vec![Party::Boundary(6)]));
        assert_eq!(cast.find("l[0,0,2]"), None);
        let refused = cast.find_for("--events-only", "ww");
        assert!(matches!(refused, Err(Failure::Wrong(text)) if text.contains("did you mean 'w'?")));
        let refused = cast.find_for("--events-only", "bal");
        assert!(matches!(refused, Err(Failure::Wrong(text)) if text.contains("did you mean 'ball'?")));
    }

    #[test]
    fn numbers_follow_the_order_of_the_scene() {
        let cast = cast();
        for (i, &id) in cast.bodies().iter().enumerate() {
            assert_eq!(cast.number(id), i);
        }
        let names: Vec<_> = cast.parties().map(|p| cast.name(p)).collect();
        assert_eq!(names[..5], ["ball", "l[0,0,0]", "l[0,0,1]", "lx", "w.-x"]);
        for (i, party) in cast.parties().enumerate() {
            assert_eq!(cast.place(party), i as u64);
        }
        for (i, &id) in cast.names.boundaries().iter().enumerate() {
            assert_eq!(cast.party(Partner::Boundary(id)), Party::Boundary(i));
        }
    }
}
