//! Compliant contact under all that acts on joints: chains, gravity, drives, dry friction, stops; closed forms and
//! references of another method.

mod common;

use common::{bodies, chained, close, coordinate, extrapolate, on_chain, push, row, slide, turn};
use mainspring_dynamics::{EventKind, Run, Status};
use mainspring_geometry::Vec2;
use mainspring_mechanism::{ContactLaw, Coordinate, Drive, Forces, Mass, Stop, System, Table};
use std::f64::consts::{PI, TAU};

const G: f64 = 9.81;

fn balanced(run: &Run, tolerance: f64) {
    let residual = run.energy.residual();
    assert!(residual.abs() < tolerance, "energy residual {residual:e}: {:?}", run.energy);
    assert!(run.energy.friction >= 0.0 && run.energy.impacts >= -1e-9, "{:?}", run.energy);
}

fn law() -> ContactLaw {
    ContactLaw::default()
}

fn free(inertia: f64) -> Coordinate {
    coordinate("free", inertia, 0.0, (0.0, 0.0))
}

fn at(c: Coordinate, position: f64, velocity: f64) -> Coordinate {
    Coordinate { position, velocity, ..c }
}

/// Parts that never meet.
const APART: &str = "generic m(m)\na = blo(x=1)\nb = blo(x=1) at (movz=3)\nf = blo() at (movz=-9)\nattr f : frame = 1\n\
                     m = a asb b asb f\n";

/// A physical pendulum swings with the period 2π √(I/mgd) / agm(1, cos ½θ).
#[test]
fn a_pendulum_has_its_elliptic_period() {
    let (inertia, m, d, angle) = (0.7, 1.3, 0.45, 2.5);
    let mass = Mass { body: 0, mass: m, center: Vec2::new(0.0, -d), inertia: 0.0, chained: false };
    let forces = Forces { masses: vec![mass], gravity: Vec2::new(0.0, -G), ..Forces::none(1) };
    let machine = System::new(
        vec![at(free(inertia), angle, 0.0)],
        chained(APART, &[("a", &[turn(0, 0.0, 0.0)])]),
        &[],
        1.0,
    )
    .with_forces(forces);
    let (mut a, mut b) = (1.0f64, (0.5 * angle).cos());
    for _ in 0..40 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let period = TAU * (inertia / (m * G * d)).sqrt() / a;
    for (rtol, allowed) in [(1e-6, 3e-5), (1e-9, 1e-7)] {
        let found = push(&machine, law(), 9.0, rtol);
        assert_eq!(found.status, Status::Complete);
        for (n, minimum) in found.minima.iter().enumerate() {
            close(minimum.t, 0.5 * period * (n + 1) as f64, allowed);
        }
        assert_eq!(found.minima.len(), (9.0 / (0.5 * period)) as usize);
        balanced(&found, allowed);
    }
}

/// Two point masses on two rods, against Bulirsch and Stoer's extrapolation of the textbooks' equations.
#[test]
fn a_double_pendulum_moves_as_an_independent_integration_says() {
    let (m, l) = ([1.1, 0.7], [0.9, 0.6]);
    let joints = [turn(0, 0.0, 0.0), turn(1, 0.0, -l[0])];
    let first = Mass { body: 0, mass: m[0], center: Vec2::new(0.0, -l[0]), inertia: 0.0, chained: false };
    let masses = vec![first, on_chain(1, m[1], (0.0, -l[0] - l[1]), 0.0)];
    let forces = Forces { masses, gravity: Vec2::new(0.0, -G), ..Forces::none(2) };
    let coordinates = vec![at(free(m[0] * l[0] * l[0]), 1.2, 0.0), at(free(0.0), -0.4, 0.0)];
    let machine = System::new(coordinates, chained(APART, &[("a", &joints[..1]), ("b", &joints)]), &[], 1.5)
        .with_forces(forces);
    let rate = move |_: f64, y: &[f64]| {
        let (s, c) = (y[0] - y[1]).sin_cos();
        let (a11, a12) = ((m[0] + m[1]) * l[0], m[1] * l[1] * c);
        let b1 = -m[1] * l[1] * y[3] * y[3] * s - (m[0] + m[1]) * G * y[0].sin();
        let (a21, a22, b2) = (l[0] * c, l[1], l[0] * y[2] * y[2] * s - G * y[1].sin());
        let det = a11 * a22 - a12 * a21;
        vec![y[2], y[3], (b1 * a22 - a12 * b2) / det, (a11 * b2 - a21 * b1) / det]
    };
    let y = extrapolate(rate, (0.0, 3.0), &[1.2, 0.8, 0.0, 0.0], 120);
    let found = push(&machine, law(), 3.0, 1e-10);
    close(found.q[0], y[0], 1e-7);
    close(found.q[0] + found.q[1], y[1], 1e-7);
    close(found.v[0] + found.v[1], y[3], 1e-6);
    balanced(&found, 1e-8);
}

