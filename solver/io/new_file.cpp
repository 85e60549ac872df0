#include "io/new_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <string>
#include <system_error>

#include "base/error.hpp"

namespace sandglass {

namespace {

namespace fs = std::filesystem;

/// Waits until a file or the entries of a folder are on the disk; returns an error number, or 0.
int synchronize(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return errno;
  const int error = fsync(file) == 0 ? 0 : errno;
  close(file);
  return error;
}

/// Whether the file is abandoned: its process no longer exists, and no process on another computer holds a
/// lock.
bool is_abandoned(const fs::path& part, const std::string& process) {
  const pid_t id = std::atoi(process.c_str());
  if (id <= 0 || kill(id, 0) == 0 || errno != ESRCH) return false;
  const int file = open(part.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool free = flock(file, LOCK_EX | LOCK_NB) == 0;
  close(file);
  return free;
}

/// Blocks signals that end the program during its lifetime, so that no temporary file is left behind.
class Undisturbed {
 public:
  Undisturbed() {
    sigset_t both;
    sigemptyset(&both);
    for (const int signal : {SIGINT, SIGTERM}) sigaddset(&both, signal);
    pthread_sigmask(SIG_BLOCK, &both, &before_);
  }
  Undisturbed(const Undisturbed&) = delete;
  Undisturbed& operator=(const Undisturbed&) = delete;
  ~Undisturbed() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_{};
};

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Removes files PATH.PROCESS.part of programs that were killed.
void remove_abandoned(const fs::path& path) {
  const std::string before = path.filename().string() + ".", after = ".part";
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_of(path), ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after))
      continue;
    const auto process = name.substr(before.size(), name.size() - before.size() - after.size());
    if (process.find_first_not_of("0123456789") != std::string::npos) continue;
    if (is_abandoned(entry.path(), process)) fs::remove(entry.path(), ignored);
  }
}

}  // namespace

fs::path temporary_path(const fs::path& path, int process) {
  return fs::path(path) += fmt::format(".{}.part", process);
}

NewFile::NewFile(const fs::path& path) : path_(path), temporary_(temporary_path(path, getpid())) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    throw InputError(
        fmt::format("{}: cannot be put in place: something that is not a file has this name", path.string()));
  }
  remove_abandoned(path);
  const int file = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) {
    throw InputError(fmt::format("{}: cannot be written: {}; its folder must exist and be writable",
                                 path.string(), std::generic_category().message(errno)));
  }
  close(file);
}

NewFile::~NewFile() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void NewFile::commit() {
  if (const int error = synchronize(temporary_); error != 0) {
    throw ComputationError(
        fmt::format("{}: cannot be completed: {}", path_.string(), std::generic_category().message(error)));
  }
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) throw InputError(fmt::format("{}: cannot be put in place: {}", path_.string(), error.message()));
  temporary_.clear();
  synchronize(folder_of(path_));  // if the system supports that for folders
}

void require_place(const fs::path& path, const std::vector<fs::path>& inputs) {
  for (const fs::path& input : inputs) {
    std::error_code ignored;
    if (!fs::equivalent(path, input, ignored)) continue;
    throw InputError(fmt::format(
        "{}: is an input of this command and would be overwritten; name another output file", path.string()));
  }
  const Undisturbed meanwhile;
  const NewFile tried(path);
}

void require_places(const std::vector<fs::path>& paths, const std::vector<fs::path>& inputs) {
  std::vector<fs::path> places;
  for (const fs::path& path : paths) {
    if (path.empty()) continue;
    require_place(path, inputs);
    places.push_back(fs::weakly_canonical(fs::absolute(path)));
    if (std::ranges::count(places, places.back()) > 1) {
      throw InputError(fmt::format("{}: would be written twice by this command; name different output files",
                                   path.string()));
    }
  }
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!error && fs::is_directory(path, error)) return;
  throw InputError(fmt::format("{}: this folder cannot be created: {}", path.string(),
                               error ? error.message() : "a file has this name"));
}

}  // namespace sandglass
