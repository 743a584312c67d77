//! A running engine whose frames a scene follows.

use crate::deck::{FRAMES, LOG};
use crate::frames::{Frame, FrameReader};
use crate::program::{Launch, Program, wrong};
use crate::running::{LOOK, Running, SCREEN, make_room, remove_restarts};
use std::fs::{File, OpenOptions};
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use windfall_files::error::Error;
use windfall_files::written::check_written;
use windfall_scene::energy::Energy;
use windfall_scene::follow::Followed;
use windfall_scene::motion::simulation::Simulation;
use windfall_scene_run::file::engine_kind::Engine;
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

/// Frames that wait to be followed.
const WAITING: usize = 4;

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
        make_room(directory, &[SCREEN, LOG])?;
        let _ = std::fs::remove_file(&pipe);
        remove_restarts(directory);
        let made = Command::new("mkfifo").arg(&pipe).status();
        if !made.is_ok_and(|status| status.success()) {
            let problem = "this system has no named pipes (mkfifo); run the deck of `windfall scene \
                           export` by hand and give its frames with --frames";
            return Err(wrong(engine, problem.to_owned()));
        }
        let command = program.command(launch, deck, directory);
        let running = Running::start(program, (command, &launch.name), directory)?;
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
                && running.is_over()
            {
                // Wakes a reader that waits for the engine to open the pipe.
                over = true;
                let pipe = running.directory().join(FRAMES);
                drop(OpenOptions::new().read(true).write(true).open(pipe));
            }
        }
    }

    /// What went wrong, with what the engine said.
    fn failed(&mut self, problem: &str) -> Error {
        match &mut self.running {
            Some(running) => running.failed(problem, self.next),
            None => wrong(self.engine, problem.to_owned()),
        }
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
