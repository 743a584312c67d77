//! Engines that a scene can run on.

/// An engine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Engine {
    /// The engine of this program
    #[default]
    Windfall,
    /// LAMMPS of 29 Sep 2021 or newer
    Lammps,
    /// LIGGGHTS-PUBLIC 3.8
    Liggghts,
}

impl Engine {
    /// Its name, for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Windfall => "windfall",
            Self::Lammps => "LAMMPS",
            Self::Liggghts => "LIGGGHTS",
        }
    }

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Windfall => "windfall",
            Self::Lammps => "lammps",
            Self::Liggghts => "liggghts",
        }
    }
}
