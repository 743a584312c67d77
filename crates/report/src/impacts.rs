//! What the report of a campaign of impacts says.

use crate::figures::bench::figure_of_bench;
use crate::figures::covariate::{covariates_of, figure_of_covariate};
use crate::figures::parameters::{
    estimated_parameters, figure_of_pairs, figure_of_predictions, groups_of_impacts,
};
use crate::figures::posterior::figure_of_posterior;
use crate::figures::profiles::figure_of_profiles;
use crate::figures::residuals::figure_of_residuals;
use crate::figures::stacked::figure_of_stacked;
use crate::figures::trends::figure_of_trends;
use crate::listed::{LISTED, left_out};
use crate::methods::methods;
use windfall_campaign::impacts::figure_impact::figure_of_impact;
use windfall_campaign::impacts::groups::{
    SOURCES, derived_cells, groups_of, heading_of, law_cells, parameter_cells,
};
use windfall_campaign::impacts::mass::RigFound;
use windfall_campaign::impacts::text::{
    bench_lines, common_line, counted_line, derived_cell, laws_of, mass_line, own_codes,
    shared_codes,
};
use windfall_campaign::recording::extract::extract_recording;
use windfall_campaign::result::outcome::{CampaignOutcome, ImpactOutcome};
use windfall_campaign::result::quantity::quantities_named;
use windfall_campaign::result::trend::times_of;
use windfall_campaign::settings::model::ImpactCampaign;
use windfall_draw::files::{NamedFigure, file_name};
use windfall_draw::page::{CaptionedTable, Section};
use windfall_draw::xy::Figure;
use windfall_files::error::Error;
use windfall_files::text::number::{interval, value_and_sd};
use windfall_files::text::table::Cells;

/// Quantities in the table of impacts.
const OF_IMPACTS: [&str; 4] = [
    "impact_velocity",
    "peak_force",
    "restitution",
    "absorbed_energy",
];

/// Sections on a campaign, with the figures of the whole and of a few impacts.
///
/// # Errors
/// A recording that was fitted cannot be read any more.
pub fn sections_of_campaign(
    campaign: &ImpactCampaign,
    rig: &RigFound,
    outcome: &CampaignOutcome,
) -> Result<Vec<Section>, Error> {
    let mut sections = vec![
        Section::of_words("Methods", methods(campaign, outcome)),
        results(outcome),
    ];
    let times = times_of(&campaign.shared);
    for law in laws_of(outcome) {
        let impacts: Vec<&ImpactOutcome> = counted_of_law(outcome, law);
        let covariates = covariates_of(campaign, &impacts).into_iter();
        let over = covariates.filter_map(|c| figure_of_covariate(law, &impacts, &c));
        let pairs = figure_of_pairs(law, &impacts).into_iter();
        let figures = pairs
            .chain(over)
            .chain(figure_of_predictions(law, &impacts))
            .chain(figure_of_stacked(law, &impacts))
            .chain(figure_of_trends(law, &impacts, &outcome.trends, &times));
        let section = Section {
            figures: figures.collect(),
            ..Section::of_words(&format!("Figures: {law}"), Vec::new())
        };
        // Of a law under which no impact counts there is nothing to show.
        sections.extend((!section.figures.is_empty()).then_some(section));
    }
    let first = laws_of(outcome).first().map(|law| of_law(outcome, law));
    if let Some(figure) = first.and_then(|impacts| figure_of_bench(outcome, &impacts)) {
        sections.push(Section {
            figures: vec![figure],
            ..Section::of_words("Figures: bench", Vec::new())
        });
    }
    sections.push(examples(campaign, rig, outcome)?);
    sections.push(every_impact(outcome));
    Ok(sections)
}

fn of_law<'a>(outcome: &'a CampaignOutcome, law: &str) -> Vec<&'a ImpactOutcome> {
    outcome.impacts.iter().filter(|i| i.law == law).collect()
}

/// Those that count.
fn counted_of_law<'a>(outcome: &'a CampaignOutcome, law: &str) -> Vec<&'a ImpactOutcome> {
    let all = of_law(outcome, law).into_iter();
    all.filter(|impact| impact.counts()).collect()
}

/// Tables of groups.
fn results(outcome: &CampaignOutcome) -> Section {
    let laws = laws_of(outcome);
    let mut tables = Vec::new();
    for law in &laws {
        tables.push(CaptionedTable {
            caption: format!("Parameters of {law}, mean ± SD over impacts (SD in % of the mean)"),
            cells: parameter_cells(&groups_of(outcome, law), &of_law(outcome, law)),
        });
    }
    if let Some(first) = laws.first() {
        for (source, words) in SOURCES {
            let cells = derived_cells(outcome, first, source).into_iter();
            tables.extend(cells.map(|cells| CaptionedTable {
                caption: format!("Velocities, peaks and energies {words}, mean ± SD in %"),
                cells,
            }));
        }
    }
    if laws.len() > 1 {
        tables.push(CaptionedTable {
            caption: "The laws compared by residual over noise; 1 is a law that describes the \
                      signal to its noise"
                .to_owned(),
            cells: law_cells(outcome, &laws),
        });
    }
    Section {
        tables,
        ..Section::of_words(
            "Results",
            [counted_line(outcome), mass_line(outcome)]
                .into_iter()
                .chain(bench_lines(outcome))
                .chain(
                    laws_of(outcome)
                        .first()
                        .and_then(|law| common_line(outcome, &groups_of(outcome, law))),
                )
                .map(|line| format!("{line}."))
                .collect(),
        )
    }
}

