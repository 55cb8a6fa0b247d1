//! Bounds of how fast two bodies' features move over a stretch of time, and of how gaps change.
//!
//! A point of a body whose joints move it at most with speed S, turn it with ω, and so on, obeys
//! ```text
//! |p̈| ≤ A = Σ L α + ω S        |p⃛| ≤ J = Σ L j + 2 α S + ω A        (one joint with lever arm L)
//! |p̈| ≤ A = Σ L α + 2 ω S      |p⃛| ≤ J = Σ L j + 3 α S + 3 ω Σ L α + 5 ω² S        (a chain)
//! ```
//! With n the normal of an edge, f a point of it and c the centre of a round feature, `g = n·(c − f) − r` gives
//! `|g⃛| ≤ |n⃛| |c − f| + 3 |n̈| |ċ − ḟ| + 3 |ṅ| |c̈ − f̈| + |c⃛ − f⃛|`; for two centres d apart
//! `|g⃛| ≤ J + 3 S A / d + 2/√3 S³ / d²`.

use crate::flight::{Bounds, State};
use crate::path::Path;
use crate::world::Arm;
use mainspring_mechanism::GapKind;

/// Bounds of the motion of one body's features.
#[derive(Clone, Copy, Debug, Default)]
pub struct Side {
    speed: f64,
    acceleration: f64,
    jerk: f64,
    turning: f64,
    turning_rate: f64,
    turning_jerk: f64,
    joints: u32,
}

impl Side {
    /// A joint that moves points by `length` and turns by `turn` per unit of its coordinate.
    pub fn add_joint(&mut self, (length, turn): (f64, f64), bounds: Bounds, jerk: f64) {
        self.speed += length * bounds.speed;
        self.acceleration += length * bounds.acceleration;
        self.jerk += length * jerk;
        self.turning += turn * bounds.speed;
        self.turning_rate += turn * bounds.acceleration;
        self.turning_jerk += turn * jerk;
        self.joints += 1;
    }

    /// A² + S J: how fast the power of a unit mass can change.
    pub fn point_bend(&self) -> f64 {
        self.point_acceleration().powi(2) + self.speed * self.point_jerk()
    }

    /// The same of a unit moment of inertia.
    pub fn turning_bend(&self) -> f64 {
        self.turning_rate * self.turning_rate + self.turning * self.turning_jerk
    }

    fn shared(&self, share: f64) -> Self {
        Self {
            speed: share * self.speed,
            acceleration: share * self.acceleration,
            jerk: share * self.jerk,
            ..*self
        }
    }

    /// A: of a point. A slide on a turning part has the acceleration of Coriolis, 2 ω ṡ.
    fn point_acceleration(&self) -> f64 {
        let coriolis = if self.joints <= 1 { 1.0 } else { 2.0 };
        self.acceleration + coriolis * self.turning * self.speed
    }

    /// J: of a point. Along a chain the arms of later joints turn with earlier ones, which adds terms.
    fn point_jerk(&self) -> f64 {
        let (w, dw, speed) = (self.turning, self.turning_rate, self.speed);
        let one = self.jerk + 2.0 * dw * speed + w * self.point_acceleration();
        if self.joints <= 1 {
            one
        } else {
            one + 2.0 * w * self.acceleration + dw * speed + 3.0 * w * w * speed
        }
    }
}

/// Rates of motion of the two sides of an interaction over a stretch.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pace {
    sides: [Side; 2],
}

impl Pace {
    /// Over a time `dt` from positions `q` and velocities `v` on the paths.
    pub fn new(arms: &[Arm], paths: &[Path], (q, v): (&[f64], &[f64]), dt: f64) -> Self {
        let mut pace = Self::default();
        for arm in arms {
            let i = arm.coordinate;
            if !paths[i].is_rest() {
                let bounds_of = |i: usize| paths[i].bounds(State { q: q[i], v: v[i] }, dt);
                let bounds = bounds_of(i);
                let length = arm.reach(|k| {
                    let j = arms[k].coordinate;
                    q[j].abs() + if paths[j].is_rest() { 0.0 } else { bounds_of(j).speed * dt }
                });
                pace.sides[usize::from(arm.second)].add_joint(
                    (length, arm.turn),
                    bounds,
                    paths[i].jerk(bounds),
                );
            }
        }
        pace
    }

    /// The same for features whose lever arms are these shares of the greatest.
    pub fn shared(&self, shares: [f64; 2]) -> Self {
        Self { sides: [self.sides[0].shared(shares[0]), self.sides[1].shared(shares[1])] }
    }

    /// `shared(shares).total()`.
    #[inline]
    pub fn shared_total(&self, shares: [f64; 2]) -> f64 {
        shares[0] * self.sides[0].speed + shares[1] * self.sides[1].speed
    }

    /// Greatest speed at which features of the two bodies approach.
    pub fn total(&self) -> f64 {
        self.sides[0].speed + self.sides[1].speed
    }

    /// Greatest rate at which the two bodies turn against each other.
    pub fn turning(&self) -> f64 {
        self.sides[0].turning + self.sides[1].turning
    }

    /// Greatest acceleration of features of the two bodies along their paths.
    pub fn acceleration(&self) -> f64 {
        self.sides[0].acceleration + self.sides[1].acceleration
    }

    /// Bounds for the gap of a contact whose round feature stays within `away` of the other feature and, if both
    /// are round, whose centres stay at least `centers` apart.
    pub fn of_gap(&self, kind: GapKind, away: f64, centers: f64) -> GapPace {
        let [a, b] = &self.sides;
        let (speed, acceleration) = (self.total(), a.point_acceleration() + b.point_acceleration());
        let jerk = a.point_jerk() + b.point_jerk();
        let GapKind::RoundEdge { swapped } = kind else {
            let d = centers.max(f64::MIN_POSITIVE);
            let (bend, twist) = (speed * speed / d, 3.0 * speed * acceleration / d);
            return GapPace {
                speed,
                acceleration: acceleration + bend,
                jerk: jerk + twist + 1.155 * bend * speed / d,
            };
        };
        let Side { turning: w, turning_rate: dw, turning_jerk: ddw, .. } = *if swapped { a } else { b };
        let (second, third) = (dw + w * w, ddw + 3.0 * w * dw + w * w * w);
        GapPace {
            speed: speed + w * away,
            acceleration: acceleration + 2.0 * w * speed + second * away,
            jerk: jerk + 3.0 * w * acceleration + 3.0 * second * speed + third * away,
        }
    }
}

/// Bounds of |ġ|, |g̈| and |g⃛|.
#[derive(Clone, Copy, Debug)]
pub struct GapPace {
    pub speed: f64,
    pub acceleration: f64,
    pub jerk: f64,
}
