//! The files that make a campaign, and their version.

use std::path::Path;
use windfall_campaign::settings::kind::CAMPAIGN_FILE;
use windfall_files::error::Error;
use windfall_files::provenance::digest_text;

/// Files that make a campaign; the store and the recordings are no part of it.
pub const CAMPAIGN_FILES: [&str; 3] = [CAMPAIGN_FILE, "specimens.csv", "impacts.csv"];

/// Digest of the files of a campaign; one that is absent counts as empty.
///
/// # Errors
/// One of them cannot be read.
pub fn campaign_version(directory: &Path) -> Result<String, Error> {
    let mut all = String::new();
    for name in CAMPAIGN_FILES {
        let path = directory.join(name);
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Vec::new(),
            Err(source) => return Err(Error::access(&path, "read", source)),
        };
        let text = String::from_utf8_lossy(&bytes);
        all += &format!("{name} {}\n{text}\n", bytes.len());
    }
    Ok(digest_text(&all)[..16].to_owned())
}
