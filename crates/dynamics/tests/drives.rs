//! Prescribed motion: constant speed and tables, what they push, and the work that takes.

mod common;

use common::{balanced, bodies, chained, close, coordinate, extrapolate, on_chain, run, slide, turn};
use mainspring_dynamics::{EventKind, Options, Simulation, Status};
use mainspring_geometry::Vec2;
use mainspring_mechanism::{Coordinate, Drive, Forces, Joint, Mass, System, Table};

fn free(name: &str, inertia: f64) -> Coordinate {
    coordinate(name, inertia, 0.0, (0.0, 0.0))
}

fn speed(start: f64, speed: f64) -> Option<Drive> {
    Some(Drive::Speed { start, speed })
}

fn two_sliders(coordinates: Vec<Coordinate>, apart: f64, drives: Vec<Option<Drive>>) -> System {
    let text = format!(
        "generic m(m)\na = blo(x=2,y=1) at (movx=-2)\nb = blo(x=2,y=1) at (movx={apart})\n\
         f = blo(x=1,y=1) at (movx=9)\nattr f : frame = 1\nm = a asb b asb f\n"
    );
    let bodies = bodies(&text, &[("a", slide(0, 1.0, 0.0)), ("b", slide(1, 1.0, 0.0))]);
    System::new(coordinates, bodies, &[], 10.0).with_forces(Forces { drives, ..Forces::none(2) })
}

/// A wheel driven against its spring and friction: q = q₀ + ω t, the drive does h ω² t + Δ(½ k (q − x)²).
#[test]
fn a_driven_wheel_takes_the_work_of_spring_and_friction() {
    let (h, k, x, w) = (0.7, 3.0, 0.4, -1.5);
    let bodies = bodies(
        "generic m(m)\na = blo()\nf = blo() at (movy=9)\nattr f : frame = 1\nm = a asb f\n",
        &[("a", turn(0, 0.0, 0.0))],
    );
    let c = Coordinate { velocity: w, ..coordinate("a", 2.0, h, (k, x)) };
    let forces = Forces { drives: vec![speed(0.0, w)], ..Forces::none(1) };
    let found = run(&System::new(vec![c], bodies, &[], 2.0).with_forces(forces), 3.0, 1e-8);
    assert_eq!(found.status, Status::Complete);
    close(found.q[0], -4.5, 1e-14);
    close(found.energy.friction, h * w * w * 3.0, 1e-12);
    close(found.energy.work, h * w * w * 3.0 + 0.5 * k * ((4.9f64).powi(2) - 0.16), 1e-11);
    balanced(&found);
}

/// A table between two points is q = L (3 s² − 2 s³): ∫ q̇² dt = 6/5 L²/T, and inertia gives back what it took.
#[test]
fn a_table_moves_a_part_and_leaves_it_at_rest() {
    let (h, length, time) = (0.9, 4.0, 2.0);
    let table = Drive::Table(Table::new(&[(0.5, 0.0), (0.5 + time, length)]));
    let machine =
        two_sliders(vec![coordinate("a", 3.0, h, (0.0, 0.0)), free("b", 1.0)], 6.0, vec![Some(table), None]);
    let found = run(&machine, 9.0, 1e-8);
    assert_eq!(found.status, Status::AtRest);
    close(found.t, 2.5, 1e-12);
    for s in [0.0, 0.2, 0.5, 0.9, 1.0] {
        close(found.trajectory.state(0, 0.5 + time * s).q, length * s * s * (3.0 - 2.0 * s), 1e-12);
    }
    let lost = h * 1.2 * length * length / time;
    close(found.energy.friction, lost, 1e-12);
    close(found.energy.work, lost, 1e-11);
    balanced(&found);
}

/// A driven part meets a free one: the impulse m u takes m u² from the drive, half of it lost; then it is pushed along
/// at speed u against its spring.
#[test]
fn an_impact_of_a_driven_part_and_the_push_after_it() {
    let (m, k, u, apart) = (1.7, 4.0, 1.25, 0.5);
    let machine = two_sliders(
        vec![free("a", 5.0), coordinate("b", m, 0.0, (k, 0.0))],
        apart,
        vec![speed(0.0, u), None],
    );
    let found = run(&machine, 2.0, 1e-8);
    assert_eq!(found.status, Status::Complete);
    let hit: Vec<_> = found.events.iter().filter(|e| e.kind == EventKind::Impact).collect();
    assert_eq!(hit.len(), 1);
    close(hit[0].t, apart / u, 1e-12);
    close(hit[0].impulse, m * u, 1e-12);
    let pushed = u * 2.0 - apart;
    close(found.q[1], pushed, 1e-12);
    close(found.energy.impacts, 0.5 * m * u * u, 1e-12);
    close(found.energy.work, m * u * u + 0.5 * k * pushed * pushed, 1e-9);
    balanced(&found);
}

