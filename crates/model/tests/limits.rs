//! Every limit holds at the limit and refuses one past it; nothing grows without bound.

mod common;

use common::{SMALL, read, supplemented};
use mainspring_model::limits;
use std::fmt::Write as _;

fn ok(text: &str) {
    if let Err(e) = read(text.as_bytes()) {
        panic!("{e}");
    }
}

fn refused(text: &str, expected: &str) {
    let message = read(text.as_bytes()).expect_err("past the limit").to_string();
    assert!(message.contains(expected) && message.contains("; expected "), "{message}");
}

fn with(body: &str) -> String {
    format!("generic g(r)\n{body}\nr = s\n")
}

#[test]
fn file_size() {
    let mut text = with("s = blo()");
    text.push_str(&"#".repeat(limits::FILE_BYTES - text.len()));
    ok(&text);
    refused(&(text + "#"), "m.padl:1:1: error: the file is larger than 16777216 bytes");
    let mut supplement = "< a : FRAME > 1 2\n".to_string();
    supplement.push_str(&" ".repeat(limits::FILE_BYTES - supplement.len()));
    assert!(supplemented(SMALL, &supplement).is_ok());
    supplement.push(' ');
    let message = supplemented(SMALL, &supplement).unwrap_err().to_string();
    assert!(message.starts_with("m.sup:1:1: error: the file is larger"), "{message}");
}

#[test]
fn primitives_written_in_one_solid() {
    let solid = |count: usize| with(&format!("s = {}", vec!["blo()"; count].join(" un ")));
    ok(&solid(limits::PRIMITIVES));
    refused(&solid(limits::PRIMITIVES + 1), "more than 10000 primitives in a solid");
}

#[test]
fn primitives_after_expansion() {
    let copies =
        |count: usize| with(&format!("s = SYMMETRIC_UNION(blo() un cyl(), z, ROTATIONAL, {count}, 360)"));
    ok(&copies(limits::PRIMITIVES / 2));
    refused(&copies(limits::PRIMITIVES / 2 + 1), "m.padl:2:1: error: s has 10002 primitives after expansion");
    let parts = |count: usize| {
        let mut text = "generic g(r)\n".to_string();
        let names: Vec<String> = (0..count).map(|i| format!("p{i}")).collect();
        for name in &names {
            writeln!(text, "{name} = blo()").unwrap();
        }
        text + "r = " + &names.join(" asb ")
    };
    ok(&parts(limits::PRIMITIVES));
    refused(&parts(limits::PRIMITIVES + 1), "the parts together have 10001 primitives after expansion");
}

#[test]
fn doubling_is_counted_not_expanded() {
    let mut text = "generic g(r)\nd0 = blo()\n".to_string();
    for i in 1..=100 {
        writeln!(text, "d{i} = d{0} un d{0}", i - 1).unwrap();
    }
    refused(&(text + "r = d100"), "m.padl:16:1: error: d14 has 16384 primitives after expansion");
}

#[test]
fn nesting() {
    let number = |depth: usize| with(&format!("w = {}1{}\ns = blo()", "(".repeat(depth), ")".repeat(depth)));
    ok(&number(limits::NESTING));
    refused(&number(limits::NESTING + 1), "m.padl:2:205: error: more than 200 open brackets");
    let calls =
        |depth: usize| with(&format!("w = {}1{}\ns = blo()", "sin(".repeat(depth), ")".repeat(depth)));
    ok(&calls(limits::NESTING));
    refused(&calls(limits::NESTING + 1), "more than 200 open brackets");
    let placed = |depth: usize| {
        with(&format!("s = {}blo(){}", "(".repeat(depth - 1), " at (degz=1))".repeat(depth - 1)))
    };
    ok(&placed(limits::NESTING));
    refused(&placed(limits::NESTING + 1), "more than 200 open brackets");
    let unions = |depth: usize| {
        let close = ", z, ROTATIONAL, 1, 360)".repeat(depth - 1);
        with(&format!("s = {}blo(){close}", "SYMMETRIC_UNION(".repeat(depth - 1)))
    };
    ok(&unions(limits::NESTING));
    refused(&unions(limits::NESTING + 1), "more than 200 open brackets");
    refused(&with(&format!("s = {}", "(".repeat(1_000_000))), "m.padl:2:205: error: more than 200");
    refused(&with(&format!("s = {}", "[(".repeat(1_000_000))), "m.padl:2:5: error: unexpected `[`");
}

#[test]
fn nodes_of_an_expression() {
    // n numbers and n − 1 operators.
    let sum = |numbers: usize| with(&format!("w = {}\ns = blo()", vec!["1"; numbers].join("+")));
    ok(&sum(500));
    refused(&sum(501), "more than 1000 numbers, names and operators");
    let signs = |count: usize| with(&format!("w = {}1\ns = blo()", "-".repeat(count)));
    ok(&signs(limits::EXPRESSION_NODES - 1));
    refused(&signs(limits::EXPRESSION_NODES), "more than 1000 numbers");
    let call = |arguments: usize| with(&format!("s = blo(x=max({}))", vec!["1"; arguments].join(",")));
    ok(&call(limits::EXPRESSION_NODES - 1));
    refused(&call(limits::EXPRESSION_NODES), "more than 1000 numbers");
}

