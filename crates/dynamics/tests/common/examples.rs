//! The shipped machines, compiled as a user's would be.

use mainspring_mechanism::{CompileOptions, Mechanism, System};
use mainspring_model::Machine;
use std::path::PathBuf;

/// Every shipped machine that runs, with its supplement.
pub const RUNNING: [(&str, &str); 7] = [
    ("escapement", "escapement"),
    ("pawl-on-plate", "pawl-on-plate"),
    ("pawl-on-plate", "blocked"),
    ("ratchet", "ratchet"),
    ("ratchet", "blocked"),
    ("slide", "slide"),
    ("rotary-to-reciprocating", "rotary-to-reciprocating"),
];

/// A shipped machine with parameters set.
pub fn shipped((name, supplement): (&str, &str), set: &[(&str, f64)]) -> Mechanism {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name);
    let read = |file: String| std::fs::read(folder.join(file)).unwrap();
    let (model, forces) = (read(format!("{name}.padl")), read(format!("{supplement}.sup")));
    let machine = Machine::parse("m.padl", &model, Some(("m.sup", &forces))).unwrap();
    let set: Vec<(String, f64)> = set.iter().map(|(name, value)| (name.to_string(), *value)).collect();
    Mechanism::compile(machine.into(), &set, &CompileOptions::default()).unwrap()
}

/// Its system.
pub fn example(names: (&str, &str), set: &[(&str, f64)]) -> System {
    shipped(names, set).system().unwrap()
}
