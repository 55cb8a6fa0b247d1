//! Parts carried by moving parts, and what acts on joints: from text to coordinates, chains and forces.

mod support;

use mainspring_geometry::Vec2;
use mainspring_mechanism::{CompileOptions, Drive, Mechanism, Motion, System};
use std::f64::consts::PI;
use support::{compile, kinds, machine, try_compile};

fn with(text: &str, supplement: &str) -> Result<Mechanism, String> {
    try_compile(text, supplement, &CompileOptions::default()).map_err(|e| e.to_string())
}

fn system(text: &str, supplement: &str) -> System {
    with(text, supplement)
        .and_then(|m| m.system().map_err(|e| e.to_string()))
        .unwrap_or_else(|e| panic!("{e}"))
}

/// The message that compiling or simulating ends with, without the file's name.
fn refusal(text: &str, supplement: &str) -> String {
    let system = with(text, supplement).and_then(|m| m.system().map(|_| ()).map_err(|e| e.to_string()));
    system.expect_err(supplement).replacen("test.sup:", "", 1)
}

fn near(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-9 * (1.0 + b.abs()), "{a} {b}");
}

/// A cam on the frame's shaft with a pin at x = 3, a pawl on that pin.
fn pawl(attributes: &str) -> String {
    let defs = format!(
        "cam = ((cyl(d=8, h=1)) un (cyl(d=1, h=2) at (movx=3))) dif cyl(d=1, h=1)
pawl = ((cyl(d=2, h=0.8) un blo(x=3, y=0.5, z=0.8)) at (movx=3, movz=1.1)) dif (cyl(d=1, h=0.8) at (movx=3, movz=1.1))
frame = (cyl(d=1, h=3) at (movz=-1)) un (blo(x=1, y=1, z=1) at (movz=-2))
{attributes}"
    );
    machine(&defs, &["cam", "pawl", "frame"])
}

const DENSE: &str = "attr cam : density = 1\nattr pawl : density = 2";

#[test]
fn a_pawl_on_a_cam_is_a_chain_of_two_joints() {
    let m = compile(&pawl(DENSE));
    assert_eq!(kinds(&m), ["revolute/cylindrical cam-pawl", "revolute/cylindrical cam-frame"]);
    assert_eq!((m.parts[1].carrier, m.mobility), (Some(0), 2));
    let s = m.system().unwrap_or_else(|e| panic!("{e}"));
    let chain = &s.bodies[1].chain;
    let centers: Vec<Motion> = chain.iter().map(|j| j.motion).collect();
    let turn = |x: f64| Motion::Turn { center: Vec2::new(x, 0.0) };
    assert_eq!(centers, [turn(0.0), turn(3.0)]);
    assert_eq!(s.coupled.iter().map(|g| g.coordinates.to_vec()).collect::<Vec<_>>(), [[0, 1]]);
    // The cam's own inertia is constant, the pawl's is in the masses.
    assert!(s.coordinates[0].inertia > 0.0 && s.coordinates[1].inertia == 0.0);
    let [mass] = s.forces.masses[..] else { panic!("{:?}", s.forces.masses) };
    assert!((mass.body, mass.chained) == (1, true) && mass.center.x > 3.0);
    // About its pin it has what the density gives for the joint.
    let about_pin = mass.inertia + mass.mass * (mass.center - Vec2::new(3.0, 0.0)).norm().powi(2);
    near(about_pin, m.parts[1].inertia.unwrap_or(0.0));
}

