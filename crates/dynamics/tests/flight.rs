//! Closed-form flight against series of its own equation, integrated in small steps of high order.

mod common;

use common::{Random, close};
use mainspring_dynamics::{Flight, Path, State};

/// One step of the Taylor series of `q̈ = f − k q − h q̇` (unit inertia) to order 20: exact to rounding for small steps.
fn step(s: State, (h, k, f): (f64, f64, f64), dt: f64) -> State {
    let mut terms = [0.0; 22];
    (terms[0], terms[1]) = (s.q, s.v);
    for n in 0..20 {
        let constant = if n == 0 { f } else { 0.0 };
        let n1 = (n + 1) as f64;
        terms[n + 2] = (constant - k * terms[n] - h * n1 * terms[n + 1]) / (n1 * (n1 + 1.0));
    }
    let (mut q, mut v) = (0.0, 0.0);
    for n in (0..22).rev() {
        q = q * dt + terms[n];
        if n > 0 {
            v = v * dt + n as f64 * terms[n];
        }
    }
    State { q, v }
}

fn integrate(start: State, forces: (f64, f64, f64), t: f64) -> State {
    let rate = forces.0.max(forces.1.sqrt()).max(1e-3);
    let steps = (t * rate * 4.0).ceil().max(1.0);
    (0..steps as usize).fold(start, |s, _| step(s, forces, t / steps))
}

fn check(start: State, (h, k, f): (f64, f64, f64), t: f64) {
    let flight = Flight::new(0.0, start, 1.0, h, k, f);
    let (found, expected) = (flight.at(t), integrate(start, (h, k, f), t));
    let reach = start.q.abs().max(expected.q.abs()).max(if k > 0.0 { (f / k).abs() } else { 0.0 });
    let speed = start.v.abs().max(expected.v.abs()).max(1e-12 * reach);
    let what = format!("h {h} k {k} f {f} t {t} from {start:?}: {found:?} for {expected:?}");
    assert!((found.q - expected.q).abs() <= 1e-12 * (reach + speed * t), "{what}");
    assert!(
        (found.v - expected.v).abs() <= 1e-11 * (speed + k.sqrt() * reach + f.abs() * t.min(1.0)),
        "{what}"
    );
}

/// Weak, strong and critical damping, no spring, no friction, nothing at all: all agree with a Taylor integration.
#[test]
fn every_kind_of_damping() {
    let start = State { q: 0.3, v: -1.1 };
    let kinds = [
        (0.2, 1.0, 0.4),
        (5.0, 1.0, 0.4),
        (50.0, 1.0, 0.4),
        (2.0, 1.0, 0.4),
        (2.0 + 1e-9, 1.0, 0.4),
        (2.0 - 1e-9, 1.0, 0.4),
        (2.0 + 1e-4, 1.0, 0.4),
        (2.0 - 1e-4, 1.0, 0.4),
        (0.7, 0.0, 0.4),
        (0.0, 2.0, 0.4),
        (0.0, 0.0, 0.4),
        (0.0, 0.0, 0.0),
        (1e-9, 0.0, 0.4),
        (0.5, 1e-12, 0.4),
    ];
    for forces in kinds {
        for t in [1e-9, 1e-4, 0.01, 0.3, 0.5, 1.0, 3.0, 10.0, 40.0] {
            check(start, forces, t);
        }
    }
}

/// 5000 random flights, also near the borders between the forms.
#[test]
fn random_flights() {
    let mut random = Random(7);
    for _ in 0..5000 {
        let start = State { q: random.next(-2.0, 2.0), v: random.next(-2.0, 2.0) };
        let k = 10f64.powf(random.next(-6.0, 1.5));
        let h = 2.0 * k.sqrt() * 10f64.powf(random.next(-2.0, 2.0));
        check(start, (h, k, random.next(-1.0, 1.0)), random.next(0.0, 20.0));
    }
}

/// An equilibrium 1e5 away costs no digits of the motion: displacement ½ g t² is kept to rounding at small times.
#[test]
fn a_far_equilibrium_loses_nothing() {
    let (k, f) = (0.02, 2000.0);
    let start = State { q: 0.1, v: 0.0 };
    let flight = Flight::new(0.0, start, 200.0, 0.0, k, f);
    let (w, g) = ((k / 200.0f64).sqrt(), (f - k * 0.1) / 200.0);
    for t in [1e-6, 1e-3, 0.1, 1.0, 30.0] {
        let s = (0.5 * w * t).sin();
        close(flight.at(t).q - start.q, 2.0 * g * s * s / (w * w), 1e-14 * (g * t * t + start.q));
        close(flight.at(t).v, g * (w * t).sin() / w, 1e-14 * g * t);
    }
}

/// After a very long time a damped flight is at its equilibrium, and an undamped one keeps its energy.
#[test]
fn long_times() {
    let start = State { q: 0.3, v: -1.1 };
    for (h, k) in [(0.2, 1.0), (5.0, 1.0), (2.0, 1.0), (1e3, 0.5)] {
        let end = Flight::new(0.0, start, 1.0, h, k, 0.4).at(1e9);
        close(end.q, 0.4 / k, 1e-14);
        close(end.v, 0.0, 1e-14);
    }
    let end = Flight::new(0.0, start, 1.0, 0.0, 4.0, 0.0).at(1e6);
    close(2.0 * end.q * end.q + 0.5 * end.v * end.v, 2.0 * 0.09 + 0.5 * 1.21, 1e-12);
    let end = Flight::new(0.0, start, 1.0, 0.5, 0.0, 2.0).at(1e6);
    close(end.v, 4.0, 1e-13);
}

/// The bounds of speed, acceleration and jerk hold at every later instant of the time asked for.
#[test]
fn bounds_bound() {
    let mut random = Random(3);
    for _ in 0..3000 {
        let start = State { q: random.next(-2.0, 2.0), v: random.next(-2.0, 2.0) };
        let k = if random.next(0.0, 1.0) < 0.2 { 0.0 } else { 10f64.powf(random.next(-3.0, 2.0)) };
        let h = if random.next(0.0, 1.0) < 0.2 { 0.0 } else { 10f64.powf(random.next(-3.0, 2.0)) };
        let flight = Flight::new(0.0, start, random.next(0.1, 3.0), h, k, random.next(-3.0, 3.0));
        let (from, dt) = (random.next(0.0, 3.0), 10f64.powf(random.next(-3.0, 1.0)));
        let path = Path::Flight(flight);
        let bounds = path.bounds(flight.at(from), dt);
        let mut before = path.with_acceleration(from).1;
        for n in 0..=50 {
            let (state, acceleration) = path.with_acceleration(from + dt * f64::from(n) / 50.0);
            let slack = 1.0 + 1e-9;
            assert!(state.v.abs() <= bounds.speed * slack + 1e-12);
            assert!(acceleration.abs() <= bounds.acceleration * slack + 1e-12);
            let change = (acceleration - before).abs();
            assert!(change <= path.jerk(bounds) * dt / 50.0 * slack + 1e-9 * (1.0 + bounds.acceleration));
            before = acceleration;
        }
    }
}