#[test]
fn reuse_goes_as_deep_as_the_limits_allow() {
    let chain = |count: usize, step: &str| {
        let mut text = "generic g(r)\nr = s0\n".to_string();
        for i in 0..count {
            writeln!(text, "s{i} = {}", step.replace('@', &format!("s{}", i + 1))).unwrap();
        }
        text + &format!("s{count} = blo()\n")
    };
    ok(&chain(limits::PRIMITIVES - 1, "blo() un @"));
    refused(&chain(limits::PRIMITIVES, "blo() un @"), "s0 has 10001 primitives");
    ok(&chain(90_000, "@"));
    ok(&chain(90_000, "@ at (movx=1e-9)"));
    let mut numbers = "generic g(r)\nr = s\ns = blo(x=n0)\n".to_string();
    for i in 0..90_000 {
        writeln!(numbers, "n{i} = n{} + 1", i + 1).unwrap();
    }
    ok(&(numbers.clone() + "n90000 = 1\n"));
    refused(&(numbers + "n90000 = n0\n"), "a cycle of names: n0 -> n1 -> n2");
}

#[test]
fn definitions() {
    let text = |count: usize| {
        let mut text = "generic g(r)\ns = blo()\nr = s\n".to_string();
        for i in 1..count {
            writeln!(text, "n{i}=1").unwrap();
        }
        text
    };
    ok(&text(limits::DEFINITIONS));
    refused(&text(limits::DEFINITIONS + 1), "m.padl:100003:1: error: more than 100000 definitions");
}

#[test]
fn steps_of_expansion() {
    // A chain of k names below n uses costs n (k + 1) steps.
    let text = |uses: usize| {
        let mut text = "generic g(r)\na0 = blo()\n".to_string();
        for i in 1..1000 {
            writeln!(text, "a{i} = a{}", i - 1).unwrap();
        }
        text + &format!("s = {}\nr = s\n", vec!["a999"; uses].join(" un "))
    };
    // 999 steps inside each use, one for the use itself, one for the part.
    ok(&text(limits::EXPANSION_STEPS / 1000 - 1));
    refused(&text(limits::EXPANSION_STEPS / 1000 + 1), "1001000 steps of expansion");
}

#[test]
fn nodes_of_a_file() {
    // Each definition has 500 numbers and 499 operators; further nodes are two primitives, one use, and one `at`.
    let sum = vec!["1"; 500].join("+");
    let text = |more: usize| {
        let mut text = "generic g(r)\ns = blo()\nr = s\n".to_string();
        for i in 0..1000 {
            writeln!(text, "n{i} = {sum}").unwrap();
        }
        text + &format!("s1 = blo() at ({})\n", vec!["movx=1"; more].join(","))
    };
    let rest = limits::FILE_NODES - 1000 * 999 - 4;
    ok(&text(rest));
    refused(&text(rest + 1), "more than 1000000 numbers, names, operators and primitives in the file");
}

#[test]
fn different_names() {
    let text = |count: usize| {
        let names: Vec<String> = (0..count - 2).map(|i| format!("movx=q{i}")).collect();
        with(&format!("s = blo() at ({})", names.join(",")))
    };
    refused(&text(limits::NAMES), "m.padl:2:20: error: `q0` is not defined");
    refused(&text(limits::NAMES + 1), "more than 200000 different names");
}

#[test]
fn names_and_numbers() {
    let name = |length: usize| with(&format!("{} = 1\ns = blo()", "n".repeat(length)));
    ok(&name(limits::NAME_CHARACTERS));
    refused(&name(limits::NAME_CHARACTERS + 1), "has 101 characters; expected at most 100");
    let number = |length: usize| with(&format!("w = 0.{}\ns = blo()", "1".repeat(length - 2)));
    ok(&number(limits::NUMBER_CHARACTERS));
    refused(&number(limits::NUMBER_CHARACTERS + 1), "has 101 characters; expected at most 100");
}

#[test]
fn sixteen_mebibytes_of_anything_get_one_error() {
    let pieces = [
        "a",
        "1",
        "(",
        ")",
        "[",
        "-",
        "\n",
        " ",
        "\\",
        "\\\n",
        "#\n",
        ".",
        "=",
        "\u{202e}",
        "\0",
        "ä",
        "<",
        "a=1\n",
        "a un ",
        "blo() un ",
        "at (movx=1) ",
        "generic g(r)\n",
        "attr a : gear = 1\n",
        "SYMMETRIC_UNION(",
        "1+",
        ",",
    ];
    for piece in pieces {
        for start in [
            "",
            "generic g(r)\n",
            "generic g(r)\nr = ",
            "generic g(r)\ns = ",
            "generic g(r)\ns = blo() at (movx=",
        ] {
            let count = (limits::FILE_BYTES - start.len()) / piece.len();
            let text = start.to_string() + &piece.repeat(count);
            let message = read(text.as_bytes()).expect_err(piece).to_string();
            assert!(message.starts_with("m.padl:") && message.len() < 300, "{piece}: {message}");
        }
    }
}
