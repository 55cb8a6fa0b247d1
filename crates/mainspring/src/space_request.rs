//! What a configuration space is asked for, by names, and what is wrong with it if nothing can be made of it.

use crate::space::SpaceAxis;
use mainspring_cspace::SpaceError;
use mainspring_mechanism::{Mechanism, System};
use mainspring_model::Error;

/// Two parts and choices, all by names of parts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpaceRequest {
    pub parts: [String; 2],
    /// The parts whose joints are the two coordinates; none: the two parts' own, or for a part that does not move
    /// against the other's carrier, the joint next to the other's own.
    pub coordinates: Option<[String; 2]>,
    /// Ranges of coordinates: radians or the file's length.
    pub windows: Vec<(String, f64, f64)>,
    /// Values of other joints; those not named stay where they are at the start.
    pub held: Vec<(String, f64)>,
}

/// The same by indices.
pub(crate) struct Chosen {
    pub parts: [usize; 2],
    pub axes: [SpaceAxis; 2],
    /// Coordinates with values.
    pub held: Vec<(usize, f64)>,
    pub windows: [Option<(f64, f64)>; 2],
}

/// An error of an argument: the option stands where a file's name would.
fn fault<T>(option: &str, message: String) -> Result<T, Error> {
    Err(Error { file: option.into(), line: 1, column: 1, message })
}

pub(crate) fn choose(m: &Mechanism, system: &System, request: &SpaceRequest) -> Result<Chosen, Error> {
    let [a, b] = &request.parts;
    let parts = [part(m, "cspace", a)?, part(m, "cspace", b)?];
    if parts[0] == parts[1] {
        return fault(
            "cspace",
            format!("{} is named twice; expected two different parts", m.parts[parts[0]].name),
        );
    }
    let joints = match &request.coordinates {
        Some([p, q]) => [part(m, "--coordinates", p)?, part(m, "--coordinates", q)?],
        None => own_joints(m, system, parts)?,
    };
    let axes = [axis(m, system, joints[0])?, axis(m, system, joints[1])?];
    check_axes(m, system, parts, &axes)?;
    let windows = windows(m, &axes, &request.windows)?;
    let held = request.held.iter().map(|(name, x)| hold(m, &axes, name, *x)).collect::<Result<_, _>>()?;
    Ok(Chosen { parts, axes, held, windows })
}

fn part(m: &Mechanism, option: &str, name: &str) -> Result<usize, Error> {
    let names = || m.parts.iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", ");
    match m.part_index(name) {
        Some(i) => Ok(i),
        None => {
            fault(option, format!("no part {}; expected one of {}", mainspring_model::quote(name), names()))
        }
    }
}

/// The coordinates that move either body against the other: those of its chain after what both chains share.
pub(crate) fn rests(system: &System, parts: [usize; 2]) -> [Vec<usize>; 2] {
    let chains = parts.map(|p| system.bodies[p].chain.as_slice());
    let common = chains[0].iter().zip(chains[1]).take_while(|(a, b)| a == b).count();
    chains.map(|c| c[common..].iter().map(|j| j.coordinate).collect())
}

/// The parts whose joints are the two coordinates, if none were named.
fn own_joints(m: &Mechanism, system: &System, parts: [usize; 2]) -> Result<[usize; 2], Error> {
    let names = parts.map(|p| m.parts[p].name.as_str());
    let [a, b] = rests(system, parts);
    let found = match (a.as_slice(), b.as_slice()) {
        ([.., p], [.., q]) => Some([joint_of(m, parts[0], *p), joint_of(m, parts[1], *q)]),
        ([.., next, p], []) => Some([joint_of(m, parts[0], *p), joint_of(m, parts[0], *next)]),
        ([], [.., next, q]) => Some([joint_of(m, parts[1], *next), joint_of(m, parts[1], *q)]),
        _ => None,
    };
    match found {
        Some([Some(p), Some(q)]) => Ok([p, q]),
        _ if a.is_empty() && b.is_empty() => fault(
            "cspace",
            format!(
                "{} and {} never move against each other; expected two parts that do",
                names[0], names[1]
            ),
        ),
        _ => fault(
            "cspace",
            format!(
                "{} and {} move against each other with one joint only; expected two parts with a joint each",
                names[0], names[1]
            ),
        ),
    }
}

/// The part among `part` and what carries it whose own joint moves by a coordinate.
fn joint_of(m: &Mechanism, part: usize, coordinate: usize) -> Option<usize> {
    let mut at = Some(part);
    for _ in 0..=m.parts.len() {
        let p = at?;
        if m.subsystem_of(p).is_some_and(|(c, _)| c == coordinate) {
            return Some(p);
        }
        at = m.parts[p].carrier;
    }
    None
}

