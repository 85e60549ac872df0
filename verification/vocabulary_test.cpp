/// Every number type has the functions of scalar.hpp, and gives laws and elements the same values as doubles.
/// Other parts of a type (lanes, a slope, a tally) are tested where they are used.

#include <gtest/gtest.h>

#include "element/methods.hpp"
#include "support/number_types.hpp"
#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::vocabulary_test {
namespace {

template <class Number>
class Vocabulary : public ::testing::Test {
 protected:
  /// The distance from one to the next number, found numerically.
  static double spacing() {
    double step = 1.0;
    while (plain_value(Number(1.0) + Number(0.5 * step)) > 1.0) step *= 0.5;
    return step;
  }

  template <int R, int C>
  static Matrix<double, R, C> plain(const Matrix<Number, R, C>& a) {
    Matrix<double, R, C> result;
    for (std::size_t n = 0; n < a.entries.size(); ++n) result.entries[n] = plain_value(a.entries[n]);
    return result;
  }

  /// Multiples of 2^-18, which every number type represents, so that all compute with the same input.
  template <int R, int C>
  static Matrix<double, R, C> coarse(Matrix<double, R, C> a) {
    for (double& x : a.entries) x = std::round(x * 0x1p18) * 0x1p-18;
    return a;
  }

  RandomGeometry random{23};
  double eps = spacing();
};
TYPED_TEST_SUITE(Vocabulary, detail::AsTestTypes<NumberTypes>::type);

/// Operators round once; roots, exponentials and logarithms are within two units in the last place.
TYPED_TEST(Vocabulary, functions_are_those_of_doubles) {
  using N = TypeParam;
  const auto expect = [&](const N& found, double exact) {
    EXPECT_NEAR(plain_value(found), exact, 2 * this->eps * std::abs(exact));
  };
  for (const double a : {-0.875, -0.0625, 0.375, 1.5, 6.25}) {
    for (const double b : {0.125, 1.5, 3.0}) {
      const auto x = N(a), y = N(b);
      expect(x + y, a + b);
      expect(x - y, a - b);
      expect(-x, -a);
      expect(x * y, a * b);
      expect(x / y, a / b);
      expect(max(x, y), std::max(a, b));
      expect(max(y, x), std::max(a, b));
      expect(min(x, y), std::min(a, b));
      expect(min(y, x), std::min(a, b));
      expect(select(x < y, x + x, y * y), a < b ? a + a : b * b);
      expect(select(x > y, x + x, y * y), a > b ? a + a : b * b);
      expect(abs(x), std::abs(a));
      expect(expm1(x), std::expm1(a));
      expect(log1p(x), std::log1p(a));
      expect(sqrt(y), std::sqrt(b));
      expect(inverse_cube_root(y), 1.0 / std::cbrt(b));
    }
  }
}

/// Small arguments keep all their digits; otherwise laws would lose theirs at small strains.
TYPED_TEST(Vocabulary, nothing_is_lost_near_zero) {
  using N = TypeParam;
  for (const double x : {1e-3, -1e-6, 1e-12, -1e-30}) {
    EXPECT_NEAR(plain_value(expm1(N(x))) / std::expm1(x), 1.0, 4 * this->eps) << x;
    EXPECT_NEAR(plain_value(log1p(N(x))) / std::log1p(x), 1.0, 4 * this->eps) << x;
  }
}

/// Stress and energy of every law within the roundoff of its stiffness (see law_test.cpp).
TYPED_TEST(Vocabulary, laws_are_those_of_doubles) {
  for_each_type(ElasticLaws{}, [&]<class Law>() {
    const Law law = sample_law<Law>(0.45);
    for (int n = 0; n < 20; ++n) {
      const auto H = this->coarse(this->random.deformation(0.6, 1.6) - identity<double>());
      const auto on_numbers = from_double<TypeParam>(H);
      const auto bound = tangent_bound(law, H);
      const double tolerance = 1024 * this->eps * (std::abs(bound.volumetric) + bound.gradient);
      EXPECT_LT(largest_entry(this->plain(law.piola(on_numbers)) - law.piola(H)), tolerance) << Law::name;
      EXPECT_NEAR(plain_value(law.energy(on_numbers)), law.energy(H), tolerance) << Law::name;
    }
  });
}

/// An element from its coordinates to its forces: geometry, law and hourglass control, some hundred
/// operations on terms as large as stiffness times displacement.
TYPED_TEST(Vocabulary, elements_are_those_of_doubles) {
  using Kernel = FormulationOf<TlModalSampling, NeoHookean>;
  const auto law = sample_law<NeoHookean>(0.45);
  const auto force = [&]<class N>(const NodalVectors<double>& X, const NodalVectors<double>& u, N /*type*/) {
    ElementMotion<N> motion{};
    motion.u = to_modes(from_double<N>(u));
    motion.X = to_modes(from_double<N>(X));
    const auto element = Kernel::template constants<N>(motion.X, law, {});
    typename Kernel::template History<N> none;
    return from_modes(Kernel::force(Kernel::deformation(motion, element), element, none, law));
  };
  for (int n = 0; n < 20; ++n) {
    const auto X = this->coarse(this->random.hexahedron());
    const auto u = this->coarse(this->random.displacements(X, 0.7, 1.4, 0.1));
    ElementMotion<double> motion{};
    motion.u = to_modes(u);
    const double size = Kernel::stiffness_bound(motion, Kernel::precompute(X, law, {}), {}, law) *
                        std::sqrt(double_dot(u, u));
    const auto difference = this->plain(force(X, u, TypeParam{})) - force(X, u, double{});
    EXPECT_LT(largest_entry(difference), 256 * this->eps * size);
  }
}

}  // namespace
}  // namespace sandglass::verification::vocabulary_test
