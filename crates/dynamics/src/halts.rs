//! Two things that come down to zero along the paths: the gap of a stop, and a velocity against dry friction.

use crate::descent::{Descent, Look, first_zero};
use crate::path::Path;
use crate::search::{CLOSED, Watch};
use crate::world::World;
use mainspring_mechanism::ContactId;

/// Velocities below this fraction of what the greatest speeds make likely count as zero for dry friction.
const HALTED: f64 = 1e-11;

/// The first of these to happen over a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Halt {
    /// A stop closes (its index).
    Stop(usize),
    /// A coordinate that slides against dry friction comes to a halt.
    Slide(usize),
}

/// The motion over a stretch, which a search shortens to what it finds.
pub struct Halts<'h, 'a> {
    pub world: &'h World<'a>,
    pub paths: &'h [Path],
    pub from: f64,
    pub to: f64,
    pub first: Option<(f64, Halt)>,
}

impl Halts<'_, '_> {
    /// Looks for the first stop to close; closed ones are `watched`.
    pub fn stops(&mut self, watched: &[(ContactId, Watch)]) {
        let floor = CLOSED * self.world.system.size;
        for k in self.world.stops() {
            let stop = &self.world.system.forces.stops[k];
            let (path, slope) = (&self.paths[stop.coordinate], stop.slope());
            let watch = watched.iter().find(|w| w.0 == ContactId::of_stop(k)).map(|w| w.1);
            if path.is_rest() || watch == Some(Watch::Closed) {
                continue;
            }
            let below = if let Some(Watch::Released { floor }) = watch { floor } else { 0.0 };
            let bend = slope.abs() * path.bounds(path.at(self.from), self.to - self.from).acceleration;
            let look = |t: f64| {
                let state = path.at(t);
                Look { x: stop.gap(state.q) - below, rate: slope * state.v, bend }
            };
            let found = first_zero(look, (self.from, self.to), floor);
            self.take(found, Halt::Stop(k));
        }
    }

    /// Looks for the first velocity against dry friction to come to zero; `floor` tells below what it is.
    pub fn slides(&mut self, floor: impl Fn(usize) -> f64) {
        let slides = |i: &usize| self.world.sliding[*i] != 0.0 && !self.paths[*i].is_rest();
        let sliding: Vec<usize> = (0..self.paths.len()).filter(slides).collect();
        for i in sliding {
            let (path, sign) = (&self.paths[i], self.world.sliding[i]);
            let bend = path.jerk(path.bounds(path.at(self.from), self.to - self.from));
            let look = |t: f64| {
                let (state, acceleration) = path.with_acceleration(t);
                Look { x: sign * state.v, rate: sign * acceleration, bend }
            };
            let found = first_zero(look, (self.from, self.to), floor(i));
            self.take(found, Halt::Slide(i));
        }
    }

    fn take(&mut self, found: Descent, halt: Halt) {
        if let Some(t) = found.zero {
            self.first = Some((t, halt));
        } else if found.clear_until < self.to {
            self.first = None;
        }
        self.to = found.clear_until;
    }
}

/// Velocities of coordinate `i` up to this count as zero for dry friction.
pub fn halted(i: usize, scales: &[f64], speeds: &[f64]) -> f64 {
    let relative = speeds.iter().zip(scales).map(|(v, scale)| v / scale);
    HALTED * scales[i] * relative.fold(0.0, f64::max)
}
