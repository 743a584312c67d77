//! Tables of the sensors, which grow with a scene.

use crate::file::key::FRUIT;
use crate::run::growing::{GrowingFile, remove_earlier, take_back};
use crate::run::sensors::flow::Pass;
use crate::run::sensors::probe::{Impact, Sample};
use crate::run::sensors::space::Content;
use std::path::{Path, PathBuf};
use windfall_campaign::settings::rig::STANDARD_GRAVITY;
use windfall_files::error::Error;
use windfall_files::table::write::{csv_cell, number_cell};
use windfall_scene::event::Partner;
use windfall_scene::vector::length;

/// A table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Table {
    Passes,
    Spaces,
    Samples,
    Impacts,
}

/// Each table with its file and its columns.
const TABLES: [(Table, &str, &str); 4] = [
    (
        Table::Passes,
        "sensor_passes.csv",
        "sensor,time_s,fruit,forward,x_m,y_m,z_m,normal_speed_m_s,mass_kg",
    ),
    (
        Table::Spaces,
        "sensor_boxes.csv",
        "sensor,time_s,fruit,mass_kg,level_m,fruit_share",
    ),
    (
        Table::Samples,
        "sensor_probes.csv",
        "sensor,fruit,time_s,x_m_s2,y_m_s2,z_m_s2,magnitude_m_s2",
    ),
    (
        Table::Impacts,
        "sensor_impacts.csv",
        "sensor,fruit,time_s,duration_s,peak_acceleration_m_s2,peak_acceleration_g,\
         velocity_change_m_s,struck,struck_fruit,lasting",
    ),
];

/// The figure and its data.
pub(in crate::run) const FIGURE: [&str; 3] = ["sensors.csv", "sensors.png", "sensors.svg"];

/// How far each table is on the disk; bytes.
pub(in crate::run) type Lengths = [u64; 4];

/// The tables that a scene has.
pub(super) struct SensorTables {
    files: [Option<GrowingFile>; 4],
    /// Names of sensors and of walls, as cells.
    sensors: Vec<String>,
    walls: Vec<String>,
}

impl SensorTables {
    /// Opens the tables that are wanted.
    ///
    /// * `kept`: bytes that a checkpoint counts on; `None` begins anew
    ///
    /// # Errors
    /// A table is shorter than that, or cannot be written.
    pub fn open(
        out: &Path,
        wanted: impl Fn(Table) -> bool,
        [sensors, walls]: [&[&str]; 2],
        kept: Option<Lengths>,
    ) -> Result<Self, Error> {
        let cells = |names: &[&str]| {
            let cells = names.iter().map(|own| csv_cell(own));
            cells.collect::<Result<Vec<String>, Error>>()
        };
        let mut files = [const { None }; 4];
        for (place, (table, name, columns)) in TABLES.into_iter().enumerate() {
            if !wanted(table) {
                continue;
            }
            let path = out.join(name);
            let mut file = match kept {
                Some(kept) => {
                    take_back(&path)?;
                    GrowingFile::check_length(&path, "the table", kept[place])?;
                    let mut file = GrowingFile::open(&path)?;
                    file.cut(kept[place])?;
                    file
                }
                None => {
                    let mut file = GrowingFile::open(&path)?;
                    file.cut(0)?;
                    file.write(format!("{columns}\n"))?;
                    file
                }
            };
            // Whoever watches the run sees the header.
            file.flush()?;
            files[place] = Some(file);
        }
        Ok(Self {
            files,
            sensors: cells(sensors)?,
            walls: cells(walls)?,
        })
    }

    fn write(&mut self, table: Table, row: String) -> Result<(), Error> {
        match &mut self.files[table as usize] {
            Some(file) => file.write(row),
            None => Ok(()),
        }
    }

    /// A row of a pass.
    pub fn pass(&mut self, sensor: usize, own: &Pass) -> Result<(), Error> {
        let [x, y, z] = own.place;
        let row = format!(
            "{},{},{},{},{x},{y},{z},{},{}\n",
            self.sensors[sensor],
            own.time,
            own.fruit + 1,
            own.forward,
            own.speed,
            own.mass
        );
        self.write(Table::Passes, row)
    }

    /// A row of what is in a box.
    pub fn content(&mut self, sensor: usize, time: f64, own: &Content) -> Result<(), Error> {
        let row = format!(
            "{},{time},{},{},{},{}\n",
            self.sensors[sensor],
            own.fruit,
            own.mass,
            number_cell(own.level),
            own.share
        );
        self.write(Table::Spaces, row)
    }

    /// A row of a sample.
    pub fn sample(&mut self, sensor: usize, own: &Sample) -> Result<(), Error> {
        let [x, y, z] = own.acceleration;
        let row = format!(
            "{},{},{},{x},{y},{z},{}\n",
            self.sensors[sensor],
            own.fruit + 1,
            own.time,
            length(own.acceleration)
        );
        self.write(Table::Samples, row)
    }

    /// A row of an impact.
    pub fn impact(&mut self, sensor: usize, own: &Impact) -> Result<(), Error> {
        let (struck, number) = match own.struck {
            None => ("", String::new()),
            Some(Partner::Fruit(other)) => (FRUIT, (other + 1).to_string()),
            Some(Partner::Wall(wall)) => (self.walls[wall as usize].as_str(), String::new()),
        };
        let row = format!(
            "{},{},{},{},{},{},{},{struck},{number},{}\n",
            self.sensors[sensor],
            own.fruit + 1,
            own.time,
            own.duration,
            own.peak,
            own.peak / STANDARD_GRAVITY,
            own.change,
            own.lasting
        );
        self.write(Table::Impacts, row)
    }

    /// Brings all rows so far to the disk.
    pub fn sync(&mut self) -> Result<Lengths, Error> {
        let mut lengths = [0; 4];
        for (length, file) in lengths.iter_mut().zip(&mut self.files) {
            if let Some(file) = file {
                *length = file.sync()?;
            }
        }
        Ok(lengths)
    }

    /// Whether the rows so far stay where the tables are not finished.
    pub fn keep(&mut self, keep: bool) {
        let files = self.files.iter_mut().flatten();
        files.for_each(|file| file.keep = keep);
    }

    /// Gives the tables their names; which they are. Those of an earlier run go where this one
    /// has none.
    pub fn finish(&mut self, out: &Path) -> Result<Vec<PathBuf>, Error> {
        let mut written = Vec::new();
        for (file, (_, name, _)) in self.files.iter_mut().zip(TABLES) {
            match file {
                Some(file) => written.push(file.finish()?),
                None => remove_earlier(&out.join(name))?,
            }
        }
        Ok(written)
    }
}
