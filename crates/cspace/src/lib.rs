//! Configuration spaces of planar pairs: where two bodies are free, where they overlap, and the curves of contact.

mod bodies;
mod cells;
mod cross;
mod curve;
mod domain;
mod element;
mod equation;
mod error;
mod lattice;
mod limits;
mod links;
mod locate;
mod moving;
mod options;
mod pairs;
mod pieces;
mod reduce;
mod region;
mod shape;
mod slabs;
mod space;
mod span;
mod symmetry;
mod tree;
mod witness;

pub use cells::Work;
pub use curve::Curve;
pub use domain::Axis;
pub use error::SpaceError;
pub use lattice::Lattice;
pub use options::SpaceOptions;
pub use space::ConfigurationSpace;
