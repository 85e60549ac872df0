#include "mesh/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "mesh/hexahedron.hpp"

namespace sandglass {

double smallest_measure(const NodalVectors<double>& X) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& xi : gauss_points()) smallest = std::min(smallest, determinant(parent_jacobian(X, xi)));
  return smallest;
}

Shapes shapes_in(const Mesh& mesh) {
  const bool regular = std::all_of(mesh.cells.begin(), mesh.cells.end(), [&](const Hexahedron& cell) {
    const NodalVectors<double> X = gather(mesh.points, cell);
    const Matrix<double, 3, 4> hourglass = transpose(X) * hourglass_base_vectors();
    const auto size = [](const auto& matrix) {
      double largest = 0.0;
      for (const double entry : matrix.entries) largest = std::max(largest, std::abs(entry));
      return largest;
    };
    // Eight coordinates, each rounded once or twice when it was computed and once more in each sum.
    return size(hourglass) <= 32.0 * std::numeric_limits<double>::epsilon() * size(X);
  });
  return regular ? Shapes::parallelepipeds : Shapes::any;
}

void require_positive_jacobians(const Mesh& mesh) {
  std::string listed;
  int inverted = 0;
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    const auto X = gather(mesh.points, mesh.cells[e]);
    const double measure = smallest_measure(X);
    if (measure > 0.0) continue;
    if (++inverted > 10) continue;
    const Vector centre = mean_at(mesh.cells[e], mesh.points);
    listed += fmt::format("\n  element {}: centre ({:.6g}, {:.6g}, {:.6g}), det J = {:.6g}", e, centre[0],
                          centre[1], centre[2], measure);
  }
  if (inverted > 0) {
    throw InputError(
        fmt::format("mesh: {} of {} elements are inverted; det J must be positive at all eight Gauss points; "
                    "the first {}:{}",
                    inverted, mesh.cells.size(), std::min(inverted, 10), listed));
  }
}

}  // namespace sandglass
