//! The little-endian files: a header, the names, then records of one size. `docs/manual/files.md` describes them.

use crate::cast::Cast;
use std::io::{self, Write};

/// Version of the layout.
const VERSION: u32 = 1;

/// First eight bytes of each kind of file.
pub const TRAJECTORY: &[u8; 8] = b"MRTPTRAJ";
/// Impacts.
pub const EVENTS: &[u8; 8] = b"MRTPEVNT";
/// Bodies of a report.
pub const REPORT: &[u8; 8] = b"MRTPREPT";

/// Writes the header and the table of names: of the bodies, then of the boundaries.
pub fn header(to: &mut dyn Write, magic: &[u8; 8], record_bytes: u32, cast: &Cast) -> io::Result<()> {
    let names = || cast.parties().map(|p| cast.name(p));
    // Records start at a multiple of eight bytes, so that a mapped file can be read in place.
    let table: u64 = names().map(|n| 4 + n.len() as u64).sum();
    let padding = table.next_multiple_of(8) - table;
    to.write_all(magic)?;
    to.write_all(&VERSION.to_le_bytes())?;
    to.write_all(&record_bytes.to_le_bytes())?;
    for count in [cast.body_count() as u64, cast.boundary_count() as u64, table + padding] {
        to.write_all(&count.to_le_bytes())?;
    }
    for name in names() {
        to.write_all(&(name.len() as u32).to_le_bytes())?;
        to.write_all(name.as_bytes())?;
    }
    to.write_all(&[0; 8][..padding as usize])
}

/// Writes whole numbers, then doubles.
pub fn record(to: &mut dyn Write, numbers: &[u64], values: &[f64]) -> io::Result<()> {
    for n in numbers {
        to.write_all(&n.to_le_bytes())?;
    }
    for v in values {
        to.write_all(&v.to_le_bytes())?;
    }
    Ok(())
}
