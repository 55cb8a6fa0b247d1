//! Properties that hold for any set of primitives: membership, additivity, invariance.

mod common;
use common::{Random, Solid};
use mainspring_geometry::{CsgOp, Outline, OutlineRecipe, Rigid3, Shape, Turn, Vec2, Vec3};

/// A block or cylinder; half of the time on a coarse grid, where coincidences abound, and sometimes a few
/// units in the last place beside it.
fn primitive(r: &mut Random) -> Solid {
    primitive_near_grid(r, f64::EPSILON)
}

/// As [`primitive`], up to twice `beside` off the grid.
fn primitive_near_grid(r: &mut Random, beside: f64) -> Solid {
    let coarse = r.below(2) == 0;
    let mut number = |low: f64, high: f64| {
        let x = r.within(low, high);
        let noise = f64::from(r.below(5) as u32) - 2.0;
        if coarse { (2.0 * x).round() * 0.5 + noise * beside } else { x }
    };
    let (x, y) = (number(-3.0, 3.0), number(-3.0, 3.0));
    let (w, h) = (number(0.5, 3.0).max(0.25), number(0.5, 3.0).max(0.25));
    let z = if coarse { 0.0 } else { number(-0.5, 0.5) };
    let angle = if coarse { 45.0 * r.below(8) as f64 } else { r.within(0.0, 360.0) };
    let solid = if r.below(3) == 0 { Solid::cylinder(w, 1.0) } else { Solid::block(w, h, 1.0) };
    if r.below(2) == 0 { solid.at(x, y, z).turned_by(angle) } else { solid.turned_by(angle).at(x, y, z) }
}

fn random_solid(r: &mut Random, primitives: u64) -> Solid {
    let mut solid = Solid::block(4.0, 4.0, 1.0).at(-2.0, -2.0, 0.0);
    for _ in 1..primitives {
        let other = if r.below(4) == 0 { primitive(r).un(primitive(r)) } else { primitive(r) };
        solid = match r.below(12) {
            0..=5 => solid.un(other),
            6..=10 => solid.dif(other),
            _ => solid.int(other),
        };
        if r.below(3) == 0 {
            solid = solid.un(primitive(r));
        }
    }
    solid
}

fn find(part: &Solid) -> OutlineRecipe {
    OutlineRecipe::find(&part.primitives, &part.csg, &Rigid3::identity()).expect("planar")
}

fn outline(part: &Solid) -> Outline {
    find(part).evaluate(&part.primitives, &Rigid3::identity())
}

/// Distance-like measure of how far a point is inside (negative) or outside a primitive.
fn depth(part: &Solid, i: u32, p: Vec3) -> f64 {
    let primitive = &part.primitives[i as usize];
    let q = primitive.machine_from_local.inverse().apply(p);
    let outside = |v: f64, size: f64| (-v).max(v - size);
    match primitive.shape {
        Shape::Block { x, y, z } => outside(q.x, x).max(outside(q.y, y)).max(outside(q.z, z)),
        Shape::Cylinder { radius, height } => (q.x.hypot(q.y) - radius).max(outside(q.z, height)),
        _ => f64::NAN,
    }
}

#[test]
fn membership_of_the_outline_is_membership_of_the_set() {
    let mut r = Random(0x5eed_0001);
    let (mut inside, mut tested) = (0, 0);
    for case in 0..400 {
        let count = 2 + r.below(8);
        let part = random_solid(&mut r, count);
        let drawn = outline(&part);
        for _ in 0..50 {
            let p = Vec3::new(r.within(-4.0, 4.0), r.within(-4.0, 4.0), r.within(-0.5, 1.5));
            let depths: Vec<f64> = (0..part.primitives.len() as u32).map(|i| depth(&part, i, p)).collect();
            if depths.iter().any(|d| d.abs() < 1e-6) {
                continue;
            }
            let expected = part.csg.contains(|i| depths[i as usize] < 0.0, &mut Vec::new());
            let found = drawn.layer_at(p.z).is_some_and(|l| l.contains(Vec2::new(p.x, p.y)));
            assert_eq!(found, expected, "case {case}, {p:?}");
            inside += usize::from(found);
            tested += 1;
        }
    }
    assert!(tested > 19_000 && inside > 2_000, "{inside} of {tested}");
}

/// Features that lie anywhere between rounding and plain sight of each other: around the tolerance they
/// count as coincident or not, but the outline is always found and right beyond that distance.
#[test]
fn no_distance_between_features_breaks_the_outline() {
    let mut r = Random(0x5eed_0009);
    for exponent in 3..16 {
        let beside = 10f64.powi(-exponent);
        for case in 0..60 {
            let mut part = Solid::block(4.0, 4.0, 1.0).at(-2.0, -2.0, 0.0);
            for k in 0..8 {
                let other = primitive_near_grid(&mut r, beside);
                part = if k % 3 == 2 { part.dif(other) } else { part.un(other) };
            }
            let drawn = outline(&part);
            for _ in 0..20 {
                let p = Vec3::new(r.within(-4.0, 4.0), r.within(-4.0, 4.0), r.within(0.0, 1.0));
                let depths: Vec<f64> =
                    (0..part.primitives.len() as u32).map(|i| depth(&part, i, p)).collect();
                if depths.iter().all(|d| d.abs() > 1e-4) {
                    let expected = part.csg.contains(|i| depths[i as usize] < 0.0, &mut Vec::new());
                    let found = drawn.layer_at(p.z).is_some_and(|l| l.contains(Vec2::new(p.x, p.y)));
                    assert_eq!(found, expected, "1e-{exponent}, case {case}, {p:?}");
                }
            }
        }
    }
}

