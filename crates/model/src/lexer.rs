//! From text to tokens. A line end inside open brackets is white space, `\` continues a line, `#` starts a comment.

use crate::error::{Fault, Place, Read, is_control, quote};
use crate::limits::{NAME_CHARACTERS, NESTING, NUMBER_CHARACTERS};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TokenKind {
    /// Letters, digits and `_`, beginning with a letter or `_`.
    Word,
    Number(f64),
    /// One of `()[]=,:+-*/<>`.
    Symbol(u8),
    LineEnd,
    FileEnd,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Token<'a> {
    pub kind: TokenKind,
    pub text: &'a str,
    pub place: Place,
}

impl Token<'_> {
    pub fn is_symbol(&self, symbol: u8) -> bool {
        self.kind == TokenKind::Symbol(symbol)
    }

    /// Is it this word, in any letter case?
    pub fn is_word(&self, word: &str) -> bool {
        self.kind == TokenKind::Word && self.text.eq_ignore_ascii_case(word)
    }

    pub fn is_end(&self) -> bool {
        matches!(self.kind, TokenKind::LineEnd | TokenKind::FileEnd)
    }

    /// For messages.
    pub fn describe(&self) -> String {
        match self.kind {
            TokenKind::LineEnd => "the line ends here".to_string(),
            TokenKind::FileEnd => "the file ends here".to_string(),
            _ => format!("unexpected {}", quote(self.text)),
        }
    }
}

pub(crate) struct Lexer<'a> {
    text: &'a str,
    at: usize,
    place: Place,
    /// The brackets that are open, outermost first.
    open: Vec<(u8, Place)>,
    /// Line ends are white space everywhere.
    flat: bool,
}

impl<'a> Lexer<'a> {
    pub fn new(text: &'a str, file: u8) -> Self {
        Self { text, at: 0, place: Place { file, line: 1, column: 1 }, open: Vec::new(), flat: false }
    }

    /// Of a piece of a file that begins at a place; its line ends are white space.
    pub fn within(text: &'a str, place: Place) -> Self {
        Self { text, at: 0, place, open: Vec::new(), flat: true }
    }

    /// The innermost open bracket.
    pub fn open_bracket(&self) -> Option<(u8, Place)> {
        self.open.last().copied()
    }

