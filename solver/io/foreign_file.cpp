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
#include "io/new_file.hpp"
#include "io/project_folder.hpp"

namespace sandglass {

namespace {

namespace fs = std::filesystem;

std::string setting(const char* variable, const std::string& otherwise) {
  const char* value = std::getenv(variable);
  return value != nullptr ? value : otherwise;
}

/// A folder that is gone afterwards.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "sandglass-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
      throw ComputationError(
          fmt::format("{}: cannot be made a folder: {}", pattern, std::generic_category().message(errno)));
    }
    path_ = pattern;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

/// What a program writes to a pipe, until it closes its end; trailing white space is cut.
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

/// Runs a program to its end with its standard output in `said`; how it ended, as `waitpid` tells. Throws
/// InputError when there is no such program.
int run_program(std::vector<std::string> words, std::string& said) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw ComputationError("no pipe to another program");
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
        fmt::format("{}: cannot be run: {}; files of other programs need package python3, or its "
                    "name in SANDGLASS_PYTHON",
                    words[0], std::generic_category().message(error)));
  }
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// Runs exchange/convert.py; `path` is the file of the user that is converted. Throws InputError with what it
/// says of wrong input, ComputationError when it fails.
void convert(std::vector<std::string> arguments, const fs::path& path) {
  const fs::path program = fs::path(setting("SANDGLASS_EXCHANGE", project_folder("exchange"))) / "convert.py";
  std::error_code ignored;
  if (!fs::is_regular_file(program, ignored)) {
    throw InputError(
        fmt::format("{}: is missing; it reads and writes the files of other programs; SANDGLASS_EXCHANGE "
                    "names its folder",
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

/// A path of the user as an argument that is no option.
std::string argument(const fs::path& path) {
  return path.string().starts_with('-') ? "./" + path.string() : path.string();
}

/// What a deck says beside the mesh: /problem/imposed (node, component, final value in m), /problem/forces
/// (node and three components in N), attributes law and material.NAME.
void write_problem(const Scene& scene, Hdf5File& file) {
  const auto write_rows = [&](const std::string& name, std::size_t width, const std::vector<double>& rows) {
    if (!rows.empty()) file.write(name, {rows.size() / width, width}, std::span<const double>(rows));
  };
  std::vector<double> imposed, forces;
  for (const auto& constraint : scene.constraints) {
    imposed.insert(imposed.end(),
                   {static_cast<double>(constraint.node), static_cast<double>(constraint.component),
                    final_value(scene, constraint)});
  }
  for (const auto& [node, force, curve] : scene.loads) {
    const double factor = scene.curves[curve].at(1.0, 1.0);
    forces.insert(forces.end(),
                  {static_cast<double>(node), factor * force[0], factor * force[1], factor * force[2]});
  }
  write_rows("/problem/imposed", 3, imposed);
  write_rows("/problem/forces", 4, forces);
  const auto write_number = [&]<class Value>(std::string_view name, const Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      file.write_attribute("/", fmt::format("material.{}", name), static_cast<double>(value));
    }
  };
  std::visit(
      [&](const auto& law) {
        file.write_attribute("/", "law", std::string(law.name));
        std::apply([&](const auto&... p) { (write_number(p.name, law.*(p.member)), ...); }, law.parameters());
      },
      scene.description.materials.front().law);
}

}  // namespace

bool is_foreign_mesh(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".msh" || ending == ".inp" || ending == ".vtu" || ending == ".npy" || ending == ".nii" ||
         ending == ".gz";
}

MeshWithSets read_foreign_mesh(const MeshFile& file) {
  const TemporaryFolder folder;
  const fs::path converted = folder / "mesh.h5";
  std::vector<std::string> arguments{"mesh", argument(file.path), converted.string()};
  if (file.spacing) {
    arguments.emplace_back("--spacing");
    for (const double h : *file.spacing) arguments.push_back(fmt::to_string(h));
  }
  convert(std::move(arguments), file.path);
  return read_mesh_file(converted);
}

void write_foreign_mesh(const Scene& scene, const fs::path& path, const ForeignFormat& format) {
  if (format.deck && !scene.description.quasi_static) {
    throw InputError(fmt::format("{}: a dynamic case has no deck", scene.description.file.string()));
  }
  if (format.deck && !(scene.pressures.empty() && scene.supports.empty())) {
    throw InputError(fmt::format("{}: pressures and supports have no deck; allowed are forces and gravity",
                                 scene.description.file.string()));
  }
  if (format.deck && scene.materials.list.size() > 1) {
    throw InputError(fmt::format("{}: a case of {} materials has no deck; allowed is one material",
                                 scene.description.file.string(), scene.materials.list.size()));
  }
  if (!scene.ties.empty()) {
    throw InputError(fmt::format("{}: a refined mesh has nodes that hang, which no other format here knows",
                                 scene.description.file.string()));
  }
  NewFile output(path);
  const TemporaryFolder folder;
  const fs::path source = folder / "mesh.h5";
  auto file = Hdf5File::create(source);
  write_mesh(scene, file);
  if (format.deck) write_problem(scene, file);
  file.commit();
  std::vector<std::string> arguments{"write",       source.string(), output.temporary().string(),
                                     "--format",    format.name,     "--element",
                                     format.element};
  if (format.deck) arguments.emplace_back("--deck");
  convert(std::move(arguments), path);
  output.commit();
}

NodalField read_foreign_displacement(const fs::path& path, const Scene& scene, const NodeMatching& matching) {
  const TemporaryFolder folder;
  const fs::path mesh = folder / "mesh.h5", matched = folder / "displacement.h5";
  write_mesh_file(scene, mesh);
  std::vector<std::string> arguments{"displacement",   argument(path), mesh.string(),
                                     matched.string(), "--tolerance",  fmt::to_string(matching.tolerance)};
  if (!matching.field.empty()) arguments.push_back("--field=" + matching.field);
  convert(std::move(arguments), path);
  return read_nodal_field(Hdf5File::open(matched), "/displacement", scene.mesh.points.size());
}

}  // namespace sandglass
