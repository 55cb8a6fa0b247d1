//! Machines in TOML: what is read, what is refused and where, derivatives, and writing back.

use mainspring_geometry::{Outline, OutlineRecipe, Rigid3, Segment, Shape};
use mainspring_model::{Error, Machine, MotionKind, MotionOver, Values};
use num_dual::Dual64;

const DETENT: &str = include_str!("../../../examples/detent/detent.toml");
const GEARS: &str = include_str!("../../../examples/involute-gears/involute-gears.toml");
const GENEVA: &str = include_str!("../../../examples/geneva-four/geneva-four.toml");
const ARM: &str = include_str!("../../../examples/cam-swinging-follower/cam-swinging-follower.toml");

fn read(text: &str) -> Result<Machine, Error> {
    Machine::parse("m.toml", text.as_bytes(), None)
}

/// The machine at given values, with its primitives.
fn at(machine: &Machine, set: &[(&str, f64)]) -> Result<Machine, Error> {
    let set: Vec<(String, f64)> = set.iter().map(|(n, v)| (n.to_string(), *v)).collect();
    machine.at(&machine.values(&set)?)
}

/// The first error of reading and putting the values in, as shown.
fn refused(text: &str) -> String {
    let error = read(text).and_then(|m| at(&m, &[])).map(|_| ()).expect_err(text);
    error.to_string()
}

/// A machine of one drawn part with this path.
fn drawn(path: &str) -> String {
    format!("[parameters]\nr = 2\nh = \"r*2\"\n[parts.p]\nouter = {{ path = [\n{path}\n] }}\n")
}

#[test]
fn a_machine_says_what_its_file_says() {
    let machine = read(GENEVA).unwrap();
    assert_eq!(machine.name(), "geneva-four");
    assert_eq!(machine.units().length.as_deref(), Some("mm"));
    let names: Vec<&str> = machine.parts().iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["driver", "wheel", "frame"]);
    assert_eq!(machine.frame(), Some(2));
    let slots = &machine.parameters()[0];
    assert!(slots.whole && slots.range == Some((3.0, 12.0)));
    assert_eq!(slots.meaning.as_deref(), Some("slots of the wheel, and steps in its turn"));
    let stated = machine.supplement();
    assert_eq!(stated.motions[1].kind, MotionKind::Turns { center: [50.0, 0.0] });
    assert_eq!(stated.marks[0].value, 135.0);
    // Two arcs and a pin; four pieces of six edges.
    assert_eq!(machine.primitive_count(), 3 + 24);
    assert_eq!(at(&machine, &[("slots", 6.0), ("lock", 17.0)]).unwrap().primitive_count(), 3 + 36);
}

#[test]
fn whole_numbers_are_whole() {
    let machine = read(GENEVA).unwrap();
    let error = at(&machine, &[("slots", 4.5)]).expect_err("half a slot").to_string();
    assert_eq!(error, "--set:1:1: error: slots is 4.5; expected a whole number");
}

#[test]
fn a_boundary_runs_round_its_material() {
    let machine = read(DETENT).unwrap();
    let values = machine.values(&[]).unwrap();
    let primitives = machine.primitives(&values).unwrap();
    let walls = machine.parts()[0].walls.as_ref().unwrap();
    let plane = Rigid3::identity();
    let outline = OutlineRecipe::of_walls(&primitives, walls, &plane).unwrap().evaluate(&primitives, &plane);
    let layer = &outline.layers[0];
    assert!(layer.loops[0].area() > 0.0 && layer.loops[1].area() < 0.0);
    // Six notches, each with two fillets, and the rim between.
    assert_eq!(layer.loops[0].edges.len(), 6 * 4);
    assert!(layer.contains(mainspring_geometry::Vec2::new(10.0, 0.0)));
    assert!(!layer.contains(mainspring_geometry::Vec2::new(19.0, 0.0)));
    assert!(!layer.contains(mainspring_geometry::Vec2::new(0.0, 0.0)));
}

#[test]
fn loops_may_run_either_way() {
    let one = drawn("{ from = [0, 0] }, { line = [4, 0] }, { line = [\"r\", 3] }, { close = true }");
    let other = drawn("{ from = [0, 0] }, { line = [\"r\", 3] }, { line = [4, 0] }, { close = true }");
    let area = |text: &str| outlines(&read(text).unwrap(), &[])[0].layers[0].area();
    assert!((area(&one) - 6.0).abs() < 1e-12 && (area(&other) - 6.0).abs() < 1e-12);
}

