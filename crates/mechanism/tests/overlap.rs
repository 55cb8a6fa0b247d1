//! The depth of an overlap: continuous as corners pass corners, the shortest way out for convex parts, the same
//! whichever part comes first and wherever both are. And second derivatives of gaps.

use mainspring_geometry::{CurveId, Edge, Layer, Loop, Outline, Segment, Turn, Vec2};
use mainspring_mechanism::{
    Body, Candidate, ContactId, Coordinate, GapKind, GapState, Joint, Motion, Overlaps, Placed, System,
    gap_state, is_on,
};

/// Numbers that look random, the same every time.
struct Random(u64);

impl Random {
    fn next(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1u64 << 53) as f64)
    }
}

fn turned(p: Vec2, angle: f64) -> Vec2 {
    let (s, c) = angle.sin_cos();
    Vec2::new(c * p.x - s * p.y, s * p.x + c * p.y)
}

/// A convex polygon of 3 to 6 corners around the origin, counterclockwise; corners on a circle of radius 1 with gaps
/// of at least 0.5.
fn polygon(random: &mut Random) -> Vec<Vec2> {
    let n = random.next(3.0, 6.99) as usize;
    let free = std::f64::consts::TAU - 0.5 * n as f64;
    let mut marks: Vec<f64> = (0..n).map(|_| random.next(0.0, free)).collect();
    marks.sort_by(f64::total_cmp);
    let turn = random.next(0.0, 6.0);
    marks.iter().enumerate().map(|(i, m)| turned(Vec2::new(1.0, 0.0), turn + m + 0.5 * i as f64)).collect()
}

fn outline(corners: &[Vec2]) -> Outline {
    let edge = |i: usize| Edge {
        segment: Segment::Line { from: corners[i], to: corners[(i + 1) % corners.len()] },
        curve: CurveId { primitive: i as u32, face: 0 },
        aliases: vec![],
        turn_at_start: Turn::Convex,
    };
    let edges = (0..corners.len()).map(edge).collect();
    Outline { layers: vec![Layer { bottom: 0.0, top: 1.0, loops: vec![Loop { edges }] }] }
}

fn coordinate() -> Coordinate {
    Coordinate::free("", 1.0)
}

/// The first body moves by (x, y, angle about its own origin), the second is fixed; or the other way round.
fn system(a: &[Vec2], b: &[Vec2], swapped: bool) -> System {
    let slide = |coordinate, x, y| Joint {
        coordinate,
        ratio: 1.0,
        motion: Motion::Slide { direction: Vec2::new(x, y) },
    };
    let turn = Joint { coordinate: 2, ratio: 1.0, motion: Motion::Turn { center: Vec2::default() } };
    let chain = vec![slide(0, 1.0, 0.0), slide(1, 0.0, 1.0), turn];
    let mut bodies = vec![
        Body { name: "a".into(), chain, outline: outline(a) },
        Body { name: "b".into(), chain: vec![], outline: outline(b) },
    ];
    if swapped {
        bodies.reverse();
    }
    System::new(vec![coordinate(), coordinate(), coordinate()], bodies, &[], 2.0)
}

/// Follows the one tip of a pair of convex bodies along a path.
struct Follower<'a, P> {
    system: &'a System,
    overlaps: Overlaps<'a>,
    path: P,
    s: f64,
    tip: Option<Candidate>,
    hands: u32,
}

impl<'a, P: Fn(f64) -> [f64; 3]> Follower<'a, P> {
    fn new(system: &'a System, path: P) -> Self {
        Self { system, overlaps: Overlaps::new(system), path, s: f64::NAN, tip: None, hands: 0 }
    }

