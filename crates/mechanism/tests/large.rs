//! Machines near the limits of the language: all must be compiled, or refused in one message, soon.

mod support;

use mainspring_mechanism::Mechanism;
use mainspring_model::Error;
use std::fmt::Write as _;
use std::time::{Duration, Instant};
use support::{machine, try_compile};

/// Five seconds are promised with optimization on an idle machine; here there is neither.
const PATIENCE: Duration = Duration::from_secs(60);

fn soon(story: &str, text: &str) -> Result<Mechanism, Error> {
    let start = Instant::now();
    let outcome = try_compile(text, "", &Default::default());
    let told = match &outcome {
        Ok(m) => format!("{} parts, {} pairs, {} warnings", m.parts.len(), m.pairs.len(), m.warnings.len()),
        Err(e) => e.to_string(),
    };
    println!("{:?}: {story}: {told}", start.elapsed());
    assert!(start.elapsed() < PATIENCE, "{story}: {:?}", start.elapsed());
    outcome
}

/// A machine of a frame and `count` parts, each from its number.
fn many(frame: &str, count: usize, part: impl Fn(usize) -> String, attribute: &str) -> String {
    let mut text = format!("frame = {frame}\n");
    let names: Vec<String> = (0..count).map(|i| format!("p{i}")).collect();
    for (i, name) in names.iter().enumerate() {
        writeln!(text, "{name} = {}", part(i)).unwrap();
        if !attribute.is_empty() {
            writeln!(text, "attr {name} : {attribute}").unwrap();
        }
    }
    let mut parts = vec!["frame"];
    parts.extend(names.iter().map(String::as_str));
    machine(&text, &parts)
}

/// Shafts in the holes of one plate, each with something tilted on its end, and a density.
fn shafts(count: usize, tilt: &str, head: &str) -> String {
    let frame = format!(
        "blo(x={}, y=4) dif SYMMETRIC_UNION(cyl(d=1) at (movx=2, movy=2), x, TRANSLATIONAL, {count}, {})",
        4 * count,
        4 * count
    );
    let frame = format!("({frame}) at ({tilt})");
    let part =
        |i: usize| format!("(cyl(d=1) un {head} at (movz=1.5)) at (movx={}, movy=2) at ({tilt})", 2 + 4 * i);
    many(&frame, count, part, "density = 1")
}

#[test]
fn tilted_parts_with_a_density() {
    let head = "(sph(r=0.4) dif con(d=0.3, h=0.2) at (degx=20))";
    for tilt in ["movx=0", "degx=30, degy=20"] {
        for count in [10, 100, 1000, 2400] {
            soon(&format!("{count} shafts {tilt}"), &shafts(count, tilt, head)).unwrap();
        }
    }
}

#[test]
fn one_tilted_part_of_all_primitives_the_language_allows() {
    for (operation, count) in [("un", 9998), ("dif", 9998), ("int", 9998)] {
        let mut part = "cyl(d=1, h=4)".to_string();
        for i in 0..count - 2 {
            let (x, y, z) = (i % 37, i % 41, i % 43);
            write!(part, " {operation} con(d=1, h=5) at (degx={x}, degy={y}, movx=0.0{z}, movz=1.5)")
                .unwrap();
        }
        let text =
            many("blo(x=2, y=2) at (movx=-1, movy=-1) dif cyl(d=1)", 1, |_| part.clone(), "density = 1");
        _ = soon(&format!("{count} cones joined by {operation}"), &text);
    }
}

#[test]
fn as_many_parts_as_primitives() {
    for count in [1000, 9999] {
        let apart = |i: usize| format!("blo() at (movx={}, movy=3)", 2 * i);
        soon(&format!("{count} blocks apart"), &many("blo()", count, apart, "density = 1")).unwrap();
        let row = |i: usize| format!("blo() at (movx={}, movy=1)", i);
        soon(
            &format!("{count} blocks in a row"),
            &many(&format!("blo(x={count})"), count, row, "density = 1"),
        )
        .unwrap();
        let cones = |i: usize| format!("con() at (degx={}, movx={}, movy=3)", i % 90, 2 * i);
        soon(&format!("{count} tilted cones"), &many("blo()", count, cones, "density = 1")).unwrap();
        let heap = |i: usize| format!("con() at (degx={}, movx=0.{i:05}, movy=3)", i % 90);
        _ = soon(&format!("{count} cones in a heap"), &many("blo()", count, heap, "density = 1"));
        let disks = |i: usize| format!("cyl(d=3) at (movx={})", 3 * i);
        _ = soon(&format!("{count} touching disks"), &many("blo() at (movz=3)", count, disks, "gear = 1"));
        let stack = |i: usize| format!("cyl(d=3) at (movz={i})");
        _ = soon(
            &format!("{count} disks on one axis"),
            &many("blo() at (movz=-3)", count, stack, "density = 1"),
        );
        let rings = |i: usize| format!("cyl(d={}) dif cyl(d={})", 2 * i + 2, 2 * i);
        if count < 5000 {
            _ = soon(&format!("{count} rings in each other"), &many("cyl(d=2)", count, rings, "density = 1"));
        }
    }
    let rings = |i: usize| format!("cyl(d={}) dif cyl(d={})", 2 * i + 4, 2 * i + 2);
    _ = soon("4900 rings in each other", &many("cyl(d=2)", 4900, rings, "density = 1"));
}

