#include "io/text_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "base/error.hpp"

namespace sandglass {

NewTextFile::NewTextFile(const std::filesystem::path& path, const std::string& text) : file_(path) {
  const auto reason = [] { return std::generic_category().message(errno); };
  errno = 0;
  std::ofstream stream(file_.temporary(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw ComputationError(fmt::format("{}: cannot be completed: {}", path.string(), reason()));
}

void write_text_file(const std::filesystem::path& path, const std::string& text) {
  NewTextFile(path, text).commit();
}

}  // namespace sandglass
