#include "math/dense.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sandglass {
namespace {

constexpr std::size_t n = 12;

// The second difference on n points: its eigenvalues are 4 sin^2(k pi / (2 n + 2)), and component i of
// eigenvector k is proportional to sin(i k pi / (n + 1)). All are distinct, so vectors are unique but for
// sign.
void expect_those_of_second_difference(const Eigenpairs& pairs) {
  constexpr double rounding = 1e-14;  // eigenvalues are 4 at most, and differ by 0.05 at least
  ASSERT_EQ(pairs.values.size(), n);
  ASSERT_EQ(pairs.vectors.size(), n);
  for (std::size_t k = 0; k < n; ++k) {
    const double angle = static_cast<double>(k + 1) * std::numbers::pi / (n + 1);
    EXPECT_NEAR(pairs.values[k], 4.0 * std::pow(std::sin(0.5 * angle), 2), rounding);
    double product = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      product +=
          pairs.vectors[k][i] * std::sqrt(2.0 / (n + 1)) * std::sin(static_cast<double>(i + 1) * angle);
    EXPECT_NEAR(std::abs(product), 1.0, rounding);
  }
}

// Above the diagonal there is something else, as only the lower triangle counts.
std::vector<double> second_difference() {
  std::vector<double> entries(n * n, 7.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) entries[i * n + j] = i == j ? 2.0 : i == j + 1 ? -1.0 : 0.0;
  }
  return entries;
}

TEST(Dense, eigenpairs_of_a_symmetric_matrix_are_exact) {
  expect_those_of_second_difference(symmetric_eigenpairs(second_difference()));
}

TEST(Dense, eigenpairs_of_a_tridiagonal_matrix_are_exact) {
  const std::vector<double> diagonal(n, 2.0), beside(n - 1, -1.0);
  expect_those_of_second_difference(tridiagonal_eigenpairs(diagonal, beside));
}

TEST(Dense, one_number_is_its_own_eigenvalue) {
  const std::vector<double> one{3.0};
  EXPECT_EQ(symmetric_eigenpairs(one).values, one);
  EXPECT_EQ(tridiagonal_eigenpairs(one, {}).values, one);
}

// The second difference of i (n + 1 - i) / 2 is -1.
TEST(Dense, positive_definite_systems_are_solved) {
  const std::vector<double> x = solve_positive_definite(second_difference(), std::vector<double>(n, 1.0));
  for (std::size_t i = 0; i < n; ++i)
    EXPECT_NEAR(x[i], 0.5 * static_cast<double>((i + 1) * (n - i)), 1e-12);  // condition 70, numbers to 21
}

}  // namespace
}  // namespace sandglass
