//! The binary `raypencil`.

use std::process::ExitCode;

fn main() -> ExitCode {
    raypencil_cli::main_with(std::env::args_os(), &raypencil::harness::contender)
}
