//! The parser's ground: one token of look-ahead, names, brackets, and messages.

use crate::error::{Fault, Place, Read, quote};
use crate::expression::Function;
use crate::lexer::{Lexer, Token, TokenKind};
use crate::limits::{FILE_NODES, NAMES};
use crate::names;
use crate::shape_text::ShapeKind;
use crate::syntax::{Name, Op, Ops, Syntax};
use std::collections::HashMap;

/// Words with a meaning of their own, besides functions and primitives.
const KEYWORDS: [&str; 11] = [
    "generic",
    "attr",
    "asb",
    "un",
    "dif",
    "int",
    "at",
    "in",
    "symmetric_union",
    "rotational",
    "translational",
];

/// Words that other programs take for numbers.
const NO_NUMBERS: [&str; 3] = ["nan", "inf", "infinity"];

pub(crate) struct Parser<'a> {
    lexer: Lexer<'a>,
    pub token: Token<'a>,
    names: HashMap<String, u32>,
    pub syntax: Syntax,
    /// Operations of the definition or expression being read.
    pub ops: Ops,
    /// The name being defined.
    pub current: u32,
    /// Operations read so far.
    nodes: usize,
}

impl<'a> Parser<'a> {
    pub fn new(text: &'a str, file: u8) -> Read<Self> {
        let mut lexer = Lexer::new(text, file);
        let token = lexer.next()?;
        let syntax = Syntax::default();
        Ok(Self { lexer, token, names: HashMap::new(), syntax, ops: Vec::new(), current: 0, nodes: 0 })
    }

    /// For a piece of a file that begins at a place.
    pub fn within(text: &'a str, place: Place) -> Read<Self> {
        let mut parser = Self::new("", place.file)?;
        parser.enter(text, place)?;
        Ok(parser)
    }

    /// Goes on with another piece of a file; names stay known.
    pub fn enter(&mut self, text: &'a str, place: Place) -> Read<()> {
        self.lexer = Lexer::within(text, place);
        self.token = self.lexer.next()?;
        Ok(())
    }

    /// Operations read so far, in all pieces.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Takes the current token.
    pub fn take(&mut self) -> Read<Token<'a>> {
        let taken = self.token;
        self.token = self.lexer.next()?;
        Ok(taken)
    }

    /// Takes the current token if it is this symbol.
    pub fn skip(&mut self, symbol: u8) -> Read<bool> {
        let found = self.token.is_symbol(symbol);
        if found {
            self.take()?;
        }
        Ok(found)
    }

    pub fn expect(&mut self, symbol: u8, expected: &str) -> Read<Place> {
        if !self.token.is_symbol(symbol) {
            return Err(self.unexpected(expected));
        }
        Ok(self.take()?.place)
    }

    /// Takes the bracket that closes the innermost open one.
    pub fn close(&mut self, symbol: u8, else_expected: &str) -> Read<()> {
        if self.token.is_symbol(symbol) {
            self.take()?;
            return Ok(());
        }
        let bracket = char::from(symbol);
        let opened = match self.lexer.open_bracket() {
            Some((open, at)) => format!(" to close `{}` of {}:{}", char::from(open), at.line, at.column),
            None => String::new(),
        };
        Err(self.unexpected(&format!("{else_expected}`{bracket}`{opened}")))
    }

    pub fn expect_end_of_line(&mut self, expected: &str) -> Read<()> {
        if self.token.is_end() {
            return self.take().map(|_| ());
        }
        Err(self.unexpected(expected))
    }

    /// Adds an operation to the expression being read.
    pub fn push(&mut self, op: Op, place: Place) -> Read<()> {
        self.nodes += 1;
        if self.nodes > FILE_NODES {
            let what = "numbers, names, operators and primitives in the file";
            return Err(Fault::new(
                place,
                format!("more than {FILE_NODES} {what}; expected at most as many"),
            ));
        }
        self.ops.push((op, place));
        Ok(())
    }

    /// A word of any meaning.
    pub fn expect_word(&mut self, expected: &str) -> Read<Token<'a>> {
        if self.token.kind != TokenKind::Word {
            return Err(self.unexpected(expected));
        }
        self.take()
    }

    /// A word that may be a name; its index and place.
    pub fn expect_name(&mut self, expected: &str) -> Read<(u32, Place)> {
        let word = self.expect_word(expected)?;
        self.check_name(&word)?;
        Ok((self.name(&word)?, word.place))
    }

    pub fn check_name(&self, word: &Token) -> Read<()> {
        let lower = word.text.to_ascii_lowercase();
        let meaning = if Function::named(&lower).is_some() {
            "a function"
        } else if ShapeKind::named(&lower).is_some() {
            "a primitive"
        } else if KEYWORDS.contains(&lower.as_str()) {
            "a word of the language"
        } else if NO_NUMBERS.contains(&lower.as_str()) {
            "no finite number and no name"
        } else {
            return Ok(());
        };
        Err(Fault::new(word.place, format!("{} is {meaning}; expected a name of your own", quote(word.text))))
    }

    /// The index of a name; spelled as it is first written.
    pub fn name(&mut self, word: &Token) -> Read<u32> {
        let lower = word.text.to_ascii_lowercase();
        if let Some(index) = self.names.get(&lower) {
            return Ok(*index);
        }
        let index = self.syntax.names.len();
        if index == NAMES {
            let message = format!("more than {NAMES} different names; expected at most as many");
            return Err(Fault::new(word.place, message));
        }
        self.names.insert(lower, index as u32);
        self.syntax.names.push(Name { text: word.text.to_string(), definition: None, formal: None });
        Ok(index as u32)
    }

    pub fn unexpected(&self, expected: &str) -> Box<Fault> {
        self.fault_here(format!("{}; expected {expected}", self.token.describe()))
    }

    pub fn fault_here(&self, message: impl Into<String>) -> Box<Fault> {
        Fault::new(self.token.place, message)
    }

    /// A word followed by `(` that is neither a function nor a primitive.
    pub fn unknown_call(&self, word: &Token) -> Box<Fault> {
        let functions = Function::NAMES.iter().map(|(n, _)| *n);
        let known: Vec<&str> = ShapeKind::NAMES.iter().map(|(n, _)| *n).chain(functions).collect();
        let expected = names::one_of(&known, word.text);
        let what = quote(word.text);
        Fault::new(word.place, format!("{what} is neither a primitive nor a function; expected {expected}"))
    }
}
