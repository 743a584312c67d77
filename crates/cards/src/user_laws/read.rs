//! Laws of the user: `[laws.NAME]` of a campaign.toml or a file of laws.

use crate::user_laws::file::{LawFile, LawParameterFile, LawsFile, OnlyLaws};
use std::path::Path;
use toml::Spanned;
use windfall_contact::laws::define_law::define_law;
use windfall_contact::laws::force_table::ForceTable;
use windfall_contact::laws::kind::LawKind;
use windfall_contact::laws::user::{UserForce, UserLawDefinition, UserParameter};
use windfall_files::error::Error;
use windfall_files::inputs::protect;
use windfall_files::option_value::unusable;
use windfall_files::text::file_quantity::QuantityText;
use windfall_files::text::toml_source::{TomlSource, invalid, parse_source, read_source};
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
    let source = read_source(path, advice)?;
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
    let (force, key, at) = match (&law.force, &law.table, inline) {
        (Some(formula), None, false) => (
            UserForce::Formula(formula.get_ref().clone()),
            "force",
            formula,
        ),
        (None, Some(file), false) => {
            let table = read_table(source, &table, file, directory)?;
            (UserForce::Table(table), "table", file)
        }
        (None, None, true) => {
            let table = ForceTable {
                displacement: law.displacement.clone().unwrap_or_default(),
                force: law.table_force.clone().unwrap_or_default(),
                damping: law.damping.clone(),
            };
            return finished(name, UserForce::Table(table), Vec::new())
                .map_err(|problem| wrong("displacement_m, force_N", problem));
        }
        _ => {
            let problem = "expected one of: force = \"a formula\"; table = \"FILE.csv\"; \
                           displacement_m = […] with force_N = […]";
            return Err(wrong("force", problem.to_owned()));
        }
    };
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
    finished(name, force, parameters)
        .map_err(|problem| invalid(source, &at.span(), (&table, key), at.get_ref(), problem))
}

fn finished(
    name: &str,
    force: UserForce,
    parameters: Vec<UserParameter>,
) -> Result<LawKind, String> {
    let definition = UserLawDefinition {
        name: name.to_owned(),
        force,
        parameters,
    };
    define_law(&definition).map_err(|error| error.to_string())
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

/// Columns of a table's file.
const COLUMNS: [&str; 3] = ["displacement_m", "force_N", "damping_N_s_m"];

fn read_table(
    source: &TomlSource,
    table: &str,
    file: &Spanned<String>,
    directory: &Path,
) -> Result<ForceTable, Error> {
    let path = directory.join(file.get_ref());
    let place = (table, "table");
    let wrong = |problem: String| invalid(source, &file.span(), place, file.get_ref(), problem);
    let shown = path.display();
    let found = std::fs::metadata(&path);
    let found = found.map_err(|error| wrong(format!("{shown} cannot be read: {error}")))?;
    // A device or a pipe may have no end.
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
    for (number, line) in lines {
        let cells: Vec<&str> = line.split(',').collect();
        for (values, column) in values.iter_mut().zip(columns) {
            let Some(column) = column else { continue };
            let cell = cells.get(column).map_or("", |cell| cell.trim());
            values.push(
                cell.parse()
                    .map_err(|_| wrong(format!("line {}: \"{cell}\" is no number", number + 1)))?,
            );
        }
    }
    let [displacement, force, damping] = values;
    Ok(ForceTable {
        displacement,
        force,
        damping: columns[2].map(|_| damping),
    })
}
