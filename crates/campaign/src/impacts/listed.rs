//! Impacts that a list names.

use crate::recording::read::recording_path;
use crate::settings::model::Campaign;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::known_names::known_names;
use windfall_files::option_value::unusable;
use windfall_files::text::toml_source::read_piped_source;

/// Characters of a line that are shown.
const LONGEST: usize = 80;

/// Which impacts of a campaign a list names, in the order of impacts.csv.
///
/// * `list`: a file or a stream with an id, or a recording, in each line: as impacts.csv names
///   it, or a path from the working directory, of which all impacts are meant
///
/// # Errors
/// The list cannot be read or is empty; a line names no impact of the campaign.
pub fn listed(list: &Path, campaign: &Campaign) -> Result<Vec<bool>, Error> {
    let text = read_piped_source(list, "write the ids of impacts into it, one in each line")?.text;
    let named = Places::of(campaign);
    let mut wanted = vec![false; campaign.entries.len()];
    for (line, name) in text.lines().enumerate() {
        let name = name.trim();
        if name.is_empty() {
            continue;
        }
        let places = named.find(name);
        if places.is_empty() {
            let ids = campaign.entries.iter().map(|entry| entry.id.as_str());
            let known = known_names(name, ids);
            // A line of something else may be long.
            let name: String = name.chars().take(LONGEST).collect();
            let problem = format!(
                "line {}: no impact has the id or recording \"{name}\"{known}",
                line + 1
            );
            return Err(unusable(format!("--only {}", list.display()), problem));
        }
        places.into_iter().for_each(|place| wanted[place] = true);
    }
    match wanted.contains(&true) {
        true => Ok(wanted),
        false => Err(unusable(
            format!("--only {}", list.display()),
            "names no impact; write an id or a recording into each line",
        )),
    }
}

/// Places of impacts by what may stand for them.
struct Places<'a> {
    ids: HashMap<&'a str, usize>,
    recordings: HashMap<&'a str, Vec<usize>>,
    paths: HashMap<PathBuf, Vec<usize>>,
}

impl<'a> Places<'a> {
    fn of(campaign: &'a Campaign) -> Self {
        let mut own = Self {
            ids: HashMap::new(),
            recordings: HashMap::new(),
            paths: HashMap::new(),
        };
        for (place, entry) in campaign.entries.iter().enumerate() {
            own.ids.insert(&entry.id, place);
            own.recordings.entry(&entry.file).or_default().push(place);
            let path = real(&recording_path(&campaign.files, entry));
            own.paths.entry(path).or_default().push(place);
        }
        own
    }

    fn find(&self, name: &str) -> Vec<usize> {
        if let Some(place) = self.ids.get(name) {
            return vec![*place];
        }
        let own = self.recordings.get(name);
        let own = own.or_else(|| self.paths.get(&real(Path::new(name))));
        own.cloned().unwrap_or_default()
    }
}

fn real(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_path_buf())
}
