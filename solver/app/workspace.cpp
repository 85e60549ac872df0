#include "app/workspace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "base/error.hpp"
#include "base/names.hpp"
#include "io/case_file.hpp"

namespace sandglass {

namespace {
namespace fs = std::filesystem;
}

fs::path case_folder() {
  if (const char* folder = std::getenv("SANDGLASS_CASES")) return folder;
  std::error_code ignored;
  return fs::is_directory("cases", ignored) ? fs::path("cases") : fs::path(SANDGLASS_CASES);
}

std::vector<fs::path> canonical_cases() {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(case_folder(), error)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  if (error)
    throw InputError(fmt::format("{}: cannot list the cases: {}", case_folder().string(), error.message()));
  std::sort(files.begin(), files.end());
  return files;
}

fs::path find_case(const std::string& name_or_path) {
  std::error_code ignored;
  if (fs::is_regular_file(name_or_path, ignored)) return name_or_path;
  fs::path named = case_folder() / (name_or_path + ".toml");
  if (fs::is_regular_file(named, ignored)) return named;
  std::vector<std::string> known;
  for (const auto& file : canonical_cases()) known.push_back(file.stem().string());
  throw InputError(fmt::format("case: '{}' is neither a file nor a known case; {}", name_or_path,
                               suggestion(name_or_path, known)));
}

std::deque<Scene> read_static_scenes(const std::vector<std::string>& names, const std::string& has_not) {
  std::vector<fs::path> files;
  for (const auto& name : names) files.push_back(find_case(name));
  if (names.empty()) files = canonical_cases();
  std::deque<Scene> scenes;
  for (const auto& file : files) {
    Scene scene = read_scene(file);
    if (scene.description.quasi_static) {
      scenes.push_back(std::move(scene));
    } else if (!names.empty()) {
      throw InputError(fmt::format("{}: a dynamic case has no {}", file.string(), has_not));
    }
  }
  return scenes;
}

}  // namespace sandglass