/// A block on a beam that a drive turns up: sliding begins when m g sin θ − m r ω² passes T, then as an independent
/// integration says.
#[test]
fn a_block_lets_go_on_a_rising_beam() {
    let (m, size, w, r) = (1.3, 4.0, 0.2, 2.0);
    let text = "generic m(m)\nbeam = blo(x=9,y=1) at (movy=-1)\nblock = blo() at (movx=1.5,movz=3)\nf = blo() at (movz=-9)\n\
                attr f : frame = 1\nm = beam asb block asb f\n";
    let joints = [turn(0, 0.0, 0.0), slide(1, 1.0, 0.0)];
    let forces = Forces {
        masses: vec![on_chain(1, m, (r, 0.0), 0.1)],
        gravity: Vec2::new(0.0, -G),
        drives: vec![Some(Drive::Speed { start: 0.0, speed: w }), None],
        coulomb: vec![0.0, size],
        ..Forces::none(2)
    };
    let bodies = chained(text, &[("beam", &joints[..1]), ("block", &joints)]);
    let machine = System::new(vec![at(free(4.0), 0.0, w), free(0.0)], bodies, &[], 10.0).with_forces(forces);
    let released = ((size / m + r * w * w) / G).asin() / w;
    let found = push(&machine, law(), released + 0.6, 1e-9);
    assert_eq!(found.trajectory.state(1, released - 1e-5).v, 0.0);
    assert!(found.trajectory.state(1, released + 1e-3).v < 0.0);
    let rate = |t: f64, y: &[f64]| vec![y[1], (r + y[0]) * w * w - G * (w * t).sin() + size / m];
    let y = extrapolate(rate, (released, released + 0.6), &[0.0, 0.0], 40);
    close(found.q[1], y[0], 1e-7);
    close(found.v[1], y[1], 1e-7);
    balanced(&found, 1e-7);
}

/// Half-swings about ± T/k, each shorter by 2 T/k; a constant force moves what it overcomes; a block below the limit stays.
#[test]
fn dry_friction_without_contact_is_exact() {
    let (m, k, size, x0) = (1.5, 6.0, 0.9, 1.0);
    let sprung = at(coordinate("b", m, 0.0, (k, 0.0)), x0, 0.0);
    let found = push(&row(1.0, &[(sprung, size, 0.0)], vec![None]), law(), 90.0, 1e-6);
    assert_eq!(found.status, Status::AtRest);
    let half = PI * (m / k).sqrt();
    let (mut x, mut n) = (x0, 0);
    while k * x.abs() > size {
        x = -x + x.signum() * 2.0 * size / k;
        n += 1;
        close(found.trajectory.state(0, half * f64::from(n)).q, x, 1e-10);
    }
    close(found.t, half * f64::from(n), 1e-9);
    balanced(&found, 1e-10);
    for force in [0.99, -0.99, 1.0] {
        let found = push(&row(1.0, &[(free(2.0), 1.0, force)], vec![None]), law(), 5.0, 1e-6);
        assert_eq!((found.status, found.t, found.q[0]), (Status::AtRest, 0.0, 0.0), "{force}");
    }
    let found = push(&row(1.0, &[(free(2.0), 1.0, -1.5)], vec![None]), law(), 4.0, 1e-6);
    close(found.q[0], -0.5 * 0.25 * 16.0, 1e-11);
    close(found.energy.work, 3.0, 1e-11);
}

