//! How files are read that do not say it themselves, as texts: in `[files]` of
//! campaign.toml and as flags of `inspect`.

use windfall_files::error::Error;
use windfall_files::option_value::{chosen, unusable};
use windfall_formats::contents::Format;
use windfall_formats::open::OpenOptions;
use windfall_formats::text::encoding::Encoding;
use windfall_formats::text::options::TextOptions;
use windfall_formats::text::rows::Separator;

/// Separators of tables in text by name.
pub const SEPARATORS: [(&str, Separator); 5] = [
    ("comma", Separator::Mark(b',')),
    ("semicolon", Separator::Mark(b';')),
    ("tab", Separator::Mark(b'\t')),
    ("bar", Separator::Mark(b'|')),
    ("blanks", Separator::Blanks),
];

/// Decimal marks by name.
pub const DECIMALS: [(&str, char); 2] = [("point", '.'), ("comma", ',')];

/// Marks between groups of three digits by name.
pub const THOUSANDS: [(&str, char); 4] = [
    ("point", '.'),
    ("comma", ','),
    ("apostrophe", '\''),
    ("space", ' '),
];

/// Encodings of text by name.
pub const ENCODINGS: [(&str, Encoding); 4] = [
    ("utf-8", Encoding::Utf8),
    ("windows-1252", Encoding::Windows1252),
    ("utf-16le", Encoding::Utf16Le),
    ("utf-16be", Encoding::Utf16Be),
];

/// How files are to be read; what is left out is found out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(
    feature = "clap",
    command(next_help_heading = "Reading unusual files (found out if left out)")
)]
pub struct OpenRequest {
    /// Format, whatever the first bytes say: text, lvm, tdms, mat, hdf5, wav, uff58, sigrok,
    /// xlsx, ods, npy, zip
    #[cfg_attr(feature = "clap", arg(id = "file-format", long, value_name = "FORMAT"))]
    pub format: Option<String>,
    /// Between the cells of a text: comma, semicolon, tab, bar or blanks
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub separator: Option<String>,
    /// Before decimals: point or comma
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub decimal: Option<String>,
    /// Between groups of three digits: point, comma, apostrophe or space
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub thousands: Option<String>,
    /// Encoding of a text: utf-8, windows-1252, utf-16le or utf-16be
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub encoding: Option<String>,
    /// Line with the names of the columns, from 1; 0 if there is none
    #[cfg_attr(feature = "clap", arg(long, value_name = "LINE"))]
    pub header_line: Option<u64>,
    /// Beginning of lines that are passed over
    #[cfg_attr(feature = "clap", arg(long, value_name = "TEXT"))]
    pub comment: Option<String>,
    /// A word or number that stands for a missing sample, beside the usual words (NaN, N/A, OVLD, …);
    /// may be repeated
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "TEXT", allow_hyphen_values = true)
    )]
    pub missing: Vec<String>,
    /// Lines at the end of a text that are not rows of numbers
    #[cfg_attr(feature = "clap", arg(long, value_name = "LINES", default_value_t))]
    pub footer: u64,
}

/// The options of the readers.
///
/// # Errors
/// A text cannot be used; the message names the flag.
pub fn open_options(request: &OpenRequest) -> Result<OpenOptions, Error> {
    fn named<T: Copy>(
        option: &str,
        text: Option<&String>,
        known: &[(&str, T)],
    ) -> Result<Option<T>, Error> {
        text.map(|text| chosen(option, text, known)).transpose()
    }
    let separator = named("--separator", request.separator.as_ref(), &SEPARATORS)?;
    let decimal = named("--decimal", request.decimal.as_ref(), &DECIMALS)?;
    let thousands = named("--thousands", request.thousands.as_ref(), &THOUSANDS)?;
    if decimal.is_some() && decimal == thousands {
        let problem = "decimals and thousands cannot have the same mark";
        return Err(unusable("--thousands", problem));
    }
    if request.comment.as_deref() == Some("") {
        return Err(unusable(
            "--comment",
            "give the characters that comments begin with",
        ));
    }
    Ok(OpenOptions {
        format: named("--file-format", request.format.as_ref(), &Format::NAMES)?,
        text: TextOptions {
            separator,
            decimal,
            thousands,
            encoding: named("--encoding", request.encoding.as_ref(), &ENCODINGS)?,
            header_line: request.header_line,
            comment: request.comment.clone(),
            missing: request.missing.clone(),
            footer: request.footer,
            lines_above: 0,
        },
    })
}