    fn placed(&self, s: f64) -> Vec<Placed<'a>> {
        let q = (self.path)(s);
        self.system.bodies.iter().map(|b| Placed::new(b, &q)).collect()
    }

    fn state(&self, c: &Candidate, s: f64) -> GapState {
        let (placed, lists) = (self.placed(s), &self.system.features);
        let f = (&lists[0][c.id.first as usize], &lists[1][c.id.second as usize]);
        gap_state(c.kind, f.0, f.1, &placed[0].pose, &placed[1].pose)
    }

    /// The pair that takes over from the tip at `s`.
    fn hand_over(&mut self, s: f64) {
        for _ in 0..5 {
            let Some(tip) = self.tip else { return };
            let (placed, state) = (self.placed(s), self.state(&tip, s));
            let poses = (&placed[0].pose, &placed[1].pose);
            let Some(next) = self.overlaps.successor(&tip, &state, poses, &mut vec![]) else { return };
            self.tip = Some(next.candidate);
            self.hands += 1;
        }
    }

    /// Moves on to `s`; the depth there, 0 without overlap. Where the tip leaves its features is found first, as in a
    /// simulation.
    fn depth(&mut self, s: f64) -> f64 {
        if let Some(tip) = self.tip
            && is_on(&self.state(&tip, self.s))
            && !is_on(&self.state(&tip, s))
        {
            let (mut on, mut off) = (self.s, s);
            for _ in 0..60 {
                let middle = 0.5 * (on + off);
                if is_on(&self.state(&tip, middle)) { on = middle } else { off = middle }
            }
            self.hand_over(off);
        }
        self.s = s;
        self.hand_over(s);
        self.tip = self.tip.filter(|tip| self.state(tip, s).gap < 0.0);
        if self.tip.is_none() {
            self.tip = self.made(s);
        }
        self.tip.map_or(0.0, |tip| -self.state(&tip, s).gap)
    }

    /// A tip is made where a pair comes to overlap: for convex bodies the least overlap with opposing normals.
    fn made(&self, s: f64) -> Option<Candidate> {
        let lists = &self.system.features;
        let pairs = (0..lists[0].len()).flat_map(|i| (0..lists[1].len()).map(move |j| (i, j)));
        let candidate = |(i, j): (usize, usize)| {
            let kind = GapKind::of(&lists[0][i], &lists[1][j])?;
            let id = ContactId { interaction: 0, first: i as u32, second: j as u32 };
            Some(Candidate { id, kind, distance: 0.0 })
        };
        let valid = pairs.filter_map(candidate).filter(|c| self.state(c, s).cone_margin >= 0.0);
        let best = valid.max_by(|a, b| self.state(a, s).gap.total_cmp(&self.state(b, s).gap));
        best.filter(|c| self.state(c, s).gap < 0.0 && is_on(&self.state(c, s)))
    }
}

/// The least translation that parts two convex polygons; negative if they are apart. By projection on all normals.
fn shortest_way_out(a: &[Vec2], b: &[Vec2]) -> f64 {
    let normals = |p: &[Vec2]| -> Vec<Vec2> {
        (0..p.len()).map(|i| -(p[(i + 1) % p.len()] - p[i]).unit().perp()).collect()
    };
    let along = |n: Vec2, p: &[Vec2], q: &[Vec2]| {
        let top = p.iter().map(|c| n.dot(*c)).fold(f64::MIN, f64::max);
        top - q.iter().map(|c| n.dot(*c)).fold(f64::MAX, f64::min)
    };
    let first = normals(a).into_iter().map(|n| along(n, a, b));
    first.chain(normals(b).into_iter().map(|n| along(n, b, a))).fold(f64::MAX, f64::min)
}

fn moved(p: &[Vec2], q: &[f64; 3]) -> Vec<Vec2> {
    p.iter().map(|c| turned(*c, q[2]) + Vec2::new(q[0], q[1])).collect()
}

/// A path of the first polygon past the second: one of its corners runs close by one of the other's, along an almost
/// straight line, while it turns a little. None if the corners cannot face each other well.
fn path(a: &[Vec2], b: &[Vec2], random: &mut Random) -> Option<impl Fn(f64) -> [f64; 3] + use<>> {
    let (i, j) = (random.next(0.0, a.len() as f64) as usize, random.next(0.0, b.len() as f64) as usize);
    // Corners lie on circles: the middle of a cone is about the direction from the centre.
    let (p, q) = (a[i], b[j]);
    let facing = q.y.atan2(q.x) + std::f64::consts::PI - p.y.atan2(p.x) + random.next(-0.5, 0.5);
    let along = q.perp() * if random.next(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 };
    let deep = random.next(-0.01, 0.025);
    let (spin, bend) = (random.next(-0.5, 0.5), random.next(-1.0, 1.0));
    let start = move |s: f64| {
        let angle = facing + spin * s;
        let at = q - q * deep + along * s + q * (bend * s * s) - turned(p, angle);
        [at.x, at.y, angle]
    };
    // The corners must be the only place where the parts are near.
    (shortest_way_out(&moved(a, &start(0.0)), b).abs() < 0.03).then_some(start)
}

/// Sequences of depths along random paths agree with the shortest way out, and never jump.
#[test]
fn depth_is_the_shortest_way_out_and_continuous() {
    let mut random = Random(7);
    let (mut paths, mut hands, mut overlapped) = (0, 0, 0);
    while paths < 120 {
        let (a, b) = (polygon(&mut random), polygon(&mut random));
        let Some(path) = path(&a, &b, &mut random) else { continue };
        paths += 1;
        let system = system(&a, &b, false);
        let mut follower = Follower::new(&system, &path);
        let steps = 1500;
        let mut last: Option<([f64; 3], f64)> = None;
        for k in 0..=steps {
            let s = -0.1 + 0.2 * f64::from(k) / f64::from(steps);
            let (q, depth) = (path(s), follower.depth(s));
            let expected = shortest_way_out(&moved(&a, &q), &b).max(0.0);
            assert!(
                (depth - expected).abs() < 1e-12,
                "{depth} against {expected} at step {k} of path {paths}"
            );
            if let Some((before, d)) = last {
                let travelled = (q[0] - before[0]).hypot(q[1] - before[1]) + (q[2] - before[2]).abs();
                assert!((depth - d).abs() <= 1.0001 * travelled + 1e-15, "{d} to {depth}");
            }
            overlapped += u32::from(depth > 0.0);
            last = Some((q, depth));
        }
        hands += follower.hands;
    }
    assert!(hands > 80 && overlapped > 40_000, "{hands} hand-overs, {overlapped} states that overlap");
}

