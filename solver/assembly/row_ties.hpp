#pragma once

#include <algorithm>
#include <span>

#include "assembly/layout.hpp"
#include "mesh/ties.hpp"

namespace sandglass {

/// The ties of a mesh, on rows. Everything that is a displacement follows; everything that is a force is
/// handed on, the transposed operation.
template <class Real>
class RowTies {
 public:
  RowTies() = default;

  /// `ties` are to free nodes.
  RowTies(const Ties& ties, const Layout& layout) {
    const auto row = [&](int node) {
      return static_cast<std::uint32_t>(layout.row_of_node[static_cast<std::size_t>(node)]);
    };
    for (const auto& [node, mean_of] : ties) {
      const auto first = static_cast<std::uint32_t>(shares_.size());
      for (const auto& [from, weight] : mean_of) shares_.push_back({row(from), static_cast<Real>(weight)});
      ties_.push_back({row(node), first, static_cast<std::uint32_t>(shares_.size())});
    }
    std::sort(ties_.begin(), ties_.end(), [](const TiedRow& a, const TiedRow& b) { return a.row < b.row; });
  }

  /// Sets tied rows to the means that they follow.
  void follow(Rows<Real>& displacements) const {
    for (const auto& [row, first, last] : ties_) {
      Row<Real> mean;
      for (std::uint32_t k = first; k < last; ++k) {
        const Row<Real>& from = displacements[shares_[k].row];
        for (std::size_t i = 0; i < 4; ++i) mean[i] += shares_[k].weight * from[i];
      }
      displacements[row] = mean;
    }
  }

  /// Hands what tied rows carry on to the rows that they follow, and clears them.
  void hand_on(Rows<Real>& forces) const {
    for (const auto& [row, first, last] : ties_) {
      for (std::uint32_t k = first; k < last; ++k) {
        Row<Real>& to = forces[shares_[k].row];
        for (std::size_t i = 0; i < 4; ++i) to[i] += shares_[k].weight * forces[row][i];
      }
      forces[row] = {};
    }
  }

  /// Sets tied rows to zero.
  void clear(Rows<Real>& rows) const {
    for (const auto& tie : ties_) rows[tie.row] = {};
  }

  /// A row and its weight; of rows that are tied those that they follow.
  struct Share {
    std::uint32_t row;
    Real weight;
  };

  /// The shares of a row: none if it is not tied.
  std::span<const Share> shares_of(std::size_t row) const {
    const auto found = std::lower_bound(ties_.begin(), ties_.end(), row,
                                        [](const TiedRow& tie, std::size_t r) { return tie.row < r; });
    if (found == ties_.end() || found->row != row) return {};
    return std::span(shares_).subspan(found->first, found->last - found->first);
  }

 private:
  struct TiedRow {
    std::uint32_t row, first, last;  // shares
  };
  std::vector<TiedRow> ties_;
  std::vector<Share> shares_;
};

}  // namespace sandglass
