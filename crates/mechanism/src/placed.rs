//! Bodies at joint positions: poses, and how fast and along what their points move.
//!
//! For a point p fixed on the body and joints j along its chain, `∂p/∂q_j = r_j (p − o_j)^⊥` for a turn about o_j
//! and `r_j d_j` for a slide along d_j, where o_j and d_j are carried by the joints before j.

use crate::places::Sway;
use crate::system::{Body, Joint, Motion, Pose};
use mainspring_geometry::Vec2;

/// Most joints between a body and the frame.
pub const MAX_CHAIN: usize = 4;
/// Most coordinates one gap can depend on: two chains.
pub const MAX_ROW: usize = 2 * MAX_CHAIN;

/// A sparse row of a Jacobian, `∂g/∂q`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row {
    pub count: usize,
    pub coordinate: [usize; MAX_ROW],
    pub value: [f64; MAX_ROW],
}

impl Row {
    /// One entry.
    pub fn single(coordinate: usize, value: f64) -> Self {
        let mut row = Self::default();
        row.add(coordinate, value);
        row
    }

    /// Adds `value` at `coordinate`.
    pub fn add(&mut self, coordinate: usize, value: f64) {
        for k in 0..self.count {
            if self.coordinate[k] == coordinate {
                self.value[k] += value;
                return;
            }
        }
        self.coordinate[self.count] = coordinate;
        self.value[self.count] = value;
        self.count += 1;
    }

    pub fn entries(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        (0..self.count).map(|k| (self.coordinate[k], self.value[k]))
    }

    /// The entry at a coordinate; 0 if there is none.
    pub fn at(&self, coordinate: usize) -> f64 {
        self.entries().find(|e| e.0 == coordinate).map_or(0.0, |e| e.1)
    }

    /// Same coordinates with the same entries, to 1e-9 of the largest.
    pub fn is_along(&self, other: &Self) -> bool {
        self.is_nearly_along(other, 1e-9)
    }

    /// Same coordinates with the same entries, to `tolerance` of the largest.
    pub fn is_nearly_along(&self, other: &Self, tolerance: f64) -> bool {
        let size = self.entries().map(|(_, g)| g.abs()).fold(0.0, f64::max);
        let near = |(a, b): ((usize, f64), (usize, f64))| a.0 == b.0 && (a.1 - b.1).abs() <= tolerance * size;
        self.count == other.count && self.entries().zip(other.entries()).all(near)
    }

    pub fn dot(&self, x: &[f64]) -> f64 {
        self.entries().map(|(i, g)| g * x[i]).sum()
    }

    /// `Σ gᵢ hᵢ / mᵢ` with another row h and weights m.
    pub fn product(&self, other: &Self, weight: impl Fn(usize) -> f64) -> f64 {
        let mut sum = 0.0;
        for (i, g) in self.entries() {
            for (j, h) in other.entries() {
                if i == j {
                    sum += g * h / weight(i);
                }
            }
        }
        sum
    }
}

/// A body at given joint positions.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'b> {
    pub pose: Pose,
    chain: &'b [Joint],
    /// For each joint the centre of a turn or the direction of a slide, in the machine.
    at: [Vec2; MAX_CHAIN],
}

/// Velocity of a point, and the part of its acceleration that joint accelerations do not cause.
#[derive(Clone, Copy, Debug, Default)]
pub struct PointMotion {
    pub velocity: Vec2,
    pub bias: Vec2,
}

impl<'b> Placed<'b> {
    /// Joints beyond `MAX_CHAIN` are not looked at; `System::new` allows none.
    #[inline]
    pub fn new(body: &'b Body, q: &[f64]) -> Self {
        let mut at = [Vec2::default(); MAX_CHAIN];
        let pose = place(&body.chain, q, &mut at);
        Self { pose, chain: &body.chain, at }
    }

    /// How many joints both chains begin with: they move both bodies alike, and nothing between them depends on it.
    #[inline]
    pub fn shared(&self, other: &Self) -> usize {
        self.chain.iter().zip(other.chain).take_while(|(j, k)| j == k).count()
    }

    /// The same place, moved only by the joints from `first` on: the motion against whatever carries these.
    pub fn carried_by(&self, first: usize) -> Self {
        let mut at = self.at;
        at.rotate_left(first.min(MAX_CHAIN));
        Self { pose: self.pose, chain: &self.chain[first..], at }
    }

    /// How the joint of a coordinate moves the body from where it is, and its ratio; None if no joint does or several do.
    pub fn sway(&self, coordinate: usize) -> Option<(Sway, f64)> {
        let mut own = self.joints().filter(|j| j.0.coordinate == coordinate);
        let (joint, at, turns) = own.next()?;
        let sway = if turns { Sway::Turn { center: at } } else { Sway::Slide { direction: at } };
        own.next().is_none().then_some((sway, joint.ratio))
    }

    fn joints(&self) -> impl Iterator<Item = (&Joint, Vec2, bool)> {
        self.chain.iter().zip(self.at).map(|(j, at)| (j, at, matches!(j.motion, Motion::Turn { .. })))
    }

