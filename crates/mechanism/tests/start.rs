//! The start: overlaps, initial positions, densities; and what simulation refuses.

mod support;

use mainspring_mechanism::{CompileOptions, Mechanism, PairKind};
use support::{compile, compile_with, kinds, machine, single, try_compile};

fn with(text: &str, supplement: &str) -> Result<Mechanism, String> {
    try_compile(text, supplement, &CompileOptions::default()).map_err(|e| e.to_string())
}

fn refusal(m: &Mechanism) -> String {
    m.system().map(|_| ()).map_err(|e| e.to_string()).expect_err("expected a refusal")
}

/// A lever on a shaft, with a post that it meets when turned by 90 degrees.
const LEVER: &str = "lever = (blo(x=4, y=1, z=1) at (movx=-0.5, movy=-0.5)) dif (cyl(d=0.5, h=1))
frame = (cyl(d=0.5, h=2)) un (blo(x=1, y=6, z=1) at (movx=-0.5, movy=-0.5, movz=-1)) un (cyl(d=1, h=2) at (movy=3, movz=-1))";

#[test]
fn overlap_at_the_start_is_an_error_with_a_place() {
    let text = machine(&LEVER.replace("movy=3,", "movx=3, movy=0.7,"), &["lever", "frame"]);
    let message = with(&text, "").map(|_| ()).unwrap_err();
    assert!(
        message.contains("lever and frame overlap at the start") && message.starts_with("test.padl:"),
        "{message}"
    );
    // Touching is allowed: the post's centre one radius and half a width away.
    let text = machine(&LEVER.replace("movy=3,", "movx=3, movy=1,"), &["lever", "frame"]);
    assert!(with(&text, "").is_ok());
}

#[test]
fn initial_positions_are_applied_before_looking_for_overlaps() {
    let text = machine(LEVER, &["lever", "frame"]);
    assert!(with(&text, "POSITION lever 60\n").is_ok());
    let message = with(&text, "POSITION lever 80\n").map(|_| ()).unwrap_err();
    assert!(message.contains("overlap"), "{message}");
    let m = with(&text, "POSITION lever 60\nVELOCITY lever -5\n").unwrap_or_else(|e| panic!("{e}"));
    assert!((m.parts[0].position - 60f64.to_radians()).abs() < 1e-12);
    assert!((m.parts[0].velocity + 5f64.to_radians()).abs() < 1e-12);
}

#[test]
fn overlaps_of_tilted_parts_are_found_in_space() {
    let ball = |x: f64| {
        machine(
            &format!(
                "ball = sph(r=1) at (movx={x})\nframe = blo(x=2, y=2, z=2) at (movx=-2, movy=-1, movz=-1)"
            ),
            &["ball", "frame"],
        )
    };
    assert!(with(&ball(0.9), "").is_err());
    assert!(with(&ball(1.0), "").is_ok());
}

#[test]
fn density_gives_inertia_about_the_joint() {
    let defs = "wheel = cyl(d=4, h=2) dif cyl(d=1, h=2)\nframe = cyl(d=1, h=4) un (blo(x=1, y=1, z=1) at (movz=-1))\nattr wheel : density = 3";
    let m = compile(&machine(defs, &["wheel", "frame"]));
    let expected = 3.0 * std::f64::consts::PI * 2.0 * (2f64.powi(4) - 0.5f64.powi(4)) / 2.0;
    let inertia = m.parts[0].inertia.unwrap_or(0.0);
    assert!((inertia / expected - 1.0).abs() < 1e-9, "{inertia} {expected}");
    assert!(m.parts[0].inertia_from_density && m.coordinates().is_ok());
    let given = with(&machine(defs, &["wheel", "frame"]), "< WHEEL : FRAME > 7 1\n")
        .unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(given.parts[0].inertia, Some(7.0));
    let sliding = "rider = blo(x=2, y=1, z=1) at (movx=4)\nframe = (blo(x=9, y=3, z=3) at (movy=-1, movz=-1)) dif blo(x=9)\nattr rider : density = 3";
    let m = compile(&machine(sliding, &["rider", "frame"]));
    assert!((m.parts[0].inertia.unwrap_or(0.0) - 6.0).abs() < 1e-9);
}

#[test]
fn loose_parts_are_refused_by_simulation_only() {
    let text = machine("lever = blo(x=1) at (movz=9)\nframe = blo(x=3)", &["lever", "frame"]);
    let m = with(&text, "< LEVER : FRAME > 1 1\n").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(m.pairs.len(), 0);
    let message = refusal(&m);
    assert!(
        message.contains("lever has no pair with the frame") && message.starts_with("test.sup:1:"),
        "{message}"
    );
}

#[test]
fn missing_inertia_is_refused_by_simulation_only() {
    let m = compile(&machine(LEVER, &["lever", "frame"]));
    assert!(refusal(&m).contains("inertia of lever"));
}

