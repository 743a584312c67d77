//! Intervals between impacts as people write them down: tables, or options of a command.

use crate::intervals::estimate::TimedDrop;
use crate::intervals::request::BouncesRequest;
use windfall_files::error::{Error, Place};
use windfall_files::name::Name;
use windfall_files::option_value::unusable;
use windfall_files::table::csv::{Row, Table, read_table};
use windfall_files::table::data::{EXCLUDE_COLUMN, MISSING, excludes};
use windfall_files::text::cell_quantity::cell_quantity;
use windfall_files::text::column_role::unit_of;
use windfall_files::text::column_title::column_title;
use windfall_numerics::unit::quantity::{parse_as, parse_unit};

/// A drop as it was written down.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenDrop {
    /// Its impacts.
    pub drop: TimedDrop,
    /// Where it stands, for messages.
    pub place: String,
    /// Other columns of its row, with their cells.
    pub labels: Vec<(Name, String)>,
    /// Whether the column `exclude` leaves it out.
    pub excluded: bool,
}

/// All drops of a request.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Written {
    /// The drops.
    pub drops: Vec<WrittenDrop>,
    /// Smallest step in which an interval is written; s.
    pub step: f64,
    /// Intervals of zero, which are read as missing.
    pub zeros: usize,
}

/// Names of columns that name a drop.
const NAMES: [&str; 6] = ["drop", "id", "name", "run", "trial", "file"];

/// Parts of names of times that are no intervals.
const INSTANTS: [&str; 5] = ["event", "start", "stop", "clock", "date"];

/// Reads the drops of a request.
///
/// # Errors
/// A table cannot be read or holds no intervals; a cell or an option is no time.
pub fn read_drops(request: &BouncesRequest) -> Result<Written, Error> {
    let mut written = Written {
        step: f64::INFINITY,
        ..Written::default()
    };
    for (place, text) in request.intervals.iter().enumerate() {
        let name = format!("drop {}", place + 1);
        let intervals = typed_intervals(text, &mut written)?;
        written.push(&name, "--intervals", None, intervals);
    }
    for path in &request.tables {
        let table = read_table(path)?;
        let columns = interval_columns(&table)?;
        let stem = path.file_stem().map(|own| own.to_string_lossy());
        let several = request.tables.len() > 1;
        let source = stem.filter(|_| several || request.each_column);
        let source = source.as_deref().unwrap_or_default();
        match request.each_column {
            true => columns_of_drops(&table, &columns, source, &mut written)?,
            false => rows_of_drops(&table, &columns, source, &mut written)?,
        }
    }
    Ok(written)
}

impl Written {
    fn push(&mut self, name: &str, place: &str, height: Option<f64>, times: Vec<Option<f64>>) {
        let mut intervals = times;
        while intervals.last().is_some_and(Option::is_none) {
            intervals.pop();
        }
        self.drops.push(WrittenDrop {
            drop: TimedDrop {
                name: name.to_owned(),
                height,
                intervals,
            },
            place: place.to_owned(),
            labels: Vec::new(),
            excluded: false,
        });
    }

    /// An interval as it is written, in s; `None` where there is none.
    fn interval(&mut self, text: &str, unit: f64) -> Result<Option<f64>, &'static str> {
        let text = text.trim();
        if matches!(text, "" | "-" | MISSING) || text.eq_ignore_ascii_case("nan") {
            return Ok(None);
        }
        let point = match text.contains('.') {
            true => text.to_owned(),
            false => text.replacen(',', ".", 1),
        };
        match point.parse::<f64>() {
            Ok(0.0) => {
                self.zeros += 1;
                Ok(None)
            }
            Ok(value) if value > 0.0 && value * unit < 1e6 => {
                self.step = self.step.min(unit * last_digit(&point));
                Ok(Some(value * unit))
            }
            Ok(value) if value < 0.0 => Err("an interval cannot be negative"),
            _ => Err("this is no time between two impacts"),
        }
    }
}

/// One unit of the last digit of a number: 0.001 for "0.412", 0.1 for "41.2e0".
fn last_digit(text: &str) -> f64 {
    let (digits, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, after)| after.len());
    let exponent: i32 = exponent.parse().unwrap_or(0);
    10f64.powi(exponent - decimals as i32)
}

/// "0.547, 0.412, 0.314 s" or "547 412 314 ms".
fn typed_intervals(text: &str, written: &mut Written) -> Result<Vec<Option<f64>>, Error> {
    let option = || format!("--intervals '{text}'");
    let example = "write them as '0.547, 0.412, 0.314 s'";
    let text_of_times = text
        .trim()
        .trim_end_matches(|c: char| c.is_alphabetic() || c == 'µ');
    let unit = &text.trim()[text_of_times.len()..];
    // A bare number would be seconds, which "547, 412" is not.
    let scale = parse_as(&format!("1 {unit}"), "s").ok();
    let Some(scale) = scale.filter(|_| !unit.is_empty()) else {
        let found = match unit {
            "" => "the unit is missing".to_owned(),
            _ => format!("\"{unit}\" is no unit of time"),
        };
        return Err(unusable(option(), format!("{found}; {example}")));
    };
    // Between semicolons a comma is the decimal mark.
    let between: &[char] = match text.contains(';') {
        true => &[';'],
        false => &[',', ' '],
    };
    let times = text_of_times.split(between).map(str::trim);
    let times = times.filter(|own| !own.is_empty()).map(|own| {
        let found = written.interval(own, scale);
        found.map_err(|problem| unusable(option(), format!("\"{own}\": {problem}; {example}")))
    });
    times.collect()
}

