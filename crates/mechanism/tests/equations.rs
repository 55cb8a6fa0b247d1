//! Equations of motion of chains: closed forms, the Lagrangian by an independent way, derivatives, power.

use mainspring_geometry::{Outline, Vec2};
use mainspring_mechanism::{
    Body, Coordinate, Coupled, Equations, EquationsJacobian, Forces, Joint, Mass, Motion, System,
};
use num_dual::Dual64;

fn p(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y)
}

fn coordinate(inertia: f64, damping: f64, stiffness: f64, force: f64) -> Coordinate {
    let name = "c".to_string();
    Coordinate { name, inertia, damping, stiffness, force, energy_at_zero: 0.0, position: 0.0, velocity: 0.0 }
}

fn turn(coordinate: usize, ratio: f64, center: Vec2) -> Joint {
    Joint { coordinate, ratio, motion: Motion::Turn { center } }
}

fn slide(coordinate: usize, ratio: f64, direction: Vec2) -> Joint {
    Joint { coordinate, ratio, motion: Motion::Slide { direction } }
}

fn body(chain: Vec<Joint>) -> Body {
    Body { name: "b".into(), chain, outline: Outline::default() }
}

fn system(coordinates: Vec<Coordinate>, bodies: Vec<Body>, masses: Vec<Mass>, gravity: Vec2) -> System {
    let forces = Forces { masses, gravity, ..Forces::none(coordinates.len()) };
    System::new(coordinates, bodies, &[], 10.0).with_forces(forces)
}

fn evaluate(s: &System, group: &Coupled, q: &[f64], v: &[f64]) -> Equations {
    let mut out = Equations::default();
    s.equations(group, q, v, &mut out);
    out
}

fn near(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * (1.0 + b.abs()), "{a} {b}");
}

/// I q̈ = −m g d sin q, hanging down at q = 0, turned by gravity that points along −y.
#[test]
fn physical_pendulum() {
    let (inertia, m, d, g) = (7.0, 3.0, 1.5, 9.81);
    let axis = p(2.0, 5.0);
    let mass = Mass { body: 0, mass: m, center: axis + p(0.0, -d), inertia: 0.0, chained: false };
    let s = system(
        vec![coordinate(inertia, 0.2, 0.0, 0.0)],
        vec![body(vec![turn(0, 1.0, axis)])],
        vec![mass],
        p(0.0, -g),
    );
    assert_eq!(s.coupled.len(), 1);
    for q in [-2.0, -0.3, 0.0, 1e-3, 1.2, 3.0] {
        let e = evaluate(&s, &s.coupled[0], &[q], &[0.7]);
        near(e.mass[0], inertia);
        near(e.force[0], -m * g * d * f64::sin(q) - 0.2 * 0.7);
        near(s.potential_energy(&[q]), m * g * d * (1.0 - q.cos()));
        near(s.kinetic_energy(&[q], &[0.7]), 0.5 * inertia * 0.49);
    }
}

/// Two bars: the second pinned to the first's end; q₂ is relative to the first bar.
struct TwoBars {
    m: [f64; 2],
    /// From the joint to the centre of mass.
    c: [f64; 2],
    /// About the centres.
    i: [f64; 2],
    /// Between the joints.
    l: f64,
    g: f64,
}

const BARS: TwoBars = TwoBars { m: [2.0, 1.3], c: [0.8, 0.55], i: [0.4, 0.17], l: 1.7, g: 9.81 };

impl TwoBars {
    fn system(&self) -> System {
        let pin = p(0.0, -self.l);
        let bodies = vec![
            body(vec![turn(0, 1.0, p(0.0, 0.0))]),
            body(vec![turn(0, 1.0, p(0.0, 0.0)), turn(1, 1.0, pin)]),
        ];
        let first =
            Mass { body: 0, mass: self.m[0], center: p(0.0, -self.c[0]), inertia: 0.0, chained: false };
        let second = Mass {
            body: 1,
            mass: self.m[1],
            center: pin + p(0.0, -self.c[1]),
            inertia: self.i[1],
            chained: true,
        };
        let own = self.i[0] + self.m[0] * self.c[0].powi(2);
        let coordinates = vec![coordinate(own, 0.0, 0.0, 0.0), coordinate(0.0, 0.0, 0.0, 0.0)];
        system(coordinates, bodies, vec![first, second], p(0.0, -self.g))
    }
}

