/// The stability of hourglass modes under compression, where enhanced strains are known to fail (Wriggers and
/// Reese 1996, CMAME 135:201): the tangent of homogeneously deformed elements and blocks.

#include <gtest/gtest.h>

#include <algorithm>

#include "comparison/finding.hpp"
#include "element/eight_point.hpp"
#include "support/method_test.hpp"
#include "support/scenes.hpp"
#include "support/single_element.hpp"
#include "support/tangent.hpp"

namespace sandglass::verification::compression_test {
namespace {

/// The tangent between the twelve hourglass modes h_a e_i / sqrt(8) of one element; row and column 3 a + i.
/// In homogeneous states of a box no other mode couples to them: they are odd in two or three directions.
using HourglassBlock = Matrix<double, 12, 12>;

/// A unit hourglass mode of the nodes.
NodalVectors<double> hourglass_mode(int n) {
  constexpr auto base = hourglass_base_vectors();
  NodalVectors<double> mode{};
  for (int I = 0; I < 8; ++I) mode(I, n % 3) = base(I, n / 3) / std::sqrt(8.0);
  return mode;
}

/// The block at displacements u, reached from the undeformed shape in one step.
template <class Kernel, class Law>
HourglassBlock hourglass_block(const NodalVectors<double>& X, const NodalVectors<double>& u, const Law& law) {
  const auto element = dual_element<Kernel>(Kernel::precompute(X, law, {}));
  SingleElement<Kernel, Law, D> there(X, law, element);
  there.to(constant(u));
  HourglassBlock block;
  for (int n = 0; n < 12; ++n) {
    SingleElement<Kernel, Law, D> disturbed = there;
    const auto force = slope(disturbed.to(along(u, hourglass_mode(n))));
    for (int m = 0; m < 12; ++m) block(m, n) = double_dot(hourglass_mode(m), force);
  }
  return block;
}

double smallest_eigenvalue(const HourglassBlock& block) {
  return eigenvalues(0.5 * (block + transpose(block))).front();
}

/// A box with edges l.
NodalVectors<double> box_nodes(const Vector& l) {
  NodalVectors<double> X = corner_signs;
  for (int I = 0; I < 8; ++I) {
    for (int i = 0; i < 3; ++i) X(I, i) *= 0.5 * l[index(i)];
  }
  return X;
}

/// (F - 1) X for principal stretches.
NodalVectors<double> stretched(const NodalVectors<double>& X, const Vector& stretches) {
  NodalVectors<double> u = X;
  for (int I = 0; I < 8; ++I) {
    for (int i = 0; i < 3; ++i) u(I, i) *= stretches[index(i)] - 1.0;
  }
  return u;
}

Tensor<double> gradient_of(const Vector& stretches) {
  Tensor<double> H{};
  for (int i = 0; i < 3; ++i) H(i, i) = stretches[index(i)] - 1.0;
  return H;
}

double largest_entry(const HourglassBlock& block) {
  double largest = 0.0;
  for (const double entry : block.entries) largest = std::max(largest, std::abs(entry));
  return largest;
}

/// States of the tests: compressed bars and sheets, compression from all sides, and one in tension.
const std::vector<Vector> states{{1.2, 1.2, 0.7}, {1.4, 1.4, 0.5}, {2.2, 2.2, 0.2}, {1.6, 1.0, 0.6},
                                 {3.0, 1.0, 0.3}, {0.9, 0.9, 0.9}, {1.0, 1.0, 0.8}, {0.7, 0.7, 2.0}};

const Vector edges{0.11, 0.09, 0.1};

// One point, Total Lagrangian.

template <class Pair>
class RestControlTest : public ::testing::Test {};
TYPED_TEST_SUITE(RestControlTest, ElasticMethodWithLawTypes, EntryName);

/// With one point, strain energy depends only on the mean gradient, to which hourglass modes do not
/// contribute: their tangent is the control's, at every stretch. A control that does not follow the
/// deformation keeps its undeformed tangent K; one that follows has phi F^-T K F^-1 and, by Ostrowski's
/// theorem, at least phi lambda_min(K) over the square of the largest stretch. So no compression, pressure or
/// law removes the stiffness of an hourglass mode if the control has any. A method that added the pressure's
/// share of the modes, as elements with eight points and Updated Lagrangian ones do, would fail.
TYPED_TEST(RestControlTest, no_compression_softens_hourglass_modes_to_nothing) {
  using Method = typename TypeParam::Method;
  using Hourglass = typename Method::Hourglass;
  if constexpr (integration_points<Method> != 1) {
    GTEST_SKIP() << "several points";
  } else {
    using Law = typename TypeParam::Law;
    const auto law = sample_law<Law>(0.49);
    const auto X = box_nodes(edges);
    const HourglassBlock undeformed =
        hourglass_block<typename TypeParam::Kernel>(X, NodalVectors<double>{}, law);
    for (const Vector& f : states) {
      const HourglassBlock block = hourglass_block<typename TypeParam::Kernel>(X, stretched(X, f), law);
      double phi = 1.0;
      if constexpr (GrowsWithDeformation<Hourglass>) {
        phi = (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]) / 3.0 * std::pow(f[0] * f[1] * f[2], -2.0 / 3.0);
      }
      double largest = 1.0;
      HourglassBlock expected = undeformed;
      if constexpr (FollowsDeformation<Hourglass> && !is_linear<Method>) {
        largest = *std::max_element(f.begin(), f.end());
        for (int m = 0; m < 12; ++m) {
          for (int n = 0; n < 12; ++n) expected(m, n) *= phi / (f[index(m % 3)] * f[index(n % 3)]);
        }
      }
      // Roundoff of a product of stresses and gradients, of the order of the element's own stiffness K l.
      const double roundoff = 1e-13 * law.bulk_modulus() * edges[0];
      EXPECT_LT(largest_entry(block - expected), roundoff + 1e-12 * largest_entry(expected));
      if constexpr (Hourglass::traits.active) {
        const double floor = phi * smallest_eigenvalue(undeformed) / (largest * largest);
        EXPECT_GT(floor, 0.0);
        EXPECT_GT(smallest_eigenvalue(block), floor * (1.0 - 1e-9) - roundoff);
      }
    }
  }
}

// One point, Updated Lagrangian.

/// (m^3 per m^2) the second derivative of a box's volume between its hourglass modes: the integral of
/// tr G_m tr G_n - tr(G_m G_n) over their gradients, by 2x2x2 Gauss points, which is exact.
HourglassBlock volume_curvature(const NodalVectors<double>& x) {
  HourglassBlock sum{};
  for (const auto& xi : gauss_points()) {
    const PointGradient point = point_gradient(x, xi);
    std::array<Tensor<double>, 12> G;
    for (int n = 0; n < 12; ++n) G[index(n)] = transpose(hourglass_mode(n)) * point.gradient;
    for (int m = 0; m < 12; ++m) {
      for (int n = 0; n < 12; ++n) {
        sum(m, n) +=
            point.measure * (trace(G[index(m)]) * trace(G[index(n)]) - trace(G[index(m)] * G[index(n)]));
      }
    }
  }
  return sum;
}

template <class Method>
class RebuiltControlTest : public ::testing::Test {
 protected:
  using Kernel = FormulationOf<Method, NeoHookean>;
  const NeoHookean law = sample_law<NeoHookean>(0.49);
  const NodalVectors<double> X = box_nodes(edges);

