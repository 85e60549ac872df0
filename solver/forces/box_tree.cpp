#include "forces/box_tree.hpp"

#include <algorithm>
#include <numeric>

namespace sandglass {

BoxTree::BoxTree(const NodalField& centres, int most_in_leaf) : items_(centres.size()) {
  std::iota(items_.begin(), items_.end(), 0);
  build(centres, most_in_leaf, 0, static_cast<int>(items_.size()));
}

/// The number of the node, above all items from `first` on, `count` of them, which are sorted.
int BoxTree::build(const NodalField& centres, int most_in_leaf, int first, int count) {
  const auto number = static_cast<int>(nodes_.size());
  nodes_.push_back({first, count});
  if (count <= most_in_leaf) return number;
  const auto begin = items_.begin() + first;
  Vector low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  for (auto item = begin; item != begin + count; ++item) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], centres[at(*item)][i]);
      high[i] = std::max(high[i], centres[at(*item)][i]);
    }
  }
  const Vector extent = difference(high, low);
  const auto axis = static_cast<std::size_t>(std::ranges::max_element(extent) - extent.begin());
  std::nth_element(begin, begin + count / 2, begin + count,
                   [&](int a, int b) { return centres[at(a)][axis] < centres[at(b)][axis]; });
  build(centres, most_in_leaf, first, count / 2);  // the next number
  const int second = build(centres, most_in_leaf, first + count / 2, count - count / 2);
  nodes_[at(number)] = {second, 0};
  return number;
}

}  // namespace sandglass
