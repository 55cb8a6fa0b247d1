//! What a part's table says beside its shape: motion, inertia, what acts, limits, start, marks.

use super::fields::{Fields, Node};
use super::lowering::Lowering;
use super::{Acting, DriveText, MassText, MotionKindText, MotionText};
use crate::error::{Fault, Read, quote};
use crate::limits::TABLE_POINTS;
use crate::names;

/// Keys of a part's table that tell what acts on it.
pub(crate) const ACTING: [&str; 13] = [
    "motion",
    "inertia",
    "friction",
    "spring",
    "torque",
    "force",
    "dry_friction",
    "drive",
    "limits",
    "mass",
    "position",
    "velocity",
    "marks",
];

/// The names of all parts, and which is the frame.
pub(crate) struct Names<'a> {
    pub parts: Vec<&'a str>,
    pub frame: usize,
}

impl Names<'_> {
    /// The part a text names; `frame` is the frame whatever its name.
    pub fn find(&self, node: &Node<'_>, what: &str) -> Read<usize> {
        let name = node.words(what, crate::limits::NAME_CHARACTERS)?;
        let known = self.parts.iter().position(|p| p.eq_ignore_ascii_case(&name));
        match known {
            Some(i) => Ok(i),
            None if name.eq_ignore_ascii_case("frame") => Ok(self.frame),
            None => {
                let expected = names::one_of(&self.parts, &name);
                Err(node.fault(format!("no part is named {}; expected {expected}", quote(&name))))
            }
        }
    }
}

pub(crate) fn acting(
    part: usize,
    fields: &Fields<'_>,
    names: &Names<'_>,
    lower: &Lowering<'_>,
) -> Read<Acting> {
    let name = names.parts[part];
    if part == names.frame {
        let stray = ACTING.into_iter().find_map(|k| Some((k, fields.get(k)?)));
        if let Some((key, node)) = stray {
            return Err(
                node.fault(format!("a {key} of the frame, which does not move; expected a moving part"))
            );
        }
    }
    let one = |key: &str| fields.get(key).map(|n| lower.expression(&n, key)).transpose();
    Ok(Acting {
        place: fields.place,
        motion: fields.get("motion").map(|n| motion(part, &n, names, lower)).transpose()?,
        inertia: one("inertia")?,
        friction: one("friction")?,
        spring: fields.get("spring").map(|n| spring(&n, lower)).transpose()?,
        torque: one("torque")?,
        force: both(name, fields, "torque", "force").and_then(|()| one("force"))?,
        dry_friction: one("dry_friction")?,
        drive: fields.get("drive").map(|n| drive(&n, lower).map(|d| (d, n.place))).transpose()?,
        limits: fields.get("limits").map(|n| limits(&n, lower).map(|l| (l, n.place))).transpose()?,
        mass: fields.get("mass").map(|n| mass(&n, lower)).transpose()?,
        position: one("position")?,
        velocity: one("velocity")?,
        marks: fields.get("marks").map_or(Ok(vec![]), |n| marks(&n, lower))?,
    })
}

fn both(part: &str, fields: &Fields<'_>, a: &str, b: &str) -> Read<()> {
    match (fields.get(a), fields.get(b)) {
        (Some(_), Some(n)) => Err(n.fault(format!("{part} has a {a} and a {b}; expected one of them"))),
        _ => Ok(()),
    }
}

fn motion(part: usize, node: &Node<'_>, names: &Names<'_>, lower: &Lowering<'_>) -> Read<MotionText> {
    let fields = node.table("motion")?;
    fields.allow("motion", &["turns", "slides", "fixed", "on"])?;
    let carrier = fields.get("on").map_or(Ok(names.frame), |n| names.find(&n, "on"))?;
    if carrier == part {
        let message = format!("{} on itself; expected the part that carries it", names.parts[part]);
        return Err(node.fault(message));
    }
    let kind = match (fields.get("turns"), fields.get("slides"), fields.get("fixed")) {
        (Some(n), None, None) => MotionKindText::Turns(lower.pair(&n, "turns")?),
        (None, Some(n), None) => MotionKindText::Slides(lower.pair(&n, "slides")?),
        (None, None, Some(n)) if n.flag("fixed")? => MotionKindText::Fixed,
        _ => {
            let message = "a motion without a kind; expected one of `turns = [x, y]`, `slides = [dx, dy]`, `fixed = true`";
            return Err(node.fault(message));
        }
    };
    Ok(MotionText { carrier, kind, place: node.place })
}

fn spring(node: &Node<'_>, lower: &Lowering<'_>) -> Read<[crate::Expression; 2]> {
    let fields = node.table("spring")?;
    fields.allow("spring", &["relaxed", "constant"])?;
    let relaxed = lower.expression(&fields.need("relaxed", "spring")?, "relaxed")?;
    Ok([relaxed, lower.expression(&fields.need("constant", "spring")?, "constant")?])
}

fn drive(node: &Node<'_>, lower: &Lowering<'_>) -> Read<DriveText> {
    let fields = node.table("drive")?;
    fields.allow("drive", &["speed", "table"])?;
    match (fields.get("speed"), fields.get("table")) {
        (Some(n), None) => Ok(DriveText::Speed(lower.expression(&n, "speed")?)),
        (None, Some(n)) => {
            let rows = n.list("table")?;
            if !(2..=TABLE_POINTS).contains(&rows.len()) {
                let message = format!("the table has {} points; expected 2 to {TABLE_POINTS}", rows.len());
                return Err(n.fault(message));
            }
            let row = |r: &Node<'_>| lower.pair(r, "a point of the table, [time, position],");
            Ok(DriveText::Table(rows.iter().map(row).collect::<Read<_>>()?))
        }
        _ => Err(node.fault("a drive needs either `speed` or `table`; expected one of them")),
    }
}

/// `[low, high]`, or a table with one or both.
fn limits(node: &Node<'_>, lower: &Lowering<'_>) -> Read<[Option<crate::Expression>; 2]> {
    if !node.is_table() {
        return Ok(lower.pair(node, "limits")?.map(Some));
    }
    let fields = node.table("limits")?;
    fields.allow("limits", &["low", "high"])?;
    let one = |key: &str| fields.get(key).map(|n| lower.expression(&n, key)).transpose();
    let ends = [one("low")?, one("high")?];
    if ends.iter().all(Option::is_none) {
        return Err(node.fault("limits without an end; expected `low`, `high` or both"));
    }
    Ok(ends)
}

fn mass(node: &Node<'_>, lower: &Lowering<'_>) -> Read<MassText> {
    let fields = node.table("mass")?;
    fields.allow("mass", &["value", "center", "inertia"])?;
    Ok(MassText {
        mass: lower.expression(&fields.need("value", "mass")?, "value")?,
        center: lower.several(&fields.need("center", "mass")?, "center", 2, 3)?,
        inertia: fields.get("inertia").map(|n| lower.expression(&n, "inertia")).transpose()?,
        place: node.place,
    })
}

fn marks(node: &Node<'_>, lower: &Lowering<'_>) -> Read<Vec<(String, crate::Expression)>> {
    let fields = node.table("marks")?;
    let mut found = Vec::new();
    for (key, place) in fields.keys() {
        super::syntax::check_word(key, place)?;
        let node = fields.get(key).ok_or_else(|| Fault::new(place, "no value; expected one"))?;
        found.push((key.to_string(), lower.expression(&node, key)?));
    }
    Ok(found)
}
