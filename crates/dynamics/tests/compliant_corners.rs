//! As a corner passes a corner: depth and force stay continuous, and no force acts twice.

mod common;

use common::{bodies, close, coordinate, slide, turn};
use mainspring_dynamics::{Compliant, Contact, Mode, Options, Run, compliant_forces_at};
use mainspring_mechanism::{ContactLaw, Coordinate, System};

fn push(system: &System, until: f64, rtol: f64) -> Run {
    let source = system.direct_search();
    let options = Options { until, rtol, ..Options::default() };
    let mut run = Compliant::new(system, &source, ContactLaw::default(), options);
    run.run(&mut |_| true);
    run.into_run()
}

/// Sum of the contact forces on coordinate 0 at time `t`.
fn force(system: &System, run: &Run, t: f64) -> f64 {
    let n = system.coordinates.len();
    let states: Vec<_> = (0..n).map(|i| run.trajectory.state(i, t)).collect();
    let (q, v): (Vec<f64>, Vec<f64>) = states.iter().map(|s| (s.q, s.v)).unzip();
    let mode: &Mode = &run.modes[run.modes.partition_point(|m| m.from <= t) - 1];
    let Contact::Compliant(law) = run.contact else { panic!("compliant") };
    let closed = compliant_forces_at(system, &system.direct_search(), &law, mode, (&q, &v));
    closed.iter().map(|c| c.force).sum()
}

/// A rounded nose that a spring presses on a plate slides over the plate's corner and down its side: from edge to corner to
/// edge its force changes by no more than the motion between two instants makes it.
#[test]
fn a_nose_slides_over_a_corner() {
    let text = "generic m(m)\nplate = blo(x=4,y=2) at (movy=-2)\narm = (blo(x=0.6,y=6) at (movx=-0.3)) un (cyl(r=0.3))\n\
                f = blo() at (movz=-9)\nattr f : frame = 1\nm = arm asb plate asb f\n";
    let joints = [("arm", slide(0, 0.0, 1.0)), ("plate", slide(1, -1.0, 0.0))];
    let arm = Coordinate { position: 0.31, ..coordinate("arm", 1.0, 4.0, (30.0, -1.0)) };
    let plate = Coordinate { position: 3.0, velocity: 0.5, ..coordinate("plate", 1e4, 0.0, (0.0, 0.0)) };
    let system = System::new(vec![arm, plate], bodies(text, &joints), &[], 6.0);
    let found = push(&system, 4.0, 1e-7);
    // The corner passes the nose's lowest point at t = 2.
    let samples: Vec<f64> =
        (0..=4000).map(|k| force(&system, &found, 1.0 + 1e-3 * f64::from(k) * 0.5)).collect();
    let greatest = samples.iter().copied().fold(0.0, f64::max);
    let jump = samples.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
    assert!(greatest > 20.0 && jump < 0.1 * greatest, "greatest {greatest}, jump {jump}");
    assert!(found.energy.residual().abs() < 1e-5, "{:?}", found.energy);
    // Well before the corner the force is the spring's.
    close(force(&system, &found, 1.0), 30.0 * (found.trajectory.state(0, 1.0).q + 1.0), 0.2);
}

/// A square turns under a square: corner over edge, corner over corner, edge under corner.
#[test]
fn a_corner_passes_a_corner() {
    let text = "generic m(m)\nstar = (blo(x=2,y=2) at (movx=-1,movy=-1))\nblock = blo(x=3,y=1) at (movx=-1.7,movy=1.2)\n\
                f = blo() at (movz=-9)\nattr f : frame = 1\nm = star asb block asb f\n";
    let joints = [("star", turn(0, 0.0, 0.0)), ("block", slide(1, 0.0, 1.0))];
    for speed in [0.7, -0.7, 3.0] {
        let star = Coordinate { velocity: speed, ..coordinate("star", 1e4, 0.0, (0.0, 0.0)) };
        let block = coordinate("block", 0.5, 3.0, (20.0, -1.0));
        let system = System::new(vec![star, block], bodies(text, &joints), &[], 5.0);
        let runs = [1e-6, 1e-8].map(|rtol| push(&system, 6.0, rtol));
        close(runs[0].q[1], runs[1].q[1], 1e-4);
        let residual = runs[1].energy.residual();
        assert!(residual.abs() < 1e-6, "{residual:e}");
        // Nothing acts twice or throws the block off: it goes where rigid contact takes it, but for a rebound.
        let rigid = common::run(&system, 6.0, 1e-9);
        for k in 0..60 {
            let t = 0.1 * f64::from(k);
            close(runs[1].trajectory.state(1, t).q, rigid.trajectory.state(1, t).q, 5e-3);
        }
    }
}
