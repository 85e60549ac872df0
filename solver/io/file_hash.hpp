#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace sandglass {

/// The first bytes of a sealed file; what follows has the checksum that they tell.
inline constexpr std::size_t seal_size = 512;

/// XXH3 of 128 bits, in hexadecimal digits, of the bytes of a file from `skipped` on. Throws InputError when
/// it cannot be read.
std::string hash_of_file(const std::filesystem::path& path, std::size_t skipped = 0);

/// Writes the seal into the first bytes of a file. Throws ComputationError when that fails.
void write_seal(const std::filesystem::path& path);

/// Throws InputError unless a file is, to the bit, what was sealed.
void require_seal(const std::filesystem::path& path);

}  // namespace sandglass
