//! Response surfaces as text and CSV.

use crate::regress::mixed_outcome::MixedTest;
use crate::regress::mixed_text::{TESTS, VARIANCES};
use crate::regress::text::{anova_text, lack_of_fit_text, r2_text};
use crate::surface::outcome::{
    FactorOutcome, RandomOutcome, SettingOutcome, SurfaceModel, SurfaceOutcome, SurfaceTerm,
};
use crate::term_units::{coefficient_unit, in_unit_of, table_of_terms};
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::columns::{Column, strings, text_of_rows};
use windfall_files::text::number::{beside_sd, plain};
use windfall_files::text::statistic::number;
use windfall_files::text::table::{findings_list, page_tables};
use windfall_statistics::model::anova::AnovaRow;

const FACTORS: [Column<FactorOutcome>; 6] = [
    ("", |factor| factor.letter.clone()),
    ("factor", |factor| factor.name.clone()),
    ("coded 0", |factor| plain(factor.centre)),
    ("coded 1 is +", |factor| plain(factor.half_range)),
    ("lowest", |factor| plain(factor.lowest)),
    ("highest", |factor| plain(factor.highest)),
];

const TERMS: [Column<SurfaceTerm>; 5] = [
    ("term", |term| term.term.clone()),
    ("", |term| match term.name == term.term {
        true => String::new(),
        false => term.name.clone(),
    }),
    ("coded", |term| beside_sd(term.coded, term.se)),
    ("se", |term| number(term.se)),
    ("actual", |term| number(term.actual)),
];

/// Surfaces as text.
pub fn text_of_surface(outcome: &SurfaceOutcome) -> String {
    let unit = |factor: &FactorOutcome| coefficient_unit(&factor.name, "(Intercept)");
    let mut text = table_of_terms(&outcome.factors, &FACTORS, ("unit", unit), &[0, 1]);
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
    if let Some(random) = &model.random {
        return random_text(outcome, model, random);
    }
    let quality = &model.quality;
    let own = model.terms.iter().filter_map(|term| {
        Some(AnovaRow {
            term: term.term.clone(),
            ss: term.ss?,
            df: term.df?,
            f: term.f?,
            p: term.p?,
        })
    });
    let blocks = model.blocks.iter().map(|own| AnovaRow {
        term: "blocks".to_owned(),
        ss: own.sum.ss,
        df: own.sum.df,
        f: f64::NAN,
        p: f64::NAN,
    });
    let model_row = std::iter::once(model.model.row());
    let rows: Vec<AnovaRow> = blocks.chain(model_row).chain(own).collect();
    let lack_of_fit = model.lack_of_fit.as_ref();
    format!(
        "\n{}\n{}\n{}\nAnalysis of variance, type {}, in coded units:\n{}\n\n{}\n\
         residual standard deviation {} ({} % of the mean), adequate precision {}\n{}{}",
        model.response,
        terms_text(model),
        blocks_text(model),
        model.anova_type,
        anova_text(&rows, model.residual, lack_of_fit, model.total),
        r2_text(quality),
        in_unit_of(&model.response, number(quality.sigma)),
        number(model.cv_percent),
        number(quality.adequate_precision),
        lack_of_fit_text(lack_of_fit, "no run is repeated"),
        canonical_text(outcome, model)
    )
}

/// Coefficients of the coded factors and of the actual ones.
fn terms_text(model: &SurfaceModel) -> String {
    let unit = |term: &SurfaceTerm| coefficient_unit(&model.response, &term.name);
    table_of_terms(&model.terms, &TERMS, ("unit of actual", unit), &[0, 1])
}

/// A model with random groups: tests with their own degrees of freedom in place of sums of squares.
fn random_text(outcome: &SurfaceOutcome, model: &SurfaceModel, random: &RandomOutcome) -> String {
    let groups = random.groups.iter();
    let groups: Vec<String> = groups
        .map(|(name, count)| format!("{count} of {name}"))
        .collect();
    let whole = MixedTest {
        test: model.model.row(),
        df_denominator: random.model_df_denominator,
    };
    let own = model.terms.iter().filter_map(|term| {
        Some(MixedTest {
            test: AnovaRow {
                term: term.term.clone(),
                ss: f64::NAN,
                df: term.df?,
                f: term.f?,
                p: term.p?,
            },
            df_denominator: term.df_denominator?,
        })
    });
    let tests: Vec<MixedTest> = std::iter::once(whole).chain(own).collect();
    let quality = &model.quality;
    format!(
        "\n{}; groups: {}; {}\n{}\n{}\nTests of the terms in coded units, each after all others \
         ({}):\n{}\n\nStandard deviations, with profile intervals of the same likelihood:\n{}\n\n\
         R² of the surface {}, with the groups {}\nresidual standard deviation {} ({} % of the \
         mean), adequate precision {}\n{}",
        model.response,
        groups.join(", "),
        random.method,
        terms_text(model),
        blocks_text(model),
        random.df_method,
        text_of_rows(&tests, &TESTS, &[0]),
        text_of_rows(&random.variances, &VARIANCES, &[0, 1, 2]),
        plain(quality.r2),
        plain(random.r2_conditional),
        in_unit_of(&model.response, number(quality.sigma)),
        number(model.cv_percent),
        number(quality.adequate_precision),
        canonical_text(outcome, model)
    )
}

/// Blocks and how far they lie from their mean.
fn blocks_text(model: &SurfaceModel) -> String {
    let effects = model.blocks.iter().flat_map(|own| &own.effects);
    let effects = effects.map(|own| format!("{} {}", own.block, number(own.effect)));
    let effects: Vec<String> = effects.collect();
    match effects.is_empty() {
        true => String::new(),
        false => format!("blocks, from their mean: {}\n", effects.join(", ")),
    }
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
pub fn csv_of_surface(outcome: &SurfaceOutcome) -> Result<String, Error> {
    if let Some(grid) = &outcome.grid {
        let rows = grid.rows.iter();
        return csv_text(
            &grid.columns,
            rows.map(|row| row.iter().map(f64::to_string).collect()),
        );
    }
    let header = strings(&[
        "response",
        "term",
        "name",
        "coded",
        "se",
        "actual",
        "ss",
        "df",
        "f",
        "p",
        "df_denominator",
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
                given(term.df_denominator),
            ]
        })
    });
    csv_text(&header, rows)
}
