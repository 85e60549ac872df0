#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/ranks.hpp"

namespace sandglass {

/// An array in a file: its shape, and its entries by rows.
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
  bool compressed = true;  ///< for large datasets: smaller, but many times slower
  bool sealed = false;     ///< with a checksum of the whole file at its start
  std::shared_ptr<const Ranks> ranks = std::make_shared<const Ranks>();  ///< that write it together, all the
                                                                         ///< same, each a part of a dataset
};

/// An HDF5 file that closes itself. If a file cannot be read or created, it throws InputError with the file,
/// the name inside it and the rule; if the disk fails, ComputationError. A new file is written to a temporary
/// file beside it, which `commit` renames; without `commit` nothing is left.
class Hdf5File {
 public:
  /// Starts a new file. Throws InputError if it cannot be created.
  static Hdf5File create(const std::filesystem::path& path, Storage storage = {});

  /// Opens a file for reading. Throws InputError if it is missing, truncated or not HDF5.
  static Hdf5File open(const std::filesystem::path& path);

  /// The same for a sealed file; also throws InputError if any bit has changed.
  static Hdf5File open_sealed(const std::filesystem::path& path);

  Hdf5File(const Hdf5File&) = delete;
  Hdf5File(Hdf5File&&) noexcept;
  Hdf5File& operator=(const Hdf5File&) = delete;
  Hdf5File& operator=(Hdf5File&&) = delete;
  ~Hdf5File();

  const std::filesystem::path& path() const;

  /// Finishes a file from `create`: closes it, waits for the disk and renames it.
  void commit();

  bool contains(const std::string& name) const;

  /// Names of the objects in a group, in alphabetical order; empty if there is no such group.
  std::vector<std::string> names_in(const std::string& group) const;

  /// Writes a dataset by rows, creates missing groups, and compresses large datasets. T: double or
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
