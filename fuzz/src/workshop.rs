//! Random machines that may well move: turning and sliding parts in a frame, with stops, springs and gears.
//!
//! Sizes come from a few round numbers, so that parts often touch, coincide, or just miss each other.

use crate::random::Random;
use crate::soup::NUMBERS;
use std::fmt::Write as _;

const SIZES: &[&str] = &["0.25", "0.5", "1", "1.5", "2", "2.5", "3", "4", "n0", "n1"];
const ANGLES: &[&str] = &["0", "15", "30", "45", "60", "90", "-20", "120", "180", "7.3"];

pub struct Workshop<'a> {
    random: &'a mut Random,
    /// Distance of neighbouring axes, as a number and in the text.
    pitch: f64,
    movers: usize,
}

impl<'a> Workshop<'a> {
    pub fn new(random: &'a mut Random) -> Self {
        let (pitch, movers) = ((2 + random.below(4)) as f64, 1 + random.below(4));
        Self { random, pitch, movers }
    }

    /// A model and its supplement.
    pub fn write(mut self) -> (String, String) {
        let (mut text, mut supplement) =
            ("generic g(r)\nn0 = 1\nn1 = 2 in [0.5, 4]\n".to_string(), String::new());
        let mut frame = "blo(x=40, y=20) at (movx=-10, movy=-10, movz=-1)".to_string();
        for i in 0..self.movers {
            let x = self.pitch * i as f64;
            let (cut, part) = if self.random.one_in(6) { self.slider(i, x) } else { self.turner(i, x) };
            let _ = write!(frame, " dif {cut}");
            let _ = writeln!(text, "m{i} = {part}");
            self.attributes(i, &mut text);
            self.values(i, &mut supplement);
        }
        for _ in 0..self.random.below(3) {
            let stop = self.body();
            let (x, y) = (self.random.below(20) as f64 - 3.0, self.random.below(9) as f64 - 4.0);
            let _ = write!(frame, " un {stop} at (movx={x}, movy={y})");
        }
        let movers: String = (0..self.movers).map(|i| format!(" asb m{i}")).collect();
        let _ = writeln!(text, "s0 = {frame}\nattr s0 : frame = 1\nr = s0{movers}");
        (text, supplement)
    }

    fn size(&mut self) -> &'static str {
        self.random.pick(if self.random.clone().one_in(60) { NUMBERS } else { SIZES })
    }

    fn angle(&mut self) -> &'static str {
        self.random.pick(ANGLES)
    }

    /// What the frame loses, and the part that turns there.
    fn turner(&mut self, i: usize, x: f64) -> (String, String) {
        let carrier = i > 0 && self.random.one_in(8);
        let hole = format!("cyl(d=1) at (movx={x}, movz=-1)");
        let mut body = self.body();
        if carrier {
            // It turns on the part before instead, if that reaches so far.
            body = format!("{body} at (movz=1)");
            let pin = format!("{body} dif cyl(d=0.5, h=3) un cyl(d=0.5, h=2)");
            return (hole, format!("({pin}) at (movx={})", x - self.pitch + 0.75));
        }
        let shaft = if self.random.one_in(20) { self.size() } else { "1" };
        (hole, format!("({body} un cyl(d={shaft}) at (movz=-1)) at (movx={x})"))
    }

    /// A bar in a channel.
    fn slider(&mut self, i: usize, x: f64) -> (String, String) {
        let y = 3.0 + 2.0 * i as f64;
        let cut = format!("blo(x=60, y=1, z=0.5) at (movx=-20, movy={y}, movz=-0.75)");
        let head = self.body();
        let bar =
            format!("blo(x={}, y=1, z=0.5) at (movx={x}, movy={y}, movz=-0.75)", self.random.below(40) + 2);
        (cut, format!("{bar} un {head} at (movx={}, movy={y})", x + self.random.below(9) as f64 - 4.0))
    }

    /// A flat solid about the z axis, from z = 0 up.
    fn body(&mut self) -> String {
        let (a, b, angle) = (self.size(), self.size(), self.angle());
        match self.random.below(8) {
            0 => format!("cyl(d={a})"),
            1 => format!("cyl(d={a}) at (movx={b})"),
            2 => format!("blo(x={a}, y={b}) at (degz={angle})"),
            3 => format!("(cyl(d={a}) int blo(x={b}, y={b}) at (degz={angle}))"),
            4 => format!("(blo(x={a}, y={b}) at (degz={angle}) dif cyl(d={b}) at (movx={a}))"),
            5 => format!("({} un {})", self.leaf(), self.leaf()),
            _ => {
                let (tooth, count) = (self.leaf(), 2 + self.random.below(14));
                let range = self.random.pick(&["360", "360", "180", "90"]);
                format!("SYMMETRIC_UNION({tooth}, z, ROTATIONAL, {count}, {range})")
            }
        }
    }

    fn leaf(&mut self) -> String {
        let (a, b, angle, x) = (self.size(), self.size(), self.angle(), self.size());
        match self.random.below(3) {
            0 => format!("cyl(d={a}) at (movx={x}, degz={angle})"),
            1 => format!("blo(x={a}, y={b}) at (degz={angle}, movx={x})"),
            _ => format!("blo(x={a}, y={b}) at (degz={angle})"),
        }
    }

    fn attributes(&mut self, i: usize, text: &mut String) {
        if self.random.one_in(3) {
            let density = self.size();
            let _ = writeln!(text, "attr m{i} : density = {density}");
        }
        if self.random.one_in(8) {
            let teeth = if self.random.one_in(2) {
                format!("\nattr m{i} : teeth = {}", 6 + i)
            } else {
                String::new()
            };
            let _ = writeln!(text, "attr m{i} : gear = 1{teeth}");
        }
    }

    fn values(&mut self, i: usize, text: &mut String) {
        let (inertia, friction) = (self.size(), self.random.pick(&["0", "0.1", "1", "10", "1e6"]));
        let spring = match self.random.below(3) {
            0 => format!(
                " SPRING {} {}",
                self.random.below(2000) as f64 - 1000.0,
                self.random.pick(&["1", "0.02", "1e5"])
            ),
            1 => format!(" SPRING {} 1", self.angle()),
            _ => String::new(),
        };
        let number = |s: &'static str| if s.starts_with('n') { "1" } else { s };
        let _ = writeln!(text, "< m{i} : FRAME > {} {friction}{spring}", number(inertia));
        if self.random.one_in(3) {
            let _ = writeln!(text, "VELOCITY m{i} {}", self.random.pick(&["10", "-360", "1", "1e4"]));
        }
        if self.random.one_in(6) {
            let _ = writeln!(text, "POSITION m{i} {}", self.angle());
        }
    }
}
