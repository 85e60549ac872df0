#pragma once

#include <filesystem>
#include <string>

#include "problem/case.hpp"

namespace sandglass {

/// The text of a case file for `place` (its folder is what paths are relative to) that says what the file of
/// `description` says about this case, with `choice` as its [method]. What a file with variants says of all
/// of them is resolved. `chosen` is the same case, perhaps on a coarser or refined mesh or with longer steps:
/// the file gets its counts of elements, refinements, sets, steps and moduli. If another mesh or other moduli
/// make it another case, it gets another name and no limits or references, which are not its own. Comments
/// are lost; the first lines say so. Throws InputError as reading does.
std::string case_text(const Case& description, const MethodChoice& choice, const Case& chosen,
                      const std::filesystem::path& place);

}  // namespace sandglass
