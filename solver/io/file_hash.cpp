#include "io/file_hash.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <fstream>
#include <memory>
#include <vector>

#include "base/error.hpp"

namespace sandglass {

namespace {

/// The seal of a file, padded with zeros.
std::string seal_of(const std::filesystem::path& path) {
  std::string seal = fmt::format("sandglass seal 1: XXH3 {}\n", hash_of_file(path, seal_size));
  seal.resize(seal_size, '\0');
  return seal;
}

}  // namespace

std::string hash_of_file(const std::filesystem::path& path, std::size_t skipped) {
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                              XXH3_freeState);
  XXH3_128bits_reset(state.get());
  std::ifstream stream(path, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(skipped));
  std::vector<char> block(1U << 20U);
  while (stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    XXH3_128bits_update(state.get(), block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof()) throw InputError(fmt::format("{}: cannot be read", path.string()));
  const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

void write_seal(const std::filesystem::path& path) {
  const std::string seal = seal_of(path);
  std::fstream stream(path, std::ios::binary | std::ios::in | std::ios::out);
  stream.write(seal.data(), static_cast<std::streamsize>(seal.size()));
  stream.close();
  if (!stream)
    throw ComputationError(fmt::format("{}: cannot be completed; is the disk full?", path.string()));
}

void require_seal(const std::filesystem::path& path) {
  std::string seal(seal_size, '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(seal.data(), static_cast<std::streamsize>(seal.size()));
  if (!stream || seal != seal_of(path)) {
    throw InputError(
        fmt::format("{}: is damaged or not a checkpoint: its checksum does not match its content; "
                    "delete it to start again",
                    path.string()));
  }
}

}  // namespace sandglass
