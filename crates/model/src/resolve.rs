//! Looking names up: what each name stands for, in which order definitions depend on each other.

use crate::error::{Fault, Place, Read, quote};
use crate::expression::{Expression, NumOp};
use crate::names;
use crate::syntax::{Kind, Op, Ops, Syntax};

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    /// Index of a parameter.
    Number(u32),
    /// Index of a definition that is a solid.
    Solid(u32),
    /// The generic's result.
    Result,
    Undefined,
}

/// A syntax with its names looked up.
pub(crate) struct Resolved<'a> {
    pub syntax: &'a Syntax,
    /// For each name.
    pub meanings: Vec<Meaning>,
    /// Definitions, each after those it uses.
    pub order: Vec<u32>,
    /// Definition of each parameter; none for names of the generic's list without one.
    pub parameters: Vec<(u32, Option<u32>)>,
}

/// Names shown of a cycle.
const CYCLE_SHOWN: usize = 6;

impl<'a> Resolved<'a> {
    pub fn new(syntax: &'a Syntax) -> Read<Self> {
        let meanings = vec![Meaning::Undefined; syntax.names.len()];
        let mut resolved = Self { syntax, meanings, order: Vec::new(), parameters: Vec::new() };
        resolved.check_defined()?;
        resolved.order = resolved.sort()?;
        resolved.find_meanings();
        Ok(resolved)
    }

