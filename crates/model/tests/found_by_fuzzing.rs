//! What broke the reader once, each with its story.

mod common;

use common::read;
use mainspring_model::Machine;

fn machine(numbers: &str) -> Machine {
    let text = format!("generic g(r)\n{numbers}\ns = blo()\nr = s\n");
    read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}"))
}

/// Dual numbers divide by multiplying with the reciprocal, and 1/5e-324 is infinite: an input that evaluated over
/// numbers was refused over dual numbers. Tiny divisors are scaled first (inputs 350333 and 391682 of seed 1).
#[test]
fn division_by_the_least_numbers() {
    let machine = machine("u = 2e-320\nf = u/4e-320\ng = 3*u/u");
    let values = machine.values(&[]).unwrap();
    let dual = machine.values_with_derivative(&[], "u").unwrap();
    assert_eq!(dual.re(), values);
    assert_eq!(values.get(1).unwrap(), 0.5);
    assert_eq!(dual.get(2).unwrap().re, 3.0);
}

/// The same in square roots and in the angle of a point: squares of small numbers are zero, of large ones infinite.
#[test]
fn roots_and_angles_at_the_ends_of_the_range() {
    for unit in ["1e-320", "1e-200", "1", "1e200"] {
        let machine = machine(&format!("u = {unit}\nf = sqrt(u)\ng = atan2(u, {unit})\nh = atan2(3*u, 4*u)"));
        let values = machine.values(&[]).unwrap();
        let dual = machine.values_with_derivative(&[], "u").unwrap();
        assert_eq!(dual.re(), values, "{unit}");
        assert_eq!(values.get(2).unwrap(), 45.0);
        if unit != "1e-320" {
            let relative = |i: usize| dual.get(i).unwrap().eps * values.get(0).unwrap();
            assert!((relative(1) / values.get(1).unwrap() - 0.5).abs() < 1e-14, "{unit}");
            assert!((relative(2) - 0.5f64.to_degrees()).abs() < 1e-13, "{unit}");
            assert!(relative(3).abs() < 1e-13, "{unit}");
        }
    }
}

/// A range from −5e-324 was printed with 324 digits (input 628743 of seed 1).
#[test]
fn tiny_numbers_in_messages_have_an_exponent() {
    let text = "generic g(r)\nn = -1 in [-5e-324, 1e300]\ns = blo()\nr = s\n";
    let message = read(text.as_bytes()).unwrap_err().to_string();
    assert_eq!(message, "m.padl:2:1: error: n is -1; expected a value in its range [-5e-324, 1e300]");
}

/// Suggesting a name took five seconds when a file had 99,000 long names, all of one length.
#[test]
fn a_nearest_name_is_sought_among_the_first_ten_thousand() {
    let names: String = (10_000..109_000).map(|i| format!("averylongnameforadefinition{i}=1\n")).collect();
    let text = format!("generic g(r)\ns = blo()\n{names}r = averylongnameforadefinition99999x\n");
    let message = read(text.as_bytes()).unwrap_err().to_string();
    assert!(message.starts_with("m.padl:99003:5: error: `averylongnameforadefinition99999x` is not defined"));
}

/// A quotient of −0 was −0 over numbers and 0 over dual numbers (input 146478 of seed 1).
#[test]
fn negative_zero_is_zero() {
    let machine = machine("u = 3\nf = -0*u/2\ng = sin(-0*u)\nh = atan2(-0*u, 1)");
    let dual = machine.values_with_derivative(&[], "u").unwrap().re();
    for (a, b) in machine.values(&[]).unwrap().as_slice().iter().zip(dual.as_slice()) {
        assert_eq!(a.to_bits(), b.to_bits());
    }
}
