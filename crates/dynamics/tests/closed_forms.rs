//! Runs against closed forms: oscillators, an inelastic blow, letting go, landing.

mod common;

use common::{balanced, close, coordinate, overlap, run, slide, system, turn};
use mainspring_dynamics::{EventKind, Run, Status};
use mainspring_mechanism::{Coordinate, Joint, System};

/// Two blocks on one line, the first's right face at x = 0, the second's left face at x = `apart`.
fn two_sliders(coordinates: Vec<Coordinate>, apart: f64) -> System {
    let text = format!(
        "generic m(m)\na = blo(x=2,y=1) at (movx=-2)\nb = blo(x=2,y=1) at (movx={apart})\n\
         f = blo(x=1,y=1) at (movy=50)\nattr f : frame = 1\nm = a asb b asb f\n"
    );
    system(coordinates, &text, &[("a", slide(0, 1.0, 0.0)), ("b", slide(1, 1.0, 0.0))], 10.0)
}

fn started(mut c: Coordinate, position: f64, velocity: f64) -> Coordinate {
    (c.position, c.velocity) = (position, velocity);
    c
}

fn times_of(run: &Run, kind: EventKind) -> Vec<f64> {
    run.events.iter().filter(|e| e.kind == kind).map(|e| e.t).collect()
}

/// A damped oscillator alone swings as its formula says, loses to friction what it loses, and meets nothing.
#[test]
fn a_damped_oscillator_alone() {
    let (i, h, k, x0, start) = (2.0, 0.3, 5.0, 0.4, 1.5);
    let c = started(coordinate("a", i, h, (k, x0)), start, 0.0);
    let machine = system(
        vec![c],
        "generic m(m)\na = blo(x=2)\nf = blo() at (movy=50)\nattr f : frame = 1\nm = a asb f\n",
        &[("a", turn(0, 0.0, 0.0))],
        2.0,
    );
    let found = run(&machine, 12.0, 1e-8);
    assert_eq!(found.status, Status::Complete);
    assert!(found.events.is_empty());
    let a = h / (2.0 * i);
    let w = (k / i - a * a).sqrt();
    for t in [0.0, 0.3, 1.7, 6.0, 12.0] {
        let swing = (start - x0) * (-a * t).exp();
        let state = found.trajectory.state(0, t);
        close(state.q, x0 + swing * ((w * t).cos() + a / w * (w * t).sin()), 1e-13);
        close(state.v, -swing * (k / i) / w * (w * t).sin(), 1e-13);
    }
    balanced(&found);
    // Minima of the kinetic energy: where the velocity is zero, every half period.
    for (n, m) in found.minima.iter().enumerate() {
        close(m.t, (n + 1) as f64 * std::f64::consts::PI / w, 1e-12);
        assert!(m.energy < 1e-20);
    }
    assert_eq!(found.minima.len(), (12.0 * w / std::f64::consts::PI) as usize);
}

/// A heavily damped oscillator let go from rest creeps to its equilibrium and is at rest there, not for ever under way.
#[test]
fn a_heavily_damped_oscillator_comes_to_rest() {
    let c = started(coordinate("a", 2.0, 20.0, (8.0, 0.2)), 1.0, 0.0);
    let text = "generic m(m)\na = blo(x=2)\nf = blo() at (movy=50)\nattr f : frame = 1\nm = a asb f\n";
    let found = run(&system(vec![c], text, &[("a", turn(0, 0.0, 0.0))], 2.0), 1e9, 1e-8);
    assert_eq!(found.status, Status::AtRest);
    assert!(found.t > 10.0 && found.t < 100.0, "{}", found.t);
    close(found.q[0], 0.2, 1e-6);
    balanced(&found);
}

/// Two geared oscillators move as one whose inertia, friction and spring are the sums reflected through the ratio,
/// and both bodies follow.
#[test]
fn two_geared_oscillators() {
    let ratio = -2.5;
    let own = [(2.0, 0.3, 5.0, 0.4), (0.7, 0.1, 1.2, -0.3)];
    let mut c = coordinate("a", 0.0, 0.0, (0.0, 0.0));
    for ((i, h, k, x), r) in own.into_iter().zip([1.0, ratio]) {
        c.inertia += i * r * r;
        c.damping += h * r * r;
        c.stiffness += k * r * r;
        c.force += k * r * x;
        c.energy_at_zero += 0.5 * k * x * x;
    }
    let text = "generic m(m)\na = blo(x=2)\nb = blo(x=2) at (movx=20)\nf = blo() at (movy=50)\nattr f : frame = 1\n\
                m = a asb b asb f\n";
    let second = Joint { ratio, ..turn(0, 20.0, 0.0) };
    let machine = system(vec![c], text, &[("a", turn(0, 0.0, 0.0)), ("b", second)], 2.0);
    let found = run(&machine, 9.0, 1e-8);
    // Integrate both wheels apart, with the tooth force between them eliminated by hand, in small steps.
    let force = |x: f64, v: f64| {
        let one = |(_, h, k, x0): (f64, f64, f64, f64), x: f64, v: f64| -k * (x - x0) - h * v;
        (one(own[0], x, v) + ratio * one(own[1], ratio * x, ratio * v))
            / (own[0].0 + ratio * ratio * own[1].0)
    };
    let (mut x, mut v) = (0.0, 0.0);
    let dt = 1e-3;
    for _ in 0..9000 {
        let (k1, l1) = (v, force(x, v));
        let (k2, l2) = (v + 0.5 * dt * l1, force(x + 0.5 * dt * k1, v + 0.5 * dt * l1));
        let (k3, l3) = (v + 0.5 * dt * l2, force(x + 0.5 * dt * k2, v + 0.5 * dt * l2));
        let (k4, l4) = (v + dt * l3, force(x + dt * k3, v + dt * l3));
        x += dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        v += dt / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
    }
    close(found.q[0], x, 1e-11);
    close(found.v[0], v, 1e-11);
    let pose = machine.bodies[1].pose(&found.q);
    close(pose.cos, (ratio * x).cos(), 1e-10);
    balanced(&found);
}

