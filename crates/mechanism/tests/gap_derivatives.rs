//! The gap's derivatives in closed form against dual numbers, for every kind, for turning and sliding bodies,
//! and for chains of two joints.

use mainspring_geometry::Scalar;
use mainspring_mechanism::{
    Body, Constraint, Feature, FeatureShape, GapKind, Hinge, HingeConstraint, Joint, Motion, Moving, Placed,
    Relative, approach, features, gap, gap_between, gap_state,
};
use num_dual::{Dual2_64, Dual64};
use shapes::{outline, p};

#[path = "support/shapes.rs"]
mod shapes;

fn bodies() -> Vec<Body> {
    let turn =
        |coordinate, ratio, x, y| Joint { coordinate, ratio, motion: Motion::Turn { center: p(x, y) } };
    let slide =
        |coordinate, ratio, x, y| Joint { coordinate, ratio, motion: Motion::Slide { direction: p(x, y) } };
    let chains = [
        vec![],
        vec![turn(0, 1.0, 0.5, -0.7)],
        vec![turn(1, -2.5, -1.0, 0.3)],
        vec![slide(2, 1.0, 0.6, 0.8)],
        vec![turn(0, 1.0, 0.5, -0.7), turn(1, 0.7, 1.5, 0.2)],
        vec![turn(1, 1.0, 0.1, 0.9), slide(2, 1.3, 0.0, 1.0)],
        vec![slide(2, 1.0, 1.0, 0.0), turn(3, 1.0, 0.2, 0.3)],
    ];
    let shift = |i: usize| p(0.7 * i as f64, 0.9 - 0.4 * i as f64);
    chains
        .into_iter()
        .enumerate()
        .map(|(i, chain)| Body { name: format!("b{i}"), chain, outline: outline(shift(i)) })
        .collect()
}

#[test]
fn rows_and_biases_agree_with_dual_numbers() {
    let (bodies, q, v) = (bodies(), [0.37, -0.81, 0.45, 1.2], [0.9, -1.3, 0.6, 0.4]);
    let mut kinds = [0; 3];
    for (i, a) in bodies.iter().enumerate() {
        for (j, b) in bodies.iter().enumerate().filter(|(j, _)| *j != i) {
            let (fa, fb) = (features(&a.outline, 5.0), features(&b.outline, 5.0));
            for (x, y) in fa.iter().flat_map(|x| fb.iter().map(move |y| (x, y))) {
                let Some(kind) = GapKind::of(x, y) else { continue };
                check((a, b), (x, y), kind, &q, &v, &format!("{i} {j} {kind:?}"));
                kinds[match kind {
                    GapKind::RoundEdge { .. } => 0,
                    GapKind::RoundRound => 1,
                    GapKind::RoundHollow { .. } => 2,
                }] += 1;
            }
        }
    }
    assert!(kinds.iter().all(|&n| n > 50), "every kind was met: {kinds:?}");
}

fn check(
    bodies: (&Body, &Body),
    f: (&Feature, &Feature),
    kind: GapKind,
    q: &[f64; 4],
    v: &[f64; 4],
    what: &str,
) {
    let placed = (Placed::new(bodies.0, q), Placed::new(bodies.1, q));
    let state = gap_state(kind, f.0, f.1, &placed.0.pose, &placed.1.pose);
    let value = gap(bodies, f, q).unwrap();
    assert!((state.gap - value).abs() < 1e-13, "{what}: gap {} against {value}", state.gap);

    let along: Vec<Dual2_64> = (0..4).map(|i| Dual2_64::new(q[i], v[i], 0.0)).collect();
    let path = gap(bodies, f, &along).unwrap();
    let rate = state.rate(&placed.0, &placed.1, v);
    assert!((rate - path.v1).abs() < 1e-12 * (1.0 + rate.abs()), "{what}: rate {rate} against {}", path.v1);
    let bias = state.bias(&placed.0, &placed.1, v);
    assert!((bias - path.v2).abs() < 1e-10 * (1.0 + bias.abs()), "{what}: bias {bias} against {}", path.v2);

    let dv = [-0.7, 0.4, 1.1, -1.9];
    let path: Vec<Dual2_64> = (0..4).map(|i| Dual2_64::new(q[i], v[i], dv[i])).collect();
    let path = gap(bodies, f, &path).unwrap();
    let seen = approach(kind, f.0, f.1, &Relative::new(&placed.0, &placed.1, v, &dv));
    assert!((seen.gap - value).abs() < 1e-13, "{what}: gap {} against {value}", seen.gap);
    let between = gap_between(kind, f, &Relative::pose(&placed.0.pose, &placed.1.pose));
    assert!((between - value).abs() < 1e-13, "{what}: gap {between} against {value}");
    assert!(
        (seen.rate - path.v1).abs() < 1e-12 * (1.0 + rate.abs()),
        "{what}: {} against {}",
        seen.rate,
        path.v1
    );
    let off = (seen.acceleration - path.v2).abs();
    assert!(off < 1e-10 * (1.0 + path.v2.abs()), "{what}: g̈ {} against {}", seen.acceleration, path.v2);
    assert!(seen.apart <= seen.gap.abs() + 1e-12 || matches!(kind, GapKind::RoundEdge { .. }), "{what}");

    let row = state.row(&placed.0, &placed.1);
    for i in 0..4 {
        let seeded: Vec<Dual64> = (0..4)
            .map(|k| if k == i { Dual64::from(q[k]).derivative() } else { Dual64::constant(q[k]) })
            .collect();
        let exact = gap(bodies, f, &seeded).unwrap().eps;
        let ours: f64 = row.entries().filter(|(k, _)| *k == i).map(|(_, g)| g).sum();
        assert!((ours - exact).abs() < 1e-12, "{what}: ∂g/∂q{i} {ours} against {exact}");
    }
}

