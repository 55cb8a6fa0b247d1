//! Every kind of bad text has its own message: where, what, and what was expected.

mod common;

use common::{SMALL, read, supplemented};

/// The error of a model made of `generic g(r)`, the body from line 2 on, and `r = s` as its last line.
fn error(body: &str) -> String {
    let text = format!("generic g(r)\n{body}\nr = s\n");
    let message = read(text.as_bytes()).expect_err(&text).to_string();
    assert!(!message.contains('\n'), "one line: {message}");
    message
}

fn check(cases: &[(&str, &str)]) {
    for (body, expected) in cases {
        assert_eq!(error(body), format!("m.padl:{expected}"), "{body}");
    }
}

#[test]
fn names() {
    check(&[
        (
            "s = blo()\nS = blo()",
            "3:1: error: `s` is already defined at 2:1; expected a new name (letter case does not count)",
        ),
        (
            "s = blo()\ns = 3",
            "3:1: error: `s` is already defined at 2:1; expected a new name (letter case does not count)",
        ),
        ("Sin = 3", "2:1: error: `Sin` is a function; expected a name of your own"),
        ("cyl = 3", "2:1: error: `cyl` is a primitive; expected a name of your own"),
        ("UN = 3", "2:1: error: `UN` is a word of the language; expected a name of your own"),
        (
            "s = blo(x=wdith)\nwidth = 3",
            "2:11: error: `wdith` is not defined; expected a defined name, perhaps `width`",
        ),
        ("s = blo() at (movx=q)", "2:20: error: `q` is not defined; expected a defined name"),
        ("s = blo() un w\nw = 3", "2:14: error: `w` is a number; expected a solid"),
        ("s = blo()\nw = s + 1", "3:5: error: `s` is a solid; expected a number"),
        ("s = blo() un r", "2:14: error: `r` is the result, an assembly; expected a solid or a number"),
        (
            "s = cvl(d=1)",
            "2:5: error: `cvl` is neither a primitive nor a function; expected `cyl`, the nearest name",
        ),
        ("n = n + 1\ns = blo()", "2:1: error: a cycle of names: n -> n; expected no name to use itself"),
        (
            "s = b un cyl()\nb = c at (movx=1)\nc = s",
            "2:1: error: a cycle of names: s -> b -> c -> s; expected no name to use itself",
        ),
        (
            "s = blo(x=a)\na = b\nb = c\nc = d\nd = e\ne = f\nf = g\ng = a",
            "3:1: error: a cycle of names: a -> b -> c -> d -> e -> f -> … -> a; expected no name to use itself",
        ),
    ]);
}

#[test]
fn numbers() {
    let digits = "9".repeat(1_000_000);
    let long =
        format!("2:5: error: number `{}…` has 1000000 characters; expected at most 100", "9".repeat(40));
    check(&[
        ("w = 1_0", "2:5: error: `1_0` is not a number; expected one like 12, 0.5 or 1e-3"),
        ("w = 2x", "2:5: error: `2x` is not a number; expected one like 12, 0.5 or 1e-3"),
        ("w = 0x10", "2:5: error: `0x10` is not a number; expected one like 12, 0.5 or 1e-3"),
        ("w = 1.2.3", "2:5: error: `1.2.3` is not a number; expected one like 12, 0.5 or 1e-3"),
        ("w = 1e", "2:5: error: `1e` is not a number; expected one like 12, 0.5 or 1e-3"),
        (
            "w = nan",
            "2:5: error: `nan` is no finite number and no name; expected a number, a name or a solid",
        ),
        (
            "w = -inf",
            "2:6: error: `inf` is no finite number and no name; expected a number, a name or a solid",
        ),
        ("w = 1e999", "2:5: error: number `1e999` is too large; expected at most 1.7976931348623157e308"),
        ("w = 1e-999", "2:5: error: number `1e-999` is too small; expected 0 or a larger number"),
        (&format!("w = {digits}"), &long),
        ("w = 1/(2-2)\ns = blo()", "2:5: error: in w: division by zero; expected a divisor other than zero"),
        ("w = sqrt(-2)\ns = blo()", "2:5: error: in w: sqrt of -2; expected a number that is not negative"),
        ("w = tan(90)\ns = blo()", "2:5: error: in w: tan of 90 degrees is infinite; expected another angle"),
        (
            "w = 1e300*1e300\ns = blo()",
            "2:5: error: in w: the value is not finite; expected an expression with a finite value",
        ),
        ("w = atan2(1)", "2:5: error: atan2 has 1 argument; expected 2"),
        ("w = max(1)", "2:5: error: max has 1 argument; expected 2 or more"),
        ("w = sin(1, 2)", "2:5: error: sin has 2 arguments; expected 1"),
        ("w = 36 in [40, 30]", "2:11: error: the range [40, 30] is empty; expected low < high"),
        ("w = 36 in [0, 30]\ns = blo()", "2:1: error: w is 36; expected a value in its range [0, 30]"),
        (
            "w = 2^3",
            "2:6: error: character `^` is not part of the language; expected ASCII letters, digits, brackets and operators",
        ),
    ]);
}

