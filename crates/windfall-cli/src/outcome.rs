//! What each command answers as JSON, and what that is called.

use serde::Serialize;
use windfall_campaign::impacts::shard::ShardOutcome;
use windfall_cards::geometry::RadiusOutcome;
use windfall_cards::law_card::LawCard;
use windfall_cards::library::laws::LawCardText;
use windfall_cards::library::show::LibraryOutcome;
use windfall_cards::transfer::TransferOutcome;
use windfall_drop::calibrate::outcome::CalibrateOutcome;
use windfall_drop::intervals::outcome::BouncesOutcome;
use windfall_engines::contacts::ContactsOutcome;
use windfall_engines::run::DeckOutcome;
use windfall_inspect::gather::add::Added;
use windfall_inspect::gather::new::Gathered;
use windfall_inspect::gather::preset::Preset;
use windfall_inspect::run::Inspection;
use windfall_measure::any_outcome::AnyOutcome;
use windfall_plan::achieved::outcome::AchievedOutcome;
use windfall_plan::outcome::PlanOutcome;
use windfall_population::outcome::PopulationOutcome;
use windfall_population::ranking::outcome::LawsOutcome;
use windfall_report::explain::Explanation;
use windfall_report::run::ReportOutcome;
use windfall_scene_run::bruise::volumes::BruiseVolumes;
use windfall_scene_run::frames::table::TableOutcome;
use windfall_scene_run::frames::view::{PictureOutcome, VtkOutcome};
use windfall_scene_run::run::outcome::SceneOutcome;
use windfall_scene_run::study::outcome::StudyOutcome;
use windfall_simulate::drop::SimulatedDrop;
use windfall_simulate::eccentric::SimulatedEccentricDrop;
use windfall_simulate::impact::SimulatedImpact;
use windfall_tables::compare::agreement::AgreementOutcome;
use windfall_tables::compare::outcome::CompareOutcome;
use windfall_tables::compare::summary::SummaryOutcome;
use windfall_tables::design::document::DesignDocument;
use windfall_tables::regress::run::AnyRegressOutcome;
use windfall_tables::surface::outcome::SurfaceOutcome;

/// A result that a command shows: an object as JSON, with all numbers SI.
pub trait Outcome: Serialize {
    /// What its JSON is called, with the version of its shape. A key that is added leaves the
    /// version as it is; one that changes its name or meaning, or goes, does not.
    const SCHEMA: &'static str;

    /// Indented JSON of its own keys.
    ///
    /// # Errors
    /// It cannot be written as JSON.
    fn json(&self) -> serde_json::Result<String> {
        serde_json::to_string_pretty(self)
    }
}

/// Recordings that a simulation wrote.
#[derive(Debug, Serialize)]
pub struct WrittenRecordings {
    /// The campaign.
    pub directory: String,
    /// How many recordings.
    pub recordings: usize,
    /// That they were not measured.
    pub simulated: bool,
}

/// Files of a template, or manual pages.
#[derive(Debug, Serialize)]
pub struct WrittenFiles {
    /// Their paths.
    pub written: Vec<String>,
}

/// Inspected recordings.
#[derive(Debug, Serialize)]
pub struct Inspections {
    /// One for each.
    pub files: Vec<Inspection>,
}

/// Presets of programs that write recordings.
#[derive(Debug, Serialize)]
pub struct Presets {
    /// One for each program.
    pub presets: Vec<Preset>,
}

/// Force laws.
#[derive(Debug, Serialize)]
pub struct Laws {
    /// One for each.
    pub laws: Vec<LawCardText>,
}

/// What findings mean.
#[derive(Debug, Serialize)]
pub struct Explanations {
    /// One for each finding.
    pub findings: Vec<Explanation>,
}

/// Parts of the program.
#[derive(Debug, Serialize)]
pub struct Licences {
    /// Crates, packages of the page, fonts.
    pub parts: Vec<Part>,
    /// The texts of their licences, where they were asked for.
    pub texts: Option<Vec<LicenceText>>,
}

/// A part of the program.
#[derive(Debug, Serialize)]
pub struct Part {
    /// What it is called.
    pub name: &'static str,
    /// Its version.
    pub version: &'static str,
    /// Its licence, as an SPDX expression.
    pub licence: &'static str,
    /// What it is: a crate, a package of the page, a font.
    pub kind: &'static str,
    /// The one system whose build holds it; empty for all.
    pub only: &'static str,
}

/// The text of a licence.
#[derive(Debug, Serialize)]
pub struct LicenceText {
    /// The parts that it belongs to.
    pub parts: &'static str,
    /// The text.
    pub text: &'static str,
}

/// A motion, with the samples of all its quantities.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub struct Motion(pub serde_json::Value);

/// Says what the JSON of each result is called.
macro_rules! outcomes {
    ($($schema:literal: $outcome:ty,)*) => {
        $(impl Outcome for $outcome {
            const SCHEMA: &'static str = $schema;
        })*
    };
}

outcomes! {
    "add/1": Added,
    "bounces/1": BouncesOutcome,
    "bruise/1": BruiseVolumes,
    "calibrate/1": CalibrateOutcome,
    "card/1": LawCard,
    "card-laws/1": Laws,
    "card-library/1": LibraryOutcome,
    "card-transfer/1": TransferOutcome,
    "compare/1": CompareOutcome,
    "compare-agreement/1": AgreementOutcome,
    "design/1": DesignDocument,
    "explain/2": Explanations,
    "fit-shard/1": ShardOutcome,
    "inspect/1": Inspections,
    "inspect-presets/2": Presets,
    "laws/1": LawsOutcome,
    "licences/1": Licences,
    "written/1": WrittenFiles,
    "new-from/1": Gathered,
    "plan/1": PlanOutcome,
    "plan-achieved/1": AchievedOutcome,
    "population/1": PopulationOutcome,
    "radius/1": RadiusOutcome,
    "regress/1": AnyRegressOutcome,
    "report/1": ReportOutcome,
    "scene-contacts/1": ContactsOutcome,
    "scene-deck/1": DeckOutcome,
    "scene-picture/1": PictureOutcome,
    "scene-run/1": SceneOutcome,
    "scene-study/1": StudyOutcome,
    "scene-table/1": TableOutcome,
    "scene-vtk/1": VtkOutcome,
    "simulate-drop/1": SimulatedDrop,
    "simulate-eccentric-drop/1": SimulatedEccentricDrop,
    "simulate-impact/1": SimulatedImpact,
    "simulate-motion/1": Motion,
    "simulate-recordings/1": WrittenRecordings,
    "summary/1": SummaryOutcome,
    "surface/1": SurfaceOutcome,
}

impl Outcome for AnyOutcome {
    const SCHEMA: &'static str = "fit/1";

    // Compiled where all of its parts are.
    fn json(&self) -> serde_json::Result<String> {
        Self::json(self)
    }
}
