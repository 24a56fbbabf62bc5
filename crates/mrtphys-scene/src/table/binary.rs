//! Body tables as little-endian binary files. Layout:
//!
//! ```text
//! 8 bytes   "mrtbody" and the version, 1
//! u32       number of materials M, at most 65536
//! M times   u32 length (1 to 1024), that many bytes of UTF-8: the material's name
//! u64       number of bodies N
//! N times   u32 kind (0 sphere, 1 tetrahedron), u32 material (number in the list above, 0xFFFFFFFF: none),
//!           f64 radius, f64 mass (0: the material's density, else 1 kg),
//!           f64 px py pz  qx qy qz qw  vx vy vz  wx wy wz           (128 bytes)
//! ```

use super::{NO_MATERIAL, Reading, TableRow, TableRows, TableShape};
use crate::diagnostics::Diagnostics;
use mrtphys::math::{Quat, Real, Vec3};
use std::fs::File;
use std::io::{BufReader, Read};

const MAGIC: [u8; 8] = *b"mrtbody\x01";
const RECORD: usize = 128;
const MOST_MATERIALS: u32 = 1 << 16;
const LONGEST_NAME: u32 = 1024;

pub(super) fn read(file: File, reading: &Reading) -> Result<TableRows, Diagnostics> {
    let length = file.metadata().map_err(|e| reading.fail(format!("cannot read: {e}")))?.len();
    read_from(BufReader::with_capacity(1 << 16, file), length, reading)
}

/// `length`: of the whole file; it must be exactly what the header says, and is compared before anything is allocated.
fn read_from(mut input: impl Read, length: u64, reading: &Reading) -> Result<TableRows, Diagnostics> {
    let mut bytes = |n: usize| {
        let mut b = vec![0; n];
        input.read_exact(&mut b).map(|()| b).map_err(|_| reading.fail("the file ends too early".into()))
    };
    if bytes(8)? != MAGIC {
        return Err(reading.fail("not a binary body table of version 1 (it begins with 'mrtbody', 1)".into()));
    }
    let mut out = TableRows::default();
    let materials = u32_of(&bytes(4)?);
    if materials > MOST_MATERIALS {
        return Err(reading.fail(format!("{materials} materials, at most {MOST_MATERIALS} are allowed")));
    }
    let mut header = 8 + 4;
    for i in 0..materials {
        let n = u32_of(&bytes(4)?);
        if n == 0 || n > LONGEST_NAME {
            return Err(
                reading.fail(format!("material {i}: the name is {n} bytes long, 1 to {LONGEST_NAME} are allowed"))
            );
        }
        let name = String::from_utf8(bytes(n as usize)?)
            .map_err(|_| reading.fail(format!("material {i}: the name is not UTF-8")))?;
        if !reading.knows(&name) {
            return Err(reading.fail(format!("there is no material '{}'", name.escape_debug())));
        }
        header += 4 + u64::from(n);
        out.materials.push(name);
    }
    let count = bytes(8)?.iter().rev().fold(0, |n, &b| n << 8 | u64::from(b));
    header += 8;
    if count > reading.left {
        return Err(reading.too_many());
    }
    if length != header + count * RECORD as u64 {
        let expected = header + count * RECORD as u64;
        return Err(reading.fail(format!("the file is {length} bytes long, {count} bodies need {expected}")));
    }
    out.rows.reserve_exact(count as usize);
    let mut record = [0; RECORD];
    for i in 0..count {
        input.read_exact(&mut record).map_err(|_| reading.fail("the file ends too early".into()))?;
        let row = row(&record, materials).and_then(|r| r.check().map(|()| r));
        out.rows.push(row.map_err(|m| reading.fail(format!("body {i}: {m}")))?);
    }
    Ok(out)
}

fn u32_of(b: &[u8]) -> u32 {
    b.iter().rev().fold(0, |n, &b| n << 8 | u32::from(b))
}

fn row(record: &[u8; RECORD], materials: u32) -> Result<TableRow, String> {
    let (kind, material) = (u32_of(&record[0..4]), u32_of(&record[4..8]));
    let shape = TableShape::ALL.iter().find(|(_, s)| *s as u32 == kind);
    let shape = shape.ok_or_else(|| format!("unknown kind {kind}"))?.1;
    if material != NO_MATERIAL && material >= materials {
        return Err(format!("material {material} of {materials}"));
    }
    let mut x = [0.0; 15];
    for (x, b) in x.iter_mut().zip(record[8..].chunks_exact(8)) {
        let mut eight = [0; 8];
        eight.copy_from_slice(b);
        *x = Real::from_le_bytes(eight);
    }
    Ok(TableRow {
        shape,
        material,
        radius: x[0],
        mass: x[1],
        position: Vec3::new(x[2], x[3], x[4]),
        orientation: Quat::new(x[5], x[6], x[7], x[8]),
        velocity: Vec3::new(x[9], x[10], x[11]),
        angular_velocity: Vec3::new(x[12], x[13], x[14]),
    })
}

/// A table as a binary file. Names of bodies are not part of it.
pub fn write(table: &TableRows) -> Vec<u8> {
    let mut out = MAGIC.to_vec();
    out.extend((table.materials.len() as u32).to_le_bytes());
    for m in &table.materials {
        out.extend((m.len() as u32).to_le_bytes());
        out.extend(m.as_bytes());
    }
    out.extend((table.rows.len() as u64).to_le_bytes());
    for r in &table.rows {
        out.extend((r.shape as u32).to_le_bytes());
        out.extend(r.material.to_le_bytes());
        let q = r.orientation;
        let numbers = [r.radius, r.mass].into_iter().chain(r.position.to_array()).chain([q.x, q.y, q.z, q.w]);
        for x in numbers.chain(r.velocity.to_array()).chain(r.angular_velocity.to_array()) {
            out.extend(x.to_le_bytes());
        }
    }
    out
}
