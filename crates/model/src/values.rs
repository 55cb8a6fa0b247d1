//! Values of the numeric definitions.

use crate::error::{Error, Fault, Place, Read, SETTING_FILE};
use crate::lexer::{Lexer, Token, TokenKind};
use mainspring_geometry::Scalar;

/// Names and values given by `--set`; names in any letter case.
pub type Overrides = Vec<(String, f64)>;

/// The value of every numeric definition, in the order of [`crate::Machine::parameters`].
#[derive(Clone, Debug, PartialEq)]
pub struct Values<S = f64> {
    pub(crate) numbers: Vec<S>,
}

impl<S: Scalar> Values<S> {
    /// The value of a parameter by its index.
    pub fn get(&self, parameter: usize) -> Option<S> {
        self.numbers.get(parameter).copied()
    }

    /// All values, one for each parameter.
    pub fn as_slice(&self) -> &[S] {
        &self.numbers
    }

    /// The values without derivatives.
    pub fn re(&self) -> Values<f64> {
        Values { numbers: self.numbers.iter().map(|v| v.re()).collect() }
    }
}

/// Reads a setting such as `gap=36`, as given to `--set`: a name, `=`, and a number with an optional sign.
/// Expressions are not accepted; whether the name is a parameter is checked by [`crate::Machine::values`].
pub fn parse_setting(text: &str) -> Result<(String, f64), Error> {
    setting(text).map_err(|fault| {
        let Place { line, column, .. } = fault.place;
        Error { file: SETTING_FILE.to_string(), line, column, message: fault.message }
    })
}

fn setting(text: &str) -> Read<(String, f64)> {
    let mut lexer = Lexer::new(text, Place::SETTING.file);
    let name = lexer.next()?;
    check(&name, name.kind == TokenKind::Word)?;
    let equals = lexer.next()?;
    check(&equals, equals.is_symbol(b'='))?;
    let mut token = lexer.next()?;
    let negative = token.is_symbol(b'-');
    if negative {
        token = lexer.next()?;
    }
    let TokenKind::Number(value) = token.kind else { return Err(misfit(&token)) };
    let end = lexer.next()?;
    check(&end, end.kind == TokenKind::FileEnd)?;
    Ok((name.text.to_string(), if negative { -value } else { value }))
}

fn check(token: &Token, fits: bool) -> Read<()> {
    if fits { Ok(()) } else { Err(misfit(token)) }
}

fn misfit(token: &Token) -> Box<Fault> {
    Fault::new(token.place, format!("{}; expected NAME=NUMBER", token.describe()))
}
