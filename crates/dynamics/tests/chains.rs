//! Parts on moving parts, and parts that gravity turns: independent references, closed forms, conservation.

mod common;

use common::{balanced, chained, close, coordinate, extrapolate, on_chain, run, slide, turn};
use mainspring_dynamics::{EventKind, Status};
use mainspring_geometry::Vec2;
use mainspring_mechanism::{Coordinate, Forces, Mass, System};
use std::f64::consts::TAU;

const G: f64 = 9.81;

fn down() -> Vec2 {
    Vec2::new(0.0, -G)
}

fn started(mut c: Coordinate, position: f64, velocity: f64) -> Coordinate {
    (c.position, c.velocity) = (position, velocity);
    c
}

fn free(name: &str, inertia: f64) -> Coordinate {
    coordinate(name, inertia, 0.0, (0.0, 0.0))
}

/// Parts that never meet: each in a layer of its own.
const APART: &str = "generic m(m)\na = blo(x=1)\nb = blo(x=1) at (movz=3)\nf = blo() at (movz=-9)\nattr f : frame = 1\n\
                     m = a asb b asb f\n";

/// A physical pendulum let go at any angle swings with the period 2π √(I/mgd) / agm(1, cos ½θ).
#[test]
fn a_pendulum_has_its_elliptic_period() {
    let (inertia, m, d) = (0.7, 1.3, 0.45);
    for angle in [0.01, 1.0, 2.5, 3.1] {
        let bodies = chained(APART, &[("a", &[turn(0, 0.2, 0.1)])]);
        let mass = Mass { body: 0, mass: m, center: Vec2::new(0.2, 0.1 - d), inertia: 0.0, chained: false };
        let forces = Forces { masses: vec![mass], gravity: down(), ..Forces::none(1) };
        let machine =
            System::new(vec![started(free("a", inertia), angle, 0.0)], bodies, &[], 1.0).with_forces(forces);
        let found = run(&machine, 9.0, 1e-11);
        assert_eq!(found.status, Status::Complete);
        let (mut a, mut b) = (1.0f64, (0.5 * angle).cos());
        for _ in 0..40 {
            (a, b) = (0.5 * (a + b), (a * b).sqrt());
        }
        let period = TAU * (inertia / (m * G * d)).sqrt() / a;
        let turns: Vec<f64> = found.minima.iter().map(|m| m.t).collect();
        assert_eq!(turns.len(), (9.0 / (0.5 * period)) as usize);
        for (n, t) in turns.iter().enumerate() {
            close(*t, 0.5 * period * (n + 1) as f64, 1e-8);
            close(found.trajectory.state(0, *t).q.abs(), angle, 1e-9);
        }
        assert!(found.energy.residual().abs() < 1e-9, "{}", found.energy.residual());
    }
}

/// Two point masses on two massless rods; the second angle is told against the first rod.
fn double_pendulum(start: [f64; 2]) -> (System, impl Fn(f64, &[f64]) -> Vec<f64>) {
    let (m, l) = ([1.1, 0.7], [0.9, 0.6]);
    let joints = [turn(0, 0.0, 0.0), turn(1, 0.0, -l[0])];
    let bodies = chained(APART, &[("a", &joints[..1]), ("b", &joints)]);
    let first = Mass { body: 0, mass: m[0], center: Vec2::new(0.0, -l[0]), inertia: 0.0, chained: false };
    let masses = vec![first, on_chain(1, m[1], (0.0, -l[0] - l[1]), 0.0)];
    let forces = Forces { masses, gravity: down(), ..Forces::none(2) };
    let coordinates =
        vec![started(free("a", m[0] * l[0] * l[0]), start[0], 0.0), started(free("b", 0.0), start[1], 0.0)];
    let system = System::new(coordinates, bodies, &[], 1.5).with_forces(forces);
    // In angles against the vertical, from the Lagrangian of the textbooks.
    let rate = move |_: f64, y: &[f64]| {
        let (d, m2) = (y[0] - y[1], m[1]);
        let (s, c) = d.sin_cos();
        let a11 = (m[0] + m2) * l[0];
        let a12 = m2 * l[1] * c;
        let b1 = -m2 * l[1] * y[3] * y[3] * s - (m[0] + m2) * G * y[0].sin();
        let (a21, a22, b2) = (l[0] * c, l[1], l[0] * y[2] * y[2] * s - G * y[1].sin());
        let det = a11 * a22 - a12 * a21;
        vec![y[2], y[3], (b1 * a22 - a12 * b2) / det, (a11 * b2 - a21 * b1) / det]
    };
    (system, rate)
}

#[test]
fn a_double_pendulum_follows_an_independent_reference() {
    for start in [[0.3, 0.5], [1.2, -0.7], [2.0, 1.0]] {
        let (machine, rate) = double_pendulum(start);
        let found = run(&machine, 4.0, 1e-12);
        assert_eq!(found.status, Status::Complete);
        let mut y = vec![start[0], start[0] + start[1], 0.0, 0.0];
        for k in 0..8 {
            let (from, to) = (0.5 * f64::from(k), 0.5 * f64::from(k + 1));
            y = extrapolate(&rate, (from, to), &y, 200);
            let (a, b) = (found.trajectory.state(0, to), found.trajectory.state(1, to));
            close(a.q, y[0], 1e-8);
            close(a.q + b.q, y[1], 1e-8);
            close(a.v, y[2], 1e-7);
            close(a.v + b.v, y[3], 1e-7);
        }
        assert!(found.energy.residual().abs() < 1e-9, "{:e}", found.energy.residual());
        assert_eq!(found.energy.work, 0.0);
    }
}

