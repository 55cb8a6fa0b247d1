//! The tables of layers, loops and their edges.

use super::fields::{Fields, Node};
use super::lowering::Lowering;
use crate::error::Read;
use crate::limits::PRIMITIVES;
use crate::profile::{EdgeKind, EdgeText, LayerText, LoopShape, LoopText, Profile, Repeat};

/// Keys of a part's table that draw it.
pub(crate) const DRAWING: [&str; 6] = ["outer", "inner", "z", "layers", "at", "turn"];

/// The drawing of a part, if there is one.
pub(crate) fn profile(part: &str, fields: &Fields<'_>, lower: &Lowering<'_>) -> Read<Option<Profile>> {
    let drawn = DRAWING.into_iter().find_map(|k| fields.get(k));
    let Some(first) = drawn else { return Ok(None) };
    if fields.get("solid").is_some() {
        return Err(first.fault(format!("part {part} has a solid and is drawn; expected one of them")));
    }
    let layers = match fields.get("layers") {
        Some(list) if fields.get("outer").or(fields.get("inner")).or(fields.get("z")).is_some() => {
            return Err(list.fault(format!(
                "part {part} has layers and boundaries of its own; expected all boundaries in its layers"
            )));
        }
        Some(list) => list.list("layers")?.iter().map(|n| inner_layer(n, lower)).collect::<Read<Vec<_>>>()?,
        None => vec![layer(fields, lower)?],
    };
    let at = fields.get("at").map(|n| lower.pair(&n, "at")).transpose()?;
    let turn = fields.get("turn").map(|n| lower.expression(&n, "turn")).transpose()?;
    if layers.iter().all(|l| l.loops.is_empty()) {
        return Err(first.fault(format!("part {part} has no boundary; expected `outer`")));
    }
    Ok(Some(Profile { part: part.to_string(), layers, at, turn }))
}

fn inner_layer(node: &Node<'_>, lower: &Lowering<'_>) -> Read<LayerText> {
    let fields = node.table("a layer")?;
    fields.allow("a layer", &["outer", "inner", "z"])?;
    layer(&fields, lower)
}

fn layer(fields: &Fields<'_>, lower: &Lowering<'_>) -> Read<LayerText> {
    let z = fields.get("z").map(|n| lower.pair(&n, "z")).transpose()?;
    let mut loops = Vec::new();
    for (key, hole) in [("outer", false), ("inner", true)] {
        let Some(node) = fields.get(key) else { continue };
        let list = if node.is_table() { vec![node] } else { node.list(key)? };
        for (i, n) in list.iter().enumerate() {
            loops.push(boundary(n, format!("{key} {}", i + 1), hole, lower)?);
        }
    }
    let place = fields.get("outer").or(fields.get("z")).map_or(fields.place, |n| n.place);
    Ok(LayerText { z, loops, place })
}

fn boundary(node: &Node<'_>, name: String, hole: bool, lower: &Lowering<'_>) -> Read<LoopText> {
    let fields = node.table(&name)?;
    fields.allow(&name, &["circle", "path", "repeat", "copies", "about"])?;
    let about = || fields.get("about").map(|n| lower.pair(&n, "about")).transpose();
    let repeat = |key: &str| -> Read<Option<Repeat>> {
        let Some(n) = fields.get(key) else { return Ok(None) };
        Ok(Some(Repeat { count: lower.expression(&n, key)?, about: about()? }))
    };
    let (pieces, copies) = (repeat("repeat")?, repeat("copies")?);
    if let Some(n) = fields.get("about").filter(|_| pieces.is_none() && copies.is_none()) {
        return Err(n.fault(format!("{name} has `about` alone; expected `repeat` or `copies` as well")));
    }
    let shape = match (fields.get("circle"), fields.get("path")) {
        (Some(n), None) => {
            if let Some(r) = fields.get("repeat") {
                return Err(r.fault("a circle in pieces; expected `copies`, or a path"));
            }
            circle(&n, lower)?
        }
        (None, Some(n)) => path(&n, &name, pieces, lower)?,
        _ => return Err(node.fault(format!("{name} is no boundary; expected either `path` or `circle`"))),
    };
    Ok(LoopText { name, hole, shape, copies, place: node.place })
}

fn circle(node: &Node<'_>, lower: &Lowering<'_>) -> Read<LoopShape> {
    let fields = node.table("circle")?;
    fields.allow("circle", &["center", "radius"])?;
    let center = lower.pair(&fields.need("center", "circle")?, "center")?;
    let radius = lower.expression(&fields.need("radius", "circle")?, "radius")?;
    Ok(LoopShape::Circle { center, radius })
}

