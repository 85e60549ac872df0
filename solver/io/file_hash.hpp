#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace sandglass {

/// The number of first bytes of a sealed file; they hold the checksum of the rest.
inline constexpr std::size_t seal_size = 512;

/// XXH3 of 128 bits, in hexadecimal digits, of the bytes of a file from `skipped`. Throws InputError if it
/// cannot be read.
std::string hash_of_file(const std::filesystem::path& path, std::size_t skipped = 0);

/// Writes the seal into the first bytes of a file. Throws ComputationError if that fails.
void write_seal(const std::filesystem::path& path);

/// Throws InputError unless a file is unchanged since it was sealed.
void require_seal(const std::filesystem::path& path);

}  // namespace sandglass
