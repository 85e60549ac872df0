#include "solve/row_constraints.hpp"

namespace sandglass {

namespace {

template <class Real>
std::array<Real, 3> rounded(const std::array<double, 3>& values) {
  return {static_cast<Real>(values[0]), static_cast<Real>(values[1]), static_cast<Real>(values[2])};
}

}  // namespace

template <class Real>
RowConstraints<Real>::RowConstraints(const Scene& scene, const Layout& layout)
    : scene_(scene), ranks_(*layout.team.ranks), terms_(scene.angles.size()) {
  const Blocks::Range local = layout.row_blocks.local();
  for (std::size_t k = 0; k < scene.constraints.size(); ++k) {
    const auto& [node, component, path, group] = scene.constraints[k];
    const auto row = at(layout.row_of_node[at(node)]);
    if (layout.owns(node)) own_.push_back(k);
    if (layout.owns(node) && path.share != PathTerms{}) moving_.push_back(k);
    if (4 * row < local.first || 4 * row >= local.last) continue;
    const auto place = static_cast<std::uint32_t>(4 * row + at(component));
    constraints_.push_back({static_cast<std::uint32_t>(k), place});
    if (path.share == PathTerms{}) {
      held_.push_back(place);
    } else {
      paths_.push_back({place, static_cast<std::uint32_t>(path.angle), rounded<Real>(path.share)});
    }
  }
}

template <class Real>
void RowConstraints<Real>::impose(State<Real>& state, double factor) {
  for (std::size_t m = 0; m < terms_.size(); ++m)
    terms_[m] = rounded<Real>(path_terms(scene_.angles[m], factor));
  for (const auto& [place, angle, share] : paths_) {
    const std::array<Real, 3>& terms = terms_[angle];
    set(state, place, share[0] * terms[0] + share[1] * terms[1] + share[2] * terms[2]);
  }
}

template <class Real>
void RowConstraints<Real>::impose(State<Real>& state, std::span<const double> displacements) const {
  for (const auto& [index, place] : constraints_) set(state, place, static_cast<Real>(displacements[index]));
}

template <class Real>
std::vector<double> RowConstraints<Real>::of_all(const std::vector<double>& numbers) const {
  std::vector<double> of_all(numbers.size());
  for (const std::size_t k : own_) of_all[k] = numbers[k];
  ranks_.sum(of_all);
  return of_all;
}

template <class Real>
Reactions RowConstraints<Real>::sums_over_sets(const std::vector<double>& numbers) const {
  Reactions sums;
  const std::vector<double> all = of_all(numbers);
  for (const auto& [set, constraints] : scene_.driven) {
    Vector& sum = sums[set];
    for (const std::size_t k : constraints) sum[at(scene_.constraints[k].component)] += all[k];
  }
  return sums;
}

template class RowConstraints<double>;
template class RowConstraints<float>;

}  // namespace sandglass
