//! Undoing changes that the page made to a campaign's files, and doing them again.
//!
//! Before a change is written, undo.json of the campaign keeps the text that each file had.
//! A change is undone only while its files are as it left them: what was changed since, in the
//! page or with an editor, is never lost.

use crate::campaign_files::{CAMPAIGN_FILES, campaign_version};
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::Path;
use windfall_campaign::settings::kind::UNDO_FILE;
use windfall_files::error::Error;
use windfall_files::provenance::{digest_text, time_now};
use windfall_files::write_file::replace_file;

/// Most changes that are kept.
const MOST: usize = 100;
/// Most text that is kept of them; bytes.
const MOST_TEXT: usize = 4 << 20;

/// The changes of a campaign, oldest first.
#[derive(Debug, Default, Deserialize, Serialize)]
pub(crate) struct History {
    /// Those that can be undone.
    done: Vec<Step>,
    /// Those that were undone, and can be done again.
    undone: Vec<Step>,
}

/// A change, seen from behind it.
#[derive(Clone, Debug, Deserialize, Serialize)]
struct Step {
    /// What it did: "excluded apple-07".
    words: String,
    /// When; UTC.
    time: String,
    files: Vec<Kept>,
}

/// A file that a step changed.
#[derive(Clone, Debug, Deserialize, Serialize)]
struct Kept {
    /// Its name.
    file: String,
    /// Digest of what the step made of it.
    after: String,
    /// Its text before.
    before: String,
}

/// Which way through the changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, utoipa::ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Way {
    /// Undo the newest change.
    Undo,
    /// Do the change again that was undone last.
    Redo,
}

/// A change that can be undone or done again.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, utoipa::ToSchema)]
pub struct StepView {
    /// What it did: "excluded apple-07".
    pub words: String,
    /// When; UTC.
    pub time: String,
}

/// A file as it is, and as undoing a change would make it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, utoipa::ToSchema)]
pub struct FileBeside {
    /// Its name.
    pub file: String,
    /// Its text now.
    pub now: String,
    /// Its text if the change were undone.
    pub before: String,
}

impl History {
    /// That of a campaign, without changes that would change nothing; what cannot be read as one
    /// is none.
    pub(crate) fn read(directory: &Path) -> Self {
        let text = std::fs::read_to_string(directory.join(UNDO_FILE)).unwrap_or_default();
        let mut history: Self = serde_json::from_str(&text).unwrap_or_default();
        // A file that somebody else wrote leads nowhere but to the files of the campaign.
        let own = |step: &Step| {
            let mut files = step.files.iter();
            files.all(|kept| CAMPAIGN_FILES.contains(&kept.file.as_str()))
        };
        history.done.retain(own);
        history.undone.retain(own);
        // One that was kept by a program that was killed before it wrote anything.
        let never = |step: &mut Step| {
            let mut files = step.files.iter();
            files.all(|kept| text_of(directory, &kept.file).is_ok_and(|now| now == kept.before))
        };
        while history.done.pop_if(never).is_some() {}
        while history.undone.pop_if(never).is_some() {}
        history
    }

    /// The newest changes either way.
    pub(crate) fn views(&self) -> (Option<StepView>, Option<StepView>) {
        let view = |steps: &[Step]| {
            let step = steps.last()?;
            Some(StepView {
                words: step.words.clone(),
                time: step.time.clone(),
            })
        };
        (view(&self.done), view(&self.undone))
    }

    fn steps(&mut self, way: Way) -> &mut Vec<Step> {
        match way {
            Way::Undo => &mut self.done,
            Way::Redo => &mut self.undone,
        }
    }

    /// Takes out the newest change if a program was killed while it made it: the files that it
    /// wrote. They are undone together with the change that comes next.
    fn take_half_made(&mut self, directory: &Path) -> Result<Vec<Kept>, Error> {
        let Some(step) = self.done.last() else {
            return Ok(Vec::new());
        };
        let mut wrote = Vec::new();
        for kept in &step.files {
            let now = text_of(directory, &kept.file)?;
            if now == kept.before {
                continue;
            }
            if digest_text(&now) != kept.after {
                return Ok(Vec::new()); // changed since
            }
            wrote.push(kept.clone());
        }
        if wrote.len() == step.files.len() {
            return Ok(Vec::new());
        }
        self.done.pop();
        Ok(wrote)
    }