/// All data of a pair act between the pawl and the cam: they stay with the pawl's coordinate.
#[test]
fn springs_and_friction_act_between_part_and_carrier() {
    let sup = "< PAWL : CAM > 0.5 SPRING 90 3\nTORQUE pawl 2\nCOULOMB pawl 0.25\nPOSITION pawl 30\nVELOCITY pawl -10\n";
    let s = system(&pawl(DENSE), sup);
    let c = &s.coordinates[1];
    assert_eq!((c.name.as_str(), c.damping, c.stiffness), ("pawl", 0.5, 3.0));
    near(c.force, 3.0 * PI / 2.0 + 2.0);
    near(c.position, PI / 6.0);
    near(c.velocity, -PI / 18.0);
    assert_eq!(
        (s.forces.applied.as_slice(), s.forces.coulomb.as_slice()),
        (&[0.0, 2.0][..], &[0.0, 0.25][..])
    );
    // The spring has no energy where it is relaxed; the constant torque counts as work.
    near(s.potential_energy(&[0.7, PI / 2.0]), 0.0);
}

#[test]
fn the_pose_of_a_carried_part_is_the_product_of_its_joints() {
    let m = with(&pawl(DENSE), "POSITION cam 90\nPOSITION pawl 90\n").unwrap_or_else(|e| panic!("{e}"));
    let s = m.system().unwrap_or_else(|e| panic!("{e}"));
    let pose = s.bodies[1].pose(&[PI / 2.0, PI / 2.0]);
    let tip = pose.apply(Vec2::new(6.0, 0.0));
    near(tip.x, -3.0);
    near(tip.y, 3.0);
    let p = m.start_poses()[1].apply(mainspring_geometry::Vec3::new(6.0, 0.0, 1.1));
    near(p.x, -3.0);
    near(p.y, 3.0);
}

#[test]
fn masses_are_given_or_follow() {
    let (given, thin) = ("MASS pawl 2 4 0 1.5\n", "attr cam : density = 1");
    let mass = |sup: &str| system(&pawl(thin), sup).forces.masses[0];
    // J = I + m d²: of the three, two are enough; the centre is one from the pin.
    let m = mass(&format!("< PAWL : CAM > 7 1\n{given}"));
    assert_eq!((m.mass, m.center, m.inertia), (2.0, Vec2::new(4.0, 0.0), 5.0));
    let m = mass("< PAWL : CAM > 1\nMASS pawl 2 4 0 1.5 5\n");
    assert_eq!((m.mass, m.inertia), (2.0, 5.0));
    let m = mass("< PAWL : CAM > 7 1\nMASS pawl 2 4 0 1.5 5\n");
    assert_eq!((m.mass, m.inertia), (2.0, 5.0));
    assert_eq!(
        refusal(&pawl(thin), "< PAWL : CAM > 7 1\nMASS pawl 2 4 0 1.5 6\n"),
        "2:1: error: the moment of inertia about its joint of pawl is 8 by MASS and 7 by the line of its pair; expected values that agree"
    );
    assert_eq!(
        refusal(&pawl(thin), "< PAWL : CAM > 1.5 1\nMASS pawl 2 4 0 1.5\n"),
        "2:1: error: the moment of inertia of pawl about its joint is 1.5, less than its mass at the distance of its centre alone has, 2; expected at least that"
    );
    assert_eq!(
        refusal(&pawl(thin), "< PAWL : CAM > 7 1\n"),
        "1:1: error: pawl moves on a moving part, and its mass and centre of mass are not known; expected a density or `MASS pawl mass x y z`"
    );
    assert_eq!(
        refusal(&pawl(thin), "< PAWL : CAM > 1\nMASS pawl 2 4 0 1.5\n"),
        "1:1: error: the inertia of pawl is not known; expected a line of the supplement or a density"
    );
}

#[test]
fn lines_of_pairs_that_are_none() {
    let text = pawl(DENSE);
    assert_eq!(
        refusal(&text, "< PAWL : FRAME > 1 1\n"),
        "1:1: error: pawl and frame form no pair; expected `< pawl : cam >`, which do"
    );
    assert_eq!(
        refusal(&text, "< CAM : PAWL > 1 1\n"),
        "1:1: error: cam carries pawl and not the other way round; expected `< pawl : cam >`"
    );
    let crank = support::example_text("slider-crank");
    let m = with(&crank, "< ROD : PISTON > 1 1\n").unwrap_or_else(|e| panic!("{e}"));
    assert!(
        m.warnings.iter().any(|w| w.message.contains("rod and piston close a chain of pairs")),
        "{:?}",
        m.warnings
    );
}

