//! What bodies wear at run time: colors that show a quantity, and an outline.

use crate::palette::{FIXED, Rgb, Theme, default_color};
use crate::poses::Poses;
use crate::scale::round_up;
use crate::stage::Stage;
use mrtphys::{Real, Vec3};

/// What the colors of bodies show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coloring {
    /// nothing: the scene's own colors
    #[default]
    Own,
    /// speed of the centre of mass
    Speed,
    /// angular speed
    Spin,
    /// kinetic energy, of translation and of rotation
    KineticEnergy,
    /// kind of shape
    Kind,
    /// number of contacts
    Contacts,
}

impl Coloring {
    /// All colorings with their names.
    pub const ALL: [(Coloring, &'static str); 6] = [
        (Coloring::Own, "own"),
        (Coloring::Speed, "speed"),
        (Coloring::Spin, "spin"),
        (Coloring::KineticEnergy, "kinetic energy"),
        (Coloring::Kind, "kind"),
        (Coloring::Contacts, "contacts"),
    ];

    /// Whether [`Dress::velocities`] is needed.
    pub fn needs_velocities(self) -> bool {
        matches!(self, Coloring::Speed | Coloring::Spin | Coloring::KineticEnergy)
    }

    /// Whether [`Dress::contacts`] is needed.
    pub fn needs_contacts(self) -> bool {
        self == Coloring::Contacts
    }

    fn quantity(self) -> (&'static str, &'static str) {
        match self {
            Coloring::Own => ("own color", ""),
            Coloring::Speed => ("speed", "m/s"),
            Coloring::Spin => ("angular speed", "rad/s"),
            Coloring::KineticEnergy => ("kinetic energy", "J"),
            Coloring::Kind => ("kind of shape", ""),
            Coloring::Contacts => ("contacts", ""),
        }
    }
}

/// What the bodies of a stage wear. The default is what the scene says, and nothing more.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dress<'a> {
    /// what their colors show
    pub coloring: Coloring,
    /// velocity \[m/s\] and angular velocity \[rad/s\] of every body, in the order of the stage
    pub velocities: &'a [(Vec3, Vec3)],
    /// number of contacts of every body, in the order of the stage: [`Stage::count_contacts`]
    pub contacts: &'a [u32],
    /// the value at the upper end of the colors; those above look the same. `None`: the next round number above the largest
    pub most: Option<Real>,
    /// numbers of the bodies that are outlined
    pub highlight: &'a [usize],
}

/// What colors mean, for a window to draw.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Legend {
    /// the quantity
    pub title: &'static str,
    /// its unit; may be empty
    pub unit: &'static str,
    /// value of the first sample
    pub min: Real,
    /// value of the last sample
    pub max: Real,
    /// colors at even distances from `min` to `max`; none: see `kinds`
    pub samples: Vec<Rgb>,
    /// colors that stand for something that is no number, with its name
    pub kinds: Vec<(String, Rgb)>,
}

/// Colors of a legend's ramp.
const SAMPLES: usize = 33;

impl Legend {
    /// From 0 to a value.
    pub(crate) fn to(max: Real, title: &'static str, unit: &'static str, theme: Theme) -> Legend {
        let samples = (0..SAMPLES).map(|i| theme.ramp(i as Real / (SAMPLES - 1) as Real)).collect();
        Legend { title, unit, min: 0.0, max, samples, kinds: Vec::new() }
    }

    /// The color of a value; black where there are no samples.
    pub fn color(&self, value: Real) -> Rgb {
        let last = self.samples.len().saturating_sub(1);
        let at = ((value - self.min) / (self.max - self.min)).clamp(0.0, 1.0) * last as Real;
        // A NaN becomes 0.
        self.samples.get(at.round() as usize).copied().unwrap_or_default()
    }
}

/// The colors of a picture's bodies.
pub(crate) struct Paint<'a> {
    stage: &'a Stage,
    poses: &'a Poses,
    dress: Dress<'a>,
    theme: Theme,
    most: Real,
    /// colors at even distances from 0 to `most`
    ramp: [Rgb; RAMP],
}

