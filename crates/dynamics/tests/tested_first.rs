//! The situations that break contact: grazing, corners on corners, rest for ever, chatter, loops, near-simultaneity,
//! thin and fast.

mod common;

use common::{
    Random, balanced, close, coordinate, escapement_with, fig_13, overlap, run, slide, system, turn,
};
use mainspring_dynamics::{EventKind, Run, Status};
use mainspring_mechanism::{Coordinate, Joint, System};

const DEGREE: f64 = std::f64::consts::PI / 180.0;

fn moving(name: &str, position: f64, velocity: f64) -> Coordinate {
    Coordinate { position, velocity, ..coordinate(name, 1.0, 0.0, (0.0, 0.0)) }
}

fn impacts(run: &Run) -> usize {
    run.events.iter().filter(|e| e.kind == EventKind::Impact).count()
}

fn machine(c: Vec<Coordinate>, parts: &str, joints: &[(&str, Joint)], size: f64) -> System {
    let names: Vec<&str> = parts.lines().filter_map(|l| l.split('=').next()).map(str::trim).collect();
    let result = names.join(" asb ");
    let text = format!("generic m(m)\n{parts}\nattr f : frame = 1\nm = {result}\n");
    system(c, &text, joints, size)
}

/// A lever's corner swings past a block that its circle misses or cuts by 1e-9: they touch just when it cuts.
#[test]
fn grazing() {
    // The corner (3, 0.5) of a bar about the origin runs on a circle of radius √9.25 over a floor below it.
    let radius = 9.25f64.sqrt();
    for (gap, touches) in
        [(1e-9, false), (1e-11, false), (-1e-9, true), (-1e-8, true), (1e-3, false), (-1e-3, true)]
    {
        let floor = -radius - gap - 1.0;
        let parts = format!(
            "a = blo(x=6,y=1) at (movx=-3,movy=-0.5)\nf = blo(x=20,y=1) at (movx=-10,movy={floor:.17})"
        );
        let m = machine(vec![moving("a", 0.0, -1.0)], &parts, &[("a", turn(0, 0.0, 0.0))], 6.0);
        let found = run(&m, 3.0, 1e-9);
        assert_eq!(impacts(&found) > 0, touches, "gap {gap}: {:?}", found.events);
        overlap::assert_never_overlaps(&m, &found, 5);
        if !touches {
            close(found.q[0], -3.0, 1e-12);
        }
    }
}

/// A slider pressed on another by a spring, both dragged along: the contact, once closed, stays closed through the
/// whole motion, and gap and speeds agree all the while.
#[test]
fn persistent_contact() {
    let parts = "a = blo(x=2,y=1) at (movx=-2)\nb = blo(x=2,y=1) at (movx=0.5)\nf = blo() at (movy=50)";
    let c = vec![coordinate("a", 1.0, 0.1, (5.0, 4.0)), coordinate("b", 2.0, 2.0, (1.0, -3.0))];
    let m = machine(c, parts, &[("a", slide(0, 1.0, 0.0)), ("b", slide(1, 1.0, 0.0))], 10.0);
    let found = run(&m, 60.0, 1e-9);
    let last_close = found.events.iter().rfind(|e| e.kind == EventKind::Close).unwrap().t;
    assert!(last_close < 30.0);
    for n in 0..=200 {
        let t = last_close + (60.0 - last_close) * f64::from(n) / 200.0;
        let (a, b) = (found.trajectory.state(0, t), found.trajectory.state(1, t));
        close(b.q - a.q, -0.5, 1e-9);
        close(a.v, b.v, 1e-9);
    }
    // Equilibrium of both springs together, with a − b = 0.5: 5 (4 − a) + (−3 − (a − 0.5)) = 0.
    close(found.q[0], 17.5 / 6.0, 1e-3);
    balanced(&found);
    overlap::assert_never_overlaps(&m, &found, 2);
}

