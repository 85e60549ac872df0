#pragma once

#include <filesystem>
#include <string>

namespace sandglass {

/// Writes a text file in one go: to a temporary beside it, then renamed. Throws InputError when that cannot
/// be done.
void write_text_file(const std::filesystem::path& path, const std::string& text);

}  // namespace sandglass
