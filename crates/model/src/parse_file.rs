//! Statements: `generic`, definitions, `attr`.

use crate::error::{Fault, Place, Read, number, quote};
use crate::lexer::TokenKind;
use crate::limits::DEFINITIONS;
use crate::names;
use crate::parser::Parser;
use crate::syntax::{Attribute, AttributeKey, Definition, Kind, Op, Syntax};

/// Reads a model file.
pub(crate) fn parse(text: &str, file: u8) -> Read<Syntax> {
    let mut parser = Parser::new(text, file)?;
    parser.skip_blank_lines()?;
    parser.generic()?;
    loop {
        parser.skip_blank_lines()?;
        if parser.token.kind == TokenKind::FileEnd {
            return Ok(parser.syntax);
        }
        parser.statement()?;
    }
}

impl Parser<'_> {
    fn skip_blank_lines(&mut self) -> Read<()> {
        while self.token.kind == TokenKind::LineEnd {
            self.take()?;
        }
        Ok(())
    }

    /// `generic NAME(RESULT, NAME …)`
    fn generic(&mut self) -> Read<()> {
        if !self.token.is_word("generic") {
            return Err(self.unexpected("`generic NAME(RESULT)` at the beginning of the file"));
        }
        self.take()?;
        self.syntax.generic = self.expect_word("the name of the generic")?.text.to_string();
        self.expect(b'(', "`(` and the name of the result")?;
        self.syntax.result = self.expect_name("the name of the result")?;
        while self.skip(b',')? {
            let (name, place) = self.expect_name("the name of a number")?;
            self.formal(name, place)?;
        }
        self.close(b')', "`,` or ")?;
        self.expect_end_of_line("the end of the line")
    }

    /// A further name of the generic's list.
    fn formal(&mut self, name: u32, place: Place) -> Read<()> {
        let is_result = name == self.syntax.result.0;
        let entry = &mut self.syntax.names[name as usize];
        if is_result || entry.formal.replace(place).is_some() {
            let what = quote(&entry.text);
            return Err(Fault::new(place, format!("{what} is listed twice; expected another name")));
        }
        self.syntax.formals.push(name);
        if self.syntax.formals.len() > DEFINITIONS {
            return Err(Fault::new(
                place,
                format!("more than {DEFINITIONS} names; expected at most as many"),
            ));
        }
        Ok(())
    }

    fn statement(&mut self) -> Read<()> {
        if self.token.is_word("attr") {
            return self.attribute();
        }
        if self.token.is_word("generic") {
            return Err(self.fault_here("a second `generic`; expected one, at the beginning of the file"));
        }
        const EXPECTED: &str = "`NAME = …` or `attr …` (a line that goes on needs `\\` at its end)";
        let (name, place) = self.expect_name(EXPECTED)?;
        self.expect(b'=', &format!("`=` after the name {}", quote(&self.syntax.names[name as usize].text)))?;
        self.announce(name, place)?;
        if name == self.syntax.result.0 { self.assembly() } else { self.definition(name, place) }
    }

    /// Refuses a second definition of a name.
    pub fn announce(&self, name: u32, place: Place) -> Read<()> {
        let entry = &self.syntax.names[name as usize];
        let earlier = match entry.definition {
            Some(d) => Some(self.syntax.definitions[d as usize].place),
            None if name == self.syntax.result.0 && self.syntax.parts.is_some() => Some(self.syntax.result.1),
            None => None,
        };
        if let Some(at) = earlier {
            let what = quote(&entry.text);
            let message = format!(
                "{what} is already defined at {}:{}; expected a new name (letter case does not count)",
                at.line, at.column
            );
            return Err(Fault::new(place, message));
        }
        if self.syntax.definitions.len() >= DEFINITIONS {
            return Err(Fault::new(
                place,
                format!("more than {DEFINITIONS} definitions; expected at most as many"),
            ));
        }
        Ok(())
    }

    fn definition(&mut self, name: u32, place: Place) -> Read<()> {
        self.current = name;
        let term = self.set()?;
        let range = if self.token.is_word("in") { Some(self.range(term.kind)?) } else { None };
        if self.token.is_word("asb") {
            let result = quote(&self.syntax.names[self.syntax.result.0 as usize].text);
            return Err(self
                .fault_here(format!("`asb` outside the result; expected it in the definition of {result}")));
        }
        self.expect_end_of_line("an operator or the end of the line")?;
        self.syntax.names[name as usize].definition = Some(self.syntax.definitions.len() as u32);
        let kind = if range.is_some() { Kind::Number } else { term.kind };
        let ops = self.ops.drain(..).collect();
        self.syntax.definitions.push(Definition { name, place, kind, ops, range });
        Ok(())
    }

    /// The result: `PART asb PART …`
    fn assembly(&mut self) -> Read<()> {
        self.syntax.result.1 = self.token.place;
        let mut parts: Vec<(u32, Place)> = Vec::new();
        loop {
            let place = self.token.place;
            self.set()?;
            let ops: Vec<_> = self.ops.drain(..).collect();
            let [(Op::Name(part), _)] = ops[..] else {
                let message = "an operand of `asb` is not a plain name; expected the name of a solid, which is then a part";
                return Err(Fault::new(place, message));
            };
            parts.push((part, place));
            if !self.token.is_word("asb") {
                break;
            }
            self.take()?;
        }
        self.expect_end_of_line("`asb` or the end of the line")?;
        self.syntax.parts = Some(parts);
        Ok(())
    }

    /// `in [low, high]`
    fn range(&mut self, kind: Kind) -> Read<(f64, f64)> {
        if kind == Kind::Solid {
            return Err(self.fault_here("a range on a solid; expected a range on a number only"));
        }
        self.take()?;
        let place = self.expect(b'[', "`[low, high]`")?;
        let low = self.signed_number("the least value")?;
        self.expect(b',', "`,` and the greatest value")?;
        let high = self.signed_number("the greatest value")?;
        self.close(b']', "")?;
        if low >= high {
            return Err(Fault::new(
                place,
                format!("the range [{}, {}] is empty; expected low < high", number(low), number(high)),
            ));
        }
        Ok((low, high))
    }

    /// A number with an optional sign.
    pub fn signed_number(&mut self, expected: &str) -> Read<f64> {
        let negative = self.skip(b'-')?;
        let TokenKind::Number(value) = self.token.kind else { return Err(self.unexpected(expected)) };
        self.take()?;
        Ok(if negative { -value } else { value })
    }

    /// `attr NAME : KEY = value`
    fn attribute(&mut self) -> Read<()> {
        self.take()?;
        let (name, place) = self.expect_name("the name of a part or solid")?;
        self.expect(b':', "`:`")?;
        let word = self.expect_word("the name of an attribute")?;
        let lower = word.text.to_ascii_lowercase();
        let Some((_, key)) = AttributeKey::NAMES.iter().find(|(n, _)| *n == lower) else {
            let known = AttributeKey::NAMES.map(|(n, _)| n);
            let message =
                format!("no attribute is called {}; expected {}", quote(word.text), names::list(&known));
            return Err(Fault::new(word.place, message));
        };
        self.expect(b'=', "`=`")?;
        let value_place = self.token.place;
        let value = self.expression()?;
        self.expect_end_of_line("the end of the line")?;
        if self.syntax.attributes.len() >= DEFINITIONS {
            return Err(Fault::new(
                place,
                format!("more than {DEFINITIONS} attributes; expected at most as many"),
            ));
        }
        self.syntax.attributes.push(Attribute { name, place, key: *key, value, value_place });
        Ok(())
    }
}