fn path(node: &Node<'_>, name: &str, repeat: Option<Repeat>, lower: &Lowering<'_>) -> Read<LoopShape> {
    let list = node.list("path")?;
    let Some((first, rest)) = list.split_first() else {
        return Err(node.fault(format!("the path of {name} is empty; expected {{ from = [x, y] }} first")));
    };
    if rest.is_empty() || rest.len() > PRIMITIVES {
        let message =
            format!("the path of {name} has {} edges; expected at least 1, at most {PRIMITIVES}", rest.len());
        return Err(node.fault(message));
    }
    let start = first.table("the start of a path")?;
    start.allow("the start of a path", &["from", "fillet"])?;
    let from = lower.pair(&start.need("from", "the start of a path")?, "from")?;
    let from_fillet = start.get("fillet").map(|n| lower.expression(&n, "fillet")).transpose()?;
    let edges = rest.iter().map(|n| edge(n, lower)).collect::<Read<Vec<_>>>()?;
    let last = edges.len() - 1;
    if let Some(i) = edges[..last].iter().position(|e| e.to.is_none()) {
        return Err(rest[i].fault("`close` before the end of the path; expected it as the last edge"));
    }
    if repeat.is_some() && edges[last].to.is_none() {
        return Err(rest[last].fault("`close` in a repeated piece; expected a line to where the next begins"));
    }
    Ok(LoopShape::Path { from, from_fillet, edges, repeat })
}

const EDGE: [&str; 8] = ["line", "arc", "close", "radius", "center", "turn", "large", "fillet"];

fn edge(node: &Node<'_>, lower: &Lowering<'_>) -> Read<EdgeText> {
    let fields = node.table("an edge of a path")?;
    fields.allow("an edge of a path", &EDGE)?;
    let fillet = fields.get("fillet").map(|n| lower.expression(&n, "fillet")).transpose()?;
    let place = node.place;
    let stray = |keys: &[&str], of: &str| match keys.iter().find_map(|k| Some((*k, fields.get(k)?))) {
        Some((key, n)) => Err(n.fault(format!("`{key}` on {of}; expected it on an arc"))),
        None => Ok(()),
    };
    match (fields.get("line"), fields.get("arc"), fields.get("close")) {
        (Some(to), None, None) => {
            stray(&["radius", "center", "turn", "large"], "a line")?;
            Ok(EdgeText { kind: EdgeKind::Line, to: Some(lower.pair(&to, "line")?), fillet, place })
        }
        (None, Some(to), None) => {
            let kind = arc(node, &fields, lower)?;
            Ok(EdgeText { kind, to: Some(lower.pair(&to, "arc")?), fillet, place })
        }
        (None, None, Some(close)) => {
            if !close.flag("close")? {
                return Err(close.fault("`close` is false; expected true, or a line or arc"));
            }
            let curved = ["radius", "center"].into_iter().any(|k| fields.get(k).is_some());
            let kind = if curved {
                arc(node, &fields, lower)?
            } else {
                stray(&["turn", "large"], "a line")?;
                EdgeKind::Line
            };
            Ok(EdgeText { kind, to: None, fillet, place })
        }
        _ => Err(node.fault("an edge without a kind; expected one of `line`, `arc`, `close`")),
    }
}

fn arc(node: &Node<'_>, fields: &Fields<'_>, lower: &Lowering<'_>) -> Read<EdgeKind> {
    let turn = fields.need("turn", "an arc")?;
    let left = match turn.value().and_then(toml_edit::Value::as_str) {
        Some("left") => true,
        Some("right") => false,
        _ => {
            let message = "`turn` is neither; expected \"left\" (counterclockwise) or \"right\"";
            return Err(turn.fault(message));
        }
    };
    let large = fields.get("large");
    match (fields.get("radius"), fields.get("center")) {
        (Some(r), None) => {
            let large = large.map(|n| n.flag("large")).transpose()?.unwrap_or(false);
            Ok(EdgeKind::Radius { radius: lower.expression(&r, "radius")?, left, large })
        }
        (None, Some(c)) => match large {
            Some(n) => Err(n.fault("`large` on an arc about a centre; expected it with `radius`")),
            None => Ok(EdgeKind::Center { center: lower.pair(&c, "center")?, left }),
        },
        _ => Err(node.fault("an arc needs either `radius` or `center`; expected one of them")),
    }
}
