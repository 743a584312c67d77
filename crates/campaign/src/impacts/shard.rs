//! A part of a campaign, fitted by itself: results go into a file as they come, and nowhere else.

use crate::impacts::bench::find_rig;
use crate::impacts::fit::Fits;
use crate::impacts::key::run_options;
use crate::impacts::listed::listed;
use crate::impacts::mass::RigFound;
use crate::impacts::table::ImpactTable;
use crate::pipeline::evaluate::Evaluation;
use crate::pipeline::request::{FitRequest, apply_request};
use crate::result::counted::mark_alone;
use crate::settings::kind::{CAMPAIGN_FILE, CampaignKind, campaign_kind};
use crate::settings::model::{Campaign, ImpactCampaign};
use crate::settings::read::read_campaign;
use serde::Serialize;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use windfall_files::error::Error;
use windfall_files::found::FailureOutcome;
use windfall_files::on_threads::on_threads;
use windfall_files::option_value::unusable;
use windfall_files::progress::{Progress, for_each};
use windfall_files::provenance::{REVISION, VERSION, digest_text};
use windfall_files::sheet::form::Form;
use windfall_files::sheet::write::{TableWriter, write_table};

/// Recordings that are fitted before their results are written.
const AT_ONCE: usize = 512;

/// A part of the rows of impacts.csv, "3/64": rows that follow each other, so that those of one
/// fruit mostly stay together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which part, from 1.
    number: usize,
    /// Parts in all.
    of: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let told = || format!("\"{text}\": expected a part and the number of parts, such as 3/64");
        let (number, of) = text.split_once('/').ok_or_else(told)?;
        let number = number.trim().parse().map_err(|_| told())?;
        let of = of.trim().parse().map_err(|_| told())?;
        match (1..=of).contains(&number) {
            true => Ok(Self { number, of }),
            false => Err(format!("\"{text}\": parts are counted from 1 to {of}")),
        }
    }
}

impl Shard {
    /// Its rows, of so many.
    fn rows(self, all: usize) -> Range<usize> {
        let end = |parts: usize| (all as u128 * parts as u128 / self.of as u128) as usize;
        end(self.number - 1)..end(self.number)
    }
}

/// Which impacts of a campaign are fitted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// Those of one of so many parts.
    Shard(Shard),
    /// Those that a list names: a file, or "-" for standard input.
    List(PathBuf),
}

impl Part {
    /// Leaves out the other impacts.
    fn keep(&self, campaign: &mut Campaign) -> Result<(), Error> {
        match self {
            Self::Shard(shard) => {
                let rows = shard.rows(campaign.entries.len());
                campaign.entries.truncate(rows.end);
                campaign.entries.drain(..rows.start);
            }
            Self::List(list) => {
                let mut wanted = listed(list, campaign)?.into_iter();
                campaign.entries.retain(|_| wanted.next() == Some(true));
            }
        }
        Ok(())
    }

    /// The option that says so.
    fn option(&self) -> &'static str {
        match self {
            Self::Shard(_) => "--shard",
            Self::List(_) => "--only",
        }
    }
}

/// What came of a part.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ShardOutcome {
    /// Version of windfall.
    pub windfall: String,
    /// Title of the campaign.
    pub campaign: String,
    /// Impacts in the part.
    pub impacts: usize,
    /// Rows written: one for each impact and law.
    pub rows: usize,
    /// What could not be fitted.
    pub failed: Vec<FailureOutcome>,
    /// The file.
    #[schema(value_type = String)]
    pub file: PathBuf,
}

