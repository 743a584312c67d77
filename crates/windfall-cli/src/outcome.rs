//! What each command answers as JSON, and what that is called.

use serde::Serialize;
use utoipa::ToSchema;
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
use windfall_files::text::result_schema::{ResultSchema, result_schema};
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
use windfall_simulate::motion::MotionOutcome;
use windfall_tables::compare::agreement::AgreementOutcome;
use windfall_tables::compare::outcome::CompareOutcome;
use windfall_tables::compare::summary::SummaryOutcome;
use windfall_tables::design::document::DesignDocument;
use windfall_tables::regress::run::AnyRegressOutcome;
use windfall_tables::surface::outcome::SurfaceOutcome;

/// A result that a command shows: an object as JSON, with all numbers SI.
pub trait Outcome: Serialize + ToSchema {
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
#[derive(Debug, Serialize, ToSchema)]
pub struct WrittenRecordings {
    /// The campaign.
    pub directory: String,
    /// How many recordings.
    pub recordings: usize,
    /// That they were not measured.
    pub simulated: bool,
}

/// Files of a template, or manual pages.
#[derive(Debug, Serialize, ToSchema)]
pub struct WrittenFiles {
    /// Their paths.
    pub written: Vec<String>,
}

/// Inspected recordings.
#[derive(Debug, Serialize, ToSchema)]
pub struct Inspections {
    /// One for each.
    pub files: Vec<Inspection>,
}

/// Presets of programs that write recordings.
#[derive(Debug, Serialize, ToSchema)]
pub struct Presets {
    /// One for each program.
    pub presets: Vec<Preset>,
}

/// Force laws.
#[derive(Debug, Serialize, ToSchema)]
pub struct Laws {
    /// One for each.
    pub laws: Vec<LawCardText>,
}

/// What findings mean.
#[derive(Debug, Serialize, ToSchema)]
pub struct Explanations {
    /// One for each finding.
    pub findings: Vec<Explanation>,
}

/// Parts of the program.
#[derive(Debug, Serialize, ToSchema)]
pub struct Licences {
    /// Crates, packages of the page, fonts.
    pub parts: Vec<Part>,
    /// The texts of their licences, where they were asked for.
    pub texts: Option<Vec<LicenceText>>,
}

/// A part of the program.
#[derive(Debug, Serialize, ToSchema)]
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
#[derive(Debug, Serialize, ToSchema)]
pub struct LicenceText {
    /// The parts that it belongs to.
    pub parts: &'static str,
    /// The text.
    pub text: &'static str,
}

/// A kind of result.
#[derive(Clone, Copy, Debug)]
pub struct ResultKind {
    /// What its JSON is called, with the version of its shape.
    pub schema: &'static str,
    /// What it is, for people.
    pub title: &'static str,
    /// Its keys.
    pub described: fn() -> ResultSchema,
}

impl ResultKind {
    /// What it is called, without the version.
    pub fn name(&self) -> &'static str {
        self.schema.split_once('/').map_or(self.schema, |own| own.0)
    }
}

/// Says what the JSON of each result is called, and which command answers it.
macro_rules! outcomes {
    ($($schema:literal: $outcome:ty = $command:literal $({ $($own:item)* })?,)*) => {
        $(impl Outcome for $outcome {
            const SCHEMA: &'static str = $schema;
            $($($own)*)?
        })*

        /// All results.
        pub const RESULTS: &[ResultKind] = &[
            $(ResultKind {
                schema: $schema,
                title: concat!("JSON of windfall ", $command),
                described: || {
                    let title = concat!("JSON of windfall ", $command);
                    result_schema::<$outcome>($schema, title)
                },
            },)*
        ];
    };
}

outcomes! {
    "add/1": Added = "add",
    "bounces/1": BouncesOutcome = "bounces",
    "bruise/1": BruiseVolumes = "bruise",
    "calibrate/1": CalibrateOutcome = "calibrate",
    "card/1": LawCard = "card show --file",
    "card-laws/1": Laws = "card show --laws",
    "card-library/1": LibraryOutcome = "card show --library",
    "card-transfer/1": TransferOutcome = "card transfer",
    "compare/1": CompareOutcome = "compare",
    "compare-agreement/1": AgreementOutcome = "compare --measured",
    "design/1": DesignDocument = "design",
    "explain/2": Explanations = "explain",
    "fit/1": AnyOutcome = "fit" {
        // Compiled where all of its parts are.
        fn json(&self) -> serde_json::Result<String> {
            Self::json(self)
        }
    },
    "fit-shard/1": ShardOutcome = "fit --shard",
    "inspect/1": Inspections = "inspect",
    "inspect-presets/2": Presets = "inspect --presets",
    "laws/1": LawsOutcome = "laws",
    "licences/1": Licences = "licences",
    "written/1": WrittenFiles = "new and man: files that were written",
    "new-from/1": Gathered = "new --from",
    "plan/1": PlanOutcome = "plan",
    "plan-achieved/1": AchievedOutcome = "plan achieved",
    "population/1": PopulationOutcome = "population",
    "radius/1": RadiusOutcome = "radius",
    "regress/1": AnyRegressOutcome = "regress",
    "report/1": ReportOutcome = "report",
    "scene-contacts/1": ContactsOutcome = "scene export: contacts",
    "scene-deck/1": DeckOutcome = "scene export: a deck",
    "scene-picture/1": PictureOutcome = "scene picture",
    "scene-run/1": SceneOutcome = "scene run",
    "scene-study/1": StudyOutcome = "scene study",
    "scene-table/1": TableOutcome = "scene table",
    "scene-vtk/1": VtkOutcome = "scene vtk",
    "simulate-drop/1": SimulatedDrop = "simulate drop",
    "simulate-eccentric-drop/1": SimulatedEccentricDrop = "simulate drop --offset or --semi-axes",
    "simulate-impact/1": SimulatedImpact = "simulate impact",
    "simulate-motion/1": MotionOutcome = "simulate: a motion",
    "simulate-recordings/1": WrittenRecordings = "simulate: a campaign of recordings",
    "summary/1": SummaryOutcome = "summary",
    "surface/1": SurfaceOutcome = "surface",
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use serde_json::Value;

    /// Targets of all references below a value.
    fn references(value: &Value) -> Vec<&str> {
        match value {
            Value::Object(own) => own
                .iter()
                .flat_map(|(key, part)| match part {
                    Value::String(target) if key == "$ref" => vec![&target[..]],
                    _ => references(part),
                })
                .collect(),
            Value::Array(own) => own.iter().flat_map(references).collect(),
            _ => Vec::new(),
        }
    }

    #[test]
    fn schemas_say_what_they_refer_to() {
        let mut total = 0;
        for kind in RESULTS {
            let schema = (kind.described)();
            assert_eq!(schema.clashes(), &[] as &[String], "{}", kind.schema);
            let schema: Value = serde_json::from_str(&schema.text().unwrap()).unwrap();
            for target in references(&schema) {
                let place = target.strip_prefix('#').unwrap();
                assert!(schema.pointer(place).is_some(), "{}: {target}", kind.schema);
                total += 1;
            }
        }
        assert!(total > 100, "{total} references");
    }

    #[test]
    fn results_have_names_of_their_own() {
        let mut names: Vec<&str> = RESULTS.iter().map(ResultKind::name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), RESULTS.len());
    }
}
