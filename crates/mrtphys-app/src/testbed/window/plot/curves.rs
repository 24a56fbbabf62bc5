//! Which curves a plot has.

use super::gas::Gas;
use super::trace::{Moment, Rates, grouped};
use mrtphys::ledger::Ledger;

/// What is plotted over time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Chart {
    /// energies
    #[default]
    Energy,
    /// where every joule went
    Ledger,
    /// relative change of the total energy
    Drift,
    /// momentum
    Momentum,
    /// angular momentum
    AngularMomentum,
    /// tests and calls in a step
    Counters,
    /// impacts in a second
    Impacts,
    /// computing time of a step
    Cost,
    /// distribution of speeds, now
    Speeds,
}

impl Chart {
    /// All charts: name, label of the vertical axis, and what it is.
    pub const ALL: [(Chart, &'static str, &'static str, &'static str); 9] = [
        (
            Chart::Energy,
            "Energy",
            "J",
            "kinetic energy of translation and of rotation, potential energy, and their sum",
        ),
        (Chart::Ledger, "Ledger", "J", "where every joule went, by cause; the residual is what no cause accounts for"),
        (Chart::Drift, "Drift", "|E/E0 - 1|", "relative change of the total energy since the start, in powers of ten"),
        (Chart::Momentum, "Momentum", "Ns", "momentum of all bodies together"),
        (Chart::AngularMomentum, "Ang. momentum", "Js", "angular momentum of all bodies about the origin"),
        (Chart::Counters, "Tests", "per step", "bounding-sphere tests, detect calls and contacts in a step"),
        (
            Chart::Impacts,
            "Impacts",
            "1/s",
            "impacts in a simulated second; for a gas of spheres in a box, beside kinetic theory",
        ),
        (Chart::Cost, "Step time", "ms", "computing time of a physical step"),
        (
            Chart::Speeds,
            "Speeds",
            "bodies",
            "how many bodies have which speed, beside Maxwell and Boltzmann's distribution",
        ),
    ];

    /// Label of the vertical axis.
    pub fn unit(self) -> &'static str {
        Chart::ALL.iter().find(|c| c.0 == self).map_or("", |c| c.2)
    }
}

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// its name in the legend
    pub name: &'static str,
    /// number of its color
    pub color: usize,
    /// whether it is a reference rather than a measurement
    pub dashed: bool,
    /// time \[s\] and value
    pub points: Vec<[f64; 2]>,
}

/// Rates and computing times are means over a part of the time shown: so many points.
const MEANS: usize = 240;
/// Smallest deviation that is told from none: a double has no smaller relative step.
const FINEST: f64 = 1e-17;

/// A curve of the moments that have a value.
fn curve(moments: &[Moment], name: &'static str, color: usize, value: &dyn Fn(&Moment) -> Option<f64>) -> Curve {
    let point = |m: &Moment| value(m).filter(|y| y.is_finite()).map(|y| [m.time, y]);
    Curve { name, color, dashed: false, points: moments.iter().filter_map(point).collect() }
}

/// The curves of a chart. Moments without a value are left out.
pub fn curves(chart: Chart, moments: &[Moment], gas: Option<&Gas>) -> Vec<Curve> {
    let rates = matches!(chart, Chart::Impacts | Chart::Cost | Chart::Counters);
    let means = if rates { grouped(moments, MEANS) } else { Vec::new() };
    let moments = if rates { &means } else { moments };
    let of = |name, color, value: &dyn Fn(&Moment) -> Option<f64>| curve(moments, name, color, value);
    match chart {
        Chart::Energy => vec![
            of("linear", 0, &|m| Some(m.energy.linear)),
            of("rotation", 1, &|m| Some(m.energy.rotational)),
            of("potential", 2, &|m| Some(m.energy.potential)),
            of("total", 3, &|m| Some(m.energy.total())),
        ],
        Chart::Ledger => ledger(moments),
        Chart::Drift => vec![of("energy", 3, &|m| drift(m).map(|d| d.abs().max(FINEST).log10()))],
        Chart::Momentum => vec![
            of("x", 3, &|m| Some(m.momentum.x)),
            of("y", 2, &|m| Some(m.momentum.y)),
            of("z", 0, &|m| Some(m.momentum.z)),
        ],
        Chart::AngularMomentum => vec![
            of("x", 3, &|m| Some(m.angular_momentum.x)),
            of("y", 2, &|m| Some(m.angular_momentum.y)),
            of("z", 0, &|m| Some(m.angular_momentum.z)),
        ],
        Chart::Counters => vec![
            of("sphere tests", 0, &|m| m.per_step(m.counts.sphere_tests)),
            of("detect calls", 1, &|m| m.per_step(m.counts.detect_calls)),
            of("contacts", 2, &|m| m.per_step(m.counts.contacts)),
        ],
        Chart::Impacts => {
            let between = |m: &Moment| m.counts.impacts.saturating_sub(m.counts.wall_impacts);
            let mut all = vec![
                of("between bodies", 0, &|m| m.per_second(between(m))),
                of("with walls", 1, &|m| m.per_second(m.counts.wall_impacts)),
            ];
            if let Some(gas) = gas {
                let theory = of("kinetic theory", 3, &|m| Some(gas.collisions_per_second(m.energy.linear)));
                all.push(Curve { dashed: true, ..theory });
            }
            all
        }
        Chart::Cost => vec![of("step", 0, &|m| m.step_cost().map(|c| c.as_secs_f64() * 1e3))],
        Chart::Speeds => Vec::new(),
    }
}

