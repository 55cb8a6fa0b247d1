//! Compliant contact against closed forms, against its own limits, and against rigid contact.

mod common;

use common::{changed_escapements, close, coordinate, escapement, low_minima, push, slide, system};
use mainspring_dynamics::{EventKind, Run, Status};
use mainspring_mechanism::{ContactLaw, System};
use std::f64::consts::PI;

fn balanced(run: &Run, tolerance: f64) {
    let residual = run.energy.residual();
    assert!(residual.abs() < tolerance, "energy residual {residual:e}: {:?}", run.energy);
    assert!(run.energy.friction >= 0.0 && run.energy.impacts >= -1e-12, "{:?}", run.energy);
}

/// The paper's constants, E and D multiplied.
fn law(factor: f64) -> ContactLaw {
    let law = ContactLaw::default();
    ContactLaw { e: law.e * factor, d: law.d * factor, ..law }
}

fn elastic(stiffness: f64) -> ContactLaw {
    ContactLaw { e: stiffness, d: 0.0, m: 1.0 }
}

/// A block of mass `mass` at x < 0 that slides towards a wall at x = 0, `apart` before it.
fn block(mass: f64, spring: (f64, f64), apart: f64, velocity: f64) -> System {
    let text = format!(
        "generic m(m)\na = blo(x=2,y=1) at (movx={})\nf = blo(x=1,y=3) at (movy=-1)\nattr f : frame = 1\n\
         m = a asb f\n",
        -2.0 - apart
    );
    let mut c = coordinate("a", mass, 0.0, spring);
    c.velocity = velocity;
    system(vec![c], &text, &[("a", slide(0, 1.0, 0.0))], 10.0)
}

fn times(run: &Run, kind: EventKind) -> Vec<f64> {
    run.events.iter().filter(|e| e.kind == kind).map(|e| e.t).collect()
}

/// Without damping a blow is half a sine: it lasts π/ω and gives the speed back. The block's flat face has two
/// corners on the wall, each with the law's stiffness: ω = √(2E/m).
#[test]
fn an_elastic_blow_is_half_a_sine() {
    let (mass, stiffness) = (2.0, 4e4);
    let found = push(&block(mass, (0.0, 0.0), 0.3, 1.5), elastic(stiffness), 0.5, 1e-9);
    let omega = (2.0 * stiffness / mass).sqrt();
    let (closed, parted) = (times(&found, EventKind::Close), times(&found, EventKind::Release));
    assert_eq!((closed.len(), parted.len()), (2, 2), "{:?}", found.events);
    close(closed[0], 0.2, 1e-12);
    close(parted[0] - closed[0], PI / omega, 1e-9);
    close(found.v[0], -1.5, 1e-8);
    for part in [0.1, 0.25, 0.5, 0.8] {
        let phase = part * PI;
        let state = found.trajectory.state(0, closed[0] + phase / omega);
        close(state.q, 0.3 + 1.5 / omega * phase.sin(), 1e-9);
        close(state.v, 1.5 * phase.cos(), 1e-7);
    }
    balanced(&found, 1e-8);
}

/// The speed after a damped blow without other forces follows from `v dv/(E + D M v) = −o do/m`: with
/// `F(v) = v/(D M) − E/(D M)² ln(1 + D M v/E)` it obeys F(−after) = F(before), and never exceeds E/(D M).
#[test]
fn a_damped_blow_rebounds_as_integrated() {
    let law = ContactLaw { e: 3e4, d: 200.0, m: 80.0 };
    let (e, c) = (law.e, law.viscosity());
    let measure = |v: f64| v / c - e / (c * c) * (c * v / e).ln_1p();
    for (mass, speed) in [(1.0, 0.01), (1.0, 0.5), (3.0, 2.0), (0.2, 40.0)] {
        let found = push(&block(mass, (0.0, 0.0), 0.1, speed), law, 0.1 / speed + 0.3, 1e-10);
        let after = found.v[0];
        assert!(after < 0.0 && -after < e / c && -after < speed, "{after} after {speed}");
        let (mut least, mut greatest) = (0.0, e / c);
        for _ in 0..80 {
            let middle = 0.5 * (least + greatest);
            if measure(-middle) < measure(speed) { least = middle } else { greatest = middle }
        }
        close(-after / least, 1.0, 1e-6);
        // Greatest depth: two corners share the load.
        let deepest = (mass * measure(speed)).sqrt();
        let closed = times(&found, EventKind::Close)[0];
        let depths =
            (0..=4000).map(|k| found.trajectory.state(0, closed + 0.3 * f64::from(k) / 4000.0).q - 0.1);
        close(depths.fold(0.0, f64::max) / deepest, 1.0, 1e-4);
        balanced(&found, 1e-7);
    }
}

