//! `windfall report`: figures, tables and a page that says what was done.

use crate::any_outcome::AnyOutcome;
use crate::campaign::Campaign;
use crate::campaign_kind::{CampaignKind, campaign_kind};
use crate::error::Error;
use crate::figure_campaign::NamedFigure;
use crate::figure_png::{PRINT, png_of_svg};
use crate::figure_theme::{DARK, LIGHT, Theme};
use crate::figure_xy::{csv_of_figure, svg_of_figure};
use crate::fit_key::input_digests;
use crate::on_threads::on_threads;
use crate::progress::Progress;
use crate::provenance::{VERSION, time_now};
use crate::report_campaign::sections_of_campaign;
use crate::report_page::{CaptionedTable, Report, Section, html_of_report};
use crate::request_fit::FitRequest;
use crate::workflow_fit::{FittedCampaign, fitted_campaign};
use crate::write_any::csv_of_any;
use crate::write_csv::csv_text;
use crate::write_file::write_whole;
use crate::write_findings::findings_once;
use crate::write_table::Cells;
use rayon::prelude::*;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Directory of the report in a campaign directory.
pub const REPORT_DIRECTORY: &str = "report";

/// Colours of the files of figures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FigureTheme {
    /// For paper.
    #[default]
    Light,
    /// For dark screens and slides.
    Dark,
}

impl FigureTheme {
    fn colours(self) -> &'static Theme {
        match self {
            Self::Light => &LIGHT,
            Self::Dark => &DARK,
        }
    }
}

/// What is asked of a report.
#[derive(Clone, Debug, Default)]
pub struct ReportRequest {
    /// How impacts are fitted; what is unchanged comes from the store.
    pub fit: FitRequest,
    /// Where to write in place of the campaign's own directory.
    pub out: Option<PathBuf>,
    /// Colours of the files of figures; the page has both.
    pub theme: FigureTheme,
}

/// What was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ReportOutcome {
    /// The page.
    pub page: PathBuf,
    /// All files, the page among them.
    pub files: Vec<PathBuf>,
    /// Impacts in it.
    pub impacts: usize,
    /// What could not be fitted.
    pub failed: usize,
}

/// Fits a campaign, as far as its results are not in its store, and writes figures,
/// tables and a page that holds all of it.
///
/// Each file is written whole or not at all; files of other names are left alone.
///
/// # Errors
/// The campaign or the request is wrong, it measures no impacts, nothing could be
/// fitted, or a file cannot be written.
pub fn report_campaign(
    directory: &Path,
    request: &ReportRequest,
    progress: Progress,
) -> Result<ReportOutcome, Error> {
    let kind = campaign_kind(directory)?;
    if kind != CampaignKind::Impacts {
        return Err(Error::OptionInvalid {
            option: directory.display().to_string(),
            problem: "reports are of campaigns of single impacts (pendulum, carriage); \
                      `windfall fit --figures` draws this one"
                .to_owned(),
        });
    }
    let fitted = fitted_campaign(directory, &request.fit, progress)?;
    if fitted.outcome.impacts.is_empty() {
        return Err(Error::NothingFitted {
            path: directory.to_path_buf(),
            failures: fitted.outcome.failed.len(),
        });
    }
    on_threads(request.fit.threads, || write(request, fitted))
}

fn write(request: &ReportRequest, fitted: FittedCampaign) -> Result<ReportOutcome, Error> {
    let FittedCampaign {
        campaign,
        rig,
        digests,
        outcome,
    } = fitted;
    let mut sections = sections_of_campaign(&campaign, &rig, &outcome)?;
    let (inputs, options) = input_digests(&campaign, &digests)?;
    let inputs = shown_names(&campaign, inputs);
    sections.push(origin(&inputs, &options));
    sections.push(citation());
    let report = Report {
        title: outcome.campaign.clone(),
        made: format!(
            "Made by windfall {VERSION} on {}; {} results of {} impacts, {} failures",
            time_now(),
            outcome.impacts.len(),
            campaign.impacts.len(),
            outcome.failed.len()
        ),
        simulated: outcome.simulated.clone(),
        findings: findings_once(&outcome),
        failed: outcome.failed.clone(),
        sections,
    };

    let out = request.out.clone();
    let out = out.unwrap_or_else(|| campaign.directory.join(REPORT_DIRECTORY));
    let figures = out.join("figures");
    std::fs::create_dir_all(&figures).map_err(|source| Error::FileAccess {
        path: figures.clone(),
        action: "create",
        source,
    })?;
    let drawn: Vec<&NamedFigure> = report.sections.iter().flat_map(|s| &s.figures).collect();
    let written: Result<Vec<Vec<PathBuf>>, Error> = drawn
        .par_iter()
        .map(|figure| write_named(&figures, figure, request.theme))
        .collect();
    let mut files: Vec<PathBuf> = written?.into_iter().flatten().collect();
    let (impacts, failed) = (outcome.impacts.len(), outcome.failed.len());
    let json = serde_json::to_string_pretty(&outcome).map_err(|error| Error::ResultUnwritable {
        item: outcome.campaign.clone(),
        detail: error.to_string(),
    })?;
    let any = AnyOutcome::Impacts(Box::new(outcome));
    let page = out.join("report.html");
    let others = [
        ("impacts.csv", csv_of_any(&any)?),
        ("results.json", json + "\n"),
        ("inputs.csv", csv_of_inputs(&inputs)?),
        ("windfall.bib", bibtex()),
        ("CITATION.cff", citation_file()),
        // Last: whoever sees the page finds all that it names.
        ("report.html", html_of_report(&report)),
    ];
    for (name, contents) in others {
        let path = out.join(name);
        write_whole(&path, contents.as_bytes())?;
        files.push(path);
    }
    Ok(ReportOutcome {
        page,
        files,
        impacts,
        failed,
    })
}

