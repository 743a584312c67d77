//! Contents of a file, known without reading its samples.

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Delimited text.
    Text,
    /// LabVIEW measurement file.
    Lvm,
    /// LabVIEW TDMS.
    Tdms,
    /// MATLAB, versions 4 to 7.
    Mat,
    /// HDF5, including MATLAB 7.3.
    Hdf5,
    /// RIFF, RIFX or RF64 WAVE.
    Wav,
    /// Universal file, data sets 58 and 58b.
    Uff58,
    /// sigrok logic-analyser capture.
    Sigrok,
    /// Workbook of Excel.
    Xlsx,
    /// Spreadsheet of OpenDocument.
    Ods,
    /// Arrays of NumPy, single or in an archive.
    Npy,
    /// Zip archive of tables of text.
    Zip,
}

impl Format {
    /// Every format with its name on the command line and in campaigns.
    pub const NAMES: [(&'static str, Self); 12] = [
        ("text", Self::Text),
        ("lvm", Self::Lvm),
        ("tdms", Self::Tdms),
        ("mat", Self::Mat),
        ("hdf5", Self::Hdf5),
        ("wav", Self::Wav),
        ("uff58", Self::Uff58),
        ("sigrok", Self::Sigrok),
        ("xlsx", Self::Xlsx),
        ("ods", Self::Ods),
        ("npy", Self::Npy),
        ("zip", Self::Zip),
    ];

    /// Whether cells may be blank, which means that there is no sample.
    pub fn has_blank_cells(self) -> bool {
        matches!(
            self,
            Self::Text | Self::Lvm | Self::Xlsx | Self::Ods | Self::Zip
        )
    }
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
            Self::Xlsx => "XLSX",
            Self::Ods => "ODS",
            Self::Npy => "NPY",
            Self::Zip => "zip",
        })
    }
}

/// When the samples of a channel were taken, if the file says so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeBase {
    /// Not stated.
    Unknown,
    /// At a constant rate.
    Uniform {
        /// Time of the first sample; s.
        start: f64,
        /// Time between samples; s.
        interval: f64,
    },
    /// At times stored in another channel of the file, in its unit.
    Channel(usize),
}

/// One channel of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelContents {
    /// Name used in campaigns, unique within the file; groups are joined by "/".
    pub name: String,
    /// Unit as written in the file.
    pub unit: Option<String>,
    /// Number of samples; `None` if unknown before reading.
    pub length: Option<u64>,
    /// When the samples were taken.
    pub time: TimeBase,
    /// How samples are stored, for example "16-bit integer, linear scale".
    pub stored_as: String,
    /// Other properties of the channel: name and text.
    pub properties: Vec<(String, String)>,
}

/// Something the user should know about the file; not an error.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Note {
    /// A part of the file that is not numeric or not supported, and why.
    #[error("{what} is left out: {why}")]
    #[allow(missing_docs)]
    LeftOut { what: String, why: String },
    /// The file is truncated here; what is complete is read.
    #[error("the file is cut off: {0}")]
    CutOff(String),
    /// Something not stated in the file was assumed: what, and how to override it.
    #[error("{0}")]
    Assumed(String),
    /// Nothing shows whether a mark stands before decimals or between groups of three digits:
    /// where, what was assumed, and how to settle it.
    #[error("{0}")]
    DecimalOrThousands(String),
    /// Cells of a column that hold a word or number for a missing sample.
    #[error(
        "\"{column}\": {count} cell(s) taken as missing samples; the first is \"{word}\" in line {line}"
    )]
    #[allow(missing_docs)]
    Missing {
        column: String,
        count: usize,
        line: u64,
        word: String,
    },
    /// The file contradicts itself or its format: how, and how that was resolved.
    #[error("{0}")]
    Odd(String),
}

impl Note {
    /// Short code for scripts.
    pub fn code(&self) -> &'static str {
        match self {
            Self::LeftOut { .. } => "left-out",
            Self::CutOff(_) => "cut-off",
            Self::Assumed(_) => "assumed",
            Self::DecimalOrThousands(_) => "decimal-or-thousands",
            Self::Missing { .. } => "missing-samples",
            Self::Odd(_) => "odd-file",
        }
    }
}

/// Contents of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Contents {
    /// Its format.
    pub format: Format,
    /// Version or variant of the format, such as "v7.3" or "RIFX".
    pub variant: String,
    /// Numeric channels in file order.
    pub channels: Vec<ChannelContents>,
    /// Properties of the file: name and text.
    pub properties: Vec<(String, String)>,
    /// Notes for the user.
    pub notes: Vec<Note>,
}
