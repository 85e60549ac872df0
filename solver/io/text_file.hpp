#pragma once

#include <filesystem>
#include <string>

#include "io/new_file.hpp"

namespace sandglass {

/// A text file that is being written beside its final path, to which `commit` renames it. Throws InputError
/// if the path cannot be written, ComputationError if writing to the disk fails.
class NewTextFile {
 public:
  NewTextFile(const std::filesystem::path& path, const std::string& text);
  void commit() { file_.commit(); }

 private:
  NewFile file_;
};

/// Writes a whole text file; errors as above.
void write_text_file(const std::filesystem::path& path, const std::string& text);

}  // namespace sandglass
