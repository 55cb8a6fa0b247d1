//! Parameters and solids of a TOML file, as the syntax that PADL's reader makes.

use super::fields::{Fields, Node};
use crate::error::{Fault, Place, Read, number, quote};
use crate::lexer::{Token, TokenKind};
use crate::limits::NAME_CHARACTERS;
use crate::parser::Parser;
use crate::syntax::{Definition, Kind, Name, Op, Ops, Syntax};
use toml_edit::Value;

/// What a parameter's table says beside its value.
#[derive(Clone, Debug, Default)]
pub(crate) struct ParameterNote {
    pub whole: bool,
    pub unit: Option<String>,
    pub meaning: Option<String>,
}

/// Characters of a unit and of a meaning.
const UNIT: usize = 20;
const MEANING: usize = 200;

/// Collects definitions.
pub(crate) struct Definitions<'a> {
    parser: Parser<'a>,
    pub notes: Vec<ParameterNote>,
    pub parts: Vec<(u32, Place)>,
}

impl<'a> Definitions<'a> {
    pub fn new() -> Read<Self> {
        let mut parser = Parser::new("", 0)?;
        // No name is the result until all are known.
        parser.syntax.result = (u32::MAX, Place::default());
        Ok(Self { parser, notes: Vec::new(), parts: Vec::new() })
    }

    pub fn parameter(&mut self, key: &'a str, place: Place, node: &Node<'a>) -> Read<()> {
        let what = format!("parameter {}", quote(key));
        let name = self.name(key, place)?;
        let (mut note, mut range) = (ParameterNote::default(), None);
        let mut value = *node;
        if node.is_table() {
            let fields = node.table(&what)?;
            fields.allow(&what, &["value", "unit", "range", "whole", "meaning"])?;
            value = fields.need("value", &what)?;
            range = fields.get("range").map(|r| interval(&r, &what)).transpose()?;
            note.whole = fields.get("whole").map(|w| w.flag("whole")).transpose()?.unwrap_or(false);
            note.unit = fields.get("unit").map(|u| u.words("unit", UNIT)).transpose()?;
            note.meaning = fields.get("meaning").map(|m| m.words("meaning", MEANING)).transpose()?;
        }
        let ops = self.numeric(&value, &what)?;
        self.define(name, place, Kind::Number, ops, range);
        self.notes.push(note);
        Ok(())
    }

    /// A named solid.
    pub fn solid(&mut self, key: &'a str, place: Place, node: &Node<'a>) -> Read<()> {
        let name = self.name(key, place)?;
        let ops = self.set(name, node, &format!("solid {}", quote(key)))?;
        self.define(name, place, Kind::Solid, ops, None);
        Ok(())
    }

    /// A part; without a solid it is empty.
    pub fn part(&mut self, key: &'a str, place: Place, solid: Option<Node<'a>>) -> Read<()> {
        let name = self.name(key, place)?;
        let ops = match solid {
            Some(node) => self.set(name, &node, &format!("the solid of part {}", quote(key)))?,
            None => Vec::new(),
        };
        self.define(name, place, Kind::Solid, ops, None);
        self.parts.push((name, place));
        Ok(())
    }

    /// A part that the file does not name.
    pub fn implicit_part(&mut self, name: &str, place: Place) {
        let index = self.unnamed(name);
        self.define(index, place, Kind::Solid, Vec::new(), None);
        self.parts.push((index, place));
    }

    pub fn is_known(&self, name: &str) -> bool {
        self.parser.syntax.names.iter().any(|n| n.text.eq_ignore_ascii_case(name) && n.definition.is_some())
    }

    pub fn finish(mut self, machine: &str) -> (Syntax, Vec<ParameterNote>) {
        let result = self.unnamed(machine);
        let mut syntax = self.parser.syntax;
        syntax.generic = machine.to_string();
        syntax.result = (result, Place { file: 0, line: 1, column: 1 });
        syntax.parts = Some(self.parts);
        (syntax, self.notes)
    }

