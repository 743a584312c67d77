//! A running engine whose frames a scene follows.

use crate::deck::{FRAMES, LOG};
use crate::frames::{Frame, FrameReader};
use crate::program::{Launch, Program, last_lines, wrong};
use std::fs::{File, OpenOptions};
use std::io::{BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::Duration;
use windfall_files::error::Error;
use windfall_files::scratch::Scratch;
use windfall_files::written::{check_written, list_filled_by_others};
use windfall_scene::energy::Energy;
use windfall_scene::follow::Followed;
use windfall_scene::motion::simulation::Simulation;
use windfall_scene_run::file::engine_kind::Engine;
use windfall_scene_run::file_error::access;
use windfall_scene_run::run::advance::Mover;
use windfall_scene_run::stopped_scene as stopped;

/// Frames of an engine, while it runs or from a file of an earlier run.
pub struct Frames {
    engine: Engine,
    received: Receiver<Result<Frame, String>>,
    running: Option<Running>,
    followed: Followed,
    frame_steps: u64,
    /// Step of the next frame.
    next: u64,
}

/// An engine that runs; it ends with this.
struct Running {
    child: Child,
    directory: PathBuf,
    /// Ends the engine where this program is killed.
    guard: Option<Child>,
    /// Needed as long as the engine runs.
    _scratch: Arc<Scratch>,
}

/// Frames that wait to be followed.
const WAITING: usize = 4;
/// Time between looks whether the engine still runs.
const LOOK: Duration = Duration::from_millis(100);
/// What the engine prints, in its directory.
const SCREEN: &str = "screen.txt";

impl Frames {
    /// Starts an engine on the deck in a directory; its frames come through a pipe, so that
    /// they take no room on the disk and the engine waits for who follows it.
    ///
    /// # Errors
    /// It does not start, or this system has no named pipes.
    pub fn of_run(
        (program, launch): (&Program, &Launch),
        (directory, deck): (&Path, &str),
        (fruit, frame_steps): (usize, u64),
    ) -> Result<Self, Error> {
        let engine = program.engine;
        let pipe = directory.join(FRAMES);
        check_written(&pipe, None)?;
        for name in [SCREEN, LOG] {
            check_written(&directory.join(name), None)?;
            list_filled_by_others(&directory.join(name))?;
        }
        let _ = std::fs::remove_file(&pipe);
        remove_restarts(directory);
        let made = Command::new("mkfifo").arg(&pipe).status();
        if !made.is_ok_and(|status| status.success()) {
            let problem = "this system has no named pipes (mkfifo); run the deck of `windfall scene \
                           export` by hand and give its frames with --frames";
            return Err(wrong(engine, problem.to_owned()));
        }
        let screen = directory.join(SCREEN);
        let failed = access(&screen, "write");
        let screen = File::create(&screen).map_err(&failed)?;
        let errors = screen.try_clone().map_err(&failed)?;
        let mut command = program.command(launch, deck, directory);
        command
            .stdout(Stdio::from(screen))
            .stderr(Stdio::from(errors));
        let mut guard = guard();
        let child = command.spawn();
        let child = child
            .map_err(|error| wrong(engine, format!("{} does not start: {error}", launch.name)))?;
        if let Some(told) = guard.as_mut().and_then(|own| own.stdin.as_mut()) {
            // Without a guard the engine runs as well.
            let _ = writeln!(told, "{}", child.id());
        }
        let running = Running {
            child,
            guard,
            directory: directory.to_path_buf(),
            _scratch: Arc::clone(&program.scratch),
        };
        Ok(Self {
            engine,
            received: received(pipe, fruit),
            running: Some(running),
            followed: Followed::default(),
            frame_steps,
            next: 0,
        })
    }

    /// Frames of an earlier run of the scene's deck.
    pub fn of_file(engine: Engine, path: &Path, fruit: usize, frame_steps: u64) -> Self {
        Self {
            engine,
            received: received(path.to_path_buf(), fruit),
            running: None,
            followed: Followed::default(),
            frame_steps,
            next: 0,
        }
    }

    fn frame(&mut self) -> Result<Frame, Error> {
        let mut over = false;
        loop {
            match self.received.recv_timeout(LOOK) {
                Ok(Ok(frame)) => return Ok(frame),
                Ok(Err(problem)) => return Err(self.failed(&problem)),
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(self.failed("its frames end too early"));
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
            if let Some(running) = &mut self.running
                && !over
                && running
                    .child
                    .try_wait()
                    .is_ok_and(|status| status.is_some())
            {
                // Wakes a reader that waits for the engine to open the pipe.
                over = true;
                let pipe = running.directory.join(FRAMES);
                drop(OpenOptions::new().read(true).write(true).open(pipe));
            }
        }
    }

    /// What went wrong, with what the engine said.
    fn failed(&mut self, problem: &str) -> Error {
        let Some(running) = &mut self.running else {
            return wrong(self.engine, problem.to_owned());
        };
        // An engine that fails takes a moment to say so.
        for _ in 0..20 {
            if running
                .child
                .try_wait()
                .is_ok_and(|status| status.is_some())
            {
                break;
            }
            std::thread::sleep(LOOK);
        }
        let status = match running.child.try_wait() {
            Ok(Some(status)) => format!("it stopped ({status})"),
            _ => problem.to_owned(),
        };
        let screen = running.directory.join(SCREEN);
        let said = std::fs::read(&screen).unwrap_or_default();
        let said = last_lines(&String::from_utf8_lossy(&said));
        let time = self.next;
        wrong(
            self.engine,
            format!(
                "{status} before step {time}; it said: {said}. All it printed is in {}",
                screen.display()
            ),
        )
    }
}

impl Mover for Frames {
    fn step(&mut self, simulation: &mut Simulation) -> Result<Energy, Error> {
        let frame = self.frame()?;
        if frame.step != self.next {
            let problem = format!(
                "its frames are of another deck: one of step {} where {} is to be; export the scene \
                 anew, or say --frame-steps as then",
                frame.step, self.next
            );
            return Err(wrong(self.engine, problem));
        }
        self.next += self.frame_steps;
        simulation
            .follow(&frame.fruit, &mut self.followed)
            .map_err(stopped)
    }

    fn goes_on(&self) -> bool {
        false
    }

    fn steps(&self) -> u64 {
        self.frame_steps
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

/// Frames of a file or pipe, read ahead.
fn received(path: PathBuf, fruit: usize) -> Receiver<Result<Frame, String>> {
    let (send, received) = sync_channel(WAITING);
    std::thread::spawn(move || {
        let file = match File::open(&path) {
            Ok(file) => file,
            Err(error) => {
                let _ = send.send(Err(format!("{}: cannot read: {error}", path.display())));
                return;
            }
        };
        let mut reader = FrameReader::new(BufReader::with_capacity(1 << 20, file), fruit);
        while let Some(frame) = reader.next_frame().transpose() {
            let ends = frame.is_err();
            if send.send(frame).is_err() || ends {
                return;
            }
        }
    });
    received
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
fn remove_restarts(directory: &Path) {
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
