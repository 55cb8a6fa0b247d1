//! Changes of contacts that are closed: a force that comes to zero, a contact point that runs off its feature.

use crate::component::Component;
use crate::linear::Small;
use crate::root::narrow;
use crate::search::Stretch;
use crate::world::{Touch, World};
use mainspring_mechanism::ContactId;

/// Why a stretch ends before its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// A contact closes.
    Closing(ContactId),
    /// The force of a contact comes to zero.
    Unloaded(ContactId),
    /// A contact point comes to the end of its feature.
    RanOff(ContactId),
}

impl Change {
    /// The contact that lets go, if it is a change of that kind.
    pub fn leaving(self) -> Option<ContactId> {
        match self {
            Change::Closing(_) => None,
            Change::Unloaded(id) | Change::RanOff(id) => Some(id),
        }
    }
}

/// A contact point has run off once it is this far past the end of its feature, relative to the machine's size: more
/// than rounding, so that a corner that turns flush lets go only after the next one has closed.
const PAST_END: f64 = 1e-11;
/// Samples of a stretch in which a change is looked for.
const SAMPLES: u32 = 3;

/// The first change of a component's contacts over the stretch.
pub fn first_change(world: &mut World, component: &Component, stretch: &Stretch) -> Option<(f64, Change)> {
    let n = stretch.paths.len();
    let zero = || -> Small<f64, 8> { smallvec::smallvec![0.0; n] };
    let mut probe = Probe { component, stretch, q: zero(), v: zero(), acceleration: zero() };
    let mut before = stretch.from;
    for k in 1..=SAMPLES {
        let t = stretch.from + (stretch.to - stretch.from) * f64::from(k) / f64::from(SAMPLES);
        let measures = probe.measure_all(world, t);
        let failing: Small<usize> = (0..measures.len()).filter(|&i| measures[i] < 0.0).collect();
        if !failing.is_empty() {
            let found = failing.iter().map(|&i| (probe.zero(world, i, before, (t, measures[i])), i));
            let (t, i) = found.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
            let id = component.contacts[i / 2].id;
            return Some((t, if i % 2 == 0 { Change::Unloaded(id) } else { Change::RanOff(id) }));
        }
        before = t;
    }
    None
}

struct Probe<'c, 's, 'p> {
    component: &'c Component,
    stretch: &'s Stretch<'p>,
    q: Small<f64, 8>,
    v: Small<f64, 8>,
    acceleration: Small<f64, 8>,
}

impl Probe<'_, '_, '_> {
    fn move_to(&mut self, t: f64) {
        for &i in &self.component.coordinates {
            let state = self.stretch.paths[i].at(t);
            (self.q[i], self.v[i]) = (state.q, state.v);
        }
    }

    /// Force and margin of every contact in turn: a contact stays while both are positive.
    fn measure_all(&mut self, world: &mut World, t: f64) -> Small<f64, 8> {
        self.move_to(t);
        let size = world.system.size;
        let mut measures: Small<f64, 8> = Small::new();
        let margin = |touch: &Touch| measures.extend([0.0, touch.margin(size) + PAST_END * size]);
        let state = (self.q.as_slice(), self.v.as_slice());
        let forces = self.component.forces(world, state, &mut self.acceleration, margin);
        for (measure, force) in measures.iter_mut().step_by(2).zip(forces.iter().flatten()) {
            *measure = *force;
        }
        measures
    }

    /// One of them; a margin needs its own contact only.
    fn measure(&mut self, world: &mut World, i: usize, t: f64) -> f64 {
        if i.is_multiple_of(2) {
            return self.measure_all(world, t)[i];
        }
        self.move_to(t);
        let size = world.system.size;
        let contact = &self.component.contacts[i / 2];
        let (a, b) = world.place(contact, &self.q);
        world.touch(contact, (&a, &b)).margin(size) + PAST_END * size
    }

    /// The time after `good` at which measure `i` turns negative, given a later time at which it is.
    fn zero(&mut self, world: &mut World, i: usize, good: f64, bad: (f64, f64)) -> f64 {
        let start = (good, self.measure(world, i, good));
        if start.1 <= 0.0 {
            return good;
        }
        narrow(|t| self.measure(world, i, t), start, bad).1.0
    }
}
