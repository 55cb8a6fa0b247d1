//! A pin in a groove with little play or none: both faces touch it for all time, one of them carries it, and it passes
//! through neither.

mod common;

use common::examples::example;
use common::{balanced, close, coordinate, extrapolate, overlap, slide, system, turn};
use mainspring_dynamics::{Options, Run, Simulation, Status};
use mainspring_mechanism::System;

const UNTIL: f64 = 20.0;
const DEPTH: f64 = 10.0;
const PLAYS: [f64; 14] =
    [0.0, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 2e-9, 3e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-3];

fn rocker(set: &[(&str, f64)]) -> System {
    example(("rotary-to-reciprocating", "rotary-to-reciprocating"), set)
}

fn run(system: &System, rtol: f64) -> Run {
    let source = system.direct_search();
    let mut run = Simulation::new(system, &source, Options { until: UNTIL, rtol, max_steps: 10_000 });
    run.run(&mut |_| true);
    let run = run.into_run();
    overlap::assert_free(system, &run);
    run
}

/// The arm's lean φ with its first two derivatives by the wheel's direction: the middle of the groove runs through the pin.
fn lean(crank: f64, wheel: f64) -> [f64; 3] {
    let (sin, cos) = wheel.sin_cos();
    let square = crank * crank + DEPTH * DEPTH + 2.0 * crank * DEPTH * sin;
    let first = (crank * crank + crank * DEPTH * sin) / square;
    let second = crank * DEPTH * cos * (1.0 - 2.0 * first) / square;
    [-(crank * cos).atan2(DEPTH + crank * sin), first, second]
}

/// The machine without play has one freedom, the wheel's: `(I + J φ′²) θ̈ = k (θ₀ − θ) − (h + η φ′²) θ̇ − J φ′ φ″ θ̇²`.
/// Returns its angle and speed at the end.
fn one_freedom(crank: f64, start: f64) -> Vec<f64> {
    let rate = |_: f64, y: &[f64]| {
        let [_, first, second] = lean(crank, start + y[0]);
        let force = 0.1 * (100_000f64.to_radians() - y[0]) - (60.0 + 10.0 * first * first) * y[1];
        vec![y[1], (force - 100.0 * first * second * y[1] * y[1]) / (60.0 + 100.0 * first * first)]
    };
    extrapolate(rate, (0.0, UNTIL), &[0.0, 0.0], 400)
}

/// By how much the motion at the end is off that without play.
fn off(found: &Run, crank: f64, start: f64, exact: &[f64]) -> f64 {
    let [now, slope, _] = lean(crank, start + exact[0]);
    let arm = now - lean(crank, start)[0];
    let wheel = (found.q[0] - exact[0]).abs().max((found.v[0] - exact[1]).abs());
    wheel.max((found.q[1] - arm).abs()).max((found.v[1] - slope * exact[1]).abs())
}

/// Whatever the play, the motion is that of one freedom to the play and the tolerance, and takes little work.
#[test]
fn motion_tends_to_that_without_play() {
    let exact = one_freedom(3.0, 0.0);
    for play in PLAYS {
        let found = run(&rocker(&[("play", play)]), 1e-10);
        assert_eq!(found.status, Status::Complete);
        let off = off(&found, 3.0, 0.0, &exact);
        assert!(off < 3e-8 + 3.0 * play, "play {play:e}: off by {off:e}");
        assert!(found.stats.gap_evaluations < 12_000, "play {play:e}: {:?}", found.stats);
        assert!(found.energy.impacts < 1e-9 + 100.0 * play, "play {play:e}: {:?}", found.energy);
        balanced(&found);
    }
}

