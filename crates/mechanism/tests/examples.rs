//! The kinematics of the shipped machines.

mod support;

use mainspring_geometry::Vec3;
use mainspring_mechanism::{CompileOptions, EvidenceKind, Freedom, PairKind, SymmetryType};
use support::{compile, compile_with, example, example_text, kinds, moved, single};

const CRANK_PARTS: [&str; 4] = ["crankshaft", "rod", "piston", "frame"];
const CRANK_PAIRS: [&str; 4] = [
    "revolute/cylindrical crankshaft-rod",
    "revolute/cylindrical crankshaft-frame",
    "revolute/cylindrical rod-piston",
    "prismatic/cylindrical piston-frame",
];
/// Motions of whole machines, the last ones askew.
const PLACES: [&str; 6] = [
    "degx=90",
    "degy=90",
    "degz=90, movx=3",
    "degx=180, movz=-7",
    "degx=31, degy=-57, degz=111, movx=2, movy=-3, movz=5",
    "degz=0.001, degx=45",
];

fn near(a: Vec3, b: Vec3) -> bool {
    (a - b).norm() < 1e-9
}

#[test]
fn escapement_has_three_revolute_pairs_with_the_frame() {
    let m = example("escapement");
    let expected = ["ewheel", "lever", "bwheel"].map(|part| format!("revolute/cylindrical {part}-frame"));
    assert_eq!(kinds(&m), expected);
    for (pair, y) in m.pairs.iter().zip([0.0, 7.5, 20.0]) {
        assert_eq!(pair.axis.direction, Vec3::new(0.0, 0.0, 1.0));
        assert!(near(pair.axis.point, Vec3::new(0.0, y, 0.0)), "{:?}", pair.axis);
        assert_eq!(pair.dropped[0].freedom, Freedom::Sliding);
        assert!(!pair.dropped[0].blocked);
    }
    assert_eq!(m.near_misses, [], "near misses");
    assert_eq!((m.mobility, m.closed_chains.len(), m.plane.planar), (3, 0, true));
    let roots: Vec<usize> = m.subsystems.iter().map(|s| s.root).collect();
    assert_eq!(roots, [0, 1, 2]);
    let inertias: Vec<Option<f64>> = m.subsystems.iter().map(|s| s.inertia).collect();
    assert_eq!(inertias, [Some(200.0), Some(10.0), Some(20.0)]);
    assert_eq!(m.state_variables().len(), 6);
    assert!(m.parts.iter().all(|p| p.outline.is_some()));
}

/// What can touch follows from the shapes: wheel and lever, balance and lever, the frame's pins and the lever, with or
/// without the supplement.
#[test]
fn escapement_touches_in_three_places() {
    let m = example("escapement");
    assert_eq!(m.interactions(), [(0, 1), (1, 2), (1, 3)]);
    let bare = compile(&example_text("escapement"));
    assert!(bare.system().is_err(), "no inertia is known");
    assert_eq!(bare.interactions(), m.interactions());
}

#[test]
fn escapement_makes_coordinates_and_bodies() {
    let m = example("escapement");
    let c = m.coordinates().unwrap_or_else(|e| panic!("{e}"));
    let names: Vec<&str> = c.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["ewheel", "lever", "bwheel"]);
    assert_eq!((c[0].inertia, c[0].damping, c[0].stiffness), (200.0, 20.0, 20.0));
    assert!((c[0].force - 20.0 * (-10000f64).to_radians()).abs() < 1e-9);
    assert!((c[2].force - 15.0 * 90f64.to_radians()).abs() < 1e-12);
    assert!((c[2].potential(90f64.to_radians())).abs() < 1e-12);
    let bodies = m.bodies().unwrap_or_else(|e| panic!("{e}"));
    let chains: Vec<usize> = bodies.iter().map(|b| b.chain.len()).collect();
    assert_eq!(chains, [1, 1, 1, 0]);
}

