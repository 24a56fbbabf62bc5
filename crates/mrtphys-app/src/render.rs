//! `mrtphys render`: pictures and films without a window.

use crate::exit::{Failure, Outcome};
use crate::interrupt;
use crate::output::{Whole, check_distinct, say};
use crate::progress::Progress;
use crate::render_args::RenderArgs;
use crate::{run, setup};
use mrtphys::World;
use mrtphys_scene::Loaded;
use mrtphys_view::film::{Folder, Gif, write_png};
use mrtphys_view::{Camera, Film, Frame, Image, Look, Mode, Poses, Quality, Renderer, Stage, Theme, ViewError};
use std::io::{self, Write};
use std::path::Path;

/// Most pictures of a film.
const MOST_PICTURES: f64 = 1e6;
/// A time closer to a step than this part of it is at the step.
const AT_A_STEP: f64 = 1e-6;

/// Where the pictures go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// one picture
    Png,
    /// a film of few colors
    Gif,
    /// a film
    Mp4,
    /// a folder of pictures
    Folder,
}

impl Kind {
    /// What a path asks for.
    pub fn of(path: &Path) -> Outcome<Kind> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            _ if path.is_dir() => Ok(Kind::Folder),
            None => Ok(Kind::Folder),
            Some("png") => Ok(Kind::Png),
            Some("gif") => Ok(Kind::Gif),
            Some("mp4") => Ok(Kind::Mp4),
            Some(other) => Err(Failure::Wrong(format!(
                "'{}': pictures are written as .png, .gif or .mp4, or into a folder (a name without an ending), not as .{other}",
                path.display()
            ))),
        }
    }

    fn default_fps(self) -> u32 {
        if self == Kind::Gif { 25 } else { 30 }
    }
}

/// How a command ends that cannot draw or write a picture.
pub fn failure(e: ViewError) -> Failure {
    match e {
        ViewError::Driver(_) | ViewError::Write(_) => Failure::Stopped(e.to_string()),
        _ => Failure::Wrong(e.to_string()),
    }
}

/// Draws a scene.
pub fn render(args: &RenderArgs, quiet: bool) -> Outcome {
    interrupt::listen()?;
    let pool = run::threads(args.simulation.threads)?;
    pool.install(|| render_here(args, quiet))
}

fn render_here(args: &RenderArgs, quiet: bool) -> Outcome {
    let kind = Kind::of(&args.output)?;
    let inputs = [("the scene", Some(Path::new(&args.scene))), ("--resume", args.simulation.resume.as_deref())];
    let inputs: Vec<(&str, &Path)> = inputs.into_iter().filter_map(|(what, path)| Some((what, path?))).collect();
    check_distinct(&[("--output", &args.output)], &inputs)?;
    let mut scene = setup::load(&args.scene)?;
    setup::apply(&args.simulation, None, &mut scene);
    let mut loaded = scene.build().map_err(|e| Failure::Wrong(e.to_string()))?;
    setup::take_up(&args.simulation, &mut loaded.world)?;
    let mut reel = Reel::new(args, kind, &loaded, quiet)?;
    let name = args.output.display();
    let done = match kind {
        Kind::Folder => {
            check_folder(&args.output)?;
            let mut folder = Folder::create(&args.output)
                .map_err(|e| Failure::Wrong(format!("cannot make the folder '{name}': {e}")))?;
            reel.shoot(&mut loaded.world, &mut folder)
        }
        _ => into_file(args, kind, &mut reel, &mut loaded.world),
    };
    let wall = reel.progress.seconds();
    reel.progress.clear();
    if reel.pictures > 0 && (done.is_ok() || !matches!(done, Err(Failure::Wrong(_)))) {
        let (n, s) = (reel.pictures, if reel.pictures == 1 { "" } else { "s" });
        let (w, h) = args.size;
        let driver = &reel.renderer.gpu().name;
        say(&format!("{name}: {n} picture{s} of {w} x {h} pixels in {wall:.1} s, drawn by {driver}\n"))?;
    }
    done
}