/// The same from other places, with other cranks and tolerances, without any play: no blow at all.
#[test]
fn without_play_there_is_no_blow() {
    for (crank, degrees) in [(1.0, 0.0), (2.0, 90.0), (3.3, -120.0), (2.7, 200.0)] {
        let start = f64::to_radians(degrees);
        let exact = one_freedom(crank, start);
        for (rtol, within) in [(1e-6, 1e-5), (1e-8, 1e-6), (1e-11, 1e-8)] {
            let found = run(&rocker(&[("play", 0.0), ("crank", crank), ("start", degrees)]), rtol);
            assert_eq!(found.status, Status::Complete);
            let off = off(&found, crank, start, &exact);
            assert!(off < within, "crank {crank}, start {degrees}, {rtol:e}: off by {off:e}");
            assert!(found.energy.impacts < 1e-12, "{:?}", found.energy);
            balanced(&found);
        }
    }
}

/// Two blocks that slide side by side, one with a fork about the other, tied by springs: as one mass without play.
#[test]
fn a_fork_without_play_makes_two_slides_one() {
    for play in [0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6] {
        let text = format!(
            "generic m(m)\na = blo()\nb = ((blo(x=9, y=4) at (movx=-4, movy=-2)) dif (blo(x={w}, y=2) at (movx={x})))\n\
             f = blo() at (movy=50)\nattr f : frame = 1\nm = a asb b asb f\n",
            w = 1.0 + play,
            x = -0.5 * play
        );
        let c = vec![coordinate("a", 1.0, 0.1, (5.0, 2.0)), coordinate("b", 3.0, 0.3, (1.0, -1.0))];
        let joints = [("a", slide(0, 1.0, 0.0)), ("b", slide(1, 1.0, 0.0))];
        let m = system(c, &text, &joints, 10.0);
        let found = run(&m, 1e-10);
        let together = |_: f64, y: &[f64]| vec![y[1], (9.0 - 6.0 * y[0] - 0.4 * y[1]) / 4.0];
        let exact = extrapolate(together, (0.0, UNTIL), &[0.0, 0.0], 400);
        for i in 0..2 {
            close(found.q[i], exact[0], 1e-8 + 5.0 * play);
            close(found.v[i], exact[1], 1e-8 + 5.0 * play);
        }
        assert!(found.stats.gap_evaluations < 6_000, "play {play:e}: {:?}", found.stats);
        balanced(&found);
    }
}

/// A pin in a ring-shaped groove about the same axis turns freely, and is stopped by neither wall.
#[test]
fn a_ring_without_play_holds_nothing() {
    let text = "generic m(m)\na = cyl(d=1) at (movx=3)\n\
                b = ((cyl(d=9) dif cyl(d=7)) un cyl(d=5))\nf = blo() at (movy=50)\nattr f : frame = 1\nm = a asb b asb f\n";
    let mut c = vec![coordinate("a", 1.0, 0.2, (0.0, 0.0)), coordinate("b", 1.0, 0.0, (0.0, 0.0))];
    c[0].velocity = 2.0;
    let m = system(c, text, &[("a", turn(0, 0.0, 0.0)), ("b", turn(1, 0.0, 0.0))], 9.0);
    let found = run(&m, 1e-9);
    close(found.q[0], 10.0 * (1.0 - (-4.0f64).exp()), 1e-7);
    close(found.q[1], 0.0, 1e-12);
}

/// After a hundred thousand turns positions are as coarse as the tightest tolerance: the run goes on, as it should.
#[test]
fn positions_far_from_zero() {
    let near = rocker(&[]);
    let far = 1e5 * std::f64::consts::TAU;
    let mut system = rocker(&[]);
    system.coordinates[0].position += far;
    system.coordinates[0].force += system.coordinates[0].stiffness * far;
    for rtol in [1e-8, 1e-11, 1e-13] {
        let (one, other) = (run(&near, rtol), run(&system, rtol));
        assert_eq!((one.status, other.status), (Status::Complete, Status::Complete), "{rtol:e}");
        close(other.q[0] - far, one.q[0], 1e-6);
        close(other.q[1], one.q[1], 1e-6);
    }
}
