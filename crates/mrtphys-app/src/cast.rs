//! Who takes part: bodies and boundaries in the order of the scene, with their names.

use crate::choices::closest;
use crate::exit::{Failure, Outcome};
use mrtphys::event::Partner;
use mrtphys::{BodyId, BoundaryId};

/// A body or a boundary by its number, counted from 0 in the order of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Party {
    /// a body
    Body(usize),
    /// a boundary
    Boundary(usize),
}

/// Bodies and boundaries with their names. None comes or goes while a scene runs.
pub struct Cast {
    bodies: Vec<BodyId>,
    boundaries: Vec<BoundaryId>,
    body_names: Vec<String>,
    boundary_names: Vec<String>,
    /// number of a body by the index in its handle
    number_of: Vec<u32>,
}

impl Cast {
    /// From handles in the order of the scene, with names.
    pub fn new(bodies: Vec<(BodyId, String)>, boundaries: Vec<(BoundaryId, String)>) -> Cast {
        let (bodies, body_names): (Vec<BodyId>, Vec<String>) = bodies.into_iter().unzip();
        let (boundaries, boundary_names) = boundaries.into_iter().unzip();
        let index = |id: &BodyId| id.to_parts().0 as usize;
        let mut number_of = vec![0; bodies.iter().map(|id| index(id) + 1).max().unwrap_or(0)];
        bodies.iter().enumerate().for_each(|(number, id)| number_of[index(id)] = number as u32);
        Cast { bodies, boundaries, body_names, boundary_names, number_of }
    }

    /// Bodies in the order of the scene.
    pub fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    /// How many bodies there are.
    pub fn body_count(&self) -> usize {
        self.bodies.len()
    }

    /// How many boundaries there are.
    pub fn boundary_count(&self) -> usize {
        self.boundaries.len()
    }

    /// Names of the bodies, in order.
    pub fn body_names(&self) -> impl Iterator<Item = &str> {
        self.body_names.iter().map(String::as_str)
    }

    /// Names of the boundaries, in order.
    pub fn boundary_names(&self) -> impl Iterator<Item = &str> {
        self.boundary_names.iter().map(String::as_str)
    }

    /// Number of a body.
    pub fn number(&self, id: BodyId) -> usize {
        self.number_of[id.to_parts().0 as usize] as usize
    }

    /// Number of the second party of an impact.
    pub fn party(&self, partner: Partner) -> Party {
        match partner {
            Partner::Body(id) => Party::Body(self.number(id)),
            // Handles of one world ascend in the order of creation.
            Partner::Boundary(id) => Party::Boundary(self.boundaries.partition_point(|&b| b < id)),
        }
    }

    /// Name of a party.
    pub fn name(&self, party: Party) -> &str {
        match party {
            Party::Body(i) => &self.body_names[i],
            Party::Boundary(i) => &self.boundary_names[i],
        }
    }

    /// Number of a party in the records of a binary file: the bodies, then the boundaries.
    pub fn place(&self, party: Party) -> u64 {
        match party {
            Party::Body(i) => i as u64,
            Party::Boundary(i) => (self.bodies.len() + i) as u64,
        }
    }

    /// The parties of a name: one, or all bodies of a lattice, or all faces of a box.
    pub fn find(&self, name: &str) -> Outcome<Vec<Party>> {
        let parties = || {
            let bodies = self.body_names().enumerate().map(|(i, n)| (Party::Body(i), n));
            bodies.chain(self.boundary_names().enumerate().map(|(i, n)| (Party::Boundary(i), n)))
        };
        let belongs =
            |n: &str| n.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with(['[', '.']));
        let found: Vec<Party> = parties().filter(|(_, n)| belongs(n)).map(|(p, _)| p).collect();
        if found.is_empty() {
            let meant = closest(name, parties().map(|(_, n)| n));
            let tip = meant.map(|m| format!("; did you mean '{m}'?")).unwrap_or_default();
            return Err(Failure::Wrong(format!("--events-only: no body or boundary is named '{name}'{tip}")));
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cast() -> Cast {
        let bodies = ["ball", "l[0,0,0]", "l[0,0,1]", "lx"];
        let ids = bodies.iter().enumerate().map(|(i, n)| (BodyId::from_parts(3 - i as u32, 0, 1), n.to_string()));
        Cast::new(ids.collect(), Vec::new())
    }

    #[test]
    fn a_name_stands_for_one_or_for_a_whole_lattice() {
        let cast = cast();
        assert_eq!(cast.find("ball").unwrap(), [Party::Body(0)]);
        assert_eq!(cast.find("l").unwrap(), [Party::Body(1), Party::Body(2)]);
        assert_eq!(cast.find("l[0,0,1]").unwrap(), [Party::Body(2)]);
        assert!(matches!(cast.find("bal"), Err(Failure::Wrong(text)) if text.contains("did you mean 'ball'?")));
    }

    #[test]
    fn numbers_follow_the_order_of_the_scene() {
        let cast = cast();
        for (i, &id) in cast.bodies().iter().enumerate() {
            assert_eq!(cast.number(id), i);
        }
    }
}
