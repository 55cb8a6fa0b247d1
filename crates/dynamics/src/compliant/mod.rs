//! Compliant contact: forces from overlap and its rate (Gelsey 1995, Sec. 2.2.1, the *local* model).

mod changes;
mod dry;
mod ending;
mod group;
mod loads;
mod rosenbrock;
mod settling;
mod simulation;
mod steps;
mod stretch;
mod tableau;
mod tip;

pub use ending::compliant_forces_at;
pub use simulation::Compliant;
