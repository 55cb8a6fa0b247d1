//! Runs a variation of the escapement: arguments are balance spring, mainspring constant and relaxed degrees, time.
#[path = "../tests/common/mod.rs"]
mod common;
use mainspring_dynamics::{Options, Simulation};
fn main() {
    let a: Vec<f64> = std::env::args().skip(1).map(|x| x.parse().unwrap()).collect();
    let mut system = common::escapement();
    let degree = std::f64::consts::PI / 180.0;
    system.coordinates[2] = common::coordinate("bwheel", 20.0, 6.0, (a[0], 90.0 * degree));
    system.coordinates[0] = common::coordinate("ewheel", 200.0, 20.0, (a[1], a[2] * degree));
    let source = system.direct_search();
    let mut run = Simulation::new(&system, &source, Options { until: a[3], ..Options::default() });
    let status = run.run(&mut |_| true);
    println!(
        "{status:?} {} {:?} {:?} res {} queries {}",
        run.t,
        run.q,
        run.stats,
        run.energy.residual(),
        run.world.queries
    );
    println!("{}", run.minima.found.iter().filter(|m| m.energy < 1e-5 * m.top).count());
    for e in run.events.iter().rev().take(a.get(4).map_or(6, |n| *n as usize)) {
        println!(
            "{} {:?} {:?} {:?} {:e}",
            e.t,
            e.kind,
            e.bodies,
            (e.contact.first, e.contact.second),
            e.impulse
        );
    }
}
