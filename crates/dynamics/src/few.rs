//! A component's contacts in the usual case: one or two, between bodies on one joint each, whose coordinates have an inertia
//! of their own. The equations of `constraints`, written out.

use crate::component::PROJECTIONS;
use crate::linear::Small;
use crate::world::World;
use mainspring_mechanism::{Candidate, Constraint, Hinge, HingeConstraint, Hinged, Hung, Pose};

/// Contacts at most.
pub const MOST: usize = 2;
/// A pivot below this part of its diagonal entry is none, as in `linear::factorize`.
const DEPENDENT: f64 = 1e-12;

/// What each contact is made of, looked up once.
#[derive(Clone, Debug)]
pub struct Few {
    coordinates: Small<Alone>,
    hinges: Small<Hinge>,
    contacts: Small<Pair, MOST>,
    /// For either coordinate of the first and of the second contact: 1/I if they are the same, else 0.
    common: [[f64; 2]; 2],
}

/// A coordinate without contacts: `q̈ = drive − stiffness q − damping q̇`, all by its inertia.
#[derive(Clone, Copy, Debug)]
struct Alone {
    coordinate: usize,
    drive: f64,
    stiffness: f64,
    damping: f64,
}

/// A contact with the places of its bodies in the list, and 1/I of the coordinates that move them.
#[derive(Clone, Copy, Debug)]
struct Pair {
    constraint: HingeConstraint,
    sides: [usize; 2],
    coordinates: [usize; 2],
    mobility: [f64; 2],
}

/// The bodies and contacts at one state, and the factor L D Lᵀ of G M⁻¹ Gᵀ.
#[derive(Clone, Copy, Debug, Default)]
pub struct FewAt {
    hung: [Hung; 2 * MOST],
    lines: [Hinged; MOST],
    pivots: [f64; MOST],
    below: f64,
}

impl Few {
    /// For contacts that tie these coordinates, none of them to others by masses. None in any other case.
    pub fn new(world: &World, coordinates: &[usize], contacts: &[Candidate]) -> Option<Self> {
        if contacts.is_empty() || contacts.len() > MOST {
            return None;
        }
        let coordinates = coordinates.iter().map(|&i| Alone::new(world, i)).collect();
        let (hinges, contacts_of) = (Small::new(), Small::new());
        let mut few = Self { coordinates, hinges, contacts: contacts_of, common: [[0.0; 2]; 2] };
        let mut known: Small<usize> = Small::new();
        for contact in contacts {
            let pair = few.pair(world, contact, &mut known)?;
            few.contacts.push(pair);
        }
        if let [a, b] = few.contacts.as_slice() {
            let same = |i: usize, j: usize| a.coordinates[i] == b.coordinates[j];
            let common = |i, j| if same(i, j) { a.mobility[i].min(b.mobility[j]) } else { 0.0 };
            few.common = [[common(0, 0), common(0, 1)], [common(1, 0), common(1, 1)]];
        }
        Some(few)
    }

    fn pair(&mut self, world: &World, contact: &Candidate, known: &mut Small<usize>) -> Option<Pair> {
        if contact.id.stop().is_some() {
            return None;
        }
        let ids = world.bodies(contact);
        let bodies = [ids.0, ids.1].map(|k| &world.system.bodies[k]);
        let hinges = [Hinge::of(bodies[0])?, Hinge::of(bodies[1])?];
        let free = &world.free;
        let tied = |h: &Hinge| h.moves() && !free.is_alone(h.coordinate) && !free.is_held(h.coordinate);
        let both = hinges.iter().all(Hinge::moves) && hinges[0].coordinate == hinges[1].coordinate;
        if both || hinges.iter().any(tied) {
            return None;
        }
        let constraint = Constraint::new(contact.kind, world.features(contact), (bodies[0], bodies[1]));
        let constraint = HingeConstraint::new(&constraint, (&hinges[0], &hinges[1]));
        let mobility = |h: &Hinge| if h.moves() { free.mobility(h.coordinate) } else { 0.0 };
        let mobility = [mobility(&hinges[0]), mobility(&hinges[1])];
        let coordinates = [hinges[0].coordinate, hinges[1].coordinate];
        let sides = [(ids.0, hinges[0]), (ids.1, hinges[1])].map(|(body, hinge)| {
            known.iter().position(|k| *k == body).unwrap_or_else(|| {
                known.push(body);
                self.hinges.push(hinge);
                known.len() - 1
            })
        });
        Some(Pair { constraint, sides, coordinates, mobility })
    }