fn axis(m: &Mechanism, system: &System, part: usize) -> Result<SpaceAxis, Error> {
    let name = m.parts[part].name.clone();
    let Some((coordinate, ratio)) = m.subsystem_of(part) else {
        return fault(
            "--coordinates",
            format!("{name} has no joint of its own; expected a part that turns or slides"),
        );
    };
    let start = system.coordinates[coordinate].position * ratio;
    Ok(SpaceAxis { name, part, coordinate, ratio, turns: !m.slides(part), start })
}

fn check_axes(m: &Mechanism, system: &System, parts: [usize; 2], axes: &[SpaceAxis; 2]) -> Result<(), Error> {
    let names = parts.map(|p| m.parts[p].name.as_str());
    if axes[0].coordinate == axes[1].coordinate {
        let message = format!(
            "{} and {} belong to one subsystem: one position gives the other; expected parts that move independently",
            axes[0].name, axes[1].name
        );
        return fault("cspace", message);
    }
    let rest = rests(system, parts).concat();
    for axis in axes {
        if !rest.contains(&axis.coordinate) {
            let message = format!(
                "the joint of {} does not move {} against {}; expected one that does",
                axis.name, names[0], names[1]
            );
            return fault("--coordinates", message);
        }
    }
    Ok(())
}

fn windows(
    m: &Mechanism,
    axes: &[SpaceAxis; 2],
    asked: &[(String, f64, f64)],
) -> Result<[Option<(f64, f64)>; 2], Error> {
    let mut found = [None, None];
    for (name, low, high) in asked {
        let p = part(m, "--window", name)?;
        let Some(k) = axes.iter().position(|a| a.part == p) else {
            let message = format!(
                "{} is no coordinate of this space; expected {} or {}",
                m.parts[p].name, axes[0].name, axes[1].name
            );
            return fault("--window", message);
        };
        if !(low.is_finite() && high.is_finite() && low < high) {
            let message =
                format!("the window of {name} is {low} to {high}; expected its end above its start");
            return fault("--window", message);
        }
        let (a, b) = (low / axes[k].ratio, high / axes[k].ratio);
        found[k] = Some((a.min(b), a.max(b)));
    }
    Ok(found)
}

fn hold(m: &Mechanism, axes: &[SpaceAxis; 2], name: &str, x: f64) -> Result<(usize, f64), Error> {
    let p = part(m, "--hold", name)?;
    let Some((coordinate, ratio)) = m.subsystem_of(p) else {
        return fault(
            "--hold",
            format!("{} has no joint to hold; expected a part that moves", m.parts[p].name),
        );
    };
    if axes.iter().any(|a| a.coordinate == coordinate) {
        let message =
            format!("{} is a coordinate of this space; expected a joint beside the two", m.parts[p].name);
        return fault("--hold", message);
    }
    if !x.is_finite() {
        return fault("--hold", format!("the position of {name} is {x}; expected a finite number"));
    }
    Ok((coordinate, x / ratio))
}

/// A refusal of the map in words.
pub(crate) fn told(error: &SpaceError, axes: &[SpaceAxis; 2], names: [&str; 2]) -> Error {
    let [a, b] = names;
    let (option, message) = match error {
        SpaceError::Window { coordinate, reason } => {
            let of = axes.iter().find(|x| x.name == *coordinate).map_or(coordinate, |x| &x.name);
            ("--window", format!("window of {of}: {reason}; expected --window {of}=LOW:HIGH"))
        }
        SpaceError::MovesTwice { coordinate, .. } => (
            "cspace",
            format!(
                "{coordinate} moves {a} against {b} through more than one joint; expected one joint for each"
            ),
        ),
        SpaceError::Stopped => ("cspace", "stopped before the map was made; expected time for it".into()),
        SpaceError::TooComplex { budget } => {
            ("cspace", format!("more than {budget} cells, curves or crossings; expected a smaller window"))
        }
        SpaceError::Degenerate { at: [q, p] } => {
            let (x, y) = (q * axes[0].ratio, p * axes[1].ratio);
            let place = format!("{} = {x}, {} = {y}", axes[0].name, axes[1].name);
            (
                "cspace",
                format!(
                    "contacts of {a} and {b} too close to each other to tell free from blocked near {place}; expected clearances above rounding"
                ),
            )
        }
        SpaceError::Thin { .. } => ("cspace", format!("{error}; expected parts of some width")),
        SpaceError::NotFinite { .. } => ("cspace", format!("{error}; expected finite numbers")),
        other => ("cspace", format!("{other}; expected two parts that move independently")),
    };
    Error { file: option.into(), line: 1, column: 1, message }
}
