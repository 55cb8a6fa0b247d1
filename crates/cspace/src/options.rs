//! What may be chosen about a configuration space.

/// Choices. Positions are joint coordinates q as the system counts them: radians or lengths.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceOptions {
    /// Range of the first and the second coordinate; none: a whole turn, or as far as a sliding part can touch.
    pub windows: [Option<(f64, f64)>; 2],
    /// Values of other coordinates that move the two bodies.
    pub held: Vec<(usize, f64)>,
    /// Use that teeth repeat: only one period is computed.
    pub periodic: bool,
    /// Most boxes looked at.
    pub budget: usize,
}

impl Default for SpaceOptions {
    fn default() -> Self {
        SpaceOptions { windows: [None, None], held: vec![], periodic: true, budget: 4_000_000 }
    }
}
