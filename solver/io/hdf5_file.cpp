#include "io/hdf5_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <unistd.h>

#include <functional>
#include <numeric>
#include <system_error>

#include "base/error.hpp"

namespace sandglass {

namespace {

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

std::vector<hsize_t> dimensions(const std::vector<std::size_t>& shape) {
  return {shape.begin(), shape.end()};
}

hid_t native(double /*tag*/) {
  return H5T_NATIVE_DOUBLE;
}
hid_t native(std::int64_t /*tag*/) {
  return H5T_NATIVE_INT64;
}

}  // namespace

struct Hdf5File::Handle {
  hid_t file = -1;
  std::filesystem::path path;
  std::filesystem::path temporary;  // empty when reading

  Handle() = default;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (file >= 0) H5Fclose(file);
    std::error_code ignored;
    if (!temporary.empty()) std::filesystem::remove(temporary, ignored);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", path.string(), what));
  }

  void require(bool condition, const std::string& what) const {
    if (!condition) fail(what);
  }

  template <class T>
  void write(const std::string& name, const std::vector<std::size_t>& shape, std::span<const T> entries) {
    const auto dims = dimensions(shape);
    const Identifier space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
    const Identifier links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links.get(), 1);
    const Identifier creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation.get(), false);  // the same content gives the same bytes
    if (entries.size() >= compress_from) {
      H5Pset_chunk(creation.get(), static_cast<int>(dims.size()), dims.data());
      H5Pset_shuffle(creation.get());
      H5Pset_deflate(creation.get(), 4);
    }
    const Identifier set(
        H5Dcreate2(file, name.c_str(), native(T{}), space.get(), links.get(), creation.get(), H5P_DEFAULT),
        H5Dclose);
    require(set.valid(), fmt::format("cannot create dataset '{}'", name));
    require(H5Dwrite(set.get(), native(T{}), H5S_ALL, H5S_ALL, H5P_DEFAULT, entries.data()) >= 0,
            fmt::format("cannot write dataset '{}'; is the disk full?", name));
  }

  template <class T>
  FileArray<T> read(const std::string& name) const {
    const Identifier set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    require(
        set.valid(),
        fmt::format("dataset '{}' is missing; this is not a file that this program or its reference wrote",
                    name));
    const Identifier space(H5Dget_space(set.get()), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space.get());
    std::vector<hsize_t> dims(static_cast<std::size_t>(std::max(rank, 0)));
    H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr);
    FileArray<T> array{{dims.begin(), dims.end()}, {}};
    array.entries.resize(
        std::accumulate(array.shape.begin(), array.shape.end(), std::size_t{1}, std::multiplies<>()));
    require(H5Dread(set.get(), native(T{}), H5S_ALL, H5S_ALL, H5P_DEFAULT, array.entries.data()) >= 0,
            fmt::format("dataset '{}' cannot be read; the file is damaged or holds another type", name));
    return array;
  }
};

Hdf5File::Hdf5File(std::unique_ptr<Handle> handle) : handle_(std::move(handle)) {}
Hdf5File::Hdf5File(Hdf5File&&) noexcept = default;
Hdf5File::~Hdf5File() = default;

Hdf5File Hdf5File::create(const std::filesystem::path& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are reported in our own words
  auto handle = std::make_unique<Handle>();
  handle->path = path;
  std::filesystem::path temporary = path;
  temporary += fmt::format(".{}.part", getpid());
  handle->file = H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  handle->require(handle->file >= 0, "cannot be written; its folder must exist and be writable");
  handle->temporary = temporary;
  return Hdf5File(std::move(handle));
}

Hdf5File Hdf5File::open(const std::filesystem::path& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  auto handle = std::make_unique<Handle>();
  handle->path = path;
  std::error_code ignored;
  handle->require(std::filesystem::is_regular_file(path, ignored), "no such file");
  handle->file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  handle->require(handle->file >= 0, "is not a complete HDF5 file (truncated, or of another kind)");
  return Hdf5File(std::move(handle));
}

const std::filesystem::path& Hdf5File::path() const {
  return handle_->path;
}

