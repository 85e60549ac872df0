#pragma once

#include <filesystem>
#include <string>

#include "io/new_file.hpp"

namespace sandglass {

/// A text file on its way: written next to its place, where `commit` puts it. Throws InputError when the
/// place cannot be written, ComputationError when the disk does not take the text.
class NewTextFile {
 public:
  NewTextFile(const std::filesystem::path& path, const std::string& text);
  void commit() { file_.commit(); }

 private:
  NewFile file_;
};

/// Writes a text file in one go; errors as above.
void write_text_file(const std::filesystem::path& path, const std::string& text);

}  // namespace sandglass