    /// Drops the oldest changes where there are too many.
    fn bound(&mut self) {
        for steps in [&mut self.done, &mut self.undone] {
            let mut room = MOST_TEXT;
            let newest = steps.iter().rev().take(MOST);
            let fit = newest.take_while(|step| {
                let texts = step.files.iter().map(|kept| kept.before.len());
                let left = room.checked_sub(texts.sum());
                room = left.unwrap_or(0);
                left.is_some()
            });
            let dropped = steps.len() - fit.count();
            steps.drain(..dropped);
        }
    }

    fn write(&mut self, directory: &Path) -> Result<(), Error> {
        self.bound();
        let path = directory.join(UNDO_FILE);
        let held = std::fs::read(&path);
        if held.is_ok_and(|held| serde_json::from_slice::<Self>(&held).is_err()) {
            return Ok(()); // somebody's file of that name: it stays, and nothing can be undone
        }
        let text = serde_json::to_string_pretty(self).map_err(|error| {
            Error::access(&path, "write", std::io::Error::other(error.to_string()))
        })?;
        replace_file(&path, |file| file.write_all(text.as_bytes()))
    }
}

/// Keeps what a change is about to replace; what was undone before cannot be done again.
///
/// * `words`: what the change does
/// * `files`: names and texts that it is about to write
///
/// # Errors
/// A file cannot be read, or undo.json not be written.
pub(crate) fn keep_before(
    directory: &Path,
    words: String,
    files: &[(&'static str, String)],
) -> Result<(), Error> {
    let mut history = History::read(directory);
    let mut kept = history.take_half_made(directory)?;
    for (name, after) in files {
        let after = digest_text(after);
        if let Some(half) = kept.iter_mut().find(|half| half.file == *name) {
            half.after = after;
            continue;
        }
        let before = text_of(directory, name)?;
        if after != digest_text(&before) {
            kept.push(Kept {
                file: (*name).to_owned(),
                after,
                before,
            });
        }
    }
    if kept.is_empty() {
        return Ok(()); // nothing changes
    }
    history.undone.clear();
    history.done.push(Step {
        words,
        time: time_now(),
        files: kept,
    });
    history.write(directory)
}

/// A step that is about to be made.
#[derive(Debug)]
pub(crate) struct Stepped {
    /// Names and texts that it writes.
    pub files: Vec<(&'static str, String)>,
    /// The history once they are written.
    history: History,
}

impl Stepped {
    /// Writes the history.
    ///
    /// # Errors
    /// undo.json cannot be written.
    pub(crate) fn write_history(mut self, directory: &Path) -> Result<(), Error> {
        self.history.write(directory)
    }
}

/// What going that way writes.
///
/// # Errors
/// [`Error::ChangeRefused`] where there is no such change; [`Error::ChangedSince`] where one of
/// its files is no longer what it made of it.
pub(crate) fn step(directory: &Path, way: Way) -> Result<Stepped, Error> {
    let mut history = History::read(directory);
    let Some(step) = history.steps(way).pop() else {
        return Err(Error::ChangeRefused {
            problem: match way {
                Way::Undo => "no change of this page is left to undo".to_owned(),
                Way::Redo => "no change was undone that could be done again".to_owned(),
            },
        });
    };
    let mut files = Vec::new();
    let mut back = Vec::new();
    for kept in step.files {
        let now = text_of(directory, &kept.file)?;
        if now == kept.before {
            continue; // the program was killed before it wrote this one
        }
        if digest_text(&now) != kept.after {
            return Err(Error::ChangedSince {
                file: kept.file,
                change: step.words,
            });
        }
        let own = CAMPAIGN_FILES.iter().find(|name| **name == kept.file);
        let Some(name) = own else { continue };
        back.push(Kept {
            after: digest_text(&kept.before),
            before: now,
            file: kept.file,
        });
        files.push((*name, kept.before));
    }
    let other = match way {
        Way::Undo => Way::Redo,
        Way::Redo => Way::Undo,
    };
    history.steps(other).push(Step {
        files: back,
        ..step
    });
    Ok(Stepped { files, history })
}

/// The files of the newest change as they are, and as undoing it would make them.
///
/// # Errors
/// One of them cannot be read.
pub fn beside(directory: &Path, way: Way) -> Result<Vec<FileBeside>, Error> {
    let mut history = History::read(directory);
    let step = history.steps(way).pop();
    let files = step.into_iter().flat_map(|step| step.files);
    let beside = files.map(|kept| {
        Ok(FileBeside {
            now: text_of(directory, &kept.file)?,
            file: kept.file,
            before: kept.before,
        })
    });
    beside.collect()
}

/// Whether the campaign is at a version.
///
/// # Errors
/// [`Error::ChangedMeanwhile`]; a file of the campaign cannot be read.
pub(crate) fn check_version(directory: &Path, version: &str) -> Result<(), Error> {
    if version != "*" && campaign_version(directory)? != version {
        return Err(Error::ChangedMeanwhile);
    }
    Ok(())
}

fn text_of(directory: &Path, name: &str) -> Result<String, Error> {
    let path = directory.join(name);
    std::fs::read_to_string(&path).map_err(|source| Error::access(&path, "read", source))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit_campaign::{Change, change_campaign, undo_change};
    use windfall_campaign::settings::kind::CAMPAIGN_FILE;
    use windfall_campaign::settings::template::{TemplateKind, write_template};

    const TABLE: &str = "id,specimen,file\na,f1,a.csv\nb,f1,b.csv\n";

    fn campaign(folder: &Path) -> std::path::PathBuf {
        let directory = folder.join("campaign");
        write_template(TemplateKind::Carriage, &directory).unwrap();
        std::fs::write(directory.join("impacts.csv"), TABLE).unwrap();
        std::fs::write(directory.join("specimens.csv"), "id,variety\nf1,gala\n").unwrap();
        directory
    }

    fn excluded(impact: &str) -> Change {
        Change::Exclusion {
            impact: impact.to_owned(),
            excluded: true,
            note: "slipped".to_owned(),
        }
    }

    #[test]
    fn changes_are_undone_from_the_newest_and_done_again() {
        let folder = tempfile::tempdir().unwrap();
        let directory = campaign(folder.path());
        let table = || std::fs::read_to_string(directory.join("impacts.csv")).unwrap();
        let first = change_campaign(&directory, "*", &excluded("a")).unwrap();
        assert_eq!(first.undo.unwrap().words, "excluded a");
        let one = table();
        change_campaign(&directory, "*", &Change::CampaignNote("wet".to_owned())).unwrap();
        let view = change_campaign(&directory, "*", &excluded("b")).unwrap();
        let all = table();
        assert_eq!(
            (view.undo.unwrap().words.as_str(), view.redo),
            ("excluded b", None)
        );

        let view = undo_change(&directory, "*", Way::Undo).unwrap();
        assert_eq!(table(), one);
        assert_eq!(view.note.as_deref(), Some("wet"));
        assert_eq!(view.redo.unwrap().words, "excluded b");
        let view = undo_change(&directory, &view.version, Way::Undo).unwrap();
        assert_eq!((view.note, table().as_str()), (None, one.as_str()));
        let view = undo_change(&directory, "*", Way::Undo).unwrap();
        assert_eq!((view.undo, table().as_str()), (None, TABLE));
        assert!(undo_change(&directory, "*", Way::Undo).is_err());

        for _ in 0..3 {
            undo_change(&directory, "*", Way::Redo).unwrap();
        }
        assert_eq!(table(), all);
        assert!(undo_change(&directory, "*", Way::Redo).is_err());
    }

    #[test]
    fn what_was_changed_since_is_not_undone() {
        let folder = tempfile::tempdir().unwrap();
        let directory = campaign(folder.path());
        change_campaign(&directory, "*", &excluded("a")).unwrap();
        let path = directory.join("impacts.csv");
        let by_hand = std::fs::read_to_string(&path).unwrap() + "c,f1,c.csv,,\n";
        std::fs::write(&path, &by_hand).unwrap();
        let refused = undo_change(&directory, "*", Way::Undo);
        assert!(
            matches!(refused, Err(Error::ChangedSince { .. })),
            "{refused:?}"
        );
        assert_eq!(std::fs::read_to_string(&path).unwrap(), by_hand);
        let files = beside(&directory, Way::Undo).unwrap();
        assert_eq!(files.len(), 1);
        assert_eq!(
            (files[0].now.as_str(), files[0].before.as_str()),
            (by_hand.as_str(), TABLE)
        );
        // Another version than the page has seen.
        let refused = undo_change(&directory, "0", Way::Undo);
        assert!(
            matches!(refused, Err(Error::ChangedMeanwhile)),
            "{refused:?}"
        );
        // As it was again, it can be undone.
        let own = by_hand.replace("c,f1,c.csv,,\n", "");
        std::fs::write(&path, own).unwrap();
        undo_change(&directory, "*", Way::Undo).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), TABLE);
    }

    #[test]
    fn a_change_that_was_kept_and_never_made_does_not_stand_in_the_way() {
        let folder = tempfile::tempdir().unwrap();
        let directory = campaign(folder.path());
        change_campaign(&directory, "*", &excluded("a")).unwrap();
        let killed = [("impacts.csv", "id,specimen,file\n".to_owned())];
        keep_before(&directory, "added a".to_owned(), &killed).unwrap();
        let (undo, redo) = History::read(&directory).views();
        assert_eq!((undo.unwrap().words.as_str(), redo), ("excluded a", None));
        // Made after all, it is one change, and no other comes of saving the same again.
        for _ in 0..2 {
            change_campaign(&directory, "*", &excluded("b")).unwrap();
        }
        for _ in 0..2 {
            undo_change(&directory, "*", Way::Undo).unwrap();
        }
        let table = std::fs::read_to_string(directory.join("impacts.csv")).unwrap();
        assert_eq!(table, TABLE);
        assert!(undo_change(&directory, "*", Way::Undo).is_err());
    }

    #[test]
    fn a_change_that_was_half_made_is_undone_whole() {
        let folder = tempfile::tempdir().unwrap();
        let directory = campaign(folder.path());
        let read = |name| std::fs::read_to_string(directory.join(name)).unwrap();
        let specimens = read("specimens.csv");
        let half = || {
            let both = [
                ("specimens.csv", format!("{specimens}f2,gala\n")),
                ("impacts.csv", format!("{TABLE}c,f2,c.csv\n")),
            ];
            keep_before(&directory, "added c".to_owned(), &both).unwrap();
            std::fs::write(directory.join("specimens.csv"), &both[0].1).unwrap();
        };
        half();
        undo_change(&directory, "*", Way::Undo).unwrap();
        assert_eq!(
            (read("specimens.csv"), read("impacts.csv").as_str()),
            (specimens.clone(), TABLE)
        );
        // A change after it takes what was written with it.
        half();
        change_campaign(&directory, "*", &excluded("a")).unwrap();
        undo_change(&directory, "*", Way::Undo).unwrap();
        assert_eq!(
            (read("specimens.csv"), read("impacts.csv").as_str()),
            (specimens.clone(), TABLE)
        );
        assert!(undo_change(&directory, "*", Way::Undo).is_err());
    }

    #[test]
    fn a_file_of_that_name_that_is_no_history_stays() {
        let folder = tempfile::tempdir().unwrap();
        let directory = campaign(folder.path());
        let path = directory.join(UNDO_FILE);
        for own in [&b"{\"steps\": 3}"[..], b"\xff\xfe", b""] {
            std::fs::write(&path, own).unwrap();
            let view = change_campaign(&directory, "*", &excluded("a")).unwrap();
            assert_eq!(view.undo, None);
            assert_eq!(std::fs::read(&path).unwrap(), own);
        }
    }

    #[test]
    fn what_is_kept_is_bounded_and_leads_nowhere_else() {
        let folder = tempfile::tempdir().unwrap();
        let directory = campaign(folder.path());
        let text = std::fs::read_to_string(directory.join(CAMPAIGN_FILE)).unwrap();
        let remark = "# remark\n".repeat(40_000);
        for turn in 0..(MOST_TEXT / remark.len() + 3) {
            let next = format!("{text}{remark}# {turn}\n");
            change_campaign(&directory, "*", &Change::Text(next)).unwrap();
        }
        let size = directory.join(UNDO_FILE).metadata().unwrap().len();
        assert!(size < 2 * MOST_TEXT as u64, "{size}");
        let step = Step {
            words: String::new(),
            time: String::new(),
            files: vec![Kept {
                file: "../elsewhere.csv".to_owned(),
                after: String::new(),
                before: String::new(),
            }],
        };
        let history = History {
            done: vec![step],
            undone: Vec::new(),
        };
        let text = serde_json::to_string(&history).unwrap();
        std::fs::write(directory.join(UNDO_FILE), text).unwrap();
        assert_eq!(History::read(&directory).views(), (None, None));
        std::fs::write(directory.join(UNDO_FILE), "no JSON").unwrap();
        assert_eq!(History::read(&directory).views(), (None, None));
    }
}
