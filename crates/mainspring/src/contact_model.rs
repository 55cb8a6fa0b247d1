//! Which model of contact a run uses, with its constants and its tolerance.

use crate::options::{check_law, check_tolerance};
use mainspring_dynamics::Contact;
use mainspring_mechanism::{ContactLaw, System};
use mainspring_model::Error;
use serde_json::{Value, json};

/// A model of contact by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactModel {
    #[default]
    Rigid,
    Compliant,
}

impl ContactModel {
    /// The model called so.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "rigid" => Some(Self::Rigid),
            "compliant" => Some(Self::Compliant),
            _ => None,
        }
    }

    /// Relative tolerance unless another is asked for. Rigid motion is exact but for stretches in contact, and dear to lose;
    /// compliant motion costs steps, and with 1.5e-6 every shipped machine accounts for its energy to 1e-5.
    pub fn default_rtol(self) -> f64 {
        match self {
            Self::Rigid => 1e-8,
            Self::Compliant => 1.5e-6,
        }
    }
}

/// How contact is to be modelled.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactChoice {
    pub model: ContactModel,
    /// Constants of compliant contact; those of the supplement if None.
    pub law: Option<ContactLaw>,
    /// Relative tolerance of integration and of contact times; the model's own if None.
    pub rtol: Option<f64>,
}

impl ContactChoice {
    /// The model with its constants, and the tolerance.
    ///
    /// # Errors
    /// Constants or a tolerance out of their range.
    pub(crate) fn resolve(&self, system: &System) -> Result<(Contact, f64), Error> {
        let rtol = self.rtol.unwrap_or(self.model.default_rtol());
        check_tolerance(rtol)?;
        let law = self.law.unwrap_or(system.forces.contact);
        check_law(&law)?;
        let contact = match self.model {
            ContactModel::Rigid => Contact::Rigid,
            ContactModel::Compliant => Contact::Compliant(law),
        };
        Ok((contact, rtol))
    }
}

/// The constants of compliant contact; None for rigid contact.
pub(crate) fn constants(contact: &Contact) -> Option<Value> {
    match contact {
        Contact::Rigid => None,
        Contact::Compliant(law) => Some(json!({"E": law.e, "D": law.d, "M": law.m})),
    }
}
