//! Pictures and films from the recording, made without the window.

use super::jobs::Ticket;
use crate::exit::{Failure, Outcome};
use crate::output::Whole;
use crate::render::{self, Kind};
use crate::testbed::session::Shot;
use mrtphys_view::film::Folder;
use mrtphys_view::{Camera, Film, Frame, Image, Look, Poses, Renderer};
use std::io;
use std::path::PathBuf;
use std::sync::Arc;

/// Most pictures of a film.
pub const MOST_PICTURES: u64 = 100_000;

/// A picture that is to be made.
pub struct Still {
    /// what is on it
    pub frame: Frame,
    /// width and height \[pixels\]
    pub size: (u32, u32),
    /// where it goes
    pub path: PathBuf,
}

impl Still {
    /// Draws and writes it; says what was written.
    ///
    /// # Errors
    /// There is no driver, or the file cannot be written.
    pub fn make(&self) -> Result<String, String> {
        let (width, height) = self.size;
        let make = || -> Outcome {
            let file = Whole::check(&self.path)?;
            let image =
                Renderer::new().and_then(|mut r| r.render(&self.frame, width, height)).map_err(render::failure)?;
            let bytes = mrtphys_view::film::png_bytes(&image).map_err(render::failure)?;
            file.write(|to| to.write_all(&bytes))
        };
        make().map_err(|e| e.to_string())?;
        Ok(format!("{}: {width} x {height} pixels", self.path.display()))
    }
}

/// How a film is made.
#[derive(Clone, Debug, PartialEq)]
pub struct Take {
    /// simulated time of the first picture \[s\]
    pub from: f64,
    /// simulated time of the end \[s\]
    pub to: f64,
    /// pictures per second of the film
    pub fps: u32,
    /// simulated seconds per second of the film
    pub speed: f64,
    /// width and height \[pixels\]
    pub size: (u32, u32),
    /// from where
    pub camera: Camera,
    /// how it looks
    pub look: Look,
    /// where it goes: a file by its ending, or a folder
    pub path: PathBuf,
}

impl Take {
    /// How many pictures it has: a second at 30 a second has 30, the first at its beginning.
    pub fn pictures(&self) -> u64 {
        let shown = (self.to - self.from).max(0.0) * f64::from(self.fps) / self.speed;
        // The sum of many frames' times is a hair off the whole number that it means.
        let whole = (shown - 1e-6).ceil().max(1.0);
        if whole.is_finite() { whole as u64 } else { u64::MAX }
    }

    /// Simulated time of a picture \[s\].
    fn time(&self, i: u64) -> f64 {
        self.from + i as f64 * self.speed / f64::from(self.fps)
    }

    /// Makes the film; `None`: called off, and nothing is left of it. The folder of single pictures keeps those it has.
    ///
    /// # Errors
    /// There is nothing recorded, no driver, or the film cannot be written.
    pub fn make(&self, shots: &[Arc<Shot>], ticket: &Ticket) -> Result<Option<String>, String> {
        let made = self.make_here(shots, ticket).map_err(|e| e.to_string())?;
        let (w, h) = self.size;
        Ok(made.then(|| format!("{}: {} pictures of {w} x {h} pixels", self.path.display(), self.pictures())))
    }

    fn make_here(&self, shots: &[Arc<Shot>], ticket: &Ticket) -> Outcome<bool> {
        if shots.is_empty() {
            return Err(Failure::Wrong("nothing is recorded of that time".into()));
        }
        if self.pictures() > MOST_PICTURES {
            return Err(Failure::Wrong(format!("a film may have {MOST_PICTURES} pictures")));
        }
        let mut renderer = Renderer::new().map_err(render::failure)?;
        let kind = Kind::of(&self.path)?;
        if kind == Kind::Folder {
            render::check_folder(&self.path)?;
            let mut folder = Folder::create(&self.path).map_err(render::failure)?;
            return self.shoot(shots, ticket, &mut renderer, &mut folder);
        }
        let file = Whole::check(&self.path)?;
        let mut ended = Ok(false);
        let written = file.write(|to| {
            ended = render::open(to, kind, self.size, f64::from(self.fps))
                .and_then(|mut film| self.shoot(shots, ticket, &mut renderer, &mut *film));
            // What is not a whole film is none: the file that was there stays.
            if matches!(ended, Ok(true)) { Ok(()) } else { Err(io::Error::other("the film was not finished")) }
        });
        match ended {
            Ok(true) => written.map(|()| true),
            other => other,
        }
    }

