#include "io/checkpoint_file.hpp"

#include <fmt/format.h>

#include <array>

#include "base/error.hpp"
#include "io/hdf5_file.hpp"
#include "io/mesh_file.hpp"
#include "io/result_file.hpp"

namespace sandglass {

namespace {

constexpr std::array history_columns{
    &HistoryRow::time,          &HistoryRow::kinetic,  &HistoryRow::strain,    &HistoryRow::hourglass,
    &HistoryRow::external_work, &HistoryRow::residual, &HistoryRow::step_size, &HistoryRow::adaption,
    &HistoryRow::contact,       &HistoryRow::friction, &HistoryRow::depth,     &HistoryRow::damping};
static_assert(sizeof(HistoryRow) == history_columns.size() * sizeof(double) + 2 * sizeof(Reactions),
              "a column is missing");

void write_history(Hdf5File& file, const std::vector<HistoryRow>& history) {
  std::vector<double> values;
  for (const auto& row : history) {
    for (const auto column : history_columns) values.push_back(row.*column);
  }
  file.write("/history", {history.size(), history_columns.size()}, std::span<const double>(values));
  write_reactions(file, "", history);
}

std::vector<HistoryRow> read_history(const Hdf5File& file) {
  const auto values = file.read<double>("/history");
  if (values.shape.size() != 2 || values.shape[1] != history_columns.size()) {
    throw InputError(fmt::format("{}: dataset '/history' must have {} columns", file.path().string(),
                                 history_columns.size()));
  }
  std::vector<HistoryRow> history(values.shape[0]);
  auto value = values.entries.begin();
  for (auto& row : history) {
    for (const auto column : history_columns) row.*column = *value++;
  }
  for (const auto& [folder, unit, of_frame, of_row] : reaction_groups) {
    for (const auto& set : file.names_in(folder)) {
      const NodalField vectors = read_nodal_field(file, folder + set, history.size());
      for (std::size_t n = 0; n < history.size(); ++n) (history[n].*of_row)[set] = vectors[n];
    }
  }
  return history;
}

void require_identity(const Hdf5File& file, const Identity& identity) {
  std::string differences;
  for (const auto& [name, value] : identity) {
    const std::string found = file.read_text_attribute("/", name);
    if (found == value) continue;
    differences += fmt::format("\n  {}: '{}' in the checkpoint, '{}' in this run", name, found, value);
  }
  if (differences.empty()) return;
  throw InputError(
      fmt::format("{}: is the checkpoint of another run; only the same program can resume it, with the same "
                  "input and options; differences:{}\nallowed: resume it with the program and input that "
                  "made it, delete it to start again, or name another file",
                  file.path().string(), differences));
}

}  // namespace

Identity identity_of(const Model& model) {
  const Scene& scene = model.scene();
  const MethodChoice& choice = model.choice();
  return {{"case", scene.settings.name},
          {"case_hash", scene.case_hash},
          {"mesh_hash", scene.mesh_hash},
          {"method", choice.method},
          {"kappa", choice.kappa ? fmt::to_string(*choice.kappa) : "auto"},
          {"kappa_modulus", choice.kappa_modulus == KappaModulus::shear ? "shear" : "p-wave"},
          {"accuracy", fmt::to_string(choice.accuracy)},
          {"precision", std::string(name_of(choice.precision))}};
}

void write_checkpoint_file(const std::filesystem::path& path, const Identity& identity, const RunSoFar& run) {
  auto file = Hdf5File::create(path, {.compressed = false, .sealed = true});
  for (const auto& [name, value] : identity) file.write_attribute("/", name, value);
  for (std::size_t n = 0; n < run.frames.size(); ++n) write_frame(file, frame_group(n), run.frames[n]);
  write_history(file, run.history);
  for (const auto& [name, values] : run.point.arrays) {
    file.write("/state/" + name, {values.size()}, std::span<const double>(values));
  }
  file.commit();
}

RunSoFar read_checkpoint_file(const std::filesystem::path& path, const Identity& identity,
                              std::size_t n_nodes, std::size_t n_elements) {
  const auto file = Hdf5File::open_sealed(path);
  require_identity(file, identity);
  RunSoFar run{.frames = {}, .history = read_history(file), .point = {}};
  const std::size_t frames = file.names_in("/frames").size();
  for (std::size_t n = 0; n < frames; ++n) {
    run.frames.push_back(read_frame(file, frame_group(n), n_nodes, n_elements));
  }
  for (const auto& name : file.names_in("/state")) {
    run.point.arrays[name] = file.read<double>("/state/" + name).entries;
  }
  return run;
}

}  // namespace sandglass
