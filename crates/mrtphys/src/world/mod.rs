//! The face of the library: create, step, query, snapshot.

mod bodies;
mod boundaries;
mod checks;
mod energy;
mod fields;
mod ids;
mod stepping;

use crate::broad::{self, BroadPhase};
use crate::counters::Counters;
use crate::def::Settings;
use crate::error::{Error, Result};
use crate::event::ImpactEvent;
use crate::id::BodyId;
use crate::impact::{self, ImpactLaw};
use crate::ledger::{Energy, Ledger};
use crate::math::Real;
use crate::model::Model;
use crate::narrow::kinds::Kinds;
use crate::state::State;
use crate::work::{StageTimes, Work};
use ids::IdTable;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

pub use bodies::Body;
pub use boundaries::BoundaryView;
pub use stepping::Overlap;

/// Numbers worlds, so that a handle of one world is recognised by another. Never part of a result.
static NEXT_WORLD: AtomicU32 = AtomicU32::new(1);

/// A world: bodies, boundaries and fields, and the time they have lived through.
pub struct World {
    tag: u32,
    kinds: Kinds,
    model: Model,
    state: State,
    work: Work,
    ids: IdTable,
    fields: fields::FieldTable,
    next_serial: u64,
    scopes_epoch: Option<u64>,
    law: Arc<dyn ImpactLaw>,
    books: Books,
    recording: bool,
    events: VecDeque<ImpactEvent>,
}

/// What is written down on the way; a snapshot carries it, the future does not depend on it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Books {
    pub ledger: Ledger,
    pub totals: Counters,
    pub initial: Option<Energy>,
    pub largest_step: Real,
}

/// A copy that lives on by itself, bit for bit as the original would; handles of the original are handles of the copy too.
/// Scratch memory is not copied, nor are events that nobody has fetched. Nor is a broad phase of the user's: the copy has the
/// one that the settings say until [`set_broad_phase`] is called.
///
/// [`set_broad_phase`]: World::set_broad_phase
impl Clone for World {
    fn clone(&self) -> World {
        World {
            tag: self.tag,
            kinds: self.kinds.clone(),
            model: self.model.clone(),
            state: self.state.clone(),
            work: Work { broad: Some(broad::make(self.model.settings.broad_phase)), ..Work::default() },
            ids: self.ids.clone(),
            fields: self.fields.clone(),
            next_serial: self.next_serial,
            scopes_epoch: self.scopes_epoch,
            law: self.law.clone(),
            books: self.books.clone(),
            recording: self.recording,
            events: VecDeque::new(),
        }
    }
}

impl World {
    /// An empty world with the standard kinds.
    ///
    /// # Errors
    /// A setting is out of range.
    pub fn new(settings: Settings) -> Result<World> {
        let kinds = Kinds::standard(settings.contact);
        World::with_kinds(settings, kinds)
    }

    /// An empty world with an inventory of kinds of the user's, usually [`Kinds::standard`] with additions.
    ///
    /// # Errors
    /// A setting is out of range.
    pub fn with_kinds(settings: Settings, kinds: Kinds) -> Result<World> {
        check_settings(&settings)?;
        let law = impact::make(settings.friction_law);
        let work = Work { broad: Some(broad::make(settings.broad_phase)), ..Work::default() };
        let model = Model {
            table: kinds.resolve(),
            settings,
            types: Vec::new(),
            type_of: Vec::new(),
            serial: Vec::new(),
            fixed: Vec::new(),
            boundaries: Vec::new(),
            wall_bounds: Vec::new(),
            forces: Vec::new(),
            flows: Vec::new(),
            all_spheres: true,
            all_smooth: true,
            spheres_meet_as_spheres: kinds.has_plain_spheres(),
            epoch: 0,
        };
        Ok(World {
            tag: NEXT_WORLD.fetch_add(1, Ordering::Relaxed),
            kinds,
            model,
            state: State::default(),
            work,
            ids: IdTable::default(),
            fields: fields::FieldTable::default(),
            next_serial: 0,
            scopes_epoch: None,
            law,
            books: Books::default(),
            recording: false,
            events: VecDeque::new(),
        })
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.model.settings
    }

    /// Changes the settings, between steps. Energy that this changes (the density of the medium) is booked to `user`.
    ///
    /// # Errors
    /// A value is out of range, or the contact or inertia mode would change, which is fixed when the world is made.
    pub fn set_settings(&mut self, settings: Settings) -> Result<()> {
        check_settings(&settings)?;
        let old = &self.model.settings;
        if settings.contact != old.contact || settings.inertia != old.inertia {
            return Err(Error::LimitExceeded {
                object: "settings".into(),
                what: "changes of the contact or inertia mode after the world was made",
                given: 1,
                limit: 0,
            });
        }
        if settings.broad_phase != old.broad_phase {
            self.work.broad = Some(broad::make(settings.broad_phase));
        }
        if settings.friction_law != old.friction_law {
            self.law = impact::make(settings.friction_law);
        }
        self.booking_all(|world| world.model.settings = settings);
        Ok(())
    }

    /// Replaces the broad phase by one of the user's.
    pub fn set_broad_phase(&mut self, broad: Box<dyn BroadPhase>) {
        self.work.broad = Some(broad);
    }

