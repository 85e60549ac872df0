#pragma once

#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "io/checkpoint_file.hpp"

namespace sandglass::verification {

/// Records all reports, and every checkpoint with the reports before it.
class KeepingRecorder final : public Observer {
 public:
  explicit KeepingRecorder(RunSoFar run = {}) : run_(std::move(run)) {}
  void frame(const Frame& frame) override { run_.frames.push_back(frame); }
  void history(const HistoryRow& row) override { run_.history.push_back(row); }
  void resumable(const std::function<Checkpoint()>& checkpoint) override {
    run_.point = checkpoint();
    kept_.push_back(run_);
  }
  const RunSoFar& run() const { return run_; }
  const std::vector<RunSoFar>& kept() const { return kept_; }

 private:
  RunSoFar run_;
  std::vector<RunSoFar> kept_;
};

/// The bits of all reports of a run and of its final answer. Zeros lose their sign, as in sums over ranks.
inline std::vector<std::uint64_t> bits_of(const RunSoFar& run, const NodalField& answer) {
  std::vector<std::uint64_t> bits;
  const auto add = [&](double number) { bits.push_back(std::bit_cast<std::uint64_t>(number + 0.0)); };
  const auto add_all = [&](const auto& numbers) {
    for (const double number : numbers) add(number);
  };
  const auto add_field = [&](const NodalField& field) {
    for (const auto& row : field) add_all(row);
  };
  for (const auto& frame : run.frames) {
    add(frame.time);
    add_field(frame.u);
    add_field(frame.v);
    add_all(frame.jacobians);
    add_all(frame.hourglass_energy_densities);
    add_all(frame.levels);
    add_all(frame.stresses);
    for (const auto& [set, force] : frame.reactions) add_all(force);
  }
  for (const auto& row : run.history) {
    add_all(std::vector{row.time, row.kinetic, row.strain, row.hourglass, row.external_work, row.residual,
                        row.step_size, row.adaption, row.contact, row.friction, row.depth});
    for (const auto& [set, force] : row.reactions) add_all(force);
  }
  for (const auto& [name, values] : run.point.arrays) add_all(values);
  add_field(answer);
  return bits;
}

}  // namespace sandglass::verification
