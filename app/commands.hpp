#pragma once

#include <CLI/App.hpp>
#include <memory>

#include "base/ranks.hpp"

namespace sandglass {

/// Each adds one subcommand to the command line. A command returns its exit code through `exit_code`.
void add_cases_command(CLI::App& app);
void add_methods_command(CLI::App& app);
void add_choose_command(CLI::App& app, int& exit_code);
void add_mesh_command(CLI::App& app);
void add_flops_command(CLI::App& app);
void add_kernels_command(CLI::App& app);
void add_run_command(CLI::App& app, int& exit_code, std::shared_ptr<const Ranks> ranks);
void add_verify_command(CLI::App& app, int& exit_code);
void add_stability_command(CLI::App& app, int& exit_code);
void add_score_command(CLI::App& app, int& exit_code);
void add_completion_command(CLI::App& app);
void add_manual_command(CLI::App& app);
void add_bench_command(CLI::App& app, int& exit_code);

/// The option for the processor, see `processor_named`.
inline CLI::Option* add_device_option(CLI::App& command, std::string& device) {
  return command
      .add_option("--device", device,
                  "processor that computes the forces of elements: 'cpu', 'opencl' for the first device of "
                  "OpenCL, a graphics card if there is one, or 'opencl:2' for the second")
      ->capture_default_str();
}

}  // namespace sandglass
