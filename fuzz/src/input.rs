//! Inputs: shipped examples, random programs and random machines, mutated; token soup; random bytes.

use crate::drafting::Drafting;
use crate::program::Program;
use crate::random::Random;
use crate::soup::{NUMBERS, STRANGE, TOKENS};
use crate::workshop::Workshop;

/// Which form of machine is tried.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Language {
    #[default]
    Padl,
    Toml,
}

impl Language {
    /// The name that an input's model goes by.
    pub fn file(self) -> &'static str {
        match self {
            Self::Padl => "m.padl",
            Self::Toml => "m.toml",
        }
    }
}

/// A model and its supplement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    pub language: Language,
    pub model: Vec<u8>,
    pub supplement: Option<Vec<u8>>,
}

const MODEL: &str = include_str!("../../examples/escapement/escapement.padl");
const SUPPLEMENT: &str = include_str!("../../examples/escapement/escapement.sup");

/// Longest text that mutations make, in bytes.
const LONGEST: usize = 20_000;

/// Shipped machines in TOML.
const DRAWN: &[&str] = &[
    include_str!("../../examples/geneva-four/geneva-four.toml"),
    include_str!("../../examples/scotch-yoke/scotch-yoke.toml"),
    include_str!("../../examples/cam-swinging-follower/cam-swinging-follower.toml"),
    include_str!("../../examples/ratchet-and-pawl/ratchet-and-pawl.toml"),
    include_str!("../../examples/detent/detent.toml"),
];

/// Input number `index` of a run with this seed.
pub fn input(language: Language, seed: u64, index: u64) -> Input {
    match language {
        Language::Padl => padl(seed, index),
        Language::Toml => toml(seed, index),
    }
}

/// Shipped and random machines in TOML, mutated; bytes.
fn toml(seed: u64, index: u64) -> Input {
    let random = &mut Random::new(seed, index);
    let mut model = match random.below(10) {
        0 => bytes(random),
        1 | 2 => random.pick(DRAWN).as_bytes().to_vec(),
        _ => Drafting::new(random).write().into_bytes(),
    };
    for _ in 0..random.below(3) * (1 + random.below(2)) {
        mutate(random, &mut model);
    }
    Input { language: Language::Toml, model, supplement: None }
}

fn padl(seed: u64, index: u64) -> Input {
    let random = &mut Random::new(seed, index);
    let (model, supplement) = match random.below(10) {
        0 => (soup(random).into_bytes(), Some(soup(random).into_bytes())),
        1 => (bytes(random), Some(SUPPLEMENT.as_bytes().to_vec())),
        2 | 3 => (MODEL.as_bytes().to_vec(), Some(SUPPLEMENT.as_bytes().to_vec())),
        4..=6 => {
            let (model, supplement) = Workshop::new(random).write();
            (model.into_bytes(), Some(supplement.into_bytes()))
        }
        _ => {
            let (model, supplement) = Program::new(random).write();
            (model.into_bytes(), Some(supplement.into_bytes()))
        }
    };
    let mut input = Input { language: Language::Padl, model, supplement };
    // A third of the inputs stay as they are: random programs must also be read when they are right.
    for _ in 0..random.below(3) * (1 + random.below(3)) {
        match (&mut input.supplement, random.one_in(3)) {
            (Some(supplement), true) => mutate(random, supplement),
            _ => mutate(random, &mut input.model),
        }
    }
    if random.one_in(8) {
        input.supplement = None;
    }
    input
}

fn soup(random: &mut Random) -> String {
    let mut text = if random.one_in(2) { "generic g(r)\n".to_string() } else { String::new() };
    for _ in 0..random.below(200) {
        let list = if random.one_in(6) { NUMBERS } else { TOKENS };
        let word: &str = random.pick(list);
        text.push_str(word);
        if random.one_in(3) {
            text.push(' ');
        }
    }
    text
}

fn bytes(random: &mut Random) -> Vec<u8> {
    let mask = if random.one_in(2) { 0x7f } else { 0xff };
    (0..random.below(300)).map(|_| random.draw() as u8 & mask).collect()
}

fn mutate(random: &mut Random, text: &mut Vec<u8>) {
    let at = random.below(text.len() + 1);
    let to = (at + random.below(40)).min(text.len());
    match random.below(12) {
        0 => {
            let strange: &[u8] = random.pick(STRANGE);
            splice(text, at, at, strange);
        }
        1 => splice(text, at, to, b""),
        2 if !text.is_empty() => {
            let at = at.min(text.len() - 1);
            text[at] ^= 1 << random.below(8);
        }
        3 => swap_lines(random, text),
        4 => repeat(random, text, at, to),
        5 => text.truncate(at),
        6 => splice_random_piece(random, text, at),
        7 | 8 => replace_number(random, text, at),
        _ => {
            let (from, to) = token_at(text, at);
            let token = random.pick(TOKENS).as_bytes();
            let to = if random.one_in(2) { to } else { from };
            splice(text, from, to, token);
        }
    }
    text.truncate(LONGEST);
}

fn splice(text: &mut Vec<u8>, from: usize, to: usize, piece: &[u8]) {
    text.splice(from..to, piece.iter().copied());
}

/// Start and end of the word or symbol at a place.
fn token_at(text: &[u8], at: usize) -> (usize, usize) {
    let is_word = |b: &u8| b.is_ascii_alphanumeric() || *b == b'_' || *b == b'.';
    let from = text[..at].iter().rposition(|b| !is_word(b)).map_or(0, |i| i + 1);
    let length = text[from..].iter().position(|b| !is_word(b)).unwrap_or(text.len() - from);
    (from, (from + length.max(1)).min(text.len()))
}

fn replace_number(random: &mut Random, text: &mut Vec<u8>, at: usize) {
    let Some(from) = text[at..].iter().position(u8::is_ascii_digit).map(|i| i + at) else { return };
    let (from, to) = token_at(text, from);
    splice(text, from, to, random.pick(NUMBERS).as_bytes());
}

fn swap_lines(random: &mut Random, text: &mut Vec<u8>) {
    let mut lines: Vec<&[u8]> = text.split(|b| *b == b'\n').collect();
    let (a, b) = (random.below(lines.len()), random.below(lines.len()));
    if random.one_in(2) {
        lines.swap(a, b)
    } else {
        lines[a] = lines[b]
    }
    *text = lines.join(&b'\n');
}

fn repeat(random: &mut Random, text: &mut Vec<u8>, from: usize, to: usize) {
    let piece = text[from..to].to_vec();
    let count = if random.one_in(10) { LONGEST / piece.len().max(1) } else { 1 + random.below(20) };
    splice(text, to, to, &piece.repeat(count));
}

fn splice_random_piece(random: &mut Random, text: &mut Vec<u8>, at: usize) {
    let from = random.below(text.len() + 1);
    let to = (from + random.below(200)).min(text.len());
    let piece = text[from..to].to_vec();
    splice(text, at, at, &piece);
}
