//! Boundaries that coincide, touch, or nearly do.

mod common;
use common::Solid;
use mainspring_geometry::{
    CurveId, Layer, Outline, OutlineError, OutlineRecipe, Part, Rigid3, Segment, Turn, Vec2, overlap,
};

fn find(part: &Solid) -> OutlineRecipe {
    OutlineRecipe::find(&part.primitives, &part.csg, &Rigid3::identity()).expect("planar")
}

fn outline(part: &Solid) -> Outline {
    find(part).evaluate(&part.primitives, &Rigid3::identity())
}

fn only_layer(part: &Solid) -> Layer {
    let mut layers = outline(part).layers;
    assert_eq!(layers.len(), 1);
    layers.remove(0)
}

fn turns(layer: &Layer, i: usize) -> Vec<Turn> {
    layer.loops[i].edges.iter().map(|e| e.turn_at_start).collect()
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * b.abs().max(1.0)
}

#[test]
fn a_shaft_that_fills_its_hole_leaves_nothing() {
    let plate = || Solid::block(4.0, 4.0, 1.0).at(-2.0, -2.0, 0.0);
    let filled = only_layer(&plate().dif(Solid::cylinder(1.0, 1.0)).un(Solid::cylinder(1.0, 1.0)));
    assert_eq!(filled.loops.len(), 1);
    assert_eq!(filled.loops[0].edges.len(), 4);
    let (hole, shaft) = (plate().dif(Solid::cylinder(1.0, 1.0)), Solid::cylinder(1.0, 1.0));
    let [a, b] = [&hole, &shaft].map(|s| Part { primitives: &s.primitives, csg: &s.csg });
    assert_eq!(overlap(a, b, &Rigid3::identity()), Ok(None));
    assert!(outline(&shaft.dif(Solid::cylinder(1.0, 1.0))).layers.is_empty());
}

#[test]
fn a_longer_shaft_sticks_out_of_its_hole() {
    let plate = Solid::block(4.0, 4.0, 1.0).at(-2.0, -2.0, 0.0).dif(Solid::cylinder(1.0, 1.0));
    let part = outline(&plate.un(Solid::cylinder(1.0, 3.0)));
    let shape: Vec<_> = part.layers.iter().map(|l| (l.bottom, l.top, l.loops[0].edges.len())).collect();
    assert_eq!(shape, [(0.0, 1.0, 4), (1.0, 3.0, 1)]);
    // Of coincident curves the first in the text owns: here the one that bounds, not the bore below.
    assert_eq!(part.layers[1].loops[0].edges[0].curve, CurveId { primitive: 2, face: 0 });
}

#[test]
fn blocks_that_share_an_edge_become_one() {
    let two = only_layer(&Solid::block(1.0, 1.0, 1.0).un(Solid::block(2.0, 1.0, 1.0).at(1.0, 0.0, 0.0)));
    assert_eq!(two.loops.len(), 1);
    assert_eq!(turns(&two, 0), [Turn::Convex; 4]);
    let joined: Vec<_> = two.loops[0].edges.iter().map(|e| (e.curve, e.aliases.clone())).collect();
    assert_eq!(joined[0], (CurveId { primitive: 0, face: 0 }, vec![]));
    // The common lines are owned by the first block; the second is the alias, all along.
    let alias = |face| (CurveId { primitive: 0, face }, vec![CurveId { primitive: 1, face }]);
    assert_eq!([&joined[1], &joined[3]], [&alias(2), &alias(3)]);
    assert!(near(two.area(), 3.0));
}

