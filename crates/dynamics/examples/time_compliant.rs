//! Times 37 s of the escapement with compliant contact:
//! `cargo run --release -p mainspring-dynamics --example time_compliant -- [RUNS [RTOL [FACTOR [UNTIL]]]]`.

#[path = "../tests/common/mod.rs"]
mod common;

use mainspring_dynamics::{Compliant, Options};
use mainspring_mechanism::ContactLaw;
use std::time::Instant;

fn main() {
    let argument = |k: usize, or: f64| std::env::args().nth(k).and_then(|x| x.parse().ok()).unwrap_or(or);
    let (runs, rtol, factor, until) =
        (argument(1, 50.0), argument(2, 1e-6), argument(3, 1.0), argument(4, 37.0));
    let system = common::escapement();
    let source = system.direct_search();
    let law = ContactLaw::default();
    let law = ContactLaw { e: law.e * factor, d: law.d * factor, ..law };
    let mut times = Vec::new();
    let mut last = None;
    for _ in 0..runs as usize {
        let start = Instant::now();
        let options = Options { until, rtol, ..Options::default() };
        let mut run = Compliant::new(&system, &source, law, options);
        run.run(&mut |_| true);
        times.push(start.elapsed());
        let rejected = run.rejected();
        last = Some((run.into_run(), rejected));
    }
    times.sort();
    let (run, rejected) = last.expect("at least one run");
    let low: Vec<f64> =
        run.minima.iter().filter(|m| m.t > 0.0 && m.energy < 1e-5 * m.top).map(|m| m.t).collect();
    println!("median {:?}, least {:?}", times[times.len() / 2], times[0]);
    println!(
        "{:?} at {}: {:?}, rejected {rejected}, events {}",
        run.status,
        run.t,
        run.stats,
        run.events.len()
    );
    println!("residual {:e}, {:?}", run.energy.residual(), run.energy);
    println!("minima {low:?}");
}
