//! The map against an overlap test of its own kind: random parts, half of the configurations close to the curves.

mod common;

use common::{Random, body, oracle, path, slide, star, system, turn};
use mainspring_cspace::{ConfigurationSpace, SpaceOptions};
use mainspring_mechanism::{Body, System};

/// A configuration is judged wrong when the map and every configuration within 1e-6 of the size disagree.
fn wrong(bodies: (&Body, &Body), q: [f64; 2], free: bool, step: [f64; 2]) -> bool {
    let agrees = |q: [f64; 2]| oracle::overlap(bodies.0, bodies.1, &q) != free;
    if agrees(q) {
        return false;
    }
    (0..24).all(|k| {
        let (s, c) = (k as f64 * std::f64::consts::TAU / 24.0).sin_cos();
        !agrees([q[0] + c * step[0], q[1] + s * step[1]])
    })
}

fn compare(system: &System, options: &SpaceOptions, random: &mut Random, count: usize, what: &str) -> usize {
    let space =
        ConfigurationSpace::new(system, [0, 1], [0, 1], options).unwrap_or_else(|e| panic!("{what}: {e}"));
    let [x, y] = space.domain();
    let bodies = (&system.bodies[0], &system.bodies[1]);
    let curves = space.curves();
    let step = [1e-6, 1e-6];
    let mut free = 0;
    for k in 0..count {
        let near = k % 2 == 0 && !curves.is_empty();
        let q = if near {
            let curve = &curves[random.below(curves.len())];
            let at = curve.at(random.next(0.0, 1.0));
            let off = 10f64.powf(random.next(-6.0, -3.0));
            [at[0] + random.next(-off, off), at[1] + random.next(-off, off)]
        } else {
            [random.next(x.start, x.end()), random.next(y.start, y.end())]
        };
        let inside = |a: &mainspring_cspace::Axis, v: f64| a.wraps || (v > a.start && v < a.end());
        if !inside(&x, q[0]) || !inside(&y, q[1]) {
            continue;
        }
        let says = space.is_free(q);
        free += usize::from(says);
        assert!(
            !wrong(bodies, q, says, step),
            "{what}: {q:?} called {}",
            if says { "free" } else { "blocked" }
        );
    }
    free
}

fn pair(random: &mut Random, kind: usize) -> (System, SpaceOptions) {
    let (n, m) = (3 + random.below(7), 3 + random.below(7));
    let distance = random.next(1.1, 1.9);
    let (x, y) = (random.next(-0.2, 0.2), random.next(-0.2, 0.2));
    let a = path(&star(random, (x, 0.1), 0.3, 1.0, n), 0);
    let b = path(&star(random, (distance, y), 0.3, 1.0, m), 100);
    let joints = match kind {
        0 => [turn(0, 0.0, 0.0), turn(1, distance, 0.0)],
        1 => [turn(0, 0.0, 0.0), slide(1, 0.6, 0.8)],
        2 => [slide(0, 0.8, -0.6), turn(1, distance, 0.0)],
        _ => [slide(0, 0.28, 0.96), slide(1, 1.0, 0.0)],
    };
    let [ja, jb] = joints;
    let s = system(vec![body("a", vec![ja], vec![a]), body("b", vec![jb], vec![b])], 2.0);
    let mut options = SpaceOptions::default();
    if kind == 3 {
        options.windows = [Some((-2.0, 2.0)), Some((-2.5, 2.5))];
    }
    (s, options)
}

#[test]
fn random_pairs_agree() {
    let count: usize = std::env::var("PAIRS").ok().and_then(|s| s.parse().ok()).unwrap_or(40);
    let seed: usize = std::env::var("SEED").ok().and_then(|s| s.parse().ok()).unwrap_or(0);
    for k in seed..seed + count {
        let mut random = Random(1000 + k as u64);
        let (system, options) = pair(&mut random, k % 4);
        compare(&system, &options, &mut random, 1500, &format!("pair {k}"));
    }
}