#[test]
fn two_parts_of_many_primitives() {
    let half = 4999;
    let comb = |shape: &str, axis: &str, step: usize| {
        format!("SYMMETRIC_UNION({shape}, {axis}, TRANSLATIONAL, {half}, {})", step * half)
    };
    let pairs = [
        ("blocks above blocks", comb("blo()", "x", 2), comb("blo() at (movz=1)", "x", 2)),
        ("blocks beside blocks", comb("blo()", "x", 2), comb("blo() at (movx=1)", "x", 2)),
        ("stacked shafts", comb("cyl()", "z", 2), comb("cyl() at (movz=1)", "z", 2)),
        ("wedges on wedges", comb("wed()", "x", 1), comb("wed() at (degy=180, movx=1, movz=1)", "x", 1)),
        (
            "turned blocks",
            format!("SYMMETRIC_UNION(blo(x=9), z, ROTATIONAL, {half}, 360)"),
            format!("SYMMETRIC_UNION(blo(x=9) at (movz=1), z, ROTATIONAL, {half}, 180)"),
        ),
        (
            "turned about x",
            format!("SYMMETRIC_UNION(blo(x=9), x, ROTATIONAL, {half}, 360)"),
            format!("SYMMETRIC_UNION(blo(x=9) at (movx=9), x, ROTATIONAL, {half}, 180)"),
        ),
        (
            "turned cones",
            format!("SYMMETRIC_UNION(con(h=9), x, ROTATIONAL, {half}, 360)"),
            format!("SYMMETRIC_UNION(con(h=9) at (movx=1), x, ROTATIONAL, {half}, 180)"),
        ),
        (
            "tilted cylinders",
            format!("SYMMETRIC_UNION(cyl(h=9) at (degy=45, movx=3), z, ROTATIONAL, {half}, 360)"),
            format!("SYMMETRIC_UNION(cyl(h=9) at (degy=45, movx=4), z, ROTATIONAL, {half}, 180)"),
        ),
        ("spheres", comb("sph()", "x", 1), comb("sph() at (movx=0.5)", "x", 1)),
        (
            "spheres cut",
            format!("blo(x=9) int ({})", comb("sph()", "x", 1)),
            format!("blo(x=9) dif ({})", comb("sph()", "x", 1)),
        ),
        (
            "grid",
            format!(
                "SYMMETRIC_UNION(SYMMETRIC_UNION(cyl(d=1) at (degz=1), x, TRANSLATIONAL, 70, 140), y, TRANSLATIONAL, 70, 140)"
            ),
            format!(
                "blo(x=140, y=140) dif SYMMETRIC_UNION(SYMMETRIC_UNION(cyl(d=1) at (degz=1), x, TRANSLATIONAL, 70, 140), y, TRANSLATIONAL, 70, 140)"
            ),
        ),
        (
            "tilted grid",
            format!(
                "SYMMETRIC_UNION(SYMMETRIC_UNION(cyl(d=1), x, TRANSLATIONAL, 70, 140), y, TRANSLATIONAL, 70, 140) at (degx=20)"
            ),
            format!(
                "(blo(x=140, y=140) dif SYMMETRIC_UNION(SYMMETRIC_UNION(cyl(d=1), x, TRANSLATIONAL, 70, 140), y, TRANSLATIONAL, 70, 140)) at (degx=20)"
            ),
        ),
    ];
    for (story, frame, part) in pairs {
        for attribute in ["density = 1", "gear = 1"] {
            _ = soon(&format!("{story} {attribute}"), &many(&frame, 1, |_| part.clone(), attribute));
        }
    }
}

#[test]
fn few_parts_of_many_primitives() {
    for parts in [10, 100] {
        let each = 9990 / (parts + 1);
        for shape in [
            "blo(x=9)",
            "con(h=9)",
            "cyl(h=9) at (degy=30)",
            "wed(x=5, y=5)",
            "cyl(d=5)",
            "blo() at (movx=3)",
        ] {
            for axis in ["x", "z"] {
                for shift in ["movz=1", "movx=1", "movy=0.001"] {
                    let part = |i: usize| {
                        format!(
                            "SYMMETRIC_UNION({shape}, {axis}, ROTATIONAL, {each}, 360) at ({shift}) at (movz={}, movx={})",
                            i % 3,
                            i / 3
                        )
                    };
                    let frame =
                        format!("SYMMETRIC_UNION({shape}, {axis}, ROTATIONAL, {each}, 360) at (movz=-1)");
                    _ = soon(
                        &format!("{parts} parts of {shape} about {axis} {shift}"),
                        &many(&frame, parts, part, "density = 1"),
                    );
                }
            }
        }
    }
}

#[test]
fn a_long_chain_of_carriers() {
    for count in [100, 1000, 3000] {
        let part = |i: usize| {
            format!(
                "(blo(x=6, y=2) un cyl(d=1, h=2) at (movx=1, movy=1) dif cyl(d=1, h=1) at (movx=5, movy=1)) at (movx={}, movz={})",
                4 * i,
                i
            )
        };
        let part = |i: usize| {
            part(i).replace(
                "un cyl(d=1, h=2) at (movx=1, movy=1)",
                "un cyl(d=1, h=1) at (movx=1, movy=1, movz=-1)",
            )
        };
        let frame = "blo(x=3, y=2) at (movz=-1) dif cyl(d=1) at (movx=1, movy=1, movz=-1)";
        _ = soon(&format!("a chain of {count}"), &many(frame, count, part, "density = 1"));
    }
}
