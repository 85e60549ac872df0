#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string_view>

/// The readers of files that come from outside, as a fuzzer feeds them. Whatever the bytes, each of them
/// returns or throws InputError: no crash, no other exception, no memory out of proportion to the file.
namespace sandglass::verification {

/// A reader and the name of its target and of its corpus.
struct Reader {
  std::string_view name;
  void (*read)(std::span<const std::byte> bytes, const std::filesystem::path& scratch);
};

/// A case file with its variants, and the scene that it describes; what counts elements is cut to a few.
void read_as_case_file(std::span<const std::byte> bytes, const std::filesystem::path& scratch);

/// A mesh file, and a scene with its mesh and sets.
void read_as_mesh_file(std::span<const std::byte> bytes, const std::filesystem::path& scratch);

/// A reference file of a scene of one element.
void read_as_reference_file(std::span<const std::byte> bytes, const std::filesystem::path& scratch);

/// A checkpoint of that scene, sealed after the fuzzer touched it: the seal would keep everything out.
void read_as_checkpoint_file(std::span<const std::byte> bytes, const std::filesystem::path& scratch);

/// A whole HDF5 file whose objects are not what their readers expect: the bytes say which dataset or
/// attribute is replaced, and by what class of type, rank, shape and values. So the fuzzer spends its time on
/// the readers, not on the library's own format.
void read_as_hdf5_content(std::span<const std::byte> bytes, const std::filesystem::path& scratch);

inline constexpr std::array readers{
    Reader{"case_file", read_as_case_file}, Reader{"mesh_file", read_as_mesh_file},
    Reader{"reference_file", read_as_reference_file}, Reader{"checkpoint_file", read_as_checkpoint_file},
    Reader{"hdf5_content", read_as_hdf5_content}};

}  // namespace sandglass::verification
