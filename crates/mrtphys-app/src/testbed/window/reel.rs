//! Pictures and films from the recording, made without the window.

use super::drawing::{self, Moment, Scales, View};
use super::jobs::Ticket;
use super::mouse;
use crate::exit::{Failure, Outcome};
use crate::output::Whole;
use crate::render::{self, Kind};
use crate::testbed::session::{Extras, Recorded, Shot, Wish, trail};
use mrtphys::Vec3;
use mrtphys_view::film::Folder;
use mrtphys_view::{Camera, Film, Frame, Image, Poses, Renderer, Theme, ViewError};
use std::io;
use std::path::PathBuf;
use std::sync::Arc;

/// Most pictures of a film.
pub const MOST_PICTURES: u64 = 100_000;

/// A picture that is to be made.
pub struct Still {
    /// what is on it: from which column on, what, and how wide \[pixels\]
    pub panes: Vec<(u32, Frame, u32)>,
    /// width and height \[pixels\]
    pub size: (u32, u32),
    /// colors of what is between
    pub theme: Theme,
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
            let (mut renderer, mut image) = (Renderer::new().map_err(render::failure)?, Image::default());
            let mut whole = drawing::board(self.size, self.theme);
            for (left, frame, wide) in &self.panes {
                renderer.render_into(frame, *wide, height, &mut image).map_err(render::failure)?;
                drawing::put(&mut whole, *left, &image);
            }
            let bytes = mrtphys_view::film::png_bytes(&whole).map_err(render::failure)?;
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
    /// how it looks; its size is that of the film
    pub view: View,
    /// where the selected body is in the view, if the camera is to follow it \[m\]
    pub follow: Option<Vec3>,
    /// whether the rival is beside the world, from where it is recorded
    pub rival: bool,
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
    pub fn make(&self, frames: &[Recorded], ticket: &Ticket) -> Result<Option<String>, String> {
        let made = self.make_here(frames, ticket).map_err(|e| e.to_string())?;
        let (w, h) = self.view.size;
        Ok(made.then(|| format!("{}: {} pictures of {w} x {h} pixels", self.path.display(), self.pictures())))
    }

    fn make_here(&self, frames: &[Recorded], ticket: &Ticket) -> Outcome<bool> {
        if frames.is_empty() {
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
            return self.shoot(frames, ticket, &mut renderer, &mut folder);
        }
        let file = Whole::check(&self.path)?;
        let mut ended = Ok(false);
        let written = file.write(|to| {
            ended = render::open(to, kind, self.view.size, f64::from(self.fps))
                .and_then(|mut film| self.shoot(frames, ticket, &mut renderer, &mut *film));
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
        frames: &[Recorded],
        ticket: &Ticket,
        renderer: &mut Renderer,
        film: &mut dyn Film,
    ) -> Outcome<bool> {
        let times: Vec<f64> = frames.iter().map(|f| f.shot.time).collect();
        let mut set = Set::new(self);
        let count = self.pictures();
        for i in 0..count {
            if ticket.progress.is_called_off() {
                return Ok(false);
            }
            let (before, part) = place(&times, self.time(i));
            let drawn = set.picture(renderer, frames, before, part);
            drawn.and_then(|image| film.put(image)).map_err(render::failure)?;
            ticket.progress(i + 1, count);
        }
        film.finish().map_err(render::failure)?;
        Ok(true)
    }

    /// What of the recording is needed: the frames of its time, one more at either end, and those of the trails before.
    pub fn needed(&self, mut frames: Vec<Recorded>) -> Vec<Recorded> {
        let first = frames.partition_point(|f| f.shot.time <= self.from).saturating_sub(1 + self.trail());
        let last = frames.partition_point(|f| f.shot.time < self.to);
        frames.truncate(last + 1);
        frames.drain(..first.min(frames.len()));
        frames
    }

    /// Length of trails \[frames\].
    fn trail(&self) -> usize {
        let mut wish = Wish { selected: self.view.selected, ..Wish::default() };
        self.view.sight.wish(&mut wish);
        wish.trail
    }
}

/// What is kept from one picture of a film to the next.
struct Set<'a> {
    take: &'a Take,
    trail: usize,
    frame: Frame,
    poses: Poses,
    extras: Extras,
    scales: [Scales; 2],
    pane: Image,
    whole: Image,
    /// so many worlds are in the picture
    sides: usize,
}

impl<'a> Set<'a> {
    fn new(take: &'a Take) -> Set<'a> {
        Set {
            take,
            trail: take.trail(),
            frame: Frame::new(take.view.camera, take.view.look),
            poses: Poses::default(),
            extras: Extras::default(),
            scales: Default::default(),
            pane: Image::default(),
            whole: Image::default(),
            sides: 0,
        }
    }

    /// The picture at this part of the way from a frame to the next.
    fn picture(
        &mut self,
        renderer: &mut Renderer,
        frames: &[Recorded],
        before: usize,
        part: f64,
    ) -> Result<&Image, ViewError> {
        let after = (before + 1).min(frames.len() - 1);
        let last = if part < 1.0 { before } else { after };
        let sides = if self.take.rival && frames[last].rival.is_some() { 2 } else { 1 };
        let (width, height) = self.take.view.size;
        if sides != self.sides {
            self.sides = sides;
            self.whole = drawing::board(self.take.view.size, self.take.view.look.theme);
        }
        let mut camera = None;
        for (i, (left, wide)) in drawing::split(width, sides).into_iter().enumerate() {
            let Some(shot) = frames[last].side(i) else { continue };
            // Bodies that come or go do so at once.
            let next = frames[after].side(i).filter(|next| Arc::ptr_eq(&shot.stage, &next.stage)).unwrap_or(shot);
            self.poses.set_between(&shot.poses, &next.poses, part);
            let newest = if Arc::ptr_eq(shot, next) { last } else { after };
            self.extras.trail = trail(frames[..newest].iter().rev(), i, next, self.trail);
            let camera = *camera.get_or_insert_with(|| self.take.camera(shot, &self.poses));
            let view = View { camera, size: (wide, height), ..self.take.view };
            // Cells are not recorded: whether they were a tree's does not matter.
            let moment = Moment { stage: &shot.stage, poses: &self.poses, extras: &self.extras, is_tree: false };
            drawing::fill(&mut self.frame, &moment, &view, &mut self.scales[i]);
            if sides == 1 {
                renderer.render_into(&self.frame, width, height, &mut self.whole)?;
            } else {
                renderer.render_into(&self.frame, wide, height, &mut self.pane)?;
                drawing::put(&mut self.whole, left, &self.pane);
            }
        }
        Ok(&self.whole)
    }
}

impl Take {
    /// The camera of a picture: it goes with the selected body of the world, if it is to follow it.
    fn camera(&self, shot: &Shot, poses: &Poses) -> Camera {
        let mut camera = self.view.camera;
        let index = self.view.selected.and_then(|id| shot.stage.index(id));
        if let (Some(from), Some(to)) = (self.follow, index.and_then(|i| poses.positions.get(i))) {
            mouse::follow(&mut camera, from, *to);
        }
        camera
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
#[path = "reel_tests.rs"]
mod tests;