  /// The block as the sum of its parts: the control of a box that has the deformed shape when undeformed, and
  /// sigma times the second derivative of the volume, since f_I = sigma dv/dx_I.
  HourglassBlock expected(const Vector& f) const {
    const auto x = box_nodes({edges[0] * f[0], edges[1] * f[1], edges[2] * f[2]});
    const Tensor<double> F = identity<double>() + gradient_of(f);
    const Tensor<double> sigma = (1.0 / determinant(F)) * (law.piola(gradient_of(f)) * transpose(F));
    HourglassBlock block = hourglass_block<Kernel>(x, NodalVectors<double>{}, law);
    const HourglassBlock curvature = volume_curvature(x);
    for (int m = 0; m < 12; ++m) {
      for (int n = 0; n < 12; ++n) block(m, n) += sigma(m % 3, m % 3) * curvature(m, n);
    }
    return block;
  }
};
TYPED_TEST_SUITE(RebuiltControlTest, UpdatedLagrangianTypes, EntryName);

/// Forces of the mean current gradient are stress times the derivative of the volume, and hourglass modes
/// change its second derivative: stress adds to the control, with either sign.
TYPED_TEST(RebuiltControlTest, stress_acts_on_hourglass_modes_through_the_curvature_of_the_volume) {
  for (const Vector& f : states) {
    const HourglassBlock block =
        hourglass_block<typename TestFixture::Kernel>(this->X, stretched(this->X, f), this->law);
    const HourglassBlock parts = this->expected(f);
    EXPECT_LT(largest_entry(block - parts), 1e-11 * this->law.bulk_modulus() * edges[0]);
  }
}

/// So, unlike above, a single element's control gives way at some pressure: the curvature has eigenvalues of
/// both signs, since its diagonal is zero. Pressure from all sides shrinks an element without changing its
/// shape, and its control K and curvature B are proportional to its edges; P B is no less than K along the
/// mode of B's largest eigenvalue once P is the ratio of their largest eigenvalues.
TYPED_TEST(RebuiltControlTest, pressure_takes_hourglass_modes_away) {
  using Element = typename TestFixture::Kernel;
  const auto largest = [](const HourglassBlock& block) { return eigenvalues(block).back(); };
  const HourglassBlock K = hourglass_block<Element>(this->X, NodalVectors<double>{}, this->law);
  const HourglassBlock B = volume_curvature(this->X);
  ASSERT_GT(largest(B), 0.0);
  const double roundoff = 1e-12 * this->law.bulk_modulus() * edges[0];
  EXPECT_GT(smallest_eigenvalue(K), -roundoff);
  const double P = 1.001 * largest(K) / largest(B) + 1e-3 * this->law.shear_modulus();
  const double f = std::cbrt(1.0 - P / this->law.bulk_modulus());  // its pressure is K (1 - J)
  EXPECT_LT(smallest_eigenvalue(hourglass_block<Element>(this->X, stretched(this->X, {f, f, f}), this->law)),
            -roundoff);
}

// Eight points.

/// The lateral stretch at which sides are free of stress: those in x, and those in y too unless held.
Vector free_sides(const NeoHookean& law, double stretch, bool plane) {
  double low = 0.1, high = 20.0;
  for (int n = 0; n < 200; ++n) {
    const double a = 0.5 * (low + high);
    const Vector f{a, plane ? 1.0 : a, stretch};
    (law.piola(gradient_of(f))(0, 0) < 0.0 ? low : high) = a;
  }
  const double a = 0.5 * (low + high);
  return {a, plane ? 1.0 : a, stretch};
}

template <class Method>
class EightPointTest : public ::testing::Test {};
TYPED_TEST_SUITE(EightPointTest, MethodTypes, EntryName);

/// A free cube of neo-Hookean material between frictionless plates that do not pull: for the modes that twist
/// its faces, q_1 about x, q_2 about y, q_3 about z, gradients have no trace and no product with F, so that
/// the second variation is mu J^(-2/3) (g : g + c tr(G G)), G = g F^-1. Here c = I1/3 - p J^(5/3) / mu, which
/// is the square of the stretch a of a stress-free side. Between (q_1, q_2, q_3) this is a matrix of ones
/// with c / (2 f_i f_j) off the diagonal. It is singular at a / stretch = sqrt(3) under uniaxial stress, at
/// any Poisson's ratio (3^(-1/3) = 0.693 when incompressible), and where a^2 (1 + 1 / stretch^2) = 4 in plane
/// strain (0.800). Pressure has no influence: full integration and mean dilatation fail together.
TYPED_TEST(EightPointTest, twisting_modes_of_a_free_cube_give_way_at_the_stretch_of_theory) {
  if constexpr (integration_points<TypeParam> != 8) {
    GTEST_SKIP() << "other points";
  } else {
    using Kernel = FormulationOf<TypeParam, NeoHookean>;
    const auto X = box_nodes({0.1, 0.1, 0.1});
    // At nu = .25 the law's volumetric energy is so weak that sides contract under compression.
    for (const double nu : {0.45, 0.49, 0.499}) {
      const auto law = sample_law<NeoHookean>(nu);
      for (const bool plane : {false, true}) {
        const auto smallest = [&](double stretch) {
          return smallest_eigenvalue(
              hourglass_block<Kernel>(X, stretched(X, free_sides(law, stretch, plane)), law));
        };
        ASSERT_GT(smallest(1.0), 0.0);
        double low = 0.4, high = 1.0;
        ASSERT_LT(smallest(low), 0.0);
        for (int n = 0; n < 45; ++n) (smallest(0.5 * (low + high)) < 0.0 ? low : high) = 0.5 * (low + high);
        const double a = free_sides(law, low, plane)[0];
        // Bisection to 1e-13; the roundoff of forces over the slope of the eigenvalue, both of the order of K
        // and mu.
        if (plane) {
          EXPECT_NEAR(a * a * (1.0 + 1.0 / (low * low)), 4.0, 1e-8);
        } else {
          EXPECT_NEAR(a / low, std::sqrt(3.0), 1e-8);
        }
      }
    }
  }
}

// Blocks of elements.

/// A cube of n^3 elements, some of whose components are free.
class Block {
 public:
  Block(std::string_view method, const NeoHookean& law, int n, bool plates)
      : mesh_(box({1.0, 1.0, 1.0}, {n, n, n})),
        elements_(std::get<0>(make_internal_force(mesh_, law, {std::string(method)}, 1000.0))) {
    for (std::size_t node = 0; node < mesh_.points.size(); ++node) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto inside = [&](std::size_t k) {
          return mesh_.points[node][k] > 0.0 && mesh_.points[node][k] < 1.0;
        };
        if (plates ? i < 2 || inside(2) : inside(0) && inside(1) && inside(2)) free_.emplace_back(node, i);
      }
    }
  }

  /// The smallest eigenvalue (N/m) of the symmetric part of the tangent at principal stretches, except for
  /// rigid motions of the free sides, and the share of hourglass amplitudes in the square of its mode.
  std::pair<double, double> least(const Vector& stretches) const {
    NodalField u = mesh_.points;
    for (auto& d : u) {
      for (std::size_t i = 0; i < 3; ++i) d[i] *= stretches[i] - 1.0;
    }
    const State<double> there = reached(elements_->undeformed(), u).first;
    // Differences of forces, linear up to 1e-6 of a size and rounded to 1e-16 over that: 1e-9 of stiffness.
    constexpr double step = 1e-6;
    const std::size_t size = free_.size();
    std::vector<double> K(size * size);
    for (std::size_t column = 0; column < size; ++column) {
      const auto [node, i] = free_[column];
      NodalField more = u, less = u;
      more[node][i] += step;
      less[node][i] -= step;
      const NodalField f = reached(there, more).second, g = reached(there, less).second;
      for (std::size_t row = 0; row < size; ++row) {
        const auto [m, k] = free_[row];
        const double slope = (f[m][k] - g[m][k]) / (2.0 * step);
        K[row * size + column] += 0.5 * slope;
        K[column * size + row] += 0.5 * slope;
      }
    }
    const Eigenpairs modes = symmetric_eigenpairs(K);
    // Between plates, three rigid motions (two slides, a turn) are among the first modes if they exist.
    for (std::size_t mode = 0; mode < size; ++mode) {
      const double value = modes.values[mode];
      if (std::abs(value) < 1e-6 * modes.values.back()) continue;
      NodalField v(mesh_.points.size());
      for (std::size_t row = 0; row < size; ++row)
        v[free_[row].first][free_[row].second] = modes.vectors[mode][row];
      const HourglassContent content = hourglass_content(mesh_, v);
      return {value, content.hourglass * content.hourglass / (content.total * content.total)};
    }
    return {0.0, 0.0};
  }

 private:
  /// Continues to displacements u; returns the state there and the forces.
  std::pair<State<double>, NodalField> reached(State<double> state, const NodalField& u) const {
    const Rows<double> rows = to_rows<double>(u, elements_->layout());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t i = 0; i < 3; ++i) state.increment[r][i] = rows[r][i] - state.u[r][i];
    }
    state.u = rows;
    Rows<double> force(rows.size());
    elements_->evaluate(state, force);
    return {state, to_field(force, elements_->layout())};
  }

  Mesh mesh_;
  std::unique_ptr<InternalForce<double>> elements_;
  std::vector<std::pair<std::size_t, std::size_t>> free_;
};

