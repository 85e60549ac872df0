#include "io/project_folder.hpp"

#include <dlfcn.h>
#include <link.h>

namespace sandglass {

namespace fs = std::filesystem;

namespace {

/// The prefix of an installation that contains this code: of PREFIX/bin/PROGRAM, or of a shared object such
/// as PREFIX/lib/python3/dist-packages/MODULE.
fs::path own_prefix() {
  static const char here = 0;
  Dl_info ignored{};
  link_map* object = nullptr;
  dladdr1(&here, &ignored, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP);
  if (object != nullptr && *object->l_name != '\0')  // empty for the program itself
    return fs::absolute(object->l_name).parent_path() / "../../..";
  std::error_code none;
  return fs::read_symlink("/proc/self/exe", none).parent_path() / "..";
}

}  // namespace

fs::path project_folder(const std::string& name) {
  std::error_code ignored;
  fs::path installed = (own_prefix() / SANDGLASS_SHARE / name).lexically_normal();
  if (fs::is_directory(installed, ignored)) return installed;
  const fs::path source = fs::path(SANDGLASS_SOURCE) / name;
  return fs::is_directory(source, ignored) ? source : fs::path(SANDGLASS_PREFIX) / SANDGLASS_SHARE / name;
}

}  // namespace sandglass
