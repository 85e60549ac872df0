#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "problem/make_scene.hpp"

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

/// The scenes of those cases that `fit`, among the cases named, by path or by name, or all canonical ones
/// when there are no names. Throws InputError that tells what a dynamic case has not, when one is named that
/// does not fit.
std::deque<Scene> read_scenes(const std::vector<std::string>& names,
                              const std::function<bool(const Case&)>& fit, const std::string& has_not);

}  // namespace sandglass
