//! Machines for the tests, with joints given by hand: contact is tested without relying on what finds the joints.
#![allow(dead_code)]

pub mod examples;
pub mod overlap;

use mainspring_dynamics::{Compliant, Minimum, Options, Run, Simulation};
use mainspring_geometry::{OutlineRecipe, Rigid3, Vec2};
use mainspring_mechanism::{
    Body, ContactLaw, Coordinate, Drive, Exclusion, Forces, Joint, Mass, Motion, System,
};
use mainspring_model::Machine;

/// A coordinate with a spring `(constant, relaxed)`.
pub fn coordinate(name: &str, inertia: f64, damping: f64, spring: (f64, f64)) -> Coordinate {
    let (stiffness, relaxed) = spring;
    Coordinate {
        name: name.into(),
        inertia,
        damping,
        stiffness,
        force: stiffness * relaxed,
        energy_at_zero: 0.5 * stiffness * relaxed * relaxed,
        position: 0.0,
        velocity: 0.0,
    }
}

pub fn turn(coordinate: usize, x: f64, y: f64) -> Joint {
    Joint { coordinate, ratio: 1.0, motion: Motion::Turn { center: Vec2::new(x, y) } }
}

pub fn slide(coordinate: usize, x: f64, y: f64) -> Joint {
    Joint { coordinate, ratio: 1.0, motion: Motion::Slide { direction: Vec2::new(x, y) } }
}

/// Bodies from a text of the input language; `joints` by part name in lower case, others are fixed.
pub fn bodies(text: &str, joints: &[(&str, Joint)]) -> Vec<Body> {
    let machine = Machine::parse("test.padl", text.as_bytes(), None).unwrap();
    let values = machine.values(&[]).unwrap();
    let primitives = machine.primitives(&values).unwrap();
    let plane = Rigid3::identity();
    machine
        .parts()
        .iter()
        .map(|part| {
            let outline =
                OutlineRecipe::find(&primitives, &part.csg, &plane).unwrap().evaluate(&primitives, &plane);
            let name = part.name.to_lowercase();
            let chain = joints.iter().filter(|(n, _)| *n == name).map(|(_, j)| *j).collect();
            Body { name, chain, outline }
        })
        .collect()
}

/// The same with chains of joints, from the frame outwards.
pub fn chained(text: &str, chains: &[(&str, &[Joint])]) -> Vec<Body> {
    let mut found = bodies(text, &[]);
    for body in &mut found {
        let chain = chains.iter().find(|(n, _)| *n == body.name);
        body.chain = chain.map_or(vec![], |(_, joints)| joints.to_vec());
    }
    found
}

/// Surfaces on which two bodies turn: circles about the same centre of the same radius.
pub fn journals(bodies: &[Body]) -> Vec<Exclusion> {
    let mut found = Vec::new();
    for (i, a) in bodies.iter().enumerate() {
        for (j, _) in bodies.iter().enumerate().skip(i + 1) {
            let mut curves = vec![];
            for joint in bodies[j].chain.iter().chain(&a.chain) {
                let Motion::Turn { center } = joint.motion else { continue };
                for body in [a, &bodies[j]] {
                    let edges = body.outline.layers.iter().flat_map(|l| &l.loops).flat_map(|l| &l.edges);
                    for edge in edges {
                        if let mainspring_geometry::Segment::Circle { center: c, .. } = edge.segment
                            && (c - center).norm() < 1e-12
                        {
                            curves.push(edge.curve);
                        }
                    }
                }
            }
            found.push(Exclusion { bodies: (i, j), curves });
        }
    }
    found
}

/// The coordinates of the escapement with the supplement of Fig. 13: wheel, lever, balance.
pub fn fig_13() -> Vec<Coordinate> {
    let degree = std::f64::consts::PI / 180.0;
    vec![
        coordinate("ewheel", 200.0, 20.0, (20.0, -10000.0 * degree)),
        coordinate("lever", 10.0, 5.0, (0.0, 0.0)),
        coordinate("bwheel", 20.0, 6.0, (15.0, 90.0 * degree)),
    ]
}

/// The escapement of Fig. 12 with the supplement of Fig. 13, its joints given.
pub fn escapement() -> System {
    escapement_with(fig_13())
}

/// The escapement of Fig. 12 with other inertias, friction or springs.
pub fn escapement_with(coordinates: Vec<Coordinate>) -> System {
    let text = include_str!("../../../../examples/escapement/escapement.padl");
    let joints =
        [("ewheel", turn(0, 0.0, 0.0)), ("lever", turn(1, 0.0, 7.5)), ("bwheel", turn(2, 0.0, 20.0))];
    let bodies = bodies(text, &joints);
    let exclusions = journals(&bodies);
    System::new(coordinates, bodies, &exclusions, 31.0)
}

/// The escapement with other balances and mainsprings, and its tenth low minimum with rigid contact, as calculated
/// independently.
pub fn changed_escapements() -> Vec<(System, f64)> {
    let spring = |c: &mut Coordinate, constant: f64| {
        let relaxed = c.force / c.stiffness;
        *c = coordinate(&c.name, c.inertia, c.damping, (constant, relaxed));
    };
    type Change<'c> = (&'c dyn Fn(&mut [Coordinate]), f64);
    let changes: [Change; 6] = [
        (&|c| spring(&mut c[2], 25.0), 28.518_098_7),
        (&|c| c[2].inertia = 15.0, 32.258_884_9),
        (&|c| c[2].inertia = 30.0, 44.961_627_4),
        (&|c| spring(&mut c[0], 12.0), 36.962_480_7),
        (&|c| spring(&mut c[0], 30.0), 36.919_732_9),
        (&|c| c[2].damping = 10.0, 38.026_761_2),
    ];
    let one = |(change, tenth): Change| {
        let mut coordinates = fig_13();
        change(&mut coordinates);
        (escapement_with(coordinates), tenth)
    };
    changes.into_iter().map(one).collect()
}

