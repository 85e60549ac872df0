#include "commands/workspace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "base/error.hpp"
#include "base/names.hpp"
#include "comparison/comparison.hpp"
#include "io/case_file.hpp"
#include "io/project_folder.hpp"

namespace sandglass {

namespace fs = std::filesystem;

fs::path case_folder() {
  if (const char* folder = std::getenv("SANDGLASS_CASES")) return folder;
  std::error_code ignored;
  return fs::is_directory("cases", ignored) ? "cases" : project_folder("cases");
}

namespace {

std::vector<fs::path> case_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  if (error) throw InputError(fmt::format("{}: cannot list the cases: {}", folder.string(), error.message()));
  std::sort(files.begin(), files.end());
  return files;
}

/// The names of a file's variants as text.
std::string listed(const std::vector<Case>& cases) {
  std::string text;
  for (const auto& scene : cases) text += (text.empty() ? "" : ", ") + scene.name;
  return text;
}

/// The cases of a file; the tables that the library does not read are checked too.
std::vector<Case> read_checked(const fs::path& path) {
  auto cases = read_cases(path);
  for (const auto& description : cases) read_comparison(description);
  return cases;
}

}  // namespace

std::vector<fs::path> canonical_files() {
  return case_files_in(case_folder());
}

namespace {

/// The known case, or file beside it, whose name is closest to an unknown name.
std::string nearest_case(const fs::path& path, std::vector<std::string> known) {
  std::error_code ignored;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::vector<std::string> beside;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".toml") beside.push_back(entry.path().stem().string());
  }
  const std::string name = (path.extension() == ".toml" ? path.stem() : path.filename()).string();
  const std::string file = nearest_name(name, beside);
  known.push_back(file);
  std::string near = nearest_name(name, known);
  if (near.empty() || near != file) return near;
  return (path.parent_path() / (file + ".toml")).string();
}

}  // namespace

std::vector<Case> find_cases(const std::string& name_or_path) {
  std::error_code ignored;
  if (fs::is_regular_file(name_or_path, ignored)) return read_checked(name_or_path);
  const fs::path path(name_or_path);
  if (fs::is_regular_file(path.parent_path(), ignored)) {
    std::vector<Case> variants = read_checked(path.parent_path());
    std::erase_if(variants, [&](const Case& variant) { return variant.name != path.filename(); });
    if (!variants.empty()) return variants;
    throw InputError(fmt::format("case: {} has no variant '{}'; it has {}", path.parent_path().string(),
                                 path.filename().string(), listed(read_checked(path.parent_path()))));
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : case_folder();
  const std::string name = path.filename().string();
  if (fs::is_regular_file(folder / (name + ".toml"), ignored)) return read_checked(folder / (name + ".toml"));
  std::vector<std::string> known;
  for (const auto& file : case_files_in(folder)) {
    known.push_back(file.stem().string());
    if (!name.starts_with(known.back())) continue;  // a variant begins with its file's name
    for (auto& scene : read_checked(file)) {
      if (scene.name == name) return {std::move(scene)};
      known.push_back(scene.name);
    }
  }
  const std::string near = nearest_case(path, std::move(known));
  throw InputError(
      fmt::format("case: '{}' is neither a file nor a known case; {}`sandglass cases` lists the known ones",
                  name_or_path, near.empty() ? "" : fmt::format("did you mean '{}'? ", near)));
}

Case find_case(const std::string& name_or_path) {
  auto cases = find_cases(name_or_path);
  if (cases.size() > 1) {
    const bool is_file = fs::is_regular_file(name_or_path);
    throw InputError(fmt::format(
        "case: '{}' has {} variants; name one of them: {}{}", name_or_path, cases.size(), listed(cases),
        is_file ? fmt::format("; as in {}/{}", name_or_path, cases.front().name) : ""));
  }
  return std::move(cases.front());
}

std::vector<Case> named_cases(const std::vector<std::string>& names,
                              const std::function<bool(const Case&)>& fit, const std::string& has_not) {
  std::vector<Case> cases;
  const auto add = [&](std::vector<Case> found) {
    for (auto& description : found) {
      if (fit(description)) {
        cases.push_back(std::move(description));
      } else if (!names.empty()) {
        throw InputError(fmt::format("{}: a dynamic case has no {}", description.file.string(), has_not));
      }
    }
  };
  for (const auto& name : names) add(find_cases(name));
  if (names.empty()) {
    for (const auto& file : canonical_files()) add(read_checked(file));
  }
  return cases;
}

}  // namespace sandglass