/// What is looked up once says the same as what is evaluated anew.
#[test]
fn constraints_agree_with_gaps() {
    let (bodies, q, v) = (bodies(), [0.37, -0.81, 0.45, 1.2], [0.9, -1.3, 0.6, 0.4]);
    let (mut met, mut hinged) = (0, 0);
    for (i, a) in bodies.iter().enumerate() {
        for b in bodies.iter().enumerate().filter(|(j, _)| *j != i).map(|b| b.1) {
            let (fa, fb) = (features(&a.outline, 5.0), features(&b.outline, 5.0));
            for (x, y) in fa.iter().flat_map(|x| fb.iter().map(move |y| (x, y))) {
                let Some(kind) = GapKind::of(x, y) else { continue };
                hinged += usize::from(compare((a, b), (x, y), kind, &q, &v));
                met += 1;
            }
        }
    }
    assert!(met > 300 && hinged > 30, "{met} {hinged}");
}

/// True if both hang on one joint or none.
fn compare(
    bodies: (&Body, &Body),
    f: (&Feature, &Feature),
    kind: GapKind,
    q: &[f64; 4],
    v: &[f64; 4],
) -> bool {
    let placed = (Placed::new(bodies.0, q), Placed::new(bodies.1, q));
    let state = gap_state(kind, f.0, f.1, &placed.0.pose, &placed.1.pose);
    let constraint = Constraint::new(kind, f, bodies);
    let first = constraint.shared;
    assert_eq!(first, placed.0.shared(&placed.1));
    let (mut a, mut b) = (Moving::default(), Moving::default());
    a.go_to(&bodies.0.chain, q, v);
    b.go_to(&bodies.1.chain, q, v);
    let sides = (a.carried_by(&bodies.0.chain, first, v), b.carried_by(&bodies.1.chain, first, v));
    let seen = constraint.at(&sides.0, &sides.1);
    let near = |x: f64, y: f64| assert!((x - y).abs() < 1e-12 * (1.0 + x.abs()), "{kind:?}: {x} against {y}");
    near(seen.gap, state.gap);
    near(seen.rate, state.rate(&placed.0, &placed.1, v));
    near(seen.bias, state.bias(&placed.0, &placed.1, v));
    let mut row = [0.0; 4];
    let (a, b) = (&bodies.0.chain, &bodies.1.chain);
    sides.0.slopes(a, first, seen.normal, seen.points.0, |k, slope| row[a[k].coordinate] += slope);
    sides.1.slopes(b, first, seen.normal, seen.points.1, |k, slope| row[b[k].coordinate] -= slope);
    let expected = state.row(&placed.0, &placed.1);
    (0..4).for_each(|i| near(row[i], expected.at(i)));
    let (Some(ha), Some(hb)) = (Hinge::of(bodies.0), Hinge::of(bodies.1)) else { return false };
    let hung = [&ha, &hb].map(|h| h.at(q[h.coordinate], v[h.coordinate]));
    let same = HingeConstraint::new(&constraint, (&ha, &hb)).at(&hung[0], &hung[1]);
    near(same.gap, seen.gap);
    near(same.rate, seen.rate);
    near(same.bias, seen.bias);
    let mut row = [0.0; 4];
    row[ha.coordinate] += same.slopes[0];
    row[hb.coordinate] += same.slopes[1];
    (0..4).for_each(|i| near(row[i], expected.at(i)));
    true
}

#[test]
fn swapping_the_bodies_changes_only_the_normal() {
    let (bodies, q) = (bodies(), [0.2, 0.5, -0.3, 0.9]);
    let (a, b) = (&bodies[1], &bodies[2]);
    let (fa, fb) = (features(&a.outline, 5.0), features(&b.outline, 5.0));
    let (pa, pb) = (Placed::new(a, &q), Placed::new(b, &q));
    for (x, y) in fa.iter().flat_map(|x| fb.iter().map(move |y| (x, y))) {
        let (Some(kind), Some(back)) = (GapKind::of(x, y), GapKind::of(y, x)) else { continue };
        let one = gap_state(kind, x, y, &pa.pose, &pb.pose);
        let two = gap_state(back, y, x, &pb.pose, &pa.pose);
        assert_eq!(one.gap, two.gap);
        assert!((one.normal + two.normal).norm() < 1e-15 && (one.point - two.point).norm() < 10.0);
        assert!((one.cone_margin - two.cone_margin).abs() < 1e-14);
        let (r, s) = (one.row(&pa, &pb), two.row(&pb, &pa));
        for (i, g) in r.entries() {
            let other: f64 = s.entries().filter(|(k, _)| *k == i).map(|(_, h)| h).sum();
            assert!((g - other).abs() < 1e-12, "{kind:?}");
        }
    }
}

#[test]
fn a_corner_is_a_round_of_radius_zero_with_a_cone() {
    let found = features(&outline(p(0.0, 0.0)), 5.0);
    let corners: Vec<_> = found.iter().filter(|f| f.is_corner()).collect();
    assert_eq!(corners.len(), 3);
    for corner in corners {
        let FeatureShape::Round { center, cone, .. } = corner.shape else { panic!("a corner is round") };
        let outwards = (center - p(0.8, 0.45)).unit();
        assert!(cone.margin(outwards) > 0.0 && cone.margin(-outwards) < 0.0);
        assert_eq!(corner.neighbours.len(), 2);
    }
}
