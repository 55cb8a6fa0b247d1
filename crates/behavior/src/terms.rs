//! What points of comparison are compared by, and how it is told that they differ (Gelsey 1995, Algorithm 12).

/// Parameters of Algorithm 12, with the paper's names and defaults.
#[derive(Clone, Debug, PartialEq)]
pub struct MatchOptions {
    /// P_confirm = 2: instances that must match beyond the first.
    pub confirm: u32,
    /// P_range_fraction = 1e-5: minima count below this fraction of the greatest kinetic energy so far.
    pub range_fraction: f64,
    /// P_ignore = 4: minima passed over at the start.
    pub ignore: u32,
    /// P_t_match = 0.01, relative to D.
    pub time_match: f64,
    /// P_s_v_match = 0.02, relative to each variable's peak-to-peak.
    pub state_match: f64,
}

impl Default for MatchOptions {
    fn default() -> Self {
        Self { confirm: 2, range_fraction: 1e-5, ignore: 4, time_match: 0.01, state_match: 0.02 }
    }
}

/// How a coordinate is called in reasons.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    pub name: String,
    /// Told in degrees if it turns.
    pub turns: bool,
}

impl Label {
    fn tell(&self, amount: f64) -> String {
        if self.turns { format!("{:.4}°", amount.to_degrees()) } else { format!("{amount:.6}") }
    }
}

/// Changes smaller than these count as equal whatever the range: ten integration tolerances.
#[derive(Clone, Debug, PartialEq)]
pub struct Floors {
    pub q: Vec<f64>,
    pub v: Vec<f64>,
}

/// What points are compared by.
#[derive(Clone, Copy, Debug)]
pub struct Terms<'t> {
    pub options: &'t MatchOptions,
    /// Of each coordinate.
    pub labels: &'t [Label],
    pub floors: &'t Floors,
    /// Of each coordinate the changes to a multiple of each of which its shapes are bound (`System::shape_periods`).
    pub periods: &'t [Vec<f64>],
}

/// Why a hypothesis falls.
pub enum Fall {
    /// An instance took this long, not that.
    Took(f64, f64),
    /// A coordinate moved by this much, not that.
    Moved(usize, f64, f64),
    /// Its velocity changed by this much, not that.
    Sped(usize, f64, f64),
    /// A coordinate moves by this much, after which its shapes are others.
    Unlike(usize, f64),
}

impl Fall {
    pub fn says(&self, labels: &[Label]) -> String {
        match *self {
            Fall::Took(found, expected) => format!("took {found:.6} s, expected {expected:.6} s"),
            Fall::Moved(i, found, expected) => {
                let label = &labels[i];
                format!("{} moved by {}, expected {}", label.name, label.tell(found), label.tell(expected))
            }
            Fall::Sped(i, found, expected) => {
                let (label, found, expected) = (&labels[i], labels[i].tell(found), labels[i].tell(expected));
                format!("{} changed its velocity by {found}, expected {expected}", label.name)
            }
            Fall::Unlike(i, change) => {
                let label = &labels[i];
                format!("{} moves on by {}, where its shape is not the same", label.name, label.tell(change))
            }
        }
    }
}