/// A block on a rail that turns about the frame's shaft.
fn slide_on_arm(attributes: &str) -> String {
    let defs = format!(
        "arm = ((blo(x=12, y=3, z=3) at (movx=-2, movy=-1.5)) dif (blo(x=9, y=1, z=1) at (movx=1, movy=-0.5, movz=1))) dif (cyl(d=1, h=3) at (movx=-1))
block = blo(x=1, y=1, z=1) at (movx=4, movy=-0.5, movz=1)
frame = (cyl(d=1, h=5) at (movx=-1, movz=-1)) un (blo(x=1, y=1, z=1) at (movx=-1.5, movy=-0.5, movz=-2))
{attributes}"
    );
    machine(&defs, &["arm", "block", "frame"])
}

#[test]
fn a_block_slides_on_a_turning_arm() {
    let both = "attr arm : density = 1\nattr block : density = 3";
    let s = system(&slide_on_arm(both), "");
    let [mass] = s.forces.masses[..] else { panic!("{:?}", s.forces.masses) };
    near(mass.mass, 3.0);
    near((mass.center - Vec2::new(4.5, 0.0)).norm(), 0.0);
    near(mass.inertia, 0.5);
    // A given mass in place of the density's keeps the shape: the moment scales with it.
    let s = system(&slide_on_arm(both), "< BLOCK : ARM > 6 0\n");
    near(s.forces.masses[0].inertia, 1.0);
    let one = slide_on_arm("attr arm : density = 1");
    assert_eq!(
        refusal(&one, "< BLOCK : ARM > 6 0\nMASS block 6 4.5 0 1.5\n"),
        "1:1: error: block turns with its carrier, and its moment of inertia about its centre of mass is not known; expected a density or `MASS block mass x y z inertia`"
    );
    let s = system(&one, "< BLOCK : ARM > 0\nMASS block 6 4.5 0 1.5 1\n");
    assert_eq!((s.forces.masses[0].mass, s.forces.masses[0].inertia), (6.0, 1.0));
    assert_eq!(
        refusal(&one, "< BLOCK : ARM > 5 0\nMASS block 6 4.5 0 1.5 1\n"),
        "2:1: error: the mass of block is 6 by MASS and 5 by the line of its pair; expected values that agree"
    );
}

/// A stud clamped into a wheel turns with it: its inertia is the wheel's.
#[test]
fn parts_fixed_to_moving_parts_move_with_them() {
    let square = "blo(x=1, y=1, z=3) at (movx=2.5, movy=-0.5, movz=-1)";
    let head = |z: i32| format!("(blo(x=2, y=2, z=1) at (movx=2, movy=-1, movz={z}))");
    let defs = format!(
        "stud = ({square}) un {} un {}\nwheel = ((cyl(d=10, h=1)) dif ({square})) dif cyl(d=1, h=1)
frame = (cyl(d=1, h=3) at (movz=-1)) un (blo(x=1, y=1, z=1) at (movx=-0.5, movy=-0.5, movz=-2))",
        head(-1),
        head(1)
    );
    let text = machine(&defs, &["stud", "wheel", "frame"]);
    assert_eq!(kinds(&compile(&text))[0], "fixed/fixed stud-wheel");
    let s = system(&text, "< WHEEL : FRAME > 10 1\nMASS stud 2 3 0 0.5 0.25\n");
    assert_eq!(s.coordinates.len(), 1);
    near(s.coordinates[0].inertia, 10.0 + 0.25 + 2.0 * 9.0);
    let dense = format!("{text}attr stud : density = 2\n");
    near(system(&dense, "< WHEEL : FRAME > 10 1\n").coordinates[0].inertia, 10.0 + stud_inertia());
    assert!(refusal(&text, "< WHEEL : FRAME > 10 1\n").contains("stud moves on a moving part"));
}

