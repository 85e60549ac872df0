#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "problem/model.hpp"

namespace sandglass {

/// The folder of the canonical cases: the environment variable SANDGLASS_CASES, else ./cases, else that which
/// is installed next to the program, else that of the source.
std::filesystem::path case_folder();

/// All case files of that folder, in alphabetical order.
std::vector<std::filesystem::path> canonical_files();

/// The cases that a file stands for, given by path or by name, or the one variant of that name, with or
/// without a folder before it. Throws InputError that lists the known names.
std::vector<Case> find_cases(const std::string& name_or_path);

/// The same for a name that stands for one case. Throws InputError that lists the variants when it stands for
/// more.
Case find_case(const std::string& name_or_path);

/// The scenes of the quasi-static cases named, by path or by name, or of all canonical ones when there are no
/// names. Throws InputError that tells what a dynamic case has not, when one is named.
std::deque<Scene> read_static_scenes(const std::vector<std::string>& names, const std::string& has_not);

}  // namespace sandglass
