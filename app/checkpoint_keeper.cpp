#include "app/checkpoint_keeper.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <system_error>

#include "app/machine.hpp"
#include "app/progress.hpp"
#include "base/error.hpp"
#include "io/file_hash.hpp"
#include "io/new_file.hpp"
#include "mesh/hash.hpp"

namespace sandglass {

namespace {

namespace fs = std::filesystem;

/// A hash of every bit that a run reads: case file and mesh. The hashes that identify an answer leave out
/// settings, and roundoff in a mesh.
std::string input_hash(const Scene& scene) {
  std::ostringstream bytes;
  bytes << std::ifstream(scene.settings.file, std::ios::binary).rdbuf() << scene.settings.name;
  const auto& [points, cells] = scene.mesh;
  bytes.write(reinterpret_cast<const char*>(points.data()),
              static_cast<std::streamsize>(points.size() * sizeof points[0]));
  bytes.write(reinterpret_cast<const char*>(cells.data()),
              static_cast<std::streamsize>(cells.size() * sizeof cells[0]));
  return hash_of(bytes.str());
}

Identity identity_of_run(const Model& model) {
  Identity identity = identity_of(model);
  identity.emplace_back("input_hash", input_hash(model.scene()));
  for (auto& entry : program_identity()) identity.push_back(std::move(entry));
  return identity;
}

}  // namespace

CheckpointKeeper::CheckpointKeeper(const Model& model, fs::path file, double seconds)
    : file_(std::move(file)),
      identity_(identity_of_run(model)),
      interval_(seconds),
      ranks_(model.choice().ranks) {
  require_place(file_);
  std::error_code ignored;
  if (!fs::exists(file_, ignored)) return;
  const Mesh& mesh = model.scene().mesh;
  run_ = read_checkpoint_file(file_, identity_, mesh.points.size(), mesh.cells.size());
  resumed_ = true;
}

void CheckpointKeeper::resumable(const std::function<Checkpoint()>& checkpoint) {
  const auto now = std::chrono::steady_clock::now();
  if (!ranks_->any(now - last_ >= interval_ || interrupted())) return;
  last_ = now;
  try {
    run_.point = checkpoint();
    if (ranks_->rank() == 0) write_checkpoint_file(file_, identity_, run_);
  } catch (const std::exception& error) {
    fmt::print(stderr, "warning: checkpoint not written, the run continues: {}\n", error.what());
  }
}

void CheckpointKeeper::finish() {
  std::error_code error;
  if (ranks_->rank() == 0) fs::remove(file_, error);
  if (error) {
    fmt::print(stderr, "warning: {}: cannot be removed: {}\n", file_.string(), error.message());
  }
}

}  // namespace sandglass