    /// Replaces the impact law by one of the user's.
    pub fn set_impact_law(&mut self, law: Arc<dyn ImpactLaw>) {
        self.law = law;
    }

    /// The kinds there are.
    pub fn kinds(&self) -> &Kinds {
        &self.kinds
    }

    /// Simulated time \[s\].
    pub fn time(&self) -> Real {
        self.state.clock.time()
    }

    /// Physical steps made.
    pub fn steps(&self) -> u64 {
        self.state.clock.steps
    }

    /// Length of a physical step \[s\]: 1 / (fps x steps per frame).
    pub fn time_step(&self) -> Real {
        1.0 / (f64::from(self.model.settings.fps) * f64::from(self.model.settings.steps_per_frame))
    }

    /// Counts of the last step.
    pub fn counters(&self) -> &Counters {
        &self.work.counters
    }

    /// Counts summed over all steps.
    pub fn totals(&self) -> &Counters {
        &self.books.totals
    }

    /// The largest distance that any body moved in a step so far, as a multiple of its own diameter. Above 0.25 collisions
    /// can go unseen at fixed steps (requirement 4).
    pub fn largest_step(&self) -> Real {
        self.books.largest_step
    }

    /// Wall time of the stages of the last step.
    pub fn stage_times(&self) -> &StageTimes {
        &self.work.stages
    }

    /// Whether impacts are written down one by one for [`drain_events`](World::drain_events).
    pub fn record_events(&mut self, on: bool) {
        self.recording = on;
    }

    /// The impacts since the last call, in order of time.
    pub fn drain_events(&mut self) -> impl Iterator<Item = ImpactEvent> + '_ {
        self.events.drain(..)
    }

    /// Contacts of the last step in the order of response, for drawing. They are put in order when first asked for, where the
    /// step itself had no need of it.
    pub fn contacts(&self) -> &crate::contact::ContactList {
        self.work.contacts.ordered()
    }

    /// The body in a slot, as [`contacts`](World::contacts) names bodies: valid until bodies come or go or are sorted.
    pub fn body_in_slot(&self, slot: u32) -> Option<BodyId> {
        ((slot as usize) < self.body_count()).then(|| self.ids.id(slot as usize, self.tag))
    }

    /// Keys of the pairs that were in contact in the last step, ascending, where the friction law asks for them.
    pub fn contact_memory(&self) -> &[u64] {
        self.state.contacts.keys()
    }

    /// Cells of the broad phase as of the last step, for drawing.
    pub fn cells(&self) -> Vec<broad::Cell> {
        self.work.broad.as_ref().map_or_else(Vec::new, |b| b.cells())
    }

    /// Forgets all scratch memory. It changes no result; tests use it to prove that.
    pub fn forget_scratch(&mut self) {
        let kind = self.model.settings.broad_phase;
        self.work = Work { broad: Some(broad::make(kind)), ..Work::default() };
    }

    /// Digest of what the future depends on: time, bodies, contact and let-back memory; never counters, ledger or broad
    /// phase. 32 hexadecimal digits; equal on every machine, thread count, broad phase and build profile.
    pub fn state_hash(&self) -> String {
        crate::record::digest::state_hash(&self.model, &self.state, &self.model.order())
    }

    /// Everything that the future depends on, and the books, as bytes with a checksum.
    pub fn snapshot(&self) -> Vec<u8> {
        let order = self.model.order();
        if self.scopes_are_fresh() {
            return crate::record::snapshot::write(&self.model, &self.state, &self.books, &order);
        }
        crate::record::snapshot::write(&self.with_fresh_scopes(), &self.state, &self.books, &order)
    }

    /// Goes on from a snapshot of a world with the same bodies, boundaries and fields. The world continues bit for bit as
    /// the one that was saved.
    ///
    /// # Errors
    /// The bytes are damaged, of another version, or of a world with other contents; this world is then unchanged.
    pub fn restore(&mut self, snapshot: &[u8]) -> Result<()> {
        self.refresh_scopes();
        let order = self.model.order();
        let (state, books) = crate::record::snapshot::read(snapshot, &self.model, &self.state, &order)?;
        self.state = state;
        self.work.nothing_spins = false;
        self.books = books;
        self.work.storage_is_new = true;
        self.model.epoch += 1;
        Ok(())
    }
}

fn check_settings(s: &Settings) -> Result<()> {
    let object = || "settings".to_string();
    let range = |field, value: Real, low: Real, high: Real, expected| {
        if !value.is_finite() {
            return Err(Error::NonFinite { object: object(), field });
        }
        if value < low || value > high {
            return Err(Error::OutOfRange { object: object(), field, value, expected });
        }
        Ok(())
    };
    range("fps", s.fps.into(), 1.0, 1e9, "1 to 10^9")?;
    range("steps_per_frame", s.steps_per_frame.into(), 1.0, 1e9, "1 to 10^9")?;
    range("viscosity", s.viscosity, 0.0, 1.0, "0 (void) to 1 (very tough)")?;
    range("medium_density", s.medium_density, 0.0, 1e30, "0 to 1e30 kg/m3")
}
