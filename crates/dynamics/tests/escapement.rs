//! The escapement of Gelsey's Fig. 12.

mod common;

use mainspring_dynamics::{Options, Simulation, Status};

#[test]
fn print_run() {
    let system = common::escapement();
    for it in &system.interactions {
        println!(
            "{} {}: {} {}",
            system.bodies[it.bodies.0].name,
            system.bodies[it.bodies.1].name,
            it.trees.0.nodes.len(),
            it.trees.1.nodes.len()
        );
    }
    let source = system.direct_search();
    let mut run = Simulation::new(&system, &source, Options { until: 37.0, ..Options::default() });
    let start = std::time::Instant::now();
    let status = run.run(&mut |_| true);
    println!(
        "{status:?} t={} {:?} {:?} queries {} in {:?}",
        run.t,
        run.stats,
        run.energy,
        run.world.queries,
        start.elapsed()
    );
    println!("residual {}", run.energy.residual());
    for e in run.events.iter().take(60) {
        println!(
            "{:.9} {:?} {:?} {:?} {}",
            e.t,
            e.kind,
            e.bodies,
            (e.contact.first, e.contact.second),
            e.impulse
        );
    }
    for m in &run.minima.found {
        println!("min {:.10} {:.3e} top {:.4}", m.t, m.energy, m.top);
    }
    assert_eq!(status, Status::Complete);
}
