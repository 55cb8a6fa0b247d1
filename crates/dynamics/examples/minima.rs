//! Prints chosen low minima of the whole run-down.
#[path = "../tests/common/mod.rs"]
mod common;
use mainspring_dynamics::{Options, Simulation};
fn main() {
    let rtol: f64 = std::env::args().nth(1).map_or(1e-8, |x| x.parse().unwrap());
    let system = common::escapement();
    let source = system.direct_search();
    let mut run = Simulation::new(&system, &source, Options { until: 3000.0, rtol, ..Options::default() });
    run.run(&mut |_| true);
    let low: Vec<f64> = run.minima.found.iter().filter(|m| m.energy < 1e-5 * m.top).map(|m| m.t).collect();
    for k in [50, 100, 200, 300, 400, 450, 500, 510, 540, 547, 551] {
        println!("{k} {:?}", low.get(k - 1));
    }
    println!("{:?} t {} q {:?}", run.status, run.t, run.q);
    for e in run.events.iter().rev().take(4) {
        println!("{} {:?} {:?}", e.t, e.kind, e.bodies);
    }
}
