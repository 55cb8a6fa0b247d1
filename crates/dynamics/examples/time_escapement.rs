//! Times 37 s of the escapement: `cargo run --release -p mainspring-dynamics --example time_escapement`.

#[path = "../tests/common/mod.rs"]
mod common;

use mainspring_dynamics::{Options, Simulation};
use std::time::Instant;

fn main() {
    let system = common::escapement();
    let source = system.direct_search();
    let mut times = Vec::new();
    let mut stats = None;
    for _ in 0..std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(200) {
        let start = Instant::now();
        let mut run = Simulation::new(&system, &source, Options { until: 37.0, ..Options::default() });
        run.run(&mut |_| true);
        times.push(start.elapsed());
        stats = Some((run.stats, run.world.lists.queries, run.record.energy.residual()));
    }
    times.sort();
    println!("median {:?}, least {:?}; {stats:?}", times[times.len() / 2], times[0]);
}
