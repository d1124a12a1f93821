//! The program `controller-sim`.

use std::process::ExitCode;

fn main() -> ExitCode {
    controller_sim_host::cli::main()
}
