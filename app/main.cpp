#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string_view>

#include "app/build_info.hpp"
#include "app/commands.hpp"
#include "app/mpi_ranks.hpp"
#include "app/usage.hpp"
#include "base/error.hpp"
#include "base/memory.hpp"

namespace {

/// Exit codes of every command.
enum ExitCode { ok = 0, limit_broken = 1, bad_input = 2, computation_failed = 3 };

/// The program. Of several ranks only the first prints.
int run(int argc, char** argv, const std::shared_ptr<const sandglass::Ranks>& ranks) {
  CLI::App app{
      "explicit solver for soft solids: hexahedra with hourglass control, compared with mixed elements",
      "sandglass"};
  app.formatter(sandglass::help_layout());
  app.failure_message(sandglass::usage_error);
  app.require_subcommand(1);
  app.set_version_flag("--version", fmt::format("sandglass {} ({})", sandglass::build_info::version,
                                                sandglass::build_info::revision));
  std::signal(SIGXFSZ, SIG_IGN);  // a file at its size limit is reported like a full disk
  if (ranks->rank() > 0 && std::freopen("/dev/null", "w", stdout) == nullptr) return computation_failed;
  if (ranks->count() > 1 && (argc < 2 || std::string_view(argv[1]) != "run")) {
    throw sandglass::InputError(
        fmt::format("ranks: {} were started, but only `sandglass run CASE` divides its work; start other "
                    "commands without mpirun",
                    ranks->count()));
  }
  int exit_code = ok;
  sandglass::add_cases_command(app);
  sandglass::add_methods_command(app);
  sandglass::add_run_command(app, exit_code, ranks);
  sandglass::add_verify_command(app, exit_code);
  sandglass::add_stability_command(app, exit_code);
  sandglass::add_choose_command(app, exit_code);
  sandglass::add_score_command(app, exit_code);
  sandglass::add_mesh_command(app);
  sandglass::add_flops_command(app);
  sandglass::add_kernels_command(app);
  sandglass::add_bench_command(app, exit_code);
  sandglass::add_completion_command(app);
  sandglass::add_manual_command(app);
  app.footer("Exit codes: 0 ok, 1 a limit is broken, 2 bad usage or input, 3 the computation failed.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostream nowhere(nullptr);
    const bool prints = ranks->rank() == 0;
    return app.exit(error, prints ? std::cout : nowhere, prints ? std::cerr : nowhere) == 0 ? ok : bad_input;
  }
  if (std::fflush(stdout) != 0) {
    fmt::print(stderr, "error: standard output: cannot be written\n");
    return computation_failed;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  std::shared_ptr<const sandglass::Ranks> ranks = std::make_shared<const sandglass::Ranks>();
  // An error of all ranks is printed once and ends them in order; one of some ends the others, which wait
  // for them.
  const auto fail = [&ranks](const std::string& message, int code) {
    const bool all = ranks->all_end();
    if (!all || ranks->rank() == 0) {
      fmt::print(stderr, "error: {}{}\n", all ? "" : fmt::format("rank {}: ", ranks->rank()), message);
    }
    if (!all) ranks->abort(code);
    return code;
  };
  try {
    ranks = sandglass::join_ranks();
    return run(argc, argv, ranks);
  } catch (const sandglass::InputError& error) {
    return fail(error.what(), bad_input);
  } catch (const std::bad_alloc&) {
    return fail(
        fmt::format("not enough memory: {:.1f} GB are free on this machine, and a limit of the shell may "
                    "allow less; remedy: fewer elements",
                    1e-9 * static_cast<double>(sandglass::available_memory())),
        computation_failed);
  } catch (const std::exception& error) {
    return fail(error.what(), computation_failed);
  }
}