/// Colors that bodies have: steps too small to be seen.
const RAMP: usize = 256;

impl<'a> Paint<'a> {
    /// Looks for the largest value. Where what the coloring needs is not there, every body has its own color.
    pub fn new(stage: &'a Stage, dress: &Dress<'a>, theme: Theme, poses: &'a Poses) -> Paint<'a> {
        let (n, mut dress) = (stage.body_count(), *dress);
        let lacks = |needed: bool, there: usize| needed && there != n;
        if lacks(dress.coloring.needs_velocities(), dress.velocities.len())
            || lacks(dress.coloring.needs_contacts(), dress.contacts.len())
        {
            dress.coloring = Coloring::Own;
        }
        let ramp = std::array::from_fn(|i| theme.ramp(i as Real / (RAMP - 1) as Real));
        let mut paint = Paint { stage, poses, dress, theme, most: 1.0, ramp };
        let given = dress.most.filter(|m| *m > 0.0 && m.is_finite());
        paint.most = given.unwrap_or_else(|| round_up((0..n).filter_map(|i| paint.value(i)).fold(0.0, Real::max)));
        paint
    }

    /// What the colors mean; `None`: they are the bodies' own.
    pub fn legend(&self) -> Option<Legend> {
        let (title, unit) = self.dress.coloring.quantity();
        match self.dress.coloring {
            Coloring::Own => None,
            Coloring::Kind => {
                let kind = |k: &String| (k.clone(), default_color(k, false));
                let mut kinds: Vec<(String, Rgb)> = self.stage.kinds().iter().map(kind).collect();
                if (0..self.stage.body_count()).any(|i| self.stage.is_fixed(i)) {
                    kinds.push(("fixed".into(), FIXED));
                }
                Some(Legend { title, kinds, ..Legend::default() })
            }
            _ => Some(Legend::to(self.most, title, unit, self.theme)),
        }
    }

    /// The color of a body.
    pub fn color(&self, i: usize) -> Rgb {
        match self.dress.coloring {
            Coloring::Own => self.stage.color(i),
            Coloring::Kind => default_color(self.stage.kind(i), self.stage.is_fixed(i)),
            // The conversion saturates.
            _ => self.value(i).map_or(FIXED, |v| {
                let step = (v / self.most * (RAMP - 1) as Real + 0.5) as usize;
                self.ramp[step.min(RAMP - 1)]
            }),
        }
    }

    /// What the color of a body shows; `None`: nothing, as of one that never moves.
    fn value(&self, i: usize) -> Option<Real> {
        if self.dress.coloring == Coloring::Contacts {
            return Some(Real::from(self.dress.contacts[i]));
        }
        if !self.dress.coloring.needs_velocities() || self.stage.is_fixed(i) {
            return None;
        }
        let (v, w) = self.dress.velocities[i];
        let value = match self.dress.coloring {
            Coloring::Speed => v.length(),
            Coloring::Spin => w.length(),
            _ => self.stage.kinetic_energy(i, self.poses.orientations[i], v, w),
        };
        value.is_finite().then_some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::frame::{Frame, Look};
    use mrtphys_scene::{Loaded, Scene};

    fn loaded() -> Loaded {
        let text = "format = 1
[[body]]
shape = { kind = \"sphere\", radius = 1 }
position = [0, 0, 0]
velocity = [0, 3, 4]
[[body]]
shape = { kind = \"box\", size = [1, 2, 3] }
position = [5, 0, 0]
angular_velocity = [1, 2, 2]
[[body]]
shape = { kind = \"sphere\", radius = 1 }
position = [9, 0, 0]
fixed = true
";
        Scene::from_text("test", text).unwrap().build().unwrap()
    }

    fn worn(dress: &Dress<'_>) -> (Vec<[u8; 4]>, Option<Legend>, Frame) {
        let loaded = loaded();
        let stage = Stage::new(&loaded);
        let mut poses = Poses::default();
        stage.read(&loaded.world, &mut poses);
        let camera = Camera { eye: Vec3::Z * 9.0, look_at: Vec3::ZERO, up: Vec3::Y, fov_deg: 60.0 };
        let mut frame = Frame::new(camera, Look::default());
        let legend = stage.fill_dressed(camera, Look::default(), dress, &poses, &mut frame);
        let s = &frame.spheres;
        (vec![s[0].color, frame.batches[0].instances[0].color, s[1].color], legend, frame)
    }

    fn velocities() -> Vec<(Vec3, Vec3)> {
        let world = loaded().world;
        world.bodies().map(|id| world.body(id).unwrap()).map(|b| (b.velocity, b.angular_velocity)).collect()
    }

    #[test]
    fn colors_show_what_they_say() {
        let v = velocities();
        let dress = Dress { velocities: &v, contacts: &[2, 5, 1], ..Dress::default() };
        let (own, legend, _) = worn(&dress);
        assert_eq!(legend, None);
        let world = loaded().world;
        let energy = world.body(world.bodies().nth(1).unwrap()).unwrap().rotational_energy();
        let top = round_up(energy.max(loaded().world.energy().linear));
        let part = |x: Real| opaque(Theme::Light.ramp((x * 255.0).round() / 255.0));
        for (coloring, max, right) in [
            (Coloring::Speed, 5.0, [part(1.0), part(0.0), opaque(FIXED)]),
            (Coloring::Spin, 5.0, [part(0.0), part(0.6), opaque(FIXED)]),
            (Coloring::Contacts, 5.0, [part(0.4), part(1.0), part(0.2)]),
            (
                Coloring::KineticEnergy,
                top,
                [part(loaded().world.energy().linear / top), part(energy / top), opaque(FIXED)],
            ),
        ] {
            let (colors, legend, _) = worn(&Dress { coloring, ..dress });
            let legend = legend.unwrap();
            assert_eq!((legend.min, legend.max), (0.0, max), "{coloring:?}");
            assert_eq!(colors, right, "{coloring:?}");
            assert_eq!(
                (legend.samples[0], *legend.samples.last().unwrap()),
                (Theme::Light.ramp(0.0), Theme::Light.ramp(1.0))
            );
            assert!(colors[..2] != own[..2]);
        }
        let (colors, legend, _) = worn(&Dress { coloring: Coloring::Kind, ..dress });
        let kinds = legend.unwrap().kinds;
        assert_eq!(kinds.len(), 3, "two kinds and what is fixed: {kinds:?}");
        assert!(colors.iter().zip([0, 1, 2]).all(|(c, i)| *c == opaque(kinds[i].1)));
        let (colors, ..) = worn(&Dress { coloring: Coloring::Speed, most: Some(20.0), ..dress });
        assert_eq!(colors[0], part(0.25));
    }

    fn opaque([r, g, b]: Rgb) -> [u8; 4] {
        [r, g, b, 255]
    }

    #[test]
    fn without_the_numbers_colors_stay_and_there_is_no_legend() {
        let (own, ..) = worn(&Dress::default());
        for coloring in [Coloring::Speed, Coloring::Spin, Coloring::KineticEnergy, Coloring::Contacts] {
            let (colors, legend, _) = worn(&Dress { coloring, ..Dress::default() });
            assert_eq!((colors, legend), (own.clone(), None));
        }
        let wild = [(Vec3::splat(Real::NAN), Vec3::splat(Real::INFINITY)); 3];
        let (colors, legend, _) = worn(&Dress { coloring: Coloring::Speed, velocities: &wild, ..Dress::default() });
        assert_eq!((colors[0], legend.unwrap().max), (opaque(FIXED), 1.0));
    }

    #[test]
    fn the_outlined_bodies_are_in_the_frame() {
        let (_, _, frame) = worn(&Dress { highlight: &[1, 0, 77], ..Dress::default() });
        let found: Vec<_> = frame.highlight.iter().map(|h| (h.batch, h.body.position, h.body.scale)).collect();
        let right = [(Some(0), frame.batches[0].instances[0]), (None, frame.spheres[0])];
        assert_eq!(found, right.map(|(batch, b)| (batch, b.position, b.scale)));
        assert!(worn(&Dress::default()).2.highlight.is_empty());
    }
}
