//! `--trajectory`: every body at frame 0 and at the end of every frame.

use crate::binary;
use crate::cast::{Cast, Party};
use crate::exit::{Failure, Outcome};
use crate::output::{Format, Stream};
use mrtphys::World;
use mrtphys::world::Body;
use std::borrow::Cow;
use std::io::{self, Write};
use std::path::Path;

const HEADER: &str = "time,body,px,py,pz,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\r\n";
/// number of the body, time, and the thirteen values
const RECORD_BYTES: u32 = 15 * 8;

/// Writes frames.
pub struct Trajectory {
    to: Stream,
    format: Format,
}

impl Trajectory {
    /// Creates the file.
    pub fn create(path: &Path, cast: &Cast) -> Outcome<Trajectory> {
        let (mut to, format) = (Stream::create(path)?, Format::of(path));
        to.put(|to| match format {
            Format::Text => to.write_all(HEADER.as_bytes()),
            Format::Binary => binary::header(to, binary::TRAJECTORY, RECORD_BYTES, cast),
        })?;
        Ok(Trajectory { to, format })
    }

    /// Writes all bodies as they are now.
    pub fn put_frame(&mut self, world: &World, cast: &Cast) -> Outcome {
        let time = world.time();
        for (i, &id) in cast.bodies().iter().enumerate() {
            let body = world.body(id).map_err(|e| Failure::Stopped(e.to_string()))?;
            let values = motion(&body);
            self.to.put(|to| match self.format {
                Format::Text => {
                    write!(to, "{time:?},{}", csv_name(&cast.name(Party::Body(i))))?;
                    csv_values(to, &values)
                }
                Format::Binary => {
                    binary::record(to, &[i as u64], &[time])?;
                    binary::record(to, &[], &values)
                }
            })?;
        }
        Ok(())
    }

    /// Hands everything to the system.
    pub fn flush(&mut self) -> Outcome {
        self.to.flush()
    }
}

/// Position \[m\], orientation (xyzw), velocity \[m/s\] and angular velocity \[rad/s\].
pub fn motion(b: &Body) -> [f64; 13] {
    let (x, q, v, w) = (b.position, b.orientation, b.velocity, b.angular_velocity);
    [x.x, x.y, x.z, q.x, q.y, q.z, q.w, v.x, v.y, v.z, w.x, w.y, w.z]
}

/// A name as a CSV field (RFC 4180): quoted where it holds a comma, a quote or a line end.
pub fn csv_name(name: &str) -> Cow<'_, str> {
    if name.contains([',', '"', '\r', '\n']) {
        Cow::Owned(format!("\"{}\"", name.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(name)
    }
}

/// Numbers in the shortest form that reads back bit for bit, each after a comma, and the end of the line.
pub fn csv_values(to: &mut dyn Write, values: &[f64]) -> io::Result<()> {
    for v in values {
        write!(to, ",{v:?}")?;
    }
    to.write_all(b"\r\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_quoted_as_rfc_4180_says() {
        assert_eq!(csv_name("ball"), "ball");
        assert_eq!(csv_name("lattice0[1,2,3]"), "\"lattice0[1,2,3]\"");
        assert_eq!(csv_name("the \"big\" one"), "\"the \"\"big\"\" one\"");
    }

    #[test]
    fn numbers_read_back_bit_for_bit() {
        let values = [0.1, -0.0, 1e-308, 5e-324, 1.7976931348623157e308, 1.0 / 3.0, 123456789012345680.0, -7.0];
        let mut text = Vec::new();
        csv_values(&mut text, &values).unwrap();
        let text = String::from_utf8(text).unwrap();
        let line = text.strip_suffix("\r\n").unwrap();
        let back: Vec<f64> = line.split(',').skip(1).map(|f| f.parse().unwrap()).collect();
        assert_eq!(back.iter().map(|v| v.to_bits()).collect::<Vec<_>>(), values.map(f64::to_bits));
    }
}
