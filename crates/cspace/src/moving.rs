//! A body that one coordinate moves: it turns about a point of the plane, slides along a direction, or stays.
//!
//! Every contact with the other body held still reduces to one of three equations for the joint position u, each
//! with at most two roots `base ± delta`:
//! ```text
//! carried point p, fixed point w at distance ρ      |R(u) p + o − w| = ρ
//! carried point p on a fixed line                   N·(R(u) p + o) = C
//! carried line n·z = c, fixed point w at offset ρ   R(u) n·(w − o) = c + ρ
//! ```
//! For a turn all three are `K cos δ = D`. `δ = 2 atan √((K−D)/(K+D))` with K−D and K+D as products of lengths keeps
//! all digits at folds, where acos would lose half of them (DESIGN: numerics). Angles in radians.

use mainspring_geometry::Vec2;
use mainspring_mechanism::Pose;

/// Equations count as solvable when K ± D is above minus this part of K.
const REACH: f64 = 1e-12;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Turn,
    Slide,
    Still,
}

/// How a body moves with its coordinate's scaled position u = |ratio| q.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moving {
    pub kind: Kind,
    /// Centre of the turn; zero for a slide.
    pub center: Vec2,
    /// +1 or −1: sense of the turn.
    pub sign: f64,
    /// Unit vector of the slide, sense included.
    pub direction: Vec2,
    /// local_from_modelled: local coordinates are those in which `place` acts.
    pub local: Pose,
    /// |ratio|: u = ratio · q.
    pub ratio: f64,
}

/// A feature's carrier in local coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Carried {
    Point(Vec2),
    /// `normal · z = offset`.
    Line {
        normal: Vec2,
        offset: f64,
    },
}

/// What it meets, in the plane of the machine.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Fixed {
    /// Distance (for a carried point) or signed offset (for a carried line) `rho` from `at`.
    Point { at: Vec2, rho: f64 },
    /// `normal · z = offset`.
    Line { normal: Vec2, offset: f64 },
}

/// Roots `base ± delta`, or `base` alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Roots {
    pub base: f64,
    pub delta: f64,
    /// Do roots exist (to rounding)?
    pub reach: bool,
    pub single: bool,
}

impl Roots {
    pub const NONE: Roots = Roots { base: f64::NAN, delta: f64::NAN, reach: false, single: true };

    fn one(base: f64) -> Self {
        Roots { base, delta: 0.0, reach: base.is_finite(), single: true }
    }

    /// `K cos δ = D` about direction `base`, from K−D and K+D.
    fn angle(base: f64, less: f64, more: f64) -> Self {
        let floor = -REACH * (less.abs() + more.abs());
        let delta = 2.0 * less.max(0.0).sqrt().atan2(more.max(0.0).sqrt());
        Roots { base, delta, reach: less >= floor && more >= floor && less + more > 0.0, single: false }
    }

    pub fn root(&self, branch: f64) -> f64 {
        self.base + branch * self.delta
    }

    pub fn each(&self) -> impl Iterator<Item = f64> + use<> {
        let roots = [self.root(1.0), self.root(-1.0)];
        let count = if !self.reach {
            0
        } else if self.single {
            1
        } else {
            2
        };
        roots.into_iter().take(count)
    }
}

/// A turn from one direction to another, give or take δ with `K cos δ = D`: K−D and K+D.
struct Turned {
    from: Vec2,
    to: Vec2,
    less: f64,
    more: f64,
}

impl Turned {
    /// The angle between both turned on by ±δ, of which tan δ/2 is known, at once.
    fn root(&self, branch: f64) -> f64 {
        let (less, more) = (self.less.max(0.0), self.more.max(0.0));
        let (cos, sin) = (more - less, branch * 2.0 * (less * more).sqrt());
        let (along, across) = (self.from.dot(self.to), self.from.cross(self.to));
        (across * cos + along * sin).atan2(along * cos - across * sin)
    }
}

/// Angle from `a` to `b`.
fn angle_between(a: Vec2, b: Vec2) -> f64 {
    a.cross(b).atan2(a.dot(b))
}

impl Moving {
    pub fn turns(&self) -> bool {
        self.kind == Kind::Turn
    }

    /// machine_from_local at u.
    pub fn place(&self, u: f64) -> Pose {
        match self.kind {
            Kind::Turn => {
                let (sin, cos) = u.sin_cos();
                Pose { cos, sin: self.sign * sin, shift: self.center }
            }
            Kind::Slide => Pose { shift: self.direction * u, ..Pose::identity() },
            Kind::Still => Pose::identity(),
        }
    }

