//! The search for candidates names every contact within reach: against all pairs of features.

mod common;

use mainspring_mechanism::{ContactSource, gap_state};

#[test]
fn direct_search_misses_nothing_within_reach() {
    let system = common::escapement();
    let source = system.direct_search();
    let mut seed = 1u64;
    let mut next = |low: f64, high: f64| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        low + (high - low) * (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut near = 0;
    for _ in 0..3000 {
        let q = [next(-200.0, 0.0), next(-0.3, 0.3), next(-7.0, 7.0)];
        for (k, it) in system.interactions.iter().enumerate() {
            let (a, b) = it.bodies;
            let (pa, pb) = (system.bodies[a].pose(&q), system.bodies[b].pose(&q));
            let mut found = vec![];
            source.candidates(k, &pa, &pb, 1.0, &mut found);
            for i in 0..system.features[a].len() {
                for j in 0..system.features[b].len() {
                    let (fa, fb) = (&system.features[a][i], &system.features[b][j]);
                    let leaf = |t: &mainspring_mechanism::FeatureTree, i| {
                        t.nodes.iter().any(|n| n.leaf && n.link == i)
                    };
                    let Some(kind) = it.kind((i, j), (fa, fb)) else { continue };
                    if !leaf(&it.trees.0, i) || !leaf(&it.trees.1, j) {
                        continue;
                    }
                    let s = gap_state(kind, fa, fb, &pa, &pb);
                    if s.gap.abs() < 0.9 && s.edge_margin > 0.0 && s.cone_margin > 0.0 {
                        near += 1;
                        assert!(
                            found.iter().any(|c| c.id.first as usize == i && c.id.second as usize == j),
                            "{k} {i} {j} gap {}",
                            s.gap
                        );
                    }
                }
            }
        }
    }
    assert!(near > 1000, "{near}");
}
