//! Lower pairs: what makes one, what nearly does, and how it is told.

mod support;

use mainspring_mechanism::{CompileOptions, EvidenceKind, PairKind};
use support::{compile, compile_with, kinds, machine, single};

const PLATE: &str = "blo(x=10, y=10, z=2) at (movx=-5, movy=-5)";

fn two(part: &str, frame: &str) -> String {
    machine(&format!("part = {part}\nframe = {frame}"), &["part", "frame"])
}

fn play(pair_clearance: f64) -> CompileOptions {
    CompileOptions { pair_clearance, ..Default::default() }
}

#[test]
fn shaft_in_hole_turns() {
    let m = compile(&two("cyl(d=2, h=6) at (movz=-2)", &format!("({PLATE}) dif cyl(d=2, h=2)")));
    assert_eq!(kinds(&m), ["revolute/cylindrical part-frame"]);
    let EvidenceKind::ShaftInHole { solid, from, to, angle, .. } = single(&m).evidence[0].what else {
        panic!()
    };
    assert_eq!((solid, from, to), (0, 0.0, 2.0));
    assert!((angle - std::f64::consts::TAU).abs() < 1e-12);
}

#[test]
fn collars_on_both_ends_make_it_revolute_by_shape() {
    let collars = "cyl(d=2, h=6) at (movz=-2) un (cyl(d=4, h=1) at (movz=2)) un (cyl(d=4, h=1) at (movz=-1))";
    let m = compile(&two(collars, &format!("({PLATE}) dif cyl(d=2, h=2)")));
    assert_eq!(kinds(&m), ["revolute/revolute part-frame"]);
    let one = "cyl(d=2, h=6) at (movz=-2) un (cyl(d=4, h=1) at (movz=2))";
    let m = compile(&two(one, &format!("({PLATE}) dif cyl(d=2, h=2)")));
    assert_eq!(kinds(&m), ["revolute/cylindrical part-frame"]);
}

#[test]
fn keys_and_second_shafts_forbid_turning() {
    let key = "cyl(d=2, h=6) un (blo(x=2, y=0.5, z=6) at (movy=-0.25))";
    let m = compile(&two(key, &format!("({PLATE}) dif ({key})")));
    assert_eq!(kinds(&m), ["prismatic/prismatic part-frame"]);
    let pins = "(cyl(d=2, h=6) at (movx=-3)) un (cyl(d=2, h=6) at (movx=3)) un (blo(x=6, y=1, z=1) at (movx=-3, movy=-0.5, movz=4))";
    let holes = format!("({PLATE}) dif (cyl(d=2, h=6) at (movx=-3)) dif (cyl(d=2, h=6) at (movx=3))");
    let m = compile(&two(pins, &holes));
    assert_eq!(kinds(&m), ["prismatic/prismatic part-frame"]);
}

#[test]
fn d_shaft_slides_only() {
    let shaft = "cyl(d=2, h=6) dif (blo(x=2, y=4, z=6) at (movx=0.6, movy=-2))";
    let m = compile(&two(shaft, &format!("({PLATE}) dif ({shaft})")));
    assert_eq!(kinds(&m), ["prismatic/prismatic part-frame"]);
}

#[test]
fn crossed_shafts_fix_the_parts() {
    let cross = "(cyl(d=1, h=2)) un (cyl(d=1, h=10) at (degy=90, movx=-5, movz=1))";
    let m = compile(&two(cross, &format!("({PLATE}) dif ({cross})")));
    assert_eq!(single(&m).kind, PairKind::Fixed);
    assert_eq!(m.subsystems.len(), 0);
}

