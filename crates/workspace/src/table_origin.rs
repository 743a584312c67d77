//! What the table of a campaign's results was made of: it is made anew when that has changed.

use std::path::Path;
use windfall_campaign::settings::kind::STORE_FILE;
use windfall_campaign::store::documents::{DocumentRecord, find_documents};
use windfall_campaign::store::runs::{latest_run, write_document};
use windfall_files::error::Error;
use windfall_files::provenance::{digest_file, digest_text};

/// Name of what the store holds of it.
const KEY: &str = "origin of the table of results";

/// Tables that are joined with the results.
const JOINED: [&str; 2] = ["impacts.csv", "specimens.csv"];

/// Whether the table is of other results, or of other tables, than there are now.
pub fn outdated(directory: &Path) -> bool {
    let (store, keys) = (directory.join(STORE_FILE), [KEY.to_owned()]);
    let noted = find_documents::<String>(&store, &keys, ("documents", "item"));
    let noted = noted.ok().and_then(|mut found| found.pop()?);
    noted.is_none_or(|noted| noted != origin(directory))
}

/// Notes in the store what the table that was just written is made of.
///
/// # Errors
/// The store cannot be written.
pub fn note(directory: &Path) -> Result<(), Error> {
    let record = DocumentRecord {
        key: KEY.to_owned(),
        kind: "origin".to_owned(),
        item: KEY.to_owned(),
        specimen: String::new(),
        file: String::new(),
        document: format!("\"{}\"", origin(directory)),
        values: Vec::new(),
    };
    write_document(&directory.join(STORE_FILE), &record)
}

/// Digest of the results of the newest run and of the tables that are joined with them.
fn origin(directory: &Path) -> String {
    let run = latest_run(&directory.join(STORE_FILE)).ok().flatten();
    let keys = run.map(|run| run.keys).unwrap_or_default();
    let tables = JOINED.map(|name| digest_file(&directory.join(name)).unwrap_or_default());
    digest_text(&format!("{keys:?} {tables:?}"))
}
