//! Dry friction: sliding and stopping, sticking, what is pushed while stuck, letting go.

mod common;

use common::{balanced, chained, close, coordinate, extrapolate, on_chain, run, slide, turn};
use mainspring_dynamics::Status;
use mainspring_geometry::Vec2;
use mainspring_mechanism::{Coordinate, Drive, Forces, Joint, System};

/// Blocks in a row that nothing drives.
fn row(gap: f64, blocks: &[(Coordinate, f64, f64)]) -> System {
    common::row(gap, blocks, vec![None; blocks.len()])
}

fn mass(m: f64) -> Coordinate {
    coordinate("b", m, 0.0, (0.0, 0.0))
}

fn moving(c: Coordinate, position: f64, velocity: f64) -> Coordinate {
    Coordinate { position, velocity, ..c }
}

/// t = m v/T, x = m v²/2T, and all its energy is friction's.
#[test]
fn a_sliding_block_stops_and_stays() {
    let (m, v, size) = (2.0, -3.0, 1.2);
    let found = run(&row(1.0, &[(moving(mass(m), 0.0, v), size, 0.0)]), 50.0, 1e-8);
    assert_eq!(found.status, Status::AtRest);
    close(found.t, m * 3.0 / size, 1e-12);
    close(found.q[0], -m * 9.0 / (2.0 * size), 1e-12);
    close(found.energy.friction, 9.0, 1e-12);
    balanced(&found);
}

/// Below the limit it stays for ever; above, it moves off at once with what is left.
#[test]
fn a_block_sticks_up_to_the_limit() {
    for force in [0.0, 0.99, -0.99, 1.0] {
        let found = run(&row(1.0, &[(mass(2.0), 1.0, force)]), 5.0, 1e-8);
        assert_eq!((found.status, found.t, found.q[0]), (Status::AtRest, 0.0, 0.0), "{force}");
    }
    let found = run(&row(1.0, &[(mass(2.0), 1.0, -1.5)]), 4.0, 1e-8);
    close(found.q[0], -0.5 * 0.25 * 16.0, 1e-12);
    close(found.energy.work, 1.5 * 2.0, 1e-12);
    balanced(&found);
    // A spring just too weak, and just strong enough.
    let sprung = |x: f64| moving(coordinate("b", 2.0, 0.0, (4.0, 0.0)), x, 0.0);
    let weak = run(&row(1.0, &[(sprung(0.249), 1.0, 0.0)]), 5.0, 1e-8);
    assert_eq!((weak.status, weak.t), (Status::AtRest, 0.0));
    let strong = run(&row(1.0, &[(sprung(0.251), 1.0, 0.0)]), 5.0, 1e-8);
    close(strong.q[0], 0.249, 1e-12);
    balanced(&strong);
}

/// Half-swings about ± T/k in turn, each shorter by 2 T/k, until the spring no longer overcomes the friction.
#[test]
fn an_oscillator_loses_four_limits_a_cycle() {
    let (m, k, size, x0) = (1.5, 6.0, 0.9, 1.0);
    let found =
        run(&row(1.0, &[(moving(coordinate("b", m, 0.0, (k, 0.0)), x0, 0.0), size, 0.0)]), 90.0, 1e-8);
    assert_eq!(found.status, Status::AtRest);
    let half = std::f64::consts::PI * (m / k).sqrt();
    let (mut x, mut n) = (x0, 0);
    while k * x.abs() > size {
        x = -x + x.signum() * 2.0 * size / k;
        n += 1;
        let turn = found.trajectory.state(0, half * f64::from(n));
        close(turn.q, x, 1e-11);
        close(turn.v, 0.0, 1e-10);
    }
    close(found.t, half * f64::from(n), 1e-10);
    close(found.energy.friction, 0.5 * k * (x0 * x0 - x * x), 1e-11);
    balanced(&found);
}

/// With viscous friction as well, sliding flights stay closed forms: v = (v₀ + T/h) e^(−ht/m) − T/h.
#[test]
fn viscous_and_dry_friction_together() {
    let (m, h, size, v) = (2.0, 0.6, 0.5, 4.0);
    let found = run(&row(1.0, &[(moving(coordinate("b", m, h, (0.0, 0.0)), 0.0, v), size, 0.0)]), 50.0, 1e-8);
    assert_eq!(found.status, Status::AtRest);
    close(found.t, m / h * (1.0 + h * v / size).ln(), 1e-10);
    balanced(&found);
}

/// Blocks that touch stick together up to the sum of their limits, and move off as one.
#[test]
fn chains_of_stuck_blocks() {
    let push =
        |force: f64| row(0.0, &[(mass(1.0), 0.5, force), (mass(2.0), 0.7, 0.0), (mass(0.5), 0.3, 0.0)]);
    for force in [0.4, 0.6, 1.1, 1.3, 1.499] {
        let found = run(&push(force), 5.0, 1e-8);
        assert_eq!((found.status, found.t), (Status::AtRest, 0.0), "{force}");
    }
    let found = run(&push(2.0), 2.0, 1e-8);
    for q in &found.q {
        close(*q, 0.5 * (2.0 - 1.5) / 3.5 * 4.0, 1e-9);
    }
    balanced(&found);
    // Pulled apart: only the first goes, once its own limit is passed.
    let found = run(&push(-0.8), 2.0, 1e-8);
    close(found.q[0], -0.5 * 0.3 * 4.0, 1e-12);
    assert_eq!((found.q[1], found.q[2]), (0.0, 0.0));
    balanced(&found);
}

