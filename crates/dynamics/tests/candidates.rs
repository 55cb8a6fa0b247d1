//! Trajectories do not depend on where candidates come from.

mod common;

use common::{changed_escapements, close, escapement, run};
use mainspring_dynamics::{Options, Run, Simulation};
use mainspring_mechanism::{Candidate, ContactId, ContactSource, FeatureTree, Pose, System};

/// Names every pair of features that can reach each other at all, always, at distance 0.
struct Everything<'a>(&'a System);

impl ContactSource for Everything<'_> {
    fn candidates(&self, interaction: usize, _: &Pose, _: &Pose, _: f64, found: &mut Vec<Candidate>) {
        let it = &self.0.interactions[interaction];
        let leaves = |tree: &FeatureTree| {
            let mut list: Vec<usize> = tree.nodes.iter().filter(|n| n.leaf).map(|n| n.link).collect();
            list.sort_unstable();
            list
        };
        let (fa, fb) = (&self.0.features[it.bodies.0], &self.0.features[it.bodies.1]);
        for i in leaves(&it.trees.0) {
            for j in leaves(&it.trees.1) {
                if let Some(kind) = it.kind((i, j), (&fa[i], &fb[j])) {
                    let id = ContactId { interaction: interaction as u32, first: i as u32, second: j as u32 };
                    found.push(Candidate { id, kind, distance: 0.0 });
                }
            }
        }
    }
}

fn run_with(system: &System, source: &dyn ContactSource, until: f64) -> Run {
    let mut run = Simulation::new(system, source, Options { until, ..Options::default() });
    run.run(&mut |_| true);
    run.into_run()
}

fn same_events(one: &Run, other: &Run) {
    let names = |run: &Run| run.events.iter().map(|e| (e.kind, e.contact)).collect::<Vec<_>>();
    assert_eq!(names(one), names(other));
    for (a, b) in one.events.iter().zip(&other.events) {
        close(a.t, b.t, 1e-9);
    }
}

/// Contacts of a single moving joint are found at places known beforehand: the same as by marching along every contact.
#[test]
fn places_known_beforehand_give_what_marching_finds() {
    for (system, _) in changed_escapements() {
        let mut marched = system.clone();
        marched.interactions.iter_mut().for_each(|i| i.pairs.clear());
        let (swept, marched) = (run(&system, 37.0, 1e-9), run(&marched, 37.0, 1e-9));
        same_events(&swept, &marched);
        assert!(swept.stats.gap_evaluations < marched.stats.gap_evaluations);
    }
}

/// Trying every pair of features everywhere gives the motion of the search: the same events between the same features
/// at the same times and the same positions, to rounding.
#[test]
fn the_search_gives_what_trying_everything_gives() {
    let system = escapement();
    let searched = run_with(&system, &system.direct_search(), 8.0);
    let tried = run_with(&system, &Everything(&system), 8.0);
    assert!(tried.stats.gap_evaluations > 2 * searched.stats.gap_evaluations);
    same_events(&searched, &tried);
    for n in 0..=800 {
        let t = f64::from(n) * 0.01;
        for i in 0..3 {
            close(searched.trajectory.state(i, t).q, tried.trajectory.state(i, t).q, 1e-9);
        }
    }
}
