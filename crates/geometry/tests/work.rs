//! Large parts: ten thousand primitives, and input that would cost too much.

mod common;
use common::{Random, Solid};
use mainspring_geometry::{Csg, CsgOp, OutlineError, OutlineRecipe, Primitive, Rigid3, Segment};

const MANY: usize = 10_000;

fn union(parts: impl IntoIterator<Item = Primitive>) -> Solid {
    let primitives: Vec<Primitive> = parts.into_iter().collect();
    let mut ops = Vec::new();
    for i in 0..primitives.len() as u32 {
        ops.push(CsgOp::Leaf(i));
        if i > 0 {
            ops.push(CsgOp::Union);
        }
    }
    Solid { primitives, csg: Csg { ops } }
}

fn find(part: &Solid) -> Result<OutlineRecipe, OutlineError> {
    OutlineRecipe::find(&part.primitives, &part.csg, &Rigid3::identity())
}

fn block(w: f64, h: f64, x: f64, y: f64) -> Primitive {
    Solid::block(w, h, 1.0).at(x, y, 0.0).primitives[0]
}

#[test]
fn a_grid_of_tiles_is_one_square() {
    let tiles = (0..MANY).map(|i| block(1.0, 1.0, (i % 100) as f64, (i / 100) as f64));
    let part = union(tiles);
    let recipe = find(&part).expect("planar");
    assert_eq!(recipe.layers[0].loops.len(), 1);
    assert_eq!(recipe.layers[0].loops[0].edges.len(), 4);
    assert_eq!(recipe.layers[0].loops[0].edges[0].aliases.len(), 99);
}

#[test]
fn ten_thousand_copies_of_one_block_are_one() {
    let recipe = find(&union((0..MANY).map(|_| block(1.0, 2.0, 0.0, 0.0)))).expect("planar");
    assert_eq!(recipe.layers[0].loops[0].edges[0].aliases.len(), MANY - 1);
}

#[test]
fn scattered_discs_and_blocks() {
    let mut r = Random(0x5eed_0008);
    let scattered = (0..MANY).map(|i| {
        let (x, y) = (r.within(0.0, 100.0), r.within(0.0, 100.0));
        let solid = if i % 2 == 0 { Solid::cylinder(0.8, 1.0) } else { Solid::block(1.0, 0.5, 1.0) };
        solid.turned_by(r.within(0.0, 360.0)).at(x, y, 0.0).primitives[0]
    });
    let part = union(scattered);
    let recipe = find(&part).expect("planar");
    let outline = recipe.evaluate(&part.primitives, &Rigid3::identity());
    let arcs = outline.layers[0].loops.iter().flat_map(|l| &l.edges);
    assert!(arcs.filter(|e| matches!(e.segment, Segment::Arc { .. })).count() > 5_000);
    // A Boolean model: the covered share of the square is 1 − exp(−density × mean area).
    let expected = 1e4 * (1.0 - (-(0.5 * 0.5 + 0.5 * 0.16 * std::f64::consts::PI)).exp());
    assert!((outline.layers[0].area() / expected - 1.0).abs() < 0.02);
}

#[test]
fn a_plate_with_holes_all_the_way_down() {
    let plate = Solid::block(101.0, 101.0, 1.0).primitives[0];
    let hole = |i: usize| Solid::cylinder(0.5, 1.0).at(1.0 + (i % 100) as f64, 1.0 + (i / 100) as f64, 0.0);
    let mut part = union([plate]);
    for i in 1..MANY {
        part.primitives.push(hole(i).primitives[0]);
        part.csg.ops.extend([CsgOp::Leaf(i as u32), CsgOp::Difference]);
    }
    let recipe = find(&part).expect("planar");
    assert_eq!(recipe.layers[0].loops.len(), MANY);
}

#[test]
fn alternating_operations_ten_thousand_deep() {
    let mut part = union([block(1.0, 1.0, 0.0, 0.0)]);
    for i in 1..MANY {
        part.primitives.push(block(0.5, 1.0, i as f64 * 0.5, 0.25 * (i % 2) as f64));
        let op = if i % 2 == 0 { CsgOp::Difference } else { CsgOp::Union };
        part.csg.ops.extend([CsgOp::Leaf(i as u32), op]);
    }
    assert!(find(&part).is_ok());
}

#[test]
fn staircases_in_height_are_layers() {
    let step = |i: usize| {
        let mut p = block(1.0, 1.0, i as f64, 0.0);
        p.machine_from_local.translation.z = i as f64 * 0.5;
        p
    };
    let recipe = find(&union((0..1_000).map(step))).expect("planar");
    assert_eq!(recipe.layers.len(), 1_001);
}

#[test]
fn too_many_crossings_are_refused() {
    let spokes = (0..MANY).map(|i| Solid::block(10.0, 0.001, 1.0).turned_by(i as f64 * 0.036).primitives[0]);
    assert_eq!(find(&union(spokes)), Err(OutlineError::TooComplex));
}

#[test]
fn too_many_levels_are_refused() {
    let steps = (0..MANY).map(|i| {
        let solid = Solid::block(1.0, 1.0, 2e4 - 2.0 * i as f64).at(0.0, 0.0, i as f64);
        solid.primitives[0]
    });
    assert_eq!(find(&union(steps)), Err(OutlineError::TooComplex));
}

/// A lattice with forty thousand windows.
#[test]
fn a_lattice() {
    let n = 200;
    let bar = |i: usize| block(2_000.0, 1.0, 0.0, 2.0 * i as f64 + 0.5);
    let post = |i: usize| block(1.0, 2_000.0, 2.0 * i as f64 + 0.5, 0.0);
    let recipe = find(&union((0..n).map(bar).chain((0..n).map(post)))).expect("planar");
    assert_eq!(recipe.layers[0].loops.len(), 1 + (n - 1) * (n - 1));
    let n = 600;
    assert_eq!(find(&union((0..n).map(bar).chain((0..n).map(post)))), Err(OutlineError::TooComplex));
}
