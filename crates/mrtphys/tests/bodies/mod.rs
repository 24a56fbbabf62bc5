//! A handful of bodies that move and never meet: a model and a state built by hand, for tests of the motion stage alone.
#![allow(dead_code)]

use mrtphys::bounds::Ball;
use mrtphys::counters::Counters;
use mrtphys::field::sum::potential_energy;
use mrtphys::field::{FlowField, ForceField, PlacedFlow, PlacedForce, Reach, Scope};
use mrtphys::ledger::Ledger;
use mrtphys::math::{Quat, Real, Vec3};
use mrtphys::model::{BodyType, Inertia, Model};
use mrtphys::motion::advance;
use mrtphys::narrow::kinds::Kinds;
use mrtphys::narrow::pair_table::PairTable;
use mrtphys::shape::{MassProperties, Shape};
use mrtphys::state::{Line, Spin, State};
use mrtphys::work::Work;
use mrtphys::{ContactMode, Error, Settings, Surface};
use std::sync::Arc;

#[derive(Debug)]
struct Dot;

impl Shape for Dot {
    fn kind(&self) -> &'static str {
        "sphere"
    }
    fn bounding_sphere(&self) -> Ball {
        Ball { center: Vec3::ZERO, radius: 0.1 }
    }
    fn mass_properties(&self) -> Option<MassProperties> {
        None
    }
}

/// No pair is ever asked about.
fn table() -> PairTable {
    Kinds::standard(ContactMode::Exact).resolve()
}

#[derive(Default)]
pub struct Run {
    pub ledger: Ledger,
    pub counters: Counters,
    pub work: Work,
}

pub struct Bodies {
    pub model: Model,
    pub state: State,
    pub run: Run,
}

impl Bodies {
    pub fn new(settings: Settings) -> Bodies {
        let model = Model {
            settings,
            table: table(),
            types: Vec::new(),
            type_of: Vec::new(),
            serial: Vec::new(),
            fixed: Vec::new(),
            boundaries: Vec::new(),
            wall_bounds: Vec::new(),
            forces: Vec::new(),
            flows: Vec::new(),
            all_spheres: false,
            all_smooth: false,
            spheres_meet_as_spheres: true,
            epoch: 0,
        };
        Bodies { model, state: State::default(), run: Run::default() }
    }

    pub fn add(&mut self, mass: Real, x: Vec3, v: Vec3) -> usize {
        self.add_with(mass, Inertia::new(Vec3::splat(1.0), Quat::IDENTITY), 0.0, x, v)
    }

    pub fn add_with(&mut self, mass: Real, inertia: Inertia, volume: Real, x: Vec3, v: Vec3) -> usize {
        let slot = self.state.lines.len();
        let kind = Kinds::standard(ContactMode::Exact).id("sphere").unwrap();
        let ball = Dot.bounding_sphere();
        let surface = Surface::default();
        self.model.types.push(BodyType { shape: Arc::new(Dot), kind, mass, inertia, surface, volume, ball });
        self.model.type_of.push(slot as u32);
        self.model.serial.push(slot as u32);
        self.model.fixed.push(mass == Real::INFINITY);
        let inverse_mass = if mass == Real::INFINITY { 0.0 } else { 1.0 / mass };
        self.state.lines.push(Line { x, radius: 0.1, v, inverse_mass });
        self.state.spins.push(Spin { q: Quat::IDENTITY, l: Vec3::ZERO });
        slot
    }

    pub fn force(&mut self, field: impl ForceField + 'static) {
        self.force_of(field, None, false);
    }

    pub fn force_of(&mut self, field: impl ForceField + 'static, carrier: Option<usize>, without_reaction: bool) {
        let scope = Scope { without_reaction, ..Scope::default() };
        let reach = Reach { carrier: carrier.map(|slot| slot as u32), ..Reach::default() };
        self.model.forces.push(PlacedForce { field: Arc::new(field), scope, reach });
    }

    pub fn flow(&mut self, field: impl FlowField + 'static) {
        self.model.flows.push(PlacedFlow { field: Arc::new(field), scope: Scope::default(), reach: Reach::default() });
    }

    pub fn step(&mut self, dt: Real) -> Result<(), Error> {
        let Run { ledger, counters, work } = &mut self.run;
        advance(&self.model, &mut self.state, work, dt, ledger, counters)
    }

    pub fn steps(&mut self, dt: Real, count: usize) {
        for _ in 0..count {
            self.step(dt).unwrap();
        }
    }

    pub fn kinetic(&self) -> Real {
        let of = |slot: usize| {
            let (body, line, spin) = (self.model.body(slot), &self.state.lines[slot], &self.state.spins[slot]);
            if line.inverse_mass == 0.0 {
                return 0.0;
            }
            0.5 * body.mass * line.v.length_squared() + body.inertia.energy(spin.q, spin.l)
        };
        (0..self.state.lines.len()).map(of).sum()
    }

    pub fn energy(&self) -> Real {
        self.kinetic() + potential_energy(&self.model, &self.state)
    }
}
