//! Energies, and the ledger that says where every joule went.

use super::digest::Digest;
use crate::testbed::session::Numbers;
use crate::testbed::window::desk::Desk;
use crate::testbed::window::format::{drift, reading};
use crate::testbed::window::table::{Row, rows};
use eframe::egui;

/// The section.
#[derive(Default)]
pub struct Energies {
    digest: Digest,
}

/// The ledger's entries in words, in its order, and what they mean.
const ENTRIES: [(&str, &str); 9] = [
    ("friction", "Lost to friction in impacts [J]"),
    ("restitution", "Lost to restitution below 1: impacts that are not elastic [J]"),
    ("drag", "Given to or taken from the medium by viscosity [J]"),
    ("work of fields", "Work of force fields that have no potential, such as a vortex [J]"),
    ("position correction", "Work of pushing overlapping bodies apart [J]"),
    ("integration", "What the integrator gained or lost against the exact motion [J]"),
    ("moving bodies", "Work of bodies of infinite mass that move [J]"),
    ("user", "Changes made by hand: velocities, masses, positions, fields, and the mouse [J]"),
    ("created and removed", "Energy of bodies created after the start, less that of bodies removed [J]"),
];

impl Energies {
    /// Shows it.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let Some(side) = desk.report().sides.first() else { return };
        let (energies, entries) = (energy_rows(&side.numbers), ledger_rows(&side.numbers));
        rows(ui, &mut desk.probes, "energies", &energies);
        ui.add_space(4.0);
        let ledger = egui::CollapsingHeader::new("Where it went").id_salt("ledger").default_open(false);
        let shown = ledger.show(ui, |ui| rows(ui, &mut desk.probes, "ledger", &entries));
        let header = shown.header_response.on_hover_text(
            "Every stage of a step measures the energy it changes and books it here: the entries and the energy at the start add up to the energy now",
        );
        desk.probes.mark("energies.ledger", &header);
        self.digest.show(ui, desk);
    }
}

/// A small difference, with its sign and so many decimals.
fn signed(x: f64, decimals: usize) -> String {
    if x == 0.0 { "0".into() } else { format!("{x:+.decimals$e}") }
}

fn joules(x: f64) -> String {
    format!("{} J", reading(x))
}

fn energy_rows(n: &Numbers) -> Vec<Row<'static>> {
    let drift = drift(n.energy.total(), n.initial_energy.total());
    vec![
        Row::new("linear", joules(n.energy.linear), "Kinetic energy of translation, m v\u{b2}/2 of all bodies [J]"),
        Row::new("rotation", joules(n.energy.rotational), "Kinetic energy of rotation of all bodies [J]"),
        Row::sum("kinetic", joules(n.energy.kinetic()), "Linear and rotational energy together [J]"),
        Row::new("potential", joules(n.energy.potential), "Potential energy in the force fields that have one [J]"),
        Row::sum("total", joules(n.energy.total()), "Kinetic and potential energy together [J]"),
        Row::new("at the start", joules(n.initial_energy.total()), "Total energy when the first step began [J]"),
        Row::new(
            "change E/E\u{2080} - 1",
            drift.map_or("none to compare with".into(), |d| signed(d, 3)),
            "The total energy now against that at the start: zero in a closed system without friction. The ledger says what a change is made of",
        ),
    ]
}

fn ledger_rows(n: &Numbers) -> Vec<Row<'static>> {
    let start = n.initial_energy.total();
    let mut list = vec![Row::new("at the start", joules(start), "Total energy when the first step began [J]")];
    list.extend(ENTRIES.iter().zip(n.ledger.entries()).map(|((name, hint), (_, x))| Row::new(name, joules(x), hint)));
    let sum = start + n.ledger.sum();
    list.push(Row::sum("sum", joules(sum), "The energy at the start and all entries [J]"));
    list.push(Row::sum("total now", joules(n.energy.total()), "The energy that the bodies have now [J]"));
    let rest = n.energy.total() - sum;
    list.push(Row::new(
        "not accounted for",
        format!("{} J", signed(rest, 1)),
        "The energy now less the sum: nothing but rounding, however long it runs [J]",
    ));
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys::ledger::{Energy, Ledger};

    #[test]
    fn the_table_has_every_entry_of_the_ledger_in_its_order() {
        for ((said, _), (name, _)) in ENTRIES.iter().zip(Ledger::default().entries()) {
            let plain = said.replace(" and ", " ").replace(' ', "_");
            assert_eq!(plain, name);
        }
    }

    #[test]
    fn what_is_shown_adds_up() {
        let n = Numbers {
            initial_energy: Energy { linear: 3.0, rotational: 1.0, potential: 0.5 },
            energy: Energy { linear: 2.0, rotational: 1.0, potential: 0.5 },
            ledger: Ledger { friction: -1.5, user: 0.5, ..Ledger::default() },
            ..Numbers::default()
        };
        let said = |list: &[Row<'_>], name: &str| {
            list.iter().find(|r| r.name == name).map(|r| r.value.clone()).unwrap_or_default()
        };
        let (energies, ledger) = (energy_rows(&n), ledger_rows(&n));
        assert_eq!(said(&energies, "kinetic"), "3.000000 J");
        assert_eq!(said(&energies, "total"), "3.500000 J");
        assert_eq!(said(&energies, "change E/E\u{2080} - 1"), "-2.222e-1");
        assert_eq!([signed(0.0, 3), signed(-0.0, 1), signed(2e-15, 1)], ["0", "0", "+2.0e-15"]);
        assert_eq!(said(&ledger, "sum"), said(&ledger, "total now"));
        assert_eq!(said(&ledger, "not accounted for"), "0 J");
        assert_eq!(said(&ledger, "friction"), "-1.500000 J");
    }
}