/// Of density 2 about the wheel's axis, three away: the shank of one cube, the heads of 2 × 2 × 1 each.
fn stud_inertia() -> f64 {
    let block = |mass: f64, side: f64| mass * (side * side / 6.0 + 9.0);
    block(2.0, 1.0) + 2.0 * block(8.0, 2.0)
}

const WHEEL: &str =
    "wheel = ((cyl(d=8, h=1)) un (blo(x=2, y=1, z=1) at (movx=3.5, movy=-0.5))) dif cyl(d=1, h=1)
frame = (cyl(d=1, h=3) at (movz=-1)) un (blo(x=1, y=1, z=1) at (movz=-2))";
const RIDER: &str = "rider = blo(x=2, y=1, z=1) at (movx=4)
frame = (blo(x=9, y=3, z=3) at (movy=-1, movz=-1)) dif blo(x=9)";

fn wheel() -> String {
    machine(WHEEL, &["wheel", "frame"])
}

fn rider() -> String {
    machine(RIDER, &["rider", "frame"])
}

#[test]
fn gravity_turns_what_hangs_off_its_axis() {
    let sup = "< WHEEL : FRAME > 9 0\nMASS wheel 2 1 -0.5 0\nGRAVITY 0 -10 0\n";
    let s = system(&wheel(), sup);
    assert_eq!((s.coordinates[0].inertia, s.coordinates[0].force), (9.0, 0.0));
    let [mass] = s.forces.masses[..] else { panic!("{:?}", s.forces.masses) };
    assert!(!mass.chained && s.coupled.len() == 1);
    let mut e = mainspring_mechanism::Equations::default();
    s.equations(&s.coupled[0], &[0.0], &[0.0], &mut e);
    near(e.force[0], -2.0 * 10.0);
    // Balanced, it flies in closed form; so does what slides: there gravity is a constant force.
    let s = system(&wheel(), &sup.replace("1 -0.5 0", "0 0 0"));
    assert!(s.coupled.is_empty() && s.forces.masses.is_empty());
    let s = system(&rider(), "< RIDER : FRAME > 2 0\nGRAVITY -3 -10 0\n");
    assert!(s.coupled.is_empty());
    near(s.coordinates[0].force, -6.0);
    near(s.potential_energy(&[0.5]), 3.0);
    assert_eq!(
        refusal(&wheel(), "< WHEEL : FRAME > 9 0\nGRAVITY 0 -10 0\n"),
        "1:1: error: wheel turns under gravity, and its mass and centre of mass are not known; expected a density or `MASS wheel mass x y z`"
    );
    let m = with(&wheel(), "< WHEEL : FRAME > 9 0\nGRAVITY 0 0 -9.81\n").unwrap_or_else(|e| panic!("{e}"));
    assert!(m.system().is_ok_and(|s| s.coupled.is_empty()));
    assert_eq!(
        m.warnings[0].message,
        "9.81 of gravity is along the normal of the working plane and moves nothing"
    );
}

#[test]
fn drives_prescribe_the_start() {
    let s = system(&wheel(), "< WHEEL : FRAME > 1 1\nPOSITION wheel 90\nSPEED wheel 180\n");
    assert_eq!(s.forces.drives[0], Some(Drive::Speed { start: PI / 2.0, speed: PI }));
    assert_eq!((s.coordinates[0].position, s.coordinates[0].velocity), (PI / 2.0, PI));
    let s = system(&rider(), "< RIDER : FRAME > 1 1\nTABLE rider -1 0  1 2\n");
    let Some(drive) = &s.forces.drives[0] else { panic!() };
    assert_eq!((drive.at(0.0).q, drive.at(0.0).v), (1.0, 1.5));
    assert_eq!((s.coordinates[0].position, s.coordinates[0].velocity), (1.0, 1.5));
}

