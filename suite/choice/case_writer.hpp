#pragma once

#include <filesystem>
#include <string>

#include "problem/case.hpp"

namespace sandglass {

/// The text of a case file at `place`, to whose folder paths are relative: the case of `description`, with
/// its variants resolved and `choice` as its [method]. `chosen` is the same case, perhaps on a coarser or
/// refined mesh or with longer steps: the file gets its counts of elements, refinements, sets, steps and
/// moduli. If another mesh or other moduli make it another case, it gets another name and no limits or
/// references, because they do not apply. Comments are lost; the first lines say so. Throws InputError like
/// reading.
std::string case_text(const Case& description, const MethodChoice& choice, const Case& chosen,
                      const std::filesystem::path& place);

}  // namespace sandglass
