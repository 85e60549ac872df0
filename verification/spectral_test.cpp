/// Exponentials and logarithms of packs, principal frames, and isotropic functions of tensors with their
/// derivatives.

#include "math/spectral.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "math/pack.hpp"
#include "support/dense_matrix.hpp"
#include "support/derivatives.hpp"
#include "support/random_hexahedra.hpp"

namespace sandglass::verification::spectral_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

#ifdef SANDGLASS_STRICT_FP
constexpr bool strict = true;
#else
constexpr bool strict = false;
#endif

using Real = long double;

template <class T>
class ExponentialTest : public ::testing::Test {
 protected:
  static constexpr double unit = static_cast<double>(std::numeric_limits<T>::epsilon());

  /// Arguments of every magnitude and both signs, of the size of strains, up to where exponentials overflow
  /// and just above -1, where logarithms do.
  std::vector<T> arguments() const {
    std::mt19937_64 random(7);
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
    };
    const double tiniest = std::log2(static_cast<double>(std::numeric_limits<T>::min()));
    const double overflow = std::log(static_cast<double>(std::numeric_limits<T>::max()));
    std::vector<T> x;
    for (int n = 0; n < 50000; ++n) {
      x.push_back(static_cast<T>(std::exp2(uniform(tiniest + 2, -tiniest - 2))));
      x.push_back(-x.back());
      x.push_back(static_cast<T>(uniform(-1, 1)));
      x.push_back(static_cast<T>(uniform(-50, overflow)));
      x.push_back(static_cast<T>(std::exp2(uniform(-60, 0)) - 1));
    }
    return x;
  }

  /// Two units in the last place: rounding of the argument's remainder, of the series and of the last sum.
  /// Packs perform the same operations; contraction by the compiler may differ.
  template <class Function, class Exact>
  void expect_two_units(const Function& function, const Exact& exact) {
    for (const T x : arguments()) {
      const T expected = static_cast<T>(exact(static_cast<Real>(x)));
      const T value = function(x);
      const T packed = function(Pack<T>(x)).lanes[Pack<T>::width - 1];
      if (!std::isfinite(expected) || expected == T(0)) {
        ASSERT_EQ(std::isnan(value), std::isnan(expected)) << x;
        if (!std::isnan(expected)) {
          ASSERT_EQ(value, expected) << x;
        }
      } else {
        const auto of = [&](T a) {
          return static_cast<double>(static_cast<Real>(a) / exact(static_cast<Real>(x)));
        };
        ASSERT_NEAR(of(value), 1.0, 2 * unit) << x;
        ASSERT_NEAR(of(packed), 1.0, 2 * unit) << x;
        if (strict) {
          ASSERT_EQ(packed, value) << x;
        }
      }
    }
  }
};

using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(ExponentialTest, Reals);

TYPED_TEST(ExponentialTest, expm1_is_within_two_units_in_the_last_place) {
  this->expect_two_units([](const auto& x) { return expm1(x); }, [](Real x) { return std::expm1(x); });
}

TYPED_TEST(ExponentialTest, log1p_is_within_two_units_in_the_last_place) {
  this->expect_two_units([](const auto& x) { return log1p(x); }, [](Real x) { return std::log1p(x); });
}