/// Gears: what acts on one is seen at the root through the ratio.
#[test]
fn gears_reflect_what_acts() {
    let gear = |i: usize, x: f64, d: f64| {
        format!(
            "e{i} = cyl(d={d}, h=1) at (movx={x})\ng{i} = e{i} dif (cyl(d=0.5, h=1) at (movx={x}))\nattr e{i} : gear = 1\n"
        )
    };
    let defs = gear(0, 0.0, 4.0)
        + &gear(1, 2.9, 2.0)
        + "frame = (blo(x=9, y=2, z=1) at (movx=-4, movy=-1, movz=-2)) un (cyl(d=0.5, h=3) at (movz=-1)) un (cyl(d=0.5, h=3) at (movx=2.9, movz=-1))";
    let text = machine(&defs, &["g0", "g1", "frame"]);
    let inert = "< G0 : FRAME > 1 0\n< G1 : FRAME > 1 0\n";
    let s = system(&text, &format!("{inert}TORQUE g1 3\nCOULOMB g0 1\nCOULOMB g1 0.5\nSTOP g1 -20 60\n"));
    assert_eq!((s.forces.applied[0], s.coordinates[0].force, s.forces.coulomb[0]), (-6.0, -6.0, 2.0));
    let [low, high] = s.forces.stops[..] else { panic!("{:?}", s.forces.stops) };
    // The gear's upper limit is the root's lower one; the lever is the gear's radius, seen at the root.
    assert!(low.upper && !high.upper && (low.side, high.side) == (1.0, -1.0));
    near(low.limit, -PI / 6.0);
    near(high.limit, PI / 18.0);
    near(low.lever, 2.0);
    near(low.gap(0.0), PI / 3.0);
    near(high.gap(0.0), PI / 9.0);
    assert_eq!((low.bodies, high.slope()), ((1, 2), -high.lever));
    let s = system(&text, &format!("{inert}POSITION g1 20\nSPEED g1 -30\n"));
    assert_eq!(s.forces.drives[0], Some(Drive::Speed { start: -PI / 18.0, speed: PI / 12.0 }));
    near(s.coordinates[0].velocity, PI / 12.0);
    assert_eq!(
        refusal(&text, &format!("{inert}SPEED g0 1\nTABLE g1 0 0 1 1\n")),
        "4:1: error: g1 moves with g0, which is driven already (at 3:1); expected one drive for both"
    );
    assert_eq!(
        refusal(&text, &format!("{inert}SPEED g0 1\nVELOCITY g1 2\n")),
        "4:1: error: the velocity of g1 is prescribed by SPEED (at 3:1); expected no VELOCITY line for it"
    );
}

