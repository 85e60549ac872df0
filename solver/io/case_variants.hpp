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

/// The cases of a file. Without [variants] it is one. Else each [[variants.AXIS]] has a name and keys of a
/// case, and every combination of one variant of each axis is a case: the file, with the variants' keys added
/// or put in place of its own; tables are merged, lists replaced. Axes stand in the order of the file, the
/// last changes fastest. Throws InputError when the file is missing or no TOML, and when a name is missing,
/// twice there or not fit for a file's name.
std::vector<CaseTables> read_case_tables(const std::filesystem::path& path);

/// The tables of one case of a file, by its variants. Throws InputError when the file no longer has it.
CaseTables read_case_tables(const std::filesystem::path& path, const std::vector<std::string>& variants);

/// The tables of a case that is a text, which must have no [variants] and no [mesh]. It stands for a file in
/// the current folder, of that name in messages. Throws InputError.
CaseTables parse_case_text(const std::string& text, const std::string& name);

}  // namespace sandglass
