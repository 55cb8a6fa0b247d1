//! The machine: what a text says, before any number is put in; and its evaluation.

use crate::description::{Gear, Parameter, PartModel, Supplement, SymmetricUnion};
use crate::error::{Error, Fault, Place, Read, file_name, quote};
use crate::expression::Expression;
use crate::placement::{Copies, Placement, PoseStep, StepKind, copied, placed};
use crate::shape_text::ShapeText;
use crate::values::Values;
use mainspring_geometry::{Primitive, Rigid3, Scalar};
use num_dual::Dual64;

/// A machine as a person edits it: parameters, parts and supplement.
#[derive(Clone, Debug)]
pub struct Machine {
    pub(crate) files: [String; 2],
    pub(crate) name: String,
    pub(crate) parameters: Vec<Parameter>,
    /// The text of each parameter; none where the generic's list names one without a definition.
    pub(crate) definitions: Vec<Option<Expression>>,
    /// Parameters in an order in which each comes after those it uses.
    pub(crate) order: Vec<u32>,
    pub(crate) shapes: Vec<ShapeText>,
    pub(crate) placements: Vec<Placement>,
    pub(crate) copies: Vec<Copies>,
    pub(crate) poses: Vec<PoseStep>,
    pub(crate) leaves: Vec<Leaf>,
    pub(crate) parts: Vec<PartModel>,
    pub(crate) gears: Vec<Gear>,
    pub(crate) unions: Vec<SymmetricUnion>,
    pub(crate) supplement: Supplement,
}

/// A primitive after expansion: a shape of the text at a pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    pub shape: u32,
    pub pose: u32,
}

impl Machine {
    /// The generic's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The parts in the order of the result's `asb`.
    pub fn parts(&self) -> &[PartModel] {
        &self.parts
    }

    /// Index of the part marked as the frame.
    pub fn frame(&self) -> Option<usize> {
        self.parts.iter().position(|p| p.is_frame)
    }

    /// Index of a part by its name, in any letter case.
    pub fn part_index(&self, name: &str) -> Option<usize> {
        self.parts.iter().position(|p| p.name.eq_ignore_ascii_case(name))
    }

