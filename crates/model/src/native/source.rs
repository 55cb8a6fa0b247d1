//! The text of a TOML file: where in it things stand.

use crate::error::{Fault, Place, Read};
use std::ops::Range;
use toml_edit::{Document, Value};

/// Size of a TOML file in bytes: 2 MiB. Every value keeps the space around it, so the limit is lower than that of PADL.
pub(crate) const TOML_BYTES: usize = 2 * 1024 * 1024;

/// Characters that begin in a piece of UTF-8.
fn begun(bytes: &[u8]) -> usize {
    bytes.iter().filter(|b| **b & 0xc0 != 0x80).count()
}

/// A text with the places of its bytes.
pub(crate) struct Source<'a> {
    pub text: &'a str,
    /// Where each line begins.
    lines: Vec<usize>,
    /// Characters before each block of bytes, so that places on long lines cost no more than others.
    characters: Vec<usize>,
}

/// Bytes of a block.
const BLOCK: usize = 256;

impl<'a> Source<'a> {
    pub fn new(text: &'a str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i + 1);
        let mut characters = vec![0];
        for block in text.as_bytes().chunks(BLOCK) {
            characters.push(characters[characters.len() - 1] + begun(block));
        }
        Self { text, lines: std::iter::once(0).chain(ends).collect(), characters }
    }

    pub fn document(&self) -> Read<Document<&'a str>> {
        if self.text.len() > TOML_BYTES {
            let message = format!("the file is larger than {TOML_BYTES} bytes; expected at most 2 MiB");
            return Err(Fault::new(self.place(0), message));
        }
        Document::parse(self.text).map_err(|e| {
            let at = e.span().map_or(0, |s| s.start);
            let told = e.message().lines().next().unwrap_or("").trim_end_matches('.').to_string();
            let told: String = told.chars().take(120).filter(|c| !c.is_control()).collect();
            Fault::new(self.place(at), format!("no TOML: {told}; expected a TOML file"))
        })
    }

    /// The place of a byte; columns count characters.
    pub fn place(&self, offset: usize) -> Place {
        let offset = offset.min(self.text.len());
        let line = self.lines.partition_point(|l| *l <= offset) - 1;
        let column = self.characters_before(offset) - self.characters_before(self.lines[line]);
        Place { file: 0, line: line as u32 + 1, column: column as u32 + 1 }
    }

    fn characters_before(&self, offset: usize) -> usize {
        let block = offset / BLOCK;
        self.characters[block] + begun(&self.text.as_bytes()[block * BLOCK..offset])
    }

    pub fn place_of(&self, span: Option<Range<usize>>) -> Place {
        self.place(span.map_or(0, |s| s.start))
    }

    /// The text between the quotes of a string, and where it begins.
    ///
    /// # Errors
    /// A string with escapes: expressions and solids need none.
    pub fn string(&self, value: &Value, what: &str) -> Read<(&'a str, Place)> {
        let place = self.place_of(value.span());
        let fault = |message: String| Fault::new(place, message);
        let Some(content) = value.as_str() else {
            return Err(fault(format!("{what} is no text; expected it between quotes")));
        };
        let raw = value.span().and_then(|s| Some((s.start, self.text.get(s)?)));
        let (start, raw) = raw.ok_or_else(|| fault(format!("{what} has no place; expected a text")))?;
        let quotes = if raw.starts_with("'''") || raw.starts_with("\"\"\"") { 3 } else { 1 };
        let inner = raw.get(quotes..raw.len().saturating_sub(quotes)).unwrap_or("");
        // The first line end after three quotes is not part of the text.
        let skip = match quotes {
            3 if inner.starts_with("\r\n") => 2,
            3 if inner.starts_with('\n') => 1,
            _ => 0,
        };
        let inner = &inner[skip..];
        if inner.replace("\r\n", "\n") != content.replace("\r\n", "\n") {
            return Err(fault(format!("{what} has escapes; expected plain text between the quotes")));
        }
        Ok((inner, self.place(start + quotes + skip)))
    }
}