/// Pictures of another film in the folder would be taken for this one's.
pub fn check_folder(path: &Path) -> Outcome {
    let Ok(entries) = std::fs::read_dir(path) else { return Ok(()) };
    let is_picture = |name: &str| name.starts_with("frame_") && name.ends_with(".png");
    if entries.flatten().any(|e| is_picture(&e.file_name().to_string_lossy())) {
        return Err(Failure::Wrong(format!("the folder '{}' holds the pictures of a film already", path.display())));
    }
    Ok(())
}

/// Writes a file that appears as a whole, with what there is when an interrupt or an error of the simulation ends it.
fn into_file(args: &RenderArgs, kind: Kind, reel: &mut Reel, world: &mut World) -> Outcome {
    let file = Whole::check(&args.output)?;
    let mut done = Ok(());
    let written = file.write(|to| {
        done = open(to, kind, args.size, f64::from(reel.fps)).and_then(|mut film| reel.shoot(world, &mut *film));
        // An error that leaves no whole file leaves none at all.
        if reel.finished { Ok(()) } else { Err(io::Error::other("the film was not finished")) }
    });
    match done {
        Err(_) => done,
        Ok(()) => written,
    }
}

/// A film into a file.
pub fn open<'a>(
    to: &'a mut dyn Write,
    kind: Kind,
    (width, height): (u32, u32),
    fps: f64,
) -> Outcome<Box<dyn Film + 'a>> {
    match kind {
        Kind::Gif => Ok(Box::new(Gif::new(to, width, height, fps).map_err(failure)?)),
        #[cfg(feature = "mp4")]
        Kind::Mp4 => Ok(Box::new(mrtphys_view::film::Mp4::new(to, width, height, fps).map_err(failure)?)),
        #[cfg(not(feature = "mp4"))]
        Kind::Mp4 => {
            Err(Failure::Wrong("this program was built without .mp4 (cargo feature 'mp4'); .gif works".into()))
        }
        Kind::Png | Kind::Folder => Ok(Box::new(Single { to })),
    }
}

/// One picture as a "film".
struct Single<'a> {
    to: &'a mut dyn Write,
}

impl Film for Single<'_> {
    fn put(&mut self, image: &Image) -> Result<(), ViewError> {
        write_png(image, &mut *self.to)
    }

    fn finish(&mut self) -> Result<(), ViewError> {
        Ok(())
    }
}

/// What is drawn when.
struct Reel {
    renderer: Renderer,
    stage: Stage,
    camera: Camera,
    look: Look,
    size: (u32, u32),
    /// pictures per second of the film
    fps: u32,
    speed: f64,
    /// simulated time of the first picture \[s\]
    start: f64,
    count: u64,
    /// pictures made
    pictures: u64,
    finished: bool,
    steps: u64,
    progress: Progress,
}

impl Reel {
    fn new(args: &RenderArgs, kind: Kind, loaded: &Loaded, quiet: bool) -> Outcome<Reel> {
        let now = loaded.world.time();
        let start = args.at.unwrap_or(now);
        if start < now {
            return Err(Failure::Wrong(format!("--at {start}: the snapshot is at {now} s, which is later")));
        }
        let fps = args.fps.unwrap_or(kind.default_fps());
        let count = picture_count(args, kind, start, loaded.scene.seconds, fps)?;
        let renderer = Renderer::new().map_err(failure)?;
        let stage = Stage::new(loaded);
        let mut camera = stage.camera();
        if args.fit {
            camera.fit(&stage.bounds(), f64::from(args.size.0) / f64::from(args.size.1));
        }
        let look = Look {
            mode: Mode::ALL.iter().find(|m| m.1 == args.mode).map_or(Mode::default(), |m| m.0),
            quality: args.quality.map_or(Quality::Auto, Quality::Level),
            theme: if args.dark { Theme::Dark } else { Theme::Light },
            smooth: Some(true),
            ..Look::default()
        };
        let last = start + (count - 1) as f64 * args.speed / f64::from(fps);
        let steps_total = ((last - now) / loaded.world.time_step()).ceil().max(0.0) as u64;
        let progress = Progress::new(quiet, steps_total);
        let (size, speed) = (args.size, args.speed);
        let (pictures, finished, steps) = (0, false, 0);
        Ok(Reel { renderer, stage, camera, look, size, fps, speed, start, count, pictures, finished, steps, progress })
    }

