//! The `windfall` command.

fn main() -> std::process::ExitCode {
    windfall_cli::main(std::env::args_os()).into()
}
