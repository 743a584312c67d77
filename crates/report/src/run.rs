//! `windfall report`: figures, tables and a page that says what was done.

use crate::any_text::csv_of_any;
use crate::fit_any::measurement_of;
use crate::impacts::sections_of_campaign;
use crate::items::sections_of_items;
use crate::listed::{LISTED, left_out};
use serde::Serialize;
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};
use windfall_campaign::impacts::findings::findings_once;
use windfall_campaign::impacts::key::run_options;
use windfall_campaign::impacts::run::{FittedCampaign, fitted_campaign};
use windfall_campaign::pipeline::request::FitRequest;
use windfall_campaign::recording::digests::{Digests, run_origin};
use windfall_campaign::result::counted::NOTE_COLUMN;
use windfall_campaign::settings::kind::campaign_kind;
use windfall_campaign::settings::model::{Campaign, FilePlan, ImpactEntry};
use windfall_draw::files::{FigureFolder, FigureFormat, NamedFigure, write_figures};
use windfall_draw::page::{CaptionedTable, Report, Section, html_of_report};
use windfall_draw::theme::FigureTheme;
use windfall_draw::width::Width;
use windfall_files::error::Error;
use windfall_files::on_threads::on_threads;
use windfall_files::progress::Progress;
use windfall_files::provenance::{VERSION, time_now};
use windfall_files::table::write::csv_text;
use windfall_files::text::table::Cells;
use windfall_files::write_file::write_whole;
use windfall_measure::any_outcome::AnyOutcome;
use windfall_measure::run::ReportedItems;
use windfall_measure::text::findings_of_measured;

/// Directory of the report in a campaign directory.
pub const REPORT_DIRECTORY: &str = "report";

/// Options of a report.
#[derive(Clone, Debug, Default)]
pub struct ReportRequest {
    /// How impacts are fitted; what is unchanged comes from the store.
    pub fit: FitRequest,
    /// Where to write in place of the campaign's own directory.
    pub out: Option<PathBuf>,
    /// Colours of the files of figures; the page has both.
    pub theme: FigureTheme,
    /// Width of the files of figures on paper; as wide as a screen shows them where it is left out.
    pub width: Option<Width>,
    /// Formats of the files of figures; SVG and PNG where it is empty.
    pub formats: Vec<FigureFormat>,
}

/// What was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, utoipa::ToSchema)]
pub struct ReportOutcome {
    /// The page.
    #[schema(value_type = String)]
    pub page: PathBuf,
    /// All files, the page among them.
    #[schema(value_type = Vec<String>)]
    pub files: Vec<PathBuf>,
    /// Impacts in it.
    pub impacts: usize,
    /// What could not be fitted.
    pub failed: usize,
}

/// Evaluates a campaign as far as needed, and writes figures, tables and the page.
///
/// Each file is written whole or not at all; files of other names are left alone.
///
/// # Errors
/// The campaign or the request is wrong, nothing could be fitted (the error says why
/// of each recording), or a file cannot be written.
pub fn report_campaign(
    directory: &Path,
    request: &ReportRequest,
    progress: Progress,
) -> Result<ReportOutcome, Error> {
    let out = report_folder(request, directory);
    let files = FILES.iter().map(|name| out.join(name));
    let fit = &FitRequest {
        outputs: files.chain([out.join(FIGURES)]).collect(),
        ..request.fit.clone()
    };
    let Some(measurement) = measurement_of(campaign_kind(directory)?) else {
        let fitted = fitted_campaign(directory, fit, progress)?;
        return on_threads(fit.threads, || report_impacts(request, fitted));
    };
    let items = (measurement.report)(directory, fit, progress)?;
    on_threads(fit.threads, || report_items(request, items))
}

/// Files of a report. The page comes last, so that all it refers to exists.
const FILES: [&str; 6] = [
    "impacts.csv",
    "results.json",
    "inputs.csv",
    "windfall.bib",
    "CITATION.cff",
    "report.html",
];

/// The folder of its figures.
const FIGURES: &str = "figures";

/// Where a report goes.
fn report_folder(request: &ReportRequest, campaign: &Path) -> PathBuf {
    let out = request.out.clone();
    out.unwrap_or_else(|| campaign.join(REPORT_DIRECTORY))
}

