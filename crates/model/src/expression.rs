//! Numeric expressions: postfix programs evaluated over any scalar.

use crate::angle::{atan2_degrees, quotient, root, sin_cos_degrees};
use crate::error::{Fault, Place, Read, number};
use mainspring_geometry::Scalar;

/// A function of the language; angles in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Sin,
    Cos,
    Tan,
    Sqrt,
    Abs,
    Min,
    Max,
    Atan2,
}

impl Function {
    pub const NAMES: [(&'static str, Self); 8] = [
        ("sin", Self::Sin),
        ("cos", Self::Cos),
        ("tan", Self::Tan),
        ("sqrt", Self::Sqrt),
        ("abs", Self::Abs),
        ("min", Self::Min),
        ("max", Self::Max),
        ("atan2", Self::Atan2),
    ];

    pub fn named(lower: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(n, _)| *n == lower).map(|(_, f)| *f)
    }

    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, f)| *f == self).map_or("", |(n, _)| n)
    }

    /// Least number of arguments, and whether more may follow.
    pub fn arguments(self) -> (usize, bool) {
        match self {
            Self::Min | Self::Max => (2, true),
            Self::Atan2 => (2, false),
            _ => (1, false),
        }
    }
}

/// One step of an expression in postfix order; `Value` is the index of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum NumOp {
    Number(f64),
    Value(u32),
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Call(Function, u32),
}

/// A numeric expression of the machine's parameters; evaluated by [`crate::Machine::evaluate`].
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    pub(crate) ops: Vec<NumOp>,
    /// Where the expression begins.
    pub place: Place,
}

impl Expression {
    /// The value, finite; an error names what is not defined there.
    pub(crate) fn evaluate<S: Scalar>(&self, values: &[S]) -> Read<S> {
        let mut stack = Vec::with_capacity(8);
        for op in &self.ops {
            let value = self.step(*op, values, &mut stack)?;
            if !value.re().is_finite() {
                return Err(self.fault("the value is not finite; expected an expression with a finite value"));
            }
            stack.push(value);
        }
        stack.pop().ok_or_else(|| self.fault("empty expression; expected a number"))
    }

    fn step<S: Scalar>(&self, op: NumOp, values: &[S], stack: &mut Vec<S>) -> Read<S> {
        Ok(match op {
            NumOp::Number(x) => S::constant(x),
            NumOp::Value(i) => values[i as usize],
            NumOp::Negate => -self.pop(stack)?,
            NumOp::Call(function, count) => {
                let arguments = stack.split_off(stack.len().saturating_sub(count as usize));
                self.call(function, &arguments)?
            }
            _ => {
                let (b, a) = (self.pop(stack)?, self.pop(stack)?);
                match op {
                    NumOp::Add => a + b,
                    NumOp::Subtract => a - b,
                    NumOp::Multiply => a * b,
                    _ if b.re() == 0.0 => {
                        return Err(self.fault("division by zero; expected a divisor other than zero"));
                    }
                    _ => quotient(a, b),
                }
            }
        })
    }

    fn call<S: Scalar>(&self, function: Function, arguments: &[S]) -> Read<S> {
        let Some(&x) = arguments.first() else {
            return Err(self.fault("missing argument; expected a number"));
        };
        let rest = &arguments[1..];
        Ok(match function {
            Function::Sin => sin_cos_degrees(x).0,
            Function::Cos => sin_cos_degrees(x).1,
            Function::Tan => self.tangent(x)?,
            Function::Sqrt => self.root(x)?,
            Function::Abs if x.re() < 0.0 => -x,
            Function::Abs => x,
            Function::Min => rest.iter().fold(x, |a, b| if b.re() < a.re() { *b } else { a }),
            Function::Max => rest.iter().fold(x, |a, b| if b.re() > a.re() { *b } else { a }),
            Function::Atan2 => atan2_degrees(x, rest.first().copied().unwrap_or(S::constant(0.0))),
        })
    }

    fn tangent<S: Scalar>(&self, x: S) -> Read<S> {
        let (s, c) = sin_cos_degrees(x);
        if c.re() == 0.0 {
            return Err(
                self.fault(format!("tan of {} degrees is infinite; expected another angle", number(x.re())))
            );
        }
        Ok(quotient(s, c))
    }

    fn root<S: Scalar>(&self, x: S) -> Read<S> {
        if x.re() < 0.0 {
            let message = format!("sqrt of {}; expected a number that is not negative", number(x.re()));
            return Err(self.fault(message));
        }
        Ok(root(x))
    }

    fn pop<S: Scalar>(&self, stack: &mut Vec<S>) -> Read<S> {
        stack.pop().ok_or_else(|| self.fault("incomplete expression; expected a number"))
    }

    fn fault(&self, message: impl Into<String>) -> Box<Fault> {
        Fault::new(self.place, message)
    }
}