/// A tooth's corner slides by the common corner of two faces, a few ulp inside or outside, from 10,000 states: none
/// outside is hit, none inside passes, nothing ever overlaps, and every run goes on.
#[test]
fn a_corner_passes_a_corner() {
    // A block slides to the right over a pallet whose corner is at (0, 1); its own lower right corner starts at
    // (−1, 1 + height), height a few ulp.
    let ulp = f64::EPSILON;
    let mut random = Random(11);
    for n in 0..10_000 {
        let height = ulp * random.next(-20.0, 20.0).round();
        let (angle, speed) = (random.next(0.0, 60.0), random.next(0.1, 5.0));
        let c = vec![Coordinate { velocity: speed, ..coordinate("a", 1.0, 0.0, (0.0, 0.0)) }];
        let m = passing(c, height, angle);
        let found = run(&m, 3.0 / speed, 1e-8);
        let passed = found.q[0] > 1.5;
        // Heights within 1e-13 of the size either way may count as touching, but never as overlap deeper than that.
        let say = format!(
            "case {n}: height {height:e} angle {angle} speed {speed} q {:?} {:?}",
            found.q, found.events
        );
        assert!(found.status != Status::StepLimit, "{say}");
        assert!(height < 0.0 || (passed && impacts(&found) == 0), "{say}");
    }
}

/// A block whose lower right corner is at (−1, 1 + height), and a pallet with its corner at (0, 1) whose right face
/// falls away by an angle.
fn passing(c: Vec<Coordinate>, height: f64, angle: f64) -> System {
    let parts = format!(
        "a = blo(x=0.4,y=1) at (movx=-1.4,movy={:.17})\nf = (blo(x=2,y=3) at (movy=-3,degz={:.17},movy=1)) un (blo(x=0.1,y=0.1) at (movy=-30))",
        1.0 + height,
        -angle
    );
    machine(c, &parts, &[("a", slide(0, 1.0, 0.0))], 4.0)
}

/// A corner that comes in above another passes untouched, however little; one that comes in below is stopped, from
/// 1e-8 of the size on (contact points are told from the ends of features to 1e-9 of the size).
#[test]
fn a_corner_meets_a_corner_just_when_it_overlaps() {
    for (height, passes) in [(1e-6, true), (1e-9, true), (-1e-6, false), (-4e-8, false)] {
        let c = vec![Coordinate { velocity: 1.0, ..coordinate("a", 1.0, 0.0, (0.0, 0.0)) }];
        let m = passing(c, height, 0.0);
        let found = run(&m, 3.0, 1e-8);
        assert_eq!(found.q[0] > 1.5, passes, "{height}: {:?}", found.events);
        assert_eq!(impacts(&found), usize::from(!passes), "{height}: {:?}", found.events);
        overlap::assert_never_overlaps(&m, &found, 3);
    }
}

/// A lever's tip runs off one face of a wedge over its corner without a blow from the next face.
#[test]
fn a_tip_runs_off_a_face_over_its_corner() {
    // The tip of a bar slides up a block's face held by a spring, then leaves over the top.
    let parts = "a = blo(x=3,y=0.4) at (movy=-0.4)\nb = blo(x=2,y=3) at (movx=3.2,movy=-3.05)\nf = blo() at (movy=50)";
    let (mut random, mut met, mut let_go) = (Random(5), 0, 0);
    for _ in 0..200 {
        let push = random.next(0.5, 4.0);
        let c = vec![
            coordinate("a", 1.0, 0.3, (6.0, -0.4)),
            Coordinate { velocity: -push, ..coordinate("b", 2.0, 0.2, (1.0, random.next(-1.0, 1.0))) },
        ];
        let m = machine(c, parts, &[("a", turn(0, 0.0, 0.0)), ("b", slide(1, 1.0, 0.0))], 6.0);
        let found = run(&m, 12.0, 1e-8);
        assert!(found.status != Status::StepLimit);
        met += impacts(&found);
        let_go += found.events.iter().filter(|e| e.kind == EventKind::Release).count();
        balanced(&found);
        overlap::assert_never_overlaps(&m, &found, 1);
    }
    assert!(met >= 200 && let_go >= 100, "{met} blows, {let_go} released");
}

