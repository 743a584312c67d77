//! Tables of a campaign, regressions and response surfaces over them.

use crate::api::recordings::FileAsked;
use crate::app::{Answer, App};
use crate::contour_map::{ContourMap, ResponseMap, contour_map, response_maps};
use crate::described::{QuestionProblems, RequestProblems};
use crate::given::{Asked, Given};
use crate::problem::Problem;
use axum::extract::{Path, State};
use serde::{Deserialize, Serialize};
use std::path::{Path as FilePath, PathBuf};
use utoipa::ToSchema;
use windfall_files::confined::path_inside;
use windfall_files::error::Error;
use windfall_files::table::csv::read_table;
use windfall_files::text::quote::{command, path_word};
use windfall_tables::regress::request::{Direction, RegressRequest};
use windfall_tables::regress::run::{AnyRegressOutcome, regress};
use windfall_tables::surface::outcome::SurfaceOutcome;
use windfall_tables::surface::request::SurfaceRequest;
use windfall_tables::surface::run::surface;
use windfall_tables::term_units::coefficient_unit;
use windfall_workspace::campaign_view::name_of;

/// Largest number of grid points along one factor.
const MOST_GRID_POINTS: usize = 200;

/// A table.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct DataTable {
    /// Its name below the campaign.
    file: String,
    columns: Vec<DataColumn>,
    /// Cells as they are written.
    rows: Vec<Vec<String>>,
}

/// A column of a table.
#[derive(Debug, Serialize, ToSchema)]
struct DataColumn {
    /// Its heading.
    name: String,
    /// Whether all its cells are numbers, or blank.
    numbers: bool,
}

/// A linear model of a table.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RegressGiven {
    /// The table: "tables/results.csv".
    table: String,
    /// A column, or a function of one.
    response: String,
    /// Its terms: "V*R + t".
    terms: String,
    /// Random effects.
    #[serde(default)]
    random: Vec<String>,
    /// Whether to remove terms by backward selection.
    #[serde(default)]
    select: bool,
}

/// Response surfaces of a table.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SurfaceGiven {
    /// The table.
    table: String,
    /// Factors in the order of their letters.
    factors: Vec<String>,
    /// Responses with their models.
    responses: Vec<ResponseGiven>,
    /// Goals for responses.
    #[serde(default)]
    goals: Vec<String>,
    /// Factors held at a value.
    #[serde(default)]
    hold: Vec<String>,
    /// Factor along which equally good settings are listed.
    along: Option<String>,
    /// How many of these values.
    #[serde(default = "usual_members")]
    members: usize,
    /// Two factors for a grid of predictions.
    grid: Option<String>,
    /// Points of the grid along each.
    #[serde(default = "usual_grid_points")]
    grid_points: usize,
}

/// A response with its model.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ResponseGiven {
    /// The column.
    name: String,
    /// "quadratic", or terms in the letters of the factors.
    model: String,
}

fn usual_members() -> usize {
    15
}

fn usual_grid_points() -> usize {
    41
}

/// Values over a rectangular grid.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct GridGiven {
    /// First coordinates, rising.
    x: Vec<f64>,
    /// Second coordinates, rising.
    y: Vec<f64>,
    /// Values, the first coordinate varying fastest.
    values: Vec<f64>,
}

/// Response surfaces with the equal command.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct SurfaceAnswer {
    #[serde(flatten)]
    outcome: SurfaceOutcome,
    /// Contour maps of the responses, where a grid was asked for.
    maps: Vec<ResponseMap>,
    /// Units of the factors, in their order; blank where their names say none.
    factor_units: Vec<String>,
    /// Units of each response and of its coefficients in actual units.
    units: Vec<TermUnits>,
    command: String,
}

/// A linear model with the equal command.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct RegressAnswer {
    #[serde(flatten)]
    outcome: AnyRegressOutcome,
    /// Unit of the response and units of the coefficients, in the order of `terms`; blank where
    /// names of columns say none.
    units: TermUnits,
    command: String,
}

/// Units of a model.
#[derive(Debug, Serialize, ToSchema)]
struct TermUnits {
    /// Of the response.
    response: String,
    /// Of the coefficients.
    terms: Vec<String>,
}

impl TermUnits {
    fn of<'a>(response: &str, terms: impl Iterator<Item = &'a str>) -> Self {
        Self {
            response: coefficient_unit(response, "(Intercept)"),
            terms: terms.map(|term| coefficient_unit(response, term)).collect(),
        }
    }

    fn of_regression(outcome: &AnyRegressOutcome) -> Self {
        let (response, terms) = match outcome {
            AnyRegressOutcome::Linear(own) => (&own.response, &own.terms),
            AnyRegressOutcome::Mixed(own) => (&own.response, &own.terms),
        };
        Self::of(response, terms.iter().map(|term| term.name.as_str()))
    }
}

/// A table of a campaign.
fn table_inside(directory: &FilePath, name: &str) -> Result<PathBuf, Error> {
    let path = path_inside(directory, name)?;
    if !name.to_lowercase().ends_with(".csv") {
        return Err(Error::NameRefused {
            name: name.to_owned(),
            problem: "is no table: its name does not end in .csv".to_owned(),
        });
    }
    match path.is_file() {
        true => Ok(path),
        false => Err(Error::FileAbsent {
            path,
            advice: "fit the campaign to get tables/results.csv, or add a table".to_owned(),
        }),
    }
}

/// A table of the campaign, cell by cell.
#[utoipa::path(
    get, path = "/api/campaigns/{id}/table", params(("id" = String, Path, example = "bench"), FileAsked),
    responses((status = 200, body = DataTable), QuestionProblems))]
