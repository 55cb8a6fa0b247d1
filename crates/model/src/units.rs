//! The units a file states.

/// Names of units as written, for display; nothing converts them. Angles in files are in degrees.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Units {
    pub length: Option<String>,
    pub time: Option<String>,
    pub mass: Option<String>,
}
