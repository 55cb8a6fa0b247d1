//! A component's contacts in the usual case: one or two, between bodies on one joint each, whose coordinates have an inertia
//! of their own. The equations of `constraints`, written out.

use crate::component::PROJECTIONS;
use crate::linear::Small;
use crate::world::World;
use mainspring_mechanism::{Candidate, Constraint, Hinge, HingeConstraint, Hinged, Hung};

/// Contacts at most.
const MOST: usize = 2;
/// A pivot below this part of its diagonal entry is none, as in `linear::factorize`.
const DEPENDENT: f64 = 1e-12;

/// What each contact is made of, looked up once.
#[derive(Clone, Debug)]
pub struct Few {
    hinges: Small<Hinge>,
    contacts: Small<Pair, MOST>,
    /// For either coordinate of the first and of the second contact: 1/I if they are the same, else 0.
    common: [[f64; 2]; 2],
}

/// A contact with the places of its bodies in the list, and 1/I of the coordinates that move them.
#[derive(Clone, Copy, Debug)]
struct Pair {
    constraint: HingeConstraint,
    sides: [usize; 2],
    coordinates: [usize; 2],
    mobility: [f64; 2],
}

/// The contacts at one state, and the factor L D Lᵀ of G M⁻¹ Gᵀ.
#[derive(Clone, Copy, Debug, Default)]
pub struct FewAt {
    pub lines: [Hinged; MOST],
    pivots: [f64; MOST],
    below: f64,
}

impl Few {
    /// None in any other case.
    pub fn new(world: &World, contacts: &[Candidate]) -> Option<Self> {
        if contacts.is_empty() || contacts.len() > MOST {
            return None;
        }
        let mut few = Self { hinges: Small::new(), contacts: Small::new(), common: [[0.0; 2]; 2] };
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
        let tied =
            |h: &Hinge| h.moves() && !world.free.is_alone(h.coordinate) && !world.free.is_held(h.coordinate);
        let both = hinges.iter().all(Hinge::moves) && hinges[0].coordinate == hinges[1].coordinate;
        if both || hinges.iter().any(tied) {
            return None;
        }
        let constraint = Constraint::new(contact.kind, world.features(contact), (bodies[0], bodies[1]));
        let constraint = HingeConstraint::new(&constraint, (&hinges[0], &hinges[1]));
        let mobility = |h: &Hinge| if h.moves() { world.free.mobility(h.coordinate) } else { 0.0 };
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

    /// Every contact at `(q, v)`, ready to solve for forces. None if they are not independent here.
    pub fn at(&self, world: &mut World, (q, v): (&[f64], &[f64])) -> Option<FewAt> {
        world.evaluations += self.contacts.len() as u64;
        let mut hung = [Hung::default(); 2 * MOST];
        for (hung, hinge) in hung.iter_mut().zip(&self.hinges) {
            *hung = hinge.at(q[hinge.coordinate], v[hinge.coordinate]);
        }
        let mut at = FewAt::default();
        let mut diagonal = [0.0; MOST];
        for (k, pair) in self.contacts.iter().enumerate() {
            let line = pair.constraint.at(&hung[pair.sides[0]], &hung[pair.sides[1]]);
            let [g, h] = line.slopes;
            diagonal[k] = g * g * pair.mobility[0] + h * h * pair.mobility[1];
            at.lines[k] = line;
        }
        at.pivots = diagonal;
        if self.contacts.len() == MOST {
            let ([g, h], [x, y]) = (at.lines[0].slopes, at.lines[1].slopes);
            let [[gx, gy], [hx, hy]] = self.common;
            let product = g * (gx * x + gy * y) + h * (hx * x + hy * y);
            at.below = product / diagonal[0];
            at.pivots[1] -= at.below * product;
        }
        let firm = |k: usize| at.pivots[k] > DEPENDENT * diagonal[k] && at.pivots[k].is_finite();
        (0..self.contacts.len()).all(firm).then_some(at)
    }

    /// Adds to `acceleration`, which holds what is without contacts, their part.
    pub fn press(&self, at: &FewAt, acceleration: &mut [f64]) {
        let mut excess = [0.0; MOST];
        for (k, pair) in self.contacts.iter().enumerate() {
            let ([g, h], [i, j]) = (at.lines[k].slopes, pair.coordinates);
            excess[k] = g * acceleration[i] + h * acceleration[j] + at.lines[k].bias;
        }
        self.take_away(at, excess, acceleration);
    }

    /// Moves `x` by the least change `M⁻¹ Gᵀ λ` that takes away each contact's excess.
    pub fn take_away(&self, at: &FewAt, excess: [f64; MOST], x: &mut [f64]) {
        let mut lambda = [-excess[0] / at.pivots[0], 0.0];
        if self.contacts.len() == MOST {
            lambda[1] = (at.below * excess[0] - excess[1]) / at.pivots[1];
            lambda[0] -= at.below * lambda[1];
        }
        for (k, pair) in self.contacts.iter().enumerate() {
            for side in 0..2 {
                x[pair.coordinates[side]] += pair.mobility[side] * at.lines[k].slopes[side] * lambda[k];
            }
        }
    }

    /// Moves `q` onto g = 0, to `exact`, and `v` onto G q̇ = 0.
    pub fn project(&self, world: &mut World, exact: f64, q: &mut [f64], v: &mut [f64]) {
        for _ in 0..PROJECTIONS {
            let Some(at) = self.at(world, (q, v)) else { return };
            self.take_away(&at, at.lines.map(|line| line.rate), v);
            if at.lines.iter().all(|line| line.gap.abs() <= exact) {
                return;
            }
            self.take_away(&at, at.lines.map(|line| line.gap), q);
        }
    }
}