fn outlines(machine: &Machine, set: &[(&str, f64)]) -> Vec<Outline> {
    let set: Vec<(String, f64)> = set.iter().map(|(n, v)| (n.to_string(), *v)).collect();
    let values = machine.values(&set).unwrap();
    let machine = machine.at(&values).unwrap();
    let (primitives, plane) = (machine.primitives(&values).unwrap(), Rigid3::identity());
    let walls = machine.parts().iter().filter_map(|p| p.walls.as_ref());
    walls
        .map(|w| OutlineRecipe::of_walls(&primitives, w, &plane).unwrap().evaluate(&primitives, &plane))
        .collect()
}

fn numbers(segment: &Segment) -> Vec<f64> {
    match *segment {
        Segment::Line { from, to } => vec![from.x, from.y, to.x, to.y],
        Segment::Arc { from, to, center, radius, .. } => {
            vec![from.x, from.y, to.x, to.y, center.x, center.y, radius]
        }
        Segment::Circle { center, radius, .. } => vec![center.x, center.y, radius],
    }
}

fn dual_numbers(segment: &Segment<Dual64>) -> Vec<Dual64> {
    match *segment {
        Segment::Line { from, to } => vec![from.x, from.y, to.x, to.y],
        Segment::Arc { from, to, center, radius, .. } => {
            vec![from.x, from.y, to.x, to.y, center.x, center.y, radius]
        }
        Segment::Circle { center, radius, .. } => vec![center.x, center.y, radius],
    }
}

/// Every number of every boundary: its derivative is the limit of differences.
fn check_derivatives(text: &str) {
    let machine = read(text).unwrap();
    let values = machine.values(&[]).unwrap();
    let (primitives, plane) = (machine.primitives(&values).unwrap(), Rigid3::identity());
    for parameter in machine.parameters().iter().filter(|p| p.range.is_some() && !p.whole) {
        let name = parameter.name.as_str();
        let (x, step) = (parameter.default.unwrap(), 1e-6);
        let seeded: Values<Dual64> = machine.values_with_derivative(&[], name).unwrap();
        let dual = machine.primitives(&seeded).unwrap();
        let (low, high) = (outlines(&machine, &[(name, x - step)]), outlines(&machine, &[(name, x + step)]));
        let drawn = machine.parts().iter().filter_map(|p| p.walls.as_ref());
        let mut moved = false;
        for (walls, (low, high)) in drawn.zip(low.iter().zip(&high)) {
            let recipe = OutlineRecipe::of_walls(&primitives, walls, &plane).unwrap();
            let exact = recipe.evaluate(&dual, &Rigid3::<Dual64>::identity());
            for (layer, (l, h)) in exact.layers.iter().zip(low.layers.iter().zip(&high.layers)) {
                let edges = layer.loops.iter().flat_map(|l| &l.edges);
                let others = |o: &mainspring_geometry::Layer| -> Vec<f64> {
                    o.loops.iter().flat_map(|l| &l.edges).flat_map(|e| numbers(&e.segment)).collect()
                };
                let found: Vec<Dual64> = edges.flat_map(|e| dual_numbers(&e.segment)).collect();
                for (f, (a, b)) in found.iter().zip(others(l).iter().zip(&others(h))) {
                    let difference = (b - a) / (2.0 * step);
                    let scale = 1.0 + difference.abs();
                    assert!((f.eps - difference).abs() < 2e-6 * scale, "{name}: {} or {difference}", f.eps);
                    moved |= f.eps != 0.0;
                }
            }
        }
        assert!(moved || name == "push", "{name} moves nothing");
    }
}

#[test]
fn corners_carry_derivatives() {
    [GENEVA, DETENT, ARM, GEARS].into_iter().for_each(check_derivatives);
}

#[test]
fn real_parts_are_the_same_to_the_last_bit() {
    for text in [GENEVA, DETENT, ARM, GEARS] {
        let machine = read(text).unwrap();
        let plain = machine.primitives(&machine.values(&[]).unwrap()).unwrap();
        for parameter in machine.parameters() {
            let seeded = machine.values_with_derivative(&[], &parameter.name).unwrap();
            let dual = machine.primitives(&seeded).unwrap();
            assert!(dual.iter().zip(&plain).all(|(d, p)| d.re() == *p), "{}", parameter.name);
        }
    }
}

#[test]
fn motions_carry_derivatives() {
    let machine = read(GENEVA).unwrap();
    let seeded = machine.values_with_derivative(&[], "a").unwrap();
    let Some(MotionOver::Turns { center }) = machine.stated_motion(1, &seeded).unwrap() else {
        panic!("the wheel turns")
    };
    assert_eq!((center.x.re, center.x.eps, center.y.eps), (50.0, 1.0, 0.0));
}