/// Four blocks around a gap: Gelsey's Algorithm 3 could not see this hole.
#[test]
fn hole_formed_as_a_union_around_a_gap() {
    let around = "(blo(x=8, y=1, z=3) at (movy=1)) un (blo(x=8, y=1, z=3) at (movy=-2)) un \
                  (blo(x=8, y=4, z=1) at (movy=-2, movz=3)) un (blo(x=8, y=4, z=1) at (movy=-2, movz=-1))";
    let m = compile(&two("blo(x=12, y=2, z=3) at (movx=-2, movy=-1)", around));
    assert_eq!(kinds(&m), ["prismatic/prismatic part-frame"]);
    assert_eq!(single(&m).axis.point.y, 0.0);
    assert!((single(&m).axis.point.z - 1.5).abs() < 1e-12);
}

#[test]
fn triangular_hole_guides() {
    let rail = "wed(x=3, y=12, z=2) at (movy=-6)";
    let m = compile(&two(
        rail,
        "(blo(x=8, y=6, z=6) at (movx=-2, movy=-3, movz=-2)) dif (wed(x=3, y=12, z=2) at (movy=-6))",
    ));
    assert_eq!(kinds(&m), ["prismatic/prismatic part-frame"]);
}

#[test]
fn channel_open_on_one_side_is_a_pair_and_says_so() {
    let m = compile(&two(
        "blo(x=2, y=2, z=2) at (movx=3)",
        "(blo(x=9, y=4, z=3) at (movy=-1, movz=-1)) dif blo(x=9, y=2, z=2)",
    ));
    assert_eq!(kinds(&m), ["prismatic/prismatic part-frame"]);
    let open = single(&m).evidence.iter().find(|e| matches!(e.what, EvidenceKind::OpenSide { .. }));
    let text = &open.unwrap_or_else(|| panic!("nothing says it is open")).text;
    assert!(text.contains("open on one side") && text.contains("(0, 0, 1)"), "{text}");
}

/// A tooth that starts in a notch it just fills may leave it: both parts turn about their own shafts.
#[test]
fn tooth_in_a_notch_is_left_to_contact() {
    let text = machine(
        "tooth = blo(x=1, y=0.4) at (movx=1.5, movy=-0.2)
wheel = ((cyl(d=4) un tooth) dif cyl(d=1))
disc = ((cyl(d=4) at (movx=4.2)) dif tooth) dif (cyl(d=1) at (movx=4.2))
frame = (cyl(d=1, h=3) at (movz=-1)) un (cyl(d=1, h=3) at (movx=4.2, movz=-1)) un (blo(x=8, y=2, z=1) at (movx=-2, movy=-1, movz=-2))",
        &["wheel", "disc", "frame"],
    );
    let m = compile(&text);
    assert_eq!(kinds(&m), ["revolute/cylindrical wheel-frame", "revolute/cylindrical disc-frame"]);
}

/// A disc that starts in a hollow arc of less than half a turn is not held by it (as the lock of a Geneva drive).
#[test]
fn shallow_arc_holds_nothing() {
    let text = two("cyl(d=4, h=1)", "(blo(x=3, y=8) at (movx=-4, movy=-4)) dif cyl(d=4, h=1)");
    let m = compile(&text);
    assert_eq!(m.pairs.len(), 0);
    assert!(m.near_misses[0].reason.contains("less than half a turn"), "{:?}", m.near_misses);
}

#[test]
fn half_a_bearing_is_open() {
    let m = compile(&two("cyl(d=2, h=6)", "(blo(x=2, y=6, z=2) at (movx=-2, movy=-3)) dif cyl(d=2, h=2)"));
    assert_eq!(single(&m).shape_kind, PairKind::Cylindrical);
    assert!(single(&m).evidence.iter().any(|e| e.text.contains("open on one side")));
}

/// The fit counts where it is left, however thin: the hole is cut away but for a rim.
#[test]
fn thin_rims_are_not_missed() {
    let holder = format!("(({PLATE}) dif cyl(d=2, h=2)) dif (cyl(d=4, h=1.999))");
    let m = compile(&two("cyl(d=2, h=6) at (movz=-2)", &holder));
    let EvidenceKind::ShaftInHole { from, to, .. } = single(&m).evidence[0].what else { panic!() };
    assert!((from - 1.999).abs() < 1e-9 && (to - 2.0).abs() < 1e-9, "{from} {to}");
}