    /// A name that no text can refer to.
    fn unnamed(&mut self, text: &str) -> u32 {
        let names = &mut self.parser.syntax.names;
        names.push(Name { text: text.to_string(), definition: None, formal: None });
        names.len() as u32 - 1
    }

    fn name(&mut self, key: &'a str, place: Place) -> Read<u32> {
        check_word(key, place)?;
        let token = Token { kind: TokenKind::Word, text: key, place };
        self.parser.check_name(&token)?;
        let name = self.parser.name(&token)?;
        self.parser.announce(name, place)?;
        self.parser.current = name;
        Ok(name)
    }

    fn define(&mut self, name: u32, place: Place, kind: Kind, ops: Ops, range: Option<(f64, f64)>) {
        let syntax = &mut self.parser.syntax;
        syntax.names[name as usize].definition = Some(syntax.definitions.len() as u32);
        syntax.definitions.push(Definition { name, place, kind, ops, range });
    }

    fn numeric(&mut self, node: &Node<'a>, what: &str) -> Read<Ops> {
        if !matches!(node.value(), Some(Value::String(_))) {
            let value = node.number(&format!("the value of {what}"))?;
            return Ok(vec![(Op::Number(value), node.place)]);
        }
        self.enter(node, what)?;
        let ops = self.parser.expression()?;
        self.parser.expect_end_of_line("an operator or the end of the text")?;
        Ok(ops)
    }

    fn set(&mut self, _name: u32, node: &Node<'a>, what: &str) -> Read<Ops> {
        self.enter(node, what)?;
        let place = self.parser.token.place;
        let term = self.parser.set()?;
        let ops: Ops = self.parser.ops.drain(..).collect();
        self.parser.expect_end_of_line("an operator or the end of the text")?;
        if term.kind == Kind::Number {
            return Err(Fault::new(place, format!("{what} is a number; expected a solid")));
        }
        Ok(ops)
    }

    fn enter(&mut self, node: &Node<'a>, what: &str) -> Read<()> {
        let value = node.value().ok_or_else(|| node.fault(format!("{what} is no text; expected one")))?;
        let (text, place) = node.source.string(value, what)?;
        self.parser.enter(text, place)
    }
}

/// Letters, digits and `_`, not beginning with a digit.
pub(crate) fn check_word(key: &str, place: Place) -> Read<()> {
    let letter = |b: u8| b.is_ascii_alphabetic() || b == b'_';
    let fits = key.bytes().next().is_some_and(letter)
        && key.bytes().all(|b| letter(b) || b.is_ascii_digit())
        && key.len() <= NAME_CHARACTERS;
    if fits {
        return Ok(());
    }
    let message = format!(
        "{} is no name; expected letters, digits and `_`, at most {NAME_CHARACTERS}, the first no digit",
        quote(key)
    );
    Err(Fault::new(place, message))
}

fn interval(node: &Node<'_>, what: &str) -> Read<(f64, f64)> {
    let ends = node.list("range")?;
    let [low, high] = &ends[..] else {
        return Err(node.fault(format!("the range of {what} has not two ends; expected [low, high]")));
    };
    let (low, high) = (low.number("the low end")?, high.number("the high end")?);
    if low >= high {
        return Err(node.fault(format!(
            "the range [{}, {}] is empty; expected low < high",
            number(low),
            number(high)
        )));
    }
    Ok((low, high))
}

/// All parameters, then all solids.
pub(crate) fn definitions<'a>(root: &Fields<'a>) -> Read<Definitions<'a>> {
    let mut found = Definitions::new()?;
    if let Some(node) = root.get("parameters") {
        let table = node.table("parameters")?;
        for (key, place) in table.keys() {
            found.parameter(key, place, &table.need(key, "parameters")?)?;
        }
    }
    if let Some(node) = root.get("solids") {
        let table = node.table("solids")?;
        for (key, place) in table.keys() {
            found.solid(key, place, &table.need(key, "solids")?)?;
        }
    }
    Ok(found)
}
