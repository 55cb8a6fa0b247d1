//! The two bodies of an interaction followed along the paths of a stretch.

use crate::component::Component;
use crate::linear::Small;
use crate::search::Stretch;
use crate::world::{Pair, World};
use mainspring_mechanism::{Placed, Relative};

/// Both bodies at the time last looked at. Positions and velocities of coordinates that move neither stay zero.
pub struct Sight<'s, 'p, 'a> {
    interaction: usize,
    pub stretch: &'s Stretch<'p>,
    pub t: f64,
    pub q: Small<f64, 8>,
    pub v: Small<f64, 8>,
    dv: Small<f64, 8>,
    pub placed: Pair<'a>,
    /// Which of the two bodies move at all.
    moving: (bool, bool),
    /// Is the state that of `hold`?
    held: bool,
}

impl<'s, 'p, 'a> Sight<'s, 'p, 'a> {
    /// The bodies of an interaction at time `t`.
    pub fn new(world: &World<'a>, interaction: usize, stretch: &'s Stretch<'p>, t: f64) -> Self {
        let n = stretch.paths.len();
        let zero = || -> Small<f64, 8> { smallvec::smallvec![0.0; n] };
        let (mut q, mut v, mut dv) = (zero(), zero(), zero());
        for arm in &world.arms[interaction] {
            let (state, acceleration) = stretch.paths[arm.coordinate].with_acceleration(t);
            (q[arm.coordinate], v[arm.coordinate]) = (state.q, state.v);
            dv[arm.coordinate] = acceleration;
        }
        let (a, b) = world.system.interactions[interaction].bodies;
        let bodies = &world.system.bodies;
        let moves = |body: usize| bodies[body].chain.iter().any(|j| !stretch.paths[j.coordinate].is_rest());
        let placed = (Placed::new(&bodies[a], &q), Placed::new(&bodies[b], &q));
        Self { interaction, stretch, t, q, v, dv, placed, moving: (moves(a), moves(b)), held: false }
    }

    /// Looks at another time.
    pub fn move_to(&mut self, world: &World<'a>, t: f64) {
        if t == self.t {
            return;
        }
        (self.t, self.held) = (t, false);
        for arm in &world.arms[self.interaction] {
            let path = &self.stretch.paths[arm.coordinate];
            if !path.is_rest() {
                let (state, acceleration) = path.with_acceleration(t);
                (self.q[arm.coordinate], self.v[arm.coordinate]) = (state.q, state.v);
                self.dv[arm.coordinate] = acceleration;
            }
        }
        self.place(world);
    }

    fn place(&mut self, world: &World<'a>) {
        let (a, b) = world.system.interactions[self.interaction].bodies;
        let bodies = &world.system.bodies;
        if self.moving.0 {
            self.placed.0 = Placed::new(&bodies[a], &self.q);
        }
        if self.moving.1 {
            self.placed.1 = Placed::new(&bodies[b], &self.q);
        }
    }

    /// Moves the bodies to where the closed contacts hold them, which steps of the integrator tell only to their
    /// tolerance. False if nothing holds them, or they are there already.
    pub fn hold(&mut self, world: &mut World<'a>) -> bool {
        let components = self.stretch.components;
        let arms = &world.arms[self.interaction];
        let holds = |c: &Component| arms.iter().any(|arm| c.coordinates.contains(&arm.coordinate));
        let holding: Small<&Component> =
            components.iter().map(|c| &c.0).filter(|c| !c.contacts.is_empty() && holds(c)).collect();
        if self.held || holding.is_empty() {
            return false;
        }
        let states = self.stretch.paths.iter().map(|path| path.at(self.t));
        let (mut q, mut v): (Small<f64, 8>, Small<f64, 8>) = states.map(|s| (s.q, s.v)).unzip();
        for component in holding {
            component.project(world, &mut q, &mut v);
        }
        for arm in &world.arms[self.interaction] {
            (self.q[arm.coordinate], self.v[arm.coordinate]) = (q[arm.coordinate], v[arm.coordinate]);
        }
        self.held = true;
        self.place(world);
        true
    }

    /// The first body's motion seen from the second.
    pub fn relative(&self) -> Relative {
        Relative::new(&self.placed.0, &self.placed.1, &self.v, &self.dv)
    }
}
