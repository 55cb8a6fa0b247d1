//! Closed-form flight: a coordinate under linear forces only, `I q̈ = f − k q − h q̇`.
//!
//! With `a = h/2I`, `w = k/I` and `g₀ = (f − k q₀)/I`
//! ```text
//! q(τ) = q₀ + v₀ S + g₀ R        v(τ) = v₀ S' + g₀ S
//! S'' + 2a S' + w S = 0,  S(0) = 0, S'(0) = 1,   R = ∫₀ S
//! ```
//! This form keeps full accuracy when the equilibrium f/k lies far away or k vanishes.

use mainspring_geometry::Scalar;

/// Position and velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    pub q: f64,
    pub v: f64,
}

/// Terms of the Taylor series of q beyond the second: with the arguments below `SHORT` the rest is below rounding.
const TERMS: usize = 14;
/// Greatest argument of the series, in units of the flight's own time.
const SHORT: f64 = 0.5;

/// A flight from `start` at time `t0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    pub t0: f64,
    pub start: State,
    /// a = h/2I.
    half_decay: f64,
    /// w = k/I.
    stiffness: f64,
    /// g₀: acceleration at the start without friction.
    drive: f64,
    /// Times since the start up to which the series is used.
    short: f64,
    /// Coefficients of τ² and higher powers in q.
    series: [f64; TERMS],
}

/// How far `|v|` and `|v̇|` can grow over a stretch of time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    pub speed: f64,
    pub acceleration: f64,
}

impl Flight {
    /// `inertia > 0`, `damping ≥ 0`, `stiffness ≥ 0`; `force` is f.
    pub fn new(t0: f64, start: State, inertia: f64, damping: f64, stiffness: f64, force: f64) -> Self {
        let (a2, w) = (damping / inertia, stiffness / inertia);
        let drive = (force - stiffness * start.q) / inertia;
        let short = SHORT / a2.max(w.sqrt());
        let series = series(a2, w, start.v, drive);
        Self { t0, start, half_decay: 0.5 * a2, stiffness: w, drive, short, series }
    }

    /// Position and velocity at time `t ≥ t0`, accurate to a few rounding errors.
    pub fn at(&self, t: f64) -> State {
        let tau = t - self.t0;
        if tau < self.short {
            return self.soon(tau);
        }
        let (s, ds, r) = self.basis(tau);
        let Self { start, drive, .. } = *self;
        State { q: start.q + start.v * s + drive * r, v: start.v * ds + drive * s }
    }

    /// By the series.
    fn soon(&self, tau: f64) -> State {
        // Even and odd powers apart: two short chains of operations instead of a long one.
        let square = tau * tau;
        let (mut even, mut odd, mut even_slope, mut odd_slope) = (0.0, 0.0, 0.0, 0.0);
        for pair in self.series.chunks_exact(2).rev() {
            even_slope = even_slope * square + even;
            odd_slope = odd_slope * square + odd;
            even = even * square + pair[0];
            odd = odd * square + pair[1];
        }
        let sum = even + tau * odd;
        let slope = odd + 2.0 * tau * (even_slope + tau * odd_slope);
        let State { q, v } = self.start;
        State { q: q + tau * (v + tau * sum), v: v + tau * (2.0 * sum + tau * slope) }
    }

    /// Acceleration at a state on the flight.
    pub fn acceleration(&self, state: State) -> f64 {
        self.drive - self.stiffness * (state.q - self.start.q) - 2.0 * self.half_decay * state.v
    }

    /// Bounds valid from `state` (on the flight) onwards for a time `dt`. Both v and v̇ obey the same damped
    /// equation, so `v̇² + w v²` and `v² + v̇²/w` never grow.
    pub fn bounds(&self, state: State, dt: f64) -> Bounds {
        let (v, a, w) = (state.v.abs(), self.acceleration(state).abs(), self.stiffness);
        let acceleration = (a * a + w * v * v).sqrt();
        let linear = v + acceleration * dt;
        let speed = if w > 0.0 { linear.min((v * v + a * a / w).sqrt()) } else { linear };
        Bounds { speed, acceleration }
    }

