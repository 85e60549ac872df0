#pragma once

#include <filesystem>
#include <vector>

namespace sandglass {

/// The temporary file of a process beside a path.
std::filesystem::path temporary_path(const std::filesystem::path& path, int process);

/// A file on its way: its bytes go to a temporary file next to its place, and `commit` puts them there.
/// Without it nothing is left, and a file that stood there before stays as it was. What a program left that
/// was killed goes when the next one writes to the same place.
class NewFile {
 public:
  /// Makes the temporary, empty. Throws InputError when that cannot be done, and where something stands at
  /// `path` that is no file: a folder, a device.
  explicit NewFile(const std::filesystem::path& path);
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile();

  const std::filesystem::path& path() const { return path_; }
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Waits until the bytes are on the disk and renames: whatever happens, the old file is there or the new
  /// one. Throws ComputationError when the disk does not take them, InputError when the name cannot be taken.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

/// Throws InputError unless a file can be made at `path`, and if it is one of the files that the program
/// reads: for programs that write at the end of long work.
void require_place(const std::filesystem::path& path, const std::vector<std::filesystem::path>& inputs = {});

/// Makes a folder, and those above it, unless it is there. Throws InputError when that cannot be done.
void make_folder(const std::filesystem::path& path);

}  // namespace sandglass
