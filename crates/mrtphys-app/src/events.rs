//! `--events`: every impact, while the run goes on.

use crate::binary;
use crate::cast::{Cast, Party};
use crate::exit::Outcome;
use crate::output::{Format, Stream};
use crate::trajectory::{csv_name, csv_values};
use mrtphys::event::ImpactEvent;
use std::io::Write;
use std::path::Path;

const HEADER: &str = "time,body_a,body_b,px,py,pz,nx,ny,nz,impulse_n,impulse_t,energy_change\r\n";
/// numbers of the two parties, time, and the nine values
const RECORD_BYTES: u32 = 12 * 8;

/// Writes impacts.
pub struct Events {
    to: Stream,
    format: Format,
    only: Option<Chosen>,
}

impl Events {
    /// Creates the file. `only` is the list of names of `--events-only`.
    pub fn create(path: &Path, only: Option<&str>, cast: &Cast) -> Outcome<Events> {
        let only = only.map(|list| Chosen::new(list, cast)).transpose()?;
        let (mut to, format) = (Stream::create(path)?, Format::of(path));
        to.put(|to| match format {
            Format::Text => to.write_all(HEADER.as_bytes()),
            Format::Binary => binary::header(to, binary::EVENTS, RECORD_BYTES, cast),
        })?;
        Ok(Events { to, format, only })
    }

    /// Writes one impact, if it is asked for.
    pub fn put(&mut self, e: &ImpactEvent, cast: &Cast) -> Outcome {
        let (a, b) = (Party::Body(cast.number(e.a)), cast.party(e.b));
        if self.only.as_ref().is_some_and(|only| !only.has(a) && !only.has(b)) {
            return Ok(());
        }
        let (p, n) = (e.point, e.normal);
        let values = [p.x, p.y, p.z, n.x, n.y, n.z, e.impulse_n, e.impulse_t, e.energy_change];
        self.to.put(|to| match self.format {
            Format::Text => {
                write!(to, "{:?},{},{}", e.time, csv_name(&cast.name(a)), csv_name(&cast.name(b)))?;
                csv_values(to, &values)
            }
            Format::Binary => {
                binary::record(to, &[cast.place(a), cast.place(b)], &[e.time])?;
                binary::record(to, &[], &values)
            }
        })
    }

    /// Hands everything to the system.
    pub fn flush(&mut self) -> Outcome {
        self.to.flush()
    }
}

/// The bodies and boundaries of `--events-only`.
struct Chosen {
    bodies: Vec<bool>,
    boundaries: Vec<bool>,
}

impl Chosen {
    fn new(list: &str, cast: &Cast) -> Outcome<Chosen> {
        let mut chosen =
            Chosen { bodies: vec![false; cast.body_count()], boundaries: vec![false; cast.boundary_count()] };
        for name in split_names(list) {
            for party in cast.find_for("--events-only", name)? {
                match party {
                    Party::Body(i) => chosen.bodies[i] = true,
                    Party::Boundary(i) => chosen.boundaries[i] = true,
                }
            }
        }
        Ok(chosen)
    }

    fn has(&self, party: Party) -> bool {
        match party {
            Party::Body(i) => self.bodies[i],
            Party::Boundary(i) => self.boundaries[i],
        }
    }
}

/// Splits at commas that are not within brackets: `lattice0[0,1,2]` is one name.
pub fn split_names(list: &str) -> Vec<&str> {
    let mut depth = 0usize;
    let at_comma = move |c: char| {
        match c {
            '[' => depth += 1,
            ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        c == ',' && depth == 0
    };
    list.split(at_comma).map(str::trim).filter(|n| !n.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_split_at_commas_outside_of_brackets() {
        assert_eq!(split_names("a, lattice0[0,1,2],b"), ["a", "lattice0[0,1,2]", "b"]);
        assert_eq!(split_names("a]b,c,,"), ["a]b", "c"]);
    }
}