#[test]
fn union_and_intersection_add_up() {
    let mut r = Random(0x5eed_0002);
    for case in 0..300 {
        let (a, b) = (random_solid(&mut r, 3), random_solid(&mut r, 3));
        let volume = |s: &Solid| outline(s).volume();
        let together = volume(&a.clone().un(b.clone())) + volume(&a.clone().int(b.clone()));
        let apart = volume(&a) + volume(&b);
        assert!((together - apart).abs() < 1e-6 * apart.max(1.0), "case {case}: {together} {apart}");
        let cut = volume(&a.clone().dif(b.clone())) + volume(&a.clone().int(b));
        assert!((cut - volume(&a)).abs() < 1e-6 * apart.max(1.0), "case {case}");
    }
}

/// Loops close, turns agree with tangents, and areas are positive.
#[test]
fn loops_are_sound() {
    let mut r = Random(0x5eed_0003);
    for case in 0..400 {
        let count = 2 + r.below(10);
        let part = random_solid(&mut r, count);
        for layer in &outline(&part).layers {
            assert!(layer.top > layer.bottom && layer.area() > 0.0, "case {case}");
            let witness = layer.interior_point().expect("material");
            assert!(layer.contains(witness));
            for l in &layer.loops {
                for (i, edge) in l.edges.iter().enumerate() {
                    let next = &l.edges[(i + 1) % l.edges.len()];
                    assert_eq!(edge.segment.end(), next.segment.start(), "case {case}");
                    let turn = edge.segment.tangent(1.0).cross(next.segment.tangent(0.0));
                    if turn.abs() > 1e-3 {
                        let expected = if turn > 0.0 { Turn::Convex } else { Turn::Concave };
                        assert_eq!(next.turn_at_start, expected, "case {case}");
                    }
                    assert!(!edge.aliases.contains(&edge.curve));
                }
            }
        }
    }
}

/// Each edge's middle lies on the boundary: material just left of it, none just right.
#[test]
fn material_is_on_the_left() {
    let mut r = Random(0x5eed_0004);
    let mut tested = 0;
    for case in 0..200 {
        let part = random_solid(&mut r, 5);
        for layer in &outline(&part).layers {
            let z = 0.5 * (layer.bottom + layer.top);
            for e in layer.loops.iter().flat_map(|l| &l.edges).filter(|e| e.segment.length() > 1e-3) {
                let left = e.segment.tangent(0.4).perp() * 1e-7;
                for (side, expected) in [(left, true), (-left, false)] {
                    let q = e.segment.at(0.4) + side;
                    let p = Vec3::new(q.x, q.y, z);
                    let depths: Vec<f64> =
                        (0..part.primitives.len() as u32).map(|i| depth(&part, i, p)).collect();
                    if depths.iter().all(|d| d.abs() > 1e-9) {
                        let found = part.csg.contains(|i| depths[i as usize] < 0.0, &mut Vec::new());
                        assert_eq!(found, expected, "case {case} {:?}", e.curve);
                        tested += 1;
                    }
                }
            }
        }
    }
    assert!(tested > 2_000, "{tested}");
}

#[test]
fn turning_moving_and_scaling_keep_the_order() {
    let mut r = Random(0x5eed_0005);
    for case in 0..300 {
        let count = 2 + r.below(6);
        let part = random_solid(&mut r, count);
        let recipe = find(&part);
        let moved =
            part.clone().turned_by(r.within(0.0, 360.0)).at(r.within(-9.0, 9.0), r.within(-9.0, 9.0), 2.0);
        assert!(recipe.holds_at(&moved.primitives, &Rigid3::identity()), "case {case}");
        for factor in [1e-6, 0.37, 1e6] {
            let mut scaled = part.clone();
            for p in &mut scaled.primitives {
                p.machine_from_local.translation = p.machine_from_local.translation * factor;
                p.shape = match p.shape {
                    Shape::Block { x, y, z } => Shape::Block { x: x * factor, y: y * factor, z: z * factor },
                    Shape::Cylinder { radius, height } => {
                        Shape::Cylinder { radius: radius * factor, height: height * factor }
                    }
                    other => other,
                };
            }
            assert!(recipe.holds_at(&scaled.primitives, &Rigid3::identity()), "case {case} {factor}");
        }
        // Seen from another plane the outline is the same: the plane may be anywhere along its normal.
        let plane = Rigid3::translation(Vec3::new(1.0, -2.0, 5.0))
            .then_after(&Rigid3::rotation(mainspring_geometry::Axis::Z, 1.0));
        assert!(recipe.holds_at(&part.primitives, &plane), "case {case}");
    }
}

/// Renaming operands: a ∪ b has the outline of b ∪ a, but for who owns what.
#[test]
fn the_order_of_a_union_does_not_change_its_shape() {
    let mut r = Random(0x5eed_0006);
    for case in 0..200 {
        let mut ab = random_solid(&mut r, 1);
        let mut ba = ab.clone();
        for _ in 0..6 {
            let next = primitive(&mut r);
            ab = ab.un(next.clone());
            ba = next.un(ba);
        }
        assert!(ab.csg.ops.iter().all(|o| matches!(o, CsgOp::Leaf(_) | CsgOp::Union)));
        let (x, y) = (outline(&ab), outline(&ba));
        let shape = |o: &Outline| {
            let edges = |l: &mainspring_geometry::Layer| l.loops.iter().map(|l| l.edges.len()).sum::<usize>();
            o.layers.iter().map(edges).collect::<Vec<_>>()
        };
        assert_eq!(shape(&x), shape(&y), "case {case}");
        assert!((x.volume() - y.volume()).abs() < 1e-9);
    }
}
