//! An engine that runs as a program of its own.

use crate::deck::FRAMES;
use crate::program::{Program, last_lines, wrong};
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::time::Duration;
use windfall_files::error::Error;
use windfall_files::scratch::Scratch;
use windfall_files::written::{check_written, list_filled_by_others};
use windfall_scene_run::file::engine_kind::Engine;
use windfall_scene_run::file_error::access;

/// An engine that runs; it ends with this.
pub(crate) struct Running {
    engine: Engine,
    child: Child,
    directory: PathBuf,
    /// Ends the engine where this program is killed.
    guard: Option<Child>,
    /// Needed as long as the engine runs.
    _scratch: Arc<Scratch>,
}

/// Time between looks whether the engine still runs.
pub(crate) const LOOK: Duration = Duration::from_millis(100);
/// What the engine prints, in its directory.
pub(crate) const SCREEN: &str = "screen.txt";

/// Makes room for files that an engine writes in its directory.
///
/// # Errors
/// Somebody else's files are there.
pub(crate) fn make_room(directory: &Path, names: &[&str]) -> Result<(), Error> {
    for name in names {
        check_written(&directory.join(name), None)?;
        list_filled_by_others(&directory.join(name))?;
    }
    Ok(())
}

impl Running {
    /// Starts an engine; what it prints goes into its directory.
    ///
    /// * `name`: what starts it, for people
    ///
    /// # Errors
    /// It does not start; its directory cannot be written.
    pub fn start(
        program: &Program,
        (mut command, name): (Command, &str),
        directory: &Path,
    ) -> Result<Self, Error> {
        let screen = directory.join(SCREEN);
        let failed = access(&screen, "write");
        let screen = File::create(&screen).map_err(&failed)?;
        let errors = screen.try_clone().map_err(&failed)?;
        command
            .stdout(Stdio::from(screen))
            .stderr(Stdio::from(errors));
        let mut guard = guard();
        let child = command.spawn();
        let child = child
            .map_err(|error| wrong(program.engine, format!("{name} does not start: {error}")))?;
        if let Some(told) = guard.as_mut().and_then(|own| own.stdin.as_mut()) {
            // Without a guard the engine runs as well.
            let _ = writeln!(told, "{}", child.id());
        }
        Ok(Self {
            engine: program.engine,
            child,
            guard,
            directory: directory.to_path_buf(),
            _scratch: Arc::clone(&program.scratch),
        })
    }

    /// Where it runs.
    pub fn directory(&self) -> &Path {
        &self.directory
    }

    /// Whether it has ended.
    pub fn is_over(&mut self) -> bool {
        self.child.try_wait().is_ok_and(|status| status.is_some())
    }

    /// Whether it has ended well.
    pub fn is_done(&mut self) -> bool {
        let status = self.child.try_wait();
        status.is_ok_and(|status| status.is_some_and(|own| own.success()))
    }

    /// What went wrong, with what the engine said.
    ///
    /// * `step`: its step then
    pub fn failed(&mut self, problem: &str, step: u64) -> Error {
        // An engine that fails takes a moment to say so.
        for _ in 0..20 {
            if self.is_over() {
                break;
            }
            std::thread::sleep(LOOK);
        }
        let status = match self.child.try_wait() {
            Ok(Some(status)) => format!("it stopped ({status})"),
            _ => problem.to_owned(),
        };
        let screen = self.directory.join(SCREEN);
        let said = std::fs::read(&screen).unwrap_or_default();
        let said = last_lines(&String::from_utf8_lossy(&said));
        wrong(
            self.engine,
            format!(
                "{status} before step {step}; it said: {said}. All it printed is in {}",
                screen.display()
            ),
        )
    }
}

/// A process that waits until this one is gone, however it ends, and ends the engine then: an
/// engine whose frames nobody reads would wait for ever. It is told the engine's number.
fn guard() -> Option<Child> {
    const WAIT: &str = "read -r engine; read -r end; [ -n \"$engine\" ] || exit; kill \"$engine\"; \
                        for second in 1 2 3 4 5; do kill -0 \"$engine\" || exit; sleep 1; done; \
                        kill -KILL \"$engine\"";
    let mut command = Command::new("sh");
    command.args(["-c", WAIT]).stdin(Stdio::piped());
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().ok()
}

impl Drop for Running {
    /// Ends the engine, asking first, so that a launcher can end its ranks.
    fn drop(&mut self) {
        let ended = |child: &mut Child| child.try_wait().is_ok_and(|status| status.is_some());
        for attempt in 0..30 {
            if ended(&mut self.child) {
                break;
            }
            if attempt == 5 {
                let id = self.child.id().to_string();
                let _ = Command::new("kill").arg(id).stderr(Stdio::null()).status();
            }
            std::thread::sleep(LOOK);
        }
        if !ended(&mut self.child) {
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
        // It would take another program with this number for the engine.
        if let Some(guard) = &mut self.guard {
            let _ = guard.kill();
            let _ = guard.wait();
        }
        let _ = std::fs::remove_file(self.directory.join(FRAMES));
        remove_restarts(&self.directory);
    }
}

/// Removes what LIGGGHTS leaves in its directory when it is asked to end: its state under the
/// number of its process, which no run takes up.
pub(crate) fn remove_restarts(directory: &Path) {
    for entry in std::fs::read_dir(directory).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let number = name.to_str().and_then(|own| {
            own.strip_prefix("restart_forced_liggghts_")?
                .strip_suffix(".data")
        });
        if number.is_some_and(|own| own.bytes().all(|b| b.is_ascii_digit())) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conserves_all_files_but_the_states_of_liggghts() {
        let name = format!("windfall-restarts-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        std::fs::create_dir(&folder).unwrap();
        let names = [
            "restart_forced_liggghts_2153.data",
            "restart_forced_liggghts_mine.data",
            "restart.data",
        ];
        for name in names {
            std::fs::write(folder.join(name), "x").unwrap();
        }
        remove_restarts(&folder);
        let left = names.map(|name| folder.join(name).exists());
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(left, [false, true, true]);
    }
}
