//! Two pose chains and two coordinates brought to two bodies that one joint moves each.
//!
//! Joints that both chains begin with cancel. What is left is a product of constant motions and two live joints.
//! A joint J after a constant C acts as `C J C⁻¹` on a body placed by C. If both live joints are in one chain, the
//! outer one is undone on the other body instead: `A = C₀ J₁ C₁ J₂ C₂` against B is `C₀C₁ J₂ C₂` against `C₀ J₁⁻¹ C₀⁻¹ B`.

use crate::error::SpaceError;
use crate::moving::{Kind, Moving};
use mainspring_geometry::Vec2;
use mainspring_mechanism::{Joint, Motion, Pose, System};

/// Two bodies, each moved by one coordinate.
#[derive(Clone, Debug)]
pub(crate) struct Reduced {
    /// The body that the first coordinate moves, and the other.
    pub bodies: [usize; 2],
    pub moving: [Moving; 2],
}

/// A live joint of a chain with the constant motions before and after it.
struct Live {
    joint: Joint,
    before: Pose,
    after: Pose,
}

pub(crate) fn inverse(p: &Pose) -> Pose {
    let turn = Pose { cos: p.cos, sin: -p.sin, shift: Vec2::default() };
    Pose { shift: -turn.rotate(p.shift), ..turn }
}

/// second_from_first of two placed bodies.
pub(crate) fn relative(first: &Pose, second: &Pose) -> Pose {
    inverse(second).then_after(first)
}

pub(crate) fn reduce(
    system: &System,
    bodies: [usize; 2],
    coordinates: [usize; 2],
    held: &[(usize, f64)],
) -> Result<Reduced, SpaceError> {
    let names = || bodies.map(|b| system.bodies[b].name.clone());
    let chains = bodies.map(|b| system.bodies[b].chain.as_slice());
    let common = chains[0].iter().zip(chains[1]).take_while(|(a, b)| a == b).count();
    let rest = chains.map(|c| &c[common..]);
    for &c in &coordinates {
        if rest.iter().flat_map(|r| r.iter()).filter(|j| j.coordinate == c).count() > 1 {
            let coordinate = system.coordinates[c].name.clone();
            return Err(SpaceError::MovesTwice { bodies: names(), coordinate });
        }
    }
    let mut parts = Vec::new();
    for chain in rest {
        let split = split(chain, coordinates, held).map_err(|c| SpaceError::MoreFreedoms {
            bodies: names(),
            coordinate: system.coordinates[c].name.clone(),
        })?;
        parts.push(split);
    }
    let (second, first) = (parts.pop().unwrap_or_default(), parts.pop().unwrap_or_default());
    assemble(bodies, coordinates, [first, second]).ok_or_else(|| SpaceError::OneSubsystem { bodies: names() })
}

/// Live joints of a chain, and the whole constant motion if there are none. Err: a coordinate without value.
#[derive(Default)]
struct Split {
    live: Vec<Live>,
    constant: Option<Pose>,
}

fn split(chain: &[Joint], live: [usize; 2], held: &[(usize, f64)]) -> Result<Split, usize> {
    let mut found: Vec<Live> = Vec::new();
    let mut pose = Pose::identity();
    for joint in chain {
        if live.contains(&joint.coordinate) {
            found.push(Live { joint: *joint, before: pose, after: Pose::identity() });
            pose = Pose::identity();
            continue;
        }
        let value = held.iter().find(|(c, _)| *c == joint.coordinate).ok_or(joint.coordinate)?.1;
        let step = joint.motion.pose(value * joint.ratio);
        pose = pose.then_after(&step);
        if let Some(last) = found.last_mut() {
            last.after = pose;
        }
    }
    let constant = found.is_empty().then_some(pose);
    Ok(Split { live: found, constant })
}

fn assemble(bodies: [usize; 2], coordinates: [usize; 2], parts: [Split; 2]) -> Option<Reduced> {
    let [a, b] = parts;
    let (outer, inner) = match (a.live.as_slice(), b.live.as_slice()) {
        ([x], [y]) => (turned(x, 1.0, x.before, x.after), turned(y, 1.0, y.before, y.after)),
        ([x], []) => (turned(x, 1.0, x.before, x.after), still(b.constant?)),
        ([], [y]) => (still(a.constant?), turned(y, 1.0, y.before, y.after)),
        ([x, y], []) => {
            let before = x.before.then_after(&y.before);
            (turned(y, 1.0, before, y.after), undone(x, b.constant?))
        }
        ([], [x, y]) => {
            let before = x.before.then_after(&y.before);
            (undone(x, a.constant?), turned(y, 1.0, before, y.after))
        }
        _ => return None,
    };
    let moves_first = |m: &(Moving, Option<usize>), other: &(Moving, Option<usize>)| match m.1 {
        Some(c) => c == coordinates[0],
        None => other.1 != Some(coordinates[0]),
    };
    let in_order = moves_first(&outer, &inner);
    let mut moving = [outer.0, inner.0];
    let mut order = bodies;
    if !in_order {
        moving.swap(0, 1);
        order.swap(0, 1);
    }
    Some(Reduced { bodies: order, moving })
}

/// A body moved by `joint` of which the constant motions `before` and `after` are known.
fn turned(live: &Live, sense: f64, before: Pose, after: Pose) -> (Moving, Option<usize>) {
    (moving(&live.joint, sense, &before, before.then_after(&after)), Some(live.joint.coordinate))
}

/// A body against which the joint is undone.
fn undone(live: &Live, constant: Pose) -> (Moving, Option<usize>) {
    (moving(&live.joint, -1.0, &live.before, constant), Some(live.joint.coordinate))
}

fn still(constant: Pose) -> (Moving, Option<usize>) {
    let moving = Moving {
        kind: Kind::Still,
        center: Vec2::default(),
        sign: 1.0,
        direction: Vec2::default(),
        local: constant,
        ratio: 1.0,
    };
    (moving, None)
}

fn moving(joint: &Joint, sense: f64, before: &Pose, placed: Pose) -> Moving {
    let (ratio, sign) = (joint.ratio.abs(), sense * joint.ratio.signum());
    match joint.motion {
        Motion::Turn { center } => {
            let center = before.apply(center);
            let local = Pose { shift: placed.shift - center, ..placed };
            Moving { kind: Kind::Turn, center, sign, direction: Vec2::default(), local, ratio }
        }
        Motion::Slide { direction } => {
            let direction = before.rotate(direction).unit() * sign;
            // A direction that is no unit vector scales the motion.
            let ratio = ratio * before.rotate(joint_direction(joint)).norm();
            Moving { kind: Kind::Slide, center: Vec2::default(), sign, direction, local: placed, ratio }
        }
    }
}

fn joint_direction(joint: &Joint) -> Vec2 {
    match joint.motion {
        Motion::Slide { direction } => direction,
        Motion::Turn { .. } => Vec2::default(),
    }
}
