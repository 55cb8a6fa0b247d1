//! New parameter values put into a TOML file; everything else of its text stays, comments included.

use crate::error::{Fault, Place, Read, quote};
use toml_edit::{DocumentMut, Item, TableLike, Value};

/// The text with some parameters given as plain numbers; names in any letter case.
pub(crate) fn with_values(source: &str, set: &[(String, f64)]) -> Read<String> {
    let fault = |message: String| Fault::new(Place::SETTING, message);
    let mut document: DocumentMut =
        source.parse().map_err(|_| fault("the file is no TOML any more; expected one".to_string()))?;
    for (name, value) in set {
        let missing = || fault(format!("no parameter is named {} in the file; expected one", quote(name)));
        let table = document.get_mut("parameters").and_then(Item::as_table_like_mut).ok_or_else(missing)?;
        let key = table.iter().map(|(k, _)| k).find(|k| k.eq_ignore_ascii_case(name)).map(str::to_string);
        let item = key.and_then(|k| table.get_mut(&k)).ok_or_else(missing)?;
        let slot = match item.as_table_like_mut() {
            Some(fields) => value_of(fields),
            None => item.as_value_mut(),
        };
        let slot = slot.ok_or_else(missing)?;
        let mut new = number(*value, slot);
        *new.decor_mut() = slot.decor().clone();
        *slot = new;
    }
    Ok(document.to_string())
}

fn value_of(fields: &mut dyn TableLike) -> Option<&mut Value> {
    fields.get_mut("value").and_then(Item::as_value_mut)
}

/// Written as an integer where one stood and one is given.
fn number(x: f64, old: &Value) -> Value {
    let whole = old.is_integer() && x.fract() == 0.0 && x.abs() < 2f64.powi(53);
    if whole { Value::from(x as i64) } else { Value::from(x) }
}
