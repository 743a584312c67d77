//! A campaign directory that a simulation fills.

use std::path::{Path, PathBuf};
use windfall_campaign::settings::template::create_directory;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::write_file::write_new;

/// A new campaign directory, with `raw` in it.
pub(crate) struct NewCampaign {
    directory: PathBuf,
    /// Files so far.
    pub written: Vec<PathBuf>,
}

impl NewCampaign {
    /// Makes the directories.
    pub fn create(directory: &Path) -> Result<Self, Error> {
        create_directory(directory)?;
        create_directory(&directory.join("raw"))?;
        Ok(Self {
            directory: directory.to_path_buf(),
            written: Vec::new(),
        })
    }

    /// Writes a file; recordings are "raw/NAME".
    pub fn file(&mut self, name: &str, contents: impl AsRef<[u8]>) -> Result<(), Error> {
        let path = self.directory.join(name);
        write_new(&path, contents.as_ref())?;
        self.written.push(path);
        Ok(())
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
