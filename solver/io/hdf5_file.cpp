#include "io/hdf5_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <system_error>
#include <type_traits>
#include <utility>

#include "base/error.hpp"
#include "io/file_hash.hpp"
#include "io/new_file.hpp"

namespace sandglass {

namespace {

/// How these ranks write a file together; null for those that do not.
const WritesHdf5Together* shared_writer(const Ranks& ranks) {
  return dynamic_cast<const WritesHdf5Together*>(&ranks);
}

/// An HDF5 identifier that closes itself.
class Identifier {
 public:
  Identifier(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Identifier(const Identifier&) = delete;
  Identifier& operator=(const Identifier&) = delete;
  ~Identifier() {
    if (id_ >= 0) close_(id_);
  }
  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Datasets of at least this many entries are compressed; below, the filter costs more than it saves.
constexpr std::size_t compress_from = 4096;

hid_t native(double /*tag*/) {
  return H5T_NATIVE_DOUBLE;
}
hid_t native(std::int64_t /*tag*/) {
  return H5T_NATIVE_INT64;
}

/// The largest compression ratio of the library (zlib: 1032 to 1).
constexpr std::size_t most_compression = 1032;

/// The number of entries of a shape, or the largest number if it overflows.
std::size_t entries_of(const std::vector<std::size_t>& shape) {
  constexpr std::size_t most = std::numeric_limits<std::size_t>::max();
  if (std::find(shape.begin(), shape.end(), 0U) != shape.end()) return 0;
  std::size_t entries = 1;
  for (const std::size_t extent : shape) {
    if (entries > most / extent) return most;
    entries *= extent;
  }
  return entries;
}

/// The most bytes that a dataset can hold for each byte of its file: one, more if compressed, or none if its
/// values are in another file.
std::size_t most_bytes_per_byte(const Identifier& set) {
  const Identifier creation(H5Dget_create_plist(set.get()), H5Pclose);
  const H5D_layout_t layout = H5Pget_layout(creation.get());
  if (layout == H5D_CHUNKED) return most_compression;
  const bool own =
      layout == H5D_COMPACT || (layout == H5D_CONTIGUOUS && H5Pget_external_count(creation.get()) == 0);
  return own ? 1 : 0;
}

/// Whether a type is a number of at most eight bytes. In damaged files it may have no size.
bool is_number(const Identifier& type) {
  const H5T_class_t kind = H5Tget_class(type.get());
  const std::size_t bytes = H5Tget_size(type.get());
  return (kind == H5T_INTEGER || kind == H5T_FLOAT) && bytes > 0 && bytes <= 8;
}

/// Whether an attribute holds exactly one value.
bool is_single(const Identifier& attribute) {
  const Identifier space(H5Aget_space(attribute.get()), H5Sclose);
  return H5Sget_simple_extent_npoints(space.get()) == 1;
}

/// The system's message about the last failure of the library; "is the disk full?" if there is none.
std::string reason_of_failure() {
  std::string reason = "is the disk full?";
  const auto look = [](unsigned /*n*/, const H5E_error2_t* error, void* found) -> herr_t {
    constexpr std::string_view before = "error message = '";
    const std::string_view text = error->desc == nullptr ? "" : error->desc;
    const auto begin = text.find(before);
    if (begin == std::string_view::npos) return 0;
    const auto message = text.substr(begin + before.size());
    *static_cast<std::string*>(found) = message.substr(0, message.find('\''));
    return 1;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, look, &reason);
  return reason;
}

/// Sets up the library before its first use. This program closes its files itself: at exit, the library would
/// try again to complete a file that did not fit on a full disk, and crash. The library prints no errors, and
/// no file can make it load a filter.
void prepare_library() {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5PLset_loading_state(0);
}

}  // namespace

struct Hdf5File::Handle {
  hid_t file = -1;
  std::filesystem::path path;
  std::optional<NewFile> being_written;
  Storage storage;
  std::size_t size = 0;  // bytes, of a file being read

  Handle() = default;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (file >= 0) H5Fclose(file);
  }

  void require(bool condition, const std::string& what) const {
    if (!condition) throw InputError(fmt::format("{}: {}", path.string(), what));
  }

  void require_written(bool condition, const std::string& what) const {
    if (condition) return;
    throw ComputationError(fmt::format("{}: {}: {}", path.string(), what, reason_of_failure()));
  }

