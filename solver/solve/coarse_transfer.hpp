#pragma once

#include "assembly/layout.hpp"
#include "base/parallel.hpp"
#include "solve/coarse_grid.hpp"
#include "solve/row_vector.hpp"

namespace sandglass {

/// Three numbers for each node of a coarse grid.
using CoarseVector = std::vector<double>;

/// The transfer between rows and a coarse grid: trilinear functions Z_n at each row.
template <class Real>
class CoarseTransfer {
 public:
  /// Between a grid around `points` (m) and the rows of a layout.
  CoarseTransfer(const CoarseGrid& grid, const NodalField& points, const Layout& layout);

  /// q = sum_n Z_n^T r_n. Constrained components of r must be zero.
  void restrict_to_coarse(const Rows<Real>& r, CoarseVector& q, int threads);

  /// Sets the coarse vector for `from_coarse`.
  void take(const CoarseVector& c);

  /// Z_n c for the rows from number `k` on, constrained components included.
  template <int W>
  RowVector<Real, W> from_coarse(std::size_t k) const {
    if constexpr (W == 4) {
      const Real* a = coefficients_.data() + box_begin_[k / 4];
      const Real* local = numbers_of(local_) + k;
      const Real x = local[0], y = local[1], z = local[2];
      const auto at = [a](std::size_t m) { return load<4>(a + 4 * m); };
      return (at(0) + z * at(4)) + y * (at(2) + z * at(6)) +
             x * ((at(1) + z * at(5)) + y * (at(3) + z * at(7)));
    } else {
      return detail::permute<detail::halves, W>(from_coarse<W / 2>(k), from_coarse<W / 2>(k + W / 2));
    }
  }

 private:
  std::vector<std::array<std::size_t, 8>> box_nodes_;
  std::vector<std::size_t> first_;      // index of each box into the next two
  std::vector<Place> places_;           // rows in the order of boxes
  std::vector<Pack<Real, 8>> weights_;  // values of the functions of the box's nodes
  std::vector<std::array<double, 24>> sums_;
  Rows<Real> local_;                // place in the box, 0 to 1
  std::vector<Place> box_begin_;    // of each row, into coefficients_
  std::vector<Real> coefficients_;  // of 1, x, y, xy, z, xz, yz, xyz in each box, rows of four
};

extern template class CoarseTransfer<double>;
extern template class CoarseTransfer<float>;

}  // namespace sandglass