#[test]
fn fillets_touch_both_edges() {
    // A right angle of lines: the arc's centre is its radius from both; at an arc likewise.
    let text = drawn(
        "{ from = [0, 0], fillet = 0.5 }, { line = [4, 0], fillet = \"r/4\" }, { line = [4, 4] }, \
         { arc = [0, 0], center = [4, 0], turn = \"left\" }",
    );
    let outline = &outlines(&read(&text).unwrap(), &[])[0];
    let arcs: Vec<_> = outline.layers[0].loops[0]
        .edges
        .iter()
        .filter_map(|e| match e.segment {
            Segment::Arc { from, to, center, radius, .. } if radius < 1.0 => Some((from, to, center)),
            _ => None,
        })
        .collect();
    assert_eq!(arcs.len(), 2);
    for (from, to, center) in arcs {
        assert!(((from - center).norm() - 0.5).abs() < 1e-12 && ((to - center).norm() - 0.5).abs() < 1e-12);
        assert!((center.y - 0.5).abs() < 1e-12, "half a unit over the lower line: {center:?}");
        let rim = 4.0 - (center - mainspring_geometry::Vec2::new(4.0, 0.0)).norm();
        assert!((rim - 0.5).abs() < 1e-12 || (center.x - 3.5).abs() < 1e-12);
    }
    assert!(
        outline.layers[0].loops[0]
            .edges
            .iter()
            .filter(|e| e.turn_at_start == mainspring_geometry::Turn::Smooth)
            .count()
            >= 4
    );
}

#[test]
fn errors_name_part_loop_segment_and_values() {
    let line = |text: &str, expected: &str| assert_eq!(refused(text), expected);
    line(
        &drawn(
            "{ from = [0, 0] },\n{ arc = [\"h*2\", 0], radius = \"r\", turn = \"left\" },\n{ close = true }",
        ),
        "m.toml:7:1: error: part p, outer 1, segment 1 (arc): the radius 2 does not reach: its ends are 8 apart; \
         expected a radius of at least 4 (with r = 2)",
    );
    line(
        &drawn("{ from = [0, 0] }, { line = [\"h\", 0] }, { line = [0, 1] }"),
        "m.toml:5:9: error: part p, outer 1: the loop is open: it ends at (0, 1) and begins at (0, 0); \
         expected a closed loop (`close = true`) (with r = 2)",
    );
    line(
        &drawn(
            "{ from = [0, 0] },\n{ line = [5, 5] },\n{ line = [\"h\", 0] },\n{ line = [0, 4] },\n{ close = true }",
        ),
        "m.toml:9:1: error: part p, outer 1, segment 3 (line): it touches or crosses outer 1, segment 1 (line) \
         near (2, 2); expected boundaries that keep apart (with r = 2)",
    );
    line(
        &drawn("{ from = [0, 0] },\n{ line = [1, \"sqrt(1 - h)\"] },\n{ close = true }"),
        "m.toml:7:15: error: part p, outer 1, segment 1 (line): sqrt of -3; expected a number that is not negative \
         (with r = 2)",
    );
    line(
        &drawn(
            "{ from = [0, 0] },\n{ line = [4, 0], fillet = \"h*3\" },\n{ line = [4, 1] },\n{ close = true }",
        ),
        "m.toml:7:1: error: part p, outer 1, segment 1 (line): its fillets take more than its length; \
         expected smaller ones (with r = 2)",
    );
    line(
        "[parameters]\nr = 9\n[parts.p]\nouter = { circle = { center = [0, 0], radius = 5 } }\n\
         inner = { circle = { center = [\"r\", 0], radius = 1 } }\n",
        "m.toml:5:9: error: part p, inner 1: it lies outside the material; expected an inner boundary inside an \
         outer one (with r = 9)",
    );
    line(
        "[parts.p]\nouter = { circle = { center = [0, 0], radius = -5 } }\n",
        "m.toml:2:48: error: part p, outer 1: the radius is -5; expected a positive number",
    );
    line(
        &drawn("{ from = [0, 0] },\n{ arc = [4, 0], center = [1, 0], turn = \"left\" },\n{ close = true }"),
        "m.toml:7:1: error: part p, outer 1, segment 1 (arc): its ends are 1 and 3 from its centre; \
         expected the same distance",
    );
}

