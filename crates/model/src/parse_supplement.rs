//! The supplement's text: one line each for a pair, a state, a force, a drive (after Gelsey 1995, Fig. 13).

use crate::error::{Fault, Place, Read, number, quote};
use crate::lexer::{Lexer, Token, TokenKind};
use crate::machine::Machine;
use crate::names;
use crate::supplement::{PairData, PartNumber, Spring, Supplement, once};

/// Reads a supplement to a machine.
pub(crate) fn parse(text: &str, machine: &Machine) -> Read<Supplement> {
    let mut lexer = Lexer::new(text, 1);
    let token = lexer.next()?;
    let mut reader = Reader { lexer, token, machine, supplement: Supplement::default() };
    while reader.token.kind != TokenKind::FileEnd {
        reader.line()?;
    }
    reader.supplement.check(machine)?;
    Ok(reader.supplement)
}

/// The words that begin a line, beside `<`.
pub(crate) const WORDS: [&str; 11] = [
    "POSITION", "VELOCITY", "TORQUE", "FORCE", "COULOMB", "SPEED", "TABLE", "STOP", "MASS", "GRAVITY",
    "CONTACT",
];

pub(crate) struct Reader<'a> {
    lexer: Lexer<'a>,
    pub token: Token<'a>,
    pub machine: &'a Machine,
    pub supplement: Supplement,
}

impl<'a> Reader<'a> {
    fn line(&mut self) -> Read<()> {
        if self.token.kind == TokenKind::LineEnd {
            return self.take().map(|_| ());
        }
        let word = WORDS.into_iter().find(|w| self.token.is_word(w));
        match word {
            None if self.token.is_symbol(b'<') => self.pair()?,
            None => return Err(self.stranger()),
            Some("POSITION") => {
                let value = self.state("position")?;
                self.supplement.positions.push(value);
            }
            Some("VELOCITY") => {
                let value = self.state("velocity")?;
                self.supplement.velocities.push(value);
            }
            Some(word) => self.acting(word)?,
        }
        if self.token.is_end() {
            return self.take().map(|_| ());
        }
        Err(self.unexpected("the end of the line"))
    }

    fn stranger(&self) -> Box<Fault> {
        let nearest = names::nearest(WORDS, self.token.text).filter(|_| self.token.kind == TokenKind::Word);
        match nearest {
            Some(word) => self.unexpected(&format!("`{word}`, the nearest word that begins a line")),
            None => self.unexpected(&format!(
                "`< PART : CARRIER > …` or a line that begins with {}",
                WORDS.join(", ")
            )),
        }
    }

    /// `< PART : CARRIER > [inertia] friction [SPRING relaxed constant]`
    fn pair(&mut self) -> Read<()> {
        let place = self.take()?.place;
        let part_place = self.token.place;
        let part = self.part()?;
        self.symbol(b':')?;
        let other = self.carrier(part, part_place)?;
        self.symbol(b'>')?;
        let number = self.token.place;
        let (inertia, friction) = self.inertia_and_friction()?;
        let spring = if self.token.is_word("spring") { Some(self.spring()?) } else { None };
        let earlier = self.supplement.pairs.iter().find(|p| p.part == part);
        once(self.machine, (part, place), "line", earlier.map(|p| ("line", p.place)))?;
        self.supplement.pairs.push(PairData { part, other, inertia, friction, spring, place, number });
        Ok(())
    }

    /// One number is the friction; the inertia then follows from the part's density or mass.
    fn inertia_and_friction(&mut self) -> Read<(Option<f64>, f64)> {
        let place = self.token.place;
        let first = self.number("the inertia and the friction")?;
        if !self.at_number() {
            if !(self.token.is_end() || self.token.is_word("spring")) {
                return Err(self.unexpected("the friction"));
            }
            return Ok((None, not_negative(first, place, "friction")?));
        }
        let inertia = positive(first, place, "inertia")?;
        let friction = self.not_negative("friction")?;
        Ok((Some(inertia), friction))
    }

    fn spring(&mut self) -> Read<Spring> {
        self.take()?;
        let relaxed = self.number("the spring's relaxed position and constant")?;
        let place = self.token.place;
        let constant = self.number("the spring's constant")?;
        Ok(Spring { relaxed, constant: not_negative(constant, place, "spring constant")? })
    }

