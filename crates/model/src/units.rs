//! The units a file states.

/// Names of units as written, for display; nothing converts them. Angles in files are in degrees.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Units {
    pub length: Option<String>,
    pub time: Option<String>,
    pub mass: Option<String>,
}

/// Names of units of one kind that are known not to mean the same.
const KINDS: [&[&str]; 3] = [
    &["nm", "um", "µm", "mm", "cm", "dm", "m", "km", "in", "inch", "ft", "mil"],
    &["us", "µs", "ms", "s", "min", "h"],
    &["ug", "µg", "mg", "g", "kg", "t", "lb", "oz"],
];

impl Units {
    /// A unit named within `text` (as in `mm/s`) of a kind that the file counts in another, and that other.
    pub(crate) fn clash<'a>(&'a self, text: &'a str) -> Option<(&'a str, &'a str)> {
        let stated = [&self.length, &self.time, &self.mass];
        let words = || text.split(|c: char| !c.is_alphabetic()).filter(|w| !w.is_empty());
        KINDS.iter().zip(stated).find_map(|(kind, stated)| {
            let stated = stated.as_deref().filter(|s| kind.contains(s))?;
            words().find(|w| kind.contains(w) && *w != stated).map(|w| (w, stated))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Units;

    #[test]
    fn what_is_counted_otherwise_is_found_within_a_unit() {
        let word = |s: &str| Some(s.to_string());
        let units = Units { length: word("mm"), time: word("s"), mass: word("parsnip") };
        assert_eq!(units.clash("m"), Some(("m", "mm")));
        assert_eq!(units.clash("mm/min"), Some(("min", "s")));
        assert_eq!(units.clash("mm2/s2"), None);
        assert_eq!(units.clash("kg deg"), None);
        assert_eq!(Units::default().clash("m"), None);
    }
}
