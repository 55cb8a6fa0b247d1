//! A machine at given values: drawn parts become walls, expressions beside the shapes become numbers.

use super::{Acting, DriveText, MotionKindText, Native};
use crate::error::{Error, Fault, Place, Read, number};
use crate::expression::{Expression, NumOp};
use crate::limits::PRIMITIVES;
use crate::machine::Machine;
use crate::profile::{EdgeText, LoopShape, LoopText, Profile};
use crate::supplement::{
    ContactData, DriveData, DriveKind, ForceData, GearPairData, GravityData, Mark, MassData, MotionData,
    MotionKind, PairData, PartNumber, Spring, StopData, Supplement,
};
use crate::values::Values;
use mainspring_geometry::{Csg, CsgOp, Primitive, Scalar, Vec2};

/// A stated motion over any scalar, in the plane z = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MotionOver<S> {
    Turns { center: Vec2<S> },
    Slides { direction: Vec2<S> },
    Fixed,
}

impl Machine {
    /// The machine with the structure and the supplement that follow from `values`: numbers of repeated pieces and
    /// copies, which way boundaries run, motions, what acts. A machine in PADL is itself.
    ///
    /// # Errors
    /// Boundaries that are open, cross or bound nothing, numbers out of their ranges.
    pub fn at(&self, values: &Values<f64>) -> Result<Machine, Error> {
        let Some(native) = self.native.clone() else { return Ok(self.clone()) };
        let mut machine = self.clone();
        machine.wall_texts.clear();
        for (i, profile) in native.profiles.iter().enumerate() {
            let Some(profile) = profile else { continue };
            let drawn = self.explained(profile, &values.numbers, false, profile.draw(&values.numbers))?;
            self.explained(profile, &values.numbers, true, profile.check(&drawn))?;
            let first = machine.primitive_count() as u32;
            let (layers, texts) = profile.walls(&drawn, first);
            machine.parts[i].csg = union(first, texts.len() as u32);
            machine.parts[i].walls = Some(layers);
            machine.wall_texts.extend(texts);
            if machine.primitive_count() > PRIMITIVES {
                let message = format!(
                    "the parts together have {} edges and primitives; expected at most {PRIMITIVES}",
                    machine.primitive_count()
                );
                return Err(self.error(self.parts[i].place, message));
            }
        }
        machine.supplement = self.named(supplement(&native, self, &values.numbers))?;
        Ok(machine)
    }

    /// The primitives of drawn parts, after those of the solids.
    pub(crate) fn add_walls<S: Scalar>(
        &self,
        numbers: &[S],
        primitives: &mut Vec<Primitive<S>>,
    ) -> Result<(), Error> {
        let Some(native) = &self.native else { return Ok(()) };
        for profile in native.profiles.iter().flatten() {
            let walls = profile.primitives(numbers);
            primitives.extend(self.explained(profile, numbers, false, walls)?);
        }
        Ok(())
    }

    /// The stated motion of a part over any scalar; none if it is left to be found.
    pub fn stated_motion<S: Scalar>(
        &self,
        part: usize,
        values: &Values<S>,
    ) -> Result<Option<MotionOver<S>>, Error> {
        let native = self.native.as_ref();
        let Some(motion) = native.and_then(|n| n.acting.get(part)?.motion.as_ref()) else { return Ok(None) };
        let point = |p: &[Expression; 2]| -> Read<Vec2<S>> {
            Ok(Vec2::new(p[0].evaluate(&values.numbers)?, p[1].evaluate(&values.numbers)?))
        };
        let found = match &motion.kind {
            MotionKindText::Turns(p) => point(p).map(|center| MotionOver::Turns { center }),
            MotionKindText::Slides(d) => point(d).map(|direction| MotionOver::Slides { direction }),
            MotionKindText::Fixed => Ok(MotionOver::Fixed),
        };
        self.named(found).map(Some)
    }