#[test]
fn a_tee_and_a_notch() {
    let tee = only_layer(&Solid::block(3.0, 1.0, 1.0).un(Solid::block(1.0, 2.0, 1.0).at(1.0, 1.0, 0.0)));
    assert_eq!(tee.loops[0].edges.len(), 8);
    assert_eq!(turns(&tee, 0).iter().filter(|t| **t == Turn::Concave).count(), 2);
    let notch = only_layer(&Solid::block(3.0, 1.0, 1.0).dif(Solid::block(1.0, 1.0, 1.0).at(1.0, 0.5, 0.0)));
    assert_eq!(notch.loops[0].edges.len(), 8);
    assert!(near(notch.area(), 2.5));
    assert!(!notch.contains(Vec2::new(1.5, 0.75)) && notch.contains(Vec2::new(1.5, 0.25)));
}

#[test]
fn regions_that_touch_at_a_point_stay_separate() {
    let checkers = Solid::block(1.0, 1.0, 1.0).un(Solid::block(1.0, 1.0, 1.0).at(1.0, 1.0, 0.0));
    let layer = only_layer(&checkers);
    assert_eq!(layer.loops.iter().map(|l| l.edges.len()).collect::<Vec<_>>(), [4, 4]);
    assert!((0..2).all(|i| turns(&layer, i) == [Turn::Convex; 4]));
    let discs = only_layer(&Solid::cylinder(2.0, 1.0).un(Solid::cylinder(4.0, 1.0).at(3.0, 0.0, 0.0)));
    assert_eq!(discs.loops.len(), 2);
    assert!(discs.loops.iter().all(|l| matches!(l.edges[0].segment, Segment::Circle { convex: true, .. })));
}

#[test]
fn a_hole_that_touches_the_rim_keeps_one_loop() {
    let part = Solid::cylinder(4.0, 1.0).dif(Solid::cylinder(2.0, 1.0).at(1.0, 0.0, 0.0));
    let layer = only_layer(&part);
    assert_eq!(layer.loops.len(), 1);
    // Both arcs are full turns from the common point back to it, with a spike of material on either side.
    assert_eq!(turns(&layer, 0), [Turn::Convex; 2]);
    assert!(near(layer.area(), 3.0 * std::f64::consts::PI));
    assert!(layer.contains(Vec2::new(-1.0, 0.0)) && !layer.contains(Vec2::new(1.5, 0.0)));
}

#[test]
fn a_slot_has_smooth_joints_and_concave_arcs() {
    let end = |x| Solid::cylinder(1.0, 1.0).at(x, 0.0, 0.0);
    let slot = Solid::block(2.0, 1.0, 1.0).at(-1.0, -0.5, 0.0).un(end(-1.0)).un(end(1.0));
    let pin = only_layer(&slot);
    assert_eq!(turns(&pin, 0), [Turn::Smooth; 4]);
    let area = 2.0 + 0.25 * std::f64::consts::PI;
    assert!(near(pin.area(), area));
    let plate = only_layer(&Solid::block(6.0, 6.0, 1.0).at(-3.0, -3.0, 0.0).dif(slot));
    assert!(near(plate.area(), 36.0 - area));
    let hole = &plate.loops[1];
    let arcs = hole.edges.iter().filter(|e| matches!(e.segment, Segment::Arc { convex: false, .. }));
    assert_eq!(arcs.count(), 2);
    assert!(near(hole.area(), -area));
}

#[test]
fn a_concave_arc_between_convex_corners() {
    let bite = only_layer(&Solid::block(2.0, 2.0, 1.0).dif(Solid::cylinder(1.0, 1.0).at(0.0, 1.0, 0.0)));
    let edges = &bite.loops[0].edges;
    assert_eq!(edges.len(), 6);
    let arc = edges.iter().find(|e| e.curve.primitive == 1).expect("the arc");
    assert!(matches!(arc.segment, Segment::Arc { convex: false, .. }));
    assert!(turns(&bite, 0).iter().all(|t| *t == Turn::Convex));
    assert!(near(bite.area(), 4.0 - std::f64::consts::PI / 8.0));
    assert!(near(arc.segment.sweep(), std::f64::consts::PI));
}

