//! The closed contacts of a component as equations `G q̈ + γ = 0`, over the coordinates that they and its masses involve.

use crate::inertia::Inertia;
use crate::linear::{Small, factorize, solve_factorized};
use crate::world::World;
use mainspring_mechanism::{Candidate, Constraint, MAX_CHAIN, Moving};

/// What each contact is made of, looked up once.
#[derive(Clone, Debug, Default)]
pub struct Constraints {
    /// Coordinates involved: columns of G.
    coordinates: Small<usize, 8>,
    /// 1/I by column; 0 where the coordinate is held or a block holds its inertia.
    mobility: Small<f64, 8>,
    bodies: Vec<Member>,
    contacts: Vec<Contact>,
}

/// A body that the contacts involve, with the columns of its joints.
#[derive(Clone, Copy, Debug)]
struct Member {
    body: usize,
    columns: [usize; MAX_CHAIN],
}

#[derive(Clone, Copy, Debug)]
enum Contact {
    /// Between two of the bodies (their places in the list).
    Touch { constraint: Constraint, sides: (usize, usize) },
    /// A stop with its coordinate's column and ∂g/∂q.
    Stop { stop: usize, column: usize, slope: f64 },
}

/// The equations at one state.
#[derive(Clone, Debug)]
pub struct AtState {
    pub bodies: Small<Moving>,
    pub contacts: Small<Line>,
    /// G, a row a contact.
    rows: Small<f64, 16>,
    /// G M⁻¹.
    weighted: Small<f64, 16>,
    /// The lower triangle of the factor of G M⁻¹ Gᵀ.
    factor: Small<f64, 16>,
    /// Forces of the contacts.
    pub lambda: Small<f64>,
}

/// A contact at one state.
#[derive(Clone, Copy, Debug, Default)]
pub struct Line {
    pub gap: f64,
    /// ġ.
    pub rate: f64,
    /// γ.
    bias: f64,
}

impl Constraints {
    /// Of `contacts`, with the `tied` coordinates of the component's blocks of masses.
    pub fn new(world: &World, contacts: &[Candidate], tied: impl Iterator<Item = usize>) -> Self {
        let mut new = Self::default();
        tied.for_each(|i| _ = new.column(i));
        for contact in contacts {
            let member = match contact.id.stop() {
                Some(stop) => {
                    let limit = &world.system.forces.stops[stop];
                    Contact::Stop { stop, column: new.column(limit.coordinate), slope: limit.slope() }
                }
                None => {
                    let (a, b) = world.bodies(contact);
                    let bodies = (&world.system.bodies[a], &world.system.bodies[b]);
                    let constraint = Constraint::new(contact.kind, world.features(contact), bodies);
                    Contact::Touch { constraint, sides: (new.member(world, a), new.member(world, b)) }
                }
            };
            new.contacts.push(member);
        }
        new.mobility = new.coordinates.iter().map(|&i| world.free.mobility(i)).collect();
        new
    }

    /// The column of a coordinate, a new one if it has none.
    fn column(&mut self, i: usize) -> usize {
        self.column_of(i).unwrap_or_else(|| {
            self.coordinates.push(i);
            self.coordinates.len() - 1
        })
    }

    fn column_of(&self, i: usize) -> Option<usize> {
        self.coordinates.iter().position(|&c| c == i)
    }

    fn member(&mut self, world: &World, body: usize) -> usize {
        if let Some(k) = self.bodies.iter().position(|m| m.body == body) {
            return k;
        }
        let mut columns = [0; MAX_CHAIN];
        for (column, joint) in columns.iter_mut().zip(&world.system.bodies[body].chain) {
            *column = self.column(joint.coordinate);
        }
        self.bodies.push(Member { body, columns });
        self.bodies.len() - 1
    }

    /// Room for the equations at a state.
    pub fn state(&self) -> AtState {
        let (n, k) = (self.coordinates.len(), self.contacts.len());
        AtState {
            bodies: smallvec::smallvec![Moving::default(); self.bodies.len()],
            contacts: smallvec::smallvec![Line::default(); k],
            rows: smallvec::smallvec![0.0; k * n],
            weighted: smallvec::smallvec![0.0; k * n],
            factor: smallvec::smallvec![0.0; k * k],
            lambda: smallvec::smallvec![0.0; k],
        }
    }

    /// The places of a contact's bodies in `AtState::bodies`; None for a stop.
    pub fn sides(&self, contact: usize) -> Option<(usize, usize)> {
        match self.contacts[contact] {
            Contact::Touch { sides, .. } => Some(sides),
            Contact::Stop { .. } => None,
        }
    }

