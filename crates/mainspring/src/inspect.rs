//! `inspect`: parts, pairs with their evidence, subsystems, what may touch.

use crate::joints::joints_json;
use crate::words::{clean, vec3};
use mainspring_mechanism::{Mechanism, Pair, PairKind, Subsystem};
use mainspring_model::{Machine, Mark, Parameter};
use serde_json::{Value, json};

/// Pairs of parts listed that may touch: more are of no use to a reader, and take a gibibyte.
const MAX_INTERACTIONS: usize = 200_000;

/// The object that `inspect --json` prints.
pub fn inspect_json(m: &Mechanism) -> Value {
    let name = |i: usize| m.parts[i].name.clone();
    let names = |(a, b): (usize, usize)| json!([name(a), name(b)]);
    let found = m.interactions();
    let listed = found.iter().take(MAX_INTERACTIONS);
    let mut interactions: Vec<[String; 2]> = listed.map(|&(a, b)| sorted(name(a), name(b))).collect();
    interactions.sort();
    let mut warnings = warnings(m);
    if found.len() > MAX_INTERACTIONS {
        warnings
            .push(format!("only the first {MAX_INTERACTIONS} of {} interactions are listed", found.len()));
    }
    json!({
        "parts": m.parts.iter().map(|p| &p.name).collect::<Vec<_>>(),
        "frame": name(m.frame),
        "pairs": m.pairs.iter().map(|p| pair(m, p)).collect::<Vec<_>>(),
        "joints": joints_json(m),
        "subsystems": m.subsystems.iter().map(|s| subsystem(m, s)).collect::<Vec<_>>(),
        "state_variables": m.state_variables(),
        "interactions": interactions,
        "near_misses": m.near_misses.iter().map(|n| json!({"parts": names(n.parts), "why": n.reason})).collect::<Vec<_>>(),
        "closed_chains": m.closed_chains.iter().map(|c| json!({
            "parts": c.parts.iter().map(|&p| name(p)).collect::<Vec<_>>(),
            "mobility": c.mobility,
        })).collect::<Vec<_>>(),
        "mobility": m.mobility,
        "warnings": warnings,
        "plane": plane(m),
        "gravity": vec3(m.gravity),
        "contact": {"E": m.contact.e, "D": m.contact.d, "M": m.contact.m},
        "units": units(m),
        "marks": m.machine.supplement().marks.iter().map(|k| mark(m, k)).collect::<Vec<_>>(),
    })
}

/// The parameters of a machine: name, value at the defaults, range, unit and meaning.
pub fn parameters_json(machine: &Machine) -> Value {
    let one = |p: &Parameter| {
        let range = p.range.map(|(low, high)| [low, high]);
        json!({"name": p.name, "value": p.default, "range": range, "whole": p.whole, "unit": p.unit, "meaning": p.meaning})
    };
    machine.parameters().iter().map(one).collect()
}

/// The units stated in the file; angles in results are radians.
fn units(m: &Mechanism) -> Value {
    let units = m.machine.units();
    json!({"length": units.length, "time": units.time, "angle": "rad", "mass": units.mass})
}

/// A named value of a part's coordinate, in radians or the file's length.
fn mark(m: &Mechanism, mark: &Mark) -> Value {
    json!({"part": m.parts[mark.part].name, "name": mark.name, "value": clean(mark.value * m.unit(mark.part))})
}

/// Two names in order, letter case ignored.
fn sorted(a: String, b: String) -> [String; 2] {
    if a.to_lowercase() <= b.to_lowercase() { [a, b] } else { [b, a] }
}

fn pair(m: &Mechanism, p: &Pair) -> Value {
    let name = |i: usize| &m.parts[i].name;
    let axis = (p.kind != PairKind::Fixed)
        .then(|| json!({"point": vec3(p.axis.point), "direction": vec3(p.axis.direction)}));
    let evidence: Vec<&str> = p
        .evidence
        .iter()
        .map(|e| e.text.as_str())
        .chain(p.dropped.iter().map(|d| d.reason.as_str()))
        .collect();
    json!({
        "kind": p.kind.name(),
        "shape_kind": p.shape_kind.name(),
        "parts": [name(p.parts.0), name(p.parts.1)],
        "axis": axis,
        "ratio": p.ratio,
        "clearance": clean(p.clearance),
        "evidence": evidence,
    })
}

fn subsystem(m: &Mechanism, s: &Subsystem) -> Value {
    let name = |i: usize| &m.parts[i].name;
    json!({
        "root": name(s.root),
        "parts": s.parts.iter().map(|(p, _)| name(*p)).collect::<Vec<_>>(),
        "ratios": s.parts.iter().map(|(_, r)| clean(*r)).collect::<Vec<_>>(),
        "inertia": s.inertia,
        "locked": s.locked,
    })
}

/// Warnings as on standard error. One without a place of its own stands where its first moving part does; one
/// about the whole machine, at the frame.
fn warnings(m: &Mechanism) -> Vec<String> {
    m.warnings
        .iter()
        .map(|w| {
            let part = w.parts.iter().copied().find(|p| *p != m.frame).unwrap_or(m.frame);
            let place = w.place.unwrap_or(m.parts[part].place);
            m.machine.error(place, w.message.clone()).to_string().replacen(": error: ", ": warning: ", 1)
        })
        .collect()
}

fn plane(m: &Mechanism) -> Value {
    if !m.plane.planar {
        return Value::Null;
    }
    let machine_from_plane = m.plane.plane_from_machine.inverse();
    let [x, y, normal] = machine_from_plane.columns;
    json!({
        "origin": vec3(machine_from_plane.translation),
        "x": vec3(x),
        "y": vec3(y),
        "normal": vec3(normal),
    })
}
