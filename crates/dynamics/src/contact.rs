//! How contact is modelled.

use mainspring_mechanism::ContactLaw;

/// A model of contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Contact {
    /// Parts never overlap (Gelsey's *global* model).
    #[default]
    Rigid,
    /// Forces from overlap and its rate (Gelsey's *local* model).
    Compliant(ContactLaw),
}
