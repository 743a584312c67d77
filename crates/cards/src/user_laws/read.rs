//! Laws of the user: `[laws.NAME]` of a campaign.toml or a file of laws.

use crate::user_laws::file::{LawFile, LawParameterFile, LawsFile, OnlyLaws};
use std::path::{Path, PathBuf};
use windfall_contact::formula::error::FormulaError;
use windfall_contact::laws::define_law::define_law;
use windfall_contact::laws::force_table::{COLUMNS, ForceTable};
use windfall_contact::laws::kind::LawKind;
use windfall_contact::laws::user::{UserForce, UserLawDefinition, UserParameter};
use windfall_files::confined::named_file;
use windfall_files::error::{Error, Place};
use windfall_files::inputs::protect;
use windfall_files::option_value::unusable;
use windfall_files::text::file_quantity::QuantityText;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_places::invalid_at;
use windfall_files::text::toml_source::{TomlSource, invalid, parse_source, read_piped_source};
use windfall_numerics::unit::quantity::parse_as;

/// The laws of `--laws FILE`; none without a file.
///
/// # Errors
/// The file cannot be read, holds no law, or a law cannot be used.
pub fn laws_of_option(file: Option<&Path>) -> Result<Vec<LawKind>, Error> {
    file.map_or_else(|| Ok(Vec::new()), read_laws)
}

/// The laws of a file of laws, or of a campaign.toml.
///
/// # Errors
/// The file cannot be read, holds no law, or a law cannot be used.
pub fn read_laws(path: &Path) -> Result<Vec<LawKind>, Error> {
    let advice = "a file of laws holds tables such as [laws.my-law] with force = \"k*x^1.5\"";
    let source = read_piped_source(path, advice)?;
    let file: OnlyLaws = parse_source(&source)?;
    if file.laws.is_empty() {
        let problem = "it holds no law: write tables such as [laws.my-law] with \
                       force = \"k*x^1.5\" and parameters.k = { unit = \"N/m^1.5\", start = 4e5 }";
        return Err(unusable(format!("--laws {}", path.display()), problem));
    }
    let directory = path.parent().unwrap_or(Path::new("."));
    user_laws(&source, &file.laws, directory)
}

/// The laws of tables.
///
/// * `directory`: of the files of tables
///
/// # Errors
/// A law cannot be used; the message names file, line and what is wrong.
pub fn user_laws(
    source: &TomlSource,
    laws: &LawsFile,
    directory: &Path,
) -> Result<Vec<LawKind>, Error> {
    let mut ordered: Vec<(&String, &Spanned<LawFile>)> = laws.iter().collect();
    ordered.sort_by_key(|(_, law)| law.span().start);
    ordered
        .into_iter()
        .map(|(name, law)| user_law(source, name, law, directory))
        .collect()
}

fn user_law(
    source: &TomlSource,
    name: &str,
    file: &Spanned<LawFile>,
    directory: &Path,
) -> Result<LawKind, Error> {
    let law = file.get_ref();
    let table = format!("[laws.{name}]");
    let wrong =
        |key: &str, problem: String| invalid(source, &file.span(), (&table, key), name, problem);
    let inline = law.displacement.is_some() || law.table_force.is_some();
    let mut lines = None;
    let (force, key) = match (&law.force, &law.table, inline) {
        (Some(formula), None, false) => {
            let force = formula.get_ref().clone();
            let own = match &law.unloading {
                None => UserForce::Formula(force),
                Some(unloading) => UserForce::WithMemory {
                    force,
                    unloading: unloading.get_ref().clone(),
                },
            };
            (own, "force")
        }
        (None, Some(file), false) => {
            let (own, found) = read_table(source, &table, file, directory)?;
            lines = Some(found);
            (UserForce::Table(own), "table")
        }
        (None, None, true) => {
            let own = ForceTable {
                displacement: law.displacement.clone().unwrap_or_default(),
                force: law.table_force.clone().unwrap_or_default(),
                damping: law.damping.clone(),
            };
            (UserForce::Table(own), "displacement_m")
        }
        (Some(_), Some(file), _) => {
            let problem = "`force` is given too; keep one of them".to_owned();
            let key = (table.as_str(), "table");
            return Err(invalid(source, &file.span(), key, file.get_ref(), problem));
        }
        _ => {
            let problem = "expected one of: force = \"a formula\"; table = \"FILE.csv\"; \
                           displacement_m = […] with force_N = […]";
            return Err(wrong("force", problem.to_owned()));
        }
    };
    if let (Some(unloading), true) = (&law.unloading, key != "force") {
        let problem = "unloading belongs to a formula `force`; a table has no memory".to_owned();
        let key = (table.as_str(), "unloading");
        return Err(invalid(
            source,
            &unloading.span(),
            key,
            unloading.get_ref(),
            problem,
        ));
    }
    if key == "table" && !law.parameters.is_empty() {
        let problem = "a table has the parameters scale and damping_scale and no others";
        return Err(wrong("parameters", problem.to_owned()));
    }
    let mut parameters: Vec<(&String, &Spanned<LawParameterFile>)> =
        law.parameters.iter().collect();
    parameters.sort_by_key(|(_, parameter)| parameter.span().start);
    let parameters = parameters
        .into_iter()
        .map(|(parameter, file)| user_parameter(source, &table, parameter, file.get_ref()))
        .collect::<Result<Vec<_>, _>>()?;
    let definition = UserLawDefinition {
        name: name.to_owned(),
        force,
        parameters,
    };
    define_law(&definition).map_err(|error| placed(source, (name, key), lines.as_ref(), &error))
}

