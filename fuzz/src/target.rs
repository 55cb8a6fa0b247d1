//! What is tried with each machine that the parser accepts. Later steps of the program add a line to [`TARGETS`].

use mainspring::{SimulationOptions, inspect_json};
use mainspring_geometry::Primitive;
use mainspring_mechanism::{CompileOptions, Mechanism};
use mainspring_model::{Error, Machine, Values};
use num_dual::Dual64;
use std::sync::Arc;

/// A step of the program; `Ok` may hold the one error it reports for the input, `Err` is a broken promise.
pub struct Target {
    pub name: &'static str,
    pub check: fn(&Arc<Machine>) -> Result<Option<Error>, String>,
}

/// The steps in the order of the program's path.
pub const TARGETS: &[Target] = &[
    Target { name: "model", check: model },
    Target { name: "compile", check: compile },
    Target { name: "simulate", check: simulate },
];

/// Values and primitives: finite, positive, and the same to the last bit over dual numbers.
fn model(machine: &Arc<Machine>) -> Result<Option<Error>, String> {
    match evaluate(machine) {
        Err(e) => Ok(Some(e)),
        Ok((values, primitives)) => derivatives(machine, &values, &primitives).map(|()| None),
    }
}

/// Pairs, subsystems and outlines; for one machine in eight the same twice.
fn compile(machine: &Arc<Machine>) -> Result<Option<Error>, String> {
    let once = || Mechanism::compile(machine.clone(), &[], &CompileOptions::default());
    let first = once();
    let twice = (machine.parts().len() + machine.parameters().len()).is_multiple_of(8);
    let same = !twice
        || match (&first, &once()) {
            (Err(a), Err(b)) => a == b,
            (Ok(a), Ok(b)) => format!("{:?}", a.pairs) == format!("{:?}", b.pairs),
            _ => false,
        };
    if same { Ok(first.err()) } else { Err("two compilations of one machine differ".to_string()) }
}

/// Steps of a simulation.
const STEPS: u64 = 200;
/// Up to this time: far enough for most parts to hit something.
const UNTIL: f64 = 10.0;

/// What `inspect` prints, and the first steps of a run: every number finite.
fn simulate(machine: &Arc<Machine>) -> Result<Option<Error>, String> {
    let mechanism = match Mechanism::compile(machine.clone(), &[], &CompileOptions::default()) {
        Ok(mechanism) => mechanism,
        Err(e) => return Ok(Some(e)),
    };
    inspect_json(&mechanism);
    let options = SimulationOptions { until: UNTIL, max_steps: STEPS, ..SimulationOptions::default() };
    let result = match mainspring::simulate(&mechanism, &options, &mut |_| true) {
        Ok(result) => result,
        Err(e) => return Ok(Some(e)),
    };
    let end = result.times().last().copied().unwrap_or(0.0);
    let (positions, velocities) = result.at(end);
    let finite = positions.iter().chain(&velocities).all(|x| x.is_finite());
    if finite && end <= UNTIL {
        Ok(None)
    } else {
        Err(format!("at {end} positions {positions:?}, velocities {velocities:?}"))
    }
}

type Evaluated = (Values<f64>, Vec<Primitive>);

fn evaluate(machine: &Machine) -> Result<Evaluated, Error> {
    let values = machine.values(&[])?;
    let primitives = machine.primitives(&values)?;
    for part in machine.parts() {
        machine.density(part, &values)?;
    }
    for gear in machine.gears() {
        machine.teeth(gear, &values)?;
        machine.tooth_depth(gear, &values)?;
    }
    for union in machine.symmetric_unions() {
        machine.evaluate(&union.range, &values)?;
    }
    Ok((values, primitives))
}

fn derivatives(machine: &Machine, values: &Values<f64>, primitives: &[Primitive]) -> Result<(), String> {
    for parameter in machine.parameters().iter().take(3) {
        let name = &parameter.name;
        let seeded =
            machine.values_with_derivative(&[], name).map_err(|e| format!("derivative by {name}: {e}"))?;
        if bits(&seeded.re()) != bits(values) {
            return Err(format!("values with the derivative by {name} differ"));
        }
        let dual: Vec<Primitive<Dual64>> =
            machine.primitives(&seeded).map_err(|e| format!("primitives over duals: {e}"))?;
        if dual
            .iter()
            .zip(primitives)
            .any(|(d, p)| pose_bits(&d.re()) != pose_bits(p) || d.re().shape != p.shape)
        {
            return Err(format!("primitives with the derivative by {name} differ"));
        }
    }
    Ok(())
}

fn bits(values: &Values<f64>) -> Vec<u64> {
    values.as_slice().iter().map(|v| v.to_bits()).collect()
}

fn pose_bits(primitive: &Primitive) -> [u64; 12] {
    let [a, b, c] = primitive.machine_from_local.columns;
    let t = primitive.machine_from_local.translation;
    [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, t.x, t.y, t.z].map(f64::to_bits)
}
