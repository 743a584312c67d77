//! What a campaign measures: the word after `kind` in `[rig]`.

use serde::Deserialize;
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{choice, parse_source, read_source};

/// Name of the campaign file.
pub const CAMPAIGN_FILE: &str = "campaign.toml";

/// Name of the store in a campaign directory.
pub const STORE_FILE: &str = "results.sqlite";

/// Name of the file in a campaign directory that keeps what changes of the page replaced.
pub const UNDO_FILE: &str = "undo.json";

/// What a campaign measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CampaignKind {
    /// Single impacts, on a pendulum or a carriage; also where no kind is given, so that the
    /// reader can say what is missing.
    Impacts,
    /// Slow compressions in a testing machine.
    Compression,
    /// Force while a fruit is held at a deformation.
    Relaxation,
    /// Taps, for acoustic firmness.
    Acoustic,
    /// Impacts repeated on one spot, for the critical impact energy.
    Repeats,
    /// Fruit that fall on a plate and bounce.
    Drop,
}

impl CampaignKind {
    /// The word in `[rig] kind`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Impacts => "impacts",
            Self::Compression => "compression",
            Self::Relaxation => "relaxation",
            Self::Acoustic => "acoustic",
            Self::Repeats => "repeats",
            Self::Drop => "drop",
        }
    }
}

/// Just enough of campaign.toml to tell its kind.
#[derive(Deserialize)]
struct KindFile {
    rig: Option<RigKindFile>,
}

#[derive(Deserialize)]
struct RigKindFile {
    kind: Option<Spanned<String>>,
}

/// Words of `[rig] kind`.
pub const KINDS: [(&str, CampaignKind); 7] = [
    ("pendulum", CampaignKind::Impacts),
    ("carriage", CampaignKind::Impacts),
    ("drop", CampaignKind::Drop),
    ("compression", CampaignKind::Compression),
    ("relaxation", CampaignKind::Relaxation),
    ("acoustic", CampaignKind::Acoustic),
    ("repeats", CampaignKind::Repeats),
];

/// What the campaign in a directory measures.
///
/// # Errors
/// There is no campaign.toml, it is no TOML, or its kind is not known.
pub fn campaign_kind(directory: &Path) -> Result<CampaignKind, Error> {
    let advice = "a campaign directory holds a campaign.toml; \
                  `windfall new pendulum DIR` writes a template (`windfall new --help` lists the kinds)";
    let source = read_source(&directory.join(CAMPAIGN_FILE), advice)?;
    let file: KindFile = parse_source(&source)?;
    let kind = file.rig.and_then(|rig| rig.kind);
    let known = choice(&source, kind.as_ref(), ("[rig]", "kind"), &KINDS)?;
    Ok(known.unwrap_or(CampaignKind::Impacts))
}