/// A cart free on rails carries a sprung block and a lever that strikes it, again and again: what acts between them
/// changes the cart's motion, never the momentum of all.
#[test]
fn momentum_of_parts_on_a_free_carrier_stays() {
    let text = "generic m(m)\ncart = blo(x=20,y=1,z=0.5) at (movy=-3)\nblock = blo(x=2,y=2)\n\
                lever = blo(x=1,y=4) at (movx=3, movy=1)\nf = blo() at (movy=50)\nattr f : frame = 1\n\
                m = cart asb block asb lever asb f\n";
    let joints = [slide(0, 1.0, 0.0), slide(1, 1.0, 0.0), turn(2, 3.0, 4.0)];
    let bodies = chained(
        text,
        &[("cart", &joints[..1]), ("block", &[joints[0], joints[1]]), ("lever", &[joints[0], joints[2]])],
    );
    let (cart, block, lever, about) = (5.0, 1.5, 0.8, 0.9);
    let coordinates = vec![
        started(free("cart", cart), 0.0, 0.4),
        started(coordinate("block", 0.0, 0.0, (9.0, 0.0)), -1.5, 6.0),
        started(coordinate("lever", 0.0, 0.0, (2.0, 0.2)), 0.0, 0.3),
    ];
    let place = |name: &str| bodies.iter().position(|b| b.name == name).unwrap();
    let center = (3.0, 2.0);
    let masses = vec![
        on_chain(place("block"), block, (0.0, 0.0), 0.0),
        on_chain(place("lever"), lever, center, about),
    ];
    let forces = Forces { masses, ..Forces::none(3) };
    let machine = System::new(coordinates, bodies, &[], 20.0).with_forces(forces);
    let found = run(&machine, 12.0, 1e-10);
    assert!(found.stats.impacts >= 3, "{:?}", found.stats);
    balanced(&found);
    let momentum = |q: &[f64], v: &[f64]| {
        // The lever's centre hangs 2 below its pin: it moves along x by 2 cos q₂ times the turning.
        (cart + block + lever) * v[0] + block * v[1] + lever * 2.0 * q[2].cos() * v[2]
    };
    let at = |t: f64| {
        let states: Vec<_> = (0..3).map(|i| found.trajectory.state(i, t)).collect();
        momentum(
            &states.iter().map(|s| s.q).collect::<Vec<_>>(),
            &states.iter().map(|s| s.v).collect::<Vec<_>>(),
        )
    };
    for k in 0..=240 {
        close(at(0.05 * f64::from(k)), at(0.0), 1e-8);
    }
}

/// A pawl pinned to a plate, its nose pressed outwards by a spring into twelve undercut saw teeth of a fixed rim. The
/// plate has friction and feels about the torque told.
fn pawl_in_rim(torque: f64) -> System {
    let text = "generic m(m)\nnotch = blo(x=4,y=2) at (movy=-2, degz=-35, movy=5.8)\n\
                rim = cyl(r=7) dif (cyl(r=5) un SYMMETRIC_UNION(notch, z, ROTATIONAL, 12, 360))\n\
                plate = cyl(r=4) at (movz=-2)\n\
                pawl = (blo(x=4.0697,y=0.4) at (movy=-0.2)) un (cyl(r=0.2) at (movx=4.0697)) at (degz=132.5104, movx=3, movy=2.4)\n\
                attr rim : frame = 1\nm = rim asb plate asb pawl\n";
    let text = text.replace("pawl = (blo", "pawl = ((blo").replace("(movx=4.0697)) at", "(movx=4.0697))) at");
    let (plate, pawl) = (turn(0, 0.0, 0.0), turn(1, 3.0, 2.4));
    let bodies = chained(&text, &[("plate", &[plate]), ("pawl", &[plate, pawl])]);
    let masses = vec![on_chain(2, 0.5, (1.6, 3.9), 0.7)];
    let spring = (1e-6, torque / 1e-6);
    let pawl = started(coordinate("pawl", 0.0, 0.3, (4.0, -0.7)), 0.05, 0.0);
    let coordinates = vec![coordinate("plate", 3.0, 2.0, spring), pawl];
    System::new(coordinates, bodies, &[], 14.0).with_forces(Forces { masses, ..Forces::none(2) })
}

/// One way the nose slides over tooth after tooth; the other way a tooth's face holds it.
#[test]
fn a_pawl_on_a_turning_plate_ratchets_one_way() {
    let machine = pawl_in_rim(-6.0);
    let found = run(&machine, 8.0, 1e-9);
    assert_eq!(found.status, Status::Complete);
    balanced(&found);
    let teeth = found.q[0] / (TAU / 12.0);
    let falls = found.events.iter().filter(|e| e.kind == EventKind::Impact).count();
    assert!(teeth < -11.0 && falls as f64 > -teeth, "{teeth} {falls}");
    let blocked = run(&pawl_in_rim(6.0), 60.0, 1e-9);
    assert_eq!(blocked.status, Status::AtRest, "{} {:?}", blocked.t, blocked.q);
    assert!(blocked.q[0].abs() < TAU / 12.0);
    // The friction of neither moves it: the face carries the torque on the plate.
    assert!(blocked.closed.iter().any(|c| c.active));
    balanced(&blocked);
}
