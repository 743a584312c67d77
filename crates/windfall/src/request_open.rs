//! How files are read that do not say it themselves, as texts.

use crate::error::Error;
use crate::option_value::chosen;
use windfall_formats::contents::Format;
use windfall_formats::open::OpenOptions;
use windfall_formats::text_options::TextOptions;

/// Formats by name.
pub const FORMATS: [(&str, Format); 8] = [
    ("text", Format::Text),
    ("lvm", Format::Lvm),
    ("tdms", Format::Tdms),
    ("mat", Format::Mat),
    ("hdf5", Format::Hdf5),
    ("wav", Format::Wav),
    ("uff58", Format::Uff58),
    ("sigrok", Format::Sigrok),
];

/// How files are to be read; what is left out is found out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OpenRequest {
    /// A name of [`FORMATS`].
    pub format: Option<String>,
}

/// The options of the readers.
///
/// # Errors
/// A text cannot be used; the message names the flag.
pub fn open_options(request: &OpenRequest) -> Result<OpenOptions, Error> {
    let format = request.format.as_ref();
    Ok(OpenOptions {
        format: format
            .map(|text| chosen("--file-format", text, &FORMATS))
            .transpose()?,
        text: TextOptions::default(),
    })
}
