//! A machine written in another unit of length moves the same: every tolerance is relative to its size.

mod common;

use common::examples::{RUNNING, shipped};
use mainspring_dynamics::{Options, Run, Simulation};
use mainspring_geometry::{Edge, Layer, Loop, Outline, Segment, Vec2};
use mainspring_mechanism::{Body, Coordinate, Forces, Joint, Mass, Mechanism, Motion, Stop, System};

fn outline(of: &Outline, by: f64) -> Outline {
    let at = |p: Vec2| p * by;
    let segment = |s: &Segment| match *s {
        Segment::Line { from, to } => Segment::Line { from: at(from), to: at(to) },
        Segment::Arc { from, to, center, radius, convex } => {
            Segment::Arc { from: at(from), to: at(to), center: at(center), radius: radius * by, convex }
        }
        Segment::Circle { center, radius, convex } => {
            Segment::Circle { center: at(center), radius: radius * by, convex }
        }
    };
    let edge = |e: &Edge| Edge { segment: segment(&e.segment), ..e.clone() };
    let layer = |l: &Layer| Layer {
        bottom: l.bottom * by,
        top: l.top * by,
        loops: l.loops.iter().map(|l| Loop { edges: l.edges.iter().map(edge).collect() }).collect(),
    };
    Outline { layers: of.layers.iter().map(layer).collect() }
}

fn body(of: &Body, by: f64) -> Body {
    let motion = |m: Motion| match m {
        Motion::Turn { center } => Motion::Turn { center: center * by },
        slide => slide,
    };
    let chain = of.chain.iter().map(|j| Joint { motion: motion(j.motion), ..*j }).collect();
    Body { name: of.name.clone(), chain, outline: outline(&of.outline, by) }
}

/// Does a coordinate turn? Then its position is an angle and its force a torque.
fn turns(system: &System, i: usize) -> bool {
    let joints = system.bodies.iter().flat_map(|b| &b.chain);
    joints.filter(|j| j.coordinate == i).any(|j| matches!(j.motion, Motion::Turn { .. }))
}

fn coordinate(c: &Coordinate, turns: bool, by: f64) -> Coordinate {
    // Lengths, and forces for the same accelerations, are `by` times as large; torques and moments of inertia by²
    // times.
    let (position, force, inertia) = if turns { (1.0, by * by, by * by) } else { (by, by, 1.0) };
    Coordinate {
        name: c.name.clone(),
        inertia: c.inertia * inertia,
        damping: c.damping * inertia,
        stiffness: c.stiffness * inertia,
        force: c.force * force,
        energy_at_zero: c.energy_at_zero * by * by,
        position: c.position * position,
        velocity: c.velocity * position,
    }
}

fn forces(system: &System, by: f64) -> Forces {
    let of = &system.forces;
    let each = |values: &[f64]| {
        values.iter().enumerate().map(|(i, x)| x * if turns(system, i) { by * by } else { by }).collect()
    };
    let stop = |s: &Stop| {
        let (limit, lever) = if turns(system, s.coordinate) { (1.0, by) } else { (by, 1.0) };
        Stop { limit: s.limit * limit, lever: s.lever * lever, ..*s }
    };
    let mass = |m: &Mass| Mass { center: m.center * by, inertia: m.inertia * by * by, ..*m };
    Forces {
        applied: each(&of.applied),
        coulomb: each(&of.coulomb),
        stops: of.stops.iter().map(stop).collect(),
        masses: of.masses.iter().map(mass).collect(),
        gravity: of.gravity * by,
        ..of.clone()
    }
}

/// The machine's system, and that of the same machine in a unit of length that is `by` times shorter.
fn both(machine: &Mechanism, by: f64) -> (System, System) {
    let system = machine.system().unwrap();
    let coordinates =
        system.coordinates.iter().enumerate().map(|(i, c)| coordinate(c, turns(&system, i), by)).collect();
    let bodies = system.bodies.iter().map(|b| body(b, by)).collect();
    let scaled = System::new(coordinates, bodies, &machine.exclusions(), system.size * by);
    let forces = forces(&system, by);
    (system, scaled.with_forces(forces))
}

fn run(system: &System) -> Run {
    let source = system.direct_search();
    let mut run = Simulation::new(system, &source, Options { until: 20.0, ..Options::default() });
    run.run(&mut |_| true);
    run.into_run()
}

/// Positions of all coordinates in the first unit.
fn positions(system: &System, run: &Run, t: f64, by: f64) -> Vec<f64> {
    let unit = |i: usize| if turns(system, i) { 1.0 } else { by };
    (0..system.coordinates.len()).map(|i| run.trajectory.state(i, t).q / unit(i)).collect()
}

/// Multiplying by a power of two loses no digit: the runs are the same to the last bit.
#[test]
fn a_unit_of_a_power_of_two_changes_no_bit() {
    for name in RUNNING {
        for by in [1024.0, 1.0 / 4096.0] {
            let (system, scaled) = both(&shipped(name, &[]), by);
            let (one, other) = (run(&system), run(&scaled));
            assert_eq!((one.status, one.t), (other.status, other.t), "{name:?}");
            assert_eq!(one.stats, other.stats, "{name:?}");
            assert_eq!(one.trajectory.times, other.trajectory.times, "{name:?}");
            for &t in &one.trajectory.times {
                assert_eq!(
                    positions(&system, &one, t, 1.0),
                    positions(&system, &other, t, by),
                    "{name:?} at {t}"
                );
            }
        }
    }
}

/// Metres or millimetres: the same motion to rounding, which blows magnify.
#[test]
fn a_unit_of_a_thousand_changes_next_to_nothing() {
    for name in RUNNING {
        for by in [1e3, 1e-3] {
            let (system, scaled) = both(&shipped(name, &[]), by);
            let (one, other) = (run(&system), run(&scaled));
            assert_eq!(one.status, other.status, "{name:?}");
            assert!((one.t - other.t).abs() < 1e-6, "{name:?}: {} {}", one.t, other.t);
            for t in (0..200).map(|k| f64::from(k) * 0.005 * one.t) {
                let (p, q) = (positions(&system, &one, t, 1.0), positions(&system, &other, t, by));
                for (p, q) in p.iter().zip(&q) {
                    assert!((p - q).abs() < 1e-6 * (1.0 + p.abs()), "{name:?} at {t}: {p} {q}");
                }
            }
            assert!((one.energy.friction * by * by / other.energy.friction - 1.0).abs() < 1e-6, "{name:?}");
        }
    }
}
