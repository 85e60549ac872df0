#pragma once

#include <filesystem>
#include <string>

#include "problem/case.hpp"

namespace sandglass {

/// The text of a case file for `place` (its folder is what paths are relative to) that says what the file of
/// `description` says about this case, with `choice` as its [method]. What a file with variants says of all
/// of them is resolved. With `other`, the same case on a coarser or refined mesh, it gets that one's counts
/// of elements and refinements, keeps that one's sets, and gets another name and no limits or references, for
/// they belong to the mesh. Comments are lost; the first lines say so. Throws InputError as reading does.
std::string case_text(const Case& description, const MethodChoice& choice, const Case* other,
                      const std::filesystem::path& place);

}  // namespace sandglass
