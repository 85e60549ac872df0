#include "io/project_folder.hpp"

namespace sandglass {

namespace fs = std::filesystem;

fs::path project_folder(const std::string& name) {
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path installed = (program.parent_path() / SANDGLASS_INSTALLED / name).lexically_normal();
  return fs::is_directory(installed, ignored) ? installed : fs::path(SANDGLASS_SOURCE) / name;
}

}  // namespace sandglass
