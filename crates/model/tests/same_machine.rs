//! Changes of the text that change nothing, and what the guide promises.

mod common;

use common::{read, supplemented};
use mainspring_geometry::Primitive;
use mainspring_model::Machine;
use std::path::{Path, PathBuf};

const MODEL: &str = include_str!("../../../examples/escapement/escapement.padl");
const SUPPLEMENT: &str = include_str!("../../../examples/escapement/escapement.sup");
const GUIDE: &str = include_str!("../../../docs/guide/padl.md");

fn primitives(machine: &Machine) -> Vec<Primitive> {
    machine.primitives(&machine.values(&[]).unwrap()).unwrap()
}

/// Parts, primitives and supplement are those of the shipped escapement.
fn check_same(model: &str, supplement: &str) {
    let original = supplemented(MODEL, SUPPLEMENT).unwrap();
    let changed = supplemented(model, supplement).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(primitives(&changed), primitives(&original));
    for (a, b) in changed.parts().iter().zip(original.parts()) {
        assert_eq!((&a.csg, a.is_frame, a.name.to_lowercase()), (&b.csg, b.is_frame, b.name.to_lowercase()));
    }
    let rows = |m: &Machine| -> Vec<_> {
        m.supplement().pairs.iter().map(|p| (p.part, p.other, p.inertia, p.friction, p.spring)).collect()
    };
    assert_eq!(rows(&changed), rows(&original));
}

#[test]
fn letter_case_does_not_count() {
    check_same(&MODEL.to_uppercase(), &SUPPLEMENT.to_lowercase());
    let machine = read(MODEL.to_uppercase().as_bytes()).unwrap();
    assert_eq!(machine.parts()[0].name, "EWHEEL");
}

#[test]
fn line_ends_and_space_do_not_count() {
    check_same(&MODEL.replace('\n', "\r\n"), &SUPPLEMENT.replace('\n', "\r\n"));
    check_same(&MODEL.replace('\n', "\r"), &SUPPLEMENT.replace('\n', "\r"));
    check_same(&MODEL.replace("\\\n", "\\ # more follows\n\\\n\t"), &SUPPLEMENT.replace(' ', "\t \t"));
    check_same(MODEL.trim_end(), SUPPLEMENT.trim_end());
}

#[test]
fn the_order_of_definitions_does_not_count() {
    let (head, rest) = MODEL.split_once("generic esc(esc)\n").unwrap();
    let joined = rest.replace("\\\n", " ");
    let mut lines: Vec<&str> = joined.lines().collect();
    lines.reverse();
    check_same(&format!("{head}generic esc(esc)\n{}", lines.join("\n")), SUPPLEMENT);
}

fn blocks() -> Vec<&'static str> {
    GUIDE.split("```text\n").skip(1).map(|b| b.split("```").next().unwrap_or("")).collect()
}

#[test]
fn the_examples_of_the_guide_are_right() {
    let [model, supplement, error] = blocks()[..] else { panic!("three blocks") };
    let machine = read(model.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((machine.parts().len(), machine.symmetric_unions().len()), (2, 1));
    let with_lever =
        model.replace("wheel asb", "wheel asb lever asb") + "lever = blo()\nattr lever : density = 1\n";
    let machine = supplemented(&with_lever, supplement).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(machine.supplement().pairs[1].inertia, None);
    let wrong = model.replace("blo(x=0.3", "blo(w=0.3");
    let found = Machine::parse("clock.padl", wrong.as_bytes(), None).unwrap_err();
    assert_eq!(found.to_string(), error.trim_end());
}

/// A folder of its own for a test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn the_supplement_is_found_beside_the_model_or_given_or_absent() {
    let folder = folder("supplements");
    let (model, beside) = (folder.join("m.padl"), folder.join("m.sup"));
    let other = folder.join("other.txt");
    std::fs::write(&model, common::SMALL).unwrap();
    std::fs::write(&other, "< a : FRAME > 7 8\n").unwrap();
    let _ = std::fs::remove_file(&beside);
    assert!(Machine::load(&model, None).unwrap().supplement().pairs.is_empty());
    assert_eq!(Machine::load(&model, Some(&other)).unwrap().supplement().pairs[0].friction, 8.0);
    std::fs::write(&beside, "< a : FRAME > 1 2\n").unwrap();
    assert_eq!(Machine::load(&model, None).unwrap().supplement().pairs[0].friction, 2.0);
    assert_eq!(Machine::load(&model, Some(&other)).unwrap().supplement().pairs[0].friction, 8.0);
    let absent = Machine::load(&model, Some(&folder.join("absent.sup"))).unwrap_err();
    assert!(absent.file.ends_with("absent.sup") && absent.message.starts_with("the file cannot be read"));
}
