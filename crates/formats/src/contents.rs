//! What a file holds, known without reading its samples.

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Lines of numbers between separators.
    Text,
    /// LabVIEW measurement file.
    Lvm,
    /// LabVIEW TDMS.
    Tdms,
    /// MATLAB, versions 4 to 7.
    Mat,
    /// HDF5, which MATLAB 7.3 files are too.
    Hdf5,
    /// RIFF, RIFX or RF64 WAVE.
    Wav,
    /// Universal file, data sets 58 and 58b.
    Uff58,
    /// Logic-analyser capture of sigrok.
    Sigrok,
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Text => "text",
            Self::Lvm => "LVM",
            Self::Tdms => "TDMS",
            Self::Mat => "MAT",
            Self::Hdf5 => "HDF5",
            Self::Wav => "WAV",
            Self::Uff58 => "UFF58",
            Self::Sigrok => "sigrok",
        })
    }
}

/// When the samples of a channel were taken, as far as the file says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeBase {
    /// It does not say.
    Unknown,
    /// Evenly.
    Uniform {
        /// Time of the first sample; s.
        start: f64,
        /// Time between samples; s.
        interval: f64,
    },
    /// At the times in another channel of the same file, in that channel's unit.
    Channel(usize),
}

/// One channel of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelContents {
    /// Name by which a campaign asks for it; unique within the file. Groups and
    /// channels, or nested things, are joined by "/".
    pub name: String,
    /// Unit as the file writes it.
    pub unit: Option<String>,
    /// Number of samples; `None` where only reading tells.
    pub length: Option<u64>,
    /// When they were taken.
    pub time: TimeBase,
    /// How they are stored, in a few words: "16-bit integer, linear scale".
    pub stored_as: String,
    /// Other things that the file says of the channel: name and text.
    pub properties: Vec<(String, String)>,
}

/// Something about the file that a user must know; reading goes on.
#[derive(Clone, Debug, PartialEq)]
pub enum Note {
    /// A part of the file is not numbers, or not read: what, and why.
    LeftOut {
        /// What.
        what: String,
        /// Why.
        why: String,
    },
    /// The last part of the file is incomplete; what is complete is read.
    CutOff {
        /// What is missing.
        missing: String,
    },
    /// The file does not say, and windfall has taken the usual.
    Assumed {
        /// What was taken, and how to say otherwise.
        what: String,
    },
    /// The file contradicts itself or its format; how it was read.
    Odd {
        /// What, and how it was read.
        what: String,
    },
}

impl Note {
    /// Short name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::LeftOut { .. } => "left-out",
            Self::CutOff { .. } => "cut-off",
            Self::Assumed { .. } => "assumed",
            Self::Odd { .. } => "odd-file",
        }
    }
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::LeftOut { what, why } => write!(f, "{what} is left out: {why}"),
            Self::CutOff { missing } => write!(f, "the file is cut off: {missing}"),
            Self::Assumed { what } | Self::Odd { what } => f.write_str(what),
        }
    }
}

/// What a file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Contents {
    /// Its format.
    pub format: Format,
    /// Version or variant of the format, as one would say it: "v7.3", "RIFX".
    pub variant: String,
    /// Channels of numbers, in the order of the file.
    pub channels: Vec<ChannelContents>,
    /// What the file says of itself: name and text.
    pub properties: Vec<(String, String)>,
    /// What a user must know.
    pub notes: Vec<Note>,
}
