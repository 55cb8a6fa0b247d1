//! Changes of what is closed or stuck: a force that comes to zero, a contact point that runs off its feature, a part that
//! dry friction no longer holds.

use crate::component::Component;
use crate::constraints::AtState;
use crate::few::FewAt;
use crate::halts::Halt;
use crate::linear::Small;
use crate::root::narrow;
use crate::search::Stretch;
use crate::world::World;
use mainspring_mechanism::{Candidate, ContactId, Pose, gap_state};

/// Why a stretch ends before its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// A contact closes.
    Closing(ContactId),
    /// The force of a contact comes to zero.
    Unloaded(ContactId),
    /// A contact point comes to the end of its feature.
    RanOff(ContactId),
    /// A velocity against dry friction comes to zero.
    Halts(usize),
    /// Dry friction no longer holds a coordinate, which goes in this direction.
    Gives(usize, f64),
}

impl Change {
    /// Of a stop or a velocity that has come to zero.
    pub fn of_halt(halt: Halt) -> Self {
        match halt {
            Halt::Stop(k) => Change::Closing(ContactId::of_stop(k)),
            Halt::Slide(i) => Change::Halts(i),
        }
    }

    /// The contact that lets go, if it is a change of that kind.
    pub fn leaving(self) -> Option<ContactId> {
        match self {
            Change::Unloaded(id) | Change::RanOff(id) => Some(id),
            _ => None,
        }
    }

    /// The coordinate that gives, with its direction.
    pub fn giving(self) -> Option<(usize, f64)> {
        match self {
            Change::Gives(i, direction) => Some((i, direction)),
            _ => None,
        }
    }
}

/// A contact point has run off once it is this far past the end of its feature, relative to the machine's size: more
/// than rounding, so that a corner that turns flush lets go only after the next one has closed.
const PAST_END: f64 = 1e-11;
/// Samples of a stretch in which a change is looked for.
const SAMPLES: u32 = 3;

