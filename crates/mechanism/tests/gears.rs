//! Gear pairs and subsystems.

mod support;

use mainspring_mechanism::{CompileOptions, Mechanism, PairKind};
use support::{compile, kinds, machine, try_compile};

/// Gears `g0`, `g1`, … as discs of a diameter on shafts of the frame at places along x.
fn train(gears: &[(f64, f64)], extra: &str) -> String {
    let (mut defs, mut shafts, mut names) = (String::new(), String::new(), vec![]);
    for (i, (x, d)) in gears.iter().enumerate() {
        defs += &format!(
            "e{i} = cyl(d={d}, h=1) at (movx={x})\ng{i} = e{i} dif (cyl(d=0.5, h=1) at (movx={x}))\n"
        );
        defs += &format!("attr e{i} : gear = 1\n");
        shafts += &format!(" un (cyl(d=0.5, h=3) at (movx={x}, movz=-1))");
        names.push(format!("g{i}"));
    }
    defs += &format!("frame = (blo(x=60, y=2, z=1) at (movx=-20, movy=-1, movz=-2)){shafts}\n{extra}");
    names.push("frame".into());
    machine(&defs, &names.iter().map(String::as_str).collect::<Vec<_>>())
}

fn ratios(m: &Mechanism) -> Vec<(usize, usize, f64)> {
    m.pairs.iter().filter_map(|p| Some((p.parts.0, p.parts.1, p.ratio?))).collect()
}

#[test]
fn train_of_three_is_one_subsystem() {
    let text = train(&[(0.0, 4.0), (2.9, 2.0), (6.8, 6.0)], "");
    let sup = "< G0 : FRAME > 1 0.5\n< G1 : FRAME > 2 0.25 SPRING 90 3\n< G2 : FRAME > 9 0\nPOSITION g1 20\nVELOCITY g0 10\n";
    let m = try_compile(&text, sup, &CompileOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(ratios(&m), [(0, 1, -2.0), (1, 2, -1.0 / 3.0)]);
    assert_eq!(m.subsystems.len(), 1);
    let parts = &m.subsystems[0].parts;
    assert_eq!(parts[..2], [(0, 1.0), (1, -2.0)]);
    assert!((parts[2].1 - 2.0 / 3.0).abs() < 1e-15);
    let inertia = m.subsystems[0].inertia.unwrap_or(0.0);
    assert!((inertia - (1.0 + 2.0 * 4.0 + 9.0 * 4.0 / 9.0)).abs() < 1e-12, "{inertia}");
    assert_eq!((m.mobility, m.closed_chains.len()), (1, 0));
    let c = &m.coordinates().unwrap_or_else(|e| panic!("{e}"))[0];
    assert!((c.damping - (0.5 + 0.25 * 4.0)).abs() < 1e-12);
    assert!((c.stiffness - 12.0).abs() < 1e-12);
    assert!((c.force + 3.0 * 2.0 * 90f64.to_radians()).abs() < 1e-12);
    assert!(
        (c.position + 10f64.to_radians()).abs() < 1e-12 && (c.velocity - 10f64.to_radians()).abs() < 1e-12
    );
    // The energy of the spring is ½ k (x₁ − 90°)², x₁ = −2 x₀.
    let x1 = 0.3;
    let energy = 0.5 * 3.0 * (x1 - 90f64.to_radians()).powi(2);
    assert!((c.potential(-0.5 * x1) - energy).abs() < 1e-12);
}

#[test]
fn teeth_before_diameters_and_only_on_both() {
    let gears = [(0.0, 4.0), (2.9, 2.0)];
    let both = "attr e0 : teeth = 41\nattr e1 : teeth = 20";
    assert_eq!(ratios(&compile(&train(&gears, both))), [(0, 1, -41.0 / 20.0)]);
    let one = compile(&train(&gears, "attr e0 : teeth = 41"));
    assert_eq!(ratios(&one), [(0, 1, -2.0)]);
    assert!(one.warnings[0].message.contains("diameters"), "{:?}", one.warnings);
}

#[test]
fn depth_limits_the_overlap() {
    let gears = [(0.0, 4.0), (2.9, 2.0)];
    assert_eq!(ratios(&compile(&train(&gears, "attr e0 : depth = 0.1001"))).len(), 1);
    let error = try_compile(&train(&gears, "attr e0 : depth = 0.0999"), "", &CompileOptions::default());
    // Too deep to mesh, they overlap as solids.
    let message = error.map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("g0 and g1 overlap") && message.contains("tooth depth"), "{message}");
}

