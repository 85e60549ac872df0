#include "solve/coarse_transfer.hpp"

#include <algorithm>

namespace sandglass {

template <class Real>
CoarseTransfer<Real>::CoarseTransfer(const CoarseGrid& grid, const NodalField& points, const Layout& layout)
    : first_(grid.boxes() + 1),
      places_(layout.nodes),
      weights_(layout.nodes),
      sums_(grid.boxes()),
      local_(layout.rows()),
      box_begin_(layout.rows()),
      coefficients_(32 * grid.boxes()) {
  for (std::size_t box = 0; box < grid.boxes(); ++box) box_nodes_.push_back(grid.nodes_of(box));
  std::vector<CoarseGrid::Location> locations;
  for (std::size_t r = 0; r < layout.rows(); ++r) {
    locations.push_back(grid.locate(points[static_cast<std::size_t>(layout.node_of_row[r])]));
    const auto& [box, local] = locations.back();
    box_begin_[r] = static_cast<Place>(32 * box);
    for (std::size_t i = 0; i < 3; ++i) local_[r][i] = static_cast<Real>(local[i]);
    if (r < layout.nodes) ++first_[box + 1];
  }
  for (std::size_t box = 0; box < grid.boxes(); ++box) first_[box + 1] += first_[box];
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t r = 0; r < layout.nodes; ++r) {
    const std::size_t k = next[locations[r].box]++;
    const auto w = CoarseGrid::weights(locations[r].local);
    places_[k] = place_of_row(r);
    for (int lane = 0; lane < 8; ++lane) {
      weights_[k].lanes[lane] = static_cast<Real>(w[static_cast<std::size_t>(lane)]);
    }
  }
}

template <class Real>
void CoarseTransfer<Real>::restrict_to_coarse(const Rows<Real>& r, CoarseVector& q, int threads) {
  const Real* x = numbers_of(r);
  in_parallel(sums_.size(), threads, [&](std::size_t box) {
    using Sum = Pack<Real, 8>;
    std::array<Sum, 3> even{Real(0), Real(0), Real(0)}, odd = even;  // two chains of additions
    std::size_t k = first_[box];
    const std::size_t last = first_[box + 1];
    for (; k + 1 < last; k += 2) {
      for (std::size_t i = 0; i < 3; ++i) {
        even[i] = even[i] + Sum(x[places_[k] + i]) * weights_[k];
        odd[i] = odd[i] + Sum(x[places_[k + 1] + i]) * weights_[k + 1];
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (k < last) even[i] = even[i] + Sum(x[places_[k] + i]) * weights_[k];
      const Sum sum = even[i] + odd[i];
      for (std::size_t n = 0; n < 8; ++n) {
        sums_[box][3 * n + i] = static_cast<double>(sum.lanes[static_cast<int>(n)]);
      }
    }
  });
  std::fill(q.begin(), q.end(), 0.0);
  for (std::size_t box = 0; box < sums_.size(); ++box) {
    for (std::size_t n = 0; n < 8; ++n) {
      for (std::size_t i = 0; i < 3; ++i) q[3 * box_nodes_[box][n] + i] += sums_[box][3 * n + i];
    }
  }
}

template <class Real>
void CoarseTransfer<Real>::take(const CoarseVector& c) {
  for (std::size_t box = 0; box < box_nodes_.size(); ++box) {
    std::array<std::array<double, 3>, 8> a;
    for (std::size_t n = 0; n < 8; ++n) {
      for (std::size_t i = 0; i < 3; ++i) a[n][i] = c[3 * box_nodes_[box][n] + i];
    }
    for (const std::size_t axis : {1U, 2U, 4U}) {  // from nodal values to differences
      for (std::size_t n = 0; n < 8; ++n) {
        if ((n & axis) == 0) continue;
        for (std::size_t i = 0; i < 3; ++i) a[n][i] -= a[n - axis][i];
      }
    }
    Real* rows = coefficients_.data() + 32 * box;
    for (std::size_t n = 0; n < 8; ++n) {
      for (std::size_t i = 0; i < 3; ++i) rows[4 * n + i] = static_cast<Real>(a[n][i]);
    }
  }
}

template class CoarseTransfer<double>;
template class CoarseTransfer<float>;

}  // namespace sandglass