/// A drive cannot push what cannot give way: the run ends as jammed, where it met it.
#[test]
fn a_drive_against_the_frame_is_jammed() {
    let machine = two_sliders(vec![free("a", 5.0), free("b", 1.0)], 2.0, vec![speed(0.0, 1.0), None]);
    let found = run(&machine, 20.0, 1e-8);
    assert_eq!(found.status, Status::Jammed);
    // a meets b after 2, b meets the frame after 5 more.
    close(found.t, 7.0, 1e-12);
}

/// An eccentric disc at constant speed under a sprung flat follower: x = r + e sin ωt as long as they touch.
#[test]
fn a_cam_lifts_its_follower() {
    let (r, e, w, m, k) = (1.0, 0.3, 2.0, 0.5, 6.0);
    let text = "generic m(m)\ncam = cyl(r=1) at (movx=0.3)\nfollower = blo(x=4,y=0.5) at (movx=-2,movy=1)\n\
                f = blo() at (movy=20)\nattr f : frame = 1\nm = cam asb follower asb f\n";
    let joints = [("cam", turn(0, 0.0, 0.0)), ("follower", slide(1, 0.0, 1.0))];
    let coordinates = vec![
        Coordinate { velocity: w, ..coordinate("cam", 2.0, 0.4, (0.0, 0.0)) },
        Coordinate { velocity: e * w, ..coordinate("follower", m, 0.2, (k, -1.0)) },
    ];
    let machine = System::new(coordinates, bodies(text, &joints), &[], 4.0)
        .with_forces(Forces { drives: vec![speed(0.0, w), None], ..Forces::none(2) });
    let found = run(&machine, 10.0, 1e-9);
    assert_eq!(found.status, Status::Complete);
    for n in 0..=100 {
        let t = 0.1 * f64::from(n);
        close(found.trajectory.state(1, t).q, r - 1.0 + e * (w * t).sin(), 1e-8);
    }
    assert!(found.events.iter().all(|event| event.kind != EventKind::Release));
    balanced(&found);
}

/// A pendulum on a carriage that a table moves: θ̈ = −(g sin θ + a cos θ)/l, and the carriage takes work.
#[test]
fn a_pendulum_on_a_driven_carriage() {
    let (m, l, g) = (0.8, 0.7, 9.81);
    let text = "generic m(m)\na = blo(x=1)\nb = blo(x=1) at (movz=3)\nf = blo() at (movz=-9)\n\
                attr f : frame = 1\nm = a asb b asb f\n";
    let joints: [Joint; 2] = [slide(0, 1.0, 0.0), turn(1, 0.0, 0.0)];
    let bodies = chained(text, &[("a", &joints[..1]), ("b", &joints)]);
    let table = Drive::Table(Table::new(&[(0.0, 0.0), (0.8, 0.5), (1.4, 1.2), (3.0, -0.4)]));
    let masses: Vec<Mass> = vec![on_chain(1, m, (0.0, -l), 0.0)];
    let forces = Forces {
        masses,
        gravity: Vec2::new(0.0, -g),
        drives: vec![Some(table.clone()), None],
        ..Forces::none(2)
    };
    let machine = System::new(vec![free("a", 2.0), free("b", 0.0)], bodies, &[], 2.0).with_forces(forces);
    let found = run(&machine, 4.0, 1e-11);
    let knots = [0.0, 0.8, 1.4, 3.0, 4.0];
    let rate = |t: f64, y: &[f64]| vec![y[1], -(g * y[0].sin() + table.at(t).a * y[0].cos()) / l];
    let mut y = vec![0.0, 0.0];
    for w in knots.windows(2) {
        // The acceleration just before a knot is that of the piece: stay inside it.
        y = extrapolate(|t, y| rate(t.min(w[1] - 1e-12), y), (w[0], w[1]), &y, 100);
        close(found.trajectory.state(1, w[1]).q, y[0], 1e-8);
        close(found.trajectory.state(1, w[1]).v, y[1], 1e-8);
    }
    assert!(found.energy.work > 0.1 && found.energy.residual().abs() < 1e-8, "{:?}", found.energy);
}

/// Runs do not depend on how they are cut: stopped after every step or not.
#[test]
fn driven_runs_repeat_exactly() {
    let machine = two_sliders(
        vec![free("a", 5.0), coordinate("b", 1.0, 0.0, (40.0, 0.0))],
        0.5,
        vec![speed(0.0, 1.0), None],
    );
    let source = machine.direct_search();
    let once = || {
        let mut run = Simulation::new(&machine, &source, Options { until: 2.0, ..Options::default() });
        run.run(&mut |_| true);
        {
            let run = run.into_run();
            (run.q, run.energy)
        }
    };
    assert_eq!(once(), once());
}
