//! The motion of one coordinate between two events: at rest, in closed-form flight, along an integrated step, or
//! prescribed.

use crate::flight::{Bounds, Flight, State};
use crate::runge_kutta::Polynomial;
use mainspring_mechanism::{Drive, DrivePiece};

/// A coordinate's motion as a function of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Path {
    Rest {
        q: f64,
    },
    Flight(Flight),
    /// A step of the integrator, with bounds that hold over all of it.
    Step {
        t0: f64,
        h: f64,
        q: Polynomial,
        v: Polynomial,
        bounds: Bounds,
        /// A bound of the rate of change of acceleration.
        jerk: f64,
    },
    /// A prescribed motion.
    Driven(DrivenPath),
}

/// `q = c₀ + τ (c₁ + τ (c₂ + τ c₃))` with `τ = t − t0`, and bounds that hold over all of its piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrivenPath {
    t0: f64,
    c: [f64; 4],
    bounds: Bounds,
}

impl DrivenPath {
    /// The motion of a drive at time `t`, with the time up to which it holds.
    pub fn new(drive: &Drive, t: f64) -> (Self, f64) {
        let DrivePiece { from, until, coefficients } = drive.piece(t);
        let (speed, acceleration) = drive.bounds(from, until);
        (Self { t0: from, c: coefficients, bounds: Bounds { speed, acceleration } }, until)
    }

    /// Does it stand still?
    pub fn is_rest(&self) -> bool {
        self.c[1..].iter().all(|c| *c == 0.0)
    }

    /// Position and velocity at time `t`.
    pub fn at(&self, t: f64) -> State {
        self.state(t).0
    }

    /// State and acceleration at time `t`.
    pub fn state(&self, t: f64) -> (State, f64) {
        let ([c0, c1, c2, c3], tau) = (self.c, t - self.t0);
        let q = c0 + tau * (c1 + tau * (c2 + tau * c3));
        (State { q, v: c1 + tau * (2.0 * c2 + 3.0 * tau * c3) }, 2.0 * c2 + 6.0 * tau * c3)
    }
}

impl DrivenPath {
    /// Rate of change of acceleration.
    pub fn jerk(&self) -> f64 {
        6.0 * self.c[3]
    }
}

impl Path {
    /// Position and velocity at time `t` within the path's stretch.
    pub fn at(&self, t: f64) -> State {
        match self {
            Path::Rest { q } => State { q: *q, v: 0.0 },
            Path::Flight(flight) => flight.at(t),
            Path::Step { t0, h, q, v, .. } => {
                let x = (t - t0) / h;
                State { q: q.at(x), v: v.at(x) }
            }
            Path::Driven(driven) => driven.state(t).0,
        }
    }

    /// Bounds of speed and acceleration from time `t`, where the state is `state`, for a time `dt`.
    pub fn bounds(&self, state: State, dt: f64) -> Bounds {
        match self {
            Path::Rest { .. } => Bounds::default(),
            Path::Flight(flight) => flight.bounds(state, dt),
            Path::Step { bounds, .. } | Path::Driven(DrivenPath { bounds, .. }) => {
                let linear = state.v.abs() + bounds.acceleration * dt;
                Bounds { speed: bounds.speed.min(linear), ..*bounds }
            }
        }
    }

    pub fn is_rest(&self) -> bool {
        matches!(self, Path::Rest { .. })
    }

    /// Is its shape simple over a time `dt`: at rest, within a step of the integrator, or within a flight's own time?
    pub fn is_smooth(&self, dt: f64) -> bool {
        match self {
            Path::Rest { .. } | Path::Step { .. } => true,
            Path::Flight(flight) => dt <= flight.panel().0,
            Path::Driven(_) => false,
        }
    }
}

/// A path with the stretch of time it covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    pub from: f64,
    pub to: f64,
    pub path: Path,
}

/// The motion of all coordinates over a run: for each, pieces that follow each other without holes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    pub pieces: Vec<Vec<Piece>>,
    /// Times of accepted steps and events, increasing, from 0 to the end.
    pub times: Vec<f64>,
}

impl Trajectory {
    /// State of coordinate `i` at time `t`, clamped to the run; just after an event at exactly `t`.
    pub fn state(&self, i: usize, t: f64) -> State {
        self.find(i, t, false)
    }

    /// State of coordinate `i` just before any event at exactly `t`.
    pub fn state_before(&self, i: usize, t: f64) -> State {
        self.find(i, t, true)
    }

    fn find(&self, i: usize, t: f64, before: bool) -> State {
        let pieces = &self.pieces[i];
        let after = pieces.partition_point(|p| if before { p.from < t } else { p.from <= t });
        match pieces.get(after.saturating_sub(1)) {
            Some(piece) => piece.path.at(t.clamp(piece.from, piece.to)),
            None => State::default(),
        }
    }

    /// The end of the run.
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }
}

impl Path {
    /// State and acceleration at time `t`.
    pub fn with_acceleration(&self, t: f64) -> (State, f64) {
        match self {
            Path::Rest { q } => (State { q: *q, v: 0.0 }, 0.0),
            Path::Flight(flight) => {
                let state = flight.at(t);
                (state, flight.acceleration(state))
            }
            Path::Step { t0, h, q, v, .. } => {
                let x = (t - t0) / h;
                (State { q: q.at(x), v: v.at(x) }, v.slope(x) / h)
            }
            Path::Driven(driven) => driven.state(t),
        }
    }

    /// A bound of the rate of change of acceleration under `bounds`.
    pub fn jerk(&self, bounds: Bounds) -> f64 {
        match self {
            Path::Rest { .. } => 0.0,
            Path::Flight(flight) => flight.jerk(bounds),
            Path::Step { jerk, .. } => *jerk,
            Path::Driven(driven) => 6.0 * driven.c[3].abs(),
        }
    }
}
