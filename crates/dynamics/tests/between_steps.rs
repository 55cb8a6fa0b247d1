//! Between its steps a run keeps its contacts as well as it was asked to: the promise of dense output.

mod common;

use common::examples::{RUNNING, example};
use common::overlap::depth_at;
use mainspring_dynamics::{Closed, Options, Run, Simulation};
use mainspring_mechanism::{System, gap_state};

/// Places looked at inside every step.
const PLACES: u32 = 8;
/// Instants at which all outlines are compared.
const INSTANTS: usize = 400;

fn run(system: &System, rtol: f64) -> Run {
    let source = system.direct_search();
    let mut run = Simulation::new(system, &source, Options { until: 20.0, rtol, ..Options::default() });
    run.run(&mut |_| true);
    run.into_run()
}

fn positions(system: &System, run: &Run, t: f64) -> Vec<f64> {
    (0..system.coordinates.len()).map(|i| run.trajectory.state(i, t).q).collect()
}

/// The greatest gap, of either sign, among contacts that carry force at time `t`.
fn farthest(system: &System, run: &Run, t: f64) -> f64 {
    let q = positions(system, run, t);
    let mode = &run.modes[run.modes.partition_point(|m| m.from <= t) - 1];
    let gap = |c: &Closed| {
        let id = c.candidate.id;
        let (a, b) = system.interactions[id.interaction as usize].bodies;
        let features = (&system.features[a][id.first as usize], &system.features[b][id.second as usize]);
        let poses = (system.bodies[a].pose(&q), system.bodies[b].pose(&q));
        gap_state(c.candidate.kind, features.0, features.1, &poses.0, &poses.1).gap.abs()
    };
    let carries = |c: &&Closed| c.active && c.candidate.id.stop().is_none();
    mode.closed.iter().filter(carries).map(gap).fold(0.0, f64::max)
}

fn instants(run: &Run) -> Vec<f64> {
    let share = |k: u32| f64::from(k) / f64::from(PLACES + 1);
    let inside = |w: &[f64]| (1..=PLACES).map(|k| w[0] + share(k) * (w[1] - w[0])).collect::<Vec<f64>>();
    run.trajectory.times.windows(2).flat_map(inside).collect()
}

/// In every shipped machine: closed contacts are closed, and no outline lies in another, to the tolerance (1e-7 at the
/// loosest) of the machine's size.
#[test]
fn contacts_are_kept_between_steps() {
    for name in RUNNING {
        let system = example(name, &[]);
        for rtol in [1e-6, 1e-8, 1e-10] {
            let found = run(&system, rtol);
            let promised = rtol.min(1e-7) * system.size;
            let times = instants(&found);
            for &t in &times {
                let gap = farthest(&system, &found, t);
                assert!(gap <= promised, "{name:?} {rtol:e}: gap {gap:e} at {t}");
            }
            for &t in times.iter().step_by(times.len().div_ceil(INSTANTS)) {
                let depth = depth_at(&system, &positions(&system, &found, t));
                assert!(depth <= promised, "{name:?} {rtol:e}: overlap {depth:e} at {t}");
            }
        }
    }
}

/// It is the tolerance that keeps them: a looser one lets them stray further.
#[test]
fn what_is_promised_is_used() {
    let system = example(("rotary-to-reciprocating", "rotary-to-reciprocating"), &[]);
    let worst = |rtol: f64| {
        let found = run(&system, rtol);
        instants(&found).iter().map(|&t| farthest(&system, &found, t)).fold(0.0, f64::max)
    };
    let (loose, tight) = (worst(1e-7), worst(1e-10));
    assert!(loose > 1e-9 * system.size && tight < 0.01 * loose, "{loose:e} {tight:e}");
}
