//! Stops of joints: blows, rest, letting go.

mod common;

use common::{balanced, bodies, close, coordinate, run, slide, turn};
use mainspring_dynamics::{Event, EventKind, Run, Status};
use mainspring_geometry::Vec2;
use mainspring_mechanism::{Coordinate, Forces, Mass, Stop, System};

fn stop(limit: f64, upper: bool, lever: f64) -> Stop {
    let side = if upper { -1.0 } else { 1.0 };
    Stop { coordinate: 0, bodies: (0, 1), upper, limit, lever, side }
}

fn block(c: Coordinate, stops: Vec<Stop>, force: f64) -> System {
    let text = "generic m(m)\na = blo()\nf = blo() at (movy=9)\nattr f : frame = 1\nm = a asb f\n";
    let bodies = bodies(text, &[("a", slide(0, 1.0, 0.0))]);
    let c = Coordinate { force: c.force + force, ..c };
    System::new(vec![c], bodies, &[], 10.0).with_forces(Forces {
        stops,
        applied: vec![force],
        ..Forces::none(1)
    })
}

fn of_kind(run: &Run, kind: EventKind) -> Vec<&Event> {
    run.events.iter().filter(|e| e.kind == kind).collect()
}

/// A constant force carries a block to its stop: t = √(2 m d/f), all its energy is lost, and it rests there.
#[test]
fn a_block_comes_to_rest_on_its_stop() {
    let (m, d, f) = (2.0, 1.5, 3.0);
    let found = run(&block(coordinate("a", m, 0.0, (0.0, 0.0)), vec![stop(d, true, 1.0)], f), 9.0, 1e-8);
    assert_eq!(found.status, Status::AtRest);
    close(found.t, (2.0 * m * d / f).sqrt(), 1e-12);
    close(found.q[0], d, 1e-12);
    close(found.closed[0].force, f, 1e-12);
    let blow = of_kind(&found, EventKind::Impact);
    assert_eq!((blow.len(), blow[0].bodies), (1, (0, 1)));
    close(blow[0].impulse, m * (2.0 * f * d / m).sqrt(), 1e-11);
    close(found.energy.impacts, f * d, 1e-11);
    close(found.energy.work, f * d, 1e-11);
    balanced(&found);
}

/// A sprung block with stops short of its amplitude: it loses its speed at the first and is brought back from there.
#[test]
fn an_oscillator_between_stops() {
    let (m, k) = (1.0, 4.0);
    let c = Coordinate { position: 1.0, ..coordinate("a", m, 0.0, (k, 0.0)) };
    let found = run(&block(c, vec![stop(-0.6, false, 1.0), stop(1.0, true, 1.0)], 0.0), 6.0, 1e-8);
    let w = (k / m).sqrt();
    let blow = of_kind(&found, EventKind::Impact);
    // A period later it just comes back to it, with no speed.
    assert!(blow[1..].iter().all(|b| b.impulse < 1e-6), "{blow:?}");
    let first = (-0.6f64).acos() / w;
    close(blow[0].t, first, 1e-12);
    // It leaves the stop at once and swings with the amplitude of the stop.
    for (t, tolerance) in [(first + 0.3, 1e-11), (4.0, 1e-11), (6.0, 1e-6)] {
        close(found.trajectory.state(0, t).q, -0.6 * (w * (t - first)).cos(), tolerance);
    }
    balanced(&found);
}

/// A block starts on its stop: pressed against it nothing happens, pulled off it goes.
#[test]
fn starts_at_a_stop() {
    let start = |f: f64| block(coordinate("a", 2.0, 0.0, (0.0, 0.0)), vec![stop(0.0, false, 1.0)], f);
    let pressed = run(&start(-1.0), 4.0, 1e-8);
    assert_eq!((pressed.status, pressed.t, pressed.q[0]), (Status::AtRest, 0.0, 0.0));
    close(pressed.closed[0].force, 1.0, 1e-13);
    let pulled = run(&start(1.0), 4.0, 1e-8);
    close(pulled.q[0], 4.0, 1e-12);
    assert!(of_kind(&pulled, EventKind::Impact).is_empty());
    balanced(&pulled);
}

/// A lever that gravity lets fall on its stop: its speed by energy, and the stop bears m g d sin θ over its lever.
#[test]
fn a_pendulum_falls_on_a_stop() {
    let (inertia, m, d, g, lever, angle) = (1.1, 0.9, 0.8, 9.81, 1.6, -0.4);
    let text = "generic m(m)\na = blo()\nf = blo() at (movz=9)\nattr f : frame = 1\nm = a asb f\n";
    let bodies = bodies(text, &[("a", turn(0, 0.0, 0.0))]);
    let c = Coordinate { position: 1.2, ..coordinate("a", inertia, 0.0, (0.0, 0.0)) };
    let center = Vec2::new(0.0, -d);
    let masses = vec![Mass { body: 0, mass: m, center, inertia: 0.0, chained: false }];
    let stops = vec![stop(angle, false, lever)];
    let forces = Forces { masses, gravity: Vec2::new(0.0, -g), stops, ..Forces::none(1) };
    let found = run(&System::new(vec![c], bodies, &[], 3.0).with_forces(forces), 20.0, 1e-10);
    let blow = of_kind(&found, EventKind::Impact)[0];
    let lost = m * g * d * (f64::cos(angle) - f64::cos(1.2));
    close(blow.impulse * lever, (2.0 * inertia * lost).sqrt(), 1e-8);
    close(found.trajectory.state(0, blow.t).q, angle, 1e-11);
    balanced(&found);
}
