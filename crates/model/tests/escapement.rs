//! The shipped escapement (Gelsey 1995, Figs. 12 and 13): parts, parameters, primitives, supplement.

use mainspring_geometry::{CsgOp, Shape, Vec3};
use mainspring_model::{Machine, Spring};
use num_dual::Dual64;
use std::path::PathBuf;

fn escapement() -> Machine {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../examples/escapement/escapement.padl");
    Machine::load(&path, None).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn parts_are_the_operands_of_asb() {
    let machine = escapement();
    let names: Vec<&str> = machine.parts().iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["ewheel", "lever", "bwheel", "frame"]);
    assert_eq!(machine.name(), "esc");
    assert_eq!(machine.frame(), Some(3));
    let leaves: Vec<usize> = machine.parts().iter().map(|p| p.csg.leaves().count()).collect();
    // Wheel: disc, ten teeth, hole. The frame holds copies of all the others.
    assert_eq!(leaves, [12, 8, 3, 6 + 12 + 8 + 3]);
    assert_eq!(machine.primitive_count(), 52);
}

#[test]
fn numeric_definitions_are_parameters() {
    let machine = escapement();
    let found: Vec<_> = machine.parameters().iter().map(|p| (p.name.as_str(), p.default, p.range)).collect();
    let expected = [
        ("gap", Some(36.0), Some((30.0, 40.0))),
        ("entry_tip", Some(7.0), None),
        ("entry_flank", Some(25.0), None),
        ("exit_pallet", Some(-40.0), None),
    ];
    assert_eq!(found, expected);
}

#[test]
fn supplement_names_parts_in_capitals() {
    let machine = escapement();
    let pairs = &machine.supplement().pairs;
    let rows: Vec<_> = pairs.iter().map(|p| (p.part, p.other, p.inertia, p.friction, p.spring)).collect();
    let spring = |relaxed, constant| Some(Spring { relaxed, constant });
    let expected = [
        (1, 3, Some(10.0), 5.0, None),
        (2, 3, Some(20.0), 6.0, spring(90.0, 15.0)),
        (0, 3, Some(200.0), 20.0, spring(-10000.0, 20.0)),
    ];
    assert_eq!(rows, expected);
}

#[test]
fn primitives_stand_where_the_text_says() {
    let machine = escapement();
    let primitives = machine.primitives(&machine.values(&[]).unwrap()).unwrap();
    let Shape::Cylinder { radius, height } = primitives[0].shape else { panic!("the disc comes first") };
    assert_eq!((radius, height), (5.0, 1.0));
    // The hole through the wheel: diameter 1 and height 1, both as written or omitted.
    assert_eq!(primitives[11].shape, Shape::Cylinder { radius: 0.5, height: 1.0 });
    assert_eq!(machine.label_of_primitive(1), "tooth (blo)");
    assert_eq!(machine.label_of_primitive(11), "ewheel (cyl)");
    // The first tooth's corner, and that of the tooth turned by 2 · 36°.
    let corner = Vec3::new(0.0, 0.0, 0.0);
    assert_eq!(primitives[1].machine_from_local.apply(corner), Vec3::new(-3.2, 0.0, 0.0));
    let turned = primitives[3].machine_from_local.apply(corner);
    let angle = 72f64.to_radians();
    assert!((turned.x + 3.2 * angle.cos()).abs() < 1e-15 && (turned.y + 3.2 * angle.sin()).abs() < 1e-15);
    // The lever's hole is put back to where it was, but for the turn of 5° about it.
    let hole = primitives[12 + 7].machine_from_local.apply(corner);
    assert!((hole.y - 7.5).abs() < 1e-15 && hole.x.abs() < 1e-15);
}

#[test]
fn lever_subtracts_its_hole_last() {
    let machine = escapement();
    let ops = &machine.parts()[1].csg.ops;
    assert_eq!(ops[ops.len() - 2..], [CsgOp::Leaf(19), CsgOp::Difference]);
    assert_eq!(ops.iter().filter(|op| **op == CsgOp::Union).count(), 6);
}

#[test]
fn derivatives_agree_with_differences_and_real_parts_to_the_bit() {
    let machine = escapement();
    let values = machine.values(&[]).unwrap();
    let plain = machine.primitives(&values).unwrap();
    for parameter in machine.parameters() {
        let name = parameter.name.as_str();
        let seeded = machine.values_with_derivative(&[], name).unwrap();
        let dual = machine.primitives::<Dual64>(&seeded).unwrap();
        let at = |x: f64| {
            let set = [(name.to_string(), x)];
            machine.primitives(&machine.values(&set).unwrap()).unwrap()
        };
        let (x, step) = (parameter.default.unwrap(), 1e-4);
        let (above, below) = (at(x + step), at(x - step));
        let mut moved = 0;
        for i in 0..plain.len() {
            assert_eq!(dual[i].re(), plain[i]);
            for point in [Vec3::new(0.0, 0.0, 0.0), Vec3::new(1.0, 2.0, 0.5)] {
                let derivative = dual[i].machine_from_local.apply(Vec3::constant(point));
                let difference =
                    above[i].machine_from_local.apply(point) - below[i].machine_from_local.apply(point);
                for (d, difference) in [(derivative.x.eps, difference.x), (derivative.y.eps, difference.y)] {
                    assert!((d - difference / (2.0 * step)).abs() < 1e-8, "{name} of primitive {i}");
                    moved += usize::from(d != 0.0);
                }
            }
        }
        assert!(moved > 0, "{name} moves nothing");
    }
}

#[test]
fn settings_are_checked() {
    let machine = escapement();
    let message =
        |name: &str, value: f64| machine.values(&[(name.to_string(), value)]).unwrap_err().to_string();
    assert!(machine.values(&[("GAP".to_string(), 30.0)]).is_ok());
    let outside = message("gap", 40.0000001);
    assert!(
        outside.starts_with("--set:1:1: error: gap is 40.0000001; expected a value in its range [30, 40]")
    );
    assert!(message("gab", 36.0).contains("no parameter is named `gab`; expected `gap`, the nearest name"));
    assert!(message("exit_pallet", f64::NAN).contains("exit_pallet is NaN; expected a finite number"));
    assert!(message("lever", 1.0).contains("no parameter is named `lever`"));
}