  void write_attribute(const std::string& object, const std::string& name, hid_t type,
                       const void* value) const {
    const Identifier space(H5Screate(H5S_SCALAR), H5Sclose);
    const Identifier attribute(H5Acreate_by_name(file, object.c_str(), name.c_str(), type, space.get(),
                                                 H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose);
    require_written(attribute.valid() && H5Awrite(attribute.get(), type, value) >= 0,
                    fmt::format("cannot write attribute '{}'", name));
  }
};

Hdf5File::Hdf5File(std::unique_ptr<Handle> handle) : handle_(std::move(handle)) {}
Hdf5File::Hdf5File(Hdf5File&&) noexcept = default;
Hdf5File::~Hdf5File() = default;

Hdf5File Hdf5File::create(const std::filesystem::path& path, Storage storage) {
  prepare_library();
  auto handle = std::make_unique<Handle>();
  handle->path = path;
  handle->storage = std::move(storage);
  const Ranks& ranks = *handle->storage.ranks;
  if (ranks.rank() == 0) handle->being_written.emplace(path);
  const auto process = static_cast<int>(ranks.of_all(getpid())[0]);
  const Identifier creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose),
      access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  if (handle->storage.sealed) H5Pset_userblock(creation.get(), seal_size);
  if (const auto* shared = shared_writer(ranks)) shared->open_together(access.get());
  handle->file =
      H5Fcreate(temporary_path(path, process).c_str(), H5F_ACC_TRUNC, creation.get(), access.get());
  handle->require_written(handle->file >= 0, "cannot be completed");
  return Hdf5File(std::move(handle));
}

Hdf5File Hdf5File::open(const std::filesystem::path& path) {
  prepare_library();
  auto handle = std::make_unique<Handle>();
  handle->path = path;
  std::error_code ignored;
  handle->require(std::filesystem::is_regular_file(path, ignored), "no such file");
  handle->size = std::filesystem::file_size(path, ignored);
  handle->file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  handle->require(handle->file >= 0, "is not a complete HDF5 file (truncated, or of another kind)");
  return Hdf5File(std::move(handle));
}

Hdf5File Hdf5File::open_sealed(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) require_seal(path);
  return open(path);
}

const std::filesystem::path& Hdf5File::path() const {
  return handle_->path;
}

void Hdf5File::commit() {
  handle_->require_written(H5Fflush(handle_->file, H5F_SCOPE_GLOBAL) >= 0, "cannot be completed");
  const bool closed = H5Fclose(std::exchange(handle_->file, -1)) >= 0;
  handle_->require_written(closed, "cannot be completed");
  if (!handle_->being_written) return;
  if (handle_->storage.sealed) write_seal(handle_->being_written->temporary());
  handle_->being_written->commit();
}

bool Hdf5File::contains(const std::string& name) const {
  return H5Lexists(handle_->file, name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5File::names_in(const std::string& group) const {
  std::vector<std::string> names;
  const Identifier id(H5Gopen2(handle_->file, group.c_str(), H5P_DEFAULT), H5Gclose);
  if (!id.valid()) return names;
  const auto add = [](hid_t /*group*/, const char* name, const H5L_info_t* /*info*/, void* to) -> herr_t {
    static_cast<std::vector<std::string>*>(to)->emplace_back(name);
    return 0;
  };
  handle_->require(H5Literate(id.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names) >= 0,
                   fmt::format("group '{}' cannot be read; the file is damaged", group));
  return names;
}

template <class T>
void Hdf5File::write(const std::string& name, const std::vector<std::size_t>& shape,
                     std::span<const T> entries) {
  const std::vector<hsize_t> dims(shape.begin(), shape.end());
  const Identifier space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
  const Identifier links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links.get(), 1);
  const Identifier creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.get(), false);  // the same content gives the same bytes
  const auto count = static_cast<std::size_t>(handle_->storage.ranks->count());
  if (handle_->storage.compressed && count == 1 && entries.size() >= compress_from) {
    H5Pset_chunk(creation.get(), static_cast<int>(dims.size()), dims.data());
    H5Pset_shuffle(creation.get());
    H5Pset_deflate(creation.get(), 4);
  }
  const Identifier set(H5Dcreate2(handle_->file, name.c_str(), native(T{}), space.get(), links.get(),
                                  creation.get(), H5P_DEFAULT),
                       H5Dclose);
  handle_->require_written(set.valid(), fmt::format("cannot create dataset '{}'", name));
  // Each rank writes some of the entries along the first axis.
  const auto rank = static_cast<std::size_t>(handle_->storage.ranks->rank());
  const std::size_t first = shape[0] * rank / count, last = shape[0] * (rank + 1) / count;
  std::vector<hsize_t> begin(dims.size()), part = dims;
  begin[0] = first;
  part[0] = last - first;
  const Identifier memory(H5Screate_simple(static_cast<int>(dims.size()), part.data(), nullptr), H5Sclose);
  if (first < last) {
    H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, begin.data(), nullptr, part.data(), nullptr);
  } else {
    H5Sselect_none(space.get());
    H5Sselect_none(memory.get());
  }
  const Identifier transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  if (const auto* shared = shared_writer(*handle_->storage.ranks)) shared->write_together(transfer.get());
  const T* from = entries.data() + (shape[0] > 0 ? entries.size() / shape[0] * first : 0);
  handle_->require_written(
      H5Dwrite(set.get(), native(T{}), memory.get(), space.get(), transfer.get(), from) >= 0,
      fmt::format("cannot write dataset '{}'", name));
}