    fn shoot(
        &self,
        shots: &[Arc<Shot>],
        ticket: &Ticket,
        renderer: &mut Renderer,
        film: &mut dyn Film,
    ) -> Outcome<bool> {
        let look = Look { smooth: Some(true), ..self.look };
        let times: Vec<f64> = shots.iter().map(|s| s.time).collect();
        let (mut frame, mut image, mut between) = (Frame::new(self.camera, look), Image::default(), Poses::default());
        let count = self.pictures();
        for i in 0..count {
            if ticket.progress.is_called_off() {
                return Ok(false);
            }
            let (before, part) = place(&times, self.time(i));
            let (a, b) = (&shots[before], &shots[(before + 1).min(shots.len() - 1)]);
            // Bodies that come or go do so at once.
            let a = if Arc::ptr_eq(&a.stage, &b.stage) || part < 1.0 { a } else { b };
            let to = if Arc::ptr_eq(&a.stage, &b.stage) { b } else { a };
            between.set_between(&a.poses, &to.poses, part);
            a.stage.fill(self.camera, look, &between, &mut frame);
            let drawn = renderer.render_into(&frame, self.size.0, self.size.1, &mut image);
            drawn.and_then(|()| film.put(&image)).map_err(render::failure)?;
            ticket.progress(i + 1, count);
        }
        film.finish().map_err(render::failure)?;
        Ok(true)
    }
}

/// Between which two of ascending times a time is: the number of the first, and how far it is to the next, 0 to 1.
fn place(times: &[f64], time: f64) -> (usize, f64) {
    let after = times.partition_point(|t| *t <= time);
    match (after.checked_sub(1), times.get(after)) {
        (None, _) => (0, 0.0),
        (Some(before), None) => (before, 0.0),
        (Some(before), Some(next)) => {
            let part = (time - times[before]) / (next - times[before]);
            (before, part.clamp(0.0, 1.0))
        }
    }
}

/// The folders' and files' endings that a film can have, with what they are called.
pub const FILM_KINDS: [(&str, &str); 3] = [("mp4", "MP4 (H.264)"), ("gif", "GIF"), ("", "PNG folder")];

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys::Vec3;

    fn take(from: f64, to: f64, fps: u32, speed: f64) -> Take {
        let camera = Camera { eye: Vec3::Z, look_at: Vec3::ZERO, up: Vec3::Y, fov_deg: 45.0 };
        Take { from, to, fps, speed, size: (64, 64), camera, look: Look::default(), path: "film.gif".into() }
    }

    #[test]
    fn a_film_has_the_pictures_of_its_time() {
        assert_eq!(take(0.0, 2.0, 30, 1.0).pictures(), 60);
        assert_eq!(take(1.0, 2.0, 25, 0.1).pictures(), 250);
        assert_eq!(take(0.0, 0.1 + 0.2, 10, 1.0).pictures(), 3, "0.30000000000000004 s");
        assert_eq!(take(0.0, 0.0, 30, 1.0).pictures(), 1);
        assert_eq!(take(2.0, 1.0, 30, 1.0).pictures(), 1);
        assert!(take(0.0, 1e300, 240, 1e-9).pictures() > MOST_PICTURES);
    }

    #[test]
    fn a_picture_lies_between_the_frames_round_it() {
        let times = [1.0, 2.0, 4.0];
        assert_eq!(place(&times, 0.0), (0, 0.0));
        assert_eq!(place(&times, 1.0), (0, 0.0));
        assert_eq!(place(&times, 1.25), (0, 0.25));
        assert_eq!(place(&times, 3.0), (1, 0.5));
        assert_eq!(place(&times, 9.0), (2, 0.0));
        assert_eq!(place(&[1.0, 1.0, 2.0], 1.0), (1, 0.0), "two frames of one time");
    }
}