TYPED_TEST(ExponentialTest, limits_are_the_library_s) {
  using T = TypeParam;
  constexpr T infinity = std::numeric_limits<T>::infinity();
  constexpr T nan = std::numeric_limits<T>::quiet_NaN();
  EXPECT_EQ(sandglass::expm1(T(0)), T(0));
  EXPECT_EQ(sandglass::expm1(infinity), infinity);
  EXPECT_EQ(sandglass::expm1(-infinity), T(-1));
  EXPECT_TRUE(std::isnan(sandglass::expm1(nan)));
  EXPECT_EQ(sandglass::log1p(T(0)), T(0));
  EXPECT_EQ(sandglass::log1p(T(-1)), -infinity);
  EXPECT_EQ(sandglass::log1p(infinity), infinity);
  EXPECT_TRUE(std::isnan(sandglass::log1p(T(-1.5))));
  EXPECT_TRUE(std::isnan(sandglass::log1p(-infinity)));
  EXPECT_TRUE(std::isnan(sandglass::log1p(nan)));
  // The last argument before infinity, and the first one beyond.
  const T last = std::log(std::numeric_limits<T>::max());
  EXPECT_TRUE(std::isfinite(sandglass::expm1(std::nextafter(last, T(0)))));
  EXPECT_EQ(sandglass::expm1(std::nextafter(last, infinity) * (T(1) + 2 * std::numeric_limits<T>::epsilon())),
            infinity);
  const T largest = std::numeric_limits<T>::max();
  EXPECT_NEAR(sandglass::log1p(largest) / last, 1.0, 2 * TestFixture::unit);
}

TYPED_TEST(ExponentialTest, lanes_are_computed_by_themselves) {
  using T = TypeParam;
  Pack<T> x(T(0));
  for (int lane = 0; lane < Pack<T>::width; ++lane) x.lanes[lane] = T(0.37) * static_cast<T>(lane * lane - 2);
  const Pack<T> e = expm1(x), l = log1p(x), r = sqrt(x);
  for (int lane = 0; lane < Pack<T>::width; ++lane) {
    const auto same = [&](T packed, T plain) {
      if (std::isnan(plain)) {
        EXPECT_TRUE(std::isnan(packed));
      } else {
        EXPECT_NEAR(packed, plain,
                    (strict ? 0.0 : 4 * TestFixture::unit) * std::abs(static_cast<double>(plain)));
      }
    };
    same(e.lanes[lane], sandglass::expm1(x.lanes[lane]));
    same(l.lanes[lane], sandglass::log1p(x.lanes[lane]));
    same(r.lanes[lane], std::sqrt(x.lanes[lane]));
  }
}

/// The quotients have the error of expm1 and log1p; the remainder loses at most a factor of (e - 1)/(e - 2) =
/// 2.4, where its series takes over.
TYPED_TEST(ExponentialTest, quotients_are_smooth_at_zero) {
  using T = TypeParam;
  const double tolerance = 8 * TestFixture::unit;
  EXPECT_EQ(relative_expm1(T(0)), T(1));
  EXPECT_EQ(relative_log1p(T(0)), T(1));
  EXPECT_EQ(relative_exponential_remainder(T(0)), T(1));
  for (const double magnitude : {1e-32, 1e-12, 1e-7, 1e-3, 0.1, 0.5, 0.999, 1.001, 3.0, 20.0}) {
    for (const T x : {static_cast<T>(magnitude), static_cast<T>(-magnitude)}) {
      const auto expect = [&](T value, Real exact) {
        EXPECT_NEAR(static_cast<double>(static_cast<Real>(value) / exact), 1.0, tolerance) << x;
      };
      const Real X = static_cast<Real>(x);
      expect(relative_expm1(x), std::expm1(X) / X);
      if (x > T(-1)) expect(relative_log1p(x), std::log1p(X) / X);
      Real series = 0;  // until convergence
      Real term = 1;
      for (int n = 3; n < 30; ++n) {
        series += term;
        term *= X / n;
      }
      expect(relative_exponential_remainder(x),
             std::abs(x) < T(1) ? series : 2 * (std::expm1(X) - X) / (X * X));
    }
  }
}