template <class T>
FileArray<T> Hdf5File::read(const std::string& name) const {
  const Identifier set(H5Dopen2(handle_->file, name.c_str(), H5P_DEFAULT), H5Dclose);
  handle_->require(
      set.valid(),
      fmt::format("dataset '{}' is missing; this file is not from this program or its reference", name));
  const Identifier type(H5Dget_type(set.get()), H5Tclose);
  handle_->require(is_number(type), fmt::format("dataset '{}' must hold numbers", name));
  handle_->require(std::is_floating_point_v<T> || H5Tget_class(type.get()) == H5T_INTEGER,
                   fmt::format("dataset '{}' must hold integers", name));
  const Identifier space(H5Dget_space(set.get()), H5Sclose);
  handle_->require(H5Sget_simple_extent_type(space.get()) == H5S_SIMPLE,
                   fmt::format("dataset '{}' must be an array", name));
  std::vector<hsize_t> dims(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.get())));
  H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr);
  FileArray<T> array{{dims.begin(), dims.end()}, {}};
  const std::size_t entries = entries_of(array.shape);
  handle_->require(entries <= most_bytes_per_byte(set) * handle_->size / H5Tget_size(type.get()),
                   fmt::format("dataset '{}' claims {} values, more than a file of {} bytes can hold", name,
                               entries, handle_->size));
  array.entries.resize(entries);
  handle_->require(
      H5Dread(set.get(), native(T{}), H5S_ALL, H5S_ALL, H5P_DEFAULT, array.entries.data()) >= 0,
      fmt::format("dataset '{}' cannot be read; the file is damaged or holds another type", name));
  return array;
}

template void Hdf5File::write(const std::string&, const std::vector<std::size_t>&, std::span<const double>);
template void Hdf5File::write(const std::string&, const std::vector<std::size_t>&,
                              std::span<const std::int64_t>);
template FileArray<double> Hdf5File::read(const std::string&) const;
template FileArray<std::int64_t> Hdf5File::read(const std::string&) const;

void Hdf5File::write_attribute(const std::string& object, const std::string& name, const std::string& value) {
  const Identifier type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), H5T_VARIABLE);  // h5py reads this kind as text, the fixed kind as bytes
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  const char* text = value.c_str();
  handle_->write_attribute(object, name, type.get(), &text);
}

void Hdf5File::write_attribute(const std::string& object, const std::string& name, double value) {
  handle_->write_attribute(object, name, H5T_NATIVE_DOUBLE, &value);
}

bool Hdf5File::has_attribute(const std::string& object, const std::string& name) const {
  return H5Aexists_by_name(handle_->file, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::string Hdf5File::read_text_attribute(const std::string& object, const std::string& name) const {
  const Identifier attribute(
      H5Aopen_by_name(handle_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  handle_->require(attribute.valid(), fmt::format("attribute '{}' is missing", name));
  const Identifier type(H5Aget_type(attribute.get()), H5Tclose);
  handle_->require(H5Tget_class(type.get()) == H5T_STRING && is_single(attribute),
                   fmt::format("attribute '{}' must be a text", name));
  if (H5Tis_variable_str(type.get()) > 0) {  // as written by h5py
    char* text = nullptr;
    handle_->require(H5Aread(attribute.get(), type.get(), &text) >= 0 && text != nullptr,
                     fmt::format("attribute '{}' cannot be read", name));
    std::string value(text);
    H5free_memory(text);
    return value;
  }
  std::string value(std::min(H5Tget_size(type.get()), handle_->size + 1), '\0');
  handle_->require(value.size() <= handle_->size && H5Aread(attribute.get(), type.get(), value.data()) >= 0,
                   fmt::format("attribute '{}' cannot be read", name));
  return value.substr(0, value.find('\0'));
}

double Hdf5File::read_number_attribute(const std::string& object, const std::string& name) const {
  const Identifier attribute(
      H5Aopen_by_name(handle_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const std::string rule = fmt::format("attribute '{}' is missing or not a number", name);
  handle_->require(attribute.valid(), rule);
  const Identifier type(H5Aget_type(attribute.get()), H5Tclose);
  double value = 0.0;
  handle_->require(
      is_number(type) && is_single(attribute) && H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) >= 0,
      rule);
  return value;
}

}  // namespace sandglass
