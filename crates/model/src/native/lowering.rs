//! Expressions of the parameters anywhere in the file.

use super::fields::Node;
use crate::error::{Fault, Place, Read, quote};
use crate::expression::{Expression, NumOp};
use crate::limits::FILE_NODES;
use crate::names;
use crate::parser::Parser;
use crate::profile::Point;
use crate::resolve::Resolved;
use crate::syntax::Op;
use std::cell::Cell;
use std::collections::HashMap;
use toml_edit::Value;

pub(crate) struct Lowering<'a> {
    resolved: &'a Resolved<'a>,
    by_name: HashMap<String, u32>,
    nodes: Cell<usize>,
}

impl<'a> Lowering<'a> {
    pub fn new(resolved: &'a Resolved<'a>) -> Self {
        let definitions = resolved.syntax.definitions.iter().map(|d| d.name);
        let by_name = definitions.map(|n| (resolved.name(n).to_ascii_lowercase(), n)).collect();
        Self { resolved, by_name, nodes: Cell::new(0) }
    }

    /// A number, or a text with an expression.
    pub fn expression(&self, node: &Node<'_>, what: &str) -> Read<Expression> {
        if !matches!(node.value(), Some(Value::String(_))) {
            let message =
                || format!("{what} is no finite number; expected a number or an expression in quotes");
            let value = node.number(what).map_err(|f| Fault::new(f.place, message()))?;
            self.count(1, node.place)?;
            return Ok(Expression { ops: vec![NumOp::Number(value)], place: node.place });
        }
        let value = node.value().ok_or_else(|| node.fault("no value; expected one"))?;
        let (text, place) = node.source.string(value, what)?;
        let mut parser = Parser::within(text, place)?;
        let mut ops = parser.expression()?;
        parser.expect_end_of_line("an operator or the end of the text")?;
        self.count(parser.nodes(), place)?;
        for (op, place) in &mut ops {
            if let Op::Name(local) = op {
                *local = self.find(&parser.syntax.names[*local as usize].text, *place)?;
            }
        }
        self.resolved.expression(&ops)
    }

    fn find(&self, name: &str, place: Place) -> Read<u32> {
        self.by_name.get(&name.to_ascii_lowercase()).copied().ok_or_else(|| {
            let known = self.resolved.syntax.definitions.iter().map(|d| self.resolved.name(d.name));
            let expected = match names::nearest(known, name) {
                Some(near) => format!("a defined name, perhaps `{near}`"),
                None => "a defined name".to_string(),
            };
            Fault::new(place, format!("{} is not defined; expected {expected}", quote(name)))
        })
    }

    fn count(&self, nodes: usize, place: Place) -> Read<()> {
        self.nodes.set(self.nodes.get() + nodes);
        if self.nodes.get() > FILE_NODES {
            let message =
                format!("more than {FILE_NODES} numbers, names and operators; expected at most as many");
            return Err(Fault::new(place, message));
        }
        Ok(())
    }

    /// So many expressions in a list.
    pub fn several(&self, node: &Node<'_>, what: &str, least: usize, most: usize) -> Read<Vec<Expression>> {
        let list = node.list(what)?;
        if !(least..=most).contains(&list.len()) {
            let count = if least == most { least.to_string() } else { format!("{least} or {most}") };
            return Err(node.fault(format!("{what} has {} entries; expected {count}", list.len())));
        }
        list.iter().map(|n| self.expression(n, what)).collect()
    }

    pub fn pair(&self, node: &Node<'_>, what: &str) -> Read<Point> {
        let mut both = self.several(node, what, 2, 2)?.into_iter();
        match (both.next(), both.next()) {
            (Some(a), Some(b)) => Ok([a, b]),
            _ => Err(node.fault(format!("{what} has no two entries; expected two"))),
        }
    }
}
