//! The initial state and what may touch: asked for after compiling.

use super::bounds::Bounds;
use super::mechanism::{Mechanism, Part};
use super::pair::PairKind;
use super::reach::{Parts, Placed};
use super::subsystems::Hold;
use mainspring_geometry::Csg;
use mainspring_model::Error;
use std::sync::OnceLock;

/// A part's joint position or velocity, in radians or the file's length.
pub type PartValue = (usize, f64);

/// Where a part keeps its position or velocity.
type Field = fn(&mut Part) -> &mut f64;

/// Values of gears in mesh are the same up to this, relative and absolute.
const SAME: f64 = 1e-9;

impl Mechanism {
    /// Does the part's joint slide (and not turn)?
    pub fn slides(&self, part: usize) -> bool {
        self.parts[part].joint.is_some_and(|j| self.pairs[j].kind == PairKind::Prismatic)
    }

    /// The same mechanism with other initial positions and velocities; parts geared to those named follow.
    ///
    /// # Errors
    /// A part without a joint or with a drive, values that contradict each other through gears, positions beyond a
    /// stop, parts that overlap in the new positions.
    pub fn starting_at(&self, positions: &[PartValue], velocities: &[PartValue]) -> Result<Self, Error> {
        let mut moved = self.clone();
        moved.whole = OnceLock::new();
        moved.set_all(positions, "position", |p| &mut p.position)?;
        moved.set_all(velocities, "velocity", |p| &mut p.velocity)?;
        if !positions.is_empty() {
            moved.check_stops()?;
            moved.check_start()?;
        }
        Ok(moved)
    }

    fn set_all(&mut self, values: &[PartValue], what: &str, field: Field) -> Result<(), Error> {
        for &(part, value) in values {
            self.refuse_prescribed(part, what)?;
            self.set(part, value, what, field)?;
        }
        // What was set last moved the gears in mesh with it; the others must agree.
        for &(part, value) in values {
            let part = &mut self.parts[part];
            if (*field(part) - value).abs() > SAME * (1.0 + value.abs()) {
                let name = &part.name;
                let message = format!("the {what} of {name} contradicts that of a gear in mesh with it");
                return Err(option_error(what, format!("{message}; expected values that agree")));
            }
        }
        Ok(())
    }

    fn refuse_prescribed(&self, part: usize, what: &str) -> Result<(), Error> {
        let Some((word, _)) = self.prescribed(part, what == "position") else { return Ok(()) };
        let name = &self.parts[part].name;
        let message = format!("the {what} of {name} is prescribed by {word}; expected none for it");
        Err(option_error(what, message))
    }

    fn set(&mut self, part: usize, value: f64, what: &str, field: Field) -> Result<(), Error> {
        let name = &self.parts[part].name;
        if !value.is_finite() {
            let message = format!("the {what} of {name} is {value}; expected a finite number");
            return Err(option_error(what, message));
        }
        let Some((s, ratio)) = self.subsystem_of(part) else {
            let message = format!("{name} has no joint to set; expected a part that turns or slides");
            return Err(option_error(what, message));
        };
        for (member, r) in self.subsystems[s].parts.clone() {
            *field(&mut self.parts[member]) = value / ratio * r;
        }
        Ok(())
    }

    /// Parts that can ever touch, by the regions they sweep: pairs of indices, sorted. Where the motion is not
    /// planar, or not known, all parts whose boxes may meet; likewise for a part that hangs on nothing.
    pub fn interactions(&self) -> Vec<(usize, usize)> {
        let loose: Vec<bool> = (0..self.parts.len()).map(|i| self.is_loose(i)).collect();
        let Ok(system) = self.system_beside_loose() else { return self.meetings(|_, _| true) };
        let mut found: Vec<(usize, usize)> = system.interactions.iter().map(|i| i.bodies).collect();
        if loose.contains(&true) {
            found.extend(self.meetings(|i, j| loose[i] || loose[j]));
            found.sort_unstable();
        }
        found
    }

    /// Parts whose boxes may meet, among the pairs asked for.
    fn meetings(&self, asked: impl Fn(usize, usize) -> bool) -> Vec<(usize, usize)> {
        self.with_reach(|parts| {
            let n = self.parts.len();
            let all = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
            all.filter(|&(i, j)| asked(i, j) && parts.may_touch(i, j)).collect()
        })
    }

    /// Hands over what is needed to tell how far parts reach.
    pub(crate) fn with_reach<T>(&self, ask: impl FnOnce(&Parts) -> T) -> T {
        let boxes: Vec<Bounds> = self.primitives.iter().map(Bounds::of).collect();
        let csgs: Vec<&Csg> = self.parts.iter().map(|p| &p.csg).collect();
        let leaves: Vec<Vec<u32>> = csgs.iter().map(|c| super::compile::leaves(c)).collect();
        let hold = |p: &Part| Some(Hold { pair: p.joint?, carrier: p.carrier? });
        let holds: Vec<Option<Hold>> = self.parts.iter().map(hold).collect();
        let placed = Placed {
            primitives: &self.primitives,
            boxes: &boxes,
            csgs: &csgs,
            leaves: &leaves,
            tolerance: self.tolerance,
        };
        ask(&Parts::new(placed, &holds, &self.pairs, self.plane.normal))
    }
}

/// An error about `--position` or `--velocity`.
fn option_error(what: &str, message: String) -> Error {
    Error { file: format!("--{what}"), line: 1, column: 1, message }
}
