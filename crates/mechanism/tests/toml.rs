//! Machines in TOML compile as those in PADL do: the same pairs, stated or found, and the same checks.

use mainspring_geometry::{CsgOp, Rigid3};
use mainspring_mechanism::{CompileOptions, Mechanism, PairKind};
use mainspring_model::{Error, Machine};
use std::sync::Arc;

mod support;

fn try_toml(text: &str) -> Result<Mechanism, Error> {
    let machine = Machine::parse("m.toml", text.as_bytes(), None)?;
    Mechanism::compile(Arc::new(machine), &[], &CompileOptions::default())
}

fn toml(text: &str) -> Mechanism {
    try_toml(text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

#[test]
fn the_escapement_is_the_same_in_both_forms() {
    let other = toml(include_str!("../../../tests/machines/escapement.toml"));
    let padl = support::example("escapement");
    assert_eq!(other.primitives, padl.primitives);
    assert_eq!(other.pairs, padl.pairs);
    assert_eq!(other.subsystems, padl.subsystems);
    for (a, b) in other.parts.iter().zip(&padl.parts) {
        assert_eq!(
            (&a.outline, a.inertia, a.friction, a.spring),
            (&b.outline, b.inertia, b.friction, b.spring)
        );
        assert_eq!((a.joint, a.carrier, a.position), (b.joint, b.carrier, b.position));
    }
    assert_eq!(other.system().unwrap().coordinates, padl.system().unwrap().coordinates);
}

/// A disc with a hole on a shaft, and a block in a slot; no motion is stated.
const DRAWN: &str = "
[parts.cam]
z = [0, 1]
outer = { circle = { center = [2, 0], radius = 5 } }
inner = { circle = { center = [0, 0], radius = 1 } }
[parts.block]
outer = { path = [{ from = [10, -1] }, { line = [12, -1] }, { line = [12, 1] }, { line = [10, 1] }, { close = true }] }
[[parts.ground.layers]]
z = [-1, 0]
outer = { path = [{ from = [-10, -10] }, { line = [20, -10] }, { line = [20, 10] }, { line = [-10, 10] }, { close = true }] }
[[parts.ground.layers]]
z = [0, 1]
outer = [
  { circle = { center = [0, 0], radius = 1 } },
  { path = [{ from = [9, 1] }, { line = [19, 1] }, { line = [19, 3] }, { line = [9, 3] }, { close = true }] },
  { path = [{ from = [9, -3] }, { line = [19, -3] }, { line = [19, -1] }, { line = [9, -1] }, { close = true }] },
]
[parts.ground]
frame = true
";

const SOLID: &str = "
cam = cyl(r=5) at (movx=2) dif cyl(r=1)
block = blo(x=2, y=2) at (movx=10, movy=-1)
frame = blo(x=30, y=20) at (movx=-10, movy=-10, movz=-1) un cyl(r=1) un (blo(x=10, y=2) at (movx=9, movy=1)) un (blo(x=10, y=2) at (movx=9, movy=-3))
";

#[test]
fn pairs_of_drawn_parts_are_found() {
    // The order of tables in TOML: sub-tables before the table itself are one table.
    let drawn = toml(DRAWN);
    let solid = support::compile(&support::machine(SOLID, &["cam", "block", "frame"]));
    assert_eq!(drawn.pairs.len(), 2, "{:?}", support::kinds(&drawn));
    for (a, b) in drawn.pairs.iter().zip(&solid.pairs) {
        assert_eq!((a.kind, a.parts), (b.kind, b.parts));
        assert_eq!(a.axis.direction, b.axis.direction);
        if a.kind == PairKind::Revolute {
            assert_eq!(a.axis.point, b.axis.point);
        }
    }
    assert_eq!(drawn.interactions(), solid.interactions());
}

#[test]
fn a_part_of_solids_and_a_drawn_part_make_pairs() {
    let text = "
[parts.cam]
outer = { circle = { center = [2, 0], radius = 5 } }
inner = { circle = { center = [0, 0], radius = 1 } }
[parts.ground]
frame = true
solid = \"cyl(r=1) un (blo(x=30, y=20) at (movx=-10, movy=-10, movz=-1))\"
";
    assert_eq!(support::kinds(&toml(text)), ["revolute/revolute cam-ground"]);
}

#[test]
fn a_recipe_of_walls_knows_when_it_holds() {
    let machine =
        Machine::parse("m.toml", include_bytes!("../../../examples/geneva-four/geneva-four.toml"), None);
    let machine = Arc::new(machine.unwrap());
    let m = Mechanism::compile(machine.clone(), &[], &CompileOptions::default()).unwrap();
    let recipe = m.parts[1].recipe.as_ref().unwrap();
    let moved = machine.primitives(&machine.values(&[("pin".into(), 2.9)]).unwrap()).unwrap();
    assert!(recipe.holds_at(&moved, &Rigid3::identity()));
    // With hollows so large that they reach the slots the boundary crosses itself.
    let crossed = machine.primitives(&machine.values(&[("lock".into(), 33.0)]).unwrap()).unwrap();
    assert!(!recipe.holds_at(&crossed, &Rigid3::identity()));
    assert!(m.parts[1].csg.ops.contains(&CsgOp::Leaf(3)));
}

#[test]
fn stated_motions_are_used_and_looked_at() {
    let shaft = "outer = { circle = { center = [0, 0], radius = 5 } }\ninner = { circle = { center = [0, 0], radius = 1 } }\n";
    let ground = "[parts.ground]\nframe = true\nsolid = \"cyl(r=1, h=2) un (blo(x=30, y=20) at (movx=-10, movy=-10, movz=-1))\"\n";
    let same = toml(&format!("[parts.disc]\n{shaft}motion = {{ turns = [0, 0] }}\n{ground}"));
    assert_eq!(support::kinds(&same), ["revolute/revolute disc-ground"]);
    assert!(same.warnings.is_empty(), "{:?}", same.warnings);
    assert_eq!(same.pairs[0].evidence[0].text, "stated for disc and ground");
    // A solid on its shaft, said to turn about another point.
    let solid = "solid = \"cyl(r=5) dif cyl(r=1)\"\n";
    let other = toml(&format!("[parts.disc]\n{solid}motion = {{ turns = [3, 0] }}\n{ground}"));
    assert_eq!(other.pairs[0].axis.point.x, 3.0);
    assert!(
        other.warnings[0].message.starts_with("disc and ground: by their shapes they form a"),
        "{:?}",
        other.warnings
    );
}

#[test]
fn parts_carry_each_other_as_stated() {
    let text = "
[parts.plate]
outer = { circle = { center = [0, 0], radius = 5 } }
z = [0, 1]
motion = { turns = [0, 0] }
[parts.pawl]
outer = { circle = { center = [3, 0], radius = 1 } }
z = [1, 2]
motion = { slides = [-2, 0], on = \"plate\" }
";
    let m = toml(text);
    assert_eq!(m.parts[1].carrier, Some(0));
    // The direction keeps its sense.
    assert_eq!(m.pairs.iter().find(|p| p.parts == (0, 1)).unwrap().axis.direction.x, -1.0);
}

#[test]
fn stated_gears_turn_together() {
    let disc = |x: f64, r: f64| {
        format!(
            "outer = {{ circle = {{ center = [{x}, 0], radius = {r} }} }}\nmotion = {{ turns = [{x}, 0] }}\n"
        )
    };
    let text = format!(
        "gears = [{{ parts = [\"b\", \"a\"], teeth = [30, 20] }}]\n[parts.a]\n{}[parts.b]\n{}",
        disc(0.0, 2.0),
        disc(5.0, 3.0)
    );
    let m = toml(&text);
    assert_eq!(m.subsystems.len(), 1);
    assert_eq!(m.subsystem_of(1), Some((0, -20.0 / 30.0)));
}

#[test]
fn drawn_parts_must_not_overlap() {
    let disc = |x: f64| {
        format!(
            "outer = {{ circle = {{ center = [{x}, 0], radius = 2 }} }}\nmotion = {{ turns = [{x}, 0] }}\n"
        )
    };
    let text = |x: f64| format!("[parts.a]\n{}[parts.b]\n{}", disc(0.0), disc(x));
    assert!(try_toml(&text(4.0)).is_ok(), "they touch");
    let error = try_toml(&text(3.9)).expect_err("they overlap").to_string();
    assert!(error.starts_with("m.toml:4:8: error: a and b overlap at the start, near (1.9"), "{error}");
    // In each other, and on top of each other.
    assert!(try_toml(&text(0.5)).is_err());
    assert!(try_toml(&text(0.0)).is_err());
    let above = text(0.5).replacen("radius = 2 } }", "radius = 2 } }\nz = [1, 2]", 1);
    assert!(try_toml(&above).is_ok(), "in another layer");
}

#[test]
fn inertia_follows_from_the_boundary() {
    let text = "[parts.a]\nouter = { circle = { center = [3, 0], radius = 2 } }\nz = [0, 5]\ndensity = 0.5\nmotion = { turns = [0, 0] }\nfriction = 1\n";
    let m = toml(text);
    let mass = 0.5 * 5.0 * std::f64::consts::PI * 4.0;
    let expected = mass * (0.5 * 4.0 + 9.0);
    assert!((m.parts[0].inertia.unwrap() - expected).abs() < 1e-12 * expected);
}