class BlockTest : public MethodTest {};
INSTANTIATE_TEST_SUITE_P(, BlockTest, each_of(Methods{}), method_label);

/// A homogeneous body whose whole boundary is held is stable in every state in which its law is strongly
/// elliptic (van Hove 1947), as the neo-Hookean law is at any pressure; a negative eigenvalue here would be
/// the element's fault. Stiffness that single elements lose to pressure, their neighbours restore, since the
/// volume of the whole does not change.
TEST_P(BlockTest, blocks_with_a_held_boundary_stay_stable_as_the_continuum_does) {
  const auto law = sample_law<NeoHookean>(0.49);
  const Block block(method.name, law, 3, false);
  for (const Vector& f : {Vector{1.0, 1.0, 1.0}, free_sides(law, 0.5, false), free_sides(law, 0.2, false),
                          free_sides(law, 0.4, true), Vector{1.0, 1.0, 0.8}, Vector{0.9, 0.9, 0.9}}) {
    EXPECT_GT(block.least(f).first, 0.0) << f[0] << " " << f[1] << " " << f[2];
  }
}

/// A block between two frictionless plates is pressed to 0.55 of its height. Its free sides wrinkle, like
/// those of any half-space of this material, only once stretch^(3/2) = 0.296, at 0.444 (Biot 1963). Elements
/// that hourglass give way earlier, in an hourglass mode.
TEST_P(BlockTest, blocks_between_plates_do_not_hourglass_before_the_sides_wrinkle) {
  const auto law = sample_law<NeoHookean>(0.49);
  const Block block(method.name, law, 4, true);
  const auto [least, hourglass_share] = block.least(free_sides(law, 0.55, false));
  if (!leaves_hourglass_modes(choice())) {
    EXPECT_GT(least, 0.0);
  } else {
    EXPECT_LT(least, 0.0);
    EXPECT_GT(hourglass_share, 0.5);
  }
}

}  // namespace
}  // namespace sandglass::verification::compression_test