#[test]
fn slots_leave_the_rest_of_a_bearing() {
    // Eight narrow slots all round: the bearing still holds.
    let slot = "blo(x=3, y=0.02, z=2)";
    let slots: String = (0..8).map(|k| format!(" dif ({slot} at (degz={}))", 45 * k)).collect();
    let m = compile(&two("cyl(d=2, h=6) at (movz=-2)", &format!("({PLATE}) dif cyl(d=2, h=2){slots}")));
    let EvidenceKind::ShaftInHole { angle, .. } = single(&m).evidence[0].what else { panic!() };
    // Each slot starts at its own ray and takes asin(0.02) of the turn.
    assert!((angle - (std::f64::consts::TAU - 8.0 * 0.02f64.asin())).abs() < 1e-9, "{angle}");
}

#[test]
fn clearance_of_shafts() {
    let text = two("cyl(d=1.96, h=6) at (movz=-2)", &format!("({PLATE}) dif cyl(d=2, h=2)"));
    let tight = compile(&text);
    assert_eq!(tight.pairs.len(), 0);
    assert!(tight.near_misses[0].reason.contains("radii differ by 0.02"), "{:?}", tight.near_misses);
    let m = compile_with(&text, &play(0.02));
    assert!((single(&m).clearance - 0.02).abs() < 1e-12);
    assert_eq!(kinds(&m), ["revolute/cylindrical part-frame"]);
    assert_eq!(compile_with(&text, &play(0.0199)).pairs.len(), 0);
    // A shaft larger than its hole is never a pair.
    let large = two("cyl(d=2.02, h=1) at (movz=5)", &format!("({PLATE}) dif cyl(d=2, h=2)"));
    assert_eq!(compile_with(&large, &play(0.1)).pairs.len(), 0);
}

#[test]
fn clearance_of_blocks() {
    let slot = "(blo(x=9, y=4, z=4) at (movy=-2, movz=-2)) dif (blo(x=9, y=2, z=2) at (movy=-1, movz=-1))";
    let text = two("blo(x=2, y=1.9, z=1.9) at (movx=3, movy=-0.95, movz=-0.95)", slot);
    let tight = compile(&text);
    assert_eq!(tight.pairs.len(), 0);
    assert!(tight.near_misses[0].reason.contains("play of 0.05"), "{:?}", tight.near_misses);
    let m = compile_with(&text, &play(0.06));
    assert_eq!(kinds(&m), ["prismatic/prismatic part-frame"]);
    assert!((single(&m).clearance - 0.05).abs() < 1e-12);
    let off = two("blo(x=2, y=1.9, z=1.9) at (movx=3, movy=-0.97, movz=-0.95)", slot);
    let m = compile_with(&off, &play(0.1));
    assert_eq!(m.pairs.len(), 0);
    assert!(m.near_misses[0].reason.contains("differs"), "{:?}", m.near_misses);
}

#[test]
fn near_misses_say_why() {
    let hole = format!("({PLATE}) dif cyl(d=2, h=2)");
    let cases = [
        ("cyl(d=2, h=2) at (movz=2)", "cyl(d=2, h=2)".to_string(), "no intersection"),
        ("cyl(d=2, h=2) at (movz=5)", hole.clone(), "3 apart along it"),
        ("cyl(d=2, h=2) at (movz=2)", hole.clone(), "no intersection"),
        (
            "(blo(x=3, y=3, z=1) at (movz=3, movx=-1.5, movy=-1.5)) dif (cyl(d=2, h=2) at (movz=2.5))",
            format!("({PLATE}) dif (cyl(d=2, h=4))"),
            "no intersection",
        ),
    ];
    for (part, frame, expected) in cases {
        let m = compile(&two(part, &frame));
        let reasons: Vec<&str> = m.near_misses.iter().map(|n| n.reason.as_str()).collect();
        let hit = reasons.iter().any(|r| r.contains(expected));
        let cut = reasons.iter().any(|r| r.contains("cut away"));
        assert!(m.pairs.is_empty() && (hit || cut), "{part}: {reasons:?}");
    }
}

