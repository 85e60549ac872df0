#include "io/foreign_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "base/error.hpp"
#include "io/project_folder.hpp"
#include "io/temporary_folder.hpp"

namespace sandglass {

namespace {

namespace fs = std::filesystem;

std::string setting(const char* variable, const std::string& otherwise) {
  const char* value = std::getenv(variable);
  return value != nullptr ? value : otherwise;
}

/// The output of a program through a pipe, until it closes its end, without trailing white space.
std::string read_all(int pipe) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = read(pipe, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  text.erase(text.find_last_not_of(" \n") + 1);
  return text;
}

/// Runs a program to its end and puts its standard output into `said`; returns its status as from `waitpid`.
/// Throws InputError if there is no such program.
int run_program(std::vector<std::string> words, std::string& said) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw ComputationError("cannot open a pipe to convert.py");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int error = posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (error == 0) said = read_all(ends[0]);
  close(ends[0]);
  if (error != 0) {
    throw InputError(
        fmt::format("{}: cannot be run: {}; files of other programs need Python: install python3, or "
                    "set SANDGLASS_PYTHON to its path",
                    words[0], std::generic_category().message(error)));
  }
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

void run_converter(std::vector<std::string> arguments, const fs::path& path) {
  const fs::path program = fs::path(setting("SANDGLASS_EXCHANGE", project_folder("exchange"))) / "convert.py";
  std::error_code ignored;
  if (!fs::is_regular_file(program, ignored)) {
    throw InputError(
        fmt::format("{}: is missing; it reads and writes files of other programs; set SANDGLASS_EXCHANGE "
                    "to its folder",
                    program.string()));
  }
  arguments.insert(arguments.begin(),
                   {setting("SANDGLASS_PYTHON", "/usr/bin/python3"), "-B", program.string()});
  std::string said;
  const int status = run_program(std::move(arguments), said);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 2 && !said.empty()) throw InputError(said);
  throw ComputationError(fmt::format("{}: cannot be completed: {}", path.string(),
                                     !said.empty() ? said
                                     : WIFSIGNALED(status)
                                         ? fmt::format("convert.py was ended by signal {}", WTERMSIG(status))
                                         : fmt::format("convert.py ended with {}", WEXITSTATUS(status))));
}

std::string as_argument(const fs::path& path) {
  return path.string().starts_with('-') ? "./" + path.string() : path.string();
}

bool is_foreign_mesh(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".msh" || ending == ".inp" || ending == ".vtu" || ending == ".vtk" || ending == ".npy" ||
         ending == ".nii" || ending == ".gz";
}

MeshWithSets read_foreign_mesh(const MeshFile& file) {
  const TemporaryFolder folder;
  const fs::path converted = folder / "mesh.h5";
  std::vector<std::string> arguments{"mesh", as_argument(file.path), converted.string()};
  if (file.spacing) {
    arguments.emplace_back("--spacing");
    for (const double h : *file.spacing) arguments.push_back(fmt::to_string(h));
  }
  run_converter(std::move(arguments), file.path);
  return read_mesh_file(converted);
}

}  // namespace sandglass
