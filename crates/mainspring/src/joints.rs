//! What acts on each moving part along its joint, as `inspect` tells it.

use crate::words::{clean, vec3};
use mainspring_mechanism::{JointDrive, Mechanism, Part};
use serde_json::{Value, json};

/// One object a part that has a joint of its own, in the order of the model. Angles are radians.
pub fn joints_json(m: &Mechanism) -> Value {
    (0..m.parts.len()).filter(|i| m.subsystem_of(*i).is_some()).map(|i| joint(m, i)).collect()
}

fn joint(m: &Mechanism, i: usize) -> Value {
    let part = &m.parts[i];
    let spring =
        |s: mainspring_mechanism::JointSpring| json!({"relaxed": clean(s.relaxed), "constant": s.constant});
    let stops = part.forces.stops;
    json!({
        "part": part.name,
        "carrier": part.carrier.map(|c| &m.parts[c].name),
        "motion": if m.slides(i) { "slide" } else { "turn" },
        "position": clean(part.position),
        "velocity": clean(part.velocity),
        "inertia": part.inertia,
        "mass": part.mass.mass,
        "center": part.mass.center.map(vec3),
        "friction": part.friction,
        "coulomb": part.forces.coulomb,
        "spring": part.spring.map(spring),
        "torque": clean(part.forces.torque),
        "drive": drive(part),
        "stops": stops.iter().any(Option::is_some).then_some(stops),
    })
}

fn drive(part: &Part) -> Value {
    match &part.forces.drive {
        None => Value::Null,
        Some(JointDrive::Speed(speed)) => json!({"speed": clean(*speed), "table": null}),
        Some(JointDrive::Table(table)) => {
            let points: Vec<[f64; 2]> = table.points().map(|(t, x)| [clean(t), clean(x)]).collect();
            json!({"speed": null, "table": points})
        }
    }
}
