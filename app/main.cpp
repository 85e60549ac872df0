#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "app/build_info.hpp"
#include "app/commands.hpp"
#include "base/error.hpp"

namespace {

/// Exit codes of every command.
enum ExitCode { ok = 0, limit_broken = 1, bad_input = 2, computation_failed = 3 };

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Sandglass: explicit Total Lagrangian hexahedra with hourglass control, measured against a mixed "
      "reference.\n"
      "Exit codes: 0 ok, 1 a limit is broken, 2 bad usage or input, 3 the computation failed."};
  app.require_subcommand(1);
  app.set_version_flag("--version", fmt::format("sandglass {} ({})", sandglass::build_info::version,
                                                sandglass::build_info::revision));
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is told like a full disk
  int exit_code = ok;
  sandglass::add_cases_command(app);
  sandglass::add_methods_command(app);
  sandglass::add_run_command(app, exit_code);
  sandglass::add_verify_command(app, exit_code);
  sandglass::add_stability_command(app, exit_code);
  sandglass::add_choose_command(app, exit_code);
  sandglass::add_score_command(app);
  sandglass::add_mesh_command(app);
  sandglass::add_flops_command(app);
  sandglass::add_bench_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ok : bad_input;
  } catch (const sandglass::InputError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return bad_input;
  } catch (const sandglass::ComputationError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return computation_failed;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: not enough memory\n");
    return computation_failed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return computation_failed;
  }
  if (std::fflush(stdout) != 0) {
    fmt::print(stderr, "error: standard output: cannot be written\n");
    return computation_failed;
  }
  return exit_code;
}