    /// Gaps, rates, rows and bias of every contact at `(q, v)`.
    pub fn evaluate(&self, world: &mut World, (q, v): (&[f64], &[f64]), at: &mut AtState) {
        world.evaluations += self.contacts.len() as u64;
        let chain = |member: &Member| world.system.bodies[member.body].chain.as_slice();
        let (bodies, rows) = (at.bodies.as_mut_slice(), at.rows.as_mut_slice());
        for (member, moving) in self.bodies.iter().zip(bodies.iter_mut()) {
            moving.go_to(chain(member), q, v);
        }
        rows.fill(0.0);
        let rows = rows.chunks_exact_mut(self.coordinates.len().max(1));
        for ((contact, row), line) in self.contacts.iter().zip(rows).zip(at.contacts.as_mut_slice()) {
            *line = match *contact {
                Contact::Stop { stop, column, slope } => {
                    let stop = &world.system.forces.stops[stop];
                    row[column] = slope;
                    Line { gap: stop.gap(q[stop.coordinate]), rate: slope * v[stop.coordinate], bias: 0.0 }
                }
                Contact::Touch { ref constraint, sides: (a, b) } => {
                    let members = (&self.bodies[a], &self.bodies[b]);
                    let chains = (chain(members.0), chain(members.1));
                    let sides = (&bodies[a], &bodies[b]);
                    let first = constraint.shared;
                    let c = if first == 0 {
                        constraint.at(sides.0, sides.1)
                    } else {
                        let carried = |side: &Moving, chain| side.carried_by(chain, first, v);
                        constraint.at(&carried(sides.0, chains.0), &carried(sides.1, chains.1))
                    };
                    let (normal, columns) = (c.normal, (&members.0.columns, &members.1.columns));
                    sides.0.slopes(chains.0, first, normal, c.points.0, |k, x| row[columns.0[k]] += x);
                    sides.1.slopes(chains.1, first, normal, c.points.1, |k, x| row[columns.1[k]] -= x);
                    Line { gap: c.gap, rate: c.rate, bias: c.bias }
                }
            };
        }
    }

    /// Makes ready to solve for forces, with the inertia at hand. False if the contacts are not independent here.
    pub fn weigh(&self, inertia: &Inertia, at: &mut AtState) -> bool {
        let (n, k) = (self.coordinates.len().max(1), self.contacts.len());
        let (rows, weighted) = (at.rows.as_slice(), at.weighted.as_mut_slice());
        for (row, weighted) in rows.chunks_exact(n).zip(weighted.chunks_exact_mut(n)) {
            for ((x, g), mobility) in weighted.iter_mut().zip(row).zip(&self.mobility) {
                *x = g * mobility;
            }
            if inertia.has_blocks() {
                let entry = |i| self.column_of(i).map_or(0.0, |c| row[c]);
                inertia.respond(entry, |i, x| {
                    if let Some(c) = self.column_of(i) {
                        weighted[c] += x;
                    }
                });
            }
        }
        let factor = at.factor.as_mut_slice();
        for (i, weighted) in weighted.chunks_exact(n).enumerate() {
            for (x, row) in factor[i * k..=i * k + i].iter_mut().zip(rows.chunks_exact(n)) {
                *x = dot(weighted, row);
            }
        }
        factorize(factor, k)
    }

    /// Forces of the contacts, and their part in `acceleration`, which holds what is without them.
    pub fn press(&self, at: &mut AtState, acceleration: &mut [f64]) {
        let rows = at.rows.chunks_exact(self.coordinates.len().max(1));
        for ((l, row), line) in at.lambda.iter_mut().zip(rows).zip(&at.contacts) {
            let moved: f64 = row.iter().zip(&self.coordinates).map(|(g, &i)| g * acceleration[i]).sum();
            *l = -(moved + line.bias);
        }
        solve_factorized(&at.factor, &mut at.lambda);
        self.add(&at.weighted, &at.lambda, acceleration);
    }

    /// Moves `x` by the least change `M⁻¹ Gᵀ λ` that takes away what `excess` says of each contact.
    pub fn take_away(&self, at: &mut AtState, excess: impl Fn(&Line) -> f64, x: &mut [f64]) {
        for (l, line) in at.lambda.iter_mut().zip(&at.contacts) {
            *l = -excess(line);
        }
        solve_factorized(&at.factor, &mut at.lambda);
        self.add(&at.weighted, &at.lambda, x);
    }

    /// `x += M⁻¹ Gᵀ λ`.
    fn add(&self, weighted: &[f64], lambda: &[f64], x: &mut [f64]) {
        let coordinates = self.coordinates.as_slice();
        for (row, l) in weighted.chunks_exact(coordinates.len().max(1)).zip(lambda) {
            for (&i, w) in coordinates.iter().zip(row) {
                x[i] += w * l;
            }
        }
    }

    /// `(Gᵀ λ)_i` with the forces last found.
    pub fn pressed(&self, at: &AtState, i: usize) -> f64 {
        let Some(column) = self.column_of(i) else { return 0.0 };
        at.rows.chunks_exact(self.coordinates.len()).zip(&at.lambda).map(|(row, l)| row[column] * l).sum()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