    pub fn name(&self, name: u32) -> &'a str {
        &self.syntax.names[name as usize].text
    }

    pub fn name_of_definition(&self, definition: u32) -> &'a str {
        self.name(self.syntax.definitions[definition as usize].name)
    }

    /// Names of all solids, in the order of the text.
    pub fn solid_names(&self) -> impl Iterator<Item = &'a str> + '_ {
        let solids = self.syntax.definitions.iter().map(|d| d.name);
        solids.filter(|n| matches!(self.meanings[*n as usize], Meaning::Solid(_))).map(|n| self.name(n))
    }

    /// Every name used is defined, and none is the result.
    fn check_defined(&self) -> Read<()> {
        let formal = |name: u32| self.syntax.names[name as usize].formal.is_some();
        let mut fault = Ok(());
        for definition in 0..self.syntax.definitions.len() {
            self.for_each_name(definition, |name, place| {
                if name == self.syntax.result.0 {
                    let message = format!(
                        "{} is the result, an assembly; expected a solid or a number",
                        quote(self.name(name))
                    );
                    fault = Err(Fault::new(place, message));
                } else if self.definition(name).is_none() && !formal(name) {
                    fault = Err(self.undefined(name, place));
                }
                fault.is_ok()
            });
            if fault.is_err() {
                break;
            }
        }
        fault
    }

    pub fn undefined(&self, name: u32, place: Place) -> Box<Fault> {
        let text = self.name(name);
        let known = self.syntax.definitions.iter().map(|d| self.name(d.name));
        let expected = match names::nearest(known, text) {
            Some(near) => format!("a defined name, perhaps `{near}`"),
            None => "a defined name".to_string(),
        };
        Fault::new(place, format!("{} is not defined; expected {expected}", quote(text)))
    }

    fn definition(&self, name: u32) -> Option<u32> {
        self.syntax.names[name as usize].definition
    }

    /// Calls `visit` for every name that a definition uses, until it returns false.
    fn for_each_name(&self, definition: usize, mut visit: impl FnMut(u32, Place) -> bool) {
        let mut scan = |ops: &Ops| {
            ops.iter().all(|(op, place)| match op {
                Op::Name(name) => visit(*name, *place),
                _ => true,
            })
        };
        let syntax = self.syntax;
        let ops = &syntax.definitions[definition].ops;
        let _ = scan(ops)
            && ops.iter().all(|(op, _)| match op {
                Op::Shape(i) => syntax.shapes[*i as usize].sizes.iter().flatten().all(&mut scan),
                Op::At(i) => syntax.placements[*i as usize].iter().all(|m| scan(&m.amount)),
                Op::Copies(i) => scan(&syntax.copies[*i as usize].range),
                _ => true,
            });
    }

    /// Definitions in the order of use; a cycle is an error that names it. Depth first, without recursion.
    fn sort(&self) -> Read<Vec<u32>> {
        let count = self.syntax.definitions.len();
        let mut order = Vec::with_capacity(count);
        // 0 not seen, 1 on the path, 2 done.
        let mut state = vec![0u8; count];
        for start in 0..count as u32 {
            let mut path = self.enter(start, &mut state);
            while let Some((definition, uses)) = path.last_mut() {
                let Some(next) = uses.pop() else {
                    state[*definition as usize] = 2;
                    order.push(*definition);
                    path.pop();
                    continue;
                };
                if state[next as usize] == 1 {
                    return Err(self.cycle(path.iter().map(|(d, _)| *d).collect(), next));
                }
                path.extend(self.enter(next, &mut state));
            }
        }
        Ok(order)
    }

    /// A step of the path with what it uses, last first; none if it is done already.
    fn enter(&self, definition: u32, state: &mut [u8]) -> Vec<(u32, Vec<u32>)> {
        if state[definition as usize] != 0 {
            return Vec::new();
        }
        state[definition as usize] = 1;
        let mut uses = Vec::new();
        self.for_each_name(definition as usize, |name, _| {
            uses.extend(self.definition(name));
            true
        });
        uses.reverse();
        vec![(definition, uses)]
    }

    fn cycle(&self, path: Vec<u32>, repeated: u32) -> Box<Fault> {
        let start = path.iter().position(|d| *d == repeated).unwrap_or(0);
        let cycle = &path[start..];
        let name = |d: &u32| self.name(self.syntax.definitions[*d as usize].name).to_string();
        let mut shown: Vec<String> = cycle.iter().take(CYCLE_SHOWN).map(name).collect();
        if cycle.len() > CYCLE_SHOWN {
            shown.push("…".to_string());
        }
        shown.push(name(&repeated));
        let place = self.syntax.definitions[repeated as usize].place;
        let message = format!("a cycle of names: {}; expected no name to use itself", shown.join(" -> "));
        Fault::new(place, message)
    }

    fn find_meanings(&mut self) {
        let syntax = self.syntax;
        self.meanings[syntax.result.0 as usize] = Meaning::Result;
        for name in &syntax.formals {
            if self.definition(*name).is_none() {
                self.parameter(*name, None);
            }
        }
        let mut is_number = vec![false; syntax.definitions.len()];
        for &d in &self.order {
            let definition = &syntax.definitions[d as usize];
            is_number[d as usize] = match (definition.kind, definition.ops.first()) {
                (Kind::Name, Some((Op::Name(other), _))) => {
                    self.definition(*other).is_none_or(|o| is_number[o as usize])
                }
                (kind, _) => kind == Kind::Number,
            };
        }
        for (d, definition) in syntax.definitions.iter().enumerate() {
            if is_number[d] {
                self.parameter(definition.name, Some(d as u32));
            } else {
                self.meanings[definition.name as usize] = Meaning::Solid(d as u32);
            }
        }
    }

    fn parameter(&mut self, name: u32, definition: Option<u32>) {
        self.meanings[name as usize] = Meaning::Number(self.parameters.len() as u32);
        self.parameters.push((name, definition));
    }

    /// A numeric expression with its names looked up.
    pub fn expression(&self, ops: &Ops) -> Read<Expression> {
        let place = ops.iter().map(|(_, p)| *p).min_by_key(|p| (p.line, p.column)).unwrap_or_default();
        let ops = ops.iter().map(|(op, place)| self.numeric(*op, *place)).collect::<Read<_>>()?;
        Ok(Expression { ops, place })
    }

    fn numeric(&self, op: Op, place: Place) -> Read<NumOp> {
        Ok(match op {
            Op::Number(value) => NumOp::Number(value),
            Op::Negate => NumOp::Negate,
            Op::Add => NumOp::Add,
            Op::Subtract => NumOp::Subtract,
            Op::Multiply => NumOp::Multiply,
            Op::Divide => NumOp::Divide,
            Op::Call(function, count) => NumOp::Call(function, count),
            Op::Name(name) => match self.meanings[name as usize] {
                Meaning::Number(parameter) => NumOp::Value(parameter),
                Meaning::Undefined => return Err(self.undefined(name, place)),
                Meaning::Solid(_) | Meaning::Result => {
                    return Err(Fault::new(
                        place,
                        format!("{} is a solid; expected a number", quote(self.name(name))),
                    ));
                }
            },
            _ => return Err(Fault::new(place, "a solid where a number belongs; expected a number")),
        })
    }

    /// The definition of a solid used at a place.
    pub fn solid(&self, name: u32, place: Place) -> Read<u32> {
        match self.meanings[name as usize] {
            Meaning::Solid(definition) => Ok(definition),
            Meaning::Undefined => Err(self.undefined(name, place)),
            Meaning::Number(_) => {
                Err(Fault::new(place, format!("{} is a number; expected a solid", quote(self.name(name)))))
            }
            Meaning::Result => {
                Err(Fault::new(place, format!("{} is the result; expected a solid", quote(self.name(name)))))
            }
        }
    }
}