#[test]
fn gears_apart_are_a_near_miss() {
    let m = compile(&train(&[(0.0, 4.0), (3.05, 2.0)], ""));
    assert_eq!(ratios(&m), []);
    assert!(m.near_misses.iter().any(|n| n.reason.contains("0.05 apart")), "{:?}", m.near_misses);
    assert_eq!(m.subsystems.len(), 2);
}

#[test]
fn internal_mesh_turns_the_same_way() {
    let text = machine(
        "envelope = cyl(d=2, h=1) at (movx=3.1)
pinion = envelope dif (cyl(d=0.5, h=1) at (movx=3.1))
inner = cyl(d=8, h=1)
ring = ((cyl(d=10, h=1) dif inner) un (cyl(d=10, h=0.5) at (movz=1.2)) un ((cyl(d=10, h=0.2) dif cyl(d=9, h=0.2)) at (movz=1))) dif (cyl(d=1, h=2))
attr envelope : gear = 1
attr inner : gear = 1
frame = (cyl(d=1, h=6) at (movz=-2)) un (cyl(d=0.5, h=3.1) at (movx=3.1, movz=-2)) un (blo(x=6, y=1, z=1) at (movx=-1, movy=-0.5, movz=-2.5))",
        &["pinion", "ring", "frame"],
    );
    let m = compile(&text);
    assert_eq!(ratios(&m), [(0, 1, 0.25)], "{:?} {:?}", kinds(&m), m.near_misses);
}

/// Three gears in mesh with each other cannot turn; that is told, not crashed upon.
#[test]
fn loops_of_gears_lock_or_agree() {
    let at = |x: f64, y: f64, i: usize| {
        format!(
            "e{i} = cyl(d=2.1, h=1) at (movx={x}, movy={y})\ng{i} = e{i} dif (cyl(d=0.5, h=1) at (movx={x}, movy={y}))\nattr e{i} : gear = 1\n"
        )
    };
    let shaft = |x: f64, y: f64| format!(" un (cyl(d=0.5, h=3) at (movx={x}, movy={y}, movz=-1))");
    let places = [(0.0, 0.0), (2.0, 0.0), (1.0, 1.75)];
    let text = |n: &[(f64, f64)]| {
        let mut defs: String = n.iter().enumerate().map(|(i, p)| at(p.0, p.1, i)).collect();
        let shafts: String = n.iter().map(|p| shaft(p.0, p.1)).collect();
        defs += &format!("frame = (blo(x=9, y=9, z=1) at (movx=-3, movy=-3, movz=-2)){shafts}");
        let names: Vec<String> = (0..n.len()).map(|i| format!("g{i}")).chain(["frame".into()]).collect();
        machine(&defs, &names.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let m = compile(&text(&places));
    assert_eq!(m.pairs.iter().filter(|p| p.kind == PairKind::Gear).count(), 3);
    assert_eq!(m.mobility, 0);
    assert!(m.subsystems[0].locked && m.closed_chains[0].gears_only);
    assert!(m.pairs[..3].iter().all(|p| p.shape_kind == PairKind::Cylindrical));
    let error = m.coordinates().map(|_| ()).unwrap_err();
    assert!(error.message.contains("lock"), "{error}");
    // A ring of four agrees.
    let m = compile(&text(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]));
    assert_eq!((m.mobility, m.subsystems.len(), m.closed_chains.len()), (1, 1, 0));
}

#[test]
fn contradicting_positions_of_gears_are_refused() {
    let text = train(&[(0.0, 4.0), (2.9, 2.0)], "");
    let error = try_compile(&text, "POSITION g0 10\nPOSITION g1 10\n", &CompileOptions::default());
    let error = error.map(|_| ()).unwrap_err();
    // Found by fuzzing: it did not say what was expected.
    let message = "contradicts that of a gear in mesh with it; expected values that agree";
    assert!(error.message.contains(message) && error.line == 2, "{error}");
    assert!(try_compile(&text, "POSITION g0 10\nPOSITION g1 -20\n", &CompileOptions::default()).is_ok());
    let m = try_compile(&text, "", &CompileOptions::default()).unwrap();
    let error = m.starting_at(&[(0, 0.1), (1, 0.1)], &[]).map(|_| ()).unwrap_err().to_string();
    assert!(error.starts_with("--position:1:1: error: ") && error.contains("contradicts"), "{error}");
    assert!(m.starting_at(&[(0, 0.1), (1, -0.2)], &[(1, 3.0)]).is_ok());
}
