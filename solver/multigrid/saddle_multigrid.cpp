#include "multigrid/saddle_multigrid.hpp"

#include <algorithm>

namespace sandglass {

namespace {

/// A grid with at most this many nodes is solved exactly.
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

SaddleMultigrid::SaddleMultigrid(const Mesh& mesh, const Ties& ties, const std::vector<CoarserMesh>& coarser,
                                 const Layout& layout, const Rows<float>& free, const Rows<float>& springs)
    : elements_(make_element_level(mesh, ties, layout, free, springs)), residual_(elements_->zero()) {
  const Mesh* coarsest_mesh = &mesh;
  const Layout* coarsest_layout = &layout;
  const ElementLevel* coarsest_elements = elements_.get();
  std::vector<std::uint16_t> materials = layout.materials;
  for (const CoarserMesh& next : coarser) {
    if (!materials.empty()) {
      std::vector<std::uint16_t> own(next.mesh.cells.size());
      for (std::size_t e = 0; e < materials.size(); ++e) own[at(next.element_of[e])] = materials[e];
      materials = std::move(own);
    }
    auto own = std::make_unique<Layout>(make_layout(next.mesh, layout.width, SpareRows::where_needed,
                                                    materials, {.threads = layout.team.threads}));
    Rows<float> own_free(own->rows()), own_springs(springs.empty() ? 0 : own->rows());
    for (std::size_t row = 0; row < own->nodes; ++row) {
      const int node = own->node_of_row[row];
      const auto finest = at(layout.row_of_node[at(node)]);
      // A node that is tied on the finest mesh is tied on all meshes.
      if (!is_tied(next.ties, node)) own_free[row] = free[finest];
      if (!springs.empty()) own_springs[row] = springs[finest];
    }
    auto level = make_element_level(next.mesh, next.ties, *own, own_free, own_springs);
    auto transfer = std::make_unique<MeshTransfer>(next, *coarsest_layout, *coarsest_elements, *own, *level);
    coarsest_mesh = &next.mesh;
    coarsest_layout = own.get();
    coarsest_elements = level.get();
    const MixedVector zero = level->zero();
    meshes_.push_back({std::move(own), std::move(level), std::move(transfer), zero, zero, zero});
  }
  const auto add = [&](const Grid& grid) {
    auto level = std::make_unique<GridLevel>(grid, layout.team);
    const MixedVector zero = level->zero();
    grids_.push_back({std::move(level), nullptr, zero, zero, zero});
  };
  Grid grid = Grid::around(*coarsest_mesh);
  add(grid);
  to_grid_ = std::make_unique<ElementTransfer>(*coarsest_mesh, *coarsest_layout, *coarsest_elements,
                                               *grids_[0].level);
  while (grid.real_nodes() > fewest_nodes) {
    std::array<bool, 3> halved{};
    grid = grid.coarser(halved);
    add(grid);
    GridStage& finer = grids_[grids_.size() - 2];
    finer.to_coarser = std::make_unique<GridTransfer>(*finer.level, *grids_.back().level, halved);
  }
}

void SaddleMultigrid::update(const Rows<float>& u, const std::vector<ModelModuli>& moduli,
                             const std::vector<float>& stiffening) {
  elements_->update(u, moduli, stiffening);
  Rows<float> coarse_u = u;
  std::vector<float> coarse_stiffening = stiffening;
  if (!meshes_.empty()) elements_->layout().gather_rows(coarse_u.data());
  for (MeshStage& stage : meshes_) {
    coarse_u = stage.to_finer->at_common_nodes(coarse_u);
    coarse_stiffening = stage.to_finer->means(coarse_stiffening);
    stage.level->update(coarse_u, moduli, coarse_stiffening);
    // Without its middle nodes an element may be inverted.
    const auto& tangents = stage.level->tangents();
    const bool healthy = std::all_of(tangents.begin(), tangents.end(), [](const ElementTangent& t) {
      return t.volume == 0.0f || t.jacobian > 0.0f;
    });
    if (!healthy) stage.level->update(Rows<float>(coarse_u.size()), moduli, coarse_stiffening);
  }
  to_grid_->gather();
  assemble_grids();
}

void SaddleMultigrid::update_contact() {
  elements_->update_contact();
  for (const MeshStage& stage : meshes_) stage.level->update_contact();
  to_grid_->gather_contact();
  assemble_grids();
}

void SaddleMultigrid::assemble_grids() {
  for (GridStage& stage : grids_) {
    if (stage.to_coarser == nullptr) {
      coarsest_.update(*stage.level);
    } else {
      stage.level->assemble();
      stage.to_coarser->gather();
    }
  }
}

void SaddleMultigrid::set_contact(const std::vector<Spring>& springs) {
  elements_->set_contact(springs);
  for (const MeshStage& stage : meshes_) {
    std::vector<Spring> own;
    for (Spring spring : springs) {
      const int node = elements_->layout().node_of_row[at(spring.nodes[0])];
      if (spring.size > 1 || at(node) >= stage.layout->row_of_node.size()) continue;
      spring.nodes[0] = static_cast<int>(stage.layout->row_of_node[at(node)]);
      own.push_back(spring);
    }
    stage.level->set_contact(own);
  }
}

void SaddleMultigrid::cycle(const MixedVector& b, MixedVector& x) {
  cycle_mesh(0, *elements_, b, x, residual_);
}

void SaddleMultigrid::cycle_mesh(std::size_t number, ElementLevel& level, const MixedVector& b,
                                 MixedVector& x, MixedVector& r) {
  smooth_before(level, b, x);
  level.residual(b, x, r);
  level.layout().gather_rows(r.u.data());
  level.layout().gather_cells(r.p.data());
  if (number < meshes_.size()) {
    auto& [layout, coarser, to_finer, coarse_b, coarse_x, coarse_r] = meshes_[number];
    to_finer->restrict_residual(r, coarse_b);
    cycle_mesh(number + 1, *coarser, coarse_b, coarse_x, coarse_r);
    to_finer->add_correction(coarse_x, x);
  } else {
    to_grid_->restrict_residual(r, grids_[0].b);
    cycle_grid(0);
    to_grid_->add_correction(grids_[0].x, x);
  }
  smooth_after(level, b, x);
}

void SaddleMultigrid::cycle_grid(std::size_t number) {
  auto& [level, to_coarser, b, x, r] = grids_[number];
  if (to_coarser == nullptr) {
    coarsest_.solve(b, x);
    return;
  }
  smooth_before(*level, b, x);
  level->residual(b, x, r);
  to_coarser->restrict_residual(r, grids_[number + 1].b);
  cycle_grid(number + 1);
  to_coarser->add_correction(grids_[number + 1].x, x);
  smooth_after(*level, b, x);
}

}  // namespace sandglass