#[test]
fn cut_away_surfaces_are_told() {
    // The hole was drilled, then the plate around it taken away.
    let m = compile(&two("cyl(d=2, h=2)", &format!("({PLATE}) dif cyl(d=2, h=2) dif cyl(d=6, h=2)")));
    assert!(m.pairs.is_empty());
    assert!(m.near_misses[0].reason.contains("frame is cut away"), "{:?}", m.near_misses);
}

#[test]
fn renaming_and_order_change_nothing_but_the_order() {
    let defs = |part: &str| format!("{part} = cyl(d=2, h=6)\nframe = ({PLATE}) dif cyl(d=2, h=2)");
    let a = compile(&machine(&defs("part"), &["part", "frame"]));
    let b = compile(&machine(&defs("zeta"), &["frame", "zeta"]));
    assert_eq!(kinds(&a), ["revolute/cylindrical part-frame"]);
    assert_eq!(kinds(&b), ["revolute/cylindrical frame-zeta"]);
    assert_eq!(a.pairs[0].axis, b.pairs[0].axis);
}

#[test]
fn axes_are_normalised() {
    for (turn, direction) in
        [("degx=180", [0.0, 0.0, 1.0]), ("degy=-90", [1.0, 0.0, 0.0]), ("degx=90", [0.0, 1.0, 0.0])]
    {
        let defs = format!(
            "part = cyl(d=2, h=6) at ({turn}, movx=1)\nframe = (({PLATE}) dif cyl(d=2, h=2)) at ({turn}, movx=1)"
        );
        let m = compile(&machine(&defs, &["part", "frame"]));
        let axis = single(&m).axis;
        let d = axis.direction;
        assert_eq!([d.x, d.y, d.z], direction, "{turn}");
        assert!(axis.point.dot(d).abs() < 1e-12, "{axis:?}");
        assert!(
            [d.x, d.y, d.z, axis.point.x, axis.point.y, axis.point.z].iter().all(|c| c.is_sign_positive())
        );
    }
}

/// Flat on flat at the start: contact, not a pair.
#[test]
fn lever_leaning_on_a_stop_still_turns() {
    let lever = "(blo(x=6, y=1, z=1) at (movx=-1, movy=-0.5)) dif cyl(d=0.5, h=1)";
    let frame = "(cyl(d=0.5, h=3) at (movz=-1)) un (blo(x=2, y=1, z=2) at (movx=2, movy=0.5, movz=-1))";
    let m = compile(&two(lever, frame));
    assert_eq!(kinds(&m), ["revolute/cylindrical part-frame"]);
    // Only the shaft is no contact: the stop is.
    assert_eq!(single(&m).surfaces.each_ref().map(Vec::len), [1, 1]);
    let between = format!("{frame} un (blo(x=2, y=1, z=2) at (movx=2, movy=-1.5, movz=-1))");
    assert_eq!(kinds(&compile(&two(lever, &between))), ["prismatic/prismatic part-frame"]);
}

/// A slider that rests on its end stop at the start: the slot makes the pair, the stop is contact.
#[test]
fn end_stops_are_contact() {
    let text = two("blo(x=2)", "(blo(x=9, y=3, z=3) at (movx=-1, movy=-1, movz=-1)) dif blo(x=8)");
    let m = compile(&text);
    assert_eq!(kinds(&m), ["prismatic/prismatic part-frame"]);
    assert_eq!(single(&m).surfaces.each_ref().map(Vec::len), [4, 4]);
    assert!(single(&m).evidence.iter().any(|e| matches!(e.what, EvidenceKind::EndFaces { .. })));
}