/// exp(A) by its series and squaring, without principal values, so that equal ones are not special; in long
/// double, because squaring multiplies roundoff.
template <int N>
Matrix<double, N, N> matrix_exponential(const Matrix<double, N, N>& A) {
  const int squarings = std::max(0, 1 + std::ilogb(N * largest_entry(A)));
  const auto part = std::ldexp(Real(1), -squarings) * from_double<Real>(A);
  Matrix<Real, N, N> term{};
  for (int i = 0; i < N; ++i) term(i, i) = 1;
  auto sum = term;
  for (int n = 1; n < 25; ++n) {
    term = Real(1) / n * (term * part);
    sum = sum + term;
  }
  for (int n = 0; n < squarings; ++n) sum = sum * sum;
  Matrix<double, N, N> exp{};
  std::ranges::transform(sum.entries, exp.entries.begin(), [](Real x) { return static_cast<double>(x); });
  return exp;
}

double norm(const Tensor<double>& a) {
  return std::sqrt(double_dot(a, a));
}

Tensor<double> symmetric(const Tensor<double>& a) {
  return 0.5 * (a + transpose(a));
}

/// Tensors with distinct, nearly equal, double and triple principal values, in random and in given frames.
std::vector<Tensor<double>> samples() {
  RandomGeometry random(5);
  std::vector<Tensor<double>> all;
  const auto add = [&](const Tensor<double>& values) {
    const auto Q = random.rotation();
    all.push_back(symmetric(Q * values * transpose(Q)));
    all.push_back(values);
  };
  const auto diagonal = [](double a, double b, double c) {
    return Tensor<double>{{a, 0, 0, 0, b, 0, 0, 0, c}};
  };
  for (int n = 0; n < 200; ++n) {
    all.push_back(symmetric(random.tensor(1.0)));
    add(diagonal(random.uniform(-0.9, 2), random.uniform(-0.9, 2), random.uniform(-0.9, 2)));
    const double a = random.uniform(-0.9, 2);
    const double b = random.uniform(-0.9, 2);
    add(diagonal(a, b, a));
    add(diagonal(a, a, a));
    for (const double apart : {1e-4, 1e-8, 1e-12, 1e-15}) add(diagonal(a, b, a + apart));
    Tensor<double> plane{};  // equal on the diagonal: the rotation by 45 degrees
    plane(0, 1) = plane(1, 0) = a;
    all.push_back(plane);
    all.push_back(1e-9 * symmetric(random.tensor(1.0)));
  }
  all.push_back(Tensor<double>{});
  return all;
}

/// About ten operations in sequence, each with a few roundings of the largest entry.
double roundoff(const Tensor<double>& S) {
  return 32 * eps * largest_entry(S);
}

/// n_0 (x) n_0 is a projection onto one axis; the square of the difference of the two others is one onto
/// their plane, unless their values coincide, where there are no unique axes.
TEST(Spectrum, has_the_principal_values_and_their_projections) {
  for (const auto& S : samples()) {
    const auto found = spectrum(S);
    auto values = found.values;
    std::sort(values.begin(), values.end());
    const auto exact = eigenvalues(S);
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(values[a], exact[a], roundoff(S));
    const double D = largest_entry(deviator(S)), apart = std::abs(found.values[1] - found.values[2]);
    const auto first = full(found.first), difference = full(found.difference);
    if (D > 1e-9 * largest_entry(S)) {
      EXPECT_LT(largest_entry(first * first - first), roundoff(S) / D);
      EXPECT_NEAR(trace(first), 1.0, roundoff(S) / D);
    }
    if (apart > 1e-9 * largest_entry(S)) {
      EXPECT_LT(largest_entry(difference * difference + first - identity<double>()), 4 * roundoff(S) / apart);
    }
    const auto again = isotropic_tensor(found, found.values, [](const auto& v) { return v; });
    EXPECT_LE(largest_entry(again - S), roundoff(S));
  }
}