/// The first change of a component's contacts and of what dry friction holds over the stretch.
pub fn first_change(world: &mut World, component: &Component, stretch: &Stretch) -> Option<(f64, Change)> {
    let n = stretch.paths.len();
    let zero = || -> Small<f64, 8> { smallvec::smallvec![0.0; n] };
    let mut probe = Probe {
        component,
        stretch,
        q: zero(),
        v: zero(),
        acceleration: zero(),
        at: component.constraints.state(),
    };
    let mut before = stretch.from;
    for k in 1..=SAMPLES {
        let t = stretch.from + (stretch.to - stretch.from) * f64::from(k) / f64::from(SAMPLES);
        let measures = probe.measure_all(world, t);
        let failing: Small<usize> = (0..measures.len()).filter(|&i| measures[i] < 0.0).collect();
        if !failing.is_empty() {
            let found = failing.iter().map(|&i| (probe.zero(world, i, before, (t, measures[i])), i));
            let (t, i) = found.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
            return Some((t, probe.change(world, i, t)));
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
    /// The contacts where last measured.
    at: AtState,
}

impl Probe<'_, '_, '_> {
    fn move_to(&mut self, world: &World, t: f64) {
        let (component, drives) = (self.component, world.drives.iter().map(|d| d.0));
        for i in component.coordinates.iter().chain(&component.stuck).copied().chain(drives) {
            let state = self.stretch.paths[i].at(t);
            (self.q[i], self.v[i]) = (state.q, state.v);
        }
    }

    /// Force and margin of every contact in turn, then how far dry friction is from its limit at every coordinate it
    /// holds: all stays while these are positive.
    fn measure_all(&mut self, world: &mut World, t: f64) -> Small<f64, 8> {
        self.move_to(world, t);
        if let Some(measures) = self.measure_few(world, t) {
            return measures;
        }
        let state = (self.q.as_slice(), self.v.as_slice());
        self.component.forces(world, t, state, &mut self.acceleration, &mut self.at);
        let mut measures: Small<f64, 8> = Small::new();
        for (k, contact) in self.component.contacts.iter().enumerate() {
            let force = self.at.lambda.get(k).copied().unwrap_or(0.0);
            measures
                .extend([force, self.margin_between(world, contact, self.component.constraints.sides(k))]);
        }
        for (k, back) in self.component.backs.iter().enumerate() {
            // What is held from both sides is held whichever of them carries the force.
            if let Some(back) = back {
                measures[2 * k] = 1.0;
                measures[2 * k + 1] = measures[2 * k + 1].min(self.margin(world, back));
            }
        }
        for k in 0..self.component.stuck.len() {
            measures.push(world.system.forces.coulomb[self.component.stuck[k]] - self.held(world, k).abs());
        }
        measures
    }

    /// The same of few contacts, where dry friction holds nothing.
    fn measure_few(&mut self, world: &mut World, t: f64) -> Option<Small<f64, 8>> {
        let component = self.component;
        let few = component.few.as_ref().filter(|_| component.stuck.is_empty())?;
        let state = (self.q.as_slice(), self.v.as_slice());
        let mut at = FewAt::default();
        let forces = component.few_forces(world, (few, &mut at), t, state, &mut self.acceleration)?;
        let mut measures: Small<f64, 8> = Small::new();
        for (k, contact) in component.contacts.iter().enumerate() {
            let [a, b] = few.poses(k, &at);
            let (force, margin) = (forces[k], margin_between(world, contact, (&a, &b)));
            match &component.backs[k] {
                // What is held from both sides is held whichever of them carries the force.
                Some(back) => measures.extend([1.0, margin.min(margin_between(world, back, (&a, &b)))]),
                None => measures.extend([force, margin]),
            }
        }
        Some(measures)
    }

    /// The force of dry friction on the k-th stuck coordinate, where last measured.
    fn held(&mut self, world: &mut World, k: usize) -> f64 {
        let state = (self.q.as_slice(), self.v.as_slice());
        self.component.holding(world, self.component.stuck[k], state, &self.acceleration, &self.at)
    }

    /// One of them; a margin needs its own contact only.
    fn measure(&mut self, world: &mut World, i: usize, t: f64) -> f64 {
        if i.is_multiple_of(2) || i >= 2 * self.component.contacts.len() {
            return self.measure_all(world, t)[i];
        }
        self.move_to(world, t);
        let own = self.margin(world, &self.component.contacts[i / 2]);
        self.component.backs[i / 2].map_or(own, |back| own.min(self.margin(world, &back)))
    }

    /// The same for one of the component's own contacts, whose bodies are placed where last measured.
    fn margin_between(&self, world: &World, contact: &Candidate, sides: Option<(usize, usize)>) -> f64 {
        let Some((a, b)) = sides else { return f64::INFINITY };
        margin_between(world, contact, (&self.at.bodies[a].pose, &self.at.bodies[b].pose))
    }

    /// How far a contact still is from running off its feature, where last moved to.
    fn margin(&self, world: &mut World, contact: &Candidate) -> f64 {
        let size = world.system.size;
        let (a, b) = world.place(contact, &self.q);
        world.touch_at(contact, &self.q, (&a, &b)).margin(size) + PAST_END * size
    }

    /// What it means that measure `i` has come to zero at time `t`.
    fn change(&mut self, world: &mut World, i: usize, t: f64) -> Change {
        if let Some(k) = i.checked_sub(2 * self.component.contacts.len()) {
            self.measure_all(world, t);
            return Change::Gives(self.component.stuck[k], -self.held(world, k).signum());
        }
        let contact = &self.component.contacts[i / 2];
        if i.is_multiple_of(2) {
            return Change::Unloaded(contact.id);
        }
        self.move_to(world, t);
        match self.component.backs[i / 2] {
            Some(back) if self.margin(world, &back) < self.margin(world, contact) => Change::RanOff(back.id),
            _ => Change::RanOff(contact.id),
        }
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

/// How far a contact is from running off its feature between bodies at these poses.
fn margin_between(world: &World, contact: &Candidate, (a, b): (&Pose, &Pose)) -> f64 {
    let (features, size) = (world.features(contact), world.system.size);
    let state = gap_state(contact.kind, features.0, features.1, a, b);
    state.edge_margin.min(state.cone_margin * size) + PAST_END * size
}
