//! A campaign directory that a simulation fills.

use std::path::{Path, PathBuf};
use windfall_campaign::settings::kind::CAMPAIGN_FILE;
use windfall_files::error::Error;
use windfall_files::scratch::NewDirectory;
use windfall_files::table::write::csv_text;

/// A new campaign directory; it is there when all of it is.
pub(crate) struct NewCampaign {
    directory: NewDirectory,
    written: Vec<PathBuf>,
}

impl NewCampaign {
    /// Makes room for it.
    pub fn create(directory: &Path) -> Result<Self, Error> {
        Ok(Self {
            directory: NewDirectory::begin(directory)?,
            written: Vec::new(),
        })
    }

    /// Writes a file; recordings are "raw/NAME".
    pub fn file(&mut self, name: &str, contents: impl AsRef<[u8]>) -> Result<(), Error> {
        let path = self.directory.write(name, contents.as_ref())?;
        self.written.push(path);
        Ok(())
    }

    /// Gives the directory its name; the files in it.
    pub fn end(self) -> Result<Vec<PathBuf>, Error> {
        self.directory.end(CAMPAIGN_FILE)?;
        Ok(self.written)
    }

    /// Writes a table.
    pub fn table(
        &mut self,
        name: &str,
        header: &[&str],
        rows: Vec<Vec<String>>,
    ) -> Result<(), Error> {
        let header: Vec<String> = header.iter().map(|name| (*name).to_owned()).collect();
        self.file(name, csv_text(&header, rows)?)
    }
}