    /// Adds to an error about a boundary which part, loop and segment it is about, and the parameters behind it: those
    /// of the segment, or of its `whole` loop; likewise for the other place that has a share in it.
    fn explained<T, S: Scalar>(
        &self,
        profile: &Profile,
        numbers: &[S],
        whole: bool,
        result: Read<T>,
    ) -> Result<T, Error> {
        result.map_err(|fault| {
            let mut message = fault.message;
            let mut used = match find(profile, fault.place) {
                Some((l, edge)) => {
                    if !message.starts_with("part ") {
                        let at = edge
                            .map_or(String::new(), |(i, e)| format!(", segment {} ({})", i + 1, e.word()));
                        message = format!("part {}, {}{at}: {message}", profile.part, l.name);
                    }
                    around(l, edge.map(|e| e.0).filter(|_| !whole))
                }
                None => profile.layers.iter().flat_map(|l| l.z.iter().flatten()).collect(),
            };
            if let Some((l, edge)) = fault.also.and_then(|place| find(profile, place)) {
                used.extend(around(l, edge.map(|e| e.0).filter(|_| !whole)));
            }
            message += &self.causes(&used, numbers);
            self.error(fault.place, message)
        })
    }

    /// The parameters that some expressions come from, with their values: those written as numbers.
    pub(crate) fn causes<S: Scalar>(&self, used: &[&Expression], numbers: &[S]) -> String {
        let of = |e: &Expression| -> Vec<u32> {
            e.ops.iter().filter_map(|op| if let NumOp::Value(i) = op { Some(*i) } else { None }).collect()
        };
        let mut queue: Vec<u32> = used.iter().flat_map(|e| of(e)).collect();
        let (mut seen, mut ends) = (vec![false; self.parameters.len()], Vec::new());
        while let Some(i) = queue.pop() {
            if std::mem::replace(&mut seen[i as usize], true) {
                continue;
            }
            let below = self.definitions[i as usize].as_ref().map_or(vec![], of);
            if below.is_empty() {
                ends.push(i as usize);
            }
            queue.extend(below);
        }
        ends.sort_unstable();
        let value = |i: &usize| format!("{} = {}", self.parameters[*i].name, number(numbers[*i].re()));
        let (mut told, mut length) = (Vec::new(), 0);
        for text in ends.iter().map(value) {
            length += text.len();
            if told.len() == CAUSES || length > CAUSE_BYTES {
                told.push("…".to_string());
                break;
            }
            told.push(text);
        }
        if told.is_empty() { String::new() } else { format!(" (with {})", told.join(", ")) }
    }
}

/// Parameters told in a message.
const CAUSES: usize = 6;
/// Bytes of that.
const CAUSE_BYTES: usize = 90;

fn union(first: u32, count: u32) -> Csg {
    let leaf = |i: u32| {
        let join = (i > 0).then_some(CsgOp::Union);
        std::iter::once(CsgOp::Leaf(first + i)).chain(join)
    };
    Csg { ops: (0..count).flat_map(leaf).collect() }
}

/// The loop, and the edge of it, that a place is in.
fn find(profile: &Profile, place: Place) -> Option<(&LoopText, Option<(usize, &EdgeText)>)> {
    let loops = || profile.layers.iter().flat_map(|l| &l.loops);
    let within = |e: &EdgeText| e.place == place || e.expressions().iter().any(|x| x.place == place);
    for l in loops() {
        if let LoopShape::Path { edges, .. } = &l.shape
            && let Some(i) = edges.iter().position(within)
        {
            return Some((l, Some((i, &edges[i]))));
        }
    }
    loops().find(|l| l.place == place || l.expressions().iter().any(|x| x.place == place)).map(|l| (l, None))
}

/// What an edge is made of, or a whole loop.
fn around(l: &LoopText, edge: Option<usize>) -> Vec<&Expression> {
    match (&l.shape, edge) {
        (LoopShape::Path { from, edges, .. }, Some(i)) => {
            let before = if i == 0 { Some(from) } else { edges[i - 1].to.as_ref() };
            let mut used = edges[i].expressions();
            used.extend(before.into_iter().flatten());
            used
        }
        _ => l.expressions(),
    }
}