/// The entries that are not always zero, and what they leave unexplained.
fn ledger(moments: &[Moment]) -> Vec<Curve> {
    let of = |name, color, value: &dyn Fn(&Moment) -> Option<f64>| curve(moments, name, color, value);
    let entries = Ledger::default().entries();
    let mut all: Vec<Curve> = (0..entries.len())
        .filter(|&i| moments.iter().any(|m| m.ledger.entries()[i].1 != 0.0))
        .map(|i| of(plain(entries[i].0), i, &|m| Some(m.ledger.entries()[i].1)))
        .collect();
    all.push(of("residual", entries.len(), &|m| Some(residual(m))));
    all
}

fn plain(name: &'static str) -> &'static str {
    match name {
        "work_of_fields" => "work of fields",
        "position_correction" => "position correction",
        "moving_bodies" => "moving bodies",
        "created_removed" => "created, removed",
        other => other,
    }
}

/// Energy that no entry of the ledger explains \[J\].
fn residual(m: &Moment) -> f64 {
    m.energy.total() - m.initial_energy.total() - m.ledger.sum()
}

/// E/E0 - 1; `None` where there was no energy at the start.
fn drift(m: &Moment) -> Option<f64> {
    let start = m.initial_energy.total();
    (start != 0.0).then(|| m.energy.total() / start - 1.0)
}

/// A mark of a logarithmic axis: whole powers only, `none` for what is no deviation at all.
pub fn power_of_ten(exponent: f64) -> String {
    let whole = exponent.round();
    if (exponent - whole).abs() > 1e-6 {
        String::new()
    } else if whole <= FINEST.log10() {
        "0".into()
    } else {
        format!("1e{whole}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys::counters::Counters;
    use mrtphys::ledger::Energy;

    fn moment(time: f64, total: f64) -> Moment {
        Moment {
            time,
            energy: Energy { linear: total, ..Energy::default() },
            initial_energy: Energy { linear: 10.0, ..Energy::default() },
            ledger: Ledger { user: 2.0, ..Ledger::default() },
            counts: Counters { impacts: 12, wall_impacts: 4, sphere_tests: 100, ..Counters::default() },
            steps: 4,
            duration: 0.5,
            ..Moment::default()
        }
    }

    fn points(chart: Chart, name: &str) -> Vec<[f64; 2]> {
        let moments = [moment(0.5, 10.0), moment(1.0, 12.5)];
        curves(chart, &moments, None).into_iter().find(|c| c.name == name).map(|c| c.points).unwrap_or_default()
    }

    #[test]
    fn curves_have_the_values_that_they_name() {
        assert_eq!(points(Chart::Energy, "total"), [[0.5, 10.0], [1.0, 12.5]]);
        assert_eq!(points(Chart::Ledger, "user"), [[0.5, 2.0], [1.0, 2.0]]);
        assert_eq!(points(Chart::Ledger, "residual"), [[0.5, -2.0], [1.0, 0.5]]);
        assert_eq!(points(Chart::Ledger, "friction"), [] as [[f64; 2]; 0], "an entry that is always zero is left out");
        assert_eq!(points(Chart::Counters, "sphere tests"), [[0.5, 25.0], [1.0, 25.0]]);
        assert_eq!(points(Chart::Impacts, "between bodies"), [[0.5, 16.0], [1.0, 16.0]]);
        assert_eq!(points(Chart::Impacts, "with walls"), [[0.5, 8.0], [1.0, 8.0]]);
        let drift = points(Chart::Drift, "energy");
        assert!((drift[0][1] + 17.0).abs() < 1e-12 && (drift[1][1] - 0.25f64.log10()).abs() < 1e-12);
    }

    #[test]
    fn without_energy_at_the_start_there_is_no_drift() {
        let m = Moment { initial_energy: Energy::default(), ..moment(0.0, 1.0) };
        assert!(curves(Chart::Drift, &[m], None)[0].points.is_empty());
    }

    #[test]
    fn every_chart_has_curves_of_different_colors() {
        for (chart, ..) in Chart::ALL {
            let all = curves(chart, &[moment(0.0, 1.0)], None);
            assert_eq!(all.is_empty(), chart == Chart::Speeds);
            let mut colors: Vec<usize> = all.iter().map(|c| c.color).collect();
            colors.sort_unstable();
            colors.dedup();
            assert_eq!(colors.len(), all.len());
        }
    }

    #[test]
    fn powers_of_ten_are_written_at_whole_marks_only() {
        assert_eq!([-15.0, -14.5, -17.0, 0.0].map(power_of_ten), ["1e-15", "", "0", "1e0"]);
    }
}
