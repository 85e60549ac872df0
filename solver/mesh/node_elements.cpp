#include "mesh/node_elements.hpp"

namespace sandglass {

NodeElements::NodeElements(const Mesh& mesh) : first_(mesh.points.size() + 1, 0) {
  for (const auto& cell : mesh.cells) {
    for (const int node : cell) ++first_[at(node) + 1];
  }
  for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
  elements_.resize(first_.back());
  auto next = first_;
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    for (const int node : mesh.cells[e]) elements_[next[at(node)]++] = static_cast<int>(e);
  }
}

std::span<const int> NodeElements::around(int node) const {
  return std::span(elements_).subspan(first_[at(node)], first_[at(node) + 1] - first_[at(node)]);
}

}  // namespace sandglass