fn report_impacts(request: &ReportRequest, fitted: FittedCampaign) -> Result<ReportOutcome, Error> {
    let FittedCampaign {
        campaign,
        rig,
        digests,
        outcome,
    } = fitted;
    let sections = match outcome.impacts.is_empty() {
        true => Vec::new(),
        false => sections_of_campaign(&campaign, &rig, &outcome)?,
    };
    let sections = sections.into_iter().chain(notes_section(&campaign.shared));
    let source = Source::of(&campaign.shared, &digests, run_options(&campaign))?;
    let report = Report {
        title: outcome.campaign.clone(),
        made: String::new(),
        simulated: outcome.simulated.clone(),
        note: outcome.note.clone(),
        findings: findings_once(&outcome),
        failed: outcome.failed.clone(),
        sections: sections.collect(),
    };
    let any = AnyOutcome::Impacts(Box::new(outcome));
    write(request, &source, report, &any)
}

fn report_items(request: &ReportRequest, reported: ReportedItems) -> Result<ReportOutcome, Error> {
    let (campaign, outcome) = (&reported.campaign, &reported.outcome);
    let source = Source::of(campaign, &reported.digests, Map::new())?;
    let report = Report {
        title: outcome.campaign.clone(),
        made: String::new(),
        simulated: outcome.simulated.clone(),
        note: outcome.note.clone(),
        findings: findings_of_measured(outcome),
        failed: outcome.failed.clone(),
        sections: sections_of_items(&reported)
            .into_iter()
            .chain(notes_section(campaign))
            .collect(),
    };
    let any = AnyOutcome::Measured(Box::new(outcome.clone()));
    write(request, &source, report, &any)
}

/// What impacts.csv says in words of single impacts, whether they count or not.
fn notes_section(campaign: &Campaign) -> Option<Section> {
    let line = |entry: &ImpactEntry| {
        let mut cells = entry.cells.iter();
        let (_, note) = cells.find(|(name, _)| name == NOTE_COLUMN)?;
        (!note.trim().is_empty()).then(|| format!("{}: {}", entry.id, note.trim()))
    };
    let lines: Vec<String> = campaign.entries.iter().filter_map(line).collect();
    (!lines.is_empty()).then(|| Section::of_words("Notes on single impacts", lines))
}

/// Where the results of a report come from.
struct Source<'a> {
    /// The campaign directory.
    directory: &'a Path,
    /// Recordings in the table.
    recordings: usize,
    /// Files that were read with their SHA-256.
    inputs: Vec<(String, String)>,
    /// Options as JSON.
    options: String,
}

impl<'a> Source<'a> {
    fn of(
        campaign: &'a Campaign,
        digests: &Digests,
        options: Map<String, Value>,
    ) -> Result<Self, Error> {
        let origin = run_origin(campaign, digests, options)?;
        Ok(Self {
            directory: &campaign.directory,
            recordings: campaign.entries.len(),
            inputs: shown_names(&campaign.files, origin.inputs),
            options: origin.options,
        })
    }
}

/// Writes a report with all its files: what only says where it comes from is added here.
fn write(
    request: &ReportRequest,
    source: &Source,
    mut report: Report,
    outcome: &AnyOutcome,
) -> Result<ReportOutcome, Error> {
    let (results, failed) = (outcome.results(), outcome.failed().len());
    if results == 0 {
        return Err(Error::NothingFitted {
            path: source.directory.to_path_buf(),
            failures: outcome.failed().to_vec(),
        });
    }
    report.made = format!(
        "Made by windfall {VERSION} on {}; {results} results of {} recordings, {failed} failures",
        time_now(),
        source.recordings
    );
    report
        .sections
        .push(origin(&source.inputs, &source.options));
    report.sections.push(citation());

    let out = report_folder(request, source.directory);
    let drawn: Vec<&NamedFigure> = report.sections.iter().flat_map(|s| &s.figures).collect();
    let folder = FigureFolder {
        directory: out.join(FIGURES),
        theme: request.theme,
        width: request.width,
        formats: request.formats.clone(),
    };
    let mut files = write_figures(&folder, &drawn)?;
    let json = serde_json::to_string_pretty(outcome)
        .map_err(|error| Error::unwritable(&report.title, error))?;
    let page = out.join("report.html");
    let contents = [
        csv_of_any(outcome)?,
        json + "\n",
        csv_of_inputs(&source.inputs)?,
        bibtex(),
        citation_file(),
        html_of_report(&report),
    ];
    for (name, contents) in FILES.iter().zip(contents) {
        let path = out.join(name);
        write_whole(&path, contents.as_bytes())?;
        files.push(path);
    }
    Ok(ReportOutcome {
        page,
        files,
        impacts: results,
        failed,
    })
}

/// Names of recordings outside the campaign directory without their path on this machine,
/// because a report is given away.
fn shown_names(files: &FilePlan, inputs: Vec<(String, String)>) -> Vec<(String, String)> {
    let shown = |name: String| {
        let path = Path::new(&name);
        let within = path.strip_prefix(&files.directory);
        within.map_or(name.clone(), |within| within.display().to_string())
    };
    let inputs = inputs.into_iter();
    inputs.map(|(name, digest)| (shown(name), digest)).collect()
}

