#include "multigrid/saddle_multigrid.hpp"

namespace sandglass {

namespace {

/// A grid with at most so many nodes is solved exactly.
constexpr std::size_t fewest_nodes = 48;

/// Steps of the smoother before and after each correction.
constexpr int smoothing_steps = 2;

void smooth_before(SaddleLevel& level, const MixedVector& b, MixedVector& x) {
  level.smooth_from_zero(b, x);
  for (int k = 1; k < smoothing_steps; ++k) level.smooth(b, x);
}

void smooth_after(SaddleLevel& level, const MixedVector& b, MixedVector& x) {
  for (int k = 0; k < smoothing_steps; ++k) level.smooth(b, x);
}

}  // namespace

SaddleMultigrid::SaddleMultigrid(const Mesh& mesh, const Layout& layout, const Rows<float>& free,
                                 const Rows<float>& springs, int threads)
    : elements_(make_element_level(mesh, layout, free, springs, threads)), residual_(elements_->zero()) {
  const auto add = [&](const Grid& grid) {
    auto level = std::make_unique<GridLevel>(grid, threads);
    const MixedVector zero = level->zero();
    stages_.push_back({std::move(level), nullptr, zero, zero, zero});
  };
  Grid grid = Grid::around(mesh);
  add(grid);
  to_grid_ = std::make_unique<ElementTransfer>(mesh, layout, *elements_, *stages_[0].level);
  while (grid.real_nodes() > fewest_nodes) {
    std::array<bool, 3> halved{};
    grid = grid.coarser(halved);
    add(grid);
    Stage& finer = stages_[stages_.size() - 2];
    finer.to_coarser = std::make_unique<GridTransfer>(*finer.level, *stages_.back().level, halved);
  }
}

void SaddleMultigrid::update(const Rows<float>& u, const std::vector<ModelModuli>& moduli) {
  elements_->update(u, moduli);
  to_grid_->gather();
  for (Stage& stage : stages_) {
    if (stage.to_coarser == nullptr) {
      coarsest_.update(*stage.level);
    } else {
      stage.level->assemble();
      stage.to_coarser->gather();
    }
  }
}

void SaddleMultigrid::cycle(const MixedVector& b, MixedVector& x) {
  smooth_before(*elements_, b, x);
  elements_->residual(b, x, residual_);
  to_grid_->restrict_residual(residual_, stages_[0].b);
  cycle_grid(0);
  to_grid_->add_correction(stages_[0].x, x);
  smooth_after(*elements_, b, x);
}

void SaddleMultigrid::cycle_grid(std::size_t number) {
  auto& [level, to_coarser, b, x, r] = stages_[number];
  if (to_coarser == nullptr) {
    coarsest_.solve(b, x);
    return;
  }
  smooth_before(*level, b, x);
  level->residual(b, x, r);
  to_coarser->restrict_residual(r, stages_[number + 1].b);
  cycle_grid(number + 1);
  to_coarser->add_correction(stages_[number + 1].x, x);
  smooth_after(*level, b, x);
}

}  // namespace sandglass
