//! Which engine is installed, what it can do, and how it runs on several ranks.

use crate::deck::LOG;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::Arc;
use windfall_files::error::Error;
use windfall_files::scratch::Scratch;
use windfall_scene_run::file::engine_kind::Engine;

/// An engine that is installed.
#[derive(Clone, Debug)]
pub struct Program {
    /// Which.
    pub engine: Engine,
    /// The program.
    pub path: PathBuf,
    /// Its version, as it says it.
    pub version: String,
    /// The MPI it was built with, as it says it; empty where it does not.
    pub mpi: String,
    /// What it prints of itself.
    help: String,
    /// Where it and its launcher put what does not last.
    pub(crate) scratch: Arc<Scratch>,
}

/// A way to start an engine.
#[derive(Clone, Debug)]
pub struct Launch {
    /// Program and arguments before those of the engine.
    pub command: Vec<String>,
    /// What is shown to people.
    pub name: String,
}

/// Names the folder for temporary files to programs: Open MPI's stay where they are killed.
const TEMPORARY: &str = "TMPDIR";
/// Names under which engines are installed.
const LAMMPS_NAMES: [&str; 3] = ["lmp", "lmp_mpi", "lammps"];
const LIGGGHTS_NAMES: [&str; 2] = ["liggghts", "lmp_liggghts"];
/// Programs that start ranks.
const LAUNCHERS: [&str; 6] = [
    "mpirun",
    "mpiexec",
    "mpirun.openmpi",
    "mpiexec.openmpi",
    "mpirun.mpich",
    "mpiexec.hydra",
];
/// The oldest LAMMPS whose granular styles end a contact at zero force: year, month, day.
const OLDEST: [u32; 3] = [2021, 9, 29];
/// What decks for LAMMPS use.
const STYLES: [&str; 5] = [
    "granular",
    "wall/gran/region",
    "property/atom",
    "nve/sphere",
    "evaporate",
];

/// Finds an engine and asks what it is.
///
/// * `given`: the program, where it is not on the path under its own name
///
/// # Errors
/// It is absent, or is another program, or too old, or lacks what scenes need.
pub fn find_program(engine: Engine, given: Option<&Path>) -> Result<Program, Error> {
    let wrong = |problem: String| wrong(engine, problem);
    let names = match engine {
        Engine::Liggghts => &LIGGGHTS_NAMES[..],
        _ => &LAMMPS_NAMES[..],
    };
    let path = match given {
        Some(path) => path.to_path_buf(),
        None => names.iter().find_map(|name| on_path(name)).ok_or_else(|| {
            wrong(format!(
                "it is not installed: there is no {} on PATH. On Debian and Ubuntu: apt install {}; \
                 or say where it is with --engine-program",
                names.join(" or "),
                match engine {
                    Engine::Liggghts => "liggghts",
                    _ => "lammps openmpi-bin",
                }
            ))
        })?,
    };
    let scratch = Scratch::temporary()?;
    let mut command = Command::new(&path);
    command.env(TEMPORARY, scratch.path());
    if engine == Engine::Liggghts {
        // It would leave a log where the user stands.
        command.args(["-log", "none"]);
    }
    let output = command
        .arg("-h")
        .stdin(Stdio::null())
        .output()
        .map_err(|error| wrong(format!("{} does not start: {error}", path.display())))?;
    let help = text_of(&output);
    let sign = match engine {
        Engine::Liggghts => "LIGGGHTS",
        _ => "Large-scale Atomic/Molecular Massively Parallel Simulator",
    };
    let Some(line) = help.lines().find(|line| line.contains(sign)) else {
        return Err(wrong(format!(
            "{} does not say that it is {}: {}",
            path.display(),
            engine.title(),
            last_lines(&help)
        )));
    };
    let line = line.trim();
    let version = match engine {
        Engine::Liggghts => line.trim_matches(['(', ')']).to_owned(),
        _ => line
            .rsplit_once("Simulator - ")
            .map_or(line, |(_, own)| own)
            .to_owned(),
    };
    let mpi = help.lines().find_map(|line| line.strip_prefix("MPI v"));
    let mpi = mpi.map_or(String::new(), |own| {
        own.split(", package").next().unwrap_or(own).to_owned()
    });
    let program = Program {
        engine,
        path,
        version,
        mpi,
        help,
        scratch: Arc::new(scratch),
    };
    if engine == Engine::Lammps {
        program.suits()?;
    }
    Ok(program)
}

