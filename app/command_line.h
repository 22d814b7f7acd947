#pragma once
// The `rovigo` program: one subcommand for each thing a person does.

namespace rovigo::app {

/// Runs one subcommand. Returns the exit code: 0 done, 1 did not succeed, 2 bad usage or input.
int run_command_line(int argc, const char* const* argv);

}  // namespace rovigo::app