/// A system of bodies without surfaces of lower pairs.
pub fn system(coordinates: Vec<Coordinate>, text: &str, joints: &[(&str, Joint)], size: f64) -> System {
    System::new(coordinates, bodies(text, joints), &[], size)
}

/// Runs to a time with a tolerance, with the unpruned overlap check beside it: at every step and half way between,
/// or at so many instants of a run that is longer.
pub fn run(system: &System, until: f64, rtol: f64) -> Run {
    let source = system.direct_search();
    let mut run = Simulation::new(system, &source, Options { until, rtol, ..Options::default() });
    run.run(&mut |_| true);
    let run = run.into_run();
    overlap::assert_free(system, &run);
    run
}

/// Runs with compliant contact to a time with a tolerance.
pub fn push(system: &System, law: ContactLaw, until: f64, rtol: f64) -> Run {
    let source = system.direct_search();
    let mut run = Compliant::new(system, &source, law, Options { until, rtol, ..Options::default() });
    run.run(&mut |_| true);
    run.into_run()
}

/// Minima below 1e-5 of the greatest kinetic energy so far (those of Algorithm 12).
pub fn low_minima(run: &Run) -> Vec<&Minimum> {
    run.minima.iter().filter(|m| m.energy < 1e-5 * m.top).collect()
}

/// Asserts `|a − b| ≤ tolerance` and says how far off.
pub fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} is {:e} off {b}, allowed {tolerance:e}", (a - b).abs());
}

/// Asserts an energy account that balances to 1e-7.
pub fn balanced(run: &Run) {
    let residual = run.energy.residual();
    assert!(residual.abs() < 1e-7, "energy residual {residual:e}: {:?}", run.energy);
    assert!(run.energy.friction >= 0.0 && run.energy.impacts >= 0.0, "{:?}", run.energy);
}

/// A mass on a chain of joints.
pub fn on_chain(body: usize, mass: f64, center: (f64, f64), inertia: f64) -> Mass {
    Mass { body, mass, center: Vec2::new(center.0, center.1), inertia, chained: true }
}

/// Integrates `y' = f(t, y)` by extrapolation of the midpoint rule (Gragg, Bulirsch, Stoer): eight halved substeps a step,
/// independent of the method under test.
pub fn extrapolate(
    f: impl Fn(f64, &[f64]) -> Vec<f64>,
    (from, to): (f64, f64),
    start: &[f64],
    steps: u32,
) -> Vec<f64> {
    let mut y = start.to_vec();
    let h = (to - from) / f64::from(steps);
    let add =
        |y: &[f64], d: &[f64], h: f64| -> Vec<f64> { y.iter().zip(d).map(|(y, d)| y + h * d).collect() };
    for k in 0..steps {
        let t = from + h * f64::from(k);
        let midpoint = |n: u32| {
            let s = h / f64::from(n);
            let (mut a, mut b) = (y.clone(), add(&y, &f(t, &y), s));
            for i in 1..n {
                let c = add(&a, &f(t + s * f64::from(i), &b), 2.0 * s);
                (a, b) = (b, c);
            }
            let last = add(&b, &f(t + h, &b), s);
            a.iter().zip(&last).map(|(a, c)| 0.5 * (a + c)).collect::<Vec<f64>>()
        };
        let counts: Vec<u32> = (1..=8).map(|i| 2 * i).collect();
        let mut rows: Vec<Vec<f64>> = counts.iter().map(|n| midpoint(*n)).collect();
        for order in 1..rows.len() {
            for i in (order..rows.len()).rev() {
                let ratio = (f64::from(counts[i]) / f64::from(counts[i - order])).powi(2);
                let better: Vec<f64> =
                    rows[i].iter().zip(&rows[i - 1]).map(|(a, b)| a + (a - b) / (ratio - 1.0)).collect();
                rows[i] = better;
            }
        }
        y = rows.pop().unwrap();
    }
    y
}

/// A generator of numbers in [low, high) that is the same everywhere.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        low + (high - low) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Blocks in a row along x, `gap` between one and the next; each with its dry friction and a constant force; drives by
/// block.
pub fn row(gap: f64, blocks: &[(Coordinate, f64, f64)], drives: Vec<Option<Drive>>) -> System {
    let names: Vec<String> = (0..blocks.len()).map(|k| format!("b{k}")).collect();
    let solids: String =
        (0..blocks.len()).map(|k| format!("b{k} = blo() at (movx={})\n", k as f64 * (1.0 + gap))).collect();
    let text = format!(
        "generic m(m)\n{solids}f = blo() at (movy=9)\nattr f : frame = 1\nm = {} asb f\n",
        names.join(" asb ")
    );
    let joints: Vec<(&str, Joint)> =
        names.iter().enumerate().map(|(k, n)| (n.as_str(), slide(k, 1.0, 0.0))).collect();
    let mut coordinates: Vec<Coordinate> = blocks.iter().map(|b| b.0.clone()).collect();
    for (c, b) in coordinates.iter_mut().zip(blocks) {
        c.force += b.2;
    }
    let forces = Forces {
        coulomb: blocks.iter().map(|b| b.1).collect(),
        applied: blocks.iter().map(|b| b.2).collect(),
        drives,
        ..Forces::none(blocks.len())
    };
    System::new(coordinates, bodies(&text, &joints), &[], 10.0).with_forces(forces)
}