/// Places of the columns that hold intervals, with their units in s.
fn interval_columns(table: &Table) -> Result<Vec<(usize, f64)>, Error> {
    let timed: Vec<(usize, f64)> = table
        .columns
        .iter()
        .enumerate()
        .filter_map(|(place, name)| {
            let unit = unit_of(name).or_else(|| Some(column_title(name).1))?;
            let unit = parse_unit(&unit).ok()?;
            let second = parse_unit("s").ok()?;
            let matches = unit.dimension.matches(&second.dimension);
            matches.then(|| (place, unit.si_from(1.0)))
        })
        .collect();
    let lower = |place: usize| table.columns[place].to_lowercase();
    let named = |own: &&(usize, f64)| lower(own.0).contains("interv");
    let own: Vec<(usize, f64)> = match timed.iter().any(|own| named(&own)) {
        true => timed.iter().filter(named).copied().collect(),
        false => {
            let instant = |name: &str| INSTANTS.iter().any(|part| name.contains(part));
            let found = timed.iter().filter(|own| !instant(&lower(own.0)));
            found.copied().collect()
        }
    };
    match own.is_empty() {
        true => Err(Error::Refused {
            place: Place::at(&table.path, 1),
            problem: format!(
                "no column of intervals: the name of each must end with its unit of time, such as \
                 t1_ms or \"Interval 1 (s)\"; found {}",
                table.columns.join(", ")
            ),
        }),
        false => Ok(own),
    }
}

/// Each row is a drop.
fn rows_of_drops(
    table: &Table,
    columns: &[(usize, f64)],
    source: &str,
    written: &mut Written,
) -> Result<(), Error> {
    let named = |wanted: &str| {
        let mut names = table.columns.iter();
        names.position(|name| name.eq_ignore_ascii_case(wanted))
    };
    let name_column = NAMES.iter().find_map(|wanted| named(wanted));
    for row in &table.rows {
        let place = Place::at(&table.path, row.line);
        let mut intervals = Vec::new();
        for (column, unit) in columns {
            intervals.push(cell_interval(table, row, *column, *unit, written)?);
        }
        let names = table.columns.iter().map(Name::from);
        let pairs = names.zip(row.cells.iter().cloned());
        let cells: Vec<(Name, String)> = pairs.collect();
        let height = cell_quantity(&cells, "drop_height", "m", &place)?;
        let height = match height {
            Some(height) => Some(height),
            None => cell_quantity(&cells, "height", "m", &place)?,
        };
        let own = match name_column.map(|column| row.cells[column].as_str()) {
            Some(name) if !name.is_empty() => name.to_owned(),
            _ => format!("line {}", row.line),
        };
        let name = match source.is_empty() {
            true => own,
            false => format!("{source}: {own}"),
        };
        written.push(&name, &place.to_string(), height, intervals);
        let labels = cells.iter().enumerate().filter(|(column, (name, _))| {
            let interval = columns.iter().any(|(other, _)| other == column);
            !interval && Some(*column) != name_column && !name.is_empty()
        });
        if let Some(last) = written.drops.last_mut() {
            last.labels = labels.map(|(_, own)| own.clone()).collect();
            let excluded = |(name, cell): &(Name, String)| name == EXCLUDE_COLUMN && excludes(cell);
            last.excluded = cells.iter().any(excluded);
        }
    }
    Ok(())
}

/// Each column is a drop.
fn columns_of_drops(
    table: &Table,
    columns: &[(usize, f64)],
    source: &str,
    written: &mut Written,
) -> Result<(), Error> {
    for (column, unit) in columns {
        let mut intervals = Vec::new();
        for row in &table.rows {
            intervals.push(cell_interval(table, row, *column, *unit, written)?);
        }
        let name = match columns.len() {
            1 => source.to_owned(),
            _ => format!("{source}: {}", table.columns[*column]),
        };
        let place = format!(
            "{}, column \"{}\"",
            table.path.display(),
            table.columns[*column]
        );
        written.push(&name, &place, None, intervals);
    }
    Ok(())
}

fn cell_interval(
    table: &Table,
    row: &Row,
    column: usize,
    unit: f64,
    written: &mut Written,
) -> Result<Option<f64>, Error> {
    let text = &row.cells[column];
    written.interval(text, unit).map_err(|problem| {
        let name = &table.columns[column];
        Error::Refused {
            place: Place::at(&table.path, row.line),
            problem: format!(
                "column \"{name}\": \"{text}\": {problem}; leave the cell blank where an impact \
                 was not noticed"
            ),
        }
    })
}