/// The textbook's matrix and forces.
#[test]
fn double_pendulum() {
    let b = &BARS;
    let s = b.system();
    assert_eq!((s.coupled.len(), &s.coupled[0].coordinates[..]), (1, &[0, 1][..]));
    for (q, v) in [([0.0, 0.0], [1.0, 2.0]), ([0.4, -1.1], [-0.7, 2.1]), ([2.9, 1.3], [3.0, -4.0])] {
        let e = evaluate(&s, &s.coupled[0], &q, &v);
        let cross = b.m[1] * b.l * b.c[1];
        let last = b.i[1] + b.m[1] * b.c[1].powi(2);
        let first = b.i[0] + b.m[0] * b.c[0].powi(2) + b.m[1] * b.l * b.l;
        near(e.mass[0], first + last + 2.0 * cross * q[1].cos());
        near(e.mass[1], last + cross * q[1].cos());
        near(e.mass[2], e.mass[1]);
        near(e.mass[3], last);
        let pull = |m: f64, c: f64, angle: f64| -m * b.g * c * angle.sin();
        let lower = pull(b.m[1], b.c[1], q[0] + q[1]);
        let upper = pull(b.m[0], b.c[0], q[0]) + pull(b.m[1], b.l, q[0]);
        near(e.force[0], cross * q[1].sin() * (2.0 * v[0] + v[1]) * v[1] + upper + lower);
        near(e.force[1], -cross * q[1].sin() * v[0] * v[0] + lower);
        let height = b.m[0] * b.c[0] * (1.0 - q[0].cos())
            + b.m[1] * (b.l * (1.0 - q[0].cos()) + b.c[1] * (1.0 - (q[0] + q[1]).cos()));
        near(s.potential_energy(&q), b.g * height);
    }
}

/// A pawl pinned at R on a plate that turns at ω: centrifugal force turns it outwards with m ω² R d sin ψ, and
/// the plate's angular momentum is what its bodies have.
#[test]
fn pawl_on_a_turning_plate() {
    let (m, inertia, plate, radius, d) = (0.6, 0.05, 11.0, 3.0, 0.9);
    let pin = p(radius, 0.0);
    let mass = Mass { body: 1, mass: m, center: pin + p(d, 0.0), inertia, chained: true };
    let coordinates = vec![coordinate(plate, 0.0, 0.0, 0.0), coordinate(0.0, 0.0, 2.0, 1.0)];
    let bodies =
        vec![body(vec![turn(0, 1.0, p(0.0, 0.0))]), body(vec![turn(0, 1.0, p(0.0, 0.0)), turn(1, 1.0, pin)])];
    let s = system(coordinates, bodies, vec![mass], Vec2::default());
    let (omega, psi) = (4.0, 0.7);
    // The plate's angle must not matter.
    for angle in [0.0, 1.1, -20.0] {
        let e = evaluate(&s, &s.coupled[0], &[angle, psi], &[omega, 0.0]);
        near(e.force[1], -m * omega * omega * radius * d * f64::sin(psi) - 2.0 * psi + 1.0);
        near(e.force[0], 0.0);
        let rate = 1.3;
        let e = evaluate(&s, &s.coupled[0], &[angle, psi], &[omega, rate]);
        let momentum = e.mass[0] * omega + e.mass[1] * rate;
        let (center, turning) = (p(radius + d * psi.cos(), d * psi.sin()), omega + rate);
        let velocity = center.perp() * omega + p(-d * psi.sin(), d * psi.cos()) * rate;
        near(momentum, plate * omega + inertia * turning + m * center.cross(velocity));
    }
}

/// A block on an arm that turns: (I + m r²) θ̈ = −2 m r ṙ θ̇ and m r̈ = m r θ̇².
#[test]
fn slide_on_a_turning_arm() {
    let (arm, m, own, start) = (2.0, 0.8, 0.03, 1.25);
    let mass = Mass { body: 1, mass: m, center: p(start, 0.0), inertia: own, chained: true };
    let origin = p(0.0, 0.0);
    let chain = vec![turn(0, 1.0, origin), slide(1, 1.0, p(1.0, 0.0))];
    let bodies = vec![body(vec![turn(0, 1.0, origin)]), body(chain)];
    let coordinates = vec![coordinate(arm, 0.0, 0.0, 0.0), coordinate(0.0, 0.3, 0.0, 0.0)];
    let s = system(coordinates, bodies, vec![mass], Vec2::default());
    let (theta, x, w, rate) = (0.9, 0.35, 1.7, -0.6);
    let r = start + x;
    let e = evaluate(&s, &s.coupled[0], &[theta, x], &[w, rate]);
    near(e.mass[0], arm + own + m * r * r);
    near(e.mass[1], 0.0);
    near(e.mass[3], m);
    near(e.force[0], -2.0 * m * r * rate * w);
    near(e.force[1], m * r * w * w - 0.3 * rate);
}

