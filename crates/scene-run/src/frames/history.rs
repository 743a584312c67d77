//! The contacts of one fruit, and which fruit were hit hardest.

use crate::file_error::{SceneFileError, access};
use csv::{Reader, StringRecord};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::inputs::check_regular;
use windfall_files::table::write::unguarded;

/// Most contacts of a fruit that are listed; the hardest ones where there are more.
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

/// The contacts of one fruit.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FruitHistory {
    /// Its number.
    pub fruit: u64,
    /// Contacts that were written.
    pub contacts: usize,
    /// Those of them that are listed, in the order of time; the hardest where there are many.
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

/// What the contacts of each fruit came to over the whole run, by number from 1.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FruitTotals {
    /// Energy that all contacts of a fruit absorbed; J.
    pub absorbed_energy: Vec<f64>,
    /// Volume of the largest bruise of a fruit, 0 where it has none; m³. Nothing where the scene
    /// has no law of bruises.
    pub largest_bruise: Option<Vec<f64>>,
}

/// A row of events.csv.
#[derive(Deserialize)]
struct EventRow {
    fruit: u64,
    partner: String,
    partner_fruit: Option<u64>,
    time_s: f64,
    duration_s: f64,
    lasting: bool,
    spot_x: f64,
    spot_y: f64,
    spot_z: f64,
    partner_spot_x: f64,
    partner_spot_y: f64,
    partner_spot_z: f64,
    normal_speed_m_s: f64,
    tangential_speed_m_s: f64,
    #[serde(rename = "peak_force_N")]
    peak_force: f64,
    #[serde(rename = "absorbed_energy_J")]
    absorbed_energy: f64,
}

impl EventRow {
    /// The contact as the first or the second of its fruit sees it.
    fn seen_by(self, second: bool) -> ContactView {
        let (partner_fruit, spot) = match second {
            false => (self.partner_fruit, [self.spot_x, self.spot_y, self.spot_z]),
            true => {
                let spot = [
                    self.partner_spot_x,
                    self.partner_spot_y,
                    self.partner_spot_z,
                ];
                (Some(self.fruit), spot)
            }
        };
        ContactView {
            time: self.time_s,
            duration: self.duration_s,
            lasting: self.lasting,
            partner: self.partner,
            partner_fruit,
            spot,
            normal_speed: self.normal_speed_m_s,
            tangential_speed: self.tangential_speed_m_s,
            peak_force: self.peak_force,
            absorbed_energy: self.absorbed_energy,
        }
    }
}

/// A row of fruit.csv.
#[derive(Deserialize)]
struct FruitRow {
    fruit: u64,
    contacts: u64,
    partner_of_it: String,
    #[serde(rename = "largest_peak_force_N")]
    peak_force: Option<f64>,
    time_of_it_s: Option<f64>,
    impact_speed_of_it_m_s: Option<f64>,
    #[serde(rename = "absorbed_energy_J")]
    absorbed_energy: f64,
    bruises: Option<u64>,
    #[serde(rename = "largest_bruise_mm3")]
    largest_bruise: Option<f64>,
}

/// A table that a run wrote, row by row.
struct Table {
    path: PathBuf,
    reader: Reader<File>,
    header: StringRecord,
    row: StringRecord,
}

impl Table {
    fn open(path: PathBuf) -> Result<Self, Error> {
        check_regular(&path)?;
        let file = File::open(&path).map_err(access(&path, "read"))?;
        let mut reader = csv::ReaderBuilder::new();
        let mut reader = reader.comment(Some(b'#')).from_reader(file);
        let header = reader.headers().cloned();
        Ok(Self {
            header: header.map_err(|error| damaged(&path, 1, &error))?,
            path,
            reader,
            row: StringRecord::new(),
        })
    }

    /// Whether there is another row.
    fn next(&mut self) -> Result<bool, Error> {
        let read = self.reader.read_record(&mut self.row);
        let read = read.map_err(|error| damaged(&self.path, self.reader.position().line(), &error));
        if self.row.iter().any(|cell| unguarded(cell) != cell) {
            let place = self.row.position().cloned();
            self.row = self.row.iter().map(unguarded).collect();
            self.row.set_position(place);
        }
        read
    }

    /// Whether the row has this text in a column.
    fn is(&self, column: Option<usize>, text: &str) -> bool {
        column.and_then(|own| self.row.get(own)) == Some(text)
    }

    /// The row.
    fn read<T: DeserializeOwned>(&self) -> Result<T, Error> {
        let line = self.row.position().map_or(0, csv::Position::line);
        let mut cells = self.header.iter().zip(&self.row);
        let endless = |cell: &str| cell.parse().is_ok_and(|number: f64| !number.is_finite());
        let odd = cells.find(|(name, cell)| !name.starts_with("partner") && endless(cell));
        if let Some((name, cell)) = odd {
            return Err(Error::from(SceneFileError::TableDamaged {
                path: self.path.clone(),
                line,
                problem: format!("{cell} in column {name} is no finite number"),
            }));
        }
        let read = self.row.deserialize(Some(&self.header));
        read.map_err(|error| damaged(&self.path, line, &error))
    }
}

