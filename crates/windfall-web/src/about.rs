//! What the page must know before it shows a campaign.

use crate::app::{Answer, App};
use axum::extract::State;
use serde::Serialize;
use windfall_cards::library::laws::{LawCardText, law_cards};
use windfall_files::provenance::VERSION;

/// Kinds of campaigns that `new` knows, with the words of the command line.
pub(crate) const KINDS: [&str; 6] = [
    "pendulum",
    "carriage",
    "drop",
    "compression",
    "acoustic",
    "repeats",
];

/// What the page must know.
#[derive(Debug, Serialize)]
pub(crate) struct About {
    version: &'static str,
    directory: String,
    /// Whether further campaigns can be made.
    creates: bool,
    upload_limit: u64,
    kinds: [&'static str; 6],
    laws: Vec<LawAbout>,
}

#[derive(Debug, Serialize)]
struct LawAbout {
    name: &'static str,
    formula: &'static str,
    parameters: Vec<ParameterAbout>,
    notes: String,
}

#[derive(Debug, Serialize)]
struct ParameterAbout {
    name: &'static str,
    unit: &'static str,
    meaning: &'static str,
    default: Option<f64>,
    typical: f64,
}

/// Version, directory, limits and force laws.
#[utoipa::path(get, path = "/api/about", responses((status = 200, body = Object)))]
pub(crate) async fn about(State(app): State<App>) -> Answer<About> {
    let laws = app.work(|_| law_cards(None, None)).await?;
    app.tell(&About {
        version: VERSION,
        directory: app.workspace.name(),
        creates: !app.workspace.is_campaign(),
        upload_limit: app.upload_limit,
        kinds: KINDS,
        laws: laws.iter().map(law_about).collect(),
    })
}

fn law_about(law: &LawCardText) -> LawAbout {
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
