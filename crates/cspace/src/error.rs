//! Why a configuration space is refused.

use std::fmt;

/// Why two bodies and two coordinates have no configuration space, or none could be made with certainty.
#[derive(Clone, Debug, PartialEq)]
pub enum SpaceError {
    /// A body or coordinate that the system does not have.
    Absent { what: &'static str, index: usize },
    /// The same body, or the same coordinate, twice.
    Same { what: &'static str, name: String },
    /// Neither coordinate moves one body against the other: parts of one subsystem.
    OneSubsystem { bodies: [String; 2] },
    /// A third coordinate moves the bodies against each other and no value is stated at which it is held.
    MoreFreedoms { bodies: [String; 2], coordinate: String },
    /// One coordinate moves the bodies against each other through more than one joint.
    MovesTwice { bodies: [String; 2], coordinate: String },
    /// A window is needed (translation without bounds), or the one given is empty, not finite, or wider than
    /// one turn.
    Window { coordinate: String, reason: &'static str },
    /// An outline or a position is not made of finite numbers.
    NotFinite { body: String },
    /// A body thinner than 1e-9 of the machine's size.
    Thin { body: String },
    /// Given up as `Progress` asked.
    Stopped,
    /// More cells, curves or crossings than `SpaceOptions::budget` allows.
    TooComplex { budget: usize },
    /// Free and blocked could not be told apart consistently here (joint coordinates as asked for): contacts
    /// closer together than rounding can separate.
    Degenerate { at: [f64; 2] },
}

impl fmt::Display for SpaceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Absent { what, index } => write!(f, "there is no {what} with index {index}"),
            Self::Same { what, name } => {
                write!(f, "two different ones are needed, not twice the {what} {name}")
            }
            Self::OneSubsystem { bodies: [a, b] } => {
                write!(f, "neither coordinate moves {a} against {b}: they belong to one subsystem")
            }
            Self::MoreFreedoms { bodies: [a, b], coordinate } => {
                write!(f, "{coordinate} also moves {a} against {b}: state a value at which it is held")
            }
            Self::MovesTwice { bodies: [a, b], coordinate } => {
                write!(f, "{coordinate} moves {a} against {b} through more than one joint")
            }
            Self::Window { coordinate, reason } => write!(f, "window of {coordinate}: {reason}"),
            Self::NotFinite { body } => write!(f, "{body}: outline or position is not finite"),
            Self::Thin { body } => {
                write!(f, "{body} is thinner than a billionth of the machine: what it blocks cannot be told")
            }
            Self::Stopped => write!(f, "stopped"),
            Self::TooComplex { budget } => {
                write!(f, "more than {budget} cells, curves or crossings; a smaller window may do")
            }
            Self::Degenerate { at: [x, y] } => {
                write!(f, "contacts too close to each other to tell free from blocked near ({x}, {y})")
            }
        }
    }
}

impl std::error::Error for SpaceError {}