    /// The numeric definitions in the order of the text.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Index of a parameter by its name, in any letter case.
    pub fn parameter_index(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|p| p.name.eq_ignore_ascii_case(name))
    }

    /// Inertias, frictions, springs and the initial state; empty if no supplement was given.
    pub fn supplement(&self) -> &Supplement {
        &self.supplement
    }

    /// Every instance of a solid marked as a gear, part by part.
    pub fn gears(&self) -> &[Gear] {
        &self.gears
    }

    /// Every instance of a symmetric union, part by part; nested ones before those that contain them.
    pub fn symmetric_unions(&self) -> &[SymmetricUnion] {
        &self.unions
    }

    /// Number of primitives in all parts.
    pub fn primitive_count(&self) -> usize {
        self.leaves.len()
    }

    /// Where a primitive is written; the default place if there is no such primitive.
    pub fn place_of_primitive(&self, primitive: u32) -> Place {
        self.shape_of(primitive).map_or(Place::default(), |s| s.place)
    }

    /// A primitive in words, for example `tooth (blo)`: the solid whose definition it stands in, and its kind.
    pub fn label_of_primitive(&self, primitive: u32) -> String {
        self.shape_of(primitive).map_or(String::new(), |s| s.label.clone())
    }

    fn shape_of(&self, primitive: u32) -> Option<&ShapeText> {
        self.leaves.get(primitive as usize).map(|l| &self.shapes[l.shape as usize])
    }

    /// An error at a place, with the file's name put in.
    pub fn error(&self, place: Place, message: impl Into<String>) -> Error {
        let file = match place.file {
            0 | 1 => file_name(&self.files[place.file as usize]),
            _ => "--set".to_string(),
        };
        Error { file, line: place.line, column: place.column, message: message.into() }
    }

    fn named<T>(&self, result: Read<T>) -> Result<T, Error> {
        result.map_err(|fault| self.error(fault.place, fault.message))
    }

    /// All numbers, with some definitions overridden. Names are those of [`Machine::parameters`] in any letter
    /// case; an unknown or repeated name, a value that is not finite or outside its range is an error.
    pub fn values(&self, set: &[(String, f64)]) -> Result<Values<f64>, Error> {
        let overrides = self.overrides(set)?;
        self.values_over(&overrides)
    }

    /// As [`Machine::values`], with the derivative of everything with respect to one parameter.
    pub fn values_with_derivative(
        &self,
        set: &[(String, f64)],
        parameter: &str,
    ) -> Result<Values<Dual64>, Error> {
        let seeded = self.find_parameter(parameter)?;
        let value = self.values(set)?.numbers[seeded];
        let mut overrides: Vec<(usize, Dual64)> = Vec::new();
        overrides.extend(self.overrides(set)?.iter().map(|(i, v)| (*i, Dual64::from(*v))));
        overrides.retain(|(i, _)| *i != seeded);
        overrides.push((seeded, Dual64::new(value, 1.0)));
        self.values_over(&overrides)
    }

    /// All numbers over any scalar, with parameters (by index) overridden. Real parts are bit-identical to
    /// those of `f64`.
    pub fn values_over<S: Scalar>(&self, overrides: &[(usize, S)]) -> Result<Values<S>, Error> {
        let mut given: Vec<Option<S>> = vec![None; self.parameters.len()];
        for (i, value) in overrides {
            let slot = given.get_mut(*i);
            *slot.ok_or_else(|| self.error(Place::SETTING, format!("no parameter number {i}")))? =
                Some(*value);
        }
        let mut numbers = vec![S::constant(0.0); self.parameters.len()];
        for &i in &self.order {
            let i = i as usize;
            numbers[i] = self.named(self.number(i, given[i], &numbers))?;
        }
        Ok(Values { numbers })
    }

    /// Evaluates every definition that can be evaluated without overrides.
    pub(crate) fn find_defaults(&mut self) {
        let mut numbers = vec![f64::NAN; self.parameters.len()];
        for &i in &self.order {
            let i = i as usize;
            if let Ok(value) = self.number(i, None, &numbers) {
                numbers[i] = value;
                self.parameters[i].default = Some(value);
            }
        }
    }

    fn number<S: Scalar>(&self, i: usize, given: Option<S>, numbers: &[S]) -> Read<S> {
        let parameter = &self.parameters[i];
        let place = if given.is_some() { Place::SETTING } else { parameter.place };
        let name = &parameter.name;
        let value = match (given, &self.definitions[i]) {
            (Some(value), _) => value,
            (None, Some(expression)) => expression.evaluate(numbers)?,
            (None, None) => {
                return Err(Fault::new(
                    place,
                    format!("{name} has no value; expected a definition or --set"),
                ));
            }
        };
        let x = value.re();
        match parameter.range {
            _ if !x.is_finite() => Err(Fault::new(place, format!("{name} is {x}; expected a finite number"))),
            Some((low, high)) if x < low || x > high => Err(Fault::new(
                place,
                format!("{name} is {x}; expected a value in its range [{low}, {high}]"),
            )),
            _ => Ok(value),
        }
    }

    fn overrides(&self, set: &[(String, f64)]) -> Result<Vec<(usize, f64)>, Error> {
        let mut found: Vec<(usize, f64)> = Vec::with_capacity(set.len());
        for (name, value) in set {
            let i = self.find_parameter(name)?;
            if found.iter().any(|(j, _)| *j == i) {
                let message = format!("{} is set twice; expected one value", quote(name));
                return Err(self.error(Place::SETTING, message));
            }
            found.push((i, *value));
        }
        Ok(found)
    }

    fn find_parameter(&self, name: &str) -> Result<usize, Error> {
        self.parameter_index(name).ok_or_else(|| {
            let known: Vec<&str> = self.parameters.iter().map(|p| p.name.as_str()).collect();
            let expected = crate::names::one_of(&known, name);
            self.error(Place::SETTING, format!("no parameter is named {}; expected {expected}", quote(name)))
        })
    }

    /// The value of an expression of this machine.
    pub fn evaluate<S: Scalar>(&self, expression: &Expression, values: &Values<S>) -> Result<S, Error> {
        self.named(expression.evaluate(&values.numbers))
    }

    /// All primitives: sizes positive and finite, poses in machine coordinates.
    pub fn primitives<S: Scalar>(&self, values: &Values<S>) -> Result<Vec<Primitive<S>>, Error> {
        let shapes: Read<Vec<_>> = self.shapes.iter().map(|s| s.evaluate(&values.numbers)).collect();
        let shapes = self.named(shapes)?;
        let poses = self.named(self.poses(values))?;
        let mut primitives = Vec::with_capacity(self.leaves.len());
        for leaf in &self.leaves {
            let pose = poses[leaf.pose as usize];
            if !is_finite(&pose.re()) {
                let place = self.shapes[leaf.shape as usize].place;
                return Err(
                    self.error(place, "the motions put it infinitely far away; expected smaller motions")
                );
            }
            primitives.push(Primitive { shape: shapes[leaf.shape as usize], machine_from_local: pose });
        }
        Ok(primitives)
    }

    /// `machine_from_local` of the coordinates whose axis a symmetric union's copies follow.
    pub fn union_pose<S: Scalar>(
        &self,
        union: &SymmetricUnion,
        values: &Values<S>,
    ) -> Result<Rigid3<S>, Error> {
        let poses = self.named(self.poses(values))?;
        Ok(poses.get(union.pose as usize).copied().unwrap_or(Rigid3::identity()))
    }

    fn poses<S: Scalar>(&self, values: &Values<S>) -> Read<Vec<Rigid3<S>>> {
        let numbers = &values.numbers;
        let local: Read<Vec<_>> = self.placements.iter().map(|p| placed(p, numbers)).collect();
        let local = local?;
        let mut poses: Vec<Rigid3<S>> = Vec::with_capacity(self.poses.len());
        for step in &self.poses {
            let pose = match step.kind {
                StepKind::Root => Rigid3::identity(),
                StepKind::Placed(i) => poses[step.parent as usize].then_after(&local[i as usize]),
                StepKind::Copy(i, k) => {
                    let copy = copied(&self.copies[i as usize], k, numbers)?;
                    poses[step.parent as usize].then_after(&copy)
                }
            };
            poses.push(pose);
        }
        Ok(poses)
    }

    /// A part's density, positive; none if it was not given.
    pub fn density<S: Scalar>(&self, part: &PartModel, values: &Values<S>) -> Result<Option<S>, Error> {
        let Some(density) = &part.density else { return Ok(None) };
        self.positive(&density.value, values, &format!("density of {}", part.name)).map(Some)
    }

    /// A gear's number of teeth, a whole positive number; none if it was not given.
    pub fn teeth<S: Scalar>(&self, gear: &Gear, values: &Values<S>) -> Result<Option<u32>, Error> {
        let Some(teeth) = &gear.teeth else { return Ok(None) };
        let count = self.positive(teeth, values, &format!("number of teeth of {}", gear.name))?.re();
        if count.fract() != 0.0 || count > 1e6 {
            let message = format!("{} has {count} teeth; expected a whole number up to 1000000", gear.name);
            return Err(self.error(teeth.place, message));
        }
        Ok(Some(count as u32))
    }

    /// The depth of a gear's teeth in the file's length, positive; none if it was not given.
    pub fn tooth_depth<S: Scalar>(&self, gear: &Gear, values: &Values<S>) -> Result<Option<S>, Error> {
        let Some(depth) = &gear.depth else { return Ok(None) };
        self.positive(depth, values, &format!("tooth depth of {}", gear.name)).map(Some)
    }

    fn positive<S: Scalar>(&self, e: &Expression, values: &Values<S>, what: &str) -> Result<S, Error> {
        let value = self.evaluate(e, values)?;
        if value.re() > 0.0 {
            return Ok(value);
        }
        Err(self.error(e.place, format!("{what} is {}; expected a positive number", value.re())))
    }
}

fn is_finite(pose: &Rigid3<f64>) -> bool {
    let [a, b, c] = pose.columns;
    [a, b, c, pose.translation].iter().all(|v| v.x.is_finite() && v.y.is_finite() && v.z.is_finite())
}
