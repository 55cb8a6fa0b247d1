//! Compliant contact: forces from overlap and its rate (Gelsey 1995, Sec. 2.2.1, the *local* model).

mod changes;
mod group;
mod loads;
mod rosenbrock;
mod simulation;
mod stretch;
mod tableau;

pub use simulation::Compliant;
