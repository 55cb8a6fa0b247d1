//! The search for candidates against trying every pair of features, on all shipped machines at random positions: the same
//! contacts in the same order with the same distances, to the last bit.

use mainspring_geometry::Vec2;
use mainspring_mechanism::{
    Candidate, CompileOptions, ContactId, ContactSource, Feature, FeatureShape, FeatureTree, GapKind,
    Mechanism, Motion, Pose, Relative, System,
};
use mainspring_model::Machine;
use std::path::PathBuf;

/// Numbers spread evenly, always the same.
struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        low + (high - low) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Shipped machines whose motion is that of free coordinates.
fn machines() -> Vec<(PathBuf, System)> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let folders = std::fs::read_dir(root).unwrap().map(|folder| folder.unwrap().path());
    let model = |folder: PathBuf| {
        let name = folder.file_name().unwrap().to_str().unwrap().to_string();
        ["padl", "toml"].map(|end| folder.join(format!("{name}.{end}"))).into_iter().find(|p| p.exists())
    };
    let mut models: Vec<PathBuf> = folders.filter_map(model).collect();
    models.sort();
    let system = |path: PathBuf| {
        let machine = Machine::load(&path, None).unwrap();
        let mechanism = Mechanism::compile(machine.into(), &[], &CompileOptions::default()).unwrap();
        Some((path, mechanism.system().ok()?))
    };
    models.into_iter().filter_map(system).collect()
}

/// Distance of a point from an edge in a pose.
fn from_edge(p: Vec2, edge: &Feature, pose: &Pose) -> f64 {
    let FeatureShape::Edge { from, tangent, length, .. } = edge.shape else { panic!("{edge:?}") };
    let (start, along) = (pose.apply(from), pose.rotate(tangent));
    (start + along * along.dot(p - start).clamp(0.0, length) - p).norm()
}

/// The distance as candidates tell it: no less than that of the discs around the features.
fn distance(kind: GapKind, a: &Feature, b: &Feature, relative: &Pose) -> f64 {
    let discs = (relative.apply(a.center) - b.center).norm() - a.radius - b.radius;
    let (ra, rb) = (a.shape.radius(), b.shape.radius());
    let (ca, cb) = (relative.apply(a.shape.anchor()), b.shape.anchor());
    let own = match kind {
        GapKind::RoundEdge { swapped: false } => from_edge(ca, b, &Pose::identity()) - ra,
        GapKind::RoundEdge { swapped: true } => from_edge(cb, a, relative) - rb,
        GapKind::RoundRound => (ca - cb).norm() - ra - rb,
        GapKind::RoundHollow { .. } => ((ca - cb).norm() - ra.max(rb)).abs() - ra.min(rb),
    };
    own.max(discs)
}

/// Every pair of features of an interaction nearer than `reach`, in the order of their identities.
fn every(system: &System, interaction: usize, (a, b): (&Pose, &Pose), reach: f64) -> Vec<Candidate> {
    let pair = &system.interactions[interaction];
    let leaves = |tree: &FeatureTree| {
        let mut list: Vec<usize> = tree.nodes.iter().filter(|n| n.leaf).map(|n| n.link).collect();
        list.sort_unstable();
        list
    };
    let (first, second) = (leaves(&pair.trees.0), leaves(&pair.trees.1));
    let relative = Relative::pose(a, b);
    let mut found = vec![];
    for &i in &first {
        for &j in &second {
            let (fa, fb) = (&system.features[pair.bodies.0][i], &system.features[pair.bodies.1][j]);
            let Some(kind) = pair.kind((i, j), (fa, fb)) else { continue };
            let distance = distance(kind, fa, fb, &relative);
            if distance < reach {
                let id = ContactId { interaction: interaction as u32, first: i as u32, second: j as u32 };
                found.push(Candidate { id, kind, distance });
            }
        }
    }
    found
}

/// A random place: anywhere on a turn, within the machine's size on a slide.
fn place(system: &System, random: &mut Random) -> Vec<f64> {
    let joints = || system.bodies.iter().flat_map(|b| &b.chain);
    let slides = |i| joints().any(|j| j.coordinate == i && matches!(j.motion, Motion::Slide { .. }));
    (0..system.coordinates.len())
        .map(|i| {
            let most = if slides(i) { system.size } else { 7.0 };
            random.between(-most, most)
        })
        .collect()
}

#[test]
fn the_search_finds_what_trying_every_pair_finds() {
    let mut random = Random(1);
    let machines = machines();
    // The slider-crank is a closed chain, which is not simulated.
    assert!(machines.len() >= 16, "{} machines", machines.len());
    for (name, system) in machines {
        let source = system.direct_search();
        let mut counts = [0; 4];
        for _ in 0..40 {
            let q = place(&system, &mut random);
            let poses: Vec<Pose> = system.bodies.iter().map(|b| b.pose(&q)).collect();
            for (k, pair) in system.interactions.iter().enumerate() {
                let (a, b) = (&poses[pair.bodies.0], &poses[pair.bodies.1]);
                for (count, share) in counts.iter_mut().zip([0.003, 0.04, 0.3, 4.0]) {
                    let reach = share * system.size;
                    let expected = every(&system, k, (a, b), reach);
                    // What was found before stays where it is.
                    let mut found = expected.first().copied().into_iter().collect::<Vec<_>>();
                    let before = found.len();
                    source.candidates(k, a, b, reach, &mut found);
                    let bits = |c: &Candidate| (c.id, c.kind, c.distance.to_bits());
                    let found: Vec<_> = found[before..].iter().map(bits).collect();
                    let expected: Vec<_> = expected.iter().map(bits).collect();
                    assert_eq!(found, expected, "{name:?} {q:?} {k} {reach}");
                    *count += found.len();
                }
            }
        }
        let touching = !system.interactions.is_empty();
        assert!(!touching || (counts[3] > counts[1] && counts[2] > 0), "{name:?}: {counts:?}");
    }
}
