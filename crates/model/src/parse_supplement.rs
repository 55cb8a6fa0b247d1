//! The supplement: inertias, frictions, springs, and the initial state (Gelsey 1995, Fig. 13).

use crate::description::{PairData, Spring, StateValue, Supplement};
use crate::error::{Fault, Place, Read, number, quote};
use crate::lexer::{Lexer, Token, TokenKind};
use crate::machine::Machine;
use crate::names;

/// Reads a supplement to a machine.
pub(crate) fn parse(text: &str, machine: &Machine) -> Read<Supplement> {
    let mut lexer = Lexer::new(text, 1);
    let token = lexer.next()?;
    let mut reader = Reader { lexer, token, machine, supplement: Supplement::default() };
    while reader.token.kind != TokenKind::FileEnd {
        reader.line()?;
    }
    Ok(reader.supplement)
}

struct Reader<'a> {
    lexer: Lexer<'a>,
    token: Token<'a>,
    machine: &'a Machine,
    supplement: Supplement,
}

impl<'a> Reader<'a> {
    fn line(&mut self) -> Read<()> {
        if self.token.kind == TokenKind::LineEnd {
            return self.take().map(|_| ());
        }
        if self.token.is_symbol(b'<') {
            self.pair()?;
        } else if self.token.is_word("position") {
            let value = self.state_value("position")?;
            add(&mut self.supplement.positions, value, "position", self.machine)?;
        } else if self.token.is_word("velocity") {
            let value = self.state_value("velocity")?;
            add(&mut self.supplement.velocities, value, "velocity", self.machine)?;
        } else {
            return Err(
                self.unexpected("`< PART : FRAME > …`, `POSITION part value` or `VELOCITY part value`")
            );
        }
        if self.token.is_end() {
            return self.take().map(|_| ());
        }
        Err(self.unexpected("the end of the line"))
    }

    /// `< PART : FRAME > [inertia] friction [SPRING relaxed constant]`
    fn pair(&mut self) -> Read<()> {
        let place = self.take()?.place;
        let part = self.part()?;
        self.symbol(b':')?;
        let other = self.frame(part)?;
        self.symbol(b'>')?;
        let (inertia, friction) = self.inertia_and_friction(part)?;
        let spring = if self.token.is_word("spring") { Some(self.spring()?) } else { None };
        if let Some(earlier) = self.supplement.pairs.iter().find(|p| p.part == part) {
            return Err(twice(place, earlier.place, "line", &self.machine.parts()[part].name));
        }
        self.supplement.pairs.push(PairData { part, other, inertia, friction, spring, place });
        Ok(())
    }

    /// One number is the friction; the inertia then follows from the part's density.
    fn inertia_and_friction(&mut self, part: usize) -> Read<(Option<f64>, f64)> {
        let place = self.token.place;
        let first = self.number("the inertia and the friction")?;
        if !self.at_number() {
            if !(self.token.is_end() || self.token.is_word("spring")) {
                return Err(self.unexpected("the friction"));
            }
            let model = &self.machine.parts()[part];
            if model.density.is_none() {
                let name = &model.name;
                let message = format!(
                    "only one number, and {name} has no density; expected inertia and friction, or `attr {name} : density = …` in the model"
                );
                return Err(Fault::new(place, message));
            }
            return Ok((None, not_negative(first, place, "friction")?));
        }
        if first <= 0.0 {
            return Err(Fault::new(
                place,
                format!("the inertia is {}; expected a positive number", number(first)),
            ));
        }
        let place = self.token.place;
        let friction = self.number("the friction")?;
        Ok((Some(first), not_negative(friction, place, "friction")?))
    }

    fn spring(&mut self) -> Read<Spring> {
        self.take()?;
        let relaxed = self.number("the spring's relaxed position and constant")?;
        let place = self.token.place;
        let constant = self.number("the spring's constant")?;
        Ok(Spring { relaxed, constant: not_negative(constant, place, "spring constant")? })
    }

