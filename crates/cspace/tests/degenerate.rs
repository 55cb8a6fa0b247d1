//! Degenerate parts: coincident arcs, channels of no width, contact along a line, extreme sizes. What comes out is a map that
//! agrees with the overlap test, or a refusal; always within a bound on work, never a panic.

mod common;

use common::{Corner, Random, body, circle, path, polygon, rectangle, slide, system, turn};
use mainspring_cspace::{ConfigurationSpace, SpaceError, SpaceOptions};
use mainspring_geometry::Loop;
use mainspring_mechanism::{Joint, System};

/// Few numbers, so that lengths, angles and radii coincide often.
fn coarse(random: &mut Random) -> f64 {
    [0.0, 0.25, 0.5, 0.5, 1.0, -0.5, -1.0][random.below(7)]
}

fn loops(random: &mut Random) -> Vec<Loop> {
    let r = [0.25, 0.5, 0.5 + 1e-12, 1.0][random.below(4)];
    match random.below(6) {
        0 => vec![circle(coarse(random), coarse(random), r, true, 0)],
        1 => vec![circle(0.0, 0.0, 1.5, true, 0), circle(0.0, 0.0, r, false, 1)],
        2 => {
            let w = [1e-13, 1e-8, 0.25, 0.5][random.below(4)];
            vec![rectangle(-0.5, -w, 1.0, w)]
        }
        3 => {
            // A plate with a slot as wide as bars of kind 2.
            let w = [0.25, 0.25 + 1e-10, 0.5][random.below(3)];
            let slot: [Corner; 4] = [(-1.0, -w, 0.0), (-1.0, w, 0.0), (1.0, w, 0.0), (1.0, -w, 0.0)];
            vec![rectangle(-1.5, -1.5, 1.5, 1.5), path(&slot, 10)]
        }
        4 => {
            // Half discs and lenses: bulges of exactly a half turn.
            let bulge = [1.0, 0.5, -0.25][random.below(3)];
            vec![path(&[(-r, 0.0, bulge), (r, 0.0, 0.0), (0.0, r, 0.0)], 0)]
        }
        _ => {
            let n = 3 + random.below(5);
            let at = |i: usize| {
                let a = i as f64 * std::f64::consts::TAU / n as f64;
                (r * a.cos(), r * a.sin())
            };
            vec![polygon(&(0..n).map(at).collect::<Vec<_>>())]
        }
    }
}

fn joint(random: &mut Random, coordinate: usize) -> Joint {
    let directions = [(1.0, 0.0), (0.0, 1.0), (0.6, 0.8)];
    match random.below(3) {
        0 => {
            let (x, y) = directions[random.below(3)];
            slide(coordinate, x, y)
        }
        _ => turn(coordinate, coarse(random), coarse(random)),
    }
}

fn pair(random: &mut Random) -> (System, SpaceOptions) {
    let (a, b) = (loops(random), loops(random));
    let (i, j) = (joint(random, 0), joint(random, 1));
    let slides = |j: &Joint| matches!(j.motion, mainspring_mechanism::Motion::Slide { .. });
    let windows = [slides(&i).then_some((-2.0, 2.0)), slides(&j).then_some((-2.0, 2.0))];
    let s = system(vec![body("a", vec![i], vec![]), body("b", vec![j], vec![])], 2.0);
    let bodies = s.bodies.into_iter().zip([a, b]).map(|(old, loops)| body(&old.name, old.chain, loops));
    let s = system(bodies.collect(), 2.0);
    (s, SpaceOptions { windows, budget: 200_000, ..SpaceOptions::default() })
}