#[test]
fn thin_walls_stay_and_films_go() {
    let wall = |t: f64| Solid::block(1.0, 1.0, 1.0).dif(Solid::block(1.0, 1.0, 1.0).at(t, -0.0, 0.0));
    let thin = only_layer(&wall(1e-7));
    assert!((thin.area() - 1e-7).abs() < 1e-15);
    assert!(outline(&wall(1e-11)).layers.is_empty());
    assert!(outline(&wall(0.0)).layers.is_empty());
}

#[test]
fn a_few_units_in_the_last_place_change_nothing() {
    for k in -6..=6 {
        let off = f64::from(k) * f64::EPSILON;
        let two = Solid::block(1.0, 1.0, 1.0).un(Solid::block(1.0, 1.0, 1.0).at(1.0 + off, off, 0.0));
        assert_eq!(only_layer(&two).loops[0].edges.len(), 4, "{k}");
        let bush = Solid::cylinder(3.0, 1.0).dif(Solid::cylinder(1.0 + off, 1.0).at(off, 0.0, 0.0));
        let filled = only_layer(&bush.un(Solid::cylinder(1.0, 1.0)));
        assert_eq!(filled.loops.len(), 1, "{k}");
        let far = Solid::block(1.0, 1.0, 1.0).at(1e3, 0.0, 0.0).un(Solid::block(1.0, 1.0, 1.0).at(
            1e3,
            1.0 + off,
            off,
        ));
        assert_eq!(only_layer(&far).loops[0].edges.len(), 4, "{k}");
    }
}

#[test]
fn equal_sections_on_top_of_each_other_are_one_layer() {
    let stack = Solid::cylinder(1.0, 1.0).un(Solid::cylinder(1.0, 2.0).at(0.0, 0.0, 1.0));
    let layer = only_layer(&stack);
    assert_eq!((layer.bottom, layer.top), (0.0, 3.0));
    assert_eq!(layer.loops[0].edges[0].aliases, [CurveId { primitive: 1, face: 0 }]);
    let apart = Solid::cylinder(1.0, 1.0).un(Solid::cylinder(1.0, 2.0).at(0.0, 0.0, 1.5));
    assert_eq!(outline(&apart).layers.len(), 2);
}

#[test]
fn a_swallowed_coincident_face_owns_nothing() {
    // The first block's right face lies on the third's, but the second takes the first away.
    let part = Solid::block(1.0, 1.0, 1.0).dif(Solid::block(3.0, 3.0, 1.0).at(-1.0, -1.0, 0.0));
    let layer = only_layer(&part.un(Solid::block(1.0, 1.0, 1.0)));
    assert!(layer.loops[0].edges.iter().all(|e| e.curve.primitive == 2 && e.aliases.is_empty()));
}

#[test]
fn what_is_no_prism_is_named_where_it_matters() {
    use mainspring_geometry::{Axis, Shape};
    let plate = || Solid::block(2.0, 2.0, 1.0);
    let cone = || Solid::of(Shape::Cone { radius: 1.0, height: 1.0 });
    let found = |s: &Solid| OutlineRecipe::find(&s.primitives, &s.csg, &Rigid3::identity());
    let refused = OutlineError::NotPrismatic { primitive: 1, shape: "con" };
    assert_eq!(found(&plate().un(cone())), Err(refused.clone()));
    assert_eq!(found(&plate().dif(cone())), Err(refused));
    assert!(found(&plate().dif(cone().at(0.0, 0.0, 1.0))).is_ok());
    let tilted = plate().moved(Rigid3::rotation(Axis::X, 0.1));
    assert_eq!(found(&tilted), Err(OutlineError::NotPrismatic { primitive: 0, shape: "blo" }));
    // Lying on its side a block is a prism still, along another of its axes.
    let lying = Solid::block(2.0, 3.0, 5.0).moved(Rigid3::rotation(Axis::X, std::f64::consts::FRAC_PI_2));
    let layer = only_layer(&lying);
    assert!(near(layer.area(), 10.0) && near(layer.top - layer.bottom, 3.0));
    let faces: Vec<_> = layer.loops[0].edges.iter().map(|e| e.curve.face).collect();
    assert_eq!(faces, [0, 5, 1, 4]);
}