/// The error of a definition, at the value that is to blame.
///
/// * `key`: what says the force
/// * `lines`: of the rows, where they are in a file of their own
fn placed(
    source: &TomlSource,
    (law, key): (&str, &str),
    lines: Option<&(PathBuf, Vec<usize>)>,
    error: &windfall_contact::error::Error,
) -> Error {
    let problem = error.to_string();
    let windfall_contact::error::Error::UserLaw { problem: of, .. } = error else {
        return invalid_at(source, &["laws", law, key], problem);
    };
    let key = match **of {
        FormulaError::Unloading(_) => "unloading",
        _ => key,
    };
    match (of.parameter(), of.cell(), lines) {
        (Some((parameter, "")), ..) => {
            invalid_at(source, &["laws", law, "parameters", parameter], problem)
        }
        (Some((parameter, what)), ..) => {
            let keys = ["laws", law, "parameters", parameter, what];
            invalid_at(source, &keys, problem)
        }
        (None, Some((row, column)), Some((file, lines))) => {
            let line = row.and_then(|row| lines.get(row)).copied();
            Error::Refused {
                place: Place::at(file, line.unwrap_or(0)),
                problem: format!("{column}: {problem}"),
            }
        }
        (None, Some((row, column)), None) => {
            let row = row.unwrap_or(0).to_string();
            invalid_at(source, &["laws", law, column, &row], problem)
        }
        _ => invalid_at(source, &["laws", law, key], problem),
    }
}

fn user_parameter(
    source: &TomlSource,
    table: &str,
    name: &str,
    file: &LawParameterFile,
) -> Result<UserParameter, Error> {
    let unit = file.unit.get_ref();
    let value = |key: &str, value: Option<&Spanned<QuantityText>>| {
        let Some(value) = value else { return Ok(None) };
        let text = &value.get_ref().0;
        let number: Result<f64, _> = text.trim().parse();
        let found = number.or_else(|_| parse_as(text, unit).map_err(|error| error.to_string()));
        found.map(Some).map_err(|problem| {
            let key = format!("parameters.{name}.{key}");
            invalid(source, &value.span(), (table, &key), text, problem)
        })
    };
    Ok(UserParameter {
        name: name.to_owned(),
        unit: unit.clone(),
        meaning: file.meaning.clone(),
        lower: value("lower", file.lower.as_ref())?.unwrap_or(0.0),
        upper: value("upper", file.upper.as_ref())?.unwrap_or(f64::INFINITY),
        start: value("start", file.start.as_ref())?,
        default: value("default", file.default.as_ref())?,
    })
}

/// Largest file of a table of forces; bytes.
const LARGEST_TABLE: u64 = 10_000_000;

/// A table of forces, with its file and the lines of its rows.
type ReadTable = (ForceTable, (PathBuf, Vec<usize>));

fn read_table(
    source: &TomlSource,
    table: &str,
    file: &Spanned<String>,
    directory: &Path,
) -> Result<ReadTable, Error> {
    let place = (table, "table");
    let wrong = |problem: String| invalid(source, &file.span(), place, file.get_ref(), problem);
    let path = named_file(directory, file.get_ref(), directory).map_err(wrong)?;
    let shown = path.display();
    let found = std::fs::metadata(&path);
    let found = found.map_err(|error| wrong(format!("{shown} cannot be read: {error}")))?;
    if !found.is_file() {
        return Err(wrong(format!("{shown} is not a regular file")));
    }
    if found.len() > LARGEST_TABLE {
        let size = found.len();
        return Err(wrong(format!(
            "{shown} has {size} bytes; a table of forces has at most {LARGEST_TABLE}"
        )));
    }
    protect(&path);
    let text = std::fs::read_to_string(&path)
        .map_err(|error| wrong(format!("{shown} cannot be read: {error}")))?;
    let mut lines = text.lines().enumerate().filter(|(_, line)| {
        let line = line.trim();
        !(line.is_empty() || line.starts_with('#'))
    });
    let first = lines.next().map_or("", |(_, line)| line);
    let first = first.trim_start_matches('\u{feff}').split(',');
    let header: Vec<&str> = first.map(str::trim).collect();
    let place = |name: &str| header.iter().position(|column| *column == name);
    let (Some(x), Some(force)) = (place(COLUMNS[0]), place(COLUMNS[1])) else {
        let [x, force, damping] = COLUMNS;
        return Err(wrong(format!(
            "expected a CSV file whose first line names the columns {x}, {force} and, if there is \
             damping, {damping}; found {}",
            header.join(", ")
        )));
    };
    let columns = [Some(x), Some(force), place(COLUMNS[2])];
    let mut values: [Vec<f64>; 3] = Default::default();
    let mut rows = Vec::new();
    for (number, line) in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let places = columns.iter().zip(COLUMNS);
        for (values, (column, name)) in values.iter_mut().zip(places) {
            let Some(column) = *column else { continue };
            let cell = cells.get(column).map_or("", |cell| cell.trim());
            values.push(cell.parse().map_err(|_| Error::Refused {
                place: Place::at(&path, number + 1),
                problem: format!("{name} = \"{cell}\" is no number"),
            })?);
        }
        rows.push(number + 1);
    }
    let [displacement, force, damping] = values;
    let table = ForceTable {
        displacement,
        force,
        damping: columns[2].map(|_| damping),
    };
    Ok((table, (path, rows)))
}