#[test]
fn degenerate_pairs_are_mapped_rightly_or_refused() {
    let count: u64 = std::env::var("PAIRS").ok().and_then(|s| s.parse().ok()).unwrap_or(1500);
    let (mut mapped, mut refused, mut wrong) = (0, 0, vec![]);
    for seed in 0..count {
        let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        let (s, options) = pair(&mut random);
        let map = match ConfigurationSpace::new(&s, [0, 1], [0, 1], &options) {
            Ok(map) => map,
            Err(SpaceError::Thin { .. }) => continue,
            Err(SpaceError::Degenerate { .. } | SpaceError::TooComplex { .. }) => {
                refused += 1;
                continue;
            }
            Err(other) => panic!("{seed}: {other}"),
        };
        mapped += 1;
        let axes = map.domain();
        let polygons = [0, 1].map(|k| polygon::Polygons::new(&s.bodies[k]));
        let blocked = |q: [f64; 2]| {
            let [a, b] = [0, 1].map(|k| (&s.bodies[k], &polygons[k]));
            polygon::overlap(a, b, &q)
        };
        for _ in 0..40 {
            let q = axes.map(|a| random.next(a.start, a.end()));
            // Near a contact, also one along a whole line, the two may differ.
            let around = [[0.0, 0.0], [1e-6, 0.0], [-1e-6, 0.0], [0.0, 1e-6], [0.0, -1e-6]];
            let free = map.is_free(q);
            let agrees = around.iter().any(|d| blocked([q[0] + d[0], q[1] + d[1]]) != Some(free));
            if !(agrees || touching(&map, q)) {
                wrong.push(format!("{seed}: {q:?} is called {}", if free { "free" } else { "blocked" }));
            }
        }
        assert!(map.components().iter().all(|c| c.area.is_finite()));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(refused * 50 < mapped, "{refused} of {mapped} refused");
}

/// In contact to 1e-6.
fn touching(map: &ConfigurationSpace, q: [f64; 2]) -> bool {
    map.gap(q).is_some_and(|g| g.gap.abs() < 1e-6)
}

#[test]
fn sizes_from_a_millionth_to_a_million() {
    let at = |scale: f64| {
        let bodies = vec![
            body("a", vec![turn(0, 0.0, 0.0)], vec![circle(0.5 * scale, 0.0, scale, true, 0)]),
            body("b", vec![turn(1, 2.2 * scale, 0.0)], vec![circle(2.6 * scale, 0.0, 0.8 * scale, true, 1)]),
        ];
        let s = system(bodies, 4.0 * scale);
        ConfigurationSpace::new(&s, [0, 1], [0, 1], &SpaceOptions::default())
            .unwrap_or_else(|e| panic!("{e}"))
    };
    let plain = at(1.0);
    for scale in [1e-6, 1e-3, 1e3, 1e6] {
        let scaled = at(scale);
        assert_eq!(scaled.components().len(), plain.components().len());
        common::close(scaled.components()[0].area, plain.components()[0].area, 1e-9);
        for k in 0..40 {
            let x = -3.0 + 0.15 * f64::from(k);
            let (one, other) = (plain.slice_first(x), scaled.slice_first(x));
            assert_eq!(one.len(), other.len());
            for (a, b) in one.iter().zip(&other) {
                common::close(a.low, b.low, 1e-7);
                common::close(a.high, b.high, 1e-7);
            }
        }
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    let bodies = vec![
        body("a", vec![turn(0, 0.0, 0.0)], vec![circle(f64::NAN, 0.0, 1.0, true, 0)]),
        body("b", vec![turn(1, 2.0, 0.0)], vec![circle(2.0, 0.0, 1.0, true, 1)]),
    ];
    let made = ConfigurationSpace::new(&system(bodies, 4.0), [0, 1], [0, 1], &SpaceOptions::default());
    assert!(matches!(made, Err(SpaceError::NotFinite { .. })), "{:?}", made.err());
}

/// A pin of radius 0.4 in a channel between two walls, both sliding: the width of the channel less the pin's.
fn channel(play: f64) -> System {
    let (low, high) = (-0.4 - 0.5 * play, 0.4 + 0.5 * play);
    let walls = vec![rectangle(1.0, -2.0, 3.0, low), rectangle(1.0, high, 3.0, 2.0)];
    let bodies = vec![
        body("pin", vec![slide(0, 1.0, 0.0)], vec![circle(0.0, 0.0, 0.4, true, 0)]),
        body("walls", vec![slide(1, 0.0, 1.0)], walls),
    ];
    system(bodies, 4.0)
}

#[test]
fn a_channel_without_width_is_blocked_or_refused() {
    let options = SpaceOptions { windows: [Some((-1.0, 5.0)), Some((-1.0, 1.0))], ..SpaceOptions::default() };
    let map = |play: f64| ConfigurationSpace::new(&channel(play), [0, 1], [0, 1], &options);
    let open = map(1e-6).unwrap_or_else(|e| panic!("{e}"));
    assert!(open.way([0.0, 0.0], [4.0, 0.0]).is_some());
    for play in [0.0, -1e-12, 1e-12] {
        let Ok(map) = map(play) else { continue };
        assert!(map.way([0.0, 0.0], [4.0, 0.0]).is_none(), "a way at play {play}");
        assert!(map.is_free([0.0, 0.3]) && map.is_free([4.0, -0.3]));
        for x in [1.5, 2.0, 2.5] {
            assert!(!map.is_free([x, 1e-3]) && !map.is_free([x, -1e-3]));
        }
        assert_eq!(map.components().len(), 2);
    }
}