impl Program {
    /// Its version as one number of year, month and day, as LAMMPS's library says it.
    pub fn date(&self) -> Option<u32> {
        date_of(&self.version).map(|[year, month, day]| (year * 100 + month) * 100 + day)
    }

    /// Whether this LAMMPS is new enough and has the styles of decks.
    fn suits(&self) -> Result<(), Error> {
        if date_of(&self.version).is_none_or(|date| date < OLDEST) {
            let problem = format!(
                "{} is version {}; scenes need 29 Sep 2021 or a newer one, whose contacts can end at \
                 zero force",
                self.path.display(),
                self.version
            );
            return Err(wrong(self.engine, problem));
        }
        let has = |style: &&&str| self.help.split_whitespace().all(|own| own != **style);
        let lacking: Vec<&str> = STYLES.iter().filter(has).copied().collect();
        match lacking.is_empty() {
            true => Ok(()),
            false => Err(wrong(
                self.engine,
                format!(
                    "{} was built without {}: it needs the packages GRANULAR and MISC or MC",
                    self.path.display(),
                    lacking.join(", ")
                ),
            )),
        }
    }

    /// How to start it on so many ranks: with a launcher of its own MPI, which is tried.
    ///
    /// # Errors
    /// No launcher, or one with which every rank runs for itself.
    pub fn launch(&self, ranks: usize) -> Result<Launch, Error> {
        let own = self.path.display().to_string();
        if ranks == 1 {
            return Ok(Launch {
                command: vec![own.clone()],
                name: own,
            });
        }
        let mut seen = Vec::new();
        for name in LAUNCHERS {
            let Some(path) = on_path(name) else {
                continue;
            };
            let path = path.display().to_string();
            let kind = kind_of(&path);
            let mut command = vec![path.clone()];
            if kind == "Open MPI" {
                command.extend(["--oversubscribe", "--bind-to", "none"].map(str::to_owned));
            }
            command.extend(["-n".to_owned(), ranks.to_string(), own.clone()]);
            let launch = Launch {
                command,
                name: path.clone(),
            };
            match self.processes(&launch) {
                Ok(found) if found == ranks => return Ok(launch),
                Ok(found) => seen.push(format!("{path} ({kind}) started it on {found} procs")),
                Err(problem) => seen.push(format!("{path} ({kind}): {problem}")),
            }
        }
        let built = match self.mpi.is_empty() {
            true => String::new(),
            false => format!(", built with MPI v{},", self.mpi),
        };
        let tried = match seen.is_empty() {
            true => format!("there is none of {} on PATH", LAUNCHERS.join(", ")),
            false => seen.join("; "),
        };
        Err(wrong(
            self.engine,
            format!(
                "{own}{built} needs a launcher of the same MPI for {ranks} ranks: {tried}. Install \
                 the one it was built with (Debian's: apt install openmpi-bin), or use --ranks 1"
            ),
        ))
    }

    /// On how many processes a launcher starts it, together.
    fn processes(&self, launch: &Launch) -> Result<usize, String> {
        let text = match self.engine {
            Engine::Liggghts => {
                "atom_style granular\nboundary f f f\nregion r block 0 8 0 8 0 8 units box\n\
                 create_box 1 r\n"
            }
            _ => "atom_style sphere\nregion r block 0 8 0 8 0 8\ncreate_box 1 r\n",
        };
        let folder = Scratch::temporary().map_err(|error| error.to_string())?;
        let written = folder.write(Path::new("in.try"), text.as_bytes());
        written.map_err(|error| error.to_string())?;
        let output = self.command(launch, "in.try", folder.path()).output();
        let text = text_of(&output.map_err(|error| error.to_string())?);
        let grid = text
            .lines()
            .find(|line| line.contains("MPI processor grid"));
        let grid = grid.ok_or_else(|| last_lines(&text))?;
        let sides = grid
            .split_whitespace()
            .filter_map(|own| own.parse::<usize>().ok());
        Ok(sides.product())
    }