/// Numbers at given values, one part after the other.
struct At<'a> {
    machine: &'a Machine,
    numbers: &'a [f64],
}

fn supplement(native: &Native, machine: &Machine, numbers: &[f64]) -> Read<Supplement> {
    let at = At { machine, numbers };
    let mut s = Supplement::default();
    for (part, acting) in native.acting.iter().enumerate() {
        at.part(part, acting, &mut s)?;
    }
    for gear in &native.gears {
        let teeth = [at.teeth(&gear.teeth[0])?, at.teeth(&gear.teeth[1])?];
        s.gears.push(GearPairData { parts: gear.parts, teeth, internal: gear.internal, place: gear.place });
    }
    if let Some((field, place)) = &native.gravity {
        let mut values = [0.0; 3];
        for (v, e) in values.iter_mut().zip(field) {
            *v = e.as_ref().map_or(Ok(0.0), |e| e.evaluate(numbers))?;
        }
        s.gravity = Some(GravityData { field: values, place: *place });
    }
    if let Some(([e, d, m], place)) = &native.contact {
        let one = |x: &Expression, what| at.not_negative(x, what);
        s.contact =
            Some(ContactData { e: at.positive(e, "E")?, d: one(d, "D")?, m: one(m, "M")?, place: *place });
    }
    Ok(s)
}

