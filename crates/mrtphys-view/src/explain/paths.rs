//! Trails, and the hand's spring.

use super::{Drawn, Pen, opaque, spread};
use crate::overlay::{Line, Overlay};
use crate::poses::Poses;
use crate::stage::Stage;
use mrtphys::{Real, Vec3};
use std::borrow::Borrow;

/// Opacity of the newest end of a trail.
const NEWEST: Real = 230.0;
/// Turns of the spring, each of two strokes, and its width relative to what is seen.
const SPRING: (usize, Real) = (9, 0.012);

impl Pen {
    /// Where bodies were: paths of their centres of mass, fading with age, in their own colors. `trail`: earlier poses, oldest
    /// first; `only`: the path of this body alone. Bodies that stand still count as drawn.
    pub fn trails<P: Borrow<Poses>>(
        &self,
        overlay: &mut Overlay,
        stage: &Stage,
        trail: &[P],
        now: &Poses,
        only: Option<usize>,
    ) -> Drawn {
        let count = stage.body_count().min(now.positions.len());
        let all = only.map_or(0..count, |i| i.min(count)..(i + 1).min(count));
        let total = all.len();
        let mut drawn = 0;
        for i in spread(total, self.affordable(trail.len())) {
            self.trail(overlay, stage, trail, now, all.start + i);
            drawn += 1;
        }
        Drawn { drawn, total }
    }

    fn trail<P: Borrow<Poses>>(&self, overlay: &mut Overlay, stage: &Stage, trail: &[P], now: &Poses, i: usize) {
        let n = trail.len();
        let place = |k: usize| {
            let poses = trail.get(k).map_or(now, |p| p.borrow());
            poses.positions.get(i).copied().filter(|p| p.is_finite())
        };
        let color = stage.color(i);
        let mut from = place(0);
        for k in 1..=n {
            let to = place(k);
            if let (Some(from), Some(to)) = (from, to)
                && from != to
            {
                let age = 1.0 - k as Real / n as Real;
                let alpha = (NEWEST * (1.0 - age) * (1.0 - age)).max(6.0) as u8;
                let width = (2.2 - 1.2 * age) as f32;
                let line = self.line(from, to, opaque(color, alpha), width);
                overlay.lines.push(Line { on_top: false, ..line });
            }
            from = to;
        }
    }

    /// The spring from the point where a body is held to the hand.
    pub fn grip(&self, overlay: &mut Overlay, held: Vec3, hand: Vec3) {
        let color = opaque(self.inks.grip, 255);
        let along = hand - held;
        let across = along.cross(self.eye - held).try_normalize();
        let (turns, width) = (SPRING.0, SPRING.1 * self.length);
        let strokes = 2 * turns;
        let at = |k: usize| {
            // Straight ends, and points on both sides by turns between.
            let side = match k {
                0 | 1 => 0.0,
                k if k + 1 >= strokes => 0.0,
                k if k % 2 == 0 => 1.0,
                _ => -1.0,
            };
            held + along * (k as Real / strokes as Real) + across.unwrap_or(Vec3::ZERO) * (side * width)
        };
        for k in 0..strokes {
            let line = self.line(at(k), at(k + 1), color, 1.6);
            overlay.lines.push(Line { on_top: true, ..line });
        }
        let shown = Pen { on_top: true, ..*self };
        shown.dot(overlay, held, self.inks.grip, 5.0);
        shown.dot(overlay, hand, self.inks.grip, 7.0);
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::pen;
    use super::*;
    use mrtphys_scene::Scene;

    #[test]
    fn trails_lead_from_the_oldest_to_now_and_fade() {
        let body =
            |x: i32| format!("[[body]]\nshape = {{ kind = \"sphere\", radius = 0.1 }}\nposition = [{x}, 0, 0]\n");
        let text: String = (0..4).map(body).collect();
        let loaded = Scene::from_text("test", &format!("format = 1\n{text}")).unwrap().build().unwrap();
        let stage = Stage::new(&loaded);
        let mut now = Poses::default();
        stage.read(&loaded.world, &mut now);
        let earlier = |t: Real| {
            let mut p = now.clone();
            // The last stands still, the third was not there.
            p.positions[..2].iter_mut().for_each(|x| x.y -= t);
            p.positions[2] = Vec3::splat(Real::NAN);
            p
        };
        let trail = [earlier(3.0), earlier(2.0), earlier(1.0)];
        let mut o = Overlay::default();
        assert_eq!(pen().trails(&mut o, &stage, &trail, &now, None), Drawn { drawn: 4, total: 4 });
        assert_eq!(o.lines.len(), 6);
        let first = &o.lines[..3];
        assert_eq!((first[0].from, first[2].to), (Vec3::new(0.0, -3.0, 0.0), Vec3::ZERO));
        assert!(first.windows(2).all(|w| w[0].to == w[1].from && w[0].color[3] < w[1].color[3]));
        assert_eq!(first[0].color[..3], stage.color(0));
        o.clear();
        assert_eq!(pen().trails(&mut o, &stage, &trail, &now, Some(1)), Drawn { drawn: 1, total: 1 });
        assert!(o.lines.len() == 3 && o.lines.iter().all(|l| l.from.x == 1.0));
        assert_eq!(pen().trails(&mut o, &stage, &trail, &now, Some(9)), Drawn::default());
        assert_eq!(Pen { lines: 7, ..pen() }.trails(&mut o, &stage, &trail, &now, None), Drawn { drawn: 2, total: 4 });
        assert_eq!(pen().trails::<Poses>(&mut o, &stage, &[], &now, None).drawn, 4);
    }

    #[test]
    fn a_spring_leads_from_the_body_to_the_hand() {
        let mut o = Overlay::default();
        pen().grip(&mut o, Vec3::X, Vec3::Y);
        assert_eq!((o.lines[0].from, o.lines[o.lines.len() - 1].to), (Vec3::X, Vec3::Y));
        assert!(o.lines.windows(2).all(|w| w[0].to == w[1].from));
        let straight = (Vec3::X - Vec3::Y).length();
        let whole: Real = o.lines.iter().map(|l| (l.to - l.from).length()).sum();
        assert!(whole > 1.05 * straight);
        assert_eq!((o.points[0].at, o.points[1].at), (Vec3::X, Vec3::Y));
        o.clear();
        pen().grip(&mut o, Vec3::X, Vec3::X);
        assert!(o.lines.iter().all(|l| l.from.is_finite() && l.to.is_finite()));
    }
}
