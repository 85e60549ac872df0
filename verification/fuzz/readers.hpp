#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string_view>

/// The readers of external files, for fuzzers. For any bytes each of them returns or throws InputError: no
/// crash, no other exception, no memory out of proportion to the file.
namespace sandglass::verification {

/// A reader and the name of its target and of its corpus.
struct Reader {
  std::string_view name;
  void (*read)(std::span<const std::byte> bytes, const std::filesystem::path& scratch);
};

/// A case file with its variants, and the scene that it describes; numbers of elements are limited to a few.
void read_as_case_file(std::span<const std::byte> bytes, const std::filesystem::path& scratch);

/// A mesh file, and a scene with its mesh and sets.
void read_as_mesh_file(std::span<const std::byte> bytes, const std::filesystem::path& scratch);

/// A reference file of a scene of one element.
void read_as_reference_file(std::span<const std::byte> bytes, const std::filesystem::path& scratch);

/// A checkpoint of that scene, sealed after the fuzzer's changes: the seal would reject everything.
void read_as_checkpoint_file(std::span<const std::byte> bytes, const std::filesystem::path& scratch);

/// A valid HDF5 file with unexpected objects: the bytes choose a dataset or attribute to replace, and the new
/// class of type, rank, shape and values. So the fuzzer spends its time on the readers, not on the HDF5
/// format.
void read_as_hdf5_content(std::span<const std::byte> bytes, const std::filesystem::path& scratch);

inline constexpr std::array readers{
    Reader{"case_file", read_as_case_file}, Reader{"mesh_file", read_as_mesh_file},
    Reader{"reference_file", read_as_reference_file}, Reader{"checkpoint_file", read_as_checkpoint_file},
    Reader{"hdf5_content", read_as_hdf5_content}};

}  // namespace sandglass::verification
