//! Snapshots: the state and the books as little-endian bytes. Layout: magic, version, length, fingerprint of the model, then
//! the clock, the bodies in order of creation, contact memory, let-back memory, ledger, counters; last a checksum of all
//! before it. The model is not in it: a snapshot is restored into a world made from the same scene.

use super::digest::{Digest, model_fingerprint};
use crate::contact::let_back::{Entry, LetBack};
use crate::contact::memory::ContactMemory;
use crate::counters::Counters;
use crate::error::{Error, Result};
use crate::ledger::{Energy, Ledger};
use crate::math::{Quat, Real, Vec3};
use crate::model::Model;
use crate::state::{Clock, Line, Spin, State};
use crate::world::Books;

const MAGIC: &[u8; 8] = b"mrtphys\0";
/// Grows with every change of the layout.
const VERSION: u64 = 2;

pub(crate) fn write(model: &Model, state: &State, books: &Books, order: &[u32]) -> Vec<u8> {
    let mut out = Writer { bytes: MAGIC.to_vec() };
    out.word(VERSION);
    out.wide(model_fingerprint(model, order));
    let c = &state.clock;
    out.word(c.steps);
    out.real(c.anchor);
    out.word(c.since_anchor);
    out.word(c.rate);
    out.word(order.len() as u64);
    for &slot in order {
        let (line, spin) = (&state.lines[slot as usize], &state.spins[slot as usize]);
        out.vector(line.x);
        out.vector(line.v);
        out.real(line.radius);
        [spin.q.x, spin.q.y, spin.q.z, spin.q.w].into_iter().for_each(|c| out.real(c));
        out.vector(spin.l);
    }
    out.word(state.contacts.keys().len() as u64);
    state.contacts.keys().iter().for_each(|&k| out.word(k));
    out.word(state.let_back.entries().count() as u64);
    for e in state.let_back.entries() {
        out.word((u64::from(e.boundary) << 32) | u64::from(e.serial));
        out.word((u64::from(e.side > 0) << 1) | u64::from(e.crossed));
    }
    write_books(&mut out, books);
    let mut digest = Digest::default();
    digest.bytes(&out.bytes);
    out.wide(digest.finish());
    out.bytes
}

fn write_books(out: &mut Writer, books: &Books) {
    books.ledger.entries().into_iter().for_each(|(_, value)| out.real(value));
    books.totals.to_array().into_iter().for_each(|count| out.word(count));
    out.word(u64::from(books.initial.is_some()));
    let initial = books.initial.unwrap_or_default();
    [initial.linear, initial.rotational, initial.potential].into_iter().for_each(|e| out.real(e));
    out.real(books.largest_step);
}

pub(crate) fn read(bytes: &[u8], model: &Model, present: &State, order: &[u32]) -> Result<(State, Books)> {
    let body = checked(bytes)?;
    let mut input = Reader { bytes: &body[MAGIC.len() + 8..] };
    if input.wide()? != model_fingerprint(model, order) {
        return Err(fault("it was taken of a world with other bodies, boundaries or fields"));
    }
    let clock = Clock { steps: input.word()?, anchor: input.real()?, since_anchor: input.word()?, rate: input.word()? };
    if clock.since_anchor > 0 && clock.rate == 0 || !clock.anchor.is_finite() {
        return Err(fault("the clock is not one"));
    }
    if input.word()? != order.len() as u64 {
        return Err(fault("another number of bodies"));
    }
    let mut state = State { clock, lines: present.lines.clone(), spins: present.spins.clone(), ..State::default() };
    for &slot in order {
        let (line, spin) = read_body(&mut input, present.lines[slot as usize].inverse_mass)?;
        state.lines[slot as usize] = line;
        state.spins[slot as usize] = spin;
    }
    let count = input.count(8)?;
    state.contacts = ContactMemory::from_keys((0..count).map(|_| input.word()).collect::<Result<_>>()?);
    let count = input.count(16)?;
    let entries: Vec<Entry> = (0..count).map(|_| read_entry(&mut input)).collect::<Result<_>>()?;
    state.let_back = LetBack::from_entries(entries).ok_or_else(|| fault("the let-back memory is not one"))?;
    let books = read_books(&mut input)?;
    if !input.bytes.is_empty() {
        return Err(fault("there is more in it than there should be"));
    }
    Ok((state, books))
}

