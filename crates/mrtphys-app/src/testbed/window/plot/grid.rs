//! Where the lines and numbers of an axis are: at round numbers, near enough to each other that there are always several.

use egui_plot::{GridInput, GridMark};

/// Points between the finest lines that the plot draws: `Plot::grid_spacing` begins here.
pub const FINEST: f32 = 8.0;
/// More lines than any screen has room for.
const MOST: f64 = 4096.0;

/// Lines at round numbers; those at least `apart` points from each other bear a number, the others lie between them.
pub fn marks(input: &GridInput, apart: f64) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    let (coarse, parts) = round(input.base_step_size / f64::from(FINEST) * apart);
    let fine = coarse / f64::from(parts);
    let (first, last) = ((low / fine).ceil(), (high / fine).floor());
    if !(fine > 0.0 && last - first <= MOST && first.is_finite()) {
        return Vec::new();
    }
    let mark =
        |i: i64| GridMark { value: i as f64 * fine, step_size: if i % i64::from(parts) == 0 { coarse } else { fine } };
    (first as i64..=last as i64).map(mark).collect()
}

/// The smallest of 1, 2 and 5 times a power of ten that is not less, and into how many parts it is divided.
fn round(least: f64) -> (f64, u8) {
    let power = 10f64.powf(least.log10().floor());
    let steps = [(1.0, 5), (2.0, 4), (5.0, 5), (10.0, 5)];
    let (factor, parts) = steps.into_iter().find(|s| s.0 * power >= least).unwrap_or((10.0, 5));
    (factor * power, parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Marks of an axis of so many points.
    fn axis(bounds: (f64, f64), points: f64, apart: f64) -> Vec<GridMark> {
        let base_step_size = (bounds.1 - bounds.0) / points * f64::from(FINEST);
        marks(&GridInput { bounds, base_step_size }, apart)
    }

    #[test]
    fn every_axis_has_several_numbers_at_even_places() {
        for top in [1e-14, 0.97, 6.955, 7.0, 10.0, 1.1e3, 4e17] {
            for points in [140.0, 220.0, 400.0] {
                let marks = axis((-0.08 * top, 1.08 * top), points, 32.0);
                let coarse = marks.iter().map(|m| m.step_size).fold(0.0, f64::max);
                let numbers: Vec<f64> = marks.iter().filter(|m| m.step_size == coarse).map(|m| m.value).collect();
                assert!(numbers.len() >= 2 && numbers.contains(&0.0), "{top} {points}: {numbers:?}");
                assert!(coarse / (1.16 * top) * points >= 31.9, "they would overlap");
                assert!(marks.windows(2).all(|w| w[0].value < w[1].value));
            }
        }
    }

    #[test]
    fn an_axis_without_length_has_no_lines() {
        for (bounds, base_step_size) in
            [((0.0, 1.0), 0.0), ((0.0, f64::INFINITY), 1.0), ((f64::NAN, 1.0), 1.0), ((0.0, 1e9), 1e-9)]
        {
            assert!(marks(&GridInput { bounds, base_step_size }, 32.0).is_empty());
        }
    }
}
