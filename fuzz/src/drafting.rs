//! Random machines in TOML: parts drawn by lines and arcs, solids, stated motions, whatever a table may hold.
//!
//! Points come from a coarse grid, so that edges often coincide, touch or cross; some loops are regular and right.

use crate::random::Random;
use crate::soup::NUMBERS;
use std::fmt::Write as _;

const VALUES: &[&str] = &[
    "0",
    "1",
    "2",
    "-1",
    "0.5",
    "3",
    "4",
    "\"n0\"",
    "\"n1\"",
    "\"n0 + n1\"",
    "\"2*n1\"",
    "\"-n0\"",
    "\"sqrt(n1)\"",
];
const TEXTS: &[&str] = &[
    "\"blo()\"",
    "\"cyl(d=2)\"",
    "\"blo(x=3) dif cyl(d=n1)\"",
    "\"s0 un cyl()\"",
    "'''\ncyl(r=n0)\n dif cyl(d=1)'''",
];

pub struct Drafting<'a> {
    random: &'a mut Random,
    parts: usize,
}

impl<'a> Drafting<'a> {
    pub fn new(random: &'a mut Random) -> Self {
        let parts = 1 + random.below(4);
        Self { random, parts }
    }

    pub fn write(mut self) -> String {
        let mut text = String::new();
        if self.random.one_in(2) {
            text.push_str("[machine]\nname = \"m\"\nlength = \"mm\"\n");
        }
        text.push_str("[parameters]\nn0 = 1\n");
        text.push_str("n1 = { value = 2, range = [0.5, 9], unit = \"mm\", meaning = \"a size\" }\n");
        text.push_str("n2 = { value = 5, range = [1, 30], whole = true }\nn3 = \"n0/2 + sin(30*n1)\"\n");
        text.push_str("[solids]\ns0 = \"blo(x=n1) dif cyl(d=1)\"\n");
        if self.random.one_in(4) {
            let gravity = self.pair();
            let _ = writeln!(text, "[world]\ngravity = {gravity}");
        }
        for i in 0..self.parts {
            self.part(i, &mut text);
        }
        if self.random.one_in(4) {
            let teeth = self.pair();
            let _ = writeln!(text, "[[gears]]\nparts = [\"p0\", \"p1\"]\nteeth = {teeth}");
        }
        text
    }

    fn value(&mut self) -> &'static str {
        self.random.pick(if self.random.clone().one_in(40) { NUMBERS } else { VALUES })
    }

    fn pair(&mut self) -> String {
        format!("[{}, {}]", self.value(), self.value())
    }

    fn part(&mut self, i: usize, text: &mut String) {
        let _ = writeln!(text, "[parts.p{i}]");
        if self.random.one_in(6) {
            text.push_str("frame = true\n");
        }
        let around = 12 * i;
        match self.random.below(8) {
            0 => {
                let solid = self.random.pick(TEXTS);
                let _ = writeln!(text, "solid = {solid}");
            }
            1 => {
                let (first, second) = (self.boundary(around), self.boundary(around));
                let _ = writeln!(
                    text,
                    "layers = [{{ z = [0, 1], outer = {first} }}, {{ z = [\"n0\", 2], outer = {second} }}]"
                );
            }
            _ => {
                let outer = self.boundary(around);
                let _ = writeln!(text, "outer = {outer}");
                if self.random.one_in(2) {
                    let inner = self.boundary(around);
                    let _ = writeln!(text, "inner = [{inner}]");
                }
                if self.random.one_in(3) {
                    let at = self.pair();
                    let _ = writeln!(text, "at = {at}\nturn = {}", self.value());
                }
            }
        }
        self.motion(i, around, text);
        self.acting(text);
    }

    fn motion(&mut self, i: usize, around: usize, text: &mut String) {
        let on = if self.random.one_in(4) {
            format!(", on = \"p{}\"", self.random.below(i + 2))
        } else {
            String::new()
        };
        let _ = match self.random.below(5) {
            0 => Ok(()),
            1 => writeln!(text, "motion = {{ slides = {}{on} }}", self.pair()),
            2 => writeln!(text, "motion = {{ fixed = true{on} }}"),
            _ => writeln!(text, "motion = {{ turns = [{around}, 0]{on} }}"),
        };
    }

    fn acting(&mut self, text: &mut String) {
        if !self.random.one_in(5) {
            text.push_str("inertia = 2\n");
        }
        for key in ["friction", "torque", "dry_friction", "position", "velocity", "density"] {
            if self.random.one_in(5) {
                let _ = writeln!(text, "{key} = {}", self.value());
            }
        }
        if self.random.one_in(3) {
            let _ = writeln!(text, "spring = {{ relaxed = {}, constant = 3 }}", self.value());
        }
        if self.random.one_in(6) {
            let _ = writeln!(text, "drive = {{ speed = {} }}", self.value());
        }
        if self.random.one_in(6) {
            let _ = writeln!(text, "limits = {}\nmarks = {{ k = {} }}", self.pair(), self.value());
        }
    }

    fn boundary(&mut self, x: usize) -> String {
        match self.random.below(5) {
            0 => {
                let copies = if self.random.one_in(4) { ", copies = \"n2\", about = [0, 0]" } else { "" };
                format!("{{ circle = {{ center = [{x}, 0], radius = {} }}{copies} }}", self.value())
            }
            1 | 2 => self.wheel(x),
            3 => self.rounded(x),
            _ => self.scribble(x),
        }
    }

    /// A wheel of teeth, which closes.
    fn wheel(&mut self, x: usize) -> String {
        let kind = ["line", "arc"][self.random.below(2)];
        let arc = if kind == "arc" { ", radius = 5, turn = \"left\"" } else { "" };
        let fillet = if self.random.one_in(3) { ", fillet = 0.1" } else { "" };
        format!(
            "{{ repeat = \"n2\", about = [{x}, 0], path = [{{ from = [\"{x} + 2\", 0] }}, {{ line = [\"{x} + 3\", 0]{fillet} }}, \
             {{ {kind} = [\"{x} + 2*cos(360/n2)\", \"2*sin(360/n2)\"]{arc} }}] }}"
        )
    }

    /// A box with corners that may be round.
    fn rounded(&mut self, x: usize) -> String {
        let (w, h) = (1 + self.random.below(4), 1 + self.random.below(4));
        let f = self.value();
        format!(
            "{{ path = [{{ from = [{x}, 0], fillet = {f} }}, {{ line = [{}, 0], fillet = {f} }}, {{ line = [{}, {h}] }}, {{ line = [{x}, {h}] }}, {{ close = true }}] }}",
            x + w,
            x + w
        )
    }

    fn scribble(&mut self, x: usize) -> String {
        let mut path = format!("{{ from = [{x}, 0] }}");
        for _ in 0..1 + self.random.below(6) {
            let to = format!(
                "[{}, {}]",
                x as i64 + self.random.below(7) as i64 - 3,
                self.random.below(7) as i64 - 3
            );
            let turn = ["left", "right"][self.random.below(2)];
            let _ = match self.random.below(4) {
                0 => write!(path, ", {{ arc = {to}, radius = {}, turn = \"{turn}\" }}", self.value()),
                1 => write!(path, ", {{ arc = {to}, center = {}, turn = \"{turn}\" }}", self.pair()),
                2 => write!(path, ", {{ line = {to}, fillet = {} }}", self.value()),
                _ => write!(path, ", {{ line = {to} }}"),
            };
        }
        format!("{{ path = [{path}, {{ close = true }}] }}")
    }
}
