//! Runs machines with contacts found directly and from maps: the least time of several runs each.
//!
//! ```text
//! cargo run --release -p mainspring --example sources MODEL...
//! ```

use mainspring::{CompileOptions, Machine, Mechanism};
use mainspring_cspace::MapSource;
use mainspring_dynamics::{Options, Simulation};
use mainspring_mechanism::{ContactSource, System};
use std::path::Path;
use std::time::Instant;

const ROUNDS: usize = 25;
const UNTIL: f64 = 20.0;

fn run(system: &System, source: &dyn ContactSource) -> f64 {
    let start = Instant::now();
    let mut simulation = Simulation::new(system, source, Options { until: UNTIL, ..Options::default() });
    simulation.run(&mut |_| true);
    1e3 * start.elapsed().as_secs_f64()
}

fn system(model: &str) -> Result<System, mainspring::Error> {
    let machine = Machine::load(Path::new(model), None)?;
    Mechanism::compile(machine.into(), &[], &CompileOptions::default())?.system()
}

fn row(model: &str, system: &System) {
    let (mut direct, mut fresh, mut kept) = (f64::INFINITY, f64::INFINITY, f64::INFINITY);
    let map = MapSource::new(system);
    run(system, &map);
    for _ in 0..ROUNDS {
        direct = direct.min(run(system, &system.direct_search()));
        fresh = fresh.min(run(system, &MapSource::new(system)));
        kept = kept.min(run(system, &map));
    }
    let name = Path::new(model).file_stem().map_or(model.to_string(), |s| s.to_string_lossy().into_owned());
    let (mapped, all) = map.mapped();
    println!("{name:>24} {direct:>10.3} {fresh:>10.3} {kept:>10.3} {:>8} {mapped:>4} of {all}", map.boxes());
}

fn main() {
    println!(
        "Least milliseconds of {ROUNDS} runs to t = {UNTIL}: contacts from direct search, from a map made on the way,"
    );
    println!("from a map made before; boxes of the map; pairs of bodies with a map.");
    println!("{:>24} {:>10} {:>10} {:>10} {:>8} {:>9}", "", "direct", "map", "map kept", "boxes", "mapped");
    for model in std::env::args().skip(1) {
        match system(&model) {
            Ok(system) => row(&model, &system),
            Err(error) => println!("{model}: {error}"),
        }
    }
}
