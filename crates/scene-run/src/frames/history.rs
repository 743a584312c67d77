//! What one fruit went through, and which were hit hardest.

use crate::file_error::SceneFileError;
use csv::{Reader, StringRecord};
use serde::Serialize;
use std::fs::File;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;

/// Most contacts of a fruit that are told; the hardest ones where there are more.
const MOST: usize = 2000;

/// A contact of a fruit.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ContactView {
    /// First touch; s.
    pub time: f64,
    /// How long it lasted; s.
    pub duration: f64,
    /// Whether it was still there when the scene ended.
    pub lasting: bool,
    /// The wall, or "fruit".
    pub partner: String,
    /// Number of the other fruit.
    pub partner_fruit: Option<u64>,
    /// Where on this fruit: direction from its centre, fixed to it.
    #[schema(value_type = (f64, f64, f64))]
    pub spot: [f64; 3],
    /// Normal speed at first touch; m/s.
    pub normal_speed: f64,
    /// Tangential speed at first touch; m/s.
    pub tangential_speed: f64,
    /// Largest normal force; N.
    pub peak_force: f64,
    /// Energy that the normal contact kept; J.
    pub absorbed_energy: f64,
}

/// What one fruit went through.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FruitHistory {
    /// Its number.
    pub fruit: u64,
    /// Contacts that were written.
    pub contacts: usize,
    /// Those of them that are told, in the order of time; the hardest where there are many.
    pub told: Vec<ContactView>,
}

/// A fruit in the list of those that were hit hardest.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct HardestFruit {
    /// Its number.
    pub fruit: u64,
    /// Contacts.
    pub contacts: u64,
    /// Largest peak force of a contact; N.
    pub peak_force: f64,
    /// What it touched then.
    pub partner: String,
    /// When; s.
    pub time: Option<f64>,
    /// Impact speed then; m/s.
    pub impact_speed: Option<f64>,
    /// Energy that all its contacts absorbed; J.
    pub absorbed_energy: f64,
}

/// A table whose columns are known by their names.
struct Table {
    path: PathBuf,
    reader: Reader<File>,
    header: StringRecord,
    row: StringRecord,
}

impl Table {
    fn open(path: PathBuf) -> Result<Self, Error> {
        let file = File::open(&path).map_err(|source| Error::FileAccess {
            path: path.clone(),
            action: "read",
            source,
        })?;
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .from_reader(file);
        let header = reader.headers().cloned();
        let header = header.map_err(|error| damaged(&path, 1, error.to_string()))?;
        Ok(Self {
            path,
            reader,
            header,
            row: StringRecord::new(),
        })
    }

    /// The number of a column.
    fn column(&self, name: &str) -> Result<usize, Error> {
        let found = self.header.iter().position(|own| own == name);
        found.ok_or_else(|| damaged(&self.path, 1, format!("there is no column {name}")))
    }

    /// Whether there is another row.
    fn next(&mut self) -> Result<bool, Error> {
        let read = self.reader.read_record(&mut self.row);
        read.map_err(|error| damaged(&self.path, self.reader.position().line(), error.to_string()))
    }

    fn cell(&self, column: usize) -> &str {
        self.row.get(column).unwrap_or_default()
    }

    /// A number, or nothing where the cell is blank.
    fn optional(&self, column: usize) -> Result<Option<f64>, Error> {
        match self.cell(column) {
            "" => Ok(None),
            _ => self.number(column).map(Some),
        }
    }

    fn number(&self, column: usize) -> Result<f64, Error> {
        let number = self
            .cell(column)
            .parse()
            .ok()
            .filter(|own: &f64| own.is_finite());
        number.ok_or_else(|| self.no_number(column))
    }

    fn whole(&self, column: usize) -> Result<u64, Error> {
        let number = self.cell(column).parse().ok();
        number.ok_or_else(|| self.no_number(column))
    }

    fn no_number(&self, column: usize) -> Error {
        let name = self.header.get(column).unwrap_or_default();
        let line = self.row.position().map_or(0, csv::Position::line);
        damaged(
            &self.path,
            line,
            format!("{name} is no number: \"{}\"", self.cell(column)),
        )
    }
}

fn damaged(path: &Path, line: u64, problem: String) -> Error {
    Error::from(SceneFileError::TableDamaged {
        path: path.to_path_buf(),
        line,
        problem,
    })
}