/// Two levers meet without spring-back: equal and opposite impulses with their lever arms, equal normal speeds after
/// it (Eq. A.19 corrected), and the loss ½ u²/(α₁²/I₁ + α₂²/I₂).
#[test]
fn an_inelastic_blow_between_levers() {
    // A bar about the origin with its upper face on y = 1, a bar about (10, 0) whose corner (4, ...) comes down on it.
    let text = "generic m(m)\na = blo(x=6,y=1) at (movx=0)\nb = blo(x=7,y=1) at (movx=3,movy=1.5)\n\
                f = blo() at (movy=50)\nattr f : frame = 1\nm = a asb b asb f\n";
    let (i1, i2) = (3.0, 1.7);
    let make = |v1: f64, v2: f64| {
        let c = vec![
            started(coordinate("a", i1, 0.0, (0.0, 0.0)), 0.0, v1),
            started(coordinate("b", i2, 0.0, (0.0, 0.0)), 0.0, v2),
        ];
        system(c, text, &[("a", turn(0, 0.0, 0.0)), ("b", turn(1, 10.0, 1.5))], 10.0)
    };
    for (v1, v2) in [(0.1, 0.02), (0.0, 0.3), (0.4, 0.0), (0.2, -0.01)] {
        let machine = make(v1, v2);
        let found = run(&machine, 10.0, 1e-9);
        let first = found.events.iter().find(|e| e.kind == EventKind::Impact).expect("no impact");
        let t = first.t;
        let before = [0, 1].map(|i| found.trajectory.state_before(i, t));
        let after = [0, 1].map(|i| found.trajectory.state(i, t));
        // Frictionless and free: straight flights up to the blow.
        close(before[0].q, v1 * t, 1e-13);
        close(before[1].q, v2 * t, 1e-13);
        // The levers' arms from the geometry of the touching corner, by differences of the distance.
        let (p1, p2) = (i1 * (after[0].v - before[0].v), i2 * (after[1].v - before[1].v));
        let arm = [p1 / first.impulse, p2 / first.impulse];
        let gap = |q1: f64, q2: f64| gap_of_corner(q1, q2);
        let e = 1e-6;
        let (q1, q2) = (before[0].q, before[1].q);
        close(gap(q1, q2), 0.0, 1e-11);
        close(arm[0], (gap(q1 + e, q2) - gap(q1 - e, q2)) / (2.0 * e), 1e-8);
        close(arm[1], (gap(q1, q2 + e) - gap(q1, q2 - e)) / (2.0 * e), 1e-8);
        let speed = |s: [mainspring_dynamics::State; 2]| arm[0] * s[0].v + arm[1] * s[1].v;
        assert!(speed(before) < 0.0);
        close(speed(after), 0.0, 1e-12);
        let loss = 0.5 * speed(before).powi(2) / (arm[0] * arm[0] / i1 + arm[1] * arm[1] / i2);
        let energy = |s: [mainspring_dynamics::State; 2]| 0.5 * (i1 * s[0].v * s[0].v + i2 * s[1].v * s[1].v);
        close(energy(before) - energy(after), loss, 1e-13);
        balanced(&found);
        overlap::assert_never_overlaps(&machine, &found, 2);
    }
}

/// Distance of the corner (3, 1.5) of the second lever, turned by q2 about (10, 1.5), from the upper face y = 1 of the
/// first, turned by q1 about the origin; or of the first's corner (6, 1) from the second's underside y = 1.5, when
/// the angle between them puts that corner nearer.
fn gap_of_corner(q1: f64, q2: f64) -> f64 {
    // Relative turning q2 − q1 > 0 lowers the far end of the second lever.
    let (s2, c2) = q2.sin_cos();
    let corner = (10.0 - 7.0 * c2, 1.5 - 7.0 * s2);
    let (s1, c1) = q1.sin_cos();
    let by_second = -s1 * corner.0 + c1 * corner.1 - 1.0;
    let tip = (6.0 * c1 - s1, 6.0 * s1 + c1);
    let by_first = s2 * (tip.0 - 10.0) - c2 * (tip.1 - 1.5);
    if q2 > q1 { by_second } else { by_first }
}