#[test]
fn bad_input_is_an_error() {
    let mut part = Solid::block(1.0, 1.0, 1.0);
    part.primitives[0].machine_from_local.translation.x = f64::NAN;
    let found = |s: &Solid| OutlineRecipe::find(&s.primitives, &s.csg, &Rigid3::identity());
    assert_eq!(found(&part), Err(OutlineError::Malformed { primitive: Some(0) }));
    part.csg.ops.push(mainspring_geometry::CsgOp::Union);
    assert_eq!(found(&part), Err(OutlineError::Malformed { primitive: None }));
    part.csg.ops = vec![mainspring_geometry::CsgOp::Leaf(7)];
    assert_eq!(found(&part), Err(OutlineError::Malformed { primitive: Some(7) }));
    part.csg.ops.clear();
    assert!(found(&part).expect("empty").layers.is_empty());
}

#[test]
fn the_order_of_features_holds_until_it_changes() {
    let at = |x: f64| Solid::block(4.0, 1.0, 1.0).un(Solid::block(1.0, 2.0, 1.0).at(x, 0.5, 0.0));
    let recipe = find(&at(1.0));
    assert!(recipe.holds_at(&at(2.9).primitives, &Rigid3::identity()));
    assert!(!recipe.holds_at(&at(3.5).primitives, &Rigid3::identity()));
    let moved = recipe.evaluate(&at(2.0).primitives, &Rigid3::identity());
    assert_eq!(moved, outline(&at(2.0)));
}

#[test]
fn a_bore_through_a_reflex_corner_runs_all_the_way_round() {
    // Two blocks meet in a reflex corner on the bore: the arc's two ends have different names.
    let off = f64::EPSILON;
    let blocks = Solid::block(4.0, 4.0, 1.0).un(Solid::block(2.5, 1.5 - off, 1.0).at(-1.0, -0.5, 0.0));
    let part = blocks.dif(Solid::cylinder(1.0, 1.0).at(0.0, 0.5, 0.0));
    let layer = only_layer(&part);
    assert!((layer.area() - (4.0 * 4.0 + 2.5 * 1.5 - 1.5 - 0.25 * std::f64::consts::PI)).abs() < 1e-9);
    assert!(!layer.contains(Vec2::new(0.0, 0.5)) && layer.contains(Vec2::new(-0.7, 0.5)));
    let arc = layer.loops[0].edges.iter().find(|e| e.curve.primitive == 2).expect("the bore");
    assert_eq!(arc.segment.sweep(), 2.0 * std::f64::consts::PI);
}

#[test]
fn a_tangent_that_ends_beside_the_point_of_contact() {
    // The disc touches the side a hundred-thousandth above the block's corner, which itself lies within the
    // tolerance of the disc: side and arc are one on that stretch.
    let disc = Solid::cylinder(1.00002, 1.0).at(-0.50001, 1e-5, 0.0);
    let layer = only_layer(&Solid::block(4.0, 4.0, 1.0).un(disc));
    let area = 16.0 + std::f64::consts::PI * 0.50001 * 0.50001;
    assert!((layer.area() - area).abs() < 1e-8, "{}", layer.area() - area);
}

#[test]
fn a_side_that_starts_just_behind_the_point_of_contact() {
    // The disc would touch the block's side a ten-thousandth before the side begins.
    let disc = Solid::cylinder(2.0002, 1.0).at(0.9999, -2.0001, 0.0);
    let layer = only_layer(&Solid::block(4.0, 4.0, 1.0).at(-2.0, -2.0, 0.0).un(disc));
    assert_eq!(layer.loops.len(), 1);
    let area = 16.0 + 0.5 * std::f64::consts::PI * 1.0001 * 1.0001 + 2.0 * 1.0001 * 1e-4;
    assert!((layer.area() - area).abs() < 2e-7, "{}", layer.area() - area);
}
