//! Evaluation of a machine: numbers, sizes and poses over any scalar.

use crate::description::{Gear, PartModel, SymmetricUnion};
use crate::error::{Error, Fault, Place, Read, number, quote};
use crate::expression::Expression;
use crate::machine::Machine;
use crate::names;
use crate::placement::{StepKind, copied, placed};
use crate::values::Values;
use mainspring_geometry::{Primitive, Rigid3, Scalar};
use num_dual::Dual64;

impl Machine {
    /// All numbers, with some definitions overridden. Names are those of [`Machine::parameters`] in any letter
    /// case; an unknown or repeated name, a value that is not finite or outside its range is an error.
    pub fn values(&self, set: &[(String, f64)]) -> Result<Values<f64>, Error> {
        let overrides = self.overrides(set)?;
        self.values_over(&overrides)
    }

    /// As [`Machine::values`], with the derivative of everything with respect to one parameter, which counts as set:
    /// what it is defined by has no influence. Real parts are bit-identical to those of [`Machine::values`].
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
            (None, Some(expression)) => expression.evaluate(numbers).map_err(|mut fault| {
                let causes = self.causes(&[expression], numbers);
                fault.message = format!("in {name}: {}{causes}", fault.message);
                fault
            })?,
            (None, None) => {
                return Err(Fault::new(
                    place,
                    format!("{name} has no value; expected a definition or --set"),
                ));
            }
        };
        let x = value.re();
        match parameter.range {
            _ if parameter.whole && x.fract() != 0.0 => {
                Err(Fault::new(place, format!("{name} is {}; expected a whole number", number(x))))
            }
            _ if !x.is_finite() => Err(Fault::new(place, format!("{name} is {x}; expected a finite number"))),
            Some((low, high)) if x < low || x > high => Err(Fault::new(
                place,
                format!(
                    "{name} is {}; expected a value in its range [{}, {}]",
                    number(x),
                    number(low),
                    number(high)
                ),
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
            let expected = names::one_of(&known, name);
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
        self.add_walls(&values.numbers, &mut primitives)?;
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
            let message =
                format!("{} has {} teeth; expected a whole number up to 1000000", gear.name, number(count));
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
        Err(self.error(e.place, format!("{what} is {}; expected a positive number", number(value.re()))))
    }
}

fn is_finite(pose: &Rigid3<f64>) -> bool {
    let [a, b, c] = pose.columns;
    [a, b, c, pose.translation].iter().all(|v| v.x.is_finite() && v.y.is_finite() && v.z.is_finite())
}