/// A spring pushes two sliders; the second has a spring of its own. They part exactly when the force between them
/// comes to zero.
#[test]
fn a_part_pushed_and_let_go() {
    // a: mass 1, spring 4 relaxed at 1, starts at rest at 0 touching b: mass 3, free. Together (4) q̈ = 4 (1 − q):
    // q = 1 − cos t. Force on b: 3 cos t, zero at π/2; then b goes on at speed 1.
    let machine =
        two_sliders(vec![coordinate("a", 1.0, 0.0, (4.0, 1.0)), coordinate("b", 3.0, 0.0, (0.0, 0.0))], 0.0);
    let found = run(&machine, 3.0, 1e-10);
    let half = std::f64::consts::FRAC_PI_2;
    let released = times_of(&found, EventKind::Release);
    // Faces that lie on each other touch at two corners, which let go together.
    assert_eq!(released.len(), 2, "{:?}", found.events);
    released.iter().for_each(|t| close(*t, half, 1e-9));
    let b = found.trajectory.state(1, 3.0);
    close(b.v, 1.0, 1e-9);
    close(b.q, 1.0 + (3.0 - half), 1e-8);
    let a = found.trajectory.state(0, 3.0);
    close(a.q, 1.0 + 0.5 * (2.0 * (3.0 - half)).sin(), 1e-8);
    balanced(&found);
    overlap::assert_never_overlaps(&machine, &found, 3);
}

/// With friction on the follower only, the force changes sign at a time with a closed form of its own.
#[test]
fn a_dragged_part_stays_until_its_inertia_wins() {
    // (m₁ + m₂) q̈ = k (x − q) − h q̇; contact force = m₂ q̈ + h q̇ (friction of b).
    let (m1, m2, k, x, h) = (1.0, 2.0, 6.0, 1.0, 0.8);
    let machine =
        two_sliders(vec![coordinate("a", m1, 0.0, (k, x)), coordinate("b", m2, h, (0.0, 0.0))], 0.0);
    let found = run(&machine, 4.0, 1e-11);
    let (a, w) = (h / (2.0 * (m1 + m2)), k / (m1 + m2));
    let o = (w - a * a).sqrt();
    let force = |t: f64| {
        let e = (-a * t).exp();
        let v = x * w / o * e * (o * t).sin();
        let acceleration = x * w * e * ((o * t).cos() - a / o * (o * t).sin());
        m2 * acceleration + h * v
    };
    let (mut low, mut high) = (0.1, 3.0);
    assert!(force(low) > 0.0 && force(high) < 0.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if force(middle) > 0.0 { low = middle } else { high = middle }
    }
    let released = times_of(&found, EventKind::Release);
    close(released[0], low, 1e-9);
    balanced(&found);
    overlap::assert_never_overlaps(&machine, &found, 3);
}

/// A slider driven by a spring lands on a stop when the formula says, and rests there for ever with the spring's force.
#[test]
fn a_spring_loaded_part_landing_on_a_stop() {
    let text = "generic m(m)\na = blo(x=2,y=1) at (movx=-2)\nf = blo(x=1,y=3) at (movx=0.75,movy=-1)\n\
                attr f : frame = 1\nm = a asb f\n";
    let (mass, h, k, x) = (2.0, 0.5, 3.0, 4.0);
    let machine = system(vec![coordinate("a", mass, h, (k, x))], text, &[("a", slide(0, 1.0, 0.0))], 10.0);
    let found = run(&machine, 1e9, 1e-9);
    let (a, w) = (h / (2.0 * mass), k / mass);
    let o = (w - a * a).sqrt();
    let q = |t: f64| x - x * (-a * t).exp() * ((o * t).cos() + a / o * (o * t).sin());
    let impacts = times_of(&found, EventKind::Impact);
    assert_eq!(impacts.len(), 1);
    close(q(impacts[0]), 0.75, 1e-12);
    assert_eq!(found.status, Status::AtRest);
    close(found.q[0], 0.75, 1e-12);
    assert_eq!(found.v[0], 0.0);
    assert_eq!(found.closed.iter().filter(|c| c.active).count(), 1);
    let force: f64 = found.closed.iter().map(|c| c.force).sum();
    close(force, k * (x - 0.75), 1e-10);
    close(found.energy.impacts, 0.5 * mass * found.trajectory.state_before(0, impacts[0]).v.powi(2), 1e-12);
    balanced(&found);
    overlap::assert_never_overlaps(&machine, &found, 3);
}