#[test]
fn sizes() {
    check(&[
        ("s = blo(x=-3)", "2:11: error: size x of s (blo) is -3; expected a positive number"),
        ("s = cyl(h=w)\nw = 0", "2:11: error: size h of s (cyl) is 0; expected a positive number"),
        ("s = sph(r=0)", "2:11: error: size r of s (sph) is 0; expected a positive number"),
        (
            "s = con(d=1e308*10)",
            "2:11: error: the value is not finite; expected an expression with a finite value",
        ),
        ("s = cyl(d=1,r=2)", "2:13: error: cyl has both a diameter d and a radius r; expected one of them"),
        ("s = wed(d=1)", "2:9: error: no size of wed is called `d`; expected one of `x`, `y`, `z`"),
        (
            "s = cyl(1,2)",
            "2:9: error: unexpected `1`; expected a size of cyl by its name, one of `d`, `h`, `r`",
        ),
        ("s = cyl(d=)", "2:11: error: unexpected `)`; expected a number, a name, a primitive or `(`"),
        ("s = cyl(d)", "2:10: error: unexpected `)`; expected `=` and a value for the size d"),
        ("s = cyl", "2:8: error: the line ends here; expected `(` after cyl"),
        ("s = blo(x=1, x=2)", "2:14: error: size `x` is given twice; expected it once"),
        ("s = blo(x=cyl())", "2:11: error: a solid where a number belongs; expected a numeric expression"),
        (
            "s = blo() at (movx=1e308, movx=1e308)",
            "2:5: error: the motions put it infinitely far away; expected smaller motions",
        ),
    ]);
}

#[test]
fn syntax() {
    check(&[
        (
            "s = ((blo() un cyl()",
            "3:1: error: unexpected `r`; expected an operator or `)` to close `(` of 2:6",
        ),
        ("s = blo())", "2:10: error: unexpected `)`; expected an operator or the end of the line"),
        (
            "s = blo() un\n cyl()",
            "2:13: error: the line ends here; expected a number or a solid (a line that goes on needs `\\` at its end)",
        ),
        (
            "s = blo() \\ un cyl()",
            "2:11: error: `\\` inside a line; expected it at a line's end, to continue the line",
        ),
        ("s = blo() cyl()", "2:11: error: unexpected `cyl`; expected an operator or the end of the line"),
        ("s = blo(x=1 y=2)", "2:13: error: unexpected `y`; expected `,` or `)` to close `(` of 2:8"),
        (
            "s = blo() at (movq=1)",
            "2:15: error: no motion is called `movq`; expected one of `movx`, `movy`, `movz`, `degx`, `degy`, `degz`",
        ),
        ("s = blo() at ()", "2:15: error: unexpected `)`; expected a motion such as movx=1"),
        ("s = 3 at (movx=1)", "2:7: error: `at` on a number; expected a solid in front of it"),
        ("s = 3 un blo()", "2:7: error: a set operation on a number; expected a solid on both sides"),
        (
            "s = blo() + 3",
            "2:11: error: arithmetic on a solid; expected numbers (solids are joined by `un`, `dif`, `int`)",
        ),
        ("s blo()", "2:3: error: unexpected `blo`; expected `=` after the name `s`"),
        ("generic h(s)", "2:1: error: a second `generic`; expected one, at the beginning of the file"),
        ("s = blo() in [1, 2]", "2:11: error: a range on a solid; expected a range on a number only"),
        (
            "s = SYMMETRIC_UNION(blo(), z, ROTATIONAL, 2.5, 360)",
            "2:43: error: unexpected `2.5`; expected a whole number of copies from 1 to 10000, written in digits",
        ),
        (
            "s = SYMMETRIC_UNION(blo(), w, ROTATIONAL, 2, 360)",
            "2:28: error: no axis is called `w`; expected one of `x`, `y`, `z`",
        ),
        (
            "s = SYMMETRIC_UNION(blo(), z, round, 2, 360)",
            "2:31: error: no symmetry is called `round`; expected one of `ROTATIONAL`, `TRANSLATIONAL`",
        ),
    ]);
}

