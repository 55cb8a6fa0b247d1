//! Expansion: named solids and symmetric unions become primitives at poses, parts become set expressions.
//!
//! Everything runs on an explicit stack; sizes have been checked before ([`Solids`]).

use crate::attributes::Attributes;
use crate::description::{Gear, GearMember, SymmetricUnion};
use crate::error::{Fault, Read};
use crate::limits::EXPANSION_STEPS;
use crate::machine::Leaf;
use crate::placement::{Copies, PoseStep, StepKind};
use crate::resolve::Resolved;
use crate::shape_text::ShapeKind;
use crate::solids::{Node, Solids};
use crate::syntax::Op;
use mainspring_geometry::{Csg, CsgOp};

/// What remains to be done, last first.
enum Task {
    /// A node, the pose it stands in, and whether it takes material away.
    Visit(u32, u32, bool),
    Emit(CsgOp),
    /// A gear's definition, its first leaf, and whether it takes material away.
    EndGear(u32, usize, bool),
    /// A symmetric union, its first leaf, and the pose of its coordinates.
    EndUnion(u32, usize, u32),
}

pub(crate) struct Expansion<'a> {
    resolved: &'a Resolved<'a>,
    solids: &'a Solids,
    attributes: &'a Attributes,
    copies: &'a [Copies],
    pub poses: Vec<PoseStep>,
    pub leaves: Vec<Leaf>,
    /// For each leaf: does it take material away from its part?
    removes: Vec<bool>,
    pub gears: Vec<Gear>,
    pub unions: Vec<SymmetricUnion>,
    /// Primitives listed by symmetric unions so far.
    listed: usize,
    /// The gear definition being expanded.
    inside_gear: Option<u32>,
    part: usize,
    tasks: Vec<Task>,
    csg: Csg,
}

impl<'a> Expansion<'a> {
    pub fn new(
        resolved: &'a Resolved<'a>,
        solids: &'a Solids,
        attributes: &'a Attributes,
        copies: &'a [Copies],
    ) -> Self {
        let root = PoseStep { parent: 0, kind: StepKind::Root };
        Self {
            resolved,
            solids,
            attributes,
            copies,
            poses: vec![root],
            leaves: Vec::new(),
            removes: Vec::new(),
            gears: Vec::new(),
            unions: Vec::new(),
            listed: 0,
            inside_gear: None,
            part: 0,
            tasks: Vec::new(),
            csg: Csg::default(),
        }
    }

    /// The set expression of a part, given its definition.
    pub fn part(&mut self, part: usize, definition: u32) -> Read<Csg> {
        self.part = part;
        self.enter(definition, 0, false)?;
        while let Some(task) = self.tasks.pop() {
            match task {
                Task::Visit(node, pose, removes) => self.visit(node, pose, removes)?,
                Task::Emit(op) => self.csg.ops.push(op),
                Task::EndGear(definition, start, removes) => self.end_gear(definition, start, removes)?,
                Task::EndUnion(index, start, pose) => self.end_union(index, start, pose)?,
            }
        }
        Ok(std::mem::take(&mut self.csg))
    }

    fn enter(&mut self, definition: u32, pose: u32, removes: bool) -> Read<()> {
        let Some(root) = self.solids.roots[definition as usize] else { return Ok(()) };
        if let Some(mark) = &self.attributes.gears[definition as usize] {
            if let Some(outer) = self.inside_gear.replace(definition) {
                let (outer, inner) =
                    (self.resolved.name_of_definition(outer), self.resolved.name_of_definition(definition));
                let place = mark.gear.map(|(_, place)| place).unwrap_or_default();
                let message = format!(
                    "gear {inner} is a piece of gear {outer}; expected only one of them to be a gear"
                );
                return Err(Fault::new(place, message));
            }
            self.tasks.push(Task::EndGear(definition, self.leaves.len(), removes));
        }
        self.tasks.push(Task::Visit(root, pose, removes));
        Ok(())
    }