/// Every impact with its parameters and their intervals.
fn every_impact(outcome: &CampaignOutcome) -> Section {
    let laws = laws_of(outcome);
    let own = laws.iter().map(|law| (law, of_law(outcome, law)));
    let rows = own.clone().map(|(_, impacts)| impacts.len()).max();
    let listed = own.filter(|(_, impacts)| impacts.len() <= LISTED);
    let tables = listed.map(|(law, impacts)| CaptionedTable {
        caption: format!(
            "Each impact under {law}: estimate ± standard deviation, and 95 % interval"
        ),
        cells: impact_cells(&impacts),
    });
    let words = left_out(rows.unwrap_or(0), "impacts.csv and results.json");
    Section {
        tables: tables.collect(),
        ..Section::of_words("Each impact", words.into_iter().collect())
    }
}

fn impact_cells(impacts: &[&ImpactOutcome]) -> Cells {
    let names = estimated_parameters(impacts);
    let shared = shared_codes(impacts);
    let mut header = ["impact", "specimen", "group"].map(str::to_owned).to_vec();
    for (name, _) in &names {
        header.push(heading_of(impacts, name));
        header.push("95 % interval".to_owned());
    }
    let columns = quantities_named(&OF_IMPACTS);
    header.extend(columns.iter().map(|column| column.narrow_title()));
    header.push("findings".to_owned());
    let row = |impact: &&ImpactOutcome| {
        let group = impact.group.clone().unwrap_or_default();
        let mut row = vec![impact.id.clone(), impact.specimen.clone(), group];
        for (name, _) in &names {
            let Some(found) = impact.parameters.get(name) else {
                row.extend(["-", "-"].map(str::to_owned));
                continue;
            };
            row.push(value_and_sd(found.value, found.sd));
            row.push(match found.interval() {
                Some((low, high)) => interval(low, high),
                None => "-".to_owned(),
            });
        }
        row.extend(columns.iter().map(|column| derived_cell(impact, column)));
        row.push(own_codes(impact, &shared));
        row
    };
    Cells {
        rows: impacts.iter().map(row).collect(),
        header,
    }
}

/// Of each group the impact with the middle first parameter, and the worst fitted of all.
fn shown_impacts<'a>(impacts: &[&'a ImpactOutcome]) -> Vec<(&'a ImpactOutcome, &'static str)> {
    let mut shown: Vec<(&ImpactOutcome, &str)> = Vec::new();
    for (_, mut members) in groups_of_impacts(impacts) {
        let first = |impact: &&ImpactOutcome| {
            let parameter = impact.parameters.0.first();
            parameter.map_or(f64::NAN, |(_, estimate)| estimate.value)
        };
        members.sort_by(|a, b| first(a).total_cmp(&first(b)));
        shown.push((members[members.len() / 2], "the middle one of its group"));
    }
    let worst = impacts
        .iter()
        .max_by(|a, b| misfit(a).total_cmp(&misfit(b)));
    let new = |worst: &&&ImpactOutcome| shown.iter().all(|(own, _)| !std::ptr::eq(*own, **worst));
    if let Some(worst) = worst.filter(new) {
        shown.push((worst, "the one that the law describes worst"));
    }
    shown
}

/// Largest root mean square residual over noise among the quantities.
fn misfit(impact: &ImpactOutcome) -> f64 {
    let ratios = impact.residuals.0.iter().map(|(_, r)| r.rms / r.noise);
    ratios.filter(|r| r.is_finite()).fold(0.0, f64::max)
}

/// Figures of a few impacts: signals and residuals.
fn examples(
    campaign: &ImpactCampaign,
    rig: &RigFound,
    outcome: &CampaignOutcome,
) -> Result<Section, Error> {
    let laws = laws_of(outcome);
    let first = laws.first().copied().unwrap_or_default();
    let used = (&rig.rig, campaign.fit.options.end, &campaign.fit.user[..]);
    let mut figures = Vec::new();
    for (shown, why) in shown_impacts(&counted_of_law(outcome, first)) {
        let id = &shown.id;
        let Some(entry) = campaign.shared.entries.iter().find(|entry| entry.id == *id) else {
            continue;
        };
        let mass = Some(rig.rig.effective_mass());
        let (impact, _) = extract_recording(campaign, entry, mass)?;
        let own: Vec<&ImpactOutcome> = outcome.impacts.iter().filter(|i| i.id == *id).collect();
        let group = shown.group.as_deref().unwrap_or_default();
        let title = format!("{id} {group}").trim_end().to_owned();
        let mut add = |what: &str, caption: String, figure: Option<Figure>| {
            figures.extend(figure.map(|figure| NamedFigure {
                name: file_name(&format!("impact-{id}{what}")),
                caption,
                figure,
            }));
        };
        let caption = format!(
            "Impact {id}, {why}: signals with the contact window, fitted motion, and loop of force \
             over displacement."
        );
        add(
            "",
            caption,
            Some(figure_of_impact(&title, &impact, &own, used)),
        );
        let caption = format!(
            "Impact {id}: what {first} leaves of the signals, beside the noise of a sample, and \
             how it goes together from sample to sample."
        );
        add(
            "-residuals",
            caption,
            figure_of_residuals(&title, &impact, shown, used),
        );
        let caption = format!(
            "Impact {id}: profile of the likelihood, maximal over all other parameters. Where it \
             leaves the broken parabola, estimate ± standard deviation does not tell all."
        );
        add("-profiles", caption, figure_of_profiles(&title, shown));
        let caption = format!(
            "Impact {id}: how probable each value of a parameter is after the recording, with the \
             95 % interval, and draws of the parameters of the law against each other."
        );
        add("-posterior", caption, figure_of_posterior(&title, shown));
    }
    Ok(Section {
        figures,
        ..Section::of_words(
            "Single impacts",
            vec![format!(
                "Of each group the impact whose first parameter is the middle one, and the impact \
                 that {first} describes worst."
            )],
        )
    })
}