/// A block strikes a stuck one: dry friction has no share in the blow, then brings both to a stop.
#[test]
fn a_blow_on_a_stuck_block() {
    let (m1, m2, v, t1, t2) = (2.0, 3.0, 2.5, 0.0, 0.8);
    let machine = row(1.0, &[(moving(mass(m1), 0.0, v), t1, 0.0), (mass(m2), t2, 0.0)]);
    let found = run(&machine, 50.0, 1e-8);
    assert_eq!(found.status, Status::AtRest);
    let u = m1 * v / (m1 + m2);
    // The first has no friction: it pushes on, and both stop together.
    close(found.t, 1.0 / v + (m1 + m2) * u / t2, 1e-9);
    close(found.energy.friction, 0.5 * (m1 + m2) * u * u, 1e-9);
    balanced(&found);
}

/// A block on a beam that a drive turns up slowly: it slides when m g sin θ − m r ω² passes T, then as an independent
/// integration says.
#[test]
fn a_block_lets_go_on_a_rising_beam() {
    let (m, g, size, w, r) = (1.3, 9.81, 4.0, 0.2, 2.0);
    let text = "generic m(m)\nbeam = blo(x=9,y=1) at (movy=-1)\nblock = blo() at (movx=1.5,movz=3)\nf = blo() at (movz=-9)\n\
                attr f : frame = 1\nm = beam asb block asb f\n";
    let joints = [turn(0, 0.0, 0.0), slide(1, 1.0, 0.0)];
    let bodies = chained(text, &[("beam", &joints[..1]), ("block", &joints)]);
    let forces = Forces {
        masses: vec![on_chain(1, m, (r, 0.0), 0.1)],
        gravity: Vec2::new(0.0, -g),
        drives: vec![Some(Drive::Speed { start: 0.0, speed: w }), None],
        coulomb: vec![0.0, size],
        ..Forces::none(2)
    };
    let beam = Coordinate { velocity: w, ..mass(4.0) };
    let machine = System::new(vec![beam, mass(0.0)], bodies, &[], 10.0).with_forces(forces);
    let released = ((size / m + r * w * w) / g).asin() / w;
    let found = run(&machine, released + 0.6, 1e-10);
    assert_eq!(found.trajectory.state(1, released - 1e-6).v, 0.0);
    assert!(found.trajectory.state(1, released + 1e-3).v < 0.0);
    let rate = |t: f64, y: &[f64]| vec![y[1], (r + y[0]) * w * w - g * (w * t).sin() + size / m];
    let y = extrapolate(rate, (released, released + 0.6), &[0.0, 0.0], 40);
    close(found.q[1], y[0], 1e-9);
    close(found.v[1], y[1], 1e-9);
    balanced(&found);
}

/// A follower on a cam carries a block held by dry friction: it slides where m e ω² |sin ωt| passes T.
#[test]
fn a_stuck_block_on_a_follower_lets_go() {
    let (e, w, m, size) = (0.3, 2.0, 0.5, 0.4);
    let text = "generic m(m)\ncam = cyl(r=1) at (movx=0.3)\nfollower = blo(x=4,y=0.5) at (movx=-2,movy=1)\n\
                block = blo() at (movz=5)\nf = blo() at (movy=20)\nattr f : frame = 1\n\
                m = cam asb follower asb block asb f\n";
    let joints = [turn(0, 0.0, 0.0), slide(1, 0.0, 1.0), slide(2, 0.0, 1.0)];
    let chains: [(&str, &[Joint]); 3] =
        [("cam", &joints[..1]), ("follower", &joints[1..2]), ("block", &joints[1..])];
    let coordinates = vec![
        Coordinate { velocity: w, ..mass(2.0) },
        Coordinate { velocity: e * w, ..coordinate("follower", 1.0, 0.0, (20.0, -1.0)) },
        mass(0.0),
    ];
    let forces = Forces {
        masses: vec![on_chain(2, m, (0.5, 0.5), 0.1)],
        drives: vec![Some(Drive::Speed { start: 0.0, speed: w }), None, None],
        coulomb: vec![0.0, 0.0, size],
        ..Forces::none(3)
    };
    let machine = System::new(coordinates, chained(text, &chains), &[], 4.0).with_forces(forces);
    let released = (size / (m * e * w * w)).asin() / w;
    let found = run(&machine, 3.0, 1e-9);
    assert_eq!(found.status, Status::Complete);
    assert_eq!(found.trajectory.state(2, released - 1e-6).v, 0.0);
    assert!(found.trajectory.state(2, released + 1e-3).v > 0.0);
    // Slides with the constant force against it: its own motion is y = x + q, ÿ = −T/m.
    let t = released + 0.1;
    let own = |t: f64| e * (w * t).sin() + found.trajectory.state(2, t).q;
    let v0 = e * w * (w * released).cos();
    close(own(t), e * (w * released).sin() + v0 * 0.1 - 0.5 * size / m * 0.01, 1e-8);
    balanced(&found);
}
