//! Contacts and stops at an instant: where, along what, with what force.

use crate::words::{clean, vec2};
use mainspring_dynamics::Closed;
use mainspring_mechanism::{ContactId, Feature, System, gap_state};
use serde_json::{Value, json};

/// Closed contacts at positions `q`, as a list of objects. Forces are those carried along.
pub fn contacts_json(system: &System, closed: &[Closed], q: &[f64]) -> Vec<Value> {
    closed.iter().map(|c| contact(system, c, q)).collect()
}

/// The two bodies of a contact or a stop.
pub fn bodies(system: &System, id: ContactId) -> (usize, usize) {
    match id.stop() {
        Some(k) => system.forces.stops[k].bodies,
        None => system.interactions[id.interaction as usize].bodies,
    }
}

/// A stop has no place: its limit says where it is.
fn stop(system: &System, c: &Closed, k: usize) -> Value {
    let stop = &system.forces.stops[k];
    let (a, b) = stop.bodies;
    json!({
        "parts": [system.bodies[a].name, system.bodies[b].name],
        "stop": if stop.upper { "upper" } else { "lower" },
        "points": [],
        "normal": null,
        "force": clean(c.force),
        "features": [],
    })
}

fn contact(system: &System, c: &Closed, q: &[f64]) -> Value {
    if let Some(k) = c.candidate.id.stop() {
        return stop(system, c, k);
    }
    let (a, b) = system.interactions[c.candidate.id.interaction as usize].bodies;
    let (fa, fb) = features(system, c.candidate.id);
    let poses = (system.bodies[a].pose(q), system.bodies[b].pose(q));
    let state = gap_state(c.candidate.kind, fa, fb, &poses.0, &poses.1);
    json!({
        "parts": [system.bodies[a].name, system.bodies[b].name],
        "points": [vec2(state.point)],
        "normal": vec2(state.normal),
        "force": clean(c.force),
        "features": [feature(system, a, fa), feature(system, b, fb)],
    })
}

/// The two features of a contact.
pub fn features(system: &System, id: ContactId) -> (&Feature, &Feature) {
    let (a, b) = system.interactions[id.interaction as usize].bodies;
    (&system.features[a][id.first as usize], &system.features[b][id.second as usize])
}

/// A feature as the drawing names it.
pub fn feature(system: &System, body: usize, feature: &Feature) -> Value {
    let (layer, boundary, edge) = feature.at;
    json!({
        "part": system.bodies[body].name,
        "layer": layer,
        "loop": boundary,
        "edge": edge,
        "corner": feature.is_corner(),
    })
}
