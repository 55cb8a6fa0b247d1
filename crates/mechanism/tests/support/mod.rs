//! Machines from text, and short views of what was found.
#![allow(dead_code)]

use mainspring_mechanism::{CompileOptions, Mechanism, Pair};
use mainspring_model::{Error, Machine};
use std::path::Path;
use std::sync::Arc;

pub fn try_compile(text: &str, supplement: &str, options: &CompileOptions) -> Result<Mechanism, Error> {
    let supplement = Some(("test.sup", supplement.as_bytes()));
    let machine = Machine::parse("test.padl", text.as_bytes(), supplement)?;
    Mechanism::compile(Arc::new(machine), &[], options)
}

pub fn compile_with(text: &str, options: &CompileOptions) -> Mechanism {
    try_compile(text, "", options).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

pub fn compile(text: &str) -> Mechanism {
    compile_with(text, &CompileOptions::default())
}

/// `generic`, the parts' definitions, the frame's mark and the assembly.
pub fn machine(definitions: &str, parts: &[&str]) -> String {
    let all = parts.join(" asb ");
    format!("generic m(m)\n{definitions}\nattr frame : frame = 1\nm = {all}\n")
}

pub fn example_text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../examples/{name}/{name}.padl"));
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

pub fn example(name: &str) -> Mechanism {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../examples/{name}/{name}.padl"));
    let machine = Machine::load(&path, None).unwrap_or_else(|e| panic!("{e}"));
    Mechanism::compile(Arc::new(machine), &[], &CompileOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// Each pair as "kind/shape_kind first-second".
pub fn kinds(m: &Mechanism) -> Vec<String> {
    let name = |i: usize| m.parts[i].name.as_str();
    let of = |p: &Pair| {
        format!("{}/{} {}-{}", p.kind.name(), p.shape_kind.name(), name(p.parts.0), name(p.parts.1))
    };
    m.pairs.iter().map(of).collect()
}

/// The only pair.
pub fn single(m: &Mechanism) -> &Pair {
    assert_eq!(m.pairs.len(), 1, "{:?}, near misses {:?}", kinds(m), m.near_misses);
    &m.pairs[0]
}

/// The same machine with every part moved by the motions `at`, in the words of the language.
pub fn moved(text: &str, parts: &[&str], at: &str) -> String {
    let end = text.find("attr frame").unwrap_or_else(|| panic!("no frame in {text}"));
    let mut out = text[..end].to_string();
    for part in parts {
        out += &format!("{part}_moved = {part} at ({at})\n");
    }
    let names: Vec<String> = parts.iter().map(|p| format!("{p}_moved")).collect();
    let name = text.lines().find_map(|l| l.strip_prefix("generic ")).unwrap_or("m(m)");
    let result = name.split(['(', ')']).nth(1).unwrap_or("m");
    out + &format!("attr frame_moved : frame = 1\n{result} = {}\n", names.join(" asb "))
}