    pub fn next(&mut self) -> Read<Token<'a>> {
        self.skip_space()?;
        let Some(byte) = self.byte(0) else { return Ok(self.token(TokenKind::FileEnd, 0)) };
        match byte {
            b'\n' | b'\r' => Ok(self.line_end()),
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => self.word(),
            b'0'..=b'9' => self.number(),
            b'.' if self.byte(1).is_some_and(|b| b.is_ascii_digit()) => self.number(),
            b'(' | b')' | b'[' | b']' => self.bracket(byte),
            b'=' | b',' | b':' | b'+' | b'-' | b'*' | b'/' | b'<' | b'>' => {
                Ok(self.token(TokenKind::Symbol(byte), 1))
            }
            _ => Err(self.stranger()),
        }
    }

    fn byte(&self, ahead: usize) -> Option<u8> {
        self.text.as_bytes().get(self.at + ahead).copied()
    }

    /// A token of ASCII characters, `length` of them.
    fn token(&mut self, kind: TokenKind, length: usize) -> Token<'a> {
        let token = Token { kind, text: &self.text[self.at..self.at + length], place: self.place };
        self.advance(length);
        token
    }

    fn advance(&mut self, length: usize) {
        self.at += length;
        self.place.column += length as u32;
    }

    fn skip_space(&mut self) -> Read<()> {
        while let Some(byte) = self.byte(0) {
            match byte {
                b' ' | b'\t' => self.advance(1),
                b'#' => self.skip_comment(),
                b'\n' | b'\r' if self.flat || !self.open.is_empty() => {
                    self.line_end();
                }
                b'\\' => self.continuation()?,
                _ => break,
            }
        }
        Ok(())
    }

    fn skip_comment(&mut self) {
        let rest = &self.text[self.at..];
        let length = rest.find(['\n', '\r']).unwrap_or(rest.len());
        self.at += length;
        self.place.column += rest[..length].chars().count() as u32;
    }

    fn continuation(&mut self) -> Read<()> {
        let place = self.place;
        self.advance(1);
        while matches!(self.byte(0), Some(b' ' | b'\t')) {
            self.advance(1);
        }
        if self.byte(0) == Some(b'#') {
            self.skip_comment();
        }
        match self.byte(0) {
            Some(b'\n' | b'\r') => self.line_end(),
            None => return Ok(()),
            _ => {
                return Err(Fault::new(
                    place,
                    "`\\` inside a line; expected it at a line's end, to continue the line",
                ));
            }
        };
        Ok(())
    }

    fn line_end(&mut self) -> Token<'a> {
        let length = if self.text[self.at..].starts_with("\r\n") { 2 } else { 1 };
        let token = self.token(TokenKind::LineEnd, length);
        self.place.line += 1;
        self.place.column = 1;
        token
    }

    fn word(&mut self) -> Read<Token<'a>> {
        let length = self.word_length(0);
        if length > NAME_CHARACTERS {
            let what = quote(&self.text[self.at..self.at + length]);
            let message = format!("name {what} has {length} characters; expected at most {NAME_CHARACTERS}");
            return Err(Fault::new(self.place, message));
        }
        Ok(self.token(TokenKind::Word, length))
    }

    fn word_length(&self, from: usize) -> usize {
        let bytes = &self.text.as_bytes()[self.at + from..];
        bytes.iter().position(|b| !b.is_ascii_alphanumeric() && *b != b'_').unwrap_or(bytes.len())
    }

    fn digits(&self, from: usize) -> usize {
        let bytes = &self.text.as_bytes()[self.at + from..];
        bytes.iter().position(|b| !b.is_ascii_digit()).unwrap_or(bytes.len())
    }

    fn number(&mut self) -> Read<Token<'a>> {
        let length = self.number_length();
        let text = &self.text[self.at..self.at + length];
        let fault = |message| Err(Fault::new(self.place, message));
        if length > NUMBER_CHARACTERS {
            let what = quote(text);
            return fault(format!(
                "number {what} has {length} characters; expected at most {NUMBER_CHARACTERS}"
            ));
        }
        let Ok(value) = text.parse::<f64>() else {
            return fault(format!("{} is not a number; expected one like 12, 0.5 or 1e-3", quote(text)));
        };
        if !value.is_finite() {
            return fault(format!("number {} is too large; expected at most {:e}", quote(text), f64::MAX));
        }
        let mantissa = text.split(['e', 'E']).next().unwrap_or(text);
        if value == 0.0 && mantissa.bytes().any(|b| matches!(b, b'1'..=b'9')) {
            return fault(format!("number {} is too small; expected 0 or a larger number", quote(text)));
        }
        Ok(self.token(TokenKind::Number(value), length))
    }

    /// Length of a number, together with whatever sticks to it and spoils it (as in `1_0` or `2x`).
    fn number_length(&self) -> usize {
        let mut length = self.digits(0);
        if self.byte(length) == Some(b'.') {
            length += 1 + self.digits(length + 1);
        }
        if matches!(self.byte(length), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(self.byte(length + 1), Some(b'+' | b'-')));
            let digits = self.digits(length + 1 + sign);
            length += if digits > 0 { 1 + sign + digits } else { 0 };
        }
        while self.byte(length).is_some_and(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'.') {
            length += 1;
        }
        length
    }

    fn bracket(&mut self, byte: u8) -> Read<Token<'a>> {
        if matches!(byte, b'(' | b'[') {
            if self.open.len() == NESTING {
                let message = format!(
                    "more than {NESTING} open brackets inside each other; expected at most {NESTING}"
                );
                return Err(Fault::new(self.place, message));
            }
            self.open.push((byte, self.place));
        } else {
            self.open.pop();
        }
        Ok(self.token(TokenKind::Symbol(byte), 1))
    }

    fn stranger(&self) -> Box<Fault> {
        let c = self.text[self.at..].chars().next().unwrap_or(' ');
        let kind = if is_control(c) { "control character" } else { "character" };
        let message = format!(
            "{kind} {} is not part of the language; expected ASCII letters, digits, brackets and operators",
            quote(&c.to_string())
        );
        Fault::new(self.place, message)
    }
}
