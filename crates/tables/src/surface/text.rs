//! Response surfaces as text and CSV.

use crate::regress::outcome::AnovaOutcome;
use crate::regress::text::anova_text;
use crate::surface::outcome::{SettingOutcome, SurfaceModel, SurfaceOutcome};
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::number::plain;
use windfall_files::text::statistic::{freedom, number, probability};
use windfall_files::text::table::findings_list;
use windfall_files::text::table::page_tables;

fn strings(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// Surfaces as text.
#[must_use]
pub fn text_of_surface(outcome: &SurfaceOutcome) -> String {
    let header = strings(&["", "factor", "coded 0", "coded 1 is +", "lowest", "highest"]);
    let rows = outcome.factors.iter().map(|factor| {
        vec![
            factor.letter.clone(),
            factor.name.clone(),
            plain(factor.centre),
            plain(factor.half_range),
            plain(factor.lowest),
            plain(factor.highest),
        ]
    });
    let mut text = page_tables(&header, &rows.collect::<Vec<_>>(), &[0, 1]);
    text += &format!("\nCoding: {}\n", outcome.coding);
    for model in &outcome.responses {
        text += &model_text(outcome, model);
    }
    if let Some(optimum) = &outcome.optimum {
        text += "\nMost desirable settings:\n";
        text += &settings_text(outcome, std::slice::from_ref(optimum));
        text += "\n";
    }
    if let Some(family) = &outcome.family {
        text += &format!(
            "\nAs desirable, {} from {} to {}:\n",
            family.along,
            plain(family.from),
            plain(family.to)
        );
        text += &settings_text(outcome, &family.members);
        text += "\n";
    }
    text + &findings_list(&outcome.findings)
}

fn model_text(outcome: &SurfaceOutcome, model: &SurfaceModel) -> String {
    let quality = &model.quality;
    let header = strings(&["term", "", "coded", "se", "actual"]);
    let rows = model.terms.iter().map(|term| {
        vec![
            term.term.clone(),
            if term.name == term.term {
                String::new()
            } else {
                term.name.clone()
            },
            number(term.coded),
            number(term.se),
            number(term.actual),
        ]
    });
    let mut text = format!(
        "\n{}\n{}\n\nAnalysis of variance, type {}, in coded units:\n",
        model.response,
        page_tables(&header, &rows.collect::<Vec<_>>(), &[0, 1]),
        model.anova_type
    );
    let own = model.terms.iter().filter_map(|term| {
        Some(AnovaOutcome {
            term: term.term.clone(),
            ss: term.ss?,
            df: term.df?,
            f: term.f?,
            p: term.p?,
        })
    });
    let whole = AnovaOutcome {
        term: "model".to_owned(),
        ss: model.model.ss,
        df: model.model.df,
        f: model.model.f,
        p: model.model.p,
    };
    let mut rest = vec![("residual", model.residual.ss, model.residual.df)];
    if let Some(lack) = &model.lack_of_fit {
        rest.push(("  lack of fit", lack.lack.ss, lack.lack.df));
        rest.push(("  pure error", lack.pure_error.ss, lack.pure_error.df));
    }
    rest.push(("total", model.total.ss, model.total.df));
    let rows: Vec<AnovaOutcome> = std::iter::once(whole).chain(own).collect();
    text += &anova_text(&rows, &rest);
    text += &format!(
        "\n\nR² {}, adjusted {}, predicted {} (PRESS {})\nresidual standard deviation {} ({} % of the mean), \
         adequate precision {}\n",
        number(quality.r2),
        number(quality.r2_adjusted),
        number(quality.r2_predicted),
        number(quality.press),
        number(quality.sigma),
        number(model.cv_percent),
        number(quality.adequate_precision),
    );
    text += &match &model.lack_of_fit {
        Some(lack) => format!(
            "lack of fit: F {} on {} and {}, p {}\n",
            number(lack.lack.f),
            freedom(lack.lack.df),
            freedom(lack.pure_error.df),
            probability(lack.lack.p)
        ),
        None => "lack of fit: no run is repeated, so there is no pure error to test against\n"
            .to_owned(),
    };
    text + &canonical_text(outcome, model)
}

fn canonical_text(outcome: &SurfaceOutcome, model: &SurfaceModel) -> String {
    let Some(found) = &model.canonical else {
        return String::new();
    };
    let settings = outcome.factors.iter().zip(&found.actual);
    let settings: Vec<String> = settings
        .map(|(factor, value)| format!("{} {}", factor.name, plain(*value)))
        .collect();
    let curvatures: Vec<String> = found
        .eigenvalues
        .iter()
        .map(|value| plain(*value))
        .collect();
    format!(
        "stationary point: {} at {} ({} the range of the runs), {} there; curvatures {}\n",
        found.shape,
        settings.join(", "),
        if found.inside { "within" } else { "outside" },
        plain(found.value),
        curvatures.join(", ")
    )
}

fn settings_text(outcome: &SurfaceOutcome, settings: &[SettingOutcome]) -> String {
    let factors = outcome.factors.iter().map(|factor| factor.name.clone());
    let responses = outcome.responses.iter().map(|model| model.response.clone());
    let header: Vec<String> = factors
        .chain(responses)
        .chain(["desirability".to_owned()])
        .collect();
    let rows = settings.iter().map(|setting| {
        let actual = setting.actual.iter().map(|value| plain(*value));
        let values = setting.responses.iter().map(|r| plain(r.predicted));
        actual
            .chain(values)
            .chain([format!("{:.4}", setting.desirability)])
            .collect()
    });
    page_tables(&header, &rows.collect::<Vec<_>>(), &[])
}

/// Surfaces as CSV: the grid where one was asked for, else the terms.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_surface(outcome: &SurfaceOutcome) -> Result<String, Error> {
    if let Some(grid) = &outcome.grid {
        let rows = grid.rows.iter();
        return csv_text(
            &grid.columns,
            rows.map(|row| row.iter().map(f64::to_string).collect()),
        );
    }
    let header = strings(&[
        "response", "term", "name", "coded", "se", "actual", "ss", "df", "f", "p",
    ]);
    let rows = outcome.responses.iter().flat_map(|model| {
        model.terms.iter().map(|term| {
            let given = |value: Option<f64>| value.map_or_else(String::new, |v| v.to_string());
            vec![
                model.response.clone(),
                term.term.clone(),
                term.name.clone(),
                term.coded.to_string(),
                term.se.to_string(),
                term.actual.to_string(),
                given(term.ss),
                given(term.df),
                given(term.f),
                given(term.p),
            ]
        })
    });
    csv_text(&header, rows)
}