/// A block pushes a stuck one: it stays up to its limit, pressed to the depth the law says; beyond, both go on together
/// with what is left, (F − T)/(m₁ + m₂).
#[test]
fn a_stuck_block_holds_up_to_its_limit() {
    let machine = |force: f64| row(0.0, &[(free(1.0), 0.0, force), (free(2.0), 3.0, 0.0)], vec![None; 2]);
    let held = push(&machine(1.4), law(), 200.0, 1e-6);
    assert_eq!((held.status, held.q[1]), (Status::AtRest, 0.0), "{:?}", held.energy);
    // Two corners on a face share the force.
    close(held.q[0], 1.4 / (2.0 * law().e), 1e-9);
    assert!(held.closed.iter().all(|c| (c.force - 0.7).abs() < 1e-3), "{:?}", held.closed);
    balanced(&held, 1e-5);
    let moved = push(&machine(9.0), law(), 3.0, 1e-6);
    let accelerations: Vec<f64> =
        (0..2).map(|i| (moved.trajectory.state(i, 2.9).v - moved.trajectory.state(i, 1.9).v) / 1.0).collect();
    accelerations.iter().for_each(|a| close(*a, (9.0 - 3.0) / 3.0, 1e-3));
    balanced(&moved, 1e-5);
}

/// A driven block pushes another against a spring: momentum of the blow, then x = u t less the depth k x / 2E, and the
/// drive's work goes into spring and contact.
#[test]
fn a_driven_block_pushes_another() {
    let (m, k, u) = (1.7, 4.0, 1.25);
    let drives = vec![Some(Drive::Speed { start: 0.0, speed: u }), None];
    let machine = row(0.5, &[(free(5.0), 0.0, 0.0), (coordinate("b", m, 0.0, (k, 0.0)), 0.0, 0.0)], drives);
    let found = push(&machine, law(), 3.0, 1e-7);
    assert_eq!(found.status, Status::Complete);
    let pushed = u * 3.0 - 0.5;
    let depth = k * pushed / (2.0 * law().e);
    close(found.q[1], pushed - depth, 1e-5);
    let stored = 0.5 * k * found.q[1] * found.q[1] + law().e * depth * depth;
    let lost = found.energy.impacts;
    close(found.energy.work, stored + lost + 0.5 * m * found.v[1] * found.v[1], 1e-4);
    // Half of m u² is lost where nothing rebounds.
    assert!((0.4..0.51).contains(&(lost / (m * u * u))), "{lost}");
    balanced(&found, 1e-6);
}

/// A table moves a block into another and stands still: steps end at its points, the account closes.
#[test]
fn a_table_pushes_and_stops() {
    let table = Drive::Table(Table::new(&[(0.0, 0.0), (1.0, 0.8), (1.5, 0.8), (2.5, 0.2)]));
    let machine = row(
        0.5,
        &[(free(5.0), 0.0, 0.0), (coordinate("b", 1.0, 2.0, (8.0, 0.0)), 0.0, 0.0)],
        vec![Some(table), None],
    );
    let found = push(&machine, law(), 60.0, 1e-7);
    assert_eq!(
        found.status,
        Status::AtRest,
        "{} {:?} {:?} {:?}",
        found.t,
        found.stats,
        found.q,
        found.events
    );
    close(found.q[0], 0.2, 1e-14);
    close(found.q[1], 0.0, 1e-4);
    close(found.trajectory.state(1, 1.4).q, 0.3, 2e-3);
    balanced(&found, 1e-6);
}

