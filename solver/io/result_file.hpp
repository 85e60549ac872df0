#pragma once

#include <filesystem>
#include <vector>

#include "io/hdf5_file.hpp"
#include "problem/model.hpp"
#include "problem/observer.hpp"

namespace sandglass {

/// Text attributes on the origin of a result: revision, flags, method and so on.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// Writes a frame as the group of that name, and reads it with the mesh's numbers of nodes and elements;
/// throws InputError if a dataset is missing or has another size.
void write_frame(Hdf5File& file, const std::string& group, const Frame& frame);
Frame read_frame(const Hdf5File& file, const std::string& group, std::size_t n_nodes, std::size_t n_elements);

/// The XDMF file beside a result file.
std::filesystem::path guide_of(const std::filesystem::path& result);

/// What frames and rows of the history have of sets and obstacles: a vector by name.
struct ReactionGroup {
  std::string folder, unit;
  Reactions Frame::*of_frame;
  Reactions HistoryRow::*of_row;
};
inline const std::array reaction_groups{
    ReactionGroup{"/reaction/", "N", &Frame::reactions, &HistoryRow::reactions},
    ReactionGroup{"/moment/", "N m", &Frame::moments, &HistoryRow::moments}};

/// Writes the reactions of a history, each set's as GROUP/reaction/SET (rows, 3) in N, and moments.
void write_reactions(Hdf5File& file, const std::string& group, const std::vector<HistoryRow>& history);

/// The name of the group of a frame.
std::string frame_group(std::size_t number);

/// Writes a run: mesh and sets, /frames/NNNN/{displacement (m), velocity (m/s), jacobian (-),
/// hourglass_energy_density (J/m^3), stress (Pa), reaction/SET (N), level (of an adaptive method)} with
/// attribute `time`, and /history/*. Beside it, an XDMF file of the same stem opens in ParaView. No file is
/// in place before `commit`.
class ResultWriter {
 public:
  ResultWriter(const Model& model, const std::filesystem::path& path, const Provenance& provenance);

  void frame(const Frame& frame);
  void history(const HistoryRow& row) { history_.push_back(row); }

  /// The frames so far; the first is the undeformed body.
  std::size_t frames() const { return times_.size(); }

  /// Writes a text attribute of the file.
  void note(const std::string& name, const std::string& text) { file_.write_attribute("/", name, text); }

  /// `status` is "complete" or describes how the run ended.
  void commit(const std::string& status);

 private:
  void write_history();
  std::string xdmf() const;

  const Model& model_;
  std::filesystem::path path_;
  Hdf5File file_;
  std::vector<double> times_;
  bool has_levels_ = false;
  bool has_stresses_ = false;
  std::vector<HistoryRow> history_;
};

}  // namespace sandglass