/// A machine with everything: gears' ratios, all orders of joints, two bodies on one carrier, another apart.
fn mixed() -> System {
    let bodies = vec![
        body(vec![turn(0, 1.0, p(0.3, -0.2))]),
        body(vec![turn(0, 1.0, p(0.3, -0.2)), turn(1, -1.5, p(1.1, 0.4))]),
        body(vec![turn(0, 1.0, p(0.3, -0.2)), slide(2, 0.7, p(0.6, 0.8)), turn(3, 2.0, p(-0.5, 0.9))]),
        body(vec![slide(4, 1.0, p(0.8, -0.6)), turn(5, 1.0, p(2.0, 2.0)), turn(3, 0.5, p(2.5, 1.0))]),
        body(vec![turn(6, -2.0, p(0.0, 1.0))]),
        body(vec![slide(7, 1.0, p(0.0, 1.0))]),
    ];
    let mass = |body: usize, chained: bool| Mass {
        body,
        mass: 0.4 + 0.3 * body as f64,
        center: p(0.7 - 0.2 * body as f64, 0.3 + 0.25 * body as f64),
        inertia: if chained { 0.05 * (1 + body) as f64 } else { 0.0 },
        chained,
    };
    let masses = vec![mass(0, false), mass(1, true), mass(2, true), mass(3, true), mass(4, false)];
    let c =
        |i: usize| coordinate(0.5 + 0.1 * i as f64, 0.02 * i as f64, 0.3 * i as f64, 0.1 - 0.05 * i as f64);
    let mut s = system((0..8).map(c).collect(), bodies, masses, p(1.2, -9.0));
    s.forces.applied = (0..8).map(|i| 0.01 * i as f64).collect();
    s
}

const Q: [f64; 8] = [0.37, -0.81, 0.45, 1.2, -0.7, 2.2, 0.6, 0.1];
const V: [f64; 8] = [0.9, -1.3, 0.6, 0.4, 1.1, -0.5, 0.8, -0.2];

#[test]
fn coordinates_are_grouped_by_masses() {
    let groups: Vec<Vec<usize>> = mixed().coupled.iter().map(|g| g.coordinates.to_vec()).collect();
    // 3 joins what hangs on 0 with what hangs on 4; 6 feels gravity alone; 7 flies in closed form.
    assert_eq!(groups, [vec![0, 1, 2, 3, 4, 5], vec![6]]);
}

/// Kinetic energy from velocities found by dual numbers through the poses.
fn kinetic(s: &System, q: &[f64], v: &[f64]) -> f64 {
    let seeded: Vec<Dual64> = q.iter().zip(v).map(|(q, v)| Dual64::new(*q, *v)).collect();
    let own: f64 = s.coordinates.iter().zip(v).map(|(c, v)| 0.5 * c.inertia * v * v).sum();
    let chained = s.forces.masses.iter().filter(|m| m.chained).map(|m| {
        let pose = s.bodies[m.body].pose(&seeded);
        let center = pose.apply(Vec2::constant(m.center));
        let turning = pose.cos.re * pose.sin.eps - pose.sin.re * pose.cos.eps;
        0.5 * m.mass * (center.x.eps.powi(2) + center.y.eps.powi(2)) + 0.5 * m.inertia * turning * turning
    });
    own + chained.sum::<f64>()
}

/// M by polarisation of the kinetic energy: exact, as it is quadratic in velocities.
fn mass_matrix(s: &System, q: &[f64]) -> Vec<Vec<f64>> {
    let n = q.len();
    let unit = |i: usize, j: usize| -> Vec<f64> {
        (0..n).map(|k| f64::from(u8::from(k == i)) + f64::from(u8::from(k == j))).collect()
    };
    let single = |i: usize| kinetic(s, q, &unit(i, i)) / 4.0;
    (0..n)
        .map(|i| {
            (0..n)
                .map(|j| {
                    if i == j { 2.0 * single(i) } else { kinetic(s, q, &unit(i, j)) - single(i) - single(j) }
                })
                .collect()
        })
        .collect()
}

/// Fourth-order central difference.
fn slope(f: impl Fn(f64) -> f64, h: f64) -> f64 {
    (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h)
}