/// A part at rest on a stop is there after 1e9 as it was, in a handful of steps, under its spring's force.
#[test]
fn at_rest_for_ever() {
    let parts = "a = blo(x=2,y=1) at (movx=-2)\nf = blo(x=1,y=3) at (movy=-1)";
    for velocity in [0.0, -1.0] {
        let c = Coordinate { velocity, ..coordinate("a", 2.0, 0.5, (3.0, 4.0)) };
        let m = machine(vec![c], parts, &[("a", slide(0, 1.0, 0.0))], 10.0);
        let found = run(&m, 1e9, 1e-8);
        assert_eq!(found.status, Status::AtRest);
        assert!(found.stats.steps < 40, "{:?}", found.stats);
        close(found.q[0], 0.0, 1e-12);
        close(found.closed.iter().map(|c| c.force).sum(), 12.0, 1e-11);
    }
}

/// The escapement with a balance spring of 10 chatters and dies out: at rest, jammed, in a bounded number of steps.
#[test]
fn chatter_dies_out() {
    let mut c = fig_13();
    c[2] = coordinate("bwheel", 20.0, 6.0, (10.0, 90.0 * DEGREE));
    let m = escapement_with(c);
    let found = run(&m, 1e4, 1e-8);
    assert_eq!(found.status, Status::AtRest);
    close(found.t, 28.4283, 2e-3);
    let rest = [-0.384_204_49, 0.237_252_52, 76.837_664_11];
    found.q.iter().zip(rest).for_each(|(q, x)| close(q / DEGREE, x, 1e-6));
    balanced(&found);
    overlap::assert_never_overlaps(&m, &found, 2);
}

/// A hammer, an anvil between, and a stop behind: the blow goes through the loop of contacts at once.
#[test]
fn a_blow_through_touching_parts() {
    let parts = "a = blo(x=1,y=1) at (movx=-3)\nb = blo(x=1,y=1) at (movx=-1)\nf = blo(x=1,y=3) at (movy=-1)";
    let c = vec![moving("a", 0.0, 2.0), moving("b", 0.0, 0.0)];
    let m = machine(c, parts, &[("a", slide(0, 1.0, 0.0)), ("b", slide(1, 1.0, 0.0))], 10.0);
    let found = run(&m, 100.0, 1e-8);
    let t = found.events.iter().find(|e| e.kind == EventKind::Impact).unwrap().t;
    close(t, 0.5, 1e-12);
    // Impulse 2 at each of the places, however it is spread over the corners of the faces.
    let total = |bodies: (usize, usize)| -> f64 {
        found.events.iter().filter(|e| e.bodies == bodies).map(|e| e.impulse).sum()
    };
    close(total((0, 1)), 2.0, 1e-10);
    close(total((1, 2)), 2.0, 1e-10);
    close(found.q[0], 1.0, 1e-10);
    close(found.q[1], 0.0, 1e-10);
    close(found.energy.impacts, 2.0, 1e-10);
    balanced(&found);
}

