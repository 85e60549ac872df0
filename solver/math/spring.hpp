#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "math/matrix.hpp"
#include "math/rows.hpp"

namespace sandglass {

/// A spring of contact between at most eight nodes. Its extension is the sum of their displacements, times
/// weights, along its direction. A spring of one node holds it to the ground. With friction its force is not
/// along its direction n, but along n - s, s its drag.
struct Spring {
  std::array<int, 8> nodes;  ///< of the mesh, or rows
  std::array<float, 8> weights;
  std::size_t size;
  Row<float> root;       ///< its direction, of length one, times the root of its stiffness, root of N/m
  Row<float> drag = {};  ///< the coefficient of friction times the direction of slip, at right angles to root

  /// Its extension under displacements (m) at `nodes`, times the root of its stiffness, root of J.
  float extension(const Rows<float>& u) const {
    float sum = 0.0f;
    for (std::size_t n = 0; n < size; ++n) {
      const Row<float>& of_node = u[static_cast<std::size_t>(nodes[n])];
      sum += weights[n] * (root[0] * of_node[0] + root[1] * of_node[1] + root[2] * of_node[2]);
    }
    return sum;
  }
};

/// The root of a spring with a stiffness (N/m) along a direction of length one, root of N/m.
inline Row<float> root_of(double stiffness, const std::array<double, 3>& direction) {
  Row<float> root;
  for (std::size_t i = 0; i < 3; ++i) root[i] = static_cast<float>(std::sqrt(stiffness) * direction[i]);
  return root;
}

/// Springs as numbers, padded by springs without nodes up to `most`.
inline Rows<float> rows_of(const std::vector<Spring>& springs, std::size_t most) {
  Rows<float> rows(6 * most);
  for (std::size_t k = 0; k < springs.size(); ++k) {
    const Spring& spring = springs[k];
    rows[6 * k] = spring.root;
    rows[6 * k + 1] = {{static_cast<float>(spring.size), spring.drag[0], spring.drag[1], spring.drag[2]}};
    for (std::size_t n = 0; n < spring.size; ++n) {
      Row<float>& row = rows[6 * k + 2 + n / 2];
      row[n % 2] = static_cast<float>(spring.nodes[n]);  // exact below 2^24
      row[2 + n % 2] = spring.weights[n];
    }
  }
  return rows;
}

/// The springs of such numbers.
inline std::vector<Spring> springs_of(const Rows<float>& rows) {
  std::vector<Spring> springs;
  for (std::size_t k = 0; 6 * k < rows.size() && rows[6 * k + 1][0] > 0.0f; ++k) {
    const Row<float>& of_spring = rows[6 * k + 1];
    Spring spring{{},
                  {},
                  static_cast<std::size_t>(of_spring[0]),
                  rows[6 * k],
                  {{of_spring[1], of_spring[2], of_spring[3]}}};
    for (std::size_t n = 0; n < spring.size; ++n) {
      const Row<float>& row = rows[6 * k + 2 + n / 2];
      spring.nodes[n] = static_cast<int>(row[n % 2]);
      spring.weights[n] = row[2 + n % 2];
    }
    springs.push_back(spring);
  }
  return springs;
}

/// Adds factor s s^T to a stiffness.
inline void add_square(float factor, const Row<float>& s, Tensor<float>& K) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) K(static_cast<int>(i), static_cast<int>(j)) += factor * s[i] * s[j];
  }
}

/// Whether the stiffness of any node differs between springs by more than a share of it: of their roots.
inline bool differ(const std::vector<Spring>& now, const std::vector<Spring>& then, float share) {
  std::map<int, std::array<Tensor<float>, 2>> by_node;
  const auto add = [&](const std::vector<Spring>& springs, std::size_t when) {
    for (const Spring& spring : springs) {
      for (std::size_t n = 0; n < spring.size; ++n) {
        auto& both = by_node.try_emplace(spring.nodes[n], std::array<Tensor<float>, 2>{}).first->second;
        add_square(std::abs(spring.weights[n]), spring.root, both[when]);
      }
    }
  };
  add(now, 0);
  add(then, 1);
  return std::any_of(by_node.begin(), by_node.end(), [&](const auto& of_node) {
    const auto& [K, L] = of_node.second;
    const Tensor<float> change = K - L;
    return double_dot(change, change) > 2.0f * share * share * std::max(double_dot(K, K), double_dot(L, L));
  });
}

}  // namespace sandglass