    /// Simulates, draws, and ends the film with what there is.
    fn shoot(&mut self, world: &mut World, film: &mut dyn Film) -> Outcome {
        let ended = self.pictures_of(world, film);
        // A film that could not be written is not ended; anything else leaves one that can be played.
        if self.pictures > 0 && !matches!(ended, Err(Ending::Film(_))) {
            film.finish().map_err(failure)?;
            self.finished = true;
        }
        ended.map_err(|e| match e {
            Ending::Film(failure) | Ending::World(failure) => failure,
        })
    }

    fn pictures_of(&mut self, world: &mut World, film: &mut dyn Film) -> Result<(), Ending> {
        let (mut before, mut after, mut between) = (Poses::default(), Poses::default(), Poses::default());
        self.stage.read(world, &mut after);
        before.clone_from(&after);
        let (mut frame, mut image) = (Frame::new(self.camera, self.look), Image::default());
        let (mut from, mut to) = (world.time(), world.time());
        for i in 0..self.count {
            let time = self.start + i as f64 * self.speed / f64::from(self.fps);
            while to < time - AT_A_STEP * world.time_step() {
                if interrupt::asked() {
                    return Err(Ending::World(Failure::Interrupted));
                }
                // Only the states before and after a picture are read.
                if to + world.time_step() >= time - AT_A_STEP * world.time_step() {
                    self.stage.read(world, &mut before);
                    from = to;
                }
                world.step().map_err(|e| {
                    Ending::World(Failure::Stopped(format!("the simulation stopped at {} s: {e}", world.time())))
                })?;
                to = world.time();
                self.steps += 1;
                self.progress.tick(self.steps, to);
                if to >= time - AT_A_STEP * world.time_step() {
                    self.stage.read(world, &mut after);
                }
            }
            if interrupt::asked() {
                return Err(Ending::World(Failure::Interrupted));
            }
            let part = if to > from { ((time - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 };
            between.set_between(&before, &after, part);
            self.stage.fill(self.camera, self.look, &between, &mut frame);
            let (width, height) = self.size;
            let drawn = self.renderer.render_into(&frame, width, height, &mut image);
            drawn.and_then(|()| film.put(&image)).map_err(|e| Ending::Film(failure(e)))?;
            self.pictures += 1;
        }
        Ok(())
    }
}

/// Why there are no more pictures.
enum Ending {
    /// one could not be drawn or written
    Film(Failure),
    /// there is nothing more to draw
    World(Failure),
}

/// How many pictures: a film of ten seconds at 30 a second has 300, the first at its beginning.
fn picture_count(args: &RenderArgs, kind: Kind, start: f64, scene_seconds: f64, fps: u32) -> Outcome<u64> {
    if kind == Kind::Png {
        let given = [("--seconds", args.seconds.is_some()), ("--frames", args.frames.is_some())];
        return match given.iter().find(|g| g.1) {
            Some((option, _)) => {
                Err(Failure::Wrong(format!("{option} is for films: a .png is one picture, at the time that --at says")))
            }
            None => Ok(1),
        };
    }
    if let Some(frames) = args.frames {
        return Ok(frames);
    }
    let shown = args.seconds.unwrap_or(scene_seconds - start).max(0.0);
    let pictures = (shown * f64::from(fps) / args.speed).round().max(1.0);
    if pictures > MOST_PICTURES {
        return Err(Failure::Wrong(format!("{pictures} pictures are more than a film may have ({MOST_PICTURES})")));
    }
    Ok(pictures as u64)
}