/// A drive against the frame squeezes what is between until the shapes lose their meaning: jammed, and told so.
#[test]
fn a_drive_against_the_frame_is_jammed() {
    let text = "generic m(m)\na = blo(x=2,y=1) at (movx=-2)\nf = blo(x=1,y=3) at (movx=1,movy=-1)\nattr f : frame = 1\nm = a asb f\n";
    let forces = Forces { drives: vec![Some(Drive::Speed { start: 0.0, speed: 0.5 })], ..Forces::none(1) };
    let machine = System::new(vec![free(1.0)], bodies(text, &[("a", slide(0, 1.0, 0.0))]), &[], 10.0)
        .with_forces(forces);
    let found = push(&machine, law(), 9.0, 1e-6);
    assert_eq!(found.status, Status::Jammed);
    assert!(found.t > 2.0 && found.t < 2.5, "jammed at {} {:?}", found.t, found.q);
    // Too soft for a constant force.
    let soft = ContactLaw { e: 1.0, d: 0.0, m: 0.0 };
    let pressed = System::new(
        vec![Coordinate { force: 5.0, ..free(1.0) }],
        bodies(text, &[("a", slide(0, 1.0, 0.0))]),
        &[],
        10.0,
    );
    let found = push(&pressed, soft, 9.0, 1e-6);
    assert_eq!(found.status, Status::TooDeep, "{} {:?} {:?}", found.t, found.q, found.events);
}

/// A lever falls on its stop and comes to rest there: depth by E at the stop's lever, force m g d sin θ / ℓ.
#[test]
fn a_pendulum_falls_on_a_stop() {
    let (inertia, m, d, lever, angle) = (1.1, 0.9, 0.8, 1.6, -0.4);
    let text = "generic m(m)\na = blo()\nf = blo() at (movz=9)\nattr f : frame = 1\nm = a asb f\n";
    let c = Coordinate { position: 1.2, ..free(inertia) };
    let masses = vec![Mass { body: 0, mass: m, center: Vec2::new(0.0, -d), inertia: 0.0, chained: false }];
    let stops = vec![Stop { coordinate: 0, bodies: (0, 1), upper: false, limit: angle, lever, side: 1.0 }];
    let heavy = Vec2::new(-G * 0.9f64.sin(), -G * 0.9f64.cos());
    let forces = Forces { masses, gravity: heavy, stops, ..Forces::none(1) };
    let machine =
        System::new(vec![c], bodies(text, &[("a", turn(0, 0.0, 0.0))]), &[], 3.0).with_forces(forces);
    let found = push(&machine, law(), 60.0, 1e-7);
    assert_eq!(found.status, Status::AtRest, "{} {:?}", found.t, found.q);
    let torque = |q: f64| m * G * d * (q + 0.9).sin();
    let depth = torque(angle) / lever / law().e;
    close(found.q[0], angle - depth / lever, 1e-8);
    close(found.closed[0].force * lever, torque(found.q[0]), 1e-3);
    let closed = found.events.iter().find(|e| e.kind == EventKind::Close).unwrap();
    let speed = found.trajectory.state(0, closed.t).v;
    close(0.5 * inertia * speed * speed, m * G * d * ((0.9 + angle).cos() - (0.9f64 + 1.2).cos()), 1e-4);
    balanced(&found, 1e-5);
}

/// A free carrier with a slider that strikes its end: momentum stays, in both directions of the plane's motion.
#[test]
fn momentum_is_kept_on_a_free_carrier() {
    let text = "generic m(m)\ncart = (blo(x=6,y=3)) dif (blo(x=4,y=1) at (movx=1,movy=1))\nload = blo(x=1,y=1) at (movx=2,movy=1)\n\
                f = blo() at (movz=-9)\nattr f : frame = 1\nm = cart asb load asb f\n";
    let joints = [slide(0, 1.0, 0.0), slide(1, 1.0, 0.0)];
    let masses = vec![on_chain(1, 0.8, (2.5, 1.5), 0.1)];
    let forces = Forces { masses, ..Forces::none(2) };
    let bodies = chained(text, &[("cart", &joints[..1]), ("load", &joints)]);
    let machine = System::new(vec![free(2.0), at(free(0.0), 0.0, 1.5)], bodies, &[], 6.0).with_forces(forces);
    let found = push(&machine, law(), 40.0, 1e-7);
    let momentum = |v: &[f64]| 2.0 * v[0] + 0.8 * (v[0] + v[1]);
    close(momentum(&found.v), 0.8 * 1.5, 1e-5);
    assert!(found.events.iter().filter(|e| e.kind == EventKind::Close).count() >= 4, "{:?}", found.events);
    balanced(&found, 1e-5);
}