#[test]
fn assembly() {
    let whole = |text: &str| read(text.as_bytes()).expect_err(text).to_string();
    check(&[
        (
            "s = blo()\nt = s asb s",
            "3:7: error: `asb` outside the result; expected it in the definition of `r`",
        ),
        ("s = 3", "3:5: error: `s` is a number; expected a solid"),
        ("t = blo()", "3:5: error: `s` is not defined; expected a defined name"),
    ]);
    let plain = "m.padl:3:11: error: an operand of `asb` is not a plain name; expected the name of a solid, which is then a part";
    assert_eq!(whole("generic g(r)\na = blo()\nr = a asb (cyl() un a)"), plain);
    assert_eq!(
        whole("generic g(r)\na = blo()\nr = a asb A"),
        "m.padl:3:11: error: part `a` is listed twice; expected it once"
    );
    assert_eq!(
        whole("generic g(r)\na = blo()"),
        "m.padl:1:11: error: the result `r` is not defined; expected its parts, joined by `asb`"
    );
    assert_eq!(
        whole("a = blo()"),
        "m.padl:1:1: error: unexpected `a`; expected `generic NAME(RESULT)` at the beginning of the file"
    );
    assert_eq!(
        whole(""),
        "m.padl:1:1: error: the file ends here; expected `generic NAME(RESULT)` at the beginning of the file"
    );
    assert_eq!(
        whole("generic g(r, size, SIZE)"),
        "m.padl:1:20: error: `size` is listed twice; expected another name"
    );
    assert_eq!(
        whole("generic g(r, size)\na = blo(x=size)\nr = a"),
        "m.padl:1:14: error: size has no value; expected a definition or --set"
    );
}

#[test]
fn attributes() {
    check(&[
        (
            "s = blo()\nt = blo()\nattr q : frame = 1",
            "4:6: error: `q` is not defined; expected a part or solid, one of `s`, `t`",
        ),
        (
            "s = blo()\nattr s : color = 1",
            "3:10: error: no attribute is called `color`; expected one of `frame`, `gear`, `teeth`, `depth`, `density`",
        ),
        ("s = blo()\nattr s : frame = 2", "3:18: error: the value of frame is neither 1 nor 0; expected 1"),
        (
            "s = blo()\nt = cyl()\nattr t : frame = 1",
            "4:6: error: `t` is not a part, and frame is said of parts; expected `s`",
        ),
        (
            "s = blo()\nattr s : frame = 1\nattr S : frame = 0",
            "4:6: error: the frame of s is given twice; expected it once",
        ),
        (
            "s = blo()\nattr s : gear = 1",
            "3:6: error: gear s has no cylinder; expected a cylinder, the envelope of its teeth",
        ),
        (
            "s = cyl()\nattr s : teeth = 12",
            "3:6: error: s has teeth and is no gear; expected `attr s : gear = 1` as well",
        ),
        (
            "s = t\nt = cyl()\nattr s : gear = 1\nattr t : gear = 1",
            "5:6: error: gear t is a piece of gear s; expected only one of them to be a gear",
        ),
        (
            "s = cyl()\nw = 3\nattr w : density = 1",
            "4:6: error: `w` is a number; expected a part or solid, `s`",
        ),
    ]);
    let two = "generic g(r)\na = blo()\nb = blo()\nattr a : frame = 1\nattr b : frame = 1\nr = a asb b";
    assert_eq!(
        read(two.as_bytes()).unwrap_err().to_string(),
        "m.padl:5:6: error: a second frame; expected one part marked `frame = 1`"
    );
}

#[test]
fn values_of_attributes() {
    check(&[
        (
            "s = cyl()\nattr s : gear = 1\nattr s : teeth = 12.5",
            "4:18: error: s has 12.5 teeth; expected a whole number up to 1000000",
        ),
        (
            "s = cyl()\nattr s : gear = 1\nattr s : depth = 0",
            "4:18: error: tooth depth of s is 0; expected a positive number",
        ),
        ("s = cyl()\nattr s : density = 1-2", "3:20: error: density of s is -1; expected a positive number"),
    ]);
}

#[test]
fn encodings_and_characters() {
    let refuse = |bytes: &[u8]| read(bytes).expect_err("bad text").to_string();
    let utf16 = "m.padl:1:1: error: the file is encoded as UTF-16; expected UTF-8";
    assert_eq!(refuse(b"\xff\xfeg\0e\0"), utf16);
    assert_eq!(refuse(b"\xfe\xff\0g\0e"), utf16);
    assert_eq!(
        refuse(b"generic g(r)\r\na = \xe9blo()"),
        "m.padl:2:5: error: byte 0xe9 is no UTF-8 text; expected a text file in UTF-8"
    );
    assert_eq!(
        refuse(b"\x7fELF\x02\x01\0"),
        "m.padl:1:1: error: control character `\\u{7f}` is not part of the language; expected ASCII letters, digits, brackets and operators"
    );
    for (character, shown) in [('\u{202e}', "\\u{202e}"), ('\0', "\\u{0}"), ('\u{200b}', "\\u{200b}")] {
        let message = error(&format!("s = blo(x={character}3)"));
        let expected =
            format!("m.padl:2:11: error: control character `{shown}` is not part of the language;");
        assert!(message.starts_with(&expected), "{message}");
    }
    assert!(error("s = größe").starts_with("m.padl:2:7: error: character `ö` is not part of the language;"));
    // In comments every character may stand; a byte order mark may stand in front.
    assert!(read("\u{feff}generic g(r) # \u{202e}größe\0\ns = blo()\nr = s".as_bytes()).is_ok());
}

