//! Numbers and lists in JSON and in sentences.

use mainspring_geometry::{Vec2, Vec3};
use serde_json::{Map, Value, json};

/// A map with one entry a moving part, in the order of the model.
pub fn by_part(names: &[String], values: impl IntoIterator<Item = f64>) -> Value {
    Value::Object(
        names.iter().cloned().zip(values.into_iter().map(|x| json!(clean(x)))).collect::<Map<_, _>>(),
    )
}

/// Zero without a sign.
pub fn clean(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x }
}

pub fn vec2(v: Vec2) -> Value {
    json!([clean(v.x), clean(v.y)])
}

pub fn vec3(v: Vec3) -> Value {
    json!([clean(v.x), clean(v.y), clean(v.z)])
}

/// A number with `digits` significant digits, without trailing zeros.
pub fn number(x: f64, digits: usize) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{}", clean(x));
    }
    let magnitude = x.abs().log10().floor() as i32;
    let decimals = (digits as i32 - 1 - magnitude).max(0) as usize;
    let text = format!("{x:.decimals$}");
    let trimmed = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    trimmed.replace('-', "−")
}

/// `a`, `a and b`, `a, b and c`.
pub fn list(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [start @ .., last] => format!("{} and {last}", start.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::{list, number};

    #[test]
    fn numbers_have_only_the_digits_asked_for() {
        assert_eq!(number(7.385687255, 5), "7.3857");
        assert_eq!(number(-36.0, 4), "−36");
        assert_eq!(number(0.0001234, 3), "0.000123");
        assert_eq!(number(12345.678, 4), "12346");
    }

    #[test]
    fn lists_read_like_sentences() {
        let words = ["a", "b", "c"].map(String::from);
        assert_eq!(list(&words), "a, b and c");
        assert_eq!(list(&words[..1]), "a");
    }
}
