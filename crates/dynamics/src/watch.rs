//! Changes of contacts that are closed: a force that comes to zero, a contact point that runs off its feature.

use crate::component::Component;
use crate::linear::Small;
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
    let mut probe =
        Probe { component, stretch, q: vec![0.0; n], v: vec![0.0; n], acceleration: vec![0.0; n] };
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
    q: Vec<f64>,
    v: Vec<f64>,
    acceleration: Vec<f64>,
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
        let placed = self.component.place(world, &self.q);
        let touches = self.component.touches(world, &placed);
        let forces = self.component.forces_of(world, &touches, &self.q, &self.v, &mut self.acceleration);
        let forces = forces.unwrap_or_else(|| touches.iter().map(|_| 0.0).collect());
        let margin = |t: &Touch| t.margin(size) + PAST_END * size;
        forces.into_iter().zip(&touches).flat_map(|(force, t)| [force, margin(t)]).collect()
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

    /// The time after `good` at which measure `i` turns negative, given a later time at which it is: regula falsi of
    /// Illinois, to the grain of the clock.
    fn zero(&mut self, world: &mut World, i: usize, good: f64, bad: (f64, f64)) -> f64 {
        let (mut a, mut fa) = (good, self.measure(world, i, good));
        let (mut b, mut fb) = bad;
        if fa <= 0.0 {
            return a;
        }
        let mut last_negative = None;
        for k in 0..100 {
            if b - a <= 4.0 * f64::EPSILON * (1.0 + b.abs()) {
                break;
            }
            let secant = b - fb * (b - a) / (fb - fa);
            let t = if k % 8 == 7 { 0.5 * (a + b) } else { secant }.clamp(a, b);
            let f = self.measure(world, i, t);
            if f < 0.0 {
                (b, fb) = (t, f);
                fa *= if last_negative == Some(true) { 0.5 } else { 1.0 };
            } else {
                (a, fa) = (t, f);
                fb *= if last_negative == Some(false) { 0.5 } else { 1.0 };
            }
            if f == 0.0 || (k > 0 && f.abs() <= 1e-15 * world.system.size && i % 2 == 1) {
                return t;
            }
            last_negative = Some(f < 0.0);
        }
        b
    }
}