/// Swapping the parts changes nothing, and neither does moving both.
#[test]
fn depth_is_symmetric_and_moves_along() {
    let mut random = Random(11);
    let mut paths = 0;
    while paths < 40 {
        let (a, b) = (polygon(&mut random), polygon(&mut random));
        let Some(path) = path(&a, &b, &mut random) else { continue };
        paths += 1;
        let (turn, shift) = (random.next(-3.0, 3.0), Vec2::new(random.next(-5.0, 5.0), 3.0));
        let elsewhere: Vec<Vec2> = b.iter().map(|c| turned(*c, turn) + shift).collect();
        let machines = [system(&a, &b, false), system(&a, &b, true), system(&a, &elsewhere, false)];
        let there = |s: f64| {
            let q = path(s);
            let center = turned(Vec2::new(q[0], q[1]), turn) + shift;
            [center.x, center.y, q[2] + turn]
        };
        let mut first = Follower::new(&machines[0], &path);
        let mut second = Follower::new(&machines[1], &path);
        let mut third = Follower::new(&machines[2], there);
        for k in 0..=400 {
            let s = -0.1 + 0.2 * f64::from(k) / 400.0;
            let depths = [first.depth(s), second.depth(s), third.depth(s)];
            depths.iter().for_each(|d| assert!((d - depths[0]).abs() < 1e-13, "{depths:?}"));
        }
    }
}

/// A deep trial state of a pair lies on the smooth continuation of its gap, and its depth grows with the motion.
#[test]
fn deep_states_extrapolate() {
    let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec2::new(x, y));
    let wedge = [(0.0, 0.0), (1.0, 2.0), (-1.0, 2.0)].map(|(x, y)| Vec2::new(x, y));
    let system = system(&wedge, &square, false);
    let mut follower = Follower::new(&system, |_| [0.1, 0.999, 0.0]);
    follower.depth(0.0);
    let tip = follower.tip.expect("overlaps");
    for deep in [0.01, 0.5, 1.5, 4.0, 50.0] {
        let q = [0.1, 1.0 - deep, 0.0];
        let placed: Vec<Placed> = system.bodies.iter().map(|b| Placed::new(b, &q)).collect();
        let f = (&system.features[0][tip.id.first as usize], &system.features[1][tip.id.second as usize]);
        let state = gap_state(tip.kind, f.0, f.1, &placed[0].pose, &placed[1].pose);
        assert!((state.gap + deep).abs() < 1e-13, "{} at {deep}", state.gap);
    }
}

/// H from polarisation gives back the bias along any velocity, and is symmetric.
#[test]
fn second_derivatives_give_the_bias() {
    let mut random = Random(3);
    for _ in 0..200 {
        let (a, b) = (polygon(&mut random), polygon(&mut random));
        let mut system = system(&a, &b, false);
        let motion = Motion::Turn { center: Vec2::new(0.3, -0.8) };
        system.bodies[1].chain = vec![Joint { coordinate: 2, ratio: -1.5, motion }];
        let q = [random.next(-1.0, 1.0), random.next(-1.0, 1.0), random.next(-3.0, 3.0)];
        let v = [random.next(-1.0, 1.0), random.next(-1.0, 1.0), random.next(-3.0, 3.0)];
        let placed: Vec<Placed> = system.bodies.iter().map(|b| Placed::new(b, &q)).collect();
        for x in &system.features[0] {
            for y in &system.features[1] {
                let Some(kind) = GapKind::of(x, y) else { continue };
                let state = gap_state(kind, x, y, &placed[0].pose, &placed[1].pose);
                let row = state.row(&placed[0], &placed[1]);
                let h = state.hessian(&placed[0], &placed[1], &row, &mut [0.0; 3]).entries;
                let mut sum = 0.0;
                for i in 0..row.count {
                    for j in 0..row.count {
                        assert_eq!(h[i][j], h[j][i]);
                        sum += h[i][j] * v[row.coordinate[i]] * v[row.coordinate[j]];
                    }
                }
                let bias = state.bias(&placed[0], &placed[1], &v);
                assert!((sum - bias).abs() < 1e-11 * (1.0 + bias.abs()), "{sum} against {bias}");
            }
        }
    }
}