/// A wedge that two sliders and a stop hold at once: three contacts close together in one instant, and it rests.
#[test]
fn contacts_in_a_loop() {
    // A square standing on its corner comes down between two blocks that slide apart against springs, onto a post.
    let parts = "w = blo(x=2,y=2) at (degz=45,movy=1)\nl = blo(x=2,y=2) at (movx=-3,movy=-0.5)\n\
                 r = blo(x=2,y=2) at (movx=1,movy=-0.5)\nf = blo(x=1,y=1) at (movx=-0.5,movy=-1)";
    let c = vec![
        coordinate("w", 2.0, 0.5, (10.0, -3.0)),
        coordinate("l", 1.0, 0.5, (4.0, 1.5)),
        coordinate("r", 1.0, 0.5, (4.0, -1.5)),
    ];
    let joints = [("w", slide(0, 0.0, 1.0)), ("l", slide(1, 1.0, 0.0)), ("r", slide(2, 1.0, 0.0))];
    let m = machine(c, parts, &joints, 6.0);
    let start: Vec<f64> = vec![0.0; 3];
    assert!(overlap::depth_at(&m, &start) <= 1e-9, "overlap at the start: {}", overlap::depth_at(&m, &start));
    let found = run(&m, 1e6, 1e-8);
    assert_eq!(found.status, Status::AtRest, "{:?}", found.events);
    // The mirror image of itself: left and right do the same.
    close(found.q[1], -found.q[2], 1e-9);
    let holding: Vec<(usize, usize)> = found
        .closed
        .iter()
        .filter(|c| c.active)
        .map(|c| m.interactions[c.candidate.id.interaction as usize].bodies)
        .collect();
    assert!(
        holding.contains(&(0, 1)) && holding.contains(&(0, 2)) && holding.contains(&(0, 3)),
        "{holding:?} {:?}",
        found.q
    );
    balanced(&found);
    overlap::assert_never_overlaps(&m, &found, 2);
}

/// Two blows two millionths apart are two entries in the right order; two at the same time are one instant.
#[test]
fn two_impacts_microseconds_apart() {
    for apart in [2e-6, 1e-8, 0.0] {
        let parts = format!(
            "a = blo(x=1,y=1) at (movx=-2)\nb = blo(x=1,y=1) at (movx=-2,movy=5)\nf = blo(x=1,y=1) un (blo(x=1,y=1) at (movx={apart:.17},movy=5)) un (blo(x=0.5,y=6) at (movx=0.4))"
        );
        let c = vec![moving("a", 0.0, 1.0), moving("b", 0.0, 1.0)];
        let m = machine(c, &parts, &[("a", slide(0, 1.0, 0.0)), ("b", slide(1, 1.0, 0.0))], 10.0);
        let found = run(&m, 5.0, 1e-8);
        let blows: Vec<(f64, usize)> =
            found.events.iter().filter(|e| e.kind == EventKind::Impact).map(|e| (e.t, e.bodies.0)).collect();
        let first = |body| blows.iter().find(|b| b.1 == body).unwrap().0;
        close(first(0), 1.0, 1e-10);
        close(first(1), 1.0 + apart, 1e-10);
        assert!(blows.windows(2).all(|w| w[0].0 <= w[1].0));
        assert!(apart == 0.0 || blows[0].1 == 0, "{blows:?}");
        assert_eq!(found.status, Status::AtRest);
    }
}

/// A wall a thousandth thick stops a block that comes at ten thousand a second, slides or swings.
#[test]
fn thin_and_fast() {
    for speed in [1.0, 1e2, 1e4, 1e6] {
        let parts = "a = blo(x=1,y=1) at (movx=-2)\nf = blo(x=0.001,y=3) at (movx=50,movy=-1)";
        let c = Coordinate { velocity: speed, ..coordinate("a", 1.0, 0.0, (0.0, 0.0)) };
        let m = machine(vec![c], parts, &[("a", slide(0, 1.0, 0.0))], 60.0);
        let found = run(&m, 1e3, 1e-8);
        close(found.q[0], 51.0, 1e-10);
        assert!(found.stats.gap_evaluations < 1000, "{:?}", found.stats);
        let parts = "a = blo(x=20,y=0.001)\nf = blo(x=0.001,y=0.001) at (movx=-19,movy=0.5)";
        let c = Coordinate { velocity: speed, ..coordinate("a", 1.0, 0.0, (0.0, 0.0)) };
        let m = machine(vec![c], parts, &[("a", turn(0, 0.0, 0.0))], 60.0);
        let found = run(&m, 1e3, 1e-8);
        assert!(found.q[0] < std::f64::consts::PI && found.q[0] > 3.0, "{}", found.q[0]);
        overlap::assert_never_overlaps(&m, &found, 5);
    }
}
