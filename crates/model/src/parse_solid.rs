//! Solids: set operations, `at`, primitives, symmetric unions.

use crate::description::SymmetryKind;
use crate::error::{Fault, Place, Read, quote};
use crate::lexer::{Token, TokenKind};
use crate::limits::{DEFINITIONS, PRIMITIVES};
use crate::names;
use crate::parse_number::Term;
use crate::parser::Parser;
use crate::shape_text::ShapeKind;
use crate::syntax::{Kind, Op, RawCopies, RawMotion, RawShape};
use mainspring_geometry::Axis;

/// The six motions of `at`.
const MOTION_WORDS: [(&str, bool, Axis); 6] = [
    ("movx", false, Axis::X),
    ("movy", false, Axis::Y),
    ("movz", false, Axis::Z),
    ("degx", true, Axis::X),
    ("degy", true, Axis::Y),
    ("degz", true, Axis::Z),
];

impl Parser<'_> {
    /// `SUM {un|dif|int SUM}`: one level of precedence, left to right.
    pub fn set(&mut self) -> Read<Term> {
        let mut left = self.sum()?;
        while let Some(op) = self.set_operator() {
            let place = self.take()?.place;
            let right = self.sum()?;
            if left.kind == Kind::Number || right.kind == Kind::Number {
                return Err(Fault::new(place, "a set operation on a number; expected a solid on both sides"));
            }
            let operands = left.operands + right.operands;
            if operands > PRIMITIVES {
                let message =
                    format!("more than {PRIMITIVES} primitives in a solid; expected at most as many");
                return Err(Fault::new(place, message));
            }
            self.push(op, place)?;
            left = Term::solid(operands);
        }
        Ok(left)
    }

    fn set_operator(&self) -> Option<Op> {
        let words = [("un", Op::Union), ("dif", Op::Difference), ("int", Op::Intersection)];
        words.iter().find(|(word, _)| self.token.is_word(word)).map(|(_, op)| *op)
    }

    /// `PRIMARY {at (…)}`: binds tightest.
    pub fn placed(&mut self) -> Read<Term> {
        let mut term = self.primary()?;
        while self.token.is_word("at") {
            if term.kind == Kind::Number {
                return Err(self.fault_here("`at` on a number; expected a solid in front of it"));
            }
            let place = self.take()?.place;
            let motions = self.motions()?;
            // `s at (a) at (b)` is `s at (a, b)`.
            if let Some((Op::At(last), _)) = self.ops.last() {
                self.syntax.placements[*last as usize].extend(motions);
            } else {
                self.push(Op::At(self.syntax.placements.len() as u32), place)?;
                self.syntax.placements.push(motions);
            }
            term = Term::solid(term.operands);
        }
        Ok(term)
    }

    fn motions(&mut self) -> Read<Vec<RawMotion>> {
        self.expect(b'(', "`(` and motions such as movx=1")?;
        let mut motions = Vec::new();
        loop {
            let word = self.expect_word("a motion such as movx=1")?;
            let found = MOTION_WORDS.iter().find(|(name, ..)| word.is_word(name));
            let Some((_, turns, axis)) = found else {
                let known = MOTION_WORDS.map(|(name, ..)| name);
                return Err(unknown("motion", &word, &known));
            };
            self.expect(b'=', &format!("`=` and an amount for {}", word.text))?;
            let amount = self.expression()?;
            motions.push(RawMotion { turns: *turns, axis: *axis, amount });
            if !self.skip(b',')? {
                break;
            }
        }
        self.close(b')', "`,` or ")?;
        Ok(motions)
    }

    /// The rest of a primitive, after its word: `(x=…, y=…)`.
    pub fn shape(&mut self, kind: ShapeKind, word: &Token) -> Read<Term> {
        self.expect(b'(', &format!("`(` after {}", kind.name()))?;
        let mut sizes = [None, None, None];
        while !self.token.is_symbol(b')') {
            self.size(kind, &mut sizes)?;
            if !self.skip(b',')? {
                break;
            }
        }
        self.close(b')', "`,` or ")?;
        if self.syntax.shapes.len() >= DEFINITIONS {
            let message = format!("more than {DEFINITIONS} primitives in the text; expected at most as many");
            return Err(Fault::new(word.place, message));
        }
        self.push(Op::Shape(self.syntax.shapes.len() as u32), word.place)?;
        self.syntax.shapes.push(RawShape { kind, sizes, place: word.place, solid: self.current });
        Ok(Term::solid(1))
    }

    fn size(&mut self, kind: ShapeKind, sizes: &mut [Option<crate::syntax::Ops>; 3]) -> Read<()> {
        let known = kind.sizes();
        let word =
            self.expect_word(&format!("a size of {} by its name, {}", kind.name(), names::list(known)))?;
        let Some(slot) = known.iter().position(|n| word.is_word(n)) else {
            return Err(unknown(&format!("size of {}", kind.name()), &word, known));
        };
        self.expect(b'=', &format!("`=` and a value for the size {}", known[slot]))?;
        let value = self.expression()?;
        if sizes[slot].replace(value).is_some() {
            let message = format!("size {} is given twice; expected it once", quote(word.text));
            return Err(Fault::new(word.place, message));
        }
        let given = |name| known.iter().position(|n| *n == name).is_some_and(|i| sizes[i].is_some());
        if given("d") && given("r") {
            let message =
                format!("{} has both a diameter d and a radius r; expected one of them", kind.name());
            return Err(Fault::new(word.place, message));
        }
        Ok(())
    }

    /// The rest of `SYMMETRIC_UNION(solid, axis, kind, count, range)`, after its word.
    pub fn symmetric_union(&mut self, place: Place) -> Read<Term> {
        self.expect(b'(', "`(solid, axis, ROTATIONAL or TRANSLATIONAL, count, range)`")?;
        let solid_place = self.token.place;
        let solid = self.set()?;
        if solid.kind == Kind::Number {
            return Err(Fault::new(solid_place, "SYMMETRIC_UNION of a number; expected a solid"));
        }
        self.expect(b',', "`,` and the axis x, y or z")?;
        let axis = self.one_of("axis", &[("x", Axis::X), ("y", Axis::Y), ("z", Axis::Z)])?;
        self.expect(b',', "`,` and ROTATIONAL or TRANSLATIONAL")?;
        let kinds =
            [("ROTATIONAL", SymmetryKind::Rotational), ("TRANSLATIONAL", SymmetryKind::Translational)];
        let kind = self.one_of("symmetry", &kinds)?;
        self.expect(b',', "`,` and the number of copies")?;
        let count = self.count()?;
        self.expect(b',', "`,` and the range")?;
        let range = self.expression()?;
        self.close(b')', "")?;
        self.push(Op::Copies(self.syntax.copies.len() as u32), place)?;
        self.syntax.copies.push(RawCopies { kind, axis, count, range, place });
        Ok(Term::solid(solid.operands))
    }

    fn one_of<T: Copy>(&mut self, what: &str, known: &[(&str, T)]) -> Read<T> {
        let names: Vec<&str> = known.iter().map(|(n, _)| *n).collect();
        let word = self.expect_word(&names::list(&names))?;
        let found = known.iter().find(|(n, _)| word.is_word(n));
        found.map(|(_, value)| *value).ok_or_else(|| unknown(what, &word, &names))
    }

    fn count(&mut self) -> Read<u32> {
        let expected = format!("a whole number of copies from 1 to {PRIMITIVES}, written in digits");
        let TokenKind::Number(count) = self.token.kind else { return Err(self.unexpected(&expected)) };
        if count.fract() != 0.0 || !(1.0..=PRIMITIVES as f64).contains(&count) {
            return Err(self.unexpected(&expected));
        }
        self.take()?;
        Ok(count as u32)
    }
}

fn unknown(what: &str, word: &Token, known: &[&str]) -> Box<Fault> {
    let message = format!("no {what} is called {}; expected {}", quote(word.text), names::list(known));
    Fault::new(word.place, message)
}