#[test]
fn crossed_axes_are_inspected_but_not_simulated() {
    let defs = "a = cyl(d=2, h=1) dif cyl(d=1, h=1)\nb = (cyl(d=2, h=1) dif cyl(d=1, h=1)) at (degx=37, movx=9)
frame = (cyl(d=1, h=3) at (movz=-1)) un (cyl(d=1, h=3) at (movz=-1, degx=37, movx=9)) un (blo(x=9, y=0.5, z=0.5) at (movz=-1))
attr a : density = 1\nattr b : density = 1";
    let m = compile(&machine(defs, &["a", "b", "frame"]));
    assert!(!m.plane.planar && m.pairs.len() == 2);
    let message = refusal(&m);
    assert!(message.contains("planar") || message.contains("two freedoms"), "{message}");
}

/// A round plunger in the plane of a wheel loses its idle turning; one alone would turn.
#[test]
fn round_plunger_slides_in_the_plane() {
    let defs = "wheel = cyl(d=4, h=2) dif cyl(d=1, h=2)
plunger = cyl(d=1, h=4) at (degy=90, movx=4, movz=1)
frame = (cyl(d=1, h=4) at (movz=-1)) un ((blo(x=3, y=3, z=3) at (movx=5, movy=-1.5, movz=-0.5)) dif (cyl(d=1, h=3) at (degy=90, movx=5, movz=1)))
attr wheel : density = 1\nattr plunger : density = 1";
    let m = compile(&machine(defs, &["wheel", "plunger", "frame"]));
    assert_eq!(kinds(&m), ["revolute/cylindrical wheel-frame", "prismatic/cylindrical plunger-frame"]);
    assert!(m.pairs[1].dropped[0].reason.contains("planar"));
    // Its contact with the wheel needs a planar section, which a cylinder lying in the plane has not.
    let message = refusal(&m);
    assert!(
        message.contains("(cyl)") && message.contains("plunger") && message.contains("wheel"),
        "{message}"
    );
}

/// What no part can reach does not matter: a ball as an ornament far away, and a drilled foot.
#[test]
fn tilted_shapes_out_of_reach_are_left_out() {
    let defs = |ball: &str| {
        format!(
        "lever = (blo(x=4, y=1, z=1) at (movx=-0.5, movy=-0.5)) dif (cyl(d=0.5, h=1))
frame = (cyl(d=0.5, h=2)) un (blo(x=1, y=6, z=1) at (movx=-0.5, movy=-0.5, movz=-1)) un (sph(r=0.5) at ({ball}))
attr lever : density = 1"
    )
    };
    let m = compile(&machine(&defs("movy=5, movz=-2"), &["lever", "frame"]));
    assert!(m.system().is_ok() && m.warnings.iter().any(|w| w.message.contains("sph")), "{:?}", m.warnings);
    let m = compile(&machine(&defs("movy=3.5, movz=0.5"), &["lever", "frame"]));
    assert!(refusal_or_two(&m), "{:?}", kinds(&m));
}

/// Within reach, the ball may push along the axis: the pair keeps its sliding, and simulation refuses it by name.
fn refusal_or_two(m: &Mechanism) -> bool {
    single(m).kind == PairKind::Cylindrical
        && refusal(m).contains("frame (sph) is no prism")
        && m.warnings[0].message.contains("sph")
}

#[test]
fn compile_is_repeatable() {
    let text = machine(LEVER, &["lever", "frame"]);
    let show = |m: &Mechanism| format!("{:?} {:?} {:?} {:?}", m.pairs, m.near_misses, m.subsystems, m.plane);
    let options = CompileOptions::default();
    assert_eq!(show(&compile_with(&text, &options)), show(&compile_with(&text, &options)));
}

#[test]
fn closed_chains_take_no_initial_state() {
    let text = support::example_text("slider-crank");
    assert!(with(&text, "POSITION piston 0\n").is_ok());
    let message = with(&text, "POSITION crankshaft 10\n").map(|_| ()).unwrap_err();
    assert!(message.contains("closed chain") && message.starts_with("test.sup:1:"), "{message}");
}

/// Found by fuzzing: an inertia of 2e-308 passed, and the first step of the simulation was not a number.
#[test]
fn friction_and_springs_must_not_dwarf_the_inertia() {
    let text = machine(LEVER, &["lever", "frame"]);
    let sound = |values: &str| {
        let m = with(&text, &format!("< lever : FRAME > {values}\n")).unwrap_or_else(|e| panic!("{e}"));
        m.system().map(|_| ()).map_err(|e| e.to_string())
    };
    assert_eq!(sound("1e-90 5"), Ok(()));
    let message = sound("2e-308 5").unwrap_err();
    assert!(message.starts_with("test.sup:1:"), "{message}");
    assert!(
        message.contains("the friction of lever is 5e0, its inertia 2e-308; expected a ratio below 1e100")
    );
    let message = sound("1e-99 0 SPRING 1 50").unwrap_err();
    assert!(message.contains("the spring constant of lever is 5e1"), "{message}");
}