/// Where the results come from.
fn origin(inputs: &[(String, String)], options: &str) -> Section {
    let table = CaptionedTable {
        caption: "SHA-256 of every file that was read".to_owned(),
        cells: Cells {
            header: ["file", "SHA-256"].map(str::to_owned).to_vec(),
            rows: rows_of(inputs).collect(),
        },
    };
    let mut words = vec![format!(
        "windfall {VERSION} read {} files. The same files, options and version give the same \
         numbers to the last bit, on any number of threads. campaign.toml, word for word, and all \
         options are below.",
        inputs.len()
    )];
    words.extend(left_out(inputs.len(), "inputs.csv"));
    let (campaign, settings) = in_words(options);
    let settings = CaptionedTable {
        caption: "Options of this run; what is not set is left out".to_owned(),
        cells: Cells {
            header: ["option", "value"].map(str::to_owned).to_vec(),
            rows: settings,
        },
    };
    let mut tables = vec![settings];
    tables.extend((inputs.len() <= LISTED).then_some(table));
    tables.retain(|own| !own.cells.rows.is_empty());
    Section {
        listing: (!campaign.is_empty()).then_some(campaign),
        tables,
        ..Section::of_words("Origin", words)
    }
}

/// Options, which are JSON: texts of several lines word for word, and the others as rows of words
/// and values.
fn in_words(options: &str) -> (String, Vec<Vec<String>>) {
    let Ok(Value::Object(map)) = serde_json::from_str(options) else {
        return (options.to_owned(), Vec::new());
    };
    let (mut texts, mut rows) = (Vec::new(), Vec::new());
    for (key, value) in &map {
        match value {
            Value::String(text) if text.contains('\n') => texts.push(text.clone()),
            value => add_rows(&key.replace('_', " "), value, &mut rows),
        }
    }
    (texts.join("\n"), rows)
}

/// Adds an option by its words, or what it consists of.
fn add_rows(words: &str, value: &Value, rows: &mut Vec<Vec<String>>) {
    let plain = |value: &Value| match value {
        Value::String(text) => text.clone(),
        Value::Bool(true) => "yes".to_owned(),
        Value::Bool(false) => "no".to_owned(),
        other => other.to_string(),
    };
    let own = match value {
        Value::Null => return,
        Value::Object(map) => {
            for (key, value) in map {
                add_rows(&format!("{words}, {}", key.replace('_', " ")), value, rows);
            }
            return;
        }
        Value::Array(all) if all.iter().any(Value::is_object) => {
            for (place, value) in all.iter().enumerate() {
                add_rows(&format!("{words} {}", place + 1), value, rows);
            }
            return;
        }
        Value::Array(all) => {
            let set = all.iter().filter(|own| !own.is_null());
            set.map(plain).collect::<Vec<_>>().join(", ")
        }
        other => plain(other),
    };
    if !own.is_empty() {
        rows.push(vec![words.to_owned(), own]);
    }
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

/// Who wrote windfall, with colons between.
const AUTHORS: &str = env!("CARGO_PKG_AUTHORS");

fn citation_file() -> String {
    let authors = AUTHORS.split(':').map(|own| format!("  - name: {own}\n"));
    let authors: String = authors.collect();
    format!(
        "cff-version: 1.2.0\nmessage: If you use windfall, please cite it as below.\n\
         title: windfall\nabstract: Contact-force laws of fruit from impact recordings, with \
         calibrated uncertainty.\ntype: software\nversion: {VERSION}\nauthors:\n{authors}"
    )
}

fn csv_of_inputs(inputs: &[(String, String)]) -> Result<String, Error> {
    csv_text(&["file", "sha256"].map(str::to_owned), rows_of(inputs))
}

fn rows_of(inputs: &[(String, String)]) -> impl Iterator<Item = Vec<String>> {
    let inputs = inputs.iter();
    inputs.map(|(name, digest)| vec![name.clone(), digest.clone()])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The file at the top of the repository says the same, and under which licence.
    #[test]
    fn reference_the_citation_is_that_of_the_repository() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../CITATION.cff");
        let text = std::fs::read_to_string(path).unwrap();
        let present: Vec<&str> = text.lines().collect();
        for line in citation_file().lines() {
            assert!(present.contains(&line), "CITATION.cff lacks {line:?}");
        }
        let authors = |text: &str| text.matches("  - name: ").count();
        assert_eq!(authors(&text), authors(&citation_file()));
    }
}
