//! Random pairs of parts, by kind: arcs of any sweep, concave arcs, nearly tangent, nearly parallel, nearly concentric, sharp
//! and thin parts, holes, tens of segments.

use super::{Corner, Random, body, oracle, path, reversed, slide, system, turn};
use mainspring_cspace::SpaceOptions;
use mainspring_geometry::Loop;
use mainspring_mechanism::{Joint, Motion, System};
use std::f64::consts::TAU;

/// How many kinds of part there are.
pub const KINDS: usize = 7;

fn small(random: &mut Random, low: f64, high: f64) -> f64 {
    let sign = if random.next(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
    sign * 10f64.powf(random.next(low, high))
}

fn area(corners: &[Corner]) -> f64 {
    path(corners, 0).edges.iter().map(|e| e.segment.area_about(super::p(0.0, 0.0))).sum()
}

/// Corners in the order of their angles; some sides become arcs where they fit.
fn star(random: &mut Random, inner: f64, outer: f64, n: usize) -> Vec<Corner> {
    let mut corners: Vec<Corner> = (0..n)
        .map(|i| {
            let angle = (i as f64 + random.next(-0.35, 0.35)) * TAU / n as f64;
            let r = random.next(inner, outer);
            (r * angle.cos(), r * angle.sin(), 0.0)
        })
        .collect();
    let least = 0.3 * area(&corners).abs();
    for i in 0..n {
        let bulge = match random.below(8) {
            0..=3 => continue,
            4 => small(random, -5.0, -1.0),
            5 => random.next(1.0, 5.0),
            _ => random.next(-0.9, 1.3),
        };
        corners[i].2 = bulge;
        if area(&corners) < least || !oracle::is_simple(&path(&corners, 0)) {
            corners[i].2 = 0.0;
        }
    }
    corners
}

/// Spikes as thin as 1e-5 on a hub, and needles.
fn thin(random: &mut Random) -> Vec<Corner> {
    let width = 10f64.powf(random.next(-5.0, -1.0));
    if random.below(2) == 0 {
        let (s, c) = random.next(0.0, TAU).sin_cos();
        let at = |x: f64, y: f64| (c * x - s * y, s * x + c * y, 0.0);
        return vec![at(-0.3, -width), at(1.0, -0.2 * width), at(1.0, 0.2 * width), at(-0.3, width)];
    }
    let n = 2 + random.below(4);
    (0..n)
        .flat_map(|i| {
            let a = (i as f64 + random.next(-0.2, 0.2)) * TAU / n as f64;
            let tip = random.next(0.6, 1.0);
            let at = |r: f64, a: f64| (r * a.cos(), r * a.sin(), 0.0);
            [at(0.3, a - width), at(tip, a), at(0.3, a + width)]
        })
        .collect()
}

/// A polygon with rounded corners, whose arcs are tangent but for a perturbation.
fn rounded(random: &mut Random, n: usize) -> Vec<Corner> {
    let plain: Vec<(f64, f64)> = (0..n)
        .map(|i| {
            let a = (i as f64 + random.next(-0.3, 0.3)) * TAU / n as f64;
            let r = random.next(0.45, 1.0);
            (r * a.cos(), r * a.sin())
        })
        .collect();
    let tiny = 10f64.powf(random.next(-13.0, -2.0));
    let mut corners = Vec::new();
    for i in 0..n {
        let (p, q, r) = (plain[(i + n - 1) % n], plain[i], plain[(i + 1) % n]);
        let unit = |a: (f64, f64), b: (f64, f64)| {
            let l = (b.0 - a.0).hypot(b.1 - a.1);
            ((b.0 - a.0) / l, (b.1 - a.1) / l, l)
        };
        let (u, v) = (unit(q, p), unit(q, r));
        let cut = random.next(0.05, 0.45) * u.2.min(v.2);
        // The arc turns by the angle between the sides.
        let angle = (-u.0 * v.1 + u.1 * v.0).atan2(-(u.0 * v.0 + u.1 * v.1));
        let mut noise = || random.next(-tiny, tiny);
        corners.push((q.0 + u.0 * cut + noise(), q.1 + u.1 * cut + noise(), (0.25 * angle).tan() + noise()));
        corners.push((q.0 + v.0 * cut + noise(), q.1 + v.1 * cut + noise(), 0.0));
    }
    corners
}

/// A sector of a ring, nearly about the origin.
fn sector(random: &mut Random, r: f64, s: f64) -> Vec<Corner> {
    let (start, sweep) = (random.next(0.0, TAU), random.next(0.2, 5.5));
    let off = (small(random, -10.0, -2.0), small(random, -10.0, -2.0));
    let at = |r: f64, a: f64, bulge: f64| (off.0 + r * a.cos(), off.1 + r * a.sin(), bulge);
    let bulge = (0.25 * sweep).tan();
    vec![at(r, start + sweep, -bulge), at(r, start, 0.0), at(s, start, bulge), at(s, start + sweep, 0.0)]
}

/// A bar along `direction`, but for a tiny angle.
fn bar(random: &mut Random, direction: (f64, f64), half: f64) -> Vec<Corner> {
    let (s, c) = small(random, -10.0, -2.0).sin_cos();
    let (x, y) = (direction.0 * c - direction.1 * s, direction.0 * s + direction.1 * c);
    let at = |l: f64, h: f64| (l * x - h * y, l * y + h * x, 0.0);
    vec![at(-0.7, -half), at(0.7, -half), at(0.7, half), at(-0.7, half)]
}

/// Loops about the origin, of size about 1.
fn part(random: &mut Random, kind: usize, direction: (f64, f64)) -> Vec<Loop> {
    match kind {
        0 => {
            let n = 3 + random.below(7);
            vec![path(&star(random, 0.3, 1.0, n), 0)]
        }
        1 => {
            let n = 20 + random.below(30);
            vec![path(&star(random, 0.75, 1.0, n), 0)]
        }
        2 => vec![path(&thin(random), 0)],
        3 => {
            let (n, m) = (4 + random.below(6), 3 + random.below(6));
            let outer = star(random, 0.9, 1.2, n);
            let hole = star(random, 0.3, 0.5, m);
            let loops = vec![path(&outer, 0), path(&reversed(&hole), 100)];
            if oracle::are_apart(&loops) { loops } else { loops[..1].to_vec() }
        }
        4 => {
            let n = 3 + random.below(5);
            vec![path(&rounded(random, n), 0)]
        }
        5 => {
            let near = small(random, -9.0, -1.0).abs();
            let (r, s) = if random.below(2) == 0 { (0.5 - near, 0.9) } else { (0.2, 0.5 - near) };
            vec![path(&sector(random, r, s), 0)]
        }
        _ => {
            let half = random.next(0.05, 0.3);
            vec![path(&bar(random, direction, half), 0)]
        }
    }
}

fn shifted(loops: Vec<Loop>, x: f64, y: f64) -> Vec<Loop> {
    use mainspring_geometry::Segment;
    let d = super::p(x, y);
    let mut loops = loops;
    for e in loops.iter_mut().flat_map(|l| &mut l.edges) {
        match &mut e.segment {
            Segment::Line { from, to } => (*from, *to) = (*from + d, *to + d),
            Segment::Arc { from, to, center, .. } => {
                (*from, *to, *center) = (*from + d, *to + d, *center + d);
            }
            Segment::Circle { center, .. } => *center = *center + d,
        }
    }
    loops
}

/// A pair with its options. The kinds of the parts and of the joints follow from the seed.
pub fn pair(seed: u64) -> (System, SpaceOptions, String) {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let (i, j, joints) = (random.below(KINDS), random.below(KINDS), random.below(7));
    let angle = random.next(0.0, TAU);
    let direction = (angle.cos(), angle.sin());
    let mut valid = |kind: usize| {
        for _ in 0..50 {
            let loops = part(&mut random, kind, direction);
            if loops.iter().all(oracle::is_simple) && oracle::are_apart(&loops) {
                return loops;
            }
        }
        vec![super::rectangle(-0.5, -0.3, 0.5, 0.3)]
    };
    let (a, mut b) = (valid(i), valid(j));
    // Nearly concentric parts, parts beside each other, parts in one another's hole.
    let close = joints == 1 || (i == 3 && joints == 2);
    let (x, y) = if close {
        (small(&mut random, -10.0, -1.5), small(&mut random, -10.0, -1.5))
    } else {
        (random.next(0.5, 1.8), random.next(-0.3, 0.3))
    };
    let shift = if close && i != 5 { random.next(0.0, 0.6) } else { 0.0 };
    b = shifted(b, x + shift, y);
    let ratio = if random.below(3) == 0 { random.next(-3.0, 3.0) } else { 1.0 };
    let geared = |joint: Joint| Joint { ratio, ..joint };
    let off = if joints == 4 { random.next(-0.2, 0.2) } else { 0.0 };
    let chains = match joints {
        0..=2 => [vec![turn(0, 0.0, 0.0)], vec![geared(turn(1, x, y))]],
        3 => [vec![turn(0, 0.0, 0.0)], vec![slide(1, direction.0, direction.1)]],
        4 => [vec![slide(0, direction.0, direction.1)], vec![geared(turn(1, x + off, y))]],
        5 => [vec![slide(0, 0.28, 0.96)], vec![slide(1, direction.0, direction.1)]],
        _ => [vec![], vec![turn(0, 0.3, 0.1), geared(turn(1, x, y))]],
    };
    let [ca, cb] = chains;
    let named = format!("seed {seed}: parts {i} {j}, joints {joints}, ratio {ratio}");
    let s = system(vec![body("a", ca, a), body("b", cb, b)], 2.0);
    let window = |k: usize| {
        let slides = s
            .bodies
            .iter()
            .flat_map(|b| &b.chain)
            .any(|j| j.coordinate == k && matches!(j.motion, Motion::Slide { .. }));
        slides.then_some((-2.0, 2.0))
    };
    let periodic = random.below(2) == 0;
    let options = SpaceOptions { windows: [window(0), window(1)], periodic, ..SpaceOptions::default() };
    (s, options, named)
}