    fn visit(&mut self, node: u32, pose: u32, removes: bool) -> Read<()> {
        match self.solids.nodes[node as usize] {
            Node::Shape(shape) => {
                self.csg.ops.push(CsgOp::Leaf(self.leaves.len() as u32));
                self.leaves.push(Leaf { shape, pose });
                self.removes.push(removes);
            }
            Node::Named(definition) => self.enter(definition, pose, removes)?,
            Node::At(child, placement) => {
                let pose = self.pose(pose, StepKind::Placed(placement));
                self.tasks.push(Task::Visit(child, pose, removes));
            }
            Node::Copies(child, index) => self.copy(child, index, pose, removes),
            Node::Set(op, left, right) => {
                let (op, flipped) = match op {
                    Op::Difference => (CsgOp::Difference, !removes),
                    Op::Intersection => (CsgOp::Intersection, removes),
                    _ => (CsgOp::Union, removes),
                };
                self.tasks.push(Task::Emit(op));
                self.tasks.push(Task::Visit(right, pose, flipped));
                self.tasks.push(Task::Visit(left, pose, removes));
            }
        }
        Ok(())
    }

    fn copy(&mut self, child: u32, index: u32, pose: u32, removes: bool) {
        self.tasks.push(Task::EndUnion(index, self.leaves.len(), pose));
        let count = self.copies[index as usize].count;
        let poses: Vec<u32> = (0..count).map(|k| self.pose(pose, StepKind::Copy(index, k))).collect();
        for pose in poses[1..].iter().rev() {
            self.tasks.push(Task::Emit(CsgOp::Union));
            self.tasks.push(Task::Visit(child, *pose, removes));
        }
        self.tasks.push(Task::Visit(child, poses[0], removes));
    }

    fn pose(&mut self, parent: u32, kind: StepKind) -> u32 {
        self.poses.push(PoseStep { parent, kind });
        self.poses.len() as u32 - 1
    }

    fn end_gear(&mut self, definition: u32, start: usize, removes: bool) -> Read<()> {
        self.inside_gear = None;
        let Some(mark) = &self.attributes.gears[definition as usize] else { return Ok(()) };
        let name = self.resolved.name_of_definition(definition);
        let place = mark.gear.map(|(_, place)| place).unwrap_or_default();
        let is_cylinder = |leaf: usize| {
            let shape = self.leaves[leaf].shape as usize;
            self.resolved.syntax.shapes[shape].kind == ShapeKind::Cylinder
        };
        let members: Vec<GearMember> = (start..self.leaves.len())
            .filter(|leaf| is_cylinder(*leaf))
            .map(|leaf| GearMember { primitive: leaf as u32, adds: self.removes[leaf] == removes })
            .collect();
        if !members.iter().any(|m| m.adds) {
            let message =
                format!("gear {name} has no cylinder; expected a cylinder, the envelope of its teeth");
            return Err(Fault::new(place, message));
        }
        let (teeth, depth) = (mark.teeth.clone(), mark.depth.clone());
        self.gears.push(Gear { part: self.part, members, teeth, depth, name: name.to_string(), place });
        Ok(())
    }

    fn end_union(&mut self, index: u32, start: usize, pose: u32) -> Read<()> {
        let raw = &self.resolved.syntax.copies[index as usize];
        let primitives: Vec<u32> = (start as u32..self.leaves.len() as u32).collect();
        self.listed += primitives.len();
        if self.listed > EXPANSION_STEPS {
            let message = format!(
                "symmetric unions inside each other list more than {EXPANSION_STEPS} primitives; expected at most as many"
            );
            return Err(Fault::new(raw.place, message));
        }
        let range = self.copies[index as usize].range.clone();
        let (part, kind, axis, count, place) = (self.part, raw.kind, raw.axis, raw.count, raw.place);
        self.unions.push(SymmetricUnion { part, kind, axis, count, range, primitives, place, pose });
        Ok(())
    }
}