/// The bytes without the checksum, which was right.
fn checked(bytes: &[u8]) -> Result<&[u8]> {
    if !bytes.starts_with(MAGIC) {
        return Err(fault("it is not a snapshot of mrtphys"));
    }
    if bytes.len() < MAGIC.len() + 8 + 16 {
        return Err(fault("it is cut short"));
    }
    let version = Reader { bytes: &bytes[MAGIC.len()..] }.word()?;
    if version != VERSION {
        return Err(fault(&format!("version {version}; this program reads version {VERSION}")));
    }
    let (body, sum) = bytes.split_at(bytes.len() - 16);
    let mut digest = Digest::default();
    digest.bytes(body);
    if (Reader { bytes: sum }).wide()? != digest.finish() {
        return Err(fault("the checksum is wrong: it is damaged or cut short"));
    }
    Ok(body)
}

fn read_body(input: &mut Reader<'_>, inverse_mass: Real) -> Result<(Line, Spin)> {
    let (x, v, radius) = (input.vector()?, input.vector()?, input.real()?);
    let q = Quat::new(input.real()?, input.real()?, input.real()?, input.real()?);
    let l = input.vector()?;
    if !(x.is_finite() && v.is_finite() && q.is_finite() && l.is_finite() && radius.is_finite()) {
        return Err(fault("a body is not finite"));
    }
    Ok((Line { x, radius, v, inverse_mass }, Spin { q, l }))
}

fn read_entry(input: &mut Reader<'_>) -> Result<Entry> {
    let (who, what) = (input.word()?, input.word()?);
    let side = if what & 2 == 0 { -1 } else { 1 };
    Ok(Entry { boundary: (who >> 32) as u32, serial: who as u32, side, crossed: what & 1 == 1 })
}

fn read_books(input: &mut Reader<'_>) -> Result<Books> {
    let mut e = [0.0; 9];
    for value in &mut e {
        *value = input.real()?;
    }
    let ledger = Ledger {
        friction: e[0],
        restitution: e[1],
        drag: e[2],
        work_of_fields: e[3],
        position_correction: e[4],
        integration: e[5],
        moving_bodies: e[6],
        user: e[7],
        created_removed: e[8],
    };
    let mut c = [0; 9];
    for count in &mut c {
        *count = input.word()?;
    }
    let totals = Counters::from_array(c);
    let known = input.word()? == 1;
    let initial = Energy { linear: input.real()?, rotational: input.real()?, potential: input.real()? };
    Ok(Books { ledger, totals, initial: known.then_some(initial), largest_step: input.real()? })
}

fn fault(reason: &str) -> Error {
    Error::Snapshot { reason: reason.into() }
}

struct Writer {
    bytes: Vec<u8>,
}

impl Writer {
    fn word(&mut self, w: u64) {
        self.bytes.extend_from_slice(&w.to_le_bytes());
    }
    fn wide(&mut self, w: u128) {
        self.bytes.extend_from_slice(&w.to_le_bytes());
    }
    fn real(&mut self, x: Real) {
        self.word(x.to_bits());
    }
    fn vector(&mut self, v: Vec3) {
        v.to_array().into_iter().for_each(|x| self.real(x));
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
}

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N]> {
        let (head, rest) = self.bytes.split_first_chunk::<N>().ok_or_else(|| fault("it is cut short"))?;
        self.bytes = rest;
        Ok(*head)
    }
    fn word(&mut self) -> Result<u64> {
        Ok(u64::from_le_bytes(self.take()?))
    }
    fn wide(&mut self) -> Result<u128> {
        Ok(u128::from_le_bytes(self.take()?))
    }
    fn real(&mut self) -> Result<Real> {
        Ok(Real::from_bits(self.word()?))
    }
    fn vector(&mut self) -> Result<Vec3> {
        Ok(Vec3::new(self.real()?, self.real()?, self.real()?))
    }
    /// A number of items of at least `size` bytes that must still follow: checked before anything is allocated.
    fn count(&mut self, size: usize) -> Result<usize> {
        let count = self.word()?;
        if count > (self.bytes.len() / size) as u64 {
            return Err(fault("a count is larger than what follows"));
        }
        Ok(count as usize)
    }
}
