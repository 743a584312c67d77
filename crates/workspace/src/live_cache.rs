//! Recordings being viewed, cached in memory while there is room.

use crate::campaign_files::campaign_version;
use crate::live_fit::{LiveCampaign, LiveImpact};
use crate::recording_outline::{Outline, OutlinedChannel};
use crate::recording_stretches::{Glance, LONG};
use crate::workspace::recordings_inside;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use windfall_campaign::settings::model::FilePlan;
use windfall_files::cache;
use windfall_files::confined::path_inside;
use windfall_files::error::Error;
use windfall_inspect::run::inspect_opened;

/// Most bytes of recordings in memory; the newest stays in any case.
const ROOM: usize = 1 << 30;

/// What is kept under keys, the one used last in front.
struct Kept<T> {
    entries: Mutex<Vec<(String, Arc<T>, usize)>>,
}

impl<T> Default for Kept<T> {
    fn default() -> Self {
        Self {
            entries: Mutex::new(Vec::new()),
        }
    }
}

impl<T> Kept<T> {
    /// The value under a key, made if absent. Two concurrent callers may both make it.
    fn get(
        &self,
        key: &str,
        make: impl FnOnce() -> Result<T, Error>,
        bytes: impl Fn(&T) -> usize,
    ) -> Result<Arc<T>, Error> {
        let lock = || self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        {
            let mut entries = lock();
            if let Some(place) = entries.iter().position(|(known, ..)| known == key) {
                let found = entries.remove(place);
                let value = found.1.clone();
                entries.insert(0, found);
                return Ok(value);
            }
        }
        let value = Arc::new(make()?);
        let size = bytes(&value);
        let mut entries = lock();
        // A concurrent caller may have made it meanwhile.
        entries.retain(|(known, ..)| known != key);
        entries.insert(0, (key.to_owned(), value.clone(), size));
        let mut held = 0;
        entries.retain(|(_, _, size)| {
            let first = held == 0;
            held += size.max(&1);
            first || held <= ROOM
        });
        Ok(value)
    }
}

/// Recordings and campaigns in memory; what changes on disk is read again.
#[derive(Default)]
pub struct LiveCache {
    campaigns: Kept<LiveCampaign>,
    impacts: Kept<LiveImpact>,
    channels: Kept<OutlinedChannel>,
    glances: Kept<Glance>,
}

impl LiveCache {
    /// An impact of a campaign, ready for fits.
    ///
    /// # Errors
    /// As [`LiveCampaign::open`] and [`LiveCampaign::impact`].
    pub fn impact(&self, directory: &Path, id: &str) -> Result<Arc<LiveImpact>, Error> {
        let version = campaign_version(directory)?;
        let key = format!("{} {version}", directory.display());
        let make = || LiveCampaign::open(directory);
        // A campaign is small beside recordings; a few are kept.
        let campaign = self.campaigns.get(&key, make, |_| ROOM / 8)?;
        let stamp = stamp(&campaign.recording(id)?);
        let make = || campaign.impact(id);
        self.impacts
            .get(&format!("{key} {id} {stamp}"), make, LiveImpact::bytes)
    }

    /// What `inspect` says of a recording of a campaign, as JSON.
    ///
    /// # Errors
    /// The name is refused, or as [`inspect_opened`].
    pub fn inspection(&self, directory: &Path, file: &str) -> Result<String, Error> {
        let (path, plan) = recording_inside(directory, file)?;
        if let Some(glance) = self.glance(directory, file, &path, &plan)? {
            return Ok(glance.inspection.clone());
        }
        let mut found = inspect_opened(&path, &plan.open, &[])?;
        file.clone_into(&mut found.file);
        serde_json::to_string(&found)
            .map_err(|error| Error::access(&path, "read", std::io::Error::other(error.to_string())))
    }

    /// A part of a channel of a recording of a campaign, in about that many points.
    ///
    /// * `from`, `to`: times; the ends of the channel if `None`
    ///
    /// # Errors
    /// The name is refused, or as [`OutlinedChannel::read`].
    pub fn outline(
        &self,
        directory: &Path,
        (file, channel): (&str, &str),
        (from, to): (Option<f64>, Option<f64>),
        points: usize,
    ) -> Result<Outline, Error> {
        let (path, plan) = recording_inside(directory, file)?;
        if let Some(glance) = self.glance(directory, file, &path, &plan)?
            && let Some(outline) = glance.outline(channel, from, to, points)
        {
            return Ok(outline);
        }
        let (shown, stamp) = (path.display(), stamp(&path));
        let key = format!("{shown} {stamp} {channel} {:?}", plan.time);
        let make = || OutlinedChannel::read(&path, &plan, channel);
        let channel = self.channels.get(&key, make, OutlinedChannel::bytes)?;
        Ok(channel.outline(from, to, points))
    }

    /// A recording at a glance, where it is a long one.
    fn glance(
        &self,
        directory: &Path,
        file: &str,
        path: &Path,
        plan: &FilePlan,
    ) -> Result<Option<Arc<Glance>>, Error> {
        if std::fs::metadata(path).map_or(0, |own| own.len()) < LONG {
            return Ok(None);
        }
        let (shown, stamp) = (path.display(), stamp(path));
        let key = format!("{shown} {stamp} {:?} {:?}", plan.open, plan.time);
        let make = || Glance::of(directory, file, path, plan);
        self.glances.get(&key, make, Glance::bytes).map(Some)
    }
}

/// A recording of a campaign, and how its files are read.
///
/// # Errors
/// The name is refused, there is no such file, or the campaign cannot be read.
pub fn recording_inside(directory: &Path, file: &str) -> Result<(PathBuf, FilePlan), Error> {
    let plan = recordings_inside(directory)?;
    let path = path_inside(&plan.directory, file)?;
    match path.is_file() {
        true => Ok((path, plan)),
        false => Err(Error::FileAbsent {
            path,
            advice: "it may have been moved or renamed meanwhile".to_owned(),
        }),
    }
}

/// By what a file is seen to be the same.
fn stamp(path: &Path) -> String {
    cache::stamp(path).unwrap_or_else(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_used_stays_and_the_rest_makes_room() {
        let kept: Kept<usize> = Kept::default();
        let get = |key: &str, value: usize| *kept.get(key, || Ok(value), |_| ROOM / 2).unwrap();
        assert_eq!((get("a", 1), get("b", 2), get("a", 9)), (1, 2, 1));
        // There is room for two: the one that was not used since goes.
        assert_eq!((get("c", 3), get("a", 9), get("b", 7)), (3, 1, 7));
        assert!(kept.get("d", || Err(Error::Cancelled), |_| 1).is_err());
    }
}