    /// The command that runs a deck in a directory.
    pub fn command(&self, launch: &Launch, deck: &str, directory: &Path) -> Command {
        let mut command = self.started(&launch.command, directory);
        command.args(["-in", deck, "-log", LOG]);
        command
    }

    /// A command that runs in a directory as this engine is to run.
    pub fn started(&self, words: &[String], directory: &Path) -> Command {
        let mut command = Command::new(&words[0]);
        command
            .args(&words[1..])
            .current_dir(directory)
            .env(TEMPORARY, self.scratch.path())
            // Ranks share the cores; Open MPI does not start for root unasked.
            .env("OMP_NUM_THREADS", "1")
            .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
            .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
            // Ranks that wait leave a busy machine to those that work.
            .env("OMPI_MCA_mpi_yield_when_idle", "1")
            .stdin(Stdio::null());
        command
    }
}

pub(crate) fn wrong(engine: Engine, problem: String) -> Error {
    Error::Engine {
        engine: engine.title(),
        problem,
    }
}

fn on_path(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path)
        .map(|folder| folder.join(name))
        .find(|file| file.is_file())
}

fn text_of(output: &Output) -> String {
    let mut text = String::from_utf8_lossy(&output.stdout).into_owned();
    text += &String::from_utf8_lossy(&output.stderr);
    text
}

/// Whose a launcher is.
fn kind_of(path: &str) -> &'static str {
    let output = Command::new(path)
        .arg("--version")
        .stdin(Stdio::null())
        .output();
    let text = output.map_or(String::new(), |own| text_of(&own));
    match text {
        own if own.contains("Open MPI") || own.contains("OpenRTE") => "Open MPI",
        own if own.contains("HYDRA") => "MPICH",
        own if own.contains("Intel") => "Intel MPI",
        _ => "an unknown MPI",
    }
}

/// Lines that are shown of what an engine said.
const SHOWN: usize = 4;

/// What an engine said at last, in one line: its errors, where it named them so.
pub(crate) fn last_lines(text: &str) -> String {
    let lines: Vec<&str> = text
        .lines()
        .map(str::trim)
        .filter(|own| own.contains(char::is_alphanumeric))
        .collect();
    let error = lines.iter().position(|own| own.contains("ERROR"));
    let from = error.unwrap_or(lines.len().saturating_sub(SHOWN));
    let shown: Vec<&str> = lines[from..].iter().take(SHOWN).copied().collect();
    match shown.is_empty() {
        true => "it said nothing".to_owned(),
        false => shown.join(" | "),
    }
}

/// Year, month and day of a version such as "29 Sep 2021 - Update 2".
fn date_of(version: &str) -> Option<[u32; 3]> {
    const MONTHS: [&str; 12] = [
        "Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec",
    ];
    let mut words = version.split_whitespace();
    let day = words.next()?.parse().ok()?;
    let name = words.next()?;
    let month = MONTHS.iter().position(|own| name.starts_with(own))?;
    let year = words.next()?.parse().ok()?;
    Some([year, month as u32 + 1, day])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_ordered_by_date() {
        let of = |text: &str| date_of(text).unwrap();
        assert!(of("29 Sep 2021 - Update 2") >= OLDEST);
        assert!(of("22 Jul 2025 - Update 4") > OLDEST);
        assert!(of("3 Mar 2020") < OLDEST);
        assert_eq!(date_of("unknown"), None);
    }

    #[test]
    fn errors_of_engines_are_what_is_shown() {
        let text = "LAMMPS\nERROR: Unknown pair style\nLast command: x\n";
        assert_eq!(
            last_lines(text),
            "ERROR: Unknown pair style | Last command: x"
        );
        assert_eq!(last_lines(""), "it said nothing");
    }
}