void Hdf5File::commit() {
  const bool flushed = H5Fflush(handle_->file, H5F_SCOPE_GLOBAL) >= 0;
  const bool closed = H5Fclose(handle_->file) >= 0;
  handle_->file = -1;
  handle_->require(flushed && closed, "cannot be completed; is the disk full?");
  std::error_code error;
  std::filesystem::rename(handle_->temporary, handle_->path, error);
  handle_->require(!error, fmt::format("cannot be put in place: {}", error.message()));
  handle_->temporary.clear();
}

bool Hdf5File::contains(const std::string& name) const {
  return H5Lexists(handle_->file, name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5File::names_in(const std::string& group) const {
  std::vector<std::string> names;
  const Identifier id(H5Gopen2(handle_->file, group.c_str(), H5P_DEFAULT), H5Gclose);
  if (!id.valid()) return names;
  H5G_info_t info{};
  H5Gget_info(id.get(), &info);
  for (hsize_t n = 0; n < info.nlinks; ++n) {
    const auto length =
        H5Lget_name_by_idx(id.get(), ".", H5_INDEX_NAME, H5_ITER_INC, n, nullptr, 0, H5P_DEFAULT);
    std::string name(static_cast<std::size_t>(length), '\0');
    H5Lget_name_by_idx(id.get(), ".", H5_INDEX_NAME, H5_ITER_INC, n, name.data(), name.size() + 1,
                       H5P_DEFAULT);
    names.push_back(name);
  }
  return names;
}

void Hdf5File::write(const std::string& name, const std::vector<std::size_t>& shape,
                     std::span<const double> entries) {
  handle_->write(name, shape, entries);
}

void Hdf5File::write(const std::string& name, const std::vector<std::size_t>& shape,
                     std::span<const std::int64_t> entries) {
  handle_->write(name, shape, entries);
}

FileArray<double> Hdf5File::read_doubles(const std::string& name) const {
  return handle_->read<double>(name);
}

FileArray<std::int64_t> Hdf5File::read_integers(const std::string& name) const {
  return handle_->read<std::int64_t>(name);
}

void Hdf5File::write_attribute(const std::string& object, const std::string& name, const std::string& value) {
  const Identifier type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), H5T_VARIABLE);  // h5py reads this kind as a text, the fixed kind as bytes
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  const Identifier space(H5Screate(H5S_SCALAR), H5Sclose);
  const Identifier attribute(H5Acreate_by_name(handle_->file, object.c_str(), name.c_str(), type.get(),
                                               space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  const char* text = value.c_str();
  handle_->require(attribute.valid() && H5Awrite(attribute.get(), type.get(), &text) >= 0,
                   fmt::format("cannot write attribute '{}'", name));
}

void Hdf5File::write_attribute(const std::string& object, const std::string& name, double value) {
  const Identifier space(H5Screate(H5S_SCALAR), H5Sclose);
  const Identifier attribute(H5Acreate_by_name(handle_->file, object.c_str(), name.c_str(), H5T_NATIVE_DOUBLE,
                                               space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  handle_->require(attribute.valid() && H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, &value) >= 0,
                   fmt::format("cannot write attribute '{}'", name));
}

std::string Hdf5File::read_text_attribute(const std::string& object, const std::string& name) const {
  const Identifier attribute(
      H5Aopen_by_name(handle_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  handle_->require(attribute.valid(), fmt::format("attribute '{}' is missing", name));
  const Identifier type(H5Aget_type(attribute.get()), H5Tclose);
  handle_->require(H5Tget_class(type.get()) == H5T_STRING,
                   fmt::format("attribute '{}' must be a text", name));
  if (H5Tis_variable_str(type.get()) > 0) {  // what h5py writes
    char* text = nullptr;
    handle_->require(H5Aread(attribute.get(), type.get(), &text) >= 0 && text != nullptr,
                     fmt::format("attribute '{}' cannot be read", name));
    std::string value(text);
    H5free_memory(text);
    return value;
  }
  std::string value(H5Tget_size(type.get()), '\0');
  handle_->require(H5Aread(attribute.get(), type.get(), value.data()) >= 0,
                   fmt::format("attribute '{}' cannot be read", name));
  return value.substr(0, value.find('\0'));
}

double Hdf5File::read_number_attribute(const std::string& object, const std::string& name) const {
  const Identifier attribute(
      H5Aopen_by_name(handle_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  double value = 0.0;
  handle_->require(attribute.valid() && H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) >= 0,
                   fmt::format("attribute '{}' is missing or not a number", name));
  return value;
}

}  // namespace sandglass
