//! What driven machines do: patterns of what they move, tables that end, dry friction that stops.

#[path = "../../dynamics/tests/common/mod.rs"]
mod common;

use common::{bodies, close, coordinate, overlap, slide, turn};
use mainspring_behavior::{NoPattern, Outcome, PredictOptions, Prediction, predict};
use mainspring_mechanism::{Coordinate, Drive, Forces, System, Table};
use std::f64::consts::{FRAC_PI_2, SQRT_2, TAU};

fn predicted(system: &System) -> Prediction {
    let found = predict(system, &system.direct_search(), &PredictOptions::default(), &mut |_| true);
    overlap::assert_free(system, &found.run);
    found
}

fn cam(shape: &str, follower: f64, inertia: f64, drive: Drive) -> System {
    let text = format!(
        "generic m(m)\ncam = {shape}\nfollower = blo(x=9,y=1) at (movx=-4.5,movy={follower})\n\
         f = blo() at (movy=50)\nattr f : frame = 1\nm = cam asb follower asb f\n"
    );
    let joints = [("cam", turn(0, 0.0, 0.0)), ("follower", slide(1, 0.0, 1.0))];
    let coordinates =
        vec![coordinate("cam", inertia, 0.1, (0.0, 0.0)), coordinate("follower", 1.0, 0.3, (10.0, -3.0))];
    System::new(coordinates, bodies(&text, &joints), &[], 6.0)
        .with_forces(Forces { drives: vec![Some(drive), None], ..Forces::none(2) })
}

/// At constant speed the follower's pattern is that of the cam, however heavy the cam is.
#[test]
fn a_driven_cam_repeats_with_its_turns() {
    for inertia in [0.01, 1.0, 1e6] {
        let speed = 0.7;
        let round =
            predicted(&cam("cyl(d=2) at (movx=0.5)", 1.0, inertia, Drive::Speed { start: 0.0, speed }));
        let Outcome::Repeats { pattern, .. } = &round.outcome else { panic!("{:?}", round.outcome) };
        close(pattern.duration, TAU / speed, 1e-7);
        close(pattern.change[0].0, TAU, 1e-7);
        close(pattern.change[1].0, 0.0, 1e-7);
        assert!(round.run.energy.residual().abs() < 1e-7);
    }
}

/// A square cam lets its follower slam onto each next side: x = √2 cos(θ − 45°), four blows a turn.
#[test]
fn a_driven_square_slams() {
    let speed = 0.5;
    let square = "blo(x=2,y=2) at (movx=-1,movy=-1)";
    let found = predicted(&cam(square, 1.0, 3.0, Drive::Speed { start: 0.0, speed }));
    let Outcome::Repeats { pattern, .. } = &found.outcome else { panic!("{:?}", found.outcome) };
    close(pattern.duration, FRAC_PI_2 / speed, 1e-6);
    close(pattern.change[0].0, FRAC_PI_2, 1e-6);
    for n in 1..20 {
        let t = 0.3 * f64::from(n);
        let angle = (speed * t).rem_euclid(FRAC_PI_2);
        let height = SQRT_2 * (angle - 0.5 * FRAC_PI_2).cos() - 1.0;
        close(found.run.trajectory.state(1, t).q, height, 1e-7);
    }
    assert!(found.run.energy.residual().abs() < 1e-7, "{:?}", found.run.energy);
}

/// A wheel alone at constant speed has nothing that changes; a table that ends leaves the machine to itself.
#[test]
fn what_only_turns_and_what_ends() {
    let alone = cam("cyl(d=2)", 3.0, 1.0, Drive::Speed { start: 0.0, speed: 2.0 });
    let mut rests = alone.clone();
    rests.coordinates[1] = Coordinate { force: 0.0, energy_at_zero: 0.0, ..rests.coordinates[1].clone() };
    assert_eq!(predicted(&rests).outcome, Outcome::NoPattern(NoPattern::ConstantKineticEnergy));
    let points = [(0.0, 0.0), (3.0, 2.0), (900.0, 2.0), (903.0, -1.0)];
    let table = cam("cyl(d=2) at (movx=0.5)", 1.0, 1.0, Drive::Table(Table::new(&points)));
    let found = predicted(&table);
    let Outcome::ComesToRest { t, .. } = found.outcome else { panic!("{:?}", found.outcome) };
    assert!(t >= 903.0, "{t}");
    close(found.run.q[0], -1.0, 1e-9);
    close(found.run.q[1], 0.5 * (-1.0f64).sin(), 1e-7);
}
