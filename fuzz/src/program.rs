//! Random programs of the language: mostly right, now and then wrong in one place.

use crate::random::Random;
use crate::soup::NUMBERS;
use std::fmt::Write as _;

/// Depth of random expressions.
const DEPTH: usize = 4;

pub struct Program<'a> {
    random: &'a mut Random,
    numbers: usize,
    solids: usize,
}

impl<'a> Program<'a> {
    pub fn new(random: &'a mut Random) -> Self {
        let (numbers, solids) = (random.below(5), 1 + random.below(6));
        Self { random, numbers, solids }
    }

    /// A model and its supplement.
    pub fn write(mut self) -> (String, String) {
        let mut lines = Vec::new();
        for i in 0..self.numbers {
            let range = if self.random.one_in(3) { " in [-1000, 1000]" } else { "" };
            lines.push(format!("n{i} = {}{range}", self.number(DEPTH, i)));
        }
        for i in 0..self.solids {
            lines.push(format!("s{i} = {}", self.solid(DEPTH, i)));
            self.attributes(i, &mut lines);
        }
        for _ in 0..self.random.below(4) {
            let (a, b) = (self.random.below(lines.len()), self.random.below(lines.len()));
            lines.swap(a, b);
        }
        let parts: Vec<String> = (0..self.solids).map(|i| format!("s{i}")).collect();
        let model = format!("generic g(r)\n{}\nr = {}\n", lines.join("\n"), parts.join(" asb "));
        (model, self.supplement())
    }

    fn attributes(&mut self, solid: usize, lines: &mut Vec<String>) {
        if solid == 0 && !self.random.one_in(5) {
            lines.push("attr s0 : frame = 1".to_string());
        }
        if self.random.one_in(3) {
            let density = self.positive();
            lines.push(format!("attr s{solid} : density = {density}"));
        }
        if self.random.one_in(6) {
            lines.push(format!("attr s{solid} : gear = 1"));
            if self.random.one_in(2) {
                lines.push(format!("attr s{solid} : teeth = {}", self.random.below(100)));
            }
        }
    }

    fn supplement(&mut self) -> String {
        let mut text = String::new();
        for i in 1..self.solids {
            let (inertia, friction) = (self.constant(), self.constant());
            let spring = if self.random.one_in(2) {
                format!(" SPRING {} {}", self.constant(), self.constant())
            } else {
                String::new()
            };
            let _ = writeln!(text, "< s{i} : FRAME > {inertia} {friction}{spring}");
            if self.random.one_in(3) {
                let word = self.random.pick(&["POSITION", "VELOCITY"]);
                let _ = writeln!(text, "{word} S{i} {}", self.constant());
            }
        }
        text
    }

    fn constant(&mut self) -> String {
        if self.random.one_in(40) {
            return self.random.pick(NUMBERS).to_string();
        }
        format!("{}", (self.random.below(4000) as f64) / 100.0)
    }

    /// Nearly always positive.
    fn positive(&mut self) -> String {
        let number = self.number(2, self.numbers);
        if self.random.one_in(20) { number } else { format!("0.1 + abs({number})") }
    }

    /// A numeric expression of numbers and the names n0 … before `names`.
    fn number(&mut self, depth: usize, names: usize) -> String {
        if depth == 0 || self.random.one_in(2) {
            return match names {
                0 => self.constant(),
                _ if self.random.one_in(2) => format!("n{}", self.random.below(names)),
                _ => self.constant(),
            };
        }
        let (a, b) = (self.number(depth - 1, names), self.number(depth - 1, names));
        match self.random.below(9) {
            0 => format!("{a} + {b}"),
            1 => format!("{a} - {b}"),
            2 => format!("{a}*{b}"),
            3 => format!("({a}/{b})"),
            4 => format!("-({a})"),
            5 => format!("{}({a}, {b})", self.random.pick(&["min", "max", "atan2"])),
            6 => format!("{}({a})", self.random.pick(&["sin", "cos", "tan"])),
            7 => format!("sqrt(abs({a}))"),
            _ => format!("({a}\n + {b})"),
        }
    }

    /// A solid of primitives and the names s0 … before `names`.
    fn solid(&mut self, depth: usize, names: usize) -> String {
        if depth == 0 || self.random.one_in(4) {
            return if names > 0 && self.random.one_in(3) {
                format!("S{}", self.random.below(names))
            } else {
                self.primitive()
            };
        }
        let a = self.solid(depth - 1, names);
        match self.random.below(6) {
            0 | 1 => format!("{a} at ({})", self.motions()),
            2 => {
                let kind = self.random.pick(&["ROTATIONAL", "TRANSLATIONAL"]);
                let (axis, count) = (self.random.pick(&["x", "y", "z"]), 1 + self.random.below(12));
                format!("SYMMETRIC_UNION({a}, {axis}, {kind}, {count}, {})", self.number(1, self.numbers))
            }
            _ => {
                let b = self.solid(depth - 1, names);
                format!("({a} {} {b})", self.random.pick(&["un", "un\\\n", "dif", "int"]))
            }
        }
    }

    fn primitive(&mut self) -> String {
        let (word, sizes): (&str, &[&str]) = self.random.pick(&[
            ("blo", &["x", "y", "z"] as &[&str]),
            ("cyl", &["d", "h"]),
            ("cyl", &["r", "h"]),
            ("con", &["d", "h"]),
            ("sph", &["r"]),
            ("wed", &["x", "y", "z"]),
        ]);
        let mut given = Vec::new();
        for size in sizes {
            if self.random.one_in(2) {
                given.push(format!("{size}={}", self.positive()));
            }
        }
        format!("{word}({})", given.join(", "))
    }

    fn motions(&mut self) -> String {
        let mut motions = Vec::new();
        for _ in 0..1 + self.random.below(3) {
            let word = self.random.pick(&["movx", "movy", "movz", "degx", "degy", "degz"]);
            let amount = if self.random.one_in(3) { "90".to_string() } else { self.number(2, self.numbers) };
            motions.push(format!("{word}={amount}"));
        }
        motions.join(", ")
    }
}
