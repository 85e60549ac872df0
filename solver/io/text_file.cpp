#include "io/text_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <system_error>

#include "base/error.hpp"

namespace sandglass {

void write_text_file(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::path temporary = path;
  temporary += fmt::format(".{}.part", getpid());
  std::error_code error;
  {
    std::ofstream stream(temporary, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream) {
      std::filesystem::remove(temporary, error);
      throw InputError(fmt::format("{}: cannot be written; its folder must exist, be writable and have room",
                                   path.string()));
    }
  }
  std::filesystem::rename(temporary, path, error);
  if (error) {
    const std::string reason = error.message();
    std::filesystem::remove(temporary, error);
    throw InputError(fmt::format("{}: cannot be put in place: {}", path.string(), reason));
  }
}

}  // namespace sandglass