/// Lagrange: `f = −(Σ ∂M_ij/∂q_k q̇_j q̇_k − ½ Σ ∂M_jk/∂q_i q̇_j q̇_k) − ∂V/∂q − h q̇ + applied`.
#[test]
fn equations_are_those_of_the_lagrangian() {
    let s = mixed();
    let moved = |k: usize, h: f64| -> Vec<f64> {
        Q.iter().enumerate().map(|(i, q)| if i == k { q + h } else { *q }).collect()
    };
    let m = mass_matrix(&s, &Q);
    let entry = |i: usize, j: usize, k: usize| slope(|h| mass_matrix(&s, &moved(k, h))[i][j], 1e-2);
    let n = Q.len();
    let dm: Vec<Vec<Vec<f64>>> =
        (0..n).map(|i| (0..n).map(|j| (0..n).map(|k| entry(i, j, k)).collect()).collect()).collect();
    for group in &s.coupled {
        let e = evaluate(&s, group, &Q, &V);
        let size = group.coordinates.len();
        for (a, &i) in group.coordinates.iter().enumerate() {
            for (b, &j) in group.coordinates.iter().enumerate() {
                near(e.mass[a * size + b], m[i][j]);
            }
            let pairs = || (0..n).flat_map(|j| (0..n).map(move |k| (j, k)));
            let velocity: f64 = pairs().map(|(j, k)| (0.5 * dm[j][k][i] - dm[i][j][k]) * V[j] * V[k]).sum();
            let conservative = -slope(|h| s.potential_energy(&moved(i, h)), 1e-2);
            let c = &s.coordinates[i];
            let expected = velocity + conservative - c.damping * V[i] + s.forces.applied[i];
            assert!((e.force[a] - expected).abs() < 1e-7, "{i}: {} {expected}", e.force[a]);
        }
    }
    near(s.kinetic_energy(&Q, &V), kinetic(&s, &Q, &V));
}

#[test]
fn jacobians_agree_with_differences() {
    let s = mixed();
    let group = &s.coupled[0];
    let n = group.coordinates.len();
    let a: Vec<f64> = (0..n).map(|i| 0.7 - 0.4 * i as f64).collect();
    let mut jacobian = EquationsJacobian::default();
    s.equations_jacobian(group, &Q, &V, &a, &mut jacobian);
    let rest = |q: &[f64], v: &[f64], i: usize| {
        let e = evaluate(&s, group, q, v);
        e.force[i] - (0..n).map(|j| e.mass[i * n + j] * a[j]).sum::<f64>()
    };
    let moved = |x: &[f64; 8], k: usize, h: f64| {
        let mut x = *x;
        x[group.coordinates[k]] += h;
        x
    };
    for i in 0..n {
        for k in 0..n {
            let by_q = slope(|h| rest(&moved(&Q, k, h), &V, i), 1e-3);
            let by_v = slope(|h| rest(&Q, &moved(&V, k, h), i), 1e-3);
            assert!((jacobian.by_position[i * n + k] - by_q).abs() < 1e-8, "{i} {k}");
            assert!((jacobian.by_velocity[i * n + k] - by_v).abs() < 1e-8, "{i} {k}");
        }
    }
}

fn solve(m: &[f64], f: &[f64]) -> Vec<f64> {
    let n = f.len();
    let mut rows: Vec<Vec<f64>> = (0..n).map(|i| [&m[i * n..(i + 1) * n], &f[i..=i]].concat()).collect();
    for k in 0..n {
        let pivot = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            assert!(pivot[k] > 0.0, "positive definite at {i}");
            let factor = row[k] / pivot[k];
            row.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= factor * p);
        }
    }
    (0..n).map(|k| rows[k][n] / rows[k][k]).collect()
}

/// Energy changes by friction and constant torques alone: `d(T + V)/dt = Σ (applied − h q̇) q̇`.
#[test]
fn power_is_accounted_for() {
    let s = mixed();
    let mut a = [0.0; 8];
    for group in &s.coupled {
        let e = evaluate(&s, group, &Q, &V);
        group.coordinates.iter().zip(solve(&e.mass, &e.force)).for_each(|(i, x)| a[*i] = x);
    }
    a[7] = s.coordinates[7].free_acceleration(Q[7], V[7]);
    let energy = |t: f64| {
        let q: Vec<f64> = (0..8).map(|i| Q[i] + t * (V[i] + 0.5 * t * a[i])).collect();
        let v: Vec<f64> = (0..8).map(|i| V[i] + t * a[i]).collect();
        s.kinetic_energy(&q, &v) + s.potential_energy(&q)
    };
    let power: f64 = (0..8).map(|i| (s.forces.applied[i] - s.coordinates[i].damping * V[i]) * V[i]).sum();
    let found = slope(energy, 1e-3);
    assert!((found - power).abs() < 1e-8, "{found} {power}");
}