#[test]
fn escapement_stays_itself_in_other_places() {
    let text = example_text("escapement");
    for place in PLACES {
        let m = compile(&moved(&text, &["ewheel", "lever", "bwheel", "frame"], place));
        let all: Vec<PairKind> = m.pairs.iter().map(|p| p.kind).collect();
        assert_eq!(all, [PairKind::Revolute; 3], "{place}");
        assert!(m.plane.planar && m.parts.iter().all(|p| p.outline.is_some()), "{place}");
    }
}

#[test]
fn axial_freedoms_can_be_kept() {
    let options = CompileOptions { keep_axial: true, ..Default::default() };
    let m = compile_with(&example_text("escapement"), &options);
    assert!(m.pairs.iter().all(|p| p.kind == PairKind::Cylindrical && p.dropped.is_empty()));
    assert_eq!(m.mobility, 6);
    let error = m.coordinates().map(|_| ()).unwrap_err();
    assert!(error.message.contains("ewheel") && error.message.contains("cylindrical"), "{error}");
}

#[test]
fn slider_crank_in_several_directions() {
    let text = example_text("slider-crank");
    let here = compile(&text);
    assert_eq!(kinds(&here), CRANK_PAIRS);
    assert_eq!(here.mobility, 1);
    for place in PLACES {
        let m = compile(&moved(&text, &CRANK_PARTS, place));
        let found: Vec<String> = kinds(&m).iter().map(|k| k.replace("_moved", "")).collect();
        assert_eq!(found, CRANK_PAIRS, "{place}");
        assert_eq!((m.mobility, m.closed_chains[0].mobility), (1, 1), "{place}");
        assert!(m.plane.planar, "{place}");
    }
}

#[test]
fn crankshaft_runs_in_two_bearings() {
    let m = example("slider-crank");
    let bearings: Vec<(f64, f64)> = m.pairs[1]
        .evidence
        .iter()
        .filter_map(|e| match e.what {
            EvidenceKind::ShaftInHole { from, to, .. } => Some((from, to)),
            _ => None,
        })
        .collect();
    assert_eq!(bearings, [(-5.0, -3.0), (3.0, 5.0)]);
    let piston = &m.pairs[3].dropped;
    assert!(piston.len() == 1 && piston[0].freedom == Freedom::Turning && piston[0].blocked);
}

/// Gelsey 1995, Sec. 2.1.1: three prismatic and two rotational symmetries of the crankshaft.
#[test]
fn crankshaft_has_five_symmetries() {
    let m = example("slider-crank");
    let count = |kind| m.parts[0].symmetries.iter().filter(|s| s.kind == kind).count();
    assert_eq!((count(SymmetryType::Prismatic), count(SymmetryType::Rotational)), (3, 2));
}

/// At its dead centres the piston's speed is zero however the crank turns; it still slides.
#[test]
fn piston_slides_at_the_dead_centres() {
    for angle in ["0", "180", "90", "1"] {
        let text = example_text("slider-crank").replace("angle  = 60", &format!("angle  = {angle}"));
        let m = compile(&text);
        assert_eq!(kinds(&m), CRANK_PAIRS, "{angle} degrees");
        assert_eq!(m.mobility, 1, "{angle} degrees");
    }
}

#[test]
fn closed_chain_is_inspected_but_not_simulated() {
    let error = example("slider-crank").coordinates().map(|_| ()).unwrap_err();
    assert!(error.message.contains("closed chain") && error.message.contains("crankshaft"), "{error}");
    assert!(error.line > 0 && error.file.ends_with(".sup"), "{error}");
}

#[test]
fn slide_is_prismatic_everywhere() {
    let text = example_text("slide");
    let m = example("slide");
    assert_eq!(kinds(&m), ["prismatic/prismatic slider-frame"]);
    assert_eq!(m.pairs[0].axis.direction, Vec3::new(1.0, 0.0, 0.0));
    assert!(m.system().is_ok());
    for place in PLACES {
        let m = compile(&moved(&text, &["slider", "frame"], place));
        assert_eq!(single(&m).kind, PairKind::Prismatic, "{place}");
        assert!(m.plane.planar && m.coordinates().is_err_and(|e| e.message.contains("inertia")), "{place}");
    }
}

