//! Changes of contacts that are closed: a force that comes to zero, a contact point that runs off its feature.

use crate::component::Component;
use crate::search::Stretch;
use crate::world::World;
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

/// Samples of a stretch in which a change is looked for.
const SAMPLES: u32 = 4;

/// The first change of a component's contacts over the stretch.
pub fn first_change(world: &mut World, component: &Component, stretch: &Stretch) -> Option<(f64, Change)> {
    let n = stretch.paths.len();
    let mut probe =
        Probe { component, stretch, q: vec![0.0; n], v: vec![0.0; n], acceleration: vec![0.0; n] };
    let mut before = stretch.from;
    for k in 1..=SAMPLES {
        let t = stretch.from + (stretch.to - stretch.from) * f64::from(k) / f64::from(SAMPLES);
        let measures = probe.measure(world, t);
        let failing: Vec<usize> = (0..measures.len()).filter(|&i| measures[i] < 0.0).collect();
        if !failing.is_empty() {
            let found = failing.iter().map(|&i| (probe.zero(world, i, before, t), i));
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
    /// Force and margin of every contact in turn: a contact stays while both are positive.
    fn measure(&mut self, world: &mut World, t: f64) -> Vec<f64> {
        self.stretch.state(t, &mut self.q, &mut self.v);
        let size = world.system.size;
        let margins: Vec<f64> =
            self.component.touches(world, &self.q).iter().map(|touch| touch.margin(size)).collect();
        let forces = self.component.forces(world, &self.q, &self.v, &mut self.acceleration);
        let forces = forces.unwrap_or_else(|| vec![0.0; margins.len()]);
        forces.into_iter().zip(margins).flat_map(|(force, margin)| [force, margin]).collect()
    }

    /// The time between `good` and `bad` at which measure `i` turns negative.
    fn zero(&mut self, world: &mut World, i: usize, good: f64, bad: f64) -> f64 {
        let (mut a, mut b) = (good, bad);
        let (mut fa, mut fb) = (self.measure(world, a)[i], self.measure(world, b)[i]);
        if fa <= 0.0 {
            return a;
        }
        for k in 0..100 {
            if b - a <= 4.0 * f64::EPSILON * (1.0 + b.abs()) {
                break;
            }
            // Regula falsi of Illinois, with a bisection now and then.
            let t = if k % 4 == 3 { 0.5 * (a + b) } else { b - fb * (b - a) / (fb - fa) };
            let t = t.clamp(a, b);
            let f = self.measure(world, t)[i];
            if f < 0.0 {
                (b, fb) = (t, f);
                fa *= 0.5;
            } else {
                (a, fa) = (t, f);
                fb *= 0.5;
            }
            if f == 0.0 {
                break;
            }
        }
        b
    }
}
