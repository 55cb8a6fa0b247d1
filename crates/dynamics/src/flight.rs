//! Closed-form flight: a coordinate under linear forces only, `I q̈ = f − k q − h q̇`.
//!
//! With `a = h/2I`, `w = k/I` and `g₀ = (f − k q₀)/I`
//! ```text
//! q(τ) = q₀ + v₀ S + g₀ R        v(τ) = v₀ S' + g₀ S
//! S'' + 2a S' + w S = 0,  S(0) = 0, S'(0) = 1,   R = ∫₀ S
//! ```
//! This form keeps full accuracy when the equilibrium f/k lies far away or k vanishes.

/// Position and velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    pub q: f64,
    pub v: f64,
}

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
        Self {
            t0,
            start,
            half_decay: 0.5 * damping / inertia,
            stiffness: stiffness / inertia,
            drive: (force - stiffness * start.q) / inertia,
        }
    }

    /// Position and velocity at time `t ≥ t0`, accurate to a few rounding errors.
    pub fn at(&self, t: f64) -> State {
        let (s, ds, r) = self.basis(t - self.t0);
        let Self { start, drive, .. } = *self;
        State { q: start.q + start.v * s + drive * r, v: start.v * ds + drive * s }
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
        if (2.0 * a).max(w.sqrt()) * tau < 0.5 {
            return self.series(tau);
        }
        let square = w - a * a;
        let omega = square.abs().sqrt();
        if square > 0.0 && omega * tau > 1e-3 {
            let (sin, cos) = (omega * tau).sin_cos();
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

    /// Taylor series: S⁽ⁿ⁺²⁾ = −2a S⁽ⁿ⁺¹⁾ − w S⁽ⁿ⁾, for arguments below ½.
    fn series(&self, tau: f64) -> (f64, f64, f64) {
        let (a2, w) = (2.0 * self.half_decay, self.stiffness);
        let (mut before, mut last) = (0.0, 1.0);
        let (mut s, mut ds, mut r) = (0.0, 0.0, 0.0);
        // Without friction every other term is zero: two in a row must be small.
        let (mut power, mut term_before) = (1.0, f64::INFINITY);
        for n in 1..24 {
            // `last` is S⁽ⁿ⁾(0), `power` is τⁿ⁻¹/(n−1)!.
            let n = f64::from(n);
            ds += last * power;
            s += last * power * tau / n;
            let term = last * power * tau * tau / (n * (n + 1.0));
            r += term;
            if term.abs() + f64::abs(term_before) <= 1e-18 * r.abs() {
                break;
            }
            term_before = term;
            power *= tau / n;
            (before, last) = (last, -a2 * last - w * before);
        }
        (s, ds, r)
    }
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
