//! What several tests need.
#![allow(dead_code)] // each test binary uses a part of it

use mainspring_model::{Error, Machine};

/// A moving part and a frame.
pub const SMALL: &str = "generic g(r)\na = cyl()\nbase = blo()\nattr base : frame = 1\nr = a asb base\n";

/// Reads a model and evaluates everything that can be evaluated.
pub fn read(text: &[u8]) -> Result<Machine, Error> {
    let machine = Machine::parse("m.padl", text, None)?;
    evaluate(&machine)?;
    Ok(machine)
}

/// Reads a model with its supplement.
pub fn supplemented(model: &str, supplement: &str) -> Result<Machine, Error> {
    Machine::parse("m.padl", model.as_bytes(), Some(("m.sup", supplement.as_bytes())))
}

pub fn evaluate(machine: &Machine) -> Result<(), Error> {
    let values = machine.values(&[])?;
    machine.primitives(&values)?;
    for part in machine.parts() {
        machine.density(part, &values)?;
    }
    for gear in machine.gears() {
        machine.teeth(gear, &values)?;
        machine.tooth_depth(gear, &values)?;
    }
    Ok(())
}
