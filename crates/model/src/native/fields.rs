//! Tables and values with their places, whichever way TOML writes them.

use super::source::Source;
use crate::error::{Fault, Place, Read, quote};
use crate::names;
use toml_edit::{Item, TableLike, Value};

/// A value, a table, or a list of tables.
#[derive(Clone, Copy)]
pub(crate) struct Node<'a> {
    pub source: &'a Source<'a>,
    thing: Thing<'a>,
    pub place: Place,
}

#[derive(Clone, Copy)]
enum Thing<'a> {
    Value(&'a Value),
    Table(&'a dyn TableLike),
    Tables(&'a toml_edit::ArrayOfTables),
}

/// A table whose keys are being read.
#[derive(Clone, Copy)]
pub(crate) struct Fields<'a> {
    pub source: &'a Source<'a>,
    table: &'a dyn TableLike,
    pub place: Place,
}

impl<'a> Fields<'a> {
    pub fn root(source: &'a Source<'a>, table: &'a toml_edit::Table) -> Self {
        Self { source, table, place: source.place(0) }
    }

    /// Refuses keys that mean nothing here. `what` names the table.
    pub fn allow(&self, what: &str, known: &[&str]) -> Read<()> {
        for (key, place) in self.keys() {
            if !known.contains(&key) {
                let expected = names::one_of(known, key);
                let message = format!("{what} has no key {}; expected {expected}", quote(key));
                return Err(Fault::new(place, message));
            }
        }
        Ok(())
    }

    /// The keys in the order of the text.
    pub fn keys(&self) -> Vec<(&'a str, Place)> {
        let place = |key: &str| {
            let span = self.table.key(key).and_then(|k| k.span());
            span.map_or(self.place, |s| self.source.place(s.start))
        };
        self.table.iter().filter(|(_, item)| !item.is_none()).map(|(k, _)| (k, place(k))).collect()
    }

    pub fn get(&self, key: &str) -> Option<Node<'a>> {
        let item = self.table.get(key)?;
        let key_span = self.table.key(key).and_then(|k| k.span());
        let place = self.source.place_of(item.span().or(key_span));
        let thing = match item {
            Item::None => return None,
            Item::Value(v) => Thing::Value(v),
            Item::Table(t) => Thing::Table(t),
            Item::ArrayOfTables(t) => Thing::Tables(t),
        };
        Some(Node { source: self.source, thing, place })
    }

    pub fn need(&self, key: &str, what: &str) -> Read<Node<'a>> {
        let missing = || Fault::new(self.place, format!("{what} has no `{key}`; expected one"));
        self.get(key).ok_or_else(missing)
    }
}

impl<'a> Node<'a> {
    pub fn fault(&self, message: impl Into<String>) -> Box<Fault> {
        Fault::new(self.place, message)
    }

    /// The table; `what` names it.
    pub fn table(&self, what: &str) -> Read<Fields<'a>> {
        let table: &'a dyn TableLike = match self.thing {
            Thing::Table(t) => t,
            Thing::Value(Value::InlineTable(t)) => t,
            _ => return Err(self.fault(format!("{what} is no table; expected a table of keys and values"))),
        };
        Ok(Fields { source: self.source, table, place: self.place })
    }

    pub fn is_table(&self) -> bool {
        matches!(self.thing, Thing::Table(_) | Thing::Value(Value::InlineTable(_)))
    }

    /// The elements of a list.
    pub fn list(&self, what: &str) -> Read<Vec<Node<'a>>> {
        let value = |v: &'a Value| Node {
            source: self.source,
            thing: Thing::Value(v),
            place: self.source.place_of(v.span()),
        };
        let table = |t: &'a toml_edit::Table| Node {
            source: self.source,
            thing: Thing::Table(t),
            place: self.source.place_of(t.span()),
        };
        match self.thing {
            Thing::Value(Value::Array(a)) => Ok(a.iter().map(value).collect()),
            Thing::Tables(t) => Ok(t.iter().map(table).collect()),
            _ => Err(self.fault(format!("{what} is no list; expected values between [ and ]"))),
        }
    }

    pub fn value(&self) -> Option<&'a Value> {
        match self.thing {
            Thing::Value(v) => Some(v),
            _ => None,
        }
    }

    pub fn flag(&self, what: &str) -> Read<bool> {
        let value = self.value().and_then(Value::as_bool);
        value.ok_or_else(|| self.fault(format!("{what} is neither true nor false; expected one of them")))
    }

    /// A plain number.
    pub fn number(&self, what: &str) -> Read<f64> {
        let value = match self.value() {
            Some(Value::Integer(i)) => Some(*i.value() as f64),
            Some(Value::Float(f)) => Some(*f.value()),
            _ => None,
        };
        value
            .filter(|x| x.is_finite())
            .ok_or_else(|| self.fault(format!("{what} is no finite number; expected a plain number")))
    }

    /// A word of free text, on one line.
    pub fn words(&self, what: &str, most: usize) -> Read<String> {
        let text = self.value().and_then(Value::as_str);
        let text = text.ok_or_else(|| self.fault(format!("{what} is no text; expected it in quotes")))?;
        let fits = text.chars().count() <= most && !text.chars().any(crate::error::is_control);
        if fits {
            return Ok(text.to_string());
        }
        Err(self.fault(format!(
            "{what} is longer than {most} characters or not on one line; expected a short line"
        )))
    }
}