pub(crate) async fn table(
    State(app): State<App>,
    Path(id): Path<String>,
    Asked(asked): Asked<FileAsked>,
) -> Answer<DataTable> {
    app.answer(id, move |_, directory| {
        let table = read_table(&table_inside(directory, &asked.file)?)?;
        let number = |cell: &String| cell.is_empty() || cell.parse::<f64>().is_ok();
        let columns = table.columns.iter().enumerate().map(|(place, name)| {
            let mut cells = table.rows.iter().map(|row| &row.cells[place]);
            DataColumn {
                name: name.clone(),
                numbers: cells.clone().any(|cell| !cell.is_empty()) && cells.all(number),
            }
        });
        Ok(DataTable {
            file: asked.file,
            columns: columns.collect(),
            rows: table.rows.iter().map(|row| row.cells.clone()).collect(),
        })
    })
    .await
}

/// A linear model, as `windfall regress` gives it.
#[utoipa::path(
    post, path = "/api/campaigns/{id}/regress", params(("id" = String, Path, example = "bench")),
    request_body = RegressGiven,
    responses((status = 200, body = RegressAnswer), RequestProblems))]
pub(crate) async fn regression(
    State(app): State<App>,
    Path(id): Path<String>,
    Given(given): Given<RegressGiven>,
) -> Answer<RegressAnswer> {
    app.answer(id, move |_, directory| {
        let table = table_inside(directory, &given.table)?;
        let shown = path_word(format!("{}/{}", name_of(directory), given.table));
        let mut words = vec!["regress", &shown, "--response", &given.response];
        words.extend(["--terms", &given.terms]);
        words.extend(given.random.iter().flat_map(|random| ["--random", random]));
        if given.select {
            words.extend(["--select", "backward"]);
        }
        let command = command(&words);
        let mut request = RegressRequest::usual(table, given.response, given.terms);
        request.random = given.random;
        request.select = given.select.then_some(Direction::Backward);
        let outcome = regress(&request)?;
        Ok(RegressAnswer {
            units: TermUnits::of_regression(&outcome),
            outcome,
            command,
        })
    })
    .await
}

/// Response surfaces, as `windfall surface` gives them.
#[utoipa::path(
    post, path = "/api/campaigns/{id}/surface", params(("id" = String, Path, example = "bench")),
    request_body = SurfaceGiven,
    responses((status = 200, body = SurfaceAnswer), RequestProblems))]
pub(crate) async fn surfaces(
    State(app): State<App>,
    Path(id): Path<String>,
    Given(given): Given<SurfaceGiven>,
) -> Answer<SurfaceAnswer> {
    if given.responses.is_empty() {
        return Err(Problem::request("name at least one response"));
    }
    app.answer(id, move |_, directory| fitted_surface(directory, given))
        .await
}

fn fitted_surface(directory: &FilePath, given: SurfaceGiven) -> Result<SurfaceAnswer, Error> {
    let table = table_inside(directory, &given.table)?;
    let shown = path_word(format!("{}/{}", name_of(directory), given.table));
    let mut words = vec!["surface", shown.as_str()];
    for response in &given.responses {
        words.extend(["--response", &response.name]);
    }
    for response in &given.responses {
        words.extend(["--model", &response.model]);
    }
    let lists = [
        ("--factor", &given.factors),
        ("--goal", &given.goals),
        ("--hold", &given.hold),
    ];
    for (option, values) in lists {
        words.extend(values.iter().flat_map(|value| [option, value]));
    }
    let members = given.members.to_string();
    if let Some(along) = &given.along {
        words.extend(["--along", along, "--members", &members]);
    }
    let command = command(&words);
    let names: Vec<String> = given.responses.iter().map(|r| r.name.clone()).collect();
    let models = given.responses.into_iter().map(|r| r.model).collect();
    let mut request = SurfaceRequest::usual(table, names.clone(), models);
    request.factors = given.factors;
    request.goals = given.goals;
    request.hold = given.hold;
    request.along = given.along;
    request.members = given.members.min(1000);
    request.grid = given.grid;
    request.grid_points = given.grid_points.clamp(2, MOST_GRID_POINTS);
    let outcome = surface(&request)?;
    let maps = match (&outcome.grid, &request.grid) {
        (Some(grid), Some(pair)) => response_maps(grid, pair, &names),
        _ => Vec::new(),
    };
    let factors = outcome.factors.iter();
    let models = outcome.responses.iter();
    Ok(SurfaceAnswer {
        factor_units: factors
            .map(|factor| coefficient_unit(&factor.name, "(Intercept)"))
            .collect(),
        units: models
            .map(|own| TermUnits::of(&own.response, own.terms.iter().map(|t| t.name.as_str())))
            .collect(),
        outcome,
        maps,
        command,
    })
}

/// Contours of values over a grid.
#[utoipa::path(
    post, path = "/api/contours", request_body = GridGiven,
    responses((status = 200, body = ContourMap), RequestProblems))]
pub(crate) async fn contours(
    State(app): State<App>,
    Given(given): Given<GridGiven>,
) -> Answer<ContourMap> {
    let sizes = [given.x.len(), given.y.len()];
    let rising = |places: &[f64]| places.windows(2).all(|pair| pair[0] < pair[1]);
    if sizes
        .iter()
        .any(|size| !(2..=MOST_GRID_POINTS).contains(size))
        || sizes[0] * sizes[1] != given.values.len()
        || !rising(&given.x)
        || !rising(&given.y)
    {
        return Err(Problem::request(format!(
            "a grid has 2 to {MOST_GRID_POINTS} rising coordinates along each side, and a value \
             at each point"
        )));
    }
    app.tell(&contour_map(given.x, given.y, given.values))
}
