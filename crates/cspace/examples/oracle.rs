//! Configuration spaces of random pairs against the overlap tests of a library of polygons.
//!
//! ```text
//! cargo run --release -p mainspring-cspace --example oracle [PAIRS] [CONFIGURATIONS EACH] [FIRST SEED]
//! ```
//! Three quarters of the configurations lie within 1e-3 of the reported curves, on both sides, where there are any. A
//! configuration counts as wrong if the map and the library disagree there and everywhere within 1e-6 of the size.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Random, check, pairs};
use mainspring_cspace::ConfigurationSpace;
use std::time::Instant;

fn argument(k: usize, default: usize) -> usize {
    std::env::args().nth(k).and_then(|s| s.parse().ok()).unwrap_or(default)
}

fn main() {
    let (count, each, first) = (argument(1, 2000), argument(2, 500), argument(3, 0));
    let (mut total, mut slowest) = (check::Tally::default(), (0.0, String::new()));
    let (mut refused, mut made_in) = (0, 0.0);
    for seed in first..first + count {
        let (system, options, name) = pairs::pair(seed as u64);
        let start = Instant::now();
        let made = ConfigurationSpace::new(&system, [0, 1], [0, 1], &options);
        let seconds = start.elapsed().as_secs_f64();
        made_in += seconds;
        if seconds > slowest.0 {
            slowest = (seconds, name.clone());
        }
        match made {
            Err(e) => {
                refused += 1;
                println!("{name}: {e}");
            }
            Ok(space) => {
                let mut random = Random(seed as u64 + 7);
                let one = check::compare(&space, &system, &mut random, each);
                for w in one.wrong.iter().take(3) {
                    let second = common::oracle::overlap(&system.bodies[0], &system.bodies[1], &w.0);
                    let word = |free: bool| if free { "free" } else { "blocked" };
                    println!(
                        "{name}: wrong at {:?}, called {}, by exact arcs {}",
                        w.0,
                        word(w.1),
                        word(!second)
                    );
                }
                total.add(one);
            }
        }
    }
    println!(
        "{count} pairs ({refused} refused), {} configurations, of these {} near a curve and {} free; {} wrong, {} within 1e-6 of a contact",
        total.configurations,
        total.near,
        total.free,
        total.wrong.len(),
        total.forgiven
    );
    println!(
        "maps made in {:.2} ms on average, at most {:.1} ms: {}",
        1e3 * made_in / count as f64,
        1e3 * slowest.0,
        slowest.1
    );
}
