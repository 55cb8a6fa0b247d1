//! Lines of the supplement beside pairs and states: what they mean, and what is wrong with bad ones.

mod common;

use common::{SMALL, supplemented};
use mainspring_model::DriveKind;

/// Two moving parts and a frame.
const CARRIED: &str =
    "generic g(r)\na = cyl()\nb = cyl()\nbase = blo()\nattr base : frame = 1\nr = a asb b asb base\n";

fn error(text: &str) -> String {
    supplemented(CARRIED, text).expect_err(text).to_string()
}

#[test]
fn every_line_is_read() {
    let text = "< a : FRAME > 1 2
< b : a > 3 4 SPRING -90 5   # on a moving part
TORQUE a -6
force b 0.5
COULOMB a 0.25
SPEED a 30
TABLE b 0 0  1 90 \\
        2.5 -10
STOP a -20 NONE
STOP b -20 35
MASS a 2 0.1 -0.2 0.3
MASS b 2 0.1 -0.2 0.3 0.05
GRAVITY 0 -9.81 0
CONTACT 2e5 1e3 50
";
    let machine = supplemented(CARRIED, text).unwrap_or_else(|e| panic!("{e}"));
    let s = machine.supplement();
    assert_eq!((s.pairs[1].part, s.pairs[1].other, s.pairs[1].inertia), (1, 0, Some(3.0)));
    let forces: Vec<_> = s.forces.iter().map(|f| (f.part, f.value, f.torque)).collect();
    assert_eq!(forces, [(0, -6.0, true), (1, 0.5, false)]);
    assert_eq!((s.coulomb[0].part, s.coulomb[0].value), (0, 0.25));
    assert_eq!(s.drives[0].kind, DriveKind::Speed(30.0));
    assert_eq!(s.drives[1].kind, DriveKind::Table(vec![(0.0, 0.0), (1.0, 90.0), (2.5, -10.0)]));
    let stops: Vec<_> = s.stops.iter().map(|s| (s.part, s.low, s.high)).collect();
    assert_eq!(stops, [(0, Some(-20.0), None), (1, Some(-20.0), Some(35.0))]);
    assert_eq!((s.masses[0].mass, s.masses[0].center, s.masses[0].inertia), (2.0, [0.1, -0.2, 0.3], None));
    assert_eq!(s.masses[1].inertia, Some(0.05));
    assert_eq!(s.gravity.as_ref().map(|g| g.field), Some([0.0, -9.81, 0.0]));
    assert_eq!(s.contact.as_ref().map(|c| (c.e, c.d, c.m)), Some((2e5, 1e3, 50.0)));
}

/// One number in a pair's line is enough where a mass says the rest, before or after it.
#[test]
fn a_mass_stands_in_for_a_density() {
    for text in ["< a : FRAME > 5\nMASS a 1 0 0 0\n", "MASS a 1 0 0 0\n< a : FRAME > 5\n"] {
        let machine = supplemented(SMALL, text).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(machine.supplement().pairs[0].inertia, None);
    }
}

