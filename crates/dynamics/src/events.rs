//! The log of contacts: what closed, what let go, with what impulse, and which parts move together afterwards.

use crate::linear::Small;
use crate::settle::{Closed, Settled};
use crate::world::World;
use mainspring_mechanism::{Candidate, ContactId, Indices};
use std::sync::Arc;

/// What happened at a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EventKind {
    /// An impulse passed through the contact.
    Impact,
    /// A contact that was open stays closed from now on.
    Close,
    /// A contact that was closed is open from now on.
    Release,
}

/// Groups of bodies, shared by the entries of one instant.
pub type Tied = Arc<[Indices]>;

/// One entry of the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    pub t: f64,
    pub kind: EventKind,
    pub contact: ContactId,
    /// Indices of the two bodies.
    pub bodies: (usize, usize),
    /// Impulse along the normal (0 for a close or release).
    pub impulse: f64,
    /// Groups of two or more bodies tied by closed contacts after this instant, the fixed ones with the frame
    /// (Gelsey 1995, Fig. 8). Sorted.
    pub moving_together: Tied,
}

/// The entries of one instant, in the order impacts, releases, closes.
pub fn entries(world: &World, t: f64, before: &[Closed], settled: &Settled) -> Vec<Event> {
    let has = |list: &[Closed], id: ContactId| list.iter().any(|c| c.candidate.id == id);
    let mut released = before.iter().filter(|c| !has(&settled.closed, c.candidate.id)).peekable();
    let mut closed = settled.closed.iter().filter(|c| !has(before, c.candidate.id)).peekable();
    if settled.impulses.is_empty() && released.peek().is_none() && closed.peek().is_none() {
        return vec![];
    }
    let together = moving_together(world, &settled.closed);
    let entry = |kind, candidate: &Candidate, impulse| Event {
        t,
        kind,
        contact: candidate.id,
        bodies: world.bodies(candidate),
        impulse,
        moving_together: together.clone(),
    };
    let impacts = settled.impulses.iter().map(|i| entry(EventKind::Impact, &i.candidate, i.impulse));
    impacts
        .chain(released.map(|c| entry(EventKind::Release, &c.candidate, 0.0)))
        .chain(closed.map(|c| entry(EventKind::Close, &c.candidate, 0.0)))
        .collect()
}

/// Bodies tied by closed contacts, in groups of two or more.
pub fn moving_together(world: &World, closed: &[Closed]) -> Tied {
    let mut group: Small<usize, 16> = (0..world.system.bodies.len()).collect();
    for contact in closed {
        let (a, b) = world.bodies(&contact.candidate);
        let (from, to) = (group[a].max(group[b]), group[a].min(group[b]));
        group.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
    }
    let members = |g: usize| (g..group.len()).filter(|&body| group[body] == g).collect::<Indices>();
    let tied = |g: &usize| group[*g] == *g && group[g + 1..].contains(g);
    (0..group.len()).filter(tied).map(members).collect()
}