    /// A bound of the rate of change of acceleration from `bounds` onwards.
    pub fn jerk(&self, bounds: Bounds) -> f64 {
        2.0 * self.half_decay * bounds.acceleration + self.stiffness * bounds.speed
    }

    /// S, S' and R at τ.
    fn basis(&self, tau: f64) -> (f64, f64, f64) {
        let (a, w) = (self.half_decay, self.stiffness);
        let square = w - a * a;
        let omega = square.abs().sqrt();
        if square > 0.0 && omega * tau > 1e-3 {
            let (sin, cos) = (omega * tau).sine_and_cosine();
            let decay = (-a * tau).exp();
            let s = decay * sin / omega;
            let c = decay * cos;
            return (s, c - a * s, (1.0 - c - a * s) / w);
        }
        if square.abs() * tau * tau <= 1e-6 {
            return nearly_critical(a, square, w, tau);
        }
        overdamped(a, w, omega, tau)
    }
}

/// Coefficients of τ², τ³, … in q: `(n + 2)(n + 1) c⁽ⁿ⁺²⁾ = −2a (n + 1) c⁽ⁿ⁺¹⁾ − w c⁽ⁿ⁾`, the first with g₀ for −w c⁽⁰⁾.
fn series(a2: f64, w: f64, velocity: f64, drive: f64) -> [f64; TERMS] {
    let mut c = [0.0; TERMS];
    c[0] = 0.5 * (drive - a2 * velocity);
    c[1] = -(2.0 * a2 * c[0] + w * velocity) / 6.0;
    for k in 2..TERMS {
        let n = k as f64;
        c[k] = -(a2 * (n + 1.0) * c[k - 1] + w * c[k - 2]) / ((n + 2.0) * (n + 1.0));
    }
    c
}

/// Two real decay rates `a ∓ ω`; the slower one without cancellation as w/(a + ω).
fn overdamped(a: f64, w: f64, omega: f64, tau: f64) -> (f64, f64, f64) {
    let (fast, slow) = (a + omega, w / (a + omega));
    let (ef, es) = ((-fast * tau).exp(), (-slow * tau).exp());
    let s = es * -(-2.0 * omega * tau).exp_m1() / (2.0 * omega);
    let ds = (fast * ef - slow * es) / (2.0 * omega);
    // φ(z) = (1 − e^{−z})/z stays accurate as the slow rate vanishes.
    let phi = |rate: f64| {
        let z = rate * tau;
        if z == 0.0 { 1.0 } else { -(-z).exp_m1() / z }
    };
    let r = tau * (phi(slow) - phi(fast)) / (fast - slow);
    (s, ds, r)
}

/// |w − a²| τ² ≤ 1e-6: the first terms of sin x / x and cos x are exact to rounding.
fn nearly_critical(a: f64, square: f64, w: f64, tau: f64) -> (f64, f64, f64) {
    let x = square * tau * tau;
    let decay = (-a * tau).exp();
    let s = decay * tau * (1.0 - x / 6.0 * (1.0 - x / 20.0));
    let c = decay * (1.0 - x / 2.0 * (1.0 - x / 12.0));
    (s, c - a * s, (1.0 - c - a * s) / w)
}

impl Flight {
    /// First panel and growth of panels for quadrature of v²: constant for oscillations, doubling for decay.
    pub fn panel(&self) -> (f64, f64) {
        let (a, w) = (self.half_decay, self.stiffness);
        let rate = (2.0 * a).max(w.sqrt());
        if rate == 0.0 {
            return (f64::INFINITY, 1.0);
        }
        (1.0 / rate, if w > a * a { 1.0 } else { 2.0 })
    }
}