#[test]
fn bad_lines_say_what_is_wrong() {
    let cases = [
        ("< a : a > 1 2", "1:7: error: a against itself; expected the part that carries it, or FRAME"),
        (
            "< a : b > 1 2\n< a : FRAME > 1 2",
            "2:1: error: a second line for a (the first is at 1:1); expected one",
        ),
        ("< a : 3 > 1 2", "1:7: error: unexpected `3`; expected the part that carries it, or FRAME"),
        ("TORQUE base 1", "1:8: error: a torque of the frame, which does not move; expected a moving part"),
        ("TORQUE a", "1:9: error: the file ends here; expected the torque"),
        ("TORQUE a 1\nTORQUE a 2", "2:1: error: a second torque for a (the first is at 1:1); expected one"),
        (
            "TORQUE a 1\nFORCE a 2",
            "2:1: error: a force for a, which has a torque (at 1:1); expected one of them",
        ),
        ("FORCE c 1", "1:7: error: no part is named `c`; expected one of `a`, `b`, `base`"),
        ("COULOMB a -1", "1:11: error: the Coulomb friction is -1; expected zero or a positive number"),
        (
            "COULOMB a 1\nCOULOMB a 1",
            "2:1: error: a second Coulomb friction for a (the first is at 1:1); expected one",
        ),
        ("SPEED a", "1:8: error: the file ends here; expected the speed"),
        ("SPEED a 1\nSPEED a 1", "2:1: error: a second speed for a (the first is at 1:1); expected one"),
        (
            "SPEED a 1\nTABLE a 0 0 1 1",
            "2:1: error: a table for a, which has a speed (at 1:1); expected one of them",
        ),
        (
            "TABLE a 0 0 1 1\nSPEED a 1",
            "2:1: error: a speed for a, which has a table (at 1:1); expected one of them",
        ),
        (
            "TABLE a 0 0",
            "1:12: error: the file ends here; expected a time and a position, for two points or more",
        ),
        ("TABLE a 0 0 1", "1:14: error: the file ends here; expected the position at this time"),
        ("TABLE a 0 0 1 1 2", "1:18: error: the file ends here; expected the position at this time"),
        ("TABLE a 0 0 1 one", "1:15: error: unexpected `one`; expected the position at this time"),
        (
            "TABLE a 0 0 2 1 2 5",
            "1:17: error: time 2 of the table of a does not come after 2; expected increasing times",
        ),
        ("STOP a 3", "1:9: error: the file ends here; expected the upper limit, or NONE"),
        ("STOP a - 3", "1:11: error: the file ends here; expected the upper limit, or NONE"),
        ("STOP a NONE NONE", "1:8: error: a stop of a without limits; expected a number for one of them"),
        ("STOP a 3 3", "1:8: error: the stops of a are at 3 and 3; expected the lower limit first"),
        (
            "STOP a 3 NONE\nSTOP a NONE 4",
            "2:1: error: a second stop for a (the first is at 1:1); expected one",
        ),
        ("STOP base 3 4", "1:6: error: a stop of the frame, which does not move; expected a moving part"),
        ("MASS a 0 1 1 1", "1:8: error: the mass is 0; expected a positive number"),
        ("MASS a 1 1 1", "1:13: error: the file ends here; expected the z of the centre of mass"),
        (
            "MASS a 1 1 1 1 -1",
            "1:16: error: the inertia about the centre of mass is -1; expected zero or a positive number",
        ),
        (
            "MASS a 1 1 1 1\nMASS a 2 1 1 1",
            "2:1: error: a second mass for a (the first is at 1:1); expected one",
        ),
        ("GRAVITY 0 -9", "1:13: error: the file ends here; expected the z of gravity"),
        ("GRAVITY 0 0 1\nGRAVITY 0 0 1", "2:1: error: a second gravity (the first is at 1:1); expected one"),
        ("CONTACT 0 1 1", "1:9: error: the contact constant E is 0; expected a positive number"),
        ("CONTACT 1 -1 1", "1:11: error: the contact constant D is -1; expected zero or a positive number"),
        ("CONTACT 1 1", "1:12: error: the file ends here; expected the contact constant M"),
        (
            "CONTACT 1 1 1\nCONTACT 1 1 1",
            "2:1: error: a second contact law (the first is at 1:1); expected one",
        ),
        ("CONTACT 1 1 1 1", "1:15: error: unexpected `1`; expected the end of the line"),
        ("< a : FRAME > 5 fast", "1:17: error: unexpected `fast`; expected the friction"),
    ];
    for (text, expected) in cases {
        assert_eq!(error(text), format!("m.sup:{expected}"));
    }
}

#[test]
fn tables_are_bounded() {
    let most = mainspring_model::limits::TABLE_POINTS;
    let table = |n: usize| "TABLE a".to_string() + &(0..n).map(|i| format!(" {i} 0")).collect::<String>();
    assert!(supplemented(CARRIED, &table(most)).is_ok());
    let message = error(&table(most + 1));
    assert!(
        message.ends_with("the table of a has more than 100000 points; expected at most 100000"),
        "{message}"
    );
}
