#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/toml.hpp"

namespace sandglass {

/// The tables of one case.
struct CaseTables {
  toml::table root;
  std::vector<std::string> variants;  ///< the name of its variant on each axis; empty without variants
};

/// The cases of a file; one without [variants]. Each [[variants.AXIS]] has a name and keys of a case, and
/// every combination of one variant of each axis is a case: the file with the variants' keys added or
/// replacing its own; tables are merged, lists replaced. Axes are in the order of the file, the last varies
/// fastest. Throws InputError if the file is missing or not TOML, or if a name is missing, duplicate or
/// unusable as a file name.
std::vector<CaseTables> read_case_tables(const std::filesystem::path& path);

/// The tables of one case of a file, by its variants. Throws InputError if the file no longer has it.
CaseTables read_case_tables(const std::filesystem::path& path, const std::vector<std::string>& variants);

/// The tables of a case given as text, without [variants] and [mesh]. Messages call it `name`, and its paths
/// are relative to the current folder. Throws InputError.
CaseTables parse_case_text(const std::string& text, const std::string& name);

}  // namespace sandglass
