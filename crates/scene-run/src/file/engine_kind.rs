//! Engines that a scene can run on.

/// An engine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Engine {
    /// The one of this program.
    #[default]
    Windfall,
    /// LAMMPS.
    Lammps,
    /// LIGGGHTS.
    Liggghts,
}

impl Engine {
    /// Its name, for people.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Windfall => "windfall",
            Self::Lammps => "LAMMPS",
            Self::Liggghts => "LIGGGHTS",
        }
    }

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Windfall => "windfall",
            Self::Lammps => "lammps",
            Self::Liggghts => "liggghts",
        }
    }
}