#[test]
fn quoted_text_is_short_and_harmless() {
    let name = "q".repeat(100);
    assert!(error(&format!("s = {name}")).contains(&format!("`{}…` is not defined", "q".repeat(40))));
    let machine = mainspring_model::Machine::parse("a\nb\u{1b}.padl", b"x", None);
    assert!(machine.unwrap_err().to_string().starts_with("a\\u{a}b\\u{1b}.padl:1:1: error: "));
}

#[test]
fn supplements() {
    let cases = [
        (
            "< A : FRAME > 1 2\n< a : FRAME > 1 2",
            "2:1: error: a second line for a (the first is at 1:1); expected one",
        ),
        ("< lever : FRAME > 1 2", "1:3: error: no part is named `lever`; expected one of `a`, `base`"),
        ("< bsae : FRAME > 1 2", "1:3: error: no part is named `bsae`; expected `base`, the nearest name"),
        ("< a : ground > 1 2", "1:7: error: no part is named `ground`; expected one of `a`, `base`"),
        ("< a : FRAME > -10 5", "1:15: error: the inertia is -10; expected a positive number"),
        ("< a : FRAME > 0 5", "1:15: error: the inertia is 0; expected a positive number"),
        ("< a : FRAME > 10 -5", "1:18: error: the friction is -5; expected zero or a positive number"),
        (
            "< a : FRAME > 1 5 SPRING 3 -1",
            "1:28: error: the spring constant is -1; expected zero or a positive number",
        ),
        ("< a : FRAME > 1 5 SPRING 3", "1:27: error: the file ends here; expected the spring's constant"),
        (
            "< a : FRAME > 5",
            "1:15: error: only one number, and a has no density; expected inertia and friction, or `attr a : density = …` in the model",
        ),
        (
            "< base : FRAME > 1 2",
            "1:10: error: the frame against itself; expected a moving part in front of `:`",
        ),
        ("< base : a > 1 2", "1:3: error: the frame in front of `:`; expected `< a : FRAME >`"),
        (
            "POSITION base 6",
            "1:10: error: a position of the frame, which does not move; expected a moving part",
        ),
        (
            "POSITION a 6\nVELOCITY a 6\nposition A 6",
            "3:1: error: a second position for a (the first is at 1:1); expected one",
        ),
        ("VELOCITY a", "1:11: error: the file ends here; expected the velocity"),
        ("VELOCITY a fast", "1:12: error: unexpected `fast`; expected the velocity"),
        ("< a : FRAME > 1 2 3", "1:19: error: unexpected `3`; expected the end of the line"),
        ("< a FRAME > 1 2", "1:5: error: unexpected `FRAME`; expected `:`"),
        (
            "INERTIA a 3",
            "1:1: error: unexpected `INERTIA`; expected `< PART : CARRIER > …` or a line that begins with POSITION, VELOCITY, TORQUE, FORCE, COULOMB, SPEED, TABLE, STOP, MASS, GRAVITY, CONTACT",
        ),
        (
            "SPEDE a 3",
            "1:1: error: unexpected `SPEDE`; expected `SPEED`, the nearest word that begins a line",
        ),
        ("< a : FRAME > 1 inf", "1:17: error: unexpected `inf`; expected the friction"),
        ("< a : FRAME > nan 2", "1:15: error: unexpected `nan`; expected the inertia and the friction"),
        ("< a : FRAME > 1_0 2", "1:15: error: `1_0` is not a number; expected one like 12, 0.5 or 1e-3"),
    ];
    for (text, expected) in cases {
        let message = supplemented(SMALL, text).expect_err(text).to_string();
        assert_eq!(message, format!("m.sup:{expected}"));
    }
    let no_frame = "generic g(r)\na = cyl()\nr = a";
    assert_eq!(
        supplemented(no_frame, "< a : FRAME > 1 2").unwrap_err().to_string(),
        "m.sup:1:7: error: the machine has no frame; expected `attr PART : frame = 1` in the model"
    );
}

#[test]
fn files() {
    let absent = mainspring_model::Machine::load("no/such.padl".as_ref(), None).unwrap_err();
    assert_eq!((absent.file.as_str(), absent.line, absent.column), ("no/such.padl", 1, 1));
    assert!(absent.message.starts_with("the file cannot be read ("));
    let directory = mainspring_model::Machine::load(env!("CARGO_MANIFEST_DIR").as_ref(), None).unwrap_err();
    assert!(directory.message.contains("expected a readable text file"));
}