#[test]
fn errors_of_form_have_places() {
    let cases = [
        ("[parts.p]\nouter = 3\n", "m.toml:2:9: error: outer is no list; expected values between [ and ]"),
        ("[part.p]\n", "m.toml:1:2: error: the file has no key `part`; expected `parts`, the nearest name"),
        (
            "[parts.p]\nmotoin = 3\n",
            "m.toml:2:1: error: part p has no key `motoin`; expected `motion`, the nearest name",
        ),
        (
            "[parameters]\na = \"b + 1\"\n[parts.p]\n",
            "m.toml:2:6: error: `b` is not defined; expected a defined name",
        ),
        (
            "[parameters]\na = \"b\"\nb = \"a\"\n[parts.p]\n",
            "m.toml:2:1: error: a cycle of names: a -> b -> a; expected no name to use itself",
        ),
        (
            "[parameters]\na = nan\n[parts.p]\n",
            "m.toml:2:5: error: the value of parameter `a` is no finite number; expected a plain number",
        ),
        (
            "[parts.p]\nsolid = \"blo(q=1)\"\n",
            "m.toml:2:14: error: no size of blo is called `q`; expected one of `x`, `y`, `z`",
        ),
        (
            "[parts.a]\nmotion = { turns = [0, 0], on = \"b\" }\n",
            "m.toml:2:33: error: no part is named `b`; expected one of `a`, `frame`",
        ),
        (
            "[parts.a]\nmotion = { fixed = true, on = \"b\" }\n[parts.b]\nmotion = { fixed = true, on = \"a\" }\n",
            "m.toml:2:10: error: a is carried by itself, round a ring of parts; expected carriers that lead to the frame",
        ),
        ("a = = 1\n", "m.toml:1:5: error: no TOML: "),
        (
            "[machine]\nangle = \"rad\"\n[parts.a]\n",
            "m.toml:2:9: error: angles in a file are in degrees; expected \"deg\"",
        ),
        (
            "[parts.a]\nfriction = 1\n",
            "m.toml:2:12: error: a has friction or a spring and no inertia; expected `inertia`, `mass` or `density`",
        ),
    ];
    for (text, expected) in cases {
        let found = refused(text);
        assert!(found.starts_with(expected), "{found}\nnot\n{expected}");
        assert!(found.contains("; expected"), "{found}");
    }
}

#[test]
fn new_values_leave_the_text_as_it_is() {
    let machine = read(GENEVA).unwrap();
    let set = [("pin".to_string(), 2.75), ("slots".to_string(), 5.0)];
    let text = machine.text_with(&set).unwrap();
    let expected =
        GENEVA.replace("pin = { value = 3,", "pin = { value = 2.75,").replace("value = 4,", "value = 5,");
    assert_eq!(text, expected);
    assert_eq!(machine.text_with(&[]).unwrap(), GENEVA);
    let again = read(&text).unwrap();
    assert_eq!(again.parameters()[2].default, Some(2.75));
    let outside = machine.text_with(&[("pin".to_string(), 50.0)]).expect_err("out of its range");
    assert!(outside.message.contains("expected a value in its range [0.5, 5]"), "{outside}");
    let padl = Machine::parse("m.padl", b"generic g(r)\na = cyl()\nr = a\n", None).unwrap();
    assert!(padl.text_with(&[]).is_err());
}

#[test]
fn a_file_is_written_whole() {
    let folder = std::env::temp_dir().join(format!("mainspring-toml-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("new.toml");
    let machine = read(GENEVA).unwrap();
    machine.save(&path, &[("a".to_string(), 60.0)]).unwrap();
    let saved = Machine::load(&path, None).unwrap();
    assert_eq!(saved.values(&[]).unwrap().get(1), Some(60.0));
    let left: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left, ["new.toml"]);
    assert!(machine.save(&folder.join("no").join("where.toml"), &[]).is_err());
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn solids_are_those_of_padl() {
    let toml = "[parameters]\nd = 2\n[solids]\nhole = \"cyl(d=d)\"\n[parts.p]\nsolid = '''\n(blo(x=4, y=4) \\\n at (movx=-2, movy=-2))\n dif hole'''\n\
                density = \"d/2\"\n[parts.base]\nframe = true\nsolid = \"blo() at (movz=-2)\"\n";
    let padl = "generic m(r)\nd = 2\nhole = cyl(d=d)\np = (blo(x=4, y=4) at (movx=-2, movy=-2)) dif hole\n\
                attr p : density = d/2\nbase = blo() at (movz=-2)\nattr base : frame = 1\nr = p asb base\n";
    let (a, b) = (read(toml).unwrap(), Machine::parse("m.padl", padl.as_bytes(), None).unwrap());
    let primitives = |m: &Machine| m.primitives(&m.values(&[]).unwrap()).unwrap();
    assert_eq!(primitives(&a), primitives(&b));
    let csgs = |m: &Machine| {
        m.parts().iter().map(|p| (p.name.clone(), p.csg.clone(), p.is_frame)).collect::<Vec<_>>()
    };
    assert_eq!(csgs(&a), csgs(&b));
    let density = |m: &Machine| m.density(&m.parts()[0], &m.values(&[]).unwrap()).unwrap();
    assert_eq!(density(&a), density(&b));
    assert!(matches!(primitives(&a)[1].shape, Shape::Cylinder { radius: 1.0, .. }));
}
