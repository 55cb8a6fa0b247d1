//! What the language means: precedence, placement, expansion, marks, arithmetic.

mod common;

use common::{read, supplemented};
use mainspring_geometry::{Axis, CsgOp, Shape, Vec3};
use mainspring_model::{Machine, SymmetryKind, Values, parse_setting};
use num_dual::Dual64;

fn machine(body: &str) -> Machine {
    let text = format!("generic g(r)\n{body}\n");
    read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn number(expression: &str) -> f64 {
    let machine = machine(&format!("n = {expression}\ns = blo()\nr = s"));
    machine.parameters()[0].default.unwrap()
}

#[test]
fn arithmetic_has_the_usual_precedence() {
    let cases = [
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("8 / 4 / 2", 1.0),
        ("8 - 4 - 2", 2.0),
        ("-2 * -3", 6.0),
        ("--2", 2.0),
        ("2 - -2", 4.0),
        ("-.5 + 5.", 4.5),
        ("1e3 + 2E-1", 1000.2),
        ("sin(150) - sin(30)", 0.0),
        ("sin(90) + cos(180) + tan(180) + cos(270)", 0.0),
        ("atan2(1, -1)", 135.0),
        ("atan2(0, 0)", 0.0),
        ("sqrt(2*8)", 4.0),
        ("abs(-3) + max(1, 5, 2) - min(4, -1)", 9.0),
        ("(\n 1 +\n 2 )", 3.0),
        ("1 + \\\n 2 \\ # a comment may follow\n + 3", 6.0),
    ];
    for (text, expected) in cases {
        assert_eq!(number(text), expected, "{text}");
    }
}

#[test]
fn quarter_turns_are_exact() {
    for turn in [-450, -270, -180, -90, 0, 90, 180, 270, 360, 810, 36_000_090] {
        let machine = machine(&format!("s = blo() at (degz={turn}, degx={turn}, degy={turn})\nr = s"));
        let pose = machine.primitives(&machine.values(&[]).unwrap()).unwrap()[0].machine_from_local;
        for column in pose.columns {
            for entry in [column.x, column.y, column.z] {
                assert!(entry == entry.round() && entry.to_bits() != (-0.0f64).to_bits(), "{turn}: {entry}");
            }
        }
    }
}

#[test]
fn motions_apply_left_to_right_about_the_origin() {
    let poses = [
        ("blo() at (movx=1, degz=90)", Vec3::new(0.0, 1.0, 0.0)),
        ("blo() at (degz=90, movx=1)", Vec3::new(1.0, 0.0, 0.0)),
        ("blo() at (movx=1) at (degz=90)", Vec3::new(0.0, 1.0, 0.0)),
        ("(blo() at (movx=1)) at (degz=90) at (movz=2)", Vec3::new(0.0, 1.0, 2.0)),
        ("blo() at (movy=1, degx=90)", Vec3::new(0.0, 0.0, 1.0)),
        ("blo() at (movz=1, degy=90)", Vec3::new(1.0, 0.0, 0.0)),
    ];
    for (solid, expected) in poses {
        let machine = machine(&format!("s = {solid}\nr = s"));
        let pose = machine.primitives(&machine.values(&[]).unwrap()).unwrap()[0].machine_from_local;
        assert_eq!(pose.translation, expected, "{solid}");
    }
}

#[test]
fn set_operators_share_one_level_and_at_binds_tightest() {
    let ops = |body: &str| machine(&format!("s = {body}\nr = s")).parts()[0].csg.ops.clone();
    use CsgOp::{Difference, Intersection, Leaf, Union};
    assert_eq!(
        ops("blo() un cyl() dif sph() int con()"),
        [Leaf(0), Leaf(1), Union, Leaf(2), Difference, Leaf(3), Intersection]
    );
    assert_eq!(ops("blo() dif (cyl() un sph())"), [Leaf(0), Leaf(1), Leaf(2), Union, Difference]);
    let machine = machine("s = blo() un cyl() at (movx=5)\nr = s");
    let primitives = machine.primitives(&machine.values(&[]).unwrap()).unwrap();
    assert_eq!(primitives[0].machine_from_local.translation.x, 0.0);
    assert_eq!(primitives[1].machine_from_local.translation.x, 5.0);
}

#[test]
fn omitted_sizes_are_one() {
    let shapes = |text: &str| {
        let machine = machine(&format!("s = {text}\nr = s"));
        machine.primitives(&machine.values(&[]).unwrap()).unwrap()[0].shape
    };
    assert_eq!(shapes("blo()"), Shape::Block { x: 1.0, y: 1.0, z: 1.0 });
    assert_eq!(shapes("cyl()"), Shape::Cylinder { radius: 0.5, height: 1.0 });
    assert_eq!(shapes("cyl(r=2)"), Shape::Cylinder { radius: 2.0, height: 1.0 });
    assert_eq!(shapes("con(d=3, h=4,)"), Shape::Cone { radius: 1.5, height: 4.0 });
    assert_eq!(shapes("SPH(R=1)"), Shape::Sphere { radius: 1.0 });
    assert_eq!(shapes("wed(y=2)"), Shape::Wedge { x: 1.0, y: 2.0, z: 1.0 });
}

#[test]
fn names_are_used_before_their_definition_and_in_any_case() {
    let machine = machine("S = T un T at (movx=WIDTH)\nt = blo(x=Width)\nwidth = 2*half\nHALF = 1\nr = s");
    assert_eq!(machine.parts()[0].name, "S");
    let parameters: Vec<_> = machine.parameters().iter().map(|p| (p.name.as_str(), p.default)).collect();
    assert_eq!(parameters, [("WIDTH", Some(2.0)), ("half", Some(1.0))]);
    assert_eq!(machine.label_of_primitive(1), "T (blo)");
    let place = machine.place_of_primitive(1);
    assert_eq!((place.line, place.column), (3, 5));
}

#[test]
fn settings_carry_over_to_what_depends_on_them() {
    let machine = machine("a = 1\nb = 2*a in [0, 10]\ns = blo(x=b)\nr = s");
    let at = |set: &[(&str, f64)]| {
        let set: Vec<(String, f64)> = set.iter().map(|(n, v)| (n.to_string(), *v)).collect();
        machine.values(&set)
    };
    assert_eq!(at(&[("A", 3.0)]).unwrap().as_slice(), [3.0, 6.0]);
    assert_eq!(at(&[("a", 3.0), ("B", 1.0)]).unwrap().as_slice(), [3.0, 1.0]);
    assert_eq!(
        at(&[("a", 6.0)]).unwrap_err().to_string(),
        "m.padl:3:1: error: b is 12; expected a value in its range [0, 10]"
    );
    assert_eq!(
        at(&[("a", 1.0), ("A", 1.0)]).unwrap_err().to_string(),
        "--set:1:1: error: `A` is set twice; expected one value"
    );
    let seeded = machine.values_with_derivative(&[("a".into(), 3.0)], "a").unwrap();
    assert_eq!((seeded.get(1).unwrap().re, seeded.get(1).unwrap().eps), (6.0, 2.0));
}

#[test]
fn generic_may_list_numbers_that_must_be_set() {
    let text = "generic g(r, size, unused)\na = blo(x=size)\nunused = 4\nr = a";
    let machine = Machine::parse("m.padl", text.as_bytes(), None).unwrap();
    let names: Vec<_> = machine.parameters().iter().map(|p| (p.name.as_str(), p.default)).collect();
    assert_eq!(names, [("size", None), ("unused", Some(4.0))]);
    let values = machine.values(&[("size".into(), 3.0)]).unwrap();
    assert_eq!(machine.primitives(&values).unwrap()[0].shape, Shape::Block { x: 3.0, y: 1.0, z: 1.0 });
}

#[test]
fn settings_are_read_strictly() {
    assert_eq!(parse_setting("Gap = -36.5e0").unwrap(), ("Gap".to_string(), -36.5));
    for text in [
        "gap",
        "gap=",
        "=3",
        "gap=nan",
        "gap=1_0",
        "gap=1e999",
        "gap=3 4",
        "gap=2*3",
        "gap=--3",
        "",
        "gap=\u{202e}3",
    ] {
        let message = parse_setting(text).unwrap_err().to_string();
        assert!(message.starts_with("--set:1:") && message.contains("; expected "), "{text}: {message}");
    }
}

#[test]
fn symmetric_union_copies_and_marks() {
    let machine = machine(
        "n = 90\ntooth = blo(x=4) un cyl()\n\
         s = cyl(d=5) un SYMMETRIC_UNION(tooth, z, ROTATIONAL, 3, n) at (movz=2)\n\
         t = SYMMETRIC_UNION(blo(), X, translational, 2, 10)\nr = s asb t",
    );
    let values = machine.values(&[]).unwrap();
    let primitives = machine.primitives(&values).unwrap();
    let [round, straight] = machine.symmetric_unions() else { panic!("two unions") };
    assert_eq!((round.part, round.kind, round.axis, round.count), (0, SymmetryKind::Rotational, Axis::Z, 3));
    assert_eq!(round.primitives, [1, 2, 3, 4, 5, 6]);
    assert_eq!(machine.evaluate(&round.range, &values).unwrap(), 90.0);
    assert_eq!(machine.union_pose(round, &values).unwrap().translation, Vec3::new(0.0, 0.0, 2.0));
    for (copy, angle) in [(0, 0.0f64), (1, 30.0), (2, 60.0)] {
        let x = primitives[1 + 2 * copy].machine_from_local.columns[0];
        assert!((x.y - angle.to_radians().sin()).abs() < 1e-15);
        assert_eq!(primitives[1 + 2 * copy].machine_from_local.translation.z, 2.0);
    }
    assert_eq!((straight.part, straight.kind, straight.axis), (1, SymmetryKind::Translational, Axis::X));
    assert_eq!(primitives[8].machine_from_local.translation, Vec3::new(5.0, 0.0, 0.0));
    use CsgOp::{Leaf, Union};
    assert_eq!(machine.parts()[1].csg.ops, [Leaf(7), Leaf(8), Union]);
}

#[test]
fn every_instance_of_a_gear_in_a_part_counts() {
    let machine = machine(
        "wheel = (cyl(d=6) un blo()) dif cyl(d=1)\na = wheel un wheel at (movz=2)\n\
         base = blo(x=20) dif wheel\nattr wheel : gear = 1\nattr Wheel : teeth = 10*k\nattr wheel : depth = 0.2\n\
         k = 6\nattr base : density = 2\nr = a asb base",
    );
    let values = machine.values(&[]).unwrap();
    let found: Vec<(usize, Vec<(u32, bool)>)> = machine
        .gears()
        .iter()
        .map(|g| (g.part, g.members.iter().map(|m| (m.primitive, m.adds)).collect()))
        .collect();
    let expected = [
        (0, vec![(0, true), (2, false)]),
        (0, vec![(3, true), (5, false)]),
        (1, vec![(7, true), (9, false)]),
    ];
    assert_eq!(found, expected);
    let gear = &machine.gears()[2];
    assert_eq!((gear.name.as_str(), gear.place.line), ("wheel", 5));
    assert_eq!(machine.teeth(gear, &values).unwrap(), Some(60));
    assert_eq!(machine.tooth_depth(gear, &values).unwrap(), Some(0.2));
    assert_eq!(machine.density(&machine.parts()[1], &values).unwrap(), Some(2.0));
    assert_eq!(machine.density(&machine.parts()[0], &values).unwrap(), None);
}

#[test]
fn inertia_may_be_left_to_the_density() {
    let model = "generic g(r)\na = cyl()\nFrame = blo()\nattr a : density = 3\nattr frame : frame = 1\nr = a asb frame";
    let machine = supplemented(model, "< A : frame > 5 SPRING -2 7\nVELOCITY a -3\n").unwrap();
    let supplement = machine.supplement();
    assert_eq!((supplement.pairs[0].inertia, supplement.pairs[0].friction), (None, 5.0));
    assert_eq!(supplement.velocities[0].value, -3.0);
    let with_inertia = supplemented(model, "< A : frame > 4 5 # inertia wins over density").unwrap();
    assert_eq!(with_inertia.supplement().pairs[0].inertia, Some(4.0));
}

#[test]
fn derivatives_of_every_function_agree_with_differences() {
    let expressions = [
        "u*v - v/u",
        "sin(u) + cos(v)",
        "tan(u)/v",
        "sqrt(u*u + v)",
        "abs(u - v)",
        "abs(v - u)",
        "min(u, v)",
        "max(u, v, 1)",
        "atan2(u, -v)",
        "-(u + 3)*2/(v*v)",
        "sin(90*u/u + v*0)",
        "cos(u*90 - 90)",
    ];
    for expression in expressions {
        let machine = machine(&format!("u = 0.7\nv = 1.3\nf = {expression}\ns = blo()\nr = s"));
        for seeded in ["u", "v"] {
            let x = machine.values(&[]).unwrap().get(machine.parameter_index(seeded).unwrap()).unwrap();
            let at = |x: f64| machine.values(&[(seeded.to_string(), x)]).unwrap().get(2).unwrap();
            let difference = (at(x + 1e-5) - at(x - 1e-5)) / 2e-5;
            let dual: Values<Dual64> = machine.values_with_derivative(&[], seeded).unwrap();
            let value = dual.get(2).unwrap();
            assert_eq!(value.re.to_bits(), at(x).to_bits(), "{expression}");
            assert!((value.eps - difference).abs() < 1e-8, "{expression}: {} {difference}", value.eps);
        }
    }
}

#[test]
fn a_root_of_zero_spoils_no_derivative() {
    let machine = machine("u = 2\nf = sqrt(u - 2) + sqrt(0) + 3*u\ns = blo()\nr = s");
    let value = machine.values_with_derivative(&[], "u").unwrap().get(1).unwrap();
    assert_eq!((value.re, value.eps), (6.0, 3.0));
}
