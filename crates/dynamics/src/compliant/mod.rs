//! Compliant contact: forces from overlap and its rate (Gelsey 1995, Sec. 2.2.1, the *local* model).

mod changes;
mod dry;
mod group;
mod loads;
mod rosenbrock;
mod simulation;
mod steps;
mod stretch;
mod tableau;
mod tip;

pub use simulation::{Compliant, compliant_forces_at};
