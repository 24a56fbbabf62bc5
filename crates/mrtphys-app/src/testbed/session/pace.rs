//! How simulated time follows real time (thesis, section 7.1).

/// Real-time mode of the Animation panel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RealTime {
    /// frames as fast as they can be computed
    Off,
    /// simulated time never runs ahead of real time; it may fall behind
    #[default]
    IfPossible,
    /// it does not fall behind either: after a slow frame the frames that are late are merged into one, with the physical
    /// steps of one
    Forced,
}

impl RealTime {
    /// All modes with the thesis's names.
    pub const ALL: [(RealTime, &'static str); 3] =
        [(RealTime::Off, "Off"), (RealTime::IfPossible, "If possible"), (RealTime::Forced, "Forced")];
}
