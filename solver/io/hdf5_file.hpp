#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/ranks.hpp"

namespace sandglass {

/// An array of a file: shape and entries by rows.
template <class T>
struct FileArray {
  std::vector<std::size_t> shape;
  std::vector<T> entries;
};

/// What ranks that write one HDF5 file together implement beside `Ranks`: each changes a property list of
/// HDF5, whose handles (hid_t) are 64-bit integers here because programs without HDF5's header include this.
class WritesHdf5Together {
 public:
  virtual ~WritesHdf5Together() = default;
  virtual void open_together(std::int64_t access) const = 0;
  virtual void write_together(std::int64_t transfer) const = 0;
};

/// How a file is stored.
struct Storage {
  bool compressed = true;  ///< large datasets; smaller, and many times slower
  bool sealed = false;     ///< with a checksum of the whole file before its content
  std::shared_ptr<const Ranks> ranks = std::make_shared<const Ranks>();  ///< that write it together, all the
                                                                         ///< same, each a part of a dataset
};

/// An HDF5 file that closes itself. Errors of reading, and of places that cannot be written, are InputError
/// with the file, the name inside it and the rule; a disk that does not take the bytes is a ComputationError.
/// A file being written goes to a temporary file next to its place and is renamed by `commit`; without it
/// nothing is left.
class Hdf5File {
 public:
  /// Starts a new file. Throws InputError when the place cannot be written.
  static Hdf5File create(const std::filesystem::path& path, Storage storage = {});

  /// Opens a file for reading. Throws InputError when it is missing, truncated or not HDF5.
  static Hdf5File open(const std::filesystem::path& path);

  /// The same for a file that was sealed; throws InputError, too, when a bit has changed since.
  static Hdf5File open_sealed(const std::filesystem::path& path);

  Hdf5File(const Hdf5File&) = delete;
  Hdf5File(Hdf5File&&) noexcept;
  Hdf5File& operator=(const Hdf5File&) = delete;
  Hdf5File& operator=(Hdf5File&&) = delete;
  ~Hdf5File();

  const std::filesystem::path& path() const;

  /// Finishes a file made by `create`: close, wait for the disk, rename into place.
  void commit();

  bool contains(const std::string& name) const;

  /// Names of the objects in a group, in alphabetical order; empty when there is no such group.
  std::vector<std::string> names_in(const std::string& group) const;

  /// Writes a dataset by rows, groups on the way made as needed; compressed when it is large. T: double or
  /// std::int64_t.
  template <class T>
  void write(const std::string& name, const std::vector<std::size_t>& shape, std::span<const T> entries);
  template <class T>
  FileArray<T> read(const std::string& name) const;

  /// Attributes; `object` is "/" for the file itself.
  void write_attribute(const std::string& object, const std::string& name, const std::string& value);
  void write_attribute(const std::string& object, const std::string& name, double value);
  bool has_attribute(const std::string& object, const std::string& name) const;
  std::string read_text_attribute(const std::string& object, const std::string& name) const;
  double read_number_attribute(const std::string& object, const std::string& name) const;

 private:
  struct Handle;
  explicit Hdf5File(std::unique_ptr<Handle> handle);
  std::unique_ptr<Handle> handle_;
};

}  // namespace sandglass
