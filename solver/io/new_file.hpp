#pragma once

#include <filesystem>
#include <vector>

namespace sandglass {

/// The temporary file of this process beside a path.
std::filesystem::path temporary_path(const std::filesystem::path& path, int process);

/// A file that is being written: its bytes go to a temporary file beside it, and `commit` renames that.
/// Without `commit` nothing is left, and an existing file is unchanged. Temporary files of killed programs
/// are removed when the same file is written again.
class NewFile {
 public:
  /// Creates the empty temporary file. Throws InputError if that fails, or if `path` exists but is not a file
  /// (a folder, a device).
  explicit NewFile(const std::filesystem::path& path);
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile();

  const std::filesystem::path& path() const { return path_; }
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Waits until the bytes are on the disk and renames the file, so that at any time either the old or the
  /// new file exists. Throws ComputationError if writing to the disk fails, InputError if renaming fails.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

/// Throws InputError if `path` cannot be written or is one of the program's inputs; for programs that write
/// at the end of long work.
void require_place(const std::filesystem::path& path, const std::vector<std::filesystem::path>& inputs = {});

/// The same for several files, which must be different ones; those without a name are not written.
void require_places(const std::vector<std::filesystem::path>& paths,
                    const std::vector<std::filesystem::path>& inputs = {});

/// Creates a folder and its parents unless they exist. Throws InputError if that fails.
void make_folder(const std::filesystem::path& path);

}  // namespace sandglass
