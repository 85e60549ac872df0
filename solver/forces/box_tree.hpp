#pragma once

#include <array>
#include <utility>

#include "math/rows.hpp"
#include "mesh/vectors.hpp"

namespace sandglass {

/// A binary tree of boxes around numbered items, for searches near a point. It is built once; its boxes are
/// kept outside of it, two rows each for the low and the high corner (m), and are fitted again as items move.
class BoxTree {
 public:
  /// Items are divided in halves by their centres (m) down to at most `most_in_leaf`.
  BoxTree(const NodalField& centres, int most_in_leaf);

  /// The number of rows of the boxes.
  std::size_t rows() const { return 2 * nodes_.size(); }

  /// Fits the boxes: add(item, grow) calls grow(x) for all points (m) that the box of an item must contain.
  template <class Add>
  void fit(Row<double>* boxes, const Add& add) const {
    for (std::size_t n = nodes_.size(); n-- > 0;) {  // boxes below have greater numbers
      const Node& node = nodes_[n];
      Row<double>&low = boxes[2 * n], &high = boxes[2 * n + 1];
      low = {{INFINITY, INFINITY, INFINITY}};
      high = {{-INFINITY, -INFINITY, -INFINITY}};
      const auto grow = [&](const auto& x) {
        for (std::size_t i = 0; i < 3; ++i) {
          low[i] = std::min(low[i], x[i]);
          high[i] = std::max(high[i], x[i]);
        }
      };
      for (int k = node.first; k < node.first + node.count; ++k) add(items_[at(k)], grow);
      if (node.count > 0) continue;
      for (const std::size_t below : {n + 1, at(node.first)}) {
        grow(boxes[2 * below]);
        grow(boxes[2 * below + 1]);
      }
    }
  }

  /// Calls compare(item) for all items whose boxes are closer to x (m) than the root of `square` (m^2), which
  /// compare may lower; near boxes first. Allocates nothing.
  template <class Compare>
  void search(const Vector& x, const Row<double>* boxes, const double& square, const Compare& compare) const {
    constexpr std::size_t deepest = 64;  // nodes halve the items
    std::array<std::pair<std::size_t, double>, deepest> waiting;
    waiting[0] = {0, square_from(x, boxes, 0)};
    std::size_t count = 1;
    while (count > 0) {
      const auto [n, from] = waiting[--count];
      if (!(from < square)) continue;
      const Node& node = nodes_[n];
      for (int k = node.first; k < node.first + node.count; ++k) compare(items_[at(k)]);
      if (node.count > 0) continue;
      std::pair near{n + 1, square_from(x, boxes, n + 1)},
          far{at(node.first), square_from(x, boxes, at(node.first))};
      if (far.second < near.second) std::swap(near, far);
      waiting[count++] = far;
      waiting[count++] = near;
    }
  }

 private:
  struct Node {
    int first, count;  // of the items; count 0: the second of the two nodes below, the first is the next
  };

  int build(const NodalField& centres, int most_in_leaf, int first, int count);

  /// The square of the distance of a point from a box, m^2.
  static double square_from(const Vector& x, const Row<double>* boxes, std::size_t n) {
    const Row<double>&low = boxes[2 * n], &high = boxes[2 * n + 1];
    double square = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double beyond = std::max({low[i] - x[i], x[i] - high[i], 0.0});
      square += beyond * beyond;
    }
    return square;
  }

  std::vector<int> items_;
  std::vector<Node> nodes_;
};

}  // namespace sandglass
