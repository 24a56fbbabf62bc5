//! Pictures and films of [`mrtphys`] worlds, without a window.
//!
//! [`Stage`] knows what the bodies and boundaries of a scene look like; it fills a [`Frame`], which is plain data; the
//! [`Renderer`] draws a frame into a texture, which is read back as an [`Image`], written by a [`Film`], or shown by a
//! window. The renderer knows nothing of the simulator, and the simulator nothing of it.
//!
//! ```no_run
//! use mrtphys_view::{Look, Renderer, frame_of};
//!
//! let scene = mrtphys_scene::Scene::load("scenes/cradle.toml".as_ref()).unwrap();
//! let loaded = scene.build().unwrap();
//! let image = Renderer::new()?.render(&frame_of(&loaded, Look::default()), 1280, 720)?;
//! std::fs::write("cradle.png", mrtphys_view::film::png_bytes(&image)?).unwrap();
//! # Ok::<(), mrtphys_view::ViewError>(())
//! ```
//!
//! Feature `mp4` (on by default) writes films as H.264. It compiles the OpenH264 library from its C++ source: a C++ compiler
//! (`g++` or `clang++`) is needed to build it, and nothing more to run it.
#![warn(missing_docs)]

// What is drawn.
pub mod camera;
pub mod palette;
pub mod mesh;
pub mod overlay;
pub mod frame;
pub mod scale;
pub mod explain;
mod walls;
mod dress;
mod pick;
mod poses;
mod stage;

// How it is drawn.
mod matrix;
mod uniforms;
mod lists;
mod pipelines;
mod canvas;
mod gpu;
mod outline;
mod renderer;

// Where it goes.
pub mod image;
pub mod film;
mod error;

pub use camera::{Camera, Ray};
pub use canvas::Canvas;
pub use dress::{Coloring, Dress, Legend};
pub use error::ViewError;
pub use explain::{Drawn, Pen};
pub use film::Film;
pub use frame::{Frame, Illumination, Light, Look, Mode, Quality};
pub use gpu::Gpu;
pub use image::Image;
pub use lists::Sorting;
pub use overlay::Overlay;
pub use palette::Theme;
pub use pick::Hit;
pub use poses::Poses;
pub use renderer::Renderer;
pub use scale::Scale;
pub use stage::{Stage, frame_of};