    fn state(&mut self, what: &str) -> Read<PartNumber> {
        let (part, place) = self.moving(what)?;
        let value = self.number(&format!("the {what}"))?;
        let known = match what {
            "position" => &self.supplement.positions,
            _ => &self.supplement.velocities,
        };
        let earlier = known.iter().find(|v| v.part == part);
        once(self.machine, (part, place), what, earlier.map(|v| (what, v.place)))?;
        Ok(PartNumber { part, value, place })
    }

    /// The line's word and the part it is about, with the place of the line.
    pub fn moving(&mut self, what: &str) -> Read<(usize, Place)> {
        let place = self.take()?.place;
        let part_place = self.token.place;
        let part = self.part()?;
        if self.machine.parts()[part].is_frame {
            let message = format!("a {what} of the frame, which does not move; expected a moving part");
            return Err(Fault::new(part_place, message));
        }
        Ok((part, place))
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

    /// The other part of a pair, by its name; the frame also by the word FRAME.
    fn carrier(&mut self, part: usize, part_place: Place) -> Read<usize> {
        let word = self.word("the part that carries it, or FRAME")?;
        let named = self.machine.part_index(word.text);
        if named.is_none() && !word.is_word("frame") {
            return self.unknown_part(&word);
        }
        let Some(frame) = self.machine.frame() else {
            let message = "the machine has no frame; expected `attr PART : frame = 1` in the model";
            return Err(Fault::new(word.place, message));
        };
        let other = named.unwrap_or(frame);
        let name = &self.machine.parts()[other].name;
        let message = match part {
            _ if part == other && part == frame => {
                "the frame against itself; expected a moving part in front of `:`".to_string()
            }
            _ if part == other => {
                format!("{name} against itself; expected the part that carries it, or FRAME")
            }
            _ if part == frame => {
                let message = format!("the frame in front of `:`; expected `< {name} : FRAME >`");
                return Err(Fault::new(part_place, message));
            }
            _ => return Ok(other),
        };
        Err(Fault::new(word.place, message))
    }

    pub fn word(&mut self, expected: &str) -> Read<Token<'a>> {
        if self.token.kind == TokenKind::Word { self.take() } else { Err(self.unexpected(expected)) }
    }

    fn symbol(&mut self, symbol: u8) -> Read<()> {
        if self.token.is_symbol(symbol) {
            return self.take().map(|_| ());
        }
        Err(self.unexpected(&format!("`{}`", char::from(symbol))))
    }

    pub fn at_number(&self) -> bool {
        self.token.is_symbol(b'-') || matches!(self.token.kind, TokenKind::Number(_))
    }

    pub fn number(&mut self, expected: &str) -> Read<f64> {
        let negative = self.token.is_symbol(b'-');
        if negative {
            self.take()?;
        }
        let TokenKind::Number(value) = self.token.kind else { return Err(self.unexpected(expected)) };
        self.take()?;
        Ok(if negative { -value } else { value })
    }

    pub fn positive(&mut self, what: &str) -> Read<f64> {
        let place = self.token.place;
        positive(self.number(&format!("the {what}"))?, place, what)
    }

    pub fn not_negative(&mut self, what: &str) -> Read<f64> {
        let place = self.token.place;
        not_negative(self.number(&format!("the {what}"))?, place, what)
    }

    pub fn take(&mut self) -> Read<Token<'a>> {
        let taken = self.token;
        self.token = self.lexer.next()?;
        Ok(taken)
    }

    pub fn unexpected(&self, expected: &str) -> Box<Fault> {
        Fault::new(self.token.place, format!("{}; expected {expected}", self.token.describe()))
    }
}

fn positive(value: f64, place: Place, what: &str) -> Read<f64> {
    if value > 0.0 {
        return Ok(value);
    }
    Err(Fault::new(place, format!("the {what} is {}; expected a positive number", number(value))))
}

fn not_negative(value: f64, place: Place, what: &str) -> Read<f64> {
    if value >= 0.0 {
        return Ok(value);
    }
    Err(Fault::new(place, format!("the {what} is {}; expected zero or a positive number", number(value))))
}