#[test]
fn scale_changes_nothing() {
    // Sizes and shifts are numbers after `=`; angles keep theirs.
    let text = example_text("slide");
    for k in [1e-6, 1e-3, 1e4] {
        let scaled = text
            .replace("width  = 1", &format!("k = {k}\nwidth  = k"))
            .replace("height = 1", "height = k")
            .replace("x=2", "x=2*k")
            .replace("movx=4", "movx=4*k")
            .replace("x=10, y=3, z=3", "x=10*k, y=3*k, z=3*k")
            .replace("movy=-1.5, movz=-1", "movy=-1.5*k, movz=-k")
            .replace("x=9", "x=9*k")
            .replace("movx=1,", "movx=k,");
        let m = compile(&scaled);
        assert_eq!(kinds(&m), ["prismatic/prismatic slider-frame"], "{k}");
    }
}

/// One motion, one subsystem: the piston's speed over the crank's is that of the textbook,
/// `-r (sin a + r sin a cos a / sqrt(l² − r² sin² a))`.
#[test]
fn closed_chain_of_one_motion_is_one_subsystem() {
    let m = example("slider-crank");
    assert_eq!(m.subsystems.len(), 1);
    let s = &m.subsystems[0];
    assert!(s.closed && s.root == 0 && s.parts.len() == 3);
    let (r, l) = (2.0f64, 7.0f64);
    let (sin, cos) = 60f64.to_radians().sin_cos();
    let expected = -r * (sin + r * sin * cos / (l * l - r * r * sin * sin).sqrt());
    assert!((s.parts[2].1 - expected).abs() < 1e-9, "{} {expected}", s.parts[2].1);
}

/// A skew turn and shift made from a seed, in the words of the language.
fn somewhere(seed: u64) -> String {
    let mut state = seed;
    let mut next = |scale: f64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        scale * ((state >> 33) as f64 / (1u64 << 31) as f64 - 0.5)
    };
    let turns = [next(360.0), next(360.0), next(360.0)];
    let shifts = [next(50.0), next(50.0), next(50.0)];
    format!(
        "degx={}, degy={}, degz={}, movx={}, movy={}, movz={}",
        turns[0], turns[1], turns[2], shifts[0], shifts[1], shifts[2]
    )
}

#[test]
fn machines_are_the_same_anywhere_in_space() {
    for seed in 1..=40 {
        let place = somewhere(seed);
        let m = compile(&moved(&example_text("slider-crank"), &CRANK_PARTS, &place));
        let found: Vec<String> = kinds(&m).iter().map(|k| k.replace("_moved", "")).collect();
        assert_eq!(found, CRANK_PAIRS, "{place}");
        assert!((m.subsystems[0].parts[2].1.abs() - 1.987427766796502).abs() < 1e-8, "{:?}", m.subsystems);
        let m = compile(&moved(&example_text("escapement"), &["ewheel", "lever", "bwheel", "frame"], &place));
        let revolute = m.pairs.iter().filter(|p| p.kind == PairKind::Revolute).count();
        assert_eq!((revolute, m.pairs.len(), m.near_misses.len()), (3, 3, 0), "{place}");
        assert!(m.parts.iter().all(|p| p.outline.is_some()), "{place}");
    }
}

/// A part that hangs on nothing may be anywhere near where it is drawn: that concerns it alone.
#[test]
fn a_loose_part_leaves_the_others_interactions_as_they_are() {
    let text = example_text("rotary-to-reciprocating");
    let whole = compile(&text);
    let loose = text.replace(
        "rocker = wheel asb arm asb frame",
        "block = blo() at (movx=5.2)\nrocker = wheel asb arm asb frame asb block",
    );
    assert_ne!(loose, text);
    let found = compile(&loose).interactions();
    let (with, without): (Vec<_>, Vec<_>) = found.into_iter().partition(|pair| pair.1 == 3);
    assert_eq!(without, whole.interactions());
    assert_eq!(without, [(0, 1)]);
    assert!(with.contains(&(0, 3)), "{with:?}");
}
