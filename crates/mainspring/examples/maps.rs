//! Makes the configuration space of every two parts of machines that have one: the least time of several.
//!
//! ```text
//! cargo run --release -p mainspring --example maps MODEL...
//! ```

use mainspring::{CompileOptions, Machine, Mechanism, SpaceRequest, configuration_space};
use std::path::Path;
use std::time::Instant;

const ROUNDS: usize = 25;

fn rows(model: &str) -> Result<(), mainspring::Error> {
    let machine = Machine::load(Path::new(model), None)?;
    let mechanism = Mechanism::compile(machine.into(), &[], &CompileOptions::default())?;
    let machine = Path::new(model).file_stem().map_or(model.into(), |s| s.to_string_lossy());
    let names: Vec<String> = mechanism.parts.iter().map(|p| p.name.clone()).collect();
    for (i, a) in names.iter().enumerate() {
        for b in &names[i + 1..] {
            row(&machine, &mechanism, [a.clone(), b.clone()]);
        }
    }
    Ok(())
}

/// Nothing for two parts without a space.
fn row(machine: &str, mechanism: &Mechanism, parts: [String; 2]) {
    let pair = parts.join(" – ");
    let request = SpaceRequest { parts, ..SpaceRequest::default() };
    let Ok(space) = configuration_space(mechanism, &request) else { return };
    if space.map().curves().is_empty() {
        return;
    }
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        let made = configuration_space(mechanism, &request);
        least = least.min(1e3 * start.elapsed().as_secs_f64());
        assert!(made.is_ok());
    }
    let work = space.map().work();
    println!(
        "{machine:>24} {pair:>20} {least:>8.2} {:>6} {:>6} {:>6}",
        work.cells,
        work.elements,
        space.map().curves().len()
    );
}

fn main() {
    println!(
        "Least milliseconds of {ROUNDS}: boxes looked at, elements of curves made, curves that bound free space."
    );
    println!("{:>24} {:>20} {:>8} {:>6} {:>6} {:>6}", "", "", "ms", "boxes", "elements", "curves");
    for model in std::env::args().skip(1) {
        if let Err(error) = rows(&model) {
            println!("{model}: {error}");
        }
    }
}