#[test]
fn contradictions_say_what_they_are() {
    let cases = [
        (
            wheel(),
            "SPEED wheel 1\nVELOCITY wheel 1",
            "2:1: error: the velocity of wheel is prescribed by SPEED (at 1:1); expected no VELOCITY line for it",
        ),
        (
            wheel(),
            "TABLE wheel 0 0 1 1\nPOSITION wheel 1",
            "2:1: error: the position of wheel is prescribed by TABLE (at 1:1); expected no POSITION line for it",
        ),
        (
            wheel(),
            "FORCE wheel 1",
            "1:1: error: wheel turns and takes no force; expected TORQUE in place of FORCE",
        ),
        (
            rider(),
            "TORQUE rider 1",
            "1:1: error: rider slides and takes no torque; expected FORCE in place of TORQUE",
        ),
        (
            wheel(),
            "STOP wheel -30 30\nPOSITION wheel 31",
            "1:1: error: wheel starts at 31, beyond its stop; expected a position within",
        ),
        (
            rider(),
            "STOP rider 0.5 NONE",
            "1:1: error: rider starts at 0, beyond its stop; expected a position within",
        ),
        (
            wheel(),
            "STOP wheel NONE 30\nSPEED wheel 1",
            "1:1: error: wheel would run into its stop at the constant speed prescribed; expected no STOP, or a TABLE",
        ),
        (
            wheel(),
            "STOP wheel NONE 30\nTABLE wheel 0 0 2 31",
            "1:1: error: wheel is at 31 at time 2 of its table, beyond its stop; expected positions within",
        ),
    ];
    for (text, supplement, expected) in cases {
        assert_eq!(refusal(&text, supplement), expected, "{supplement}");
    }
    assert!(with(&wheel(), "STOP wheel -30 30\nPOSITION wheel 30").is_ok());
    let loose = machine("lever = blo(x=1) at (movz=9)\nframe = blo(x=3)", &["lever", "frame"]);
    for (line, what) in [
        ("TORQUE lever 1", "torque"),
        ("COULOMB lever 1", "Coulomb friction"),
        ("STOP lever 0 1", "stop"),
        ("SPEED lever 1", "speed"),
        ("TABLE lever 0 0 1 1", "table"),
    ] {
        let expected =
            format!("1:1: error: lever has no joint to take a {what}; expected a part that turns or slides");
        assert_eq!(refusal(&loose, line), expected);
    }
    let crank = support::example_text("slider-crank");
    assert_eq!(
        refusal(&crank, "SPEED crankshaft 30"),
        "1:1: error: crankshaft is in a closed chain of pairs; expected no SPEED for its parts"
    );
}

