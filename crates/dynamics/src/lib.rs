//! Rigid and compliant contact, and motion: impacts, contact modes as explicit state, event location, trajectories, energy.
//!
//! Gelsey 1995, Appendix A (the *global* model), with contacts as projections onto `G q̇ ≥ 0` in place of the
//! elimination of coordinates.

mod balance;
mod chained;
mod chatter;
mod clearance;
mod complementarity;
mod compliant;
mod component;
mod constraints;
mod contact;
mod descent;
mod energy;
mod engine;
mod events;
mod few;
mod flight;
mod halts;
mod impact;
mod inertia;
mod linear;
mod lists;
mod march;
mod minima;
mod near;
mod opposed;
mod pace;
mod path;
mod place;
mod ranges;
mod recorder;
mod rest;
mod root;
mod run;
mod runge_kutta;
mod search;
mod settle;
mod sight;
mod simulation;
mod sweep;
mod tableau;
mod ties;
mod watch;
mod work;
mod world;

pub use balance::forces_at;
pub use compliant::{Compliant, compliant_forces_at};
pub use contact::Contact;
pub use energy::{Energy, kinetic, potential};
pub use engine::{Engine, start};
pub use events::{Event, EventKind};
pub use flight::{Bounds, Flight, State};
pub use minima::{Minimum, MinimumFinder};
pub use path::{Path, Piece, Trajectory};
pub use ranges::{Ranges, Track};
pub use run::{Mode, Options, Run, Stats, Status};
pub use settle::Closed;
pub use simulation::Simulation;
