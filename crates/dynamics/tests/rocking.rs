//! A flat follower, pressed by a spring onto the side of a square that turns about its middle, rocks to rest on it:
//! from corner to corner in ever shorter times. It once passed through the square: one corner let go as the faces came
//! to lie flat, and the other, which by then overlapped by what integration leaves, was not found; or it rocked for ever
//! at one instant, since a corner that turns flush let go before the next one had closed.

mod common;

use common::{Random, coordinate, overlap, slide, system, turn};
use mainspring_dynamics::{Options, Run, Simulation, Status};
use mainspring_mechanism::{Coordinate, System};

const PARTS: &str = "generic m(m)\nwheel = blo(x=2,y=2) at (movx=-1,movy=-1)\n\
    follower = blo(x=1,y=8) at (movx=1,movy=-4)\nbase = blo() at (movy=50)\nattr base : frame = 1\n\
    m = wheel asb follower asb base\n";
const TORQUE: f64 = 6.0;
const SPRING: f64 = 10.0;
const RELAXED: f64 = -3.0;

fn machine(wheel: f64, follower: f64) -> System {
    let w = Coordinate { force: TORQUE, velocity: wheel, ..coordinate("wheel", 5.0, 2.0, (0.0, 0.0)) };
    let f = Coordinate { velocity: follower, ..coordinate("follower", 1.0, 0.3, (SPRING, RELAXED)) };
    system(vec![w, f], PARTS, &[("wheel", turn(0, 0.0, 0.0)), ("follower", slide(1, 1.0, 0.0))], 4.0)
}

fn run(m: &System, rtol: f64) -> Run {
    let source = m.direct_search();
    let mut run = Simulation::new(m, &source, Options { until: 200.0, rtol, max_steps: 20_000 });
    run.run(&mut |_| true);
    run.into_run()
}

/// At rest on a whole face: statics give both forces.
fn check_rest(run: &Run, about: &str) {
    assert_eq!(run.status, Status::AtRest, "{about}: {:?} at {}", run.status, run.t);
    assert_eq!(run.closed.len(), 2, "{about}: {:?}", run.closed);
    let quarter = run.q[0].rem_euclid(std::f64::consts::FRAC_PI_2);
    assert!(quarter.min(std::f64::consts::FRAC_PI_2 - quarter) < 1e-7, "{about}: {:?}", run.q);
    assert!(run.q[1].abs() < 1e-7, "{about}: {:?}", run.q);
    let mut forces: Vec<f64> = run.closed.iter().map(|c| c.force).collect();
    forces.sort_by(f64::total_cmp);
    let press = -SPRING * RELAXED;
    assert!((forces[0] - 0.5 * (press - TORQUE)).abs() < 1e-4, "{about}: {forces:?}");
    assert!((forces[1] - 0.5 * (press + TORQUE)).abs() < 1e-4, "{about}: {forces:?}");
}

#[test]
fn rocking_dies_out() {
    let mut random = Random(3);
    for _ in 0..300 {
        let (w, f) = (random.next(-4.0, 4.0), random.next(-4.0, 2.0));
        let m = machine(w, f);
        let run = run(&m, 1e-8);
        let about = format!("wheel {w}, follower {f}");
        assert!(overlap::deepest(&m, &run, 5).0 < 1e-6, "{about} passed through");
        check_rest(&run, &about);
    }
}

#[test]
fn rocking_dies_out_at_any_tolerance() {
    let mut random = Random(5);
    for rtol in [1e-2, 1e-4, 1e-6, 1e-10, 1e-12] {
        for _ in 0..20 {
            let (w, f) = (random.next(-4.0, 4.0), random.next(-4.0, 2.0));
            let m = machine(w, f);
            let run = run(&m, rtol);
            let about = format!("rtol {rtol}, wheel {w}, follower {f}");
            assert!(overlap::deepest(&m, &run, 5).0 < 1e-5, "{about} passed through");
            check_rest(&run, &about);
        }
    }
}