#[test]
fn another_start_must_fit_drives_and_stops() {
    let m = with(&wheel(), "< WHEEL : FRAME > 1 1\nSTOP wheel -30 30\n").unwrap_or_else(|e| panic!("{e}"));
    assert!(m.starting_at(&[(0, 0.5)], &[]).is_ok());
    assert!(m.starting_at(&[(0, 0.6)], &[]).is_err_and(|e| e.message.contains("beyond its stop")));
    let m = with(&wheel(), "< WHEEL : FRAME > 1 1\nSPEED wheel 30\n").unwrap_or_else(|e| panic!("{e}"));
    let refused = m.starting_at(&[], &[(0, 0.6)]);
    assert!(refused.is_err_and(|e| e.message == "the velocity of wheel is prescribed by SPEED; expected none for it"));
    let s = m.starting_at(&[(0, 0.5)], &[]).and_then(|m| m.system()).unwrap_or_else(|e| panic!("{e}"));
    assert!(matches!(s.forces.drives[0], Some(Drive::Speed { start: 0.5, .. })));
    let kept = |m: &Mechanism| m.kept_system().unwrap_or_else(|e| panic!("{e}"));
    assert!(std::sync::Arc::ptr_eq(&kept(&m), &kept(&m)), "made once");
    let moved = m.starting_at(&[(0, 0.5)], &[]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(kept(&moved).coordinates, s.coordinates, "another start is another system");
}

/// A chain of arms, each pinned to the end of the one before.
fn arms(n: usize) -> String {
    let mut defs = String::new();
    for i in 0..n {
        let (x, z) = (3 * i, 2 * i);
        defs += &format!(
            "a{i} = (((blo(x=4, y=1, z=1) at (movx=-0.5, movy=-0.5)) dif cyl(d=0.5, h=1)) un (cyl(d=0.5, h=3) at (movx=3))) at (movx={x}, movz={z})\nattr a{i} : density = 1\n"
        );
    }
    defs +=
        "frame = (cyl(d=0.5, h=2) at (movz=-1)) un (blo(x=1, y=1, z=1) at (movx=-0.5, movy=-0.5, movz=-2))";
    let names: Vec<String> = (0..n).map(|i| format!("a{i}")).chain(["frame".into()]).collect();
    machine(&defs, &names.iter().map(String::as_str).collect::<Vec<_>>())
}

#[test]
fn chains_have_a_bounded_length() {
    let s = system(&arms(4), "");
    assert_eq!((s.bodies[3].chain.len(), s.coupled.len(), s.coupled[0].coordinates.len()), (4, 1, 4));
    assert!(
        refusal(&arms(5), "").contains("a4 hangs on the frame by a chain of 5 joints; expected at most 4")
    );
}

/// A planet on an arm that turns on the sun's hub: both gears turn against the arm, but the sun hangs on the frame.
#[test]
fn gears_with_axes_on_different_parts_are_refused() {
    let defs = "envelope = cyl(d=4.2, h=1)
sun = (envelope un (cyl(d=2, h=1) at (movz=1))) dif cyl(d=1, h=2)
round = cyl(d=2, h=1) at (movx=3)
planet = round dif (cyl(d=0.5, h=1) at (movx=3))
arm = ((blo(x=5.5, y=3, z=1) at (movx=-1.5, movy=-1.5, movz=1)) un (cyl(d=0.5, h=1) at (movx=3))) dif (cyl(d=2, h=1) at (movz=1))
frame = (cyl(d=1, h=4) at (movz=-1)) un (blo(x=1, y=1, z=1) at (movz=-2))
attr envelope : gear = 1\nattr round : gear = 1";
    let text = machine(defs, &["sun", "planet", "arm", "frame"]);
    let m = compile(&text);
    let expected = [
        "revolute/cylindrical sun-arm",
        "revolute/cylindrical sun-frame",
        "revolute/cylindrical planet-arm",
        "gear/gear sun-planet",
    ];
    assert_eq!(kinds(&m), expected, "{:?}", m.near_misses);
    // Each is a subsystem of its own: the ratio holds against the arm, not against the frame.
    assert_eq!(m.subsystems.len(), 3);
    let refused = m.system().map(|_| ()).map_err(|e| e.message);
    let message =
        "sun and planet mesh, but frame carries the one and arm the other; expected both axes on one part";
    assert_eq!(refused, Err(message.to_string()));
}

/// Two gears on one turning arm: their ratio holds against the arm, which carries both.
#[test]
fn gears_on_a_common_moving_carrier_are_accepted() {
    let gear = |i: usize, x: f64| {
        format!(
            "e{i} = cyl(d=2.1, h=1) at (movx={x})\ng{i} = e{i} dif (cyl(d=0.5, h=1) at (movx={x}))\nattr e{i} : gear = 1\nattr g{i} : density = 1\n"
        )
    };
    let defs = gear(0, 2.0) + &gear(1, 4.0)
        + "arm = ((blo(x=7, y=2, z=1) at (movx=-1, movy=-1, movz=1)) un (cyl(d=0.5, h=1) at (movx=2)) un (cyl(d=0.5, h=1) at (movx=4))) dif (cyl(d=1, h=1) at (movz=1))
frame = (cyl(d=1, h=4) at (movz=-1)) un (blo(x=1, y=1, z=1) at (movx=-0.5, movy=-0.5, movz=-2))
attr arm : density = 1";
    let text = machine(&defs, &["g0", "g1", "arm", "frame"]);
    let s = system(&text, "");
    assert_eq!((s.coordinates.len(), s.forces.masses.len()), (2, 2));
    let m = s.forces.masses[0].mass;
    near(m, PI * (1.05f64.powi(2) - 0.25f64.powi(2)));
    let (mut e, own) = (mainspring_mechanism::Equations::default(), s.forces.masses[0].inertia);
    s.equations(&s.coupled[0], &[0.3, -0.7], &[0.0, 0.0], &mut e);
    // Against the arm they turn by +1 and −1: the arm feels no reaction, and carries both masses.
    near(e.mass[0], 2.0 * own);
    near(e.mass[1], 0.0);
    near(e.mass[3], s.coordinates[1].inertia + 2.0 * own + m * (4.0 + 16.0));
}
