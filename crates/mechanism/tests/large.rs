//! Machines near the limits of the language: compiled, or refused in one message, soon, with what was left out told.

mod support;

use mainspring_mechanism::{Mechanism, PairKind};
use mainspring_model::Error;
use std::fmt::Write as _;
use std::time::{Duration, Instant};
use support::{machine, try_compile};

/// Five seconds are promised with optimization on an idle machine; here there is neither.
const PATIENCE: Duration = Duration::from_secs(60);

/// Primitives of each of two parts that together have as many as the language allows.
const HALF: usize = 5_000;

fn try_soon(text: &str) -> Result<Mechanism, Error> {
    let start = Instant::now();
    let outcome = try_compile(text, "", &Default::default());
    assert!(start.elapsed() < PATIENCE, "{:?}", start.elapsed());
    outcome
}

fn soon(text: &str) -> Mechanism {
    try_soon(text).unwrap_or_else(|e| panic!("{e}"))
}

fn refused(text: &str, what: &str) {
    let error = try_soon(text).expect_err(what).to_string();
    assert!(error.starts_with("test.padl:") && error.contains(what), "{error}");
}

fn told(mechanism: &Mechanism, what: &str) -> bool {
    mechanism.warnings.iter().any(|w| w.message.contains(what))
}

/// A frame and `count` parts, each written from its number, with a density.
fn many(frame: &str, count: usize, part: impl Fn(usize) -> String) -> String {
    let mut text = format!("frame = {frame}\n");
    let names: Vec<String> = (0..count).map(|i| format!("p{i}")).collect();
    for (i, name) in names.iter().enumerate() {
        writeln!(text, "{name} = {}\nattr {name} : density = 1", part(i)).unwrap();
    }
    let mut parts = vec!["frame"];
    parts.extend(names.iter().map(String::as_str));
    machine(&text, &parts)
}

fn two(frame: &str, part: &str) -> String {
    many(frame, 1, |_| part.to_string())
}

/// Shafts in the holes of one plate, all tilted, each with a head that is planar in no direction.
fn shafts(count: usize) -> String {
    let tilt = "degx=30, degy=20";
    let (length, row) = (4 * count, "x, TRANSLATIONAL");
    let holes = format!("SYMMETRIC_UNION(cyl(d=1) at (movx=2, movy=2), {row}, {count}, {length})");
    let frame = format!("(blo(x={length}, y=4) dif {holes}) at ({tilt})");
    let head = "(sph(r=0.4) dif con(d=0.3, h=0.2) at (degx=20)) at (movz=1.5)";
    many(&frame, count, |i| format!("(cyl(d=1) un {head}) at (movx={}, movy=2) at ({tilt})", 2 + 4 * i))
}

#[test]
fn tilted_parts_with_a_density() {
    let few = soon(&shafts(20));
    assert_eq!(few.pairs.len(), 20);
    assert!(!told(&few, "from its density"), "{:?}", few.warnings);
    // The shaft, π/32, and the ball, 8/15 π 0.4⁵, less a little.
    let inertia = few.parts[1].inertia.unwrap();
    assert!((0.1150..0.1154).contains(&inertia), "{inertia}");
    // Two thousand share the work of a few.
    let many = soon(&shafts(2_000));
    assert!(told(&many, "too many faces"));
    let known: Vec<f64> = many.parts.iter().filter_map(|p| p.inertia).collect();
    assert!(known.len() > 300, "{}", known.len());
    assert!(known.iter().all(|k| (k / inertia - 1.0).abs() < 0.01), "{known:?}");
}

/// Each of many parts costs what is near it, not the whole plate it stands on: otherwise the work ran out, gears
/// without their pairs counted as parts that overlap, and the error was wrong.
#[test]
fn a_train_of_a_thousand_gears_on_one_plate() {
    const GEARS: usize = 1_000;
    let holes =
        format!("SYMMETRIC_UNION(cyl(d=1) at (movx=2, movy=3), x, TRANSLATIONAL, {GEARS}, {})", 2 * GEARS);
    let plate = format!("(blo(x={}, y=6) dif {holes}) at (movz=-1)", 2 * GEARS + 4);
    let names: Vec<String> = (0..GEARS).map(|i| format!("p{i}")).collect();
    let mut text = format!("frame = {plate}\n");
    for i in 0..GEARS {
        writeln!(text, "g{i} = cyl(d=2.2)\nattr g{i} : gear = 1").unwrap();
        writeln!(text, "p{i} = (g{i} un cyl(d=1) at (movz=-1)) at (movx={}, movy=3)", 2 + 2 * i).unwrap();
    }
    let mut parts = vec!["frame"];
    parts.extend(names.iter().map(String::as_str));
    let train = soon(&machine(&text, &parts));
    let of = |kind: PairKind| train.pairs.iter().filter(|p| p.kind == kind).count();
    assert_eq!((of(PairKind::Revolute), of(PairKind::Gear)), (GEARS, GEARS - 1));
    assert_eq!(train.subsystems.len(), 1);
}

/// The faces of bars across each other cost all the work they may, and the shaft under them is found all the same.
#[test]
fn a_shaft_under_many_faces() {
    let star = "SYMMETRIC_UNION(blo(x=20, y=0.1) at (movx=-10), z, ROTATIONAL, 200, 360)";
    let plate = "blo(x=4, y=4) at (movx=-2, movy=-2, movz=-1) dif cyl(d=1) at (movz=-1)";
    let wheel = soon(&two(plate, &format!("{star} un cyl(d=1) at (movz=-1)")));
    assert!(told(&wheel, "too many faces") && wheel.pairs.len() == 1, "{:?}", wheel.warnings);
    assert!(wheel.pairs[0].kind.turns());
}