TEST(Spectrum, of_single_precision_and_of_packs) {
  for (const auto& S : samples()) {
    Tensor<float> single;
    Tensor<Pack<float>> packed;
    Tensor<double> same;
    for (std::size_t n = 0; n < 9; ++n) {
      single.entries[n] = static_cast<float>(S.entries[n]);
      packed.entries[n] = Pack<float>(single.entries[n]);
      same.entries[n] = static_cast<double>(single.entries[n]);
    }
    const auto exact = spectrum(same).values;
    const auto found = spectrum(single).values;
    const auto lanes = spectrum(packed).values;
    const double tolerance =
        32 * static_cast<double>(std::numeric_limits<float>::epsilon()) * largest_entry(S);
    auto sorted = [](auto values) {
      std::sort(values.begin(), values.end());
      return values;
    };
    std::array<float, 3> lane;
    for (std::size_t a = 0; a < 3; ++a) lane[a] = lanes[a].lanes[Pack<float>::width - 1];
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_NEAR(static_cast<double>(sorted(found)[a]), sorted(exact)[a], tolerance);
      EXPECT_NEAR(static_cast<double>(sorted(lane)[a]), sorted(exact)[a], tolerance);
    }
  }
}

/// Where squares underflow no frame is found, but nothing grows or becomes NaN.
template <class T>
void expect_harmless(const std::vector<double>& sizes) {
  RandomGeometry random(6);
  for (const double size : sizes) {
    for (int n = 0; n < 200; ++n) {
      const auto S = symmetric(random.tensor(size));
      Tensor<T> same;
      for (std::size_t k = 0; k < 9; ++k) same.entries[k] = static_cast<T>(S.entries[k]);
      const auto found = spectrum(same);
      for (const T value : found.values) EXPECT_LT(static_cast<double>(std::abs(value)), 8 * size);
      const auto again = isotropic_tensor(found, found.values, [](const auto& v) { return v; });
      EXPECT_LT(static_cast<double>(largest_entry(again)), 8 * size);
    }
  }
}

TEST(Spectrum, of_next_to_nothing) {
  expect_harmless<double>({1e-155, 1e-180, 1e-300});
  expect_harmless<float>({1e-19, 1e-22, 1e-25, 1e-30, 1e-36});
}

/// exp(S), and its divided differences e^b (e^(a - b) - 1)/(a - b).
template <class T>
Tensor<T> exponential(const Tensor<T>& S) {
  const auto at = spectrum(S);
  const auto exp = [](const auto& x) { return decltype(x + x)(1.0) + expm1(x); };
  return isotropic_tensor(at, std::array<T, 3>{exp(at.values[0]), exp(at.values[1]), exp(at.values[2])},
                          [&](const auto& x) {
                            auto secants = x;
                            for (std::size_t c = 0; c < 3; ++c) {
                              const auto a = x[(c + 1) % 3];
                              const auto b = x[(c + 2) % 3];
                              secants[c] = exp(b) * relative_expm1(a - b);
                            }
                            return secants;
                          });
}

TEST(IsotropicTensor, is_the_matrix_function) {
  for (const auto& S : samples()) {
    const Tensor<double> exact = matrix_exponential(S);
    EXPECT_LT(largest_entry(exponential(S) - exact), 64 * eps * norm(exact));
  }
}

/// The derivative along E is the off-diagonal block of exp([S E; 0 S]) (Higham, Functions of Matrices, eq.
/// 3.16).
TEST(IsotropicTensor, has_the_derivative_of_the_matrix_function) {
  RandomGeometry random(9);
  for (const auto& S : samples()) {
    const auto E = symmetric(random.tensor(1.0));
    Matrix<double, 6, 6> block{};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        block(i, j) = block(i + 3, j + 3) = S(i, j);
        block(i, j + 3) = E(i, j);
      }
    }
    const Matrix<double, 6, 6> exp = matrix_exponential(block);
    Tensor<double> exact{};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) exact(i, j) = exp(i, j + 3);
    }
    const auto found = slope(exponential(along(S, E)));
    EXPECT_LT(largest_entry(found - exact), 256 * eps * std::sqrt(double_dot(exp, exp)));
  }
}

}  // namespace
}  // namespace sandglass::verification::spectral_test
