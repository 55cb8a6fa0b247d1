//! Arithmetic, and the primaries that numbers and solids share.

use crate::error::{Fault, Place, Read};
use crate::expression::Function;
use crate::lexer::{Token, TokenKind};
use crate::limits::EXPRESSION_NODES;
use crate::parser::Parser;
use crate::shape_text::ShapeKind;
use crate::syntax::{Kind, Op, Ops};

/// What has just been read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term {
    pub kind: Kind,
    /// Numbers, names, operators and functions, if it is a number.
    pub nodes: usize,
    /// Names and primitives, if it is a solid.
    pub operands: usize,
}

impl Term {
    pub fn solid(operands: usize) -> Self {
        Self { kind: Kind::Solid, nodes: 0, operands }
    }
}

impl Parser<'_> {
    /// A numeric expression of its own.
    pub fn expression(&mut self) -> Read<Ops> {
        let (start, place) = (self.ops.len(), self.token.place);
        let term = self.sum()?;
        if term.kind == Kind::Solid {
            return Err(Fault::new(place, "a solid where a number belongs; expected a numeric expression"));
        }
        Ok(self.ops.drain(start..).collect())
    }

    /// `PRODUCT {+|- PRODUCT}`
    pub fn sum(&mut self) -> Read<Term> {
        let mut left = self.product()?;
        while let TokenKind::Symbol(symbol @ (b'+' | b'-')) = self.token.kind {
            let place = self.take()?.place;
            let right = self.product()?;
            let op = if symbol == b'+' { Op::Add } else { Op::Subtract };
            left = self.arithmetic(op, place, &[left, right])?;
        }
        Ok(left)
    }

    /// `SIGNED {*|/ SIGNED}`
    fn product(&mut self) -> Read<Term> {
        let mut left = self.signed()?;
        while let TokenKind::Symbol(symbol @ (b'*' | b'/')) = self.token.kind {
            let place = self.take()?.place;
            let right = self.signed()?;
            let op = if symbol == b'*' { Op::Multiply } else { Op::Divide };
            left = self.arithmetic(op, place, &[left, right])?;
        }
        Ok(left)
    }

    /// `{-} PLACED`
    fn signed(&mut self) -> Read<Term> {
        let (mut signs, place) = (0, self.token.place);
        while self.skip(b'-')? {
            signs += 1;
            if signs > EXPRESSION_NODES {
                return Err(too_long(place));
            }
        }
        let mut term = self.placed()?;
        for _ in 0..signs {
            term = self.arithmetic(Op::Negate, place, &[term])?;
        }
        Ok(term)
    }

    fn arithmetic(&mut self, op: Op, place: Place, operands: &[Term]) -> Read<Term> {
        if operands.iter().any(|t| t.kind == Kind::Solid) {
            return Err(Fault::new(
                place,
                "arithmetic on a solid; expected numbers (solids are joined by `un`, `dif`, `int`)",
            ));
        }
        let nodes = 1 + operands.iter().map(|t| t.nodes).sum::<usize>();
        if nodes > EXPRESSION_NODES {
            return Err(too_long(place));
        }
        self.push(op, place)?;
        Ok(Term { kind: Kind::Number, nodes, operands: 0 })
    }

    /// A number, a name, a call, a primitive, or anything in brackets.
    pub fn primary(&mut self) -> Read<Term> {
        match self.token.kind {
            TokenKind::Number(value) => {
                let place = self.take()?.place;
                self.push(Op::Number(value), place)?;
                Ok(Term { kind: Kind::Number, nodes: 1, operands: 0 })
            }
            TokenKind::Word => self.word(),
            TokenKind::Symbol(b'(') => {
                self.take()?;
                let term = self.set()?;
                self.close(b')', "an operator or ")?;
                Ok(term)
            }
            _ if self.token.is_end() => {
                Err(self.unexpected("a number or a solid (a line that goes on needs `\\` at its end)"))
            }
            _ => Err(self.unexpected("a number, a name, a primitive or `(`")),
        }
    }

    fn word(&mut self) -> Read<Term> {
        let word = self.take()?;
        let lower = word.text.to_ascii_lowercase();
        if let Some(kind) = ShapeKind::named(&lower) {
            return self.shape(kind, &word);
        }
        if let Some(function) = Function::named(&lower) {
            return self.call(function, &word);
        }
        if lower == "symmetric_union" {
            return self.symmetric_union(word.place);
        }
        self.check_operand(&word)?;
        let name = self.name(&word)?;
        self.push(Op::Name(name), word.place)?;
        Ok(Term { kind: Kind::Name, nodes: 1, operands: 1 })
    }

    fn check_operand(&self, word: &Token) -> Read<()> {
        if let Err(mut fault) = self.check_name(word) {
            fault.message = fault.message.replace("a name of your own", "a number, a name or a solid");
            return Err(fault);
        }
        if self.token.is_symbol(b'(') { Err(self.unknown_call(word)) } else { Ok(()) }
    }

    fn call(&mut self, function: Function, word: &Token) -> Read<Term> {
        self.expect(b'(', &format!("`(` after the function {}", function.name()))?;
        let mut terms = vec![self.argument()?];
        while self.skip(b',')? {
            terms.push(self.argument()?);
            if terms.len() > EXPRESSION_NODES {
                return Err(too_long(word.place));
            }
        }
        self.close(b')', "`,` or ")?;
        let (least, more) = function.arguments();
        let count = terms.len();
        if count < least || (count > least && !more) {
            let or_more = if more { " or more" } else { "" };
            let name = function.name();
            let plural = if count == 1 { "" } else { "s" };
            let message = format!("{name} has {count} argument{plural}; expected {least}{or_more}");
            return Err(Fault::new(word.place, message));
        }
        self.arithmetic(Op::Call(function, count as u32), word.place, &terms)
    }

    fn argument(&mut self) -> Read<Term> {
        let place = self.token.place;
        let term = self.sum()?;
        if term.kind == Kind::Solid {
            return Err(Fault::new(place, "a solid where a number belongs; expected a numeric expression"));
        }
        Ok(term)
    }
}

fn too_long(place: Place) -> Box<Fault> {
    let message = format!(
        "more than {EXPRESSION_NODES} numbers, names and operators in an expression; expected at most as many"
    );
    Fault::new(place, message)
}
