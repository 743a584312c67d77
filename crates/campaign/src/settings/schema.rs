//! What campaign.toml of single impacts may say, for editors.

use crate::settings::conditioning::RATES;
use crate::settings::contact::{BASELINES, CONTACTS, COUNT_TIMES};
use crate::settings::file::CampaignFile;
use crate::settings::fit::{ENDS, INTERVALS, NOISES, TREATMENTS, WEIGHTS};
use crate::settings::rig::KINDS;
use windfall_files::text::file_schema::{FileSchema, file_schema};

/// Of impacts on a pendulum or a carriage.
pub fn impacts_schema() -> FileSchema {
    file_schema::<CampaignFile>("campaign.toml of windfall: single impacts")
        .words(("RigFile", "kind"), &KINDS)
        .words(("ContactFile", "baseline"), &BASELINES)
        .words(("ContactFile", "contact"), &CONTACTS)
        .words(("ContactFile", "rate"), &RATES)
        .words(("EncoderFile", "times"), &COUNT_TIMES)
        .words(("FitFile", "weights"), &WEIGHTS)
        .words(("FitFile", "noise"), &NOISES)
        .words(("FitFile", "intervals"), &INTERVALS)
        .words(("FitFile", "onset"), &TREATMENTS)
        .words(("FitFile", "displacement_offset"), &TREATMENTS)
        .words(("FitFile", "end"), &ENDS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_has_its_key() {
        assert_eq!(impacts_schema().missing(), &[] as &[String]);
    }
}
