//! The contacts of a scene in the terms of engines that windfall does not run.

use crate::parameters::{ContactTerms, Other, contact_terms, text_of_terms};
use serde::Serialize;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::write_file::write_whole;
use windfall_scene_run::file::read::read_scene;
use windfall_scene_run::file_error::make_directory;

/// Contacts that were written.
#[derive(Clone, Debug, Serialize)]
pub struct ContactsOutcome {
    /// The engine.
    pub engine: String,
    /// The file.
    pub file: PathBuf,
    /// Each pair of materials.
    pub contacts: Vec<ContactTerms>,
}

/// Writes the contacts of a scene in the terms of another engine.
///
/// * `out`: directory to write into; that of the file where it is left out
/// * `speed`: impact speed at which damping that is not the law's takes the same energy; m/s
///
/// # Errors
/// The scene cannot be used; the file cannot be written.
pub fn export_contacts(
    path: &Path,
    other: Other,
    out: Option<&Path>,
    speed: f64,
) -> Result<ContactsOutcome, Error> {
    let plan = read_scene(path)?;
    let contacts = contact_terms(other, &plan.scene, speed);
    let (name, _) = other.file();
    let file = match out {
        Some(out) => {
            make_directory(out)?;
            out.join(name)
        }
        None => path.with_file_name(name),
    };
    let text = text_of_terms(other, &plan.title, &contacts);
    write_whole(&file, text.as_bytes())?;
    Ok(ContactsOutcome {
        engine: other.title().to_owned(),
        file,
        contacts,
    })
}