/// The contacts of one fruit, from events.csv; the memory it takes does not grow with the
/// table.
///
/// * `fruit`: its number, from 1
///
/// # Errors
/// The table cannot be read, or there is no such fruit.
pub fn fruit_history(directory: &Path, fruit: u64, count: usize) -> Result<FruitHistory, Error> {
    if fruit == 0 || fruit > count as u64 {
        return Err(Error::from(SceneFileError::FruitUnknown { fruit, count }));
    }
    let mut table = Table::open(directory.join("events.csv"))?;
    let columns = EventColumns::of(&table)?;
    let (mut told, mut contacts) = (Vec::new(), 0);
    let text = fruit.to_string();
    while table.next()? {
        let second = table.cell(columns.partner_fruit) == text;
        if !second && table.cell(columns.fruit) != text {
            continue;
        }
        contacts += 1;
        told.push(columns.contact(&table, second)?);
        if told.len() >= 2 * MOST {
            keep_hardest(&mut told);
        }
    }
    keep_hardest(&mut told);
    told.sort_by(|a, b| a.time.total_cmp(&b.time));
    Ok(FruitHistory {
        fruit,
        contacts,
        told,
    })
}

fn keep_hardest(told: &mut Vec<ContactView>) {
    told.sort_by(|a, b| b.peak_force.total_cmp(&a.peak_force));
    told.truncate(MOST);
}

/// Where what is told stands in events.csv.
struct EventColumns {
    fruit: usize,
    partner: usize,
    partner_fruit: usize,
    time: usize,
    duration: usize,
    lasting: usize,
    spots: [[usize; 3]; 2],
    normal_speed: usize,
    tangential_speed: usize,
    peak_force: usize,
    absorbed_energy: usize,
}

impl EventColumns {
    fn of(table: &Table) -> Result<Self, Error> {
        let own = |name| table.column(name);
        Ok(Self {
            fruit: own("fruit")?,
            partner: own("partner")?,
            partner_fruit: own("partner_fruit")?,
            time: own("time_s")?,
            duration: own("duration_s")?,
            lasting: own("lasting")?,
            spots: [
                [own("spot_x")?, own("spot_y")?, own("spot_z")?],
                [
                    own("partner_spot_x")?,
                    own("partner_spot_y")?,
                    own("partner_spot_z")?,
                ],
            ],
            normal_speed: own("normal_speed_m_s")?,
            tangential_speed: own("tangential_speed_m_s")?,
            peak_force: own("peak_force_N")?,
            absorbed_energy: own("absorbed_energy_J")?,
        })
    }

    /// The contact of a row, as the first or the second of its fruit sees it.
    fn contact(&self, table: &Table, second: bool) -> Result<ContactView, Error> {
        let other = if second {
            self.fruit
        } else {
            self.partner_fruit
        };
        let [x, y, z] = self.spots[usize::from(second)];
        Ok(ContactView {
            time: table.number(self.time)?,
            duration: table.number(self.duration)?,
            lasting: table.cell(self.lasting) == "true",
            partner: table.cell(self.partner).to_owned(),
            partner_fruit: match table.cell(other) {
                "" => None,
                _ => Some(table.whole(other)?),
            },
            spot: [table.number(x)?, table.number(y)?, table.number(z)?],
            normal_speed: table.number(self.normal_speed)?,
            tangential_speed: table.number(self.tangential_speed)?,
            peak_force: table.number(self.peak_force)?,
            absorbed_energy: table.number(self.absorbed_energy)?,
        })
    }
}

/// The fruit with the largest peak forces, the hardest hit first, from fruit.csv.
///
/// # Errors
/// The table cannot be read.
pub fn hardest_fruit(directory: &Path, most: usize) -> Result<Vec<HardestFruit>, Error> {
    let mut table = Table::open(directory.join("fruit.csv"))?;
    let own = |name| table.column(name);
    let (fruit, contacts, partner) = (own("fruit")?, own("contacts")?, own("partner_of_it")?);
    let (force, time) = (own("largest_peak_force_N")?, own("time_of_it_s")?);
    let (speed, absorbed) = (own("impact_speed_of_it_m_s")?, own("absorbed_energy_J")?);
    let mut all = Vec::new();
    while table.next()? {
        let Some(peak_force) = table.optional(force)? else {
            continue;
        };
        all.push(HardestFruit {
            fruit: table.whole(fruit)?,
            contacts: table.whole(contacts)?,
            peak_force,
            partner: table.cell(partner).to_owned(),
            time: table.optional(time)?,
            impact_speed: table.optional(speed)?,
            absorbed_energy: table.number(absorbed)?,
        });
    }
    all.sort_by(|a, b| b.peak_force.total_cmp(&a.peak_force));
    all.truncate(most);
    Ok(all)
}