fn damaged(path: &Path, line: u64, problem: &csv::Error) -> Error {
    Error::from(SceneFileError::TableDamaged {
        path: path.to_path_buf(),
        line,
        problem: problem.to_string(),
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
    let column = |name| table.header.iter().position(|own| own == name);
    let columns = [column("fruit"), column("partner_fruit")];
    let (mut told, mut contacts) = (Vec::new(), 0);
    let text = fruit.to_string();
    while table.next()? {
        let [first, second] = columns.map(|own| table.is(own, &text));
        if !first && !second {
            continue;
        }
        contacts += 1;
        told.push(table.read::<EventRow>()?.seen_by(second));
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

/// Leaves the hardest where there are many; else all in the order of the table, in which loads
/// that begin at the same step stand.
fn keep_hardest(told: &mut Vec<ContactView>) {
    if told.len() <= MOST {
        return;
    }
    told.sort_by(|a, b| b.peak_force.total_cmp(&a.peak_force));
    told.truncate(MOST);
}

/// The fruit with the largest peak forces, the hardest hit first, from fruit.csv.
pub fn hardest_fruit(directory: &Path, most: usize) -> Result<Vec<HardestFruit>, Error> {
    let mut table = Table::open(directory.join("fruit.csv"))?;
    let mut all = Vec::new();
    while table.next()? {
        let row: FruitRow = table.read()?;
        all.extend(row.peak_force.map(|peak_force| HardestFruit {
            fruit: row.fruit,
            contacts: row.contacts,
            peak_force,
            partner: row.partner_of_it,
            time: row.time_of_it_s,
            impact_speed: row.impact_speed_of_it_m_s,
            absorbed_energy: row.absorbed_energy,
        }));
    }
    all.sort_by(|a, b| b.peak_force.total_cmp(&a.peak_force));
    all.truncate(most);
    Ok(all)
}

/// What the contacts of each fruit came to, from fruit.csv.
///
/// * `count`: fruit in all
///
/// # Errors
/// The table cannot be read, or names a fruit beyond `count`.
pub fn fruit_totals(directory: &Path, count: usize) -> Result<FruitTotals, Error> {
    let mut table = Table::open(directory.join("fruit.csv"))?;
    let mut absorbed_energy = vec![0.0; count];
    let mut bruises = vec![0.0; count];
    let mut bruised = false;
    while table.next()? {
        let row: FruitRow = table.read()?;
        let place = (row.fruit as usize).wrapping_sub(1);
        let fruit = row.fruit;
        if place >= count {
            return Err(Error::from(SceneFileError::FruitUnknown { fruit, count }));
        }
        absorbed_energy[place] = row.absorbed_energy;
        bruises[place] = 1e-9 * row.largest_bruise.unwrap_or(0.0);
        bruised |= row.bruises.is_some();
    }
    Ok(FruitTotals {
        absorbed_energy,
        largest_bruise: bruised.then_some(bruises),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn totals_are_those_of_the_table() {
        let folder = tempfile::tempdir().unwrap();
        let header = "fruit,contacts,partner_of_it,largest_peak_force_N,time_of_it_s,\
                      impact_speed_of_it_m_s,absorbed_energy_J,bruises,largest_bruise_mm3";
        let totals = |rows: &str, count| {
            std::fs::write(folder.path().join("fruit.csv"), format!("{header}\n{rows}")).unwrap();
            fruit_totals(folder.path(), count)
        };
        let found = totals("1,2,floor,40,0.1,1,0.03,1,250\n2,0,,,,,0,0,\n", 2).unwrap();
        assert_eq!(found.absorbed_energy, [0.03, 0.0]);
        assert_eq!(found.largest_bruise, Some(vec![250.0 * 1e-9, 0.0]));
        let plain = totals("1,2,floor,40,0.1,1,0.03,,\n", 1).unwrap();
        assert_eq!(plain.largest_bruise, None);
        let error = totals("3,0,,,,,0,,\n", 2).unwrap_err().to_string();
        assert!(error.contains('3'), "{error}");
        totals("0,0,,,,,0,,\n", 2).unwrap_err();
    }

    /// The column and the line are named; a wall may be called "inf".
    #[test]
    fn rejects_numbers_that_are_not_finite() {
        let folder = tempfile::tempdir().unwrap();
        let header = "fruit,partner,partner_fruit,time_s,duration_s,lasting,spot_x,spot_y,spot_z,\
                      partner_spot_x,partner_spot_y,partner_spot_z,normal_speed_m_s,\
                      tangential_speed_m_s,peak_force_N,absorbed_energy_J";
        let history = |force: &str| {
            let row = format!("1,inf,,0.1,0.002,false,0,0,1,0,0,1,0.5,0,{force},0.01");
            let text = format!("# contacts\n{header}\n{row}\n");
            std::fs::write(folder.path().join("events.csv"), text).unwrap();
            fruit_history(folder.path(), 1, 1)
        };
        assert_eq!(history("12.5").unwrap().told[0].peak_force, 12.5);
        let error = history("NaN").unwrap_err().to_string();
        assert!(
            error.contains("line 3") && error.contains("peak_force_N"),
            "{error}"
        );
    }
}
