//! The outlines of Gelsey 1995, Fig. 12: identities, derivatives and touching parts.

mod common;
use common::{Escapement, FIGURE, Solid};
use mainspring_geometry::{CurveId, Outline, OutlineRecipe, Part, Rigid3, Scalar, Segment, Turn, overlap};
use num_dual::Dual64;

fn find(part: &Solid) -> OutlineRecipe {
    OutlineRecipe::find(&part.primitives, &part.csg, &Rigid3::identity()).expect("planar")
}

fn outline<S: Scalar>(recipe: &OutlineRecipe, part: &Solid<S>) -> Outline<S> {
    recipe.evaluate(&part.primitives, &Rigid3::identity())
}

fn coordinates<S: Scalar>(outline: &Outline<S>) -> Vec<S> {
    let edges = outline.layers.iter().flat_map(|l| &l.loops).flat_map(|l| &l.edges);
    edges.flat_map(|e| [e.segment.start().x, e.segment.start().y]).collect()
}

#[test]
fn derivatives_of_all_corners_agree_with_differences() {
    let recipes: Vec<_> = Escapement::with(FIGURE).parts().into_iter().map(|(n, p)| (n, find(&p))).collect();
    let mut moving = 0;
    for parameter in 0..4 {
        let at = |shift: f64| {
            let mut values = FIGURE;
            values[parameter] += shift;
            Escapement::with(values).parts()
        };
        let mut dual = FIGURE.map(Dual64::from);
        dual[parameter].eps = 1.0;
        let (step, dual) = (1e-4, Escapement::with(dual).parts());
        let (below, above) = (at(-step), at(step));
        for (k, (name, recipe)) in recipes.iter().enumerate() {
            let exact = coordinates(&outline(recipe, &dual[k].1));
            let [low, high] = [&below, &above].map(|p| coordinates(&outline(recipe, &p[k].1)));
            assert!(recipe.holds_at(&above[k].1.primitives, &Rigid3::identity()), "{name}");
            for (i, e) in exact.iter().enumerate() {
                let difference = (high[i] - low[i]) / (2.0 * step);
                assert!((e.eps - difference).abs() < 1e-7, "{name} {parameter} {i}: {} {difference}", e.eps);
                moving += usize::from(e.eps != 0.0);
            }
        }
    }
    // Nine turning teeth with four corners each, and the pallets; corners on the pallets' pivots stay.
    assert!(moving >= 2 * 9 * 4 + 12, "{moving}");
}

#[test]
fn wheel_has_ten_teeth_and_a_bore() {
    let part = Escapement::with(FIGURE).wheel();
    let wheel = outline(&find(&part), &part);
    assert_eq!(wheel.layers.len(), 1);
    assert_eq!((wheel.layers[0].bottom, wheel.layers[0].top), (0.0, 1.0));
    let [rim, bore] = &wheel.layers[0].loops[..] else { panic!("rim and bore") };
    assert_eq!(rim.edges.len(), 40);
    for tooth in 1..=10 {
        let of = |face| {
            let named = move |e: &&mainspring_geometry::Edge| e.curve == CurveId { primitive: tooth, face };
            let turns: Vec<_> = rim.edges.iter().filter(named).map(|e| e.turn_at_start).collect();
            turns
        };
        assert_eq!([of(0), of(3), of(1)], [[Turn::Convex], [Turn::Convex], [Turn::Concave]]);
        assert_eq!(of(2), []);
    }
    let arcs = rim.edges.iter().filter(|e| e.curve == CurveId { primitive: 0, face: 0 });
    assert_eq!(arcs.filter(|e| matches!(e.segment, Segment::Arc { convex: true, .. })).count(), 10);
    assert!(matches!(
        bore.edges[..],
        [mainspring_geometry::Edge { segment: Segment::Circle { convex: false, .. }, .. }]
    ));
    assert_eq!(bore.edges[0].curve, CurveId { primitive: 11, face: 0 });
}

#[test]
fn lever_owns_shared_corners_once() {
    let part = Escapement::with(FIGURE).lever();
    let lever = outline(&find(&part), &part);
    let [rim, _bore] = &lever.layers[0].loops[..] else { panic!("rim and bore") };
    let faces: Vec<_> = rim.edges.iter().map(|e| (e.curve.primitive, e.curve.face)).collect();
    let expected = [
        (0, 0),
        (0, 2),
        (2, 0),
        (1, 2),
        (1, 1),
        (0, 2),
        (3, 0),
        (3, 2),
        (3, 1),
        (0, 2),
        (0, 1),
        (0, 3),
        (4, 1),
        (5, 1),
        (5, 3),
        (5, 0),
        (6, 1),
        (6, 3),
        (5, 2),
        (4, 0),
        (0, 3),
    ];
    assert_eq!(faces, expected);
    // The two arms of the fork have one common line on each side; the first in the text owns it.
    let shared: Vec<_> = rim.edges.iter().filter(|e| !e.aliases.is_empty()).collect();
    assert!(shared.iter().all(|e| e.curve.primitive == 5 && e.aliases[0].primitive == 6));
    assert_eq!(shared.len(), 2);
}

#[test]
fn frame_keeps_its_layers_and_shafts() {
    let part = Escapement::with(FIGURE).frame();
    let frame = outline(&find(&part), &part);
    let heights: Vec<_> = frame.layers.iter().map(|l| (l.bottom, l.top, l.loops.len())).collect();
    assert_eq!(heights, [(-2.0, -1.0, 1), (-1.0, 1.0, 5), (1.0, 2.0, 2)]);
    // The shaft of the wheel survives as itself; the bore of the wheel's hollow copy is its alias.
    let shaft = &frame.layers[1].loops[0].edges[0];
    assert_eq!(shaft.curve, CurveId { primitive: 1, face: 0 });
    assert!(matches!(shaft.segment, Segment::Circle { convex: true, .. }));
}

#[test]
fn parts_touch_but_do_not_overlap() {
    let parts = Escapement::with(FIGURE).parts();
    let plane = Rigid3::identity();
    for (i, (a, p)) in parts.iter().enumerate() {
        for (b, q) in &parts[..i] {
            let [p, q] = [p, q].map(|s| Part { primitives: &s.primitives, csg: &s.csg });
            assert_eq!(overlap(p, q, &plane), Ok(None), "{a} {b}");
        }
    }
    let wheel = parts[0].1.clone().turned_by(-5.0);
    let [p, q] = [&wheel, &parts[1].1].map(|s| Part { primitives: &s.primitives, csg: &s.csg });
    let found = overlap(p, q, &plane).expect("planar").expect("a tooth in the lever");
    assert!(found.area > 0.01 && found.height == 0.5);
    for s in [&wheel, &parts[1].1] {
        assert!(outline(&find(s), s).layers[0].contains(found.point));
    }
}
