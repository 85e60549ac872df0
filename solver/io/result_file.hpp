#pragma once

#include <filesystem>
#include <vector>

#include "io/hdf5_file.hpp"
#include "model/model.hpp"
#include "stepping/observer.hpp"

namespace sandglass {

/// Text attributes that tell where a result comes from: revision, flags, method and the like.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// Writes a run: mesh and sets, /frames/NNNN/{displacement (m), velocity (m/s), jacobian (-),
/// hourglass_energy_density (J/m^3)} with attribute `time`, and /history/*. Beside it, an XDMF file of the
/// same stem opens in ParaView. Nothing is in place before `commit`.
class ResultWriter {
 public:
  ResultWriter(const Model& model, const std::filesystem::path& path, const Provenance& provenance);

  void frame(const Frame& frame);
  void history(const HistoryRow& row) { history_.push_back(row); }

  /// `status` is "complete" or says how the run ended.
  void commit(const std::string& status);

 private:
  void write_history();
  std::string xdmf() const;

  const Model& model_;
  std::filesystem::path path_;
  Hdf5File file_;
  std::vector<double> times_;
  std::vector<HistoryRow> history_;
};

}  // namespace sandglass