    fn state_value(&mut self, what: &str) -> Read<StateValue> {
        let place = self.take()?.place;
        let part_place = self.token.place;
        let part = self.part()?;
        if self.machine.parts()[part].is_frame {
            let message = format!("a {what} of the frame, which does not move; expected a moving part");
            return Err(Fault::new(part_place, message));
        }
        let value = self.number(&format!("the {what}"))?;
        Ok(StateValue { part, value, place })
    }

    fn part(&mut self) -> Read<usize> {
        let word = self.word("the name of a part")?;
        self.machine.part_index(word.text).map_or_else(|| self.unknown_part(&word), Ok)
    }

    fn unknown_part(&self, word: &Token) -> Read<usize> {
        let known: Vec<&str> = self.machine.parts().iter().map(|p| p.name.as_str()).collect();
        let expected = names::one_of(&known, word.text);
        let message = format!("no part is named {}; expected {expected}", quote(word.text));
        Err(Fault::new(word.place, message))
    }

    /// The frame by its name, or the word FRAME.
    fn frame(&mut self, part: usize) -> Read<usize> {
        let word = self.word("the frame")?;
        let named = self.machine.part_index(word.text);
        if named.is_none() && !word.is_word("frame") {
            return self.unknown_part(&word);
        }
        let Some(frame) = self.machine.frame() else {
            let message = "the machine has no frame; expected `attr PART : frame = 1` in the model";
            return Err(Fault::new(word.place, message));
        };
        if named.is_some_and(|n| n != frame) {
            let name = &self.machine.parts()[frame].name;
            let message = format!("{} is not the frame; expected `{name}` or FRAME", quote(word.text));
            return Err(Fault::new(word.place, message));
        }
        if part == frame {
            return Err(Fault::new(
                word.place,
                "the frame against itself; expected a moving part in front of `:`",
            ));
        }
        Ok(frame)
    }

    fn word(&mut self, expected: &str) -> Read<Token<'a>> {
        if self.token.kind == TokenKind::Word { self.take() } else { Err(self.unexpected(expected)) }
    }

    fn symbol(&mut self, symbol: u8) -> Read<()> {
        if self.token.is_symbol(symbol) {
            return self.take().map(|_| ());
        }
        Err(self.unexpected(&format!("`{}`", char::from(symbol))))
    }

    fn at_number(&self) -> bool {
        self.token.is_symbol(b'-') || matches!(self.token.kind, TokenKind::Number(_))
    }

    fn number(&mut self, expected: &str) -> Read<f64> {
        let negative = self.token.is_symbol(b'-');
        if negative {
            self.take()?;
        }
        let TokenKind::Number(value) = self.token.kind else { return Err(self.unexpected(expected)) };
        self.take()?;
        Ok(if negative { -value } else { value })
    }

    fn take(&mut self) -> Read<Token<'a>> {
        let taken = self.token;
        self.token = self.lexer.next()?;
        Ok(taken)
    }

    fn unexpected(&self, expected: &str) -> Box<Fault> {
        Fault::new(self.token.place, format!("{}; expected {expected}", self.token.describe()))
    }
}

fn add(values: &mut Vec<StateValue>, value: StateValue, what: &str, machine: &Machine) -> Read<()> {
    if let Some(earlier) = values.iter().find(|v| v.part == value.part) {
        return Err(twice(value.place, earlier.place, what, &machine.parts()[value.part].name));
    }
    values.push(value);
    Ok(())
}

fn not_negative(value: f64, place: Place, what: &str) -> Read<f64> {
    if value >= 0.0 {
        return Ok(value);
    }
    Err(Fault::new(place, format!("the {what} is {}; expected zero or a positive number", number(value))))
}

fn twice(place: Place, earlier: Place, what: &str, part: &str) -> Box<Fault> {
    let message = format!(
        "a second {what} for {part} (the first is at {}:{}); expected one",
        earlier.line, earlier.column
    );
    Fault::new(place, message)
}