/// Fits a part of a campaign. The memory that it takes does not grow with the results, the
/// store of the campaign is neither read nor written, and rows are those of a fit of the whole
/// campaign, but for what can only be seen beside other impacts.
///
/// * `out`: the ending of its name says the form
///
/// # Errors
/// The campaign or the request is wrong; no impact of the part could be fitted.
pub fn fit_part(
    directory: &Path,
    request: &FitRequest,
    part: &Part,
    out: &Path,
    progress: Progress,
) -> Result<ShardOutcome, Error> {
    if campaign_kind(directory)? != CampaignKind::Impacts {
        let problem = "only campaigns of single impacts are fitted in parts";
        return Err(unusable(part.option(), problem));
    }
    let mut campaign = read_campaign(directory)?;
    apply_request(&mut campaign, request)?;
    let form = Form::of_path("--out", out)?;
    request.check_outputs()?;
    on_threads(request.threads, || {
        // The bench is estimated from all impacts.
        let rig = find_rig(&mut campaign)?;
        part.keep(&mut campaign.shared)?;
        let table = table_of(&campaign, &rig)?;
        let mut found = ShardOutcome {
            windfall: VERSION.to_owned(),
            campaign: campaign.shared.title.clone(),
            impacts: campaign.shared.entries.len(),
            rows: 0,
            failed: Vec::new(),
            file: out.to_path_buf(),
        };
        write_table(out, form, &table.schema, |writer| {
            fit_into((&campaign, &rig), (&table, writer), &mut found, progress)?;
            // There may be more parts than impacts.
            match found.rows == 0 && found.impacts > 0 {
                true => Err(Error::NothingFitted {
                    path: directory.to_path_buf(),
                    failures: found.failed.clone(),
                }),
                false => Ok(()),
            }
        })?;
        Ok(found)
    })
}

/// The table of a part: with a digest of what all parts must have in common, definitions of the
/// user's laws and the rig as it was estimated among it.
fn table_of<'a>(campaign: &'a ImpactCampaign, rig: &RigFound) -> Result<ImpactTable<'a>, Error> {
    let path = campaign.shared.directory.join(CAMPAIGN_FILE);
    let told = std::fs::read_to_string(&path);
    let told = told.map_err(|source| Error::access(&path, "read", source))?;
    let options = serde_json::Value::from(run_options(campaign));
    let mut table = ImpactTable::of_campaign(campaign);
    let (laws, rig) = (&campaign.fit.laws, &rig.rig);
    let options = format!("{REVISION}\n{options}\n{laws:?}\n{rig:?}\n{told}");
    let options = digest_text(&options);
    table.schema.notes.push(("options".to_owned(), options));
    Ok(table)
}

fn fit_into(
    (campaign, rig): (&ImpactCampaign, &RigFound),
    (table, writer): (&ImpactTable, &mut TableWriter),
    found: &mut ShardOutcome,
    progress: Progress,
) -> Result<(), Error> {
    let fits = Fits::new(campaign, rig);
    let entries = &campaign.shared.entries;
    for first in (0..entries.len()).step_by(AT_ONCE) {
        let some = &entries[first..entries.len().min(first + AT_ONCE)];
        let told = |done: usize, _: usize| progress(first + done, entries.len());
        let results = for_each(&told, some.len(), |at| {
            let mut results = fits.evaluate(&some[at], vec![None; fits.parts()]);
            for impact in results.iter_mut().flatten() {
                mark_alone(Some(&some[at]), &rig.rig, impact);
            }
            results
        })?;
        for result in results.into_iter().flatten() {
            match result {
                Ok(impact) => {
                    writer.push(&table.row(&impact))?;
                    found.rows += 1;
                }
                Err(failure) if found.failed.last() == Some(&*failure) => {}
                Err(failure) => found.failed.push(*failure),
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_parts_are_all_rows_once() {
        for (all, of) in [(0, 3), (1, 3), (7, 3), (64, 64), (1_000_003, 64)] {
            let mut next = 0;
            for number in 1..=of {
                let shard: Shard = format!("{number}/{of}").parse().unwrap();
                let rows = shard.rows(all);
                assert_eq!(rows.start, next);
                assert!(rows.len() <= all / of + 1);
                next = rows.end;
            }
            assert_eq!(next, all);
        }
        for text in ["3", "0/4", "5/4", "1/0", "a/4", "-1/4", "1/4/2", ""] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
