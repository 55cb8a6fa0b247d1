//! Bounds of how fast two bodies' features move over a stretch of time, and of how gaps bend.

use crate::flight::{Bounds, State};
use crate::path::Path;
use crate::world::{Arm, Touch};
use mainspring_mechanism::GapKind;

/// Rates of motion of the two sides of an interaction over a stretch.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pace {
    /// Greatest speed of any feature, first and second body.
    speed: [f64; 2],
    acceleration: [f64; 2],
    turning: [f64; 2],
    turning_acceleration: [f64; 2],
}

impl Pace {
    /// Over a time `dt` from positions `q` and velocities `v` on the paths.
    pub fn new(arms: &[Arm], paths: &[Path], (q, v): (&[f64], &[f64]), dt: f64) -> Self {
        let mut pace = Self::default();
        for arm in arms {
            let i = arm.coordinate;
            let Bounds { speed, acceleration } = paths[i].bounds(State { q: q[i], v: v[i] }, dt);
            let side = usize::from(arm.second);
            pace.speed[side] += arm.length * speed;
            pace.acceleration[side] += arm.length * acceleration;
            pace.turning[side] += arm.turn * speed;
            pace.turning_acceleration[side] += arm.turn * acceleration;
        }
        pace
    }

    /// The same for features whose lever arms are these shares of the greatest.
    pub fn shared(&self, shares: [f64; 2]) -> Self {
        let scale = |x: [f64; 2]| [x[0] * shares[0], x[1] * shares[1]];
        Self { speed: scale(self.speed), acceleration: scale(self.acceleration), ..*self }
    }

    /// Greatest speed at which features of the two bodies approach.
    pub fn total(&self) -> f64 {
        self.speed[0] + self.speed[1]
    }

    /// Greatest acceleration of features of the two bodies along their paths.
    pub fn acceleration(&self) -> f64 {
        self.acceleration[0] + self.acceleration[1]
    }

    /// A bound of |ġ|, as for `curvature`.
    pub fn lipschitz(&self, away: f64) -> f64 {
        (self.total() + (self.turning[0] + self.turning[1]) * away).max(f64::MIN_POSITIVE)
    }

    /// A bound of |g̈| for a contact whose round feature stays within `away` of the other feature.
    pub fn curvature(&self, kind: GapKind, away: f64, touch: &Touch) -> f64 {
        let edge = match kind {
            GapKind::RoundEdge { swapped } => Some(usize::from(!swapped)),
            _ => None,
        };
        let Some(edge) = edge else {
            let own = |i: usize| self.acceleration[i] + self.turning[i] * self.speed[i];
            let centers = touch.state.distance_of_centers();
            return own(0) + own(1) + self.total() * self.total() / (0.5 * centers).max(f64::MIN_POSITIVE);
        };
        // The edge's line is carried past its ends: its lever grows by `away`.
        let speed = |i: usize| self.speed[i] + if i == edge { self.turning[i] * away } else { 0.0 };
        let own = |i: usize| {
            let extra = if i == edge { self.turning_acceleration[i] * away } else { 0.0 };
            self.acceleration[i] + extra + self.turning[i] * speed(i)
        };
        own(0) + own(1) + 2.0 * self.turning[edge] * (speed(0) + speed(1))
    }
}
