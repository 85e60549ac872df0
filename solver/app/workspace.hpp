#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sandglass {

/// The folder of the canonical cases: the environment variable SANDGLASS_CASES, else ./cases, else that of
/// the source.
std::filesystem::path case_folder();

/// All case files of that folder, in alphabetical order.
std::vector<std::filesystem::path> canonical_cases();

/// The file of a case given by path or by name. Throws InputError that lists the known names.
std::filesystem::path find_case(const std::string& name_or_path);

}  // namespace sandglass
