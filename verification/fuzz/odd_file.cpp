#include "fuzz/odd_file.hpp"

#include <hdf5.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "io/mesh_file.hpp"
#include "io/result_file.hpp"

namespace sandglass::verification {

namespace {

/// Makes decisions from bytes; zeros once they are used up.
class Decisions {
 public:
  explicit Decisions(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool any_left() const { return !bytes_.empty(); }

  /// A number in [0, n).
  std::size_t below(std::size_t n) { return take<std::uint8_t>() % n; }

  template <class T>
  T take() {
    T value{};
    const std::size_t size = std::min(sizeof value, bytes_.size());
    std::memcpy(&value, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
    return value;
  }

 private:
  std::span<const std::byte> bytes_;
};

/// A type of each class that a reader may encounter.
hid_t type_of(std::size_t choice) {
  switch (choice) {
    case 0:
      return H5Tcopy(H5T_IEEE_F64LE);
    case 1:
      return H5Tcopy(H5T_IEEE_F32BE);
    case 2:
      return H5Tcopy(H5T_STD_I64LE);
    case 3:
      return H5Tcopy(H5T_STD_U64BE);
    case 4:
      return H5Tcopy(H5T_STD_I8LE);
    case 5: {  // a text of fixed length
      const hid_t type = H5Tcopy(H5T_C_S1);
      H5Tset_size(type, 16);
      return type;
    }
    case 6: {
      const std::array<hsize_t, 1> three{3};
      return H5Tarray_create2(H5T_IEEE_F64LE, 1, three.data());
    }
    case 7: {
      const hid_t type = H5Tcreate(H5T_COMPOUND, 16);
      H5Tinsert(type, "a", 0, H5T_IEEE_F64LE);
      H5Tinsert(type, "b", 8, H5T_STD_I64LE);
      return type;
    }
    case 8: {  // a variable-length text, null
      const hid_t type = H5Tcopy(H5T_C_S1);
      H5Tset_size(type, H5T_VARIABLE);
      return type;
    }
    case 9:
      return H5Tvlen_create(H5T_STD_I32LE);
    case 10:
      return H5Tcopy(H5T_STD_REF_OBJ);
    default:
      return H5Tcreate(H5T_OPAQUE, 8);
  }
}
constexpr std::size_t types = 12;

/// None, a scalar, or up to four extents, most of them small.
hid_t space_of(Decisions& decide) {
  const std::size_t rank = decide.below(6);
  if (rank == 5) return H5Screate(H5S_NULL);
  std::array<hsize_t, 4> extents{};
  for (std::size_t i = 0; i < rank; ++i) {
    constexpr std::array<hsize_t, 8> usual{8, 3, 1, 0, 2, 24, 1ULL << 32U, 1ULL << 61U};
    const std::size_t choice = decide.below(16);
    extents[i] = choice < usual.size() ? usual[choice] : decide.take<std::uint8_t>();
  }
  return rank == 0 ? H5Screate(H5S_SCALAR)
                   : H5Screate_simple(static_cast<int>(rank), extents.data(), nullptr);
}

/// The number of points of a space; where it overflows, the largest number.
std::size_t points_of(hid_t space) {
  std::array<hsize_t, 4> extents{};
  const int rank = H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  double points = H5Sget_simple_extent_type(space) == H5S_NULL ? 0.0 : 1.0;
  for (int i = 0; i < rank; ++i) points *= static_cast<double>(extents[static_cast<std::size_t>(i)]);
  return points < 1e15 ? static_cast<std::size_t>(points) : std::numeric_limits<std::size_t>::max();
}

/// Larger objects have an extent but no values.
constexpr std::size_t most_points_written = 256;

/// Values for small objects; others have none, as in files with huge extents. Variable-length texts and lists
/// are pointers in memory and stay empty.
std::vector<std::byte> values_for(hid_t type, hid_t space, Decisions& decide) {
  const std::size_t points = points_of(space);
  if (points > most_points_written) return {};
  std::vector<std::byte> values(points * H5Tget_size(type) + 1);
  const bool pointers = H5Tis_variable_str(type) > 0 || H5Tget_class(type) == H5T_VLEN;
  if (!pointers) {
    for (auto& value : values) value = decide.take<std::byte>();
  }
  return values;
}

void replace_dataset(hid_t file, const char* name, Decisions& decide) {
  H5Ldelete(file, name, H5P_DEFAULT);
  const hid_t type = type_of(decide.below(types)), space = space_of(decide);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
  switch (decide.below(4)) {
    case 1: {  // values in another file
      H5Pset_external(creation, "/dev/zero", 0, H5F_UNLIMITED);
      break;
    }
    case 2: {
      const std::array<hsize_t, 4> chunk{4, 4, 4, 4};
      const int rank = H5Sget_simple_extent_ndims(space);
      if (rank > 0 && points_of(space) <= most_points_written) {
        H5Pset_chunk(creation, rank, chunk.data());
        H5Pset_deflate(creation, 1);
      }
      break;
    }
    default:
      break;
  }
  const hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  if (set >= 0) {
    if (const auto values = values_for(type, space, decide); !values.empty()) {
      H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
    H5Dclose(set);
  }
  H5Pclose(creation);
  H5Sclose(space);
  H5Tclose(type);
}

void replace_attribute(hid_t file, const char* name, Decisions& decide) {
  H5Adelete(file, name);
  const hid_t type = type_of(decide.below(types)), space = space_of(decide);
  const hid_t attribute = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  if (attribute >= 0) {
    if (const auto values = values_for(type, space, decide); !values.empty()) {
      H5Awrite(attribute, type, values.data());
    }
    H5Aclose(attribute);
  }
  H5Sclose(space);
  H5Tclose(type);
}

/// A link to another file, to nothing, or in a circle.
void replace_by_link(hid_t file, const char* name, Decisions& decide) {
  H5Ldelete(file, name, H5P_DEFAULT);
  switch (decide.below(4)) {
    case 0:
      H5Lcreate_external("/dev/null", "/x", file, name, H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 1:
      H5Lcreate_soft(name, file, name, H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 2:
      H5Lcreate_hard(file, "/", file, name, H5P_DEFAULT, H5P_DEFAULT);
      break;
    default:
      break;  // a link to nothing
  }
}

/// The bytes of a file that every reader accepts.
std::string good_file(const Scene& scene, const std::filesystem::path& path) {
  const std::size_t n_nodes = scene.mesh.points.size(), n_cells = scene.mesh.cells.size();
  const NodalField zero(n_nodes);
  const std::vector<double> row(7), elements(n_cells);
  auto file = Hdf5File::create(path, {.compressed = false, .sealed = true});
  write_mesh(scene, file);
  file.write("/displacement", {n_nodes, 3}, std::span<const double>(zero.front().data(), 3 * n_nodes));
  file.write("/history", {1, 7}, std::span<const double>(row));
  file.write("/state/a", {7}, std::span<const double>(row));
  write_frame(file, frame_group(0), {0.0, zero, zero, elements, elements});
  file.commit();
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

}  // namespace

void write_odd_file(const Scene& scene, std::span<const std::byte> bytes, const std::filesystem::path& path) {
  static const std::string good = good_file(scene, path);
  std::ofstream(path, std::ios::binary) << good;
  constexpr std::array datasets{"/mesh/points",
                                "/mesh/cells",
                                "/mesh/sets/foot",
                                "/mesh/sets/head",
                                "/mesh/sets",
                                "/mesh",
                                "/displacement",
                                "/history",
                                "/state/a",
                                "/state",
                                "/frames",
                                "/frames/0000",
                                "/frames/0000/displacement",
                                "/frames/0000/jacobian"};
  constexpr std::array attributes{"case_hash", "mesh_hash"};
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  for (Decisions decide(bytes); decide.any_left();) {
    switch (decide.below(4)) {
      case 0:
        replace_dataset(file, datasets[decide.below(datasets.size())], decide);
        break;
      case 1:
        replace_attribute(file, attributes[decide.below(attributes.size())], decide);
        break;
      case 2: {
        const hid_t frame = H5Gopen2(file, "/frames/0000", H5P_DEFAULT);
        if (frame >= 0) {
          replace_attribute(frame, "time", decide);
          H5Gclose(frame);
        }
        break;
      }
      default:
        replace_by_link(file, datasets[decide.below(datasets.size())], decide);
        break;
    }
  }
  H5Fclose(file);
}

}  // namespace sandglass::verification
