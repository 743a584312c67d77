//! Times the reading of all samples of a file into memory.
//!
//!     read_speed FILE ROUNDS
//!
//! Prints the seconds of each round, open and read together, on one line.

#![allow(clippy::print_stdout)]

use std::path::Path;
use std::time::Instant;
use windfall_formats::Error;
use windfall_formats::open::{OpenOptions, open};

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, file, rounds] = &arguments[..] else {
        println!("read_speed FILE ROUNDS");
        return Ok(());
    };
    let rounds: usize = rounds.parse().unwrap_or(1);
    let mut seconds = Vec::new();
    for _ in 0..rounds {
        let start = Instant::now();
        let mut reader = open(Path::new(file), &OpenOptions::default())?;
        let opened = start.elapsed();
        let all: Vec<usize> = (0..reader.contents().channels.len()).collect();
        let samples = reader.read_whole(&all)?;
        seconds.push(format!("{:.6}", start.elapsed().as_secs_f64()));
        if std::env::var_os("READ_SPEED_OPEN").is_some() {
            println!("open {:.6}", opened.as_secs_f64());
        }
        // What is not used would not be read.
        std::hint::black_box(samples);
    }
    println!("{}", seconds.join(" "));
    Ok(())
}