    /// Goes to the state `(q, v)`. False if the contacts are not independent there.
    pub fn go_to(&self, world: &mut World, (q, v): (&[f64], &[f64]), at: &mut FewAt) -> bool {
        for (hung, hinge) in at.hung.iter_mut().zip(self.hinges.as_slice()) {
            *hung = hinge.at(q[hinge.coordinate], v[hinge.coordinate]);
        }
        let pairs = self.contacts.as_slice();
        world.evaluations += pairs.len() as u64;
        let mut diagonal = [0.0; MOST];
        for ((pair, line), entry) in pairs.iter().zip(&mut at.lines).zip(&mut diagonal) {
            *line = pair.constraint.at(&at.hung[pair.sides[0]], &at.hung[pair.sides[1]]);
            let [g, h] = line.slopes;
            *entry = g * g * pair.mobility[0] + h * h * pair.mobility[1];
        }
        at.pivots = diagonal;
        if pairs.len() == MOST {
            let ([g, h], [x, y]) = (at.lines[0].slopes, at.lines[1].slopes);
            let [[gx, gy], [hx, hy]] = self.common;
            let product = g * (gx * x + gy * y) + h * (hx * x + hy * y);
            at.below = product / diagonal[0];
            at.pivots[1] -= at.below * product;
        }
        let firm = |(pivot, entry): (&f64, &f64)| *pivot > DEPENDENT * entry && pivot.is_finite();
        at.pivots.iter().zip(&diagonal).take(pairs.len()).all(firm)
    }

    /// Accelerations of the coordinates, and the forces of the contacts, where `at` is. Those of driven coordinates are
    /// given.
    pub fn accelerate(&self, (q, v): (&[f64], &[f64]), at: &FewAt, acceleration: &mut [f64]) -> [f64; MOST] {
        for alone in self.coordinates.as_slice() {
            let i = alone.coordinate;
            acceleration[i] = alone.drive - alone.stiffness * q[i] - alone.damping * v[i];
        }
        let mut excess = [0.0; MOST];
        for ((pair, line), excess) in self.contacts.as_slice().iter().zip(&at.lines).zip(&mut excess) {
            let ([g, h], [i, j]) = (line.slopes, pair.coordinates);
            *excess = g * acceleration[i] + h * acceleration[j] + line.bias;
        }
        self.take_away(at, excess, acceleration)
    }

    /// Moves `x` by the least change `M⁻¹ Gᵀ λ` that takes away each contact's excess; returns λ.
    fn take_away(&self, at: &FewAt, excess: [f64; MOST], x: &mut [f64]) -> [f64; MOST] {
        let pairs = self.contacts.as_slice();
        let mut lambda = [-excess[0] / at.pivots[0], 0.0];
        if pairs.len() == MOST {
            lambda[1] = (at.below * excess[0] - excess[1]) / at.pivots[1];
            lambda[0] -= at.below * lambda[1];
        }
        for ((pair, line), lambda) in pairs.iter().zip(&at.lines).zip(lambda) {
            for side in 0..2 {
                x[pair.coordinates[side]] += pair.mobility[side] * line.slopes[side] * lambda;
            }
        }
        lambda
    }

    /// Every contact's gap where `at` is.
    pub fn gaps(&self, at: &FewAt) -> Small<f64> {
        at.lines[..self.contacts.len()].iter().map(|line| line.gap).collect()
    }

    /// The poses of the bodies of the k-th contact.
    pub fn poses(&self, k: usize, at: &FewAt) -> [Pose; 2] {
        self.contacts[k].sides.map(|side| self.hinges[side].pose(&at.hung[side]))
    }

    /// Moves `q` onto g = 0, to `exact`, and `v` onto G q̇ = 0.
    pub fn project(&self, world: &mut World, exact: f64, q: &mut [f64], v: &mut [f64]) {
        let mut at = FewAt::default();
        for _ in 0..PROJECTIONS {
            if !self.go_to(world, (q, v), &mut at) {
                return;
            }
            self.take_away(&at, at.lines.map(|line| line.rate), v);
            if at.lines.iter().all(|line| line.gap.abs() <= exact) {
                return;
            }
            self.take_away(&at, at.lines.map(|line| line.gap), q);
        }
    }
}

impl Alone {
    fn new(world: &World, coordinate: usize) -> Self {
        let c = &world.system.coordinates[coordinate];
        let force = c.force + world.dry_force(coordinate);
        Self {
            coordinate,
            drive: force / c.inertia,
            stiffness: c.stiffness / c.inertia,
            damping: c.damping / c.inertia,
        }
    }
}
