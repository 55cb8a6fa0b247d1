//! Bad input: where, what, and what was expected.

use std::fmt;

/// A place in a source text; line and column count from 1, columns in characters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// 0 the model, 1 the supplement, 2 the command line (`--set`).
    pub file: u8,
    pub line: u32,
    pub column: u32,
}

/// What stands for a file's name in errors about `--set`.
pub(crate) const SETTING_FILE: &str = "--set";

impl Place {
    /// The place of everything given by `--set`.
    pub const SETTING: Self = Self { file: 2, line: 1, column: 1 };
}

/// Bad input: shown as `FILE:LINE:COL: error: what; what was expected`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    pub file: String,
    pub line: u32,
    pub column: u32,
    pub message: String,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}: error: {}", self.file, self.line, self.column, self.message)
    }
}

impl std::error::Error for Error {}

/// A message with its place, before the file's name is put in front.
#[derive(Clone, Debug)]
pub(crate) struct Fault {
    pub place: Place,
    /// Another place that has a share in it.
    pub also: Option<Place>,
    pub message: String,
}

impl Fault {
    /// Boxed, so that the results of the parser's many small functions stay small.
    pub fn new(place: Place, message: impl Into<String>) -> Box<Self> {
        Box::new(Self { place, also: None, message: message.into() })
    }
}

/// Result of reading; the error still lacks the file's name.
pub(crate) type Read<T> = Result<T, Box<Fault>>;

/// Characters of user text shown in a message.
const SHOWN: usize = 40;

/// User text between backquotes, shortened to 40 characters; whatever could disturb a terminal is escaped.
pub fn quote(text: &str) -> String {
    let mut shown: String = text.chars().take(SHOWN).map(visible).collect();
    if text.chars().nth(SHOWN).is_some() {
        shown.push('…');
    }
    format!("`{shown}`")
}

/// A number for messages: very small and very large ones with an exponent.
pub(crate) fn number(x: f64) -> String {
    if x == 0.0 || !x.is_finite() || (1e-5..1e16).contains(&x.abs()) {
        x.to_string()
    } else {
        format!("{x:e}")
    }
}

/// A file's name for messages: whole, but on one line and without control characters.
pub(crate) fn file_name(name: &str) -> String {
    name.chars().map(visible).collect()
}

fn visible(c: char) -> String {
    if c == ' ' || (!is_control(c) && !c.is_whitespace()) {
        c.to_string()
    } else {
        c.escape_unicode().to_string()
    }
}

/// Control characters, and those that are invisible or change the direction of text.
pub(crate) fn is_control(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}