/// Recordings outside the campaign directory by their names within the directory of
/// recordings: a report is given away, and where files lie on a machine is not its
/// reader's business.
fn shown_names(campaign: &Campaign, inputs: Vec<(String, String)>) -> Vec<(String, String)> {
    let shown = |name: String| {
        let path = Path::new(&name);
        let within = path.strip_prefix(&campaign.files.directory);
        within.map_or(name.clone(), |within| within.display().to_string())
    };
    let named = inputs
        .into_iter()
        .map(|(name, digest)| (shown(name), digest));
    named.collect()
}

/// A figure as SVG, PNG and the data that it shows.
fn write_named(
    directory: &Path,
    named: &NamedFigure,
    theme: FigureTheme,
) -> Result<Vec<PathBuf>, Error> {
    let svg = svg_of_figure(&named.figure, theme.colours());
    let contents = [
        ("csv", csv_of_figure(&named.figure)?.into_bytes()),
        ("png", png_of_svg(&svg, PRINT)?),
        ("svg", svg.into_bytes()),
    ];
    let mut files = Vec::new();
    for (ending, contents) in contents {
        let path = directory.join(format!("{}.{ending}", named.name));
        write_whole(&path, &contents)?;
        files.push(path);
    }
    Ok(files)
}

/// Where the results come from.
fn origin(inputs: &[(String, String)], options: &str) -> Section {
    let rows = inputs
        .iter()
        .map(|(name, digest)| vec![name.clone(), digest.clone()]);
    let table = CaptionedTable {
        caption: "SHA-256 of every file that was read".to_owned(),
        cells: Cells {
            header: ["file", "SHA-256"].map(str::to_owned).to_vec(),
            rows: rows.collect(),
        },
    };
    Section {
        listing: Some(readable(options)),
        tables: vec![table],
        ..Section::of_words(
            "Origin",
            vec![format!(
                "windfall {VERSION}. The same files, options and version give the same numbers to \
                 the last bit, on any number of threads. Options, campaign.toml word for word \
                 among them:"
            )],
        )
    }
}

/// JSON with texts of several lines written as such.
fn readable(options: &str) -> String {
    let Ok(serde_json::Value::Object(map)) = serde_json::from_str(options) else {
        return options.to_owned();
    };
    let text = |value: &serde_json::Value| match value {
        serde_json::Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    let parts = map
        .iter()
        .map(|(key, value)| format!("{key}: {}", text(value)));
    parts.collect::<Vec<_>>().join("\n")
}

fn citation() -> Section {
    Section {
        listing: Some(bibtex()),
        ..Section::of_words(
            "How to cite",
            vec![
                "Cite windfall with its version, beside the source of the law (under Methods); \
                 the same is in windfall.bib and CITATION.cff beside this page."
                    .to_owned(),
            ],
        )
    }
}

fn bibtex() -> String {
    format!(
        "@software{{windfall,\n  title = {{windfall: contact-force laws of fruit from impact \
         recordings}},\n  version = {{{VERSION}}},\n  year = {{{}}}\n}}\n",
        &time_now()[..4]
    )
}

fn citation_file() -> String {
    format!(
        "cff-version: 1.2.0\nmessage: If you use windfall, please cite it as below.\n\
         title: windfall\nabstract: Contact-force laws of fruit from impact recordings, with \
         calibrated uncertainty.\ntype: software\nversion: {VERSION}\nauthors:\n  - name: The \
         windfall developers\n"
    )
}

fn csv_of_inputs(inputs: &[(String, String)]) -> Result<String, Error> {
    let rows = inputs
        .iter()
        .map(|(name, digest)| vec![name.clone(), digest.clone()]);
    csv_text(&["file", "sha256"].map(str::to_owned), rows)
}
