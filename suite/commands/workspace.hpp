#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "problem/case.hpp"

namespace sandglass {

/// The folder of the canonical cases: the environment variable SANDGLASS_CASES, else ./cases, else the one
/// installed next to the program, else the one in the source tree.
std::filesystem::path case_folder();

/// All case files of that folder, in alphabetical order.
std::vector<std::filesystem::path> canonical_files();

/// All cases of a file, given by path or name, or the one variant of that name, with or without a folder.
/// Throws InputError that lists the known names.
std::vector<Case> find_cases(const std::string& name_or_path);

/// The single case of that name. Throws InputError that lists the variants if there are several.
Case find_case(const std::string& name_or_path);

/// The cases that `fit`, among those named by path or name, or among all canonical ones if there are no
/// names. Throws InputError for a named dynamic case that does not fit, naming what it lacks.
std::vector<Case> named_cases(const std::vector<std::string>& names,
                              const std::function<bool(const Case&)>& fit, const std::string& has_not);

}  // namespace sandglass