    /// Velocity per unit of u of the body's point now at `p`.
    pub fn velocity(&self, p: Vec2) -> Vec2 {
        match self.kind {
            Kind::Turn => (p - self.center).perp() * self.sign,
            Kind::Slide => self.direction,
            Kind::Still => Vec2::default(),
        }
    }

    /// Greatest speed per unit of u of the points within `radius` of the local point `center`.
    pub fn lever(&self, center: Vec2, radius: f64) -> f64 {
        match self.kind {
            Kind::Turn => center.norm() + radius,
            Kind::Slide => 1.0,
            Kind::Still => 0.0,
        }
    }

    /// Positions at which the carried feature meets the fixed one.
    pub fn solve(&self, carried: Carried, fixed: Fixed) -> Roots {
        match self.kind {
            Kind::Turn => self.solve_turn(carried, fixed),
            Kind::Slide => self.solve_slide(carried, fixed),
            Kind::Still => Roots::NONE,
        }
    }

    fn solve_turn(&self, carried: Carried, fixed: Fixed) -> Roots {
        let Some(Turned { from, to, less, more }) = self.turned(carried, fixed) else { return Roots::NONE };
        let roots = Roots::angle(angle_between(from, to), less, more);
        Roots { base: self.sign * roots.base, ..roots }
    }

    /// `K cos δ = D` for the angle δ from where the carried feature is turned to `to`.
    fn turned(&self, carried: Carried, fixed: Fixed) -> Option<Turned> {
        match (carried, fixed) {
            (Carried::Point(from), Fixed::Point { at, rho }) => {
                let to = at - self.center;
                let (k, l) = (to.norm(), from.norm());
                let (less, more) = ((rho - k + l) * (rho + k - l), (k + l - rho) * (k + l + rho));
                Some(Turned { from, to, less, more })
            }
            (Carried::Point(from), Fixed::Line { normal, offset }) => {
                let (k, d) = (from.norm(), offset - normal.dot(self.center));
                Some(Turned { from, to: normal, less: k - d, more: k + d })
            }
            (Carried::Line { normal, offset }, Fixed::Point { at, rho }) => {
                let to = at - self.center;
                let (k, d) = (to.norm(), offset + rho);
                Some(Turned { from: normal, to, less: k - d, more: k + d })
            }
            (Carried::Line { .. }, Fixed::Line { .. }) => None,
        }
    }

    /// The root of one branch, as `solve` has it but for whole turns; half the work.
    pub fn root(&self, carried: Carried, fixed: Fixed, branch: f64) -> f64 {
        match self.kind {
            Kind::Turn => {
                self.turned(carried, fixed).map_or(f64::NAN, |t| self.sign * t.root(self.sign * branch))
            }
            Kind::Slide => self.solve_slide(carried, fixed).root(branch),
            Kind::Still => f64::NAN,
        }
    }

    fn solve_slide(&self, carried: Carried, fixed: Fixed) -> Roots {
        let d = self.direction;
        match (carried, fixed) {
            (Carried::Point(p), Fixed::Point { at, rho }) => {
                let w = at - p;
                let h = w.cross(d).abs();
                let square = (rho - h) * (rho + h);
                let reach = square >= -REACH * (rho * rho + h * h);
                Roots { base: w.dot(d), delta: square.max(0.0).sqrt(), reach, single: false }
            }
            (Carried::Point(p), Fixed::Line { normal, offset }) => {
                Self::ratio(offset - normal.dot(p), normal.dot(d))
            }
            (Carried::Line { normal, offset }, Fixed::Point { at, rho }) => {
                Self::ratio(normal.dot(at) - offset - rho, normal.dot(d))
            }
            (Carried::Line { .. }, Fixed::Line { .. }) => Roots::NONE,
        }
    }

    fn ratio(offset: f64, slope: f64) -> Roots {
        if slope.abs() < 1e-12 { Roots::NONE } else { Roots::one(offset / slope) }
    }

    /// Position at which the carried direction `e` points along `d`; none unless it turns.
    pub fn aim(&self, e: Vec2, d: Vec2) -> Roots {
        if self.turns() { Roots::one(self.sign * angle_between(e, d)) } else { Roots::NONE }
    }
}
