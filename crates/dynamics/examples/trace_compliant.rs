#[path = "../tests/common/mod.rs"]
mod common;
use mainspring_dynamics::{Compliant, Options, Simulation};
use mainspring_mechanism::ContactLaw;
fn main() {
    let argument = |k: usize, or: f64| std::env::args().nth(k).and_then(|x| x.parse().ok()).unwrap_or(or);
    let (rtol, factor, until) = (argument(1, 1e-6), argument(2, 1.0), argument(3, 8.0));
    let system = common::escapement();
    let source = system.direct_search();
    let law = ContactLaw::default();
    let law = ContactLaw { e: law.e * factor, d: law.d * factor, ..law };
    let options = Options { until, rtol, ..Options::default() };
    let mut run = Compliant::new(&system, &source, law, options.clone());
    let mut modes = 0;
    while run.advance().is_none() {
        let now = run.closed();
        let n = run.modes().len();
        if n != modes {
            print!(
                "{:.7} steps {:5} q {:.6} {:.6} {:.6} loss {:.4} |",
                run.t, run.stats.steps, run.q[0], run.q[1], run.q[2], run.energy.impacts
            );
            for c in &now {
                let it = &system.interactions[c.candidate.id.interaction as usize];
                print!(
                    " {}-{} {}/{} {:.2}{}",
                    system.bodies[it.bodies.0].name,
                    system.bodies[it.bodies.1].name,
                    c.candidate.id.first,
                    c.candidate.id.second,
                    c.force,
                    if c.active { "" } else { "c" }
                );
            }
            println!();
        }
        modes = n;
    }
    println!("RIGID");
    let mut run = Simulation::new(&system, &source, options);
    run.run(&mut |_| true);
    for e in &run.events {
        println!(
            "{:.6} {:?} {}-{} {}/{} {:.4}",
            e.t,
            e.kind,
            system.bodies[e.bodies.0].name,
            system.bodies[e.bodies.1].name,
            e.contact.first,
            e.contact.second,
            e.impulse
        );
    }
}