#[test]
fn one_tilted_part_of_all_primitives() {
    for operation in ["un", "dif", "int"] {
        let mut part = "cyl(d=1, h=4)".to_string();
        for i in 0..9_990 {
            let (x, y, z) = (i % 37, i % 41, i % 43);
            write!(part, " {operation} con(d=1, h=5) at (degx={x}, degy={y}, movx=0.0{z}, movz=1.5)")
                .unwrap();
        }
        soon(&two("blo(x=2, y=2) at (movx=-1, movy=-1) dif cyl(d=1)", &part));
    }
}

#[test]
fn as_many_parts_as_primitives() {
    let count = 9_999;
    let row = soon(&many(&format!("blo(x={count})"), count, |i| format!("blo() at (movx={i}, movy=1)")));
    assert_eq!((row.parts.len(), row.pairs.len()), (count + 1, 0));
    let cones =
        soon(&many("blo()", count, |i| format!("con() at (degx={}, movx={}, movy=3)", i % 90, 2 * i)));
    assert!(cones.parts.iter().skip(1).any(|p| p.outline.is_none()));
    let heap = many("blo()", count, |i| format!("con() at (degx={}, movx=0.{i:05}, movy=3)", i % 90));
    refused(&heap, "overlap at the start");
}

#[test]
fn a_crowd_of_parts() {
    let rings = many("cyl(d=2)", 3_000, |i| format!("cyl(d={}) dif cyl(d={})", 2 * i + 4, 2 * i + 2));
    let rings = soon(&rings);
    assert!(told(&rings, "pairs of parts near each other were examined"));
    assert!(told(&rings, "boxes were checked for overlap") || told(&rings, "be checked for overlap"));
    let stack = soon(&many("blo() at (movz=-3)", 5_000, |i| format!("cyl(d=3) at (movz={i})")));
    assert!(told(&stack, "near misses are listed") && stack.pairs.is_empty());
}

#[test]
fn a_chain_of_three_thousand_carriers() {
    let link = "blo(x=6, y=2) un cyl(d=1) at (movx=1, movy=1, movz=-1) dif cyl(d=1) at (movx=5, movy=1)";
    let frame = "blo(x=3, y=2) at (movz=-1) dif cyl(d=1) at (movx=1, movy=1, movz=-1)";
    let chain = soon(&many(frame, 3_000, |i| format!("({link}) at (movx={}, movz={i})", 4 * i)));
    assert_eq!(chain.pairs.len(), 3_000);
    assert!(chain.pairs.iter().all(|p| p.kind == PairKind::Revolute));
}

#[test]
fn two_parts_of_many_primitives() {
    let comb = |shape: &str, axis: &str, step: usize| {
        format!("SYMMETRIC_UNION({shape}, {axis}, TRANSLATIONAL, {HALF}, {})", step * HALF)
    };
    let star = |shape: &str, axis: &str, range: usize| {
        format!("SYMMETRIC_UNION({shape}, {axis}, ROTATIONAL, {HALF}, {range})")
    };
    let machines = [
        two(&comb("cyl()", "z", 2), &comb("cyl() at (movz=1)", "z", 2)),
        two(&comb("wed()", "x", 1), &comb("wed() at (degy=180, movx=1, movz=1)", "x", 1)),
        two(&star("blo(x=9)", "z", 360), &star("blo(x=9) at (movz=1)", "z", 180)),
        two(&star("con(h=9)", "x", 360), &star("con(h=9) at (movx=20)", "x", 180)),
        two(&star("cyl(h=9) at (degy=45, movx=3)", "z", 360), &star("cyl() at (degy=45, movz=30)", "z", 180)),
    ];
    for text in machines {
        assert!(!soon(&text).warnings.is_empty(), "{text}");
    }
}

#[test]
fn several_outlines_with_all_spokes_across_each_other() {
    let star = "SYMMETRIC_UNION(blo(x=9), z, ROTATIONAL, 900, 360)";
    let stacked = soon(&many("blo()", 10, |i| format!("{star} at (movz={})", i + 1)));
    let why = |n: &Option<String>| n.as_deref().is_some_and(|n| n.contains("too many curves"));
    assert!(stacked.parts.iter().any(|p| why(&p.note)) && stacked.parts[0].outline.is_some());
}

/// A solid doubled as often as the limits allow: all its copies coincide.
#[test]
fn copies_on_copies() {
    for shape in ["blo()", "cyl()", "con()", "cyl() at (degx=30)"] {
        let mut text = format!("frame = blo() at (movx=4)\nd0 = {shape}\n");
        for i in 0..13 {
            writeln!(text, "d{} = d{i} un d{i} at (movx=0)", i + 1).unwrap();
        }
        writeln!(text, "p = d13\nattr p : density = 1").unwrap();
        soon(&machine(&text, &["frame", "p"]));
    }
}

#[test]
fn nested_as_deep_as_allowed() {
    for operation in ["un", "dif", "int"] {
        let open: String = (0..199).map(|i| format!("(blo(x=3, y=3) at (degz={i}) {operation} ")).collect();
        soon(&two("blo() at (movz=5)", &format!("{open}cyl(){}", ")".repeat(199))));
    }
}