/// Pressed by a spring a block comes to rest where the contact's force equals the spring's.
#[test]
fn a_pressed_block_rests_at_its_depth() {
    let found = push(&block(1.5, (20.0, 3.0), 0.2, 0.0), law(1.0), 1e4, 1e-6);
    assert_eq!(found.status, Status::AtRest, "at {} after {:?}", found.t, found.stats);
    // 2 E (q − 0.2) = 20 (3 − q).
    let q = (2e5 * 0.2 + 60.0) / (2e5 + 20.0);
    close(found.q[0], q, 1e-7);
    assert_eq!(found.closed.len(), 2);
    found.closed.iter().for_each(|c| close(c.force, 10.0 * (3.0 - q), 0.01));
    close(found.energy.contact_stored, 1e5 * (q - 0.2).powi(2), 1e-5);
    balanced(&found, 1e-6);
}

/// Two free blocks keep their momentum, and part no faster than E/(D M).
#[test]
fn momentum_is_kept() {
    let text = "generic m(m)\na = blo(x=2,y=1) at (movx=-2)\nb = blo(x=2,y=1) at (movx=0.5)\n\
                f = blo(x=1,y=1) at (movy=50)\nattr f : frame = 1\nm = a asb b asb f\n";
    let (mut a, b) = (coordinate("a", 2.0, 0.0, (0.0, 0.0)), coordinate("b", 3.0, 0.0, (0.0, 0.0)));
    a.velocity = 4.0;
    let joints = [("a", slide(0, 1.0, 0.0)), ("b", slide(1, 1.0, 0.0))];
    let found = push(&system(vec![a, b], text, &joints, 10.0), law(1.0), 1.0, 1e-7);
    close(2.0 * found.v[0] + 3.0 * found.v[1], 8.0, 1e-6);
    let apart = found.v[1] - found.v[0];
    assert!(apart > 0.09 && apart < 0.1, "{apart}");
    balanced(&found, 1e-6);
}

fn tenth(run: &Run) -> f64 {
    low_minima(run).into_iter().filter(|m| m.t > 0.0).nth(9).expect("ten minima").t
}

/// The escapement: the asked tolerance is delivered, energy balances, and the work is small.
#[test]
fn results_converge_with_the_tolerance() {
    let machine = escapement();
    let runs = [1e-5, 1e-6, 1e-8].map(|rtol| push(&machine, law(1.0), 37.0, rtol));
    let finest = tenth(&runs[2]);
    close(tenth(&runs[0]), finest, 1e-5);
    close(tenth(&runs[1]), finest, 1e-6);
    balanced(&runs[0], 1e-5);
    balanced(&runs[1], 1e-6);
    balanced(&runs[2], 1e-7);
    assert!(runs[0].stats.steps < 2_000, "{:?}", runs[0].stats);
    close(finest, 36.903_286_642, 1e-7);
}

/// At the paper's constants the two models agree to 0.1 %, with E and D raised a thousandfold to 0.01 %.
#[test]
fn agrees_with_rigid_contact() {
    let machine = escapement();
    let rigid = tenth(&common::run(&machine, 37.0, 1e-9));
    for (factor, allowed) in [(1.0, 1e-3), (1000.0, 1e-4)] {
        let found = push(&machine, law(factor), 37.0, 1e-6);
        close(tenth(&found) / rigid, 1.0, allowed);
        balanced(&found, 1e-6);
        // Ringing and bouncing take a bounded number of steps.
        assert!(found.stats.steps < 20_000, "{:?}", found.stats);
    }
}

/// Changed machines tick as with rigid contact.
#[test]
fn changed_machines_agree_with_rigid_contact() {
    for (system, rigid) in changed_escapements() {
        let found = push(&system, law(1.0), rigid + 1.0, 1e-6);
        close(tenth(&found) / rigid, 1.0, 3e-3);
        balanced(&found, 1e-6);
    }
}

/// The same machine twice gives the same run to the last bit.
#[test]
fn runs_are_deterministic() {
    let machine = escapement();
    let (a, b) = (push(&machine, law(1.0), 8.0, 1e-6), push(&machine, law(1.0), 8.0, 1e-6));
    assert_eq!(a.trajectory, b.trajectory);
    assert_eq!((a.events, a.q, a.v, a.stats), (b.events, b.q, b.v, b.stats));
}