impl At<'_> {
    fn value(&self, e: &Expression) -> Read<f64> {
        e.evaluate(self.numbers)
    }

    fn maybe(&self, e: Option<&Expression>) -> Read<Option<f64>> {
        e.map(|e| self.value(e)).transpose()
    }

    fn positive(&self, e: &Expression, what: &str) -> Read<f64> {
        let x = self.value(e)?;
        if x > 0.0 {
            return Ok(x);
        }
        Err(Fault::new(e.place, format!("the {what} is {}; expected a positive number", number(x))))
    }

    fn not_negative(&self, e: &Expression, what: &str) -> Read<f64> {
        let x = self.value(e)?;
        if x >= 0.0 {
            return Ok(x);
        }
        let message = format!("the {what} is {}; expected zero or a positive number", number(x));
        Err(Fault::new(e.place, message))
    }

    fn teeth(&self, e: &Expression) -> Read<u32> {
        let x = self.value(e)?;
        if x.fract() == 0.0 && (1.0..=1e6).contains(&x) {
            return Ok(x as u32);
        }
        let message = format!("{} teeth; expected a whole number from 1 to 1000000", number(x));
        Err(Fault::new(e.place, message))
    }

    fn part(&self, part: usize, acting: &Acting, s: &mut Supplement) -> Read<()> {
        self.motion(part, acting, s)?;
        self.pair(part, acting, s)?;
        let number = |e: &Expression| self.value(e).map(|value| PartNumber { part, value, place: e.place });
        s.positions.extend(acting.position.as_ref().map(number).transpose()?);
        s.velocities.extend(acting.velocity.as_ref().map(number).transpose()?);
        for (e, torque) in [(&acting.torque, true), (&acting.force, false)] {
            if let Some(e) = e {
                s.forces.push(ForceData { part, value: self.value(e)?, torque, place: e.place });
            }
        }
        if let Some(e) = &acting.dry_friction {
            let value = self.not_negative(e, "dry friction")?;
            s.coulomb.push(PartNumber { part, value, place: e.place });
        }
        if let Some((drive, place)) = &acting.drive {
            s.drives.push(DriveData { part, kind: self.drive(drive, *place)?, place: *place });
        }
        if let Some((ends, place)) = &acting.limits {
            let (low, high) = (self.maybe(ends[0].as_ref())?, self.maybe(ends[1].as_ref())?);
            if low.zip(high).is_some_and(|(l, h)| l >= h) {
                let told = [low, high].map(|x| crate::error::number(x.unwrap_or(0.0)));
                let message = format!("limits from {} to {}; expected low < high", told[0], told[1]);
                return Err(Fault::new(*place, message));
            }
            s.stops.push(StopData { part, low, high, place: *place });
        }
        self.mass(part, acting, s)?;
        for (name, e) in &acting.marks {
            s.marks.push(Mark { part, name: name.clone(), value: self.value(e)?, place: e.place });
        }
        Ok(())
    }

    fn motion(&self, part: usize, acting: &Acting, s: &mut Supplement) -> Read<()> {
        let Some(motion) = &acting.motion else { return Ok(()) };
        let point = |p: &[Expression; 2]| -> Read<[f64; 2]> { Ok([self.value(&p[0])?, self.value(&p[1])?]) };
        let kind = match &motion.kind {
            MotionKindText::Turns(p) => MotionKind::Turns { center: point(p)? },
            MotionKindText::Slides(d) => {
                let direction = point(d)?;
                if !direction[0].hypot(direction[1]).is_normal() {
                    let message = "it slides along a direction of no length; expected another direction";
                    return Err(Fault::new(motion.place, message));
                }
                MotionKind::Slides { direction }
            }
            MotionKindText::Fixed => MotionKind::Fixed,
        };
        s.motions.push(MotionData { part, carrier: motion.carrier, kind, place: motion.place });
        Ok(())
    }

    fn pair(&self, part: usize, acting: &Acting, s: &mut Supplement) -> Read<()> {
        let first = acting.inertia.as_ref().or(acting.friction.as_ref());
        let Some(first) = first.or(acting.spring.as_ref().map(|s| &s[1])) else { return Ok(()) };
        let inertia = acting.inertia.as_ref().map(|e| self.positive(e, "inertia")).transpose()?;
        let weighs = self.machine.parts[part].density.is_some() || acting.mass.is_some();
        if inertia.is_none() && !weighs {
            let name = &self.machine.parts[part].name;
            let message = format!(
                "{name} has friction or a spring and no inertia; expected `inertia`, `mass` or `density`"
            );
            return Err(Fault::new(first.place, message));
        }
        let friction = acting.friction.as_ref().map_or(Ok(0.0), |e| self.not_negative(e, "friction"))?;
        let spring = match &acting.spring {
            None => None,
            Some([relaxed, constant]) => Some(Spring {
                relaxed: self.value(relaxed)?,
                constant: self.not_negative(constant, "spring constant")?,
            }),
        };
        let other = acting.motion.as_ref().map_or(part, |m| m.carrier);
        let number = first.place;
        s.pairs.push(PairData { part, other, inertia, friction, spring, place: acting.place, number });
        Ok(())
    }

    fn mass(&self, part: usize, acting: &Acting, s: &mut Supplement) -> Read<()> {
        let Some(text) = &acting.mass else { return Ok(()) };
        let mut center = [0.0; 3];
        for (c, e) in center.iter_mut().zip(&text.center) {
            *c = self.value(e)?;
        }
        let inertia = text.inertia.as_ref().map(|e| self.positive(e, "inertia")).transpose()?;
        let mass = self.positive(&text.mass, "mass")?;
        s.masses.push(MassData { part, mass, center, inertia, place: text.place });
        Ok(())
    }

    fn drive(&self, drive: &DriveText, place: Place) -> Read<DriveKind> {
        match drive {
            DriveText::Speed(e) => Ok(DriveKind::Speed(self.value(e)?)),
            DriveText::Table(rows) => {
                let row = |r: &[Expression; 2]| Ok((self.value(&r[0])?, self.value(&r[1])?));
                let table: Vec<(f64, f64)> = rows.iter().map(row).collect::<Read<_>>()?;
                if table.windows(2).any(|w| w[1].0 <= w[0].0) {
                    let message =
                        "the times of the table do not grow; expected each later than the one before";
                    return Err(Fault::new(place, message));
                }
                Ok(DriveKind::Table(table))
            }
        }
    }
}