    /// Adds `sign · n · ∂p/∂q` to a row, for the body's point now at `p`.
    pub fn add_to_row(&self, row: &mut Row, n: Vec2, p: Vec2, sign: f64) {
        for (j, at, turns) in self.joints() {
            let along = if turns { n.dot((p - at).perp()) } else { n.dot(at) };
            row.add(j.coordinate, sign * j.ratio * along);
        }
    }

    /// Rate of turning of the body, radians per unit of time.
    pub fn turning(&self, v: &[f64]) -> f64 {
        self.joints().filter(|j| j.2).map(|(j, ..)| j.ratio * v[j.coordinate]).sum()
    }

    /// The velocity field of the body and its rate of change, at velocities `v` and accelerations `dv` of the
    /// coordinates.
    pub fn field(&self, v: &[f64], dv: &[f64]) -> Field {
        let mut field = Field::default();
        for (j, at, turns) in self.joints() {
            let (rate, change) = (j.ratio * v[j.coordinate], j.ratio * dv[j.coordinate]);
            if turns {
                let carried = field.velocity_at(at);
                field.linear_rate = field.linear_rate - at.perp() * change - carried.perp() * rate;
                field.turning_rate += change;
                field.turn(at, rate);
            } else {
                field.linear_rate = field.linear_rate + at * change + at.perp() * (rate * field.turning);
                field.linear = field.linear + at * rate;
            }
        }
        field
    }

    /// Velocity of the body's point now at `p`.
    pub fn velocity(&self, p: Vec2, v: &[f64]) -> Vec2 {
        self.joints().fold(Vec2::default(), |sum, (j, at, turns)| {
            let rate = j.ratio * v[j.coordinate];
            sum + if turns { (p - at).perp() } else { at } * rate
        })
    }

    /// Velocity and bias acceleration of the body's point now at `p`.
    pub fn motion(&self, p: Vec2, v: &[f64]) -> PointMotion {
        let velocity = self.velocity(p, v);
        let mut bias = Vec2::default();
        let mut carried = Field::default();
        for (j, at, turns) in self.joints() {
            let rate = j.ratio * v[j.coordinate];
            if turns {
                let center = carried.velocity_at(at);
                bias = bias + (velocity - center).perp() * rate;
                carried.turn(at, rate);
            } else {
                bias = bias + at.perp() * (rate * carried.turning);
                carried.linear = carried.linear + at * rate;
            }
        }
        PointMotion { velocity, bias }
    }
}

/// Where the joints of a chain put its body at positions `q`; `at` gets for each joint the centre of a turn or the
/// direction of a slide, in the machine.
#[inline]
pub(crate) fn place(chain: &[Joint], q: &[f64], at: &mut [Vec2; MAX_CHAIN]) -> Pose {
    let Some((first, others)) = chain.split_first() else { return Pose::identity() };
    at[0] = first.motion.vector();
    let mut pose = first.motion.pose(q[first.coordinate] * first.ratio);
    for (joint, at) in others.iter().zip(&mut at[1..]) {
        *at = match joint.motion {
            Motion::Turn { center } => pose.apply(center),
            Motion::Slide { direction } => pose.rotate(direction),
        };
        pose = pose.then_after(&joint.motion.pose(q[joint.coordinate] * joint.ratio));
    }
    pose
}

/// A velocity field `linear + turning · p^⊥`, with its rate of change at fixed places.
#[derive(Clone, Copy, Debug, Default)]
pub struct Field {
    pub linear: Vec2,
    pub turning: f64,
    pub linear_rate: Vec2,
    pub turning_rate: f64,
}

impl Field {
    /// Of a body on a chain with joints `at` their places, at velocities `v` and without accelerations of the coordinates.
    #[inline]
    pub(crate) fn drift(chain: &[Joint], at: &[Vec2], v: &[f64]) -> Self {
        let mut field = Self::default();
        for (j, &at) in chain.iter().zip(at) {
            let rate = j.ratio * v[j.coordinate];
            if matches!(j.motion, Motion::Turn { .. }) {
                field.linear_rate = field.linear_rate - field.velocity_at(at).perp() * rate;
                field.turn(at, rate);
            } else {
                field.linear_rate = field.linear_rate + at.perp() * (rate * field.turning);
                field.linear = field.linear + at * rate;
            }
        }
        field
    }

    /// Velocity and bias acceleration of the body's point now at `p`, for a field without accelerations of the
    /// coordinates.
    #[inline]
    pub fn motion(&self, p: Vec2) -> PointMotion {
        let velocity = self.velocity_at(p);
        PointMotion { velocity, bias: self.linear_rate + velocity.perp() * self.turning }
    }

    fn velocity_at(&self, p: Vec2) -> Vec2 {
        self.linear + p.perp() * self.turning
    }

    fn turn(&mut self, center: Vec2, rate: f64) {
        self.linear = self.linear - center.perp() * rate;
        self.turning += rate;
    }
}
