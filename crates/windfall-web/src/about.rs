//! What the page needs before it opens a campaign.

use crate::app::{Answer, App};
use axum::extract::State;
use serde::Serialize;
use utoipa::ToSchema;
use windfall_campaign::settings::template::TEMPLATES;
use windfall_cards::library::laws::{LawCardText, law_cards};
use windfall_files::provenance::VERSION;
use windfall_report::explain::{Explanation, all_explanations};

/// What the page needs before it opens a campaign.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct About {
    /// Version of windfall.
    version: &'static str,
    /// Name of the directory that is served.
    directory: String,
    /// Whether campaigns can be created here.
    creates: bool,
    /// Size limit of an upload; bytes.
    upload_limit: u64,
    /// Kinds of campaigns that can be created.
    kinds: [&'static str; 7],
    /// Force laws.
    laws: Vec<LawAbout>,
}

/// A force law.
#[derive(Debug, Serialize, ToSchema)]
struct LawAbout {
    name: &'static str,
    /// F = …
    formula: &'static str,
    parameters: Vec<ParameterAbout>,
    /// Shape at first touch, and source.
    notes: String,
}

/// A parameter of a force law.
#[derive(Debug, Serialize, ToSchema)]
struct ParameterAbout {
    name: &'static str,
    unit: &'static str,
    meaning: &'static str,
    default: Option<f64>,
    typical: f64,
}

/// Version, directory, limits and force laws.
#[utoipa::path(get, path = "/api/about", responses((status = 200, body = About)))]
pub(crate) async fn about(State(app): State<App>) -> Answer<About> {
    let laws = app.work(|_| law_cards(None, None)).await?;
    app.tell(&About {
        version: VERSION,
        directory: app.workspace.name(),
        creates: !app.workspace.is_campaign(),
        upload_limit: app.upload_limit,
        kinds: TEMPLATES.map(|(name, _)| name),
        laws: laws.iter().map(law_about).collect(),
    })
}

/// Every finding: what it means and what to do, as `windfall explain` says it.
#[utoipa::path(get, path = "/api/findings", responses((status = 200, body = Vec<Explanation>)))]
pub(crate) async fn findings(State(app): State<App>) -> Answer<Vec<Explanation>> {
    app.tell(&all_explanations())
}

fn law_about(LawCardText { law, .. }: &LawCardText) -> LawAbout {
    let parameters = law.parameters.iter().map(|parameter| ParameterAbout {
        name: parameter.name,
        unit: parameter.unit,
        meaning: parameter.meaning,
        default: parameter.default,
        typical: parameter.typical,
    });
    LawAbout {
        name: law.name,
        formula: law.formula,
        parameters: parameters.collect(),
        notes: format!("First touch: {}. {}", law.first_touch, law.source),
    }
}
