//! The initial state and what may touch: asked for after compiling.

use super::bounds::Bounds;
use super::mechanism::Mechanism;
use super::pair::PairKind;
use super::reach::{Parts, Placed};
use super::subsystems::Hold;
use mainspring_geometry::Csg;
use mainspring_model::{Error, Place};

/// A part's joint position or velocity, in radians or the file's length.
pub type PartValue = (usize, f64);

impl Mechanism {
    /// Does the part's joint slide (and not turn)?
    pub fn slides(&self, part: usize) -> bool {
        self.parts[part].joint.is_some_and(|j| self.pairs[j].kind == PairKind::Prismatic)
    }

    /// The same mechanism with other initial positions and velocities; parts geared to those named follow.
    ///
    /// # Errors
    /// A part without a joint, and parts that overlap in the new positions.
    pub fn starting_at(&self, positions: &[PartValue], velocities: &[PartValue]) -> Result<Self, Error> {
        let mut moved = self.clone();
        for &(part, x) in positions {
            moved.set(part, x, |p| &mut p.position)?;
        }
        for &(part, v) in velocities {
            moved.set(part, v, |p| &mut p.velocity)?;
        }
        if !positions.is_empty() {
            moved.check_start()?;
        }
        Ok(moved)
    }

    fn set(
        &mut self,
        part: usize,
        value: f64,
        field: fn(&mut super::mechanism::Part) -> &mut f64,
    ) -> Result<(), Error> {
        let name = self.parts[part].name.clone();
        let place = Place { file: 2, line: 1, column: 1 };
        if !value.is_finite() {
            return Err(self
                .machine
                .error(place, format!("the value for {name} is {value}, expected a finite number")));
        }
        let Some((s, ratio)) = self.subsystem_of(part) else {
            let message = format!("{name} has no joint to set, expected a part that turns or slides");
            return Err(self.machine.error(place, message));
        };
        for (member, r) in self.subsystems[s].parts.clone() {
            *field(&mut self.parts[member]) = value / ratio * r;
        }
        Ok(())
    }

    /// Parts that can ever touch, by the regions they sweep: pairs of indices, sorted. Where the motion is not
    /// planar, or not known, all parts whose boxes may meet.
    pub fn interactions(&self) -> Vec<(usize, usize)> {
        if let Ok(system) = self.system() {
            return system.interactions.iter().map(|i| i.bodies).collect();
        }
        self.with_reach(|parts| {
            let n = self.parts.len();
            let all = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
            all.filter(|&(i, j)| parts.may_touch(i, j)).collect()
        })
    }

    /// Hands over what is needed to tell how far parts reach.
    pub(crate) fn with_reach<T>(&self, ask: impl FnOnce(&Parts) -> T) -> T {
        let boxes: Vec<Bounds> = self.primitives.iter().map(Bounds::of).collect();
        let csgs: Vec<&Csg> = self.parts.iter().map(|p| &p.csg).collect();
        let leaves: Vec<Vec<u32>> = csgs.iter().map(|c| super::compile::leaves(c)).collect();
        let hold = |p: &super::mechanism::Part| Some(Hold { pair: p.joint?, carrier: p.carrier? });
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
