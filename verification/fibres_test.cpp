/// Directions of fibres, and volumetric parts that replace the law's.

#include "problem/fibres.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/case_file.hpp"
#include "mesh/box.hpp"
#include "support/case_text.hpp"
#include "support/derivatives.hpp"
#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::fibres_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

Vector row(const Tensor<double>& axes, int i) {
  return {axes(i, 0), axes(i, 1), axes(i, 2)};
}

TEST(Fibres, axes_are_a_right_handed_frame_along_fibre_and_sheet) {
  RandomGeometry random(3);
  for (int n = 0; n < 100; ++n) {
    const Tensor<double> given = random.tensor(1.0);
    const auto axes = axes_along(row(given, 0), row(given, 1));
    EXPECT_LT(largest_entry(axes * transpose(axes) - identity<double>()), 8 * eps);
    EXPECT_NEAR(determinant(axes), 1.0, 8 * eps);
    const Tensor<double> seen = given * transpose(axes);  // in material axes
    EXPECT_GT(seen(0, 0), 0.0);
    EXPECT_NEAR(seen(0, 1), 0.0, 8 * eps);
    EXPECT_NEAR(seen(0, 2), 0.0, 8 * eps);
    EXPECT_GT(seen(1, 1), 0.0);
    EXPECT_NEAR(seen(1, 2), 0.0, 64 * eps);  // the sheet is in the plane of the first two axes
    const auto alone = axes_along(row(given, 0));
    EXPECT_LT(largest_entry(alone * transpose(alone) - identity<double>()), 8 * eps);
    EXPECT_LT(distance(row(alone, 0), row(axes, 0)), 8 * eps);
  }
}

std::string with_material(const std::string& keys) {
  return replaced(box_case("hollow", "[0.2, 0.2, 0.1]", "[2, 2, 2]"), "law = \"neo-hookean\"\n",
                  "law = \"fibre-neo-hookean\"\nfibre_modulus = 1000.0\n" + keys + "\n") +
         "[sets]\nfoot = { z = [0.0, 0.0] }\n\n[[displacement]]\nset = \"foot\"\nvalue = [0.0, 0.0, 0.0]\n";
}

/// Centres (.05, .05, z) and (.15, .05, z) around the axis through (.1, .1): radius .0707; at the first,
/// outward is -(1, 1)/sqrt(2), so that the circle runs along (1, -1)/sqrt(2).
TEST(Fibres, wind_around_an_axis) {
  const TemporaryFolder folder;
  const auto at = [&](const std::string& radii, std::size_t element) {
    const std::string rule =
        "fibres = { axis = \"z\", center = [0.1, 0.1, 0.7], radii = " + radii + ", angles = [60, -30] }";
    return read_scene(folder.write("hollow.toml", with_material(rule))).materials.axes[element];
  };
  const double h = std::numbers::sqrt2 / 2.0;
  const auto expect = [&](const Tensor<double>& axes, double degrees, const Vector& circle,
                          const Vector& out) {
    const double a = degrees * std::numbers::pi / 180.0;
    const Vector fibre{std::cos(a) * circle[0], std::cos(a) * circle[1], std::sin(a)};
    EXPECT_LT(distance(row(axes, 0), fibre), 1e-12);
    EXPECT_LT(distance(row(axes, 1), out), 1e-12);
  };
  expect(at("[0.02, 0.03]", 0), -30.0, {h, -h, 0.0}, {-h, -h, 0.0});  // beyond the outer radius
  expect(at("[0.1, 0.2]", 0), 60.0, {h, -h, 0.0}, {-h, -h, 0.0});     // within the inner radius
  const std::string around =
      fmt::format("[{}, {}]", 0.05 * std::numbers::sqrt2 - 0.01, 0.05 * std::numbers::sqrt2 + 0.02);
  expect(at(around, 0), 30.0, {h, -h, 0.0}, {-h, -h, 0.0});  // a third of the way out
  expect(at(around, 1), 30.0, {h, h, 0.0}, {h, -h, 0.0});
}

TEST(Fibres, are_read_from_a_file_with_a_line_for_each_element) {
  const TemporaryFolder folder;
  std::string lines = "# fibres and sheets\n";
  for (int e = 0; e < 8; ++e) lines += fmt::format("{}, 1, 0  0 0 2\n", e);
  folder.write("fibres.txt", lines);
  const std::string text = with_material("fibres = { file = \"fibres.txt\" }");
  const Scene scene = read_scene(folder.write("hollow.toml", text));
  ASSERT_EQ(scene.materials.axes.size(), 8U);
  for (std::size_t e = 0; e < 8; ++e) {
    const double x = static_cast<double>(e), length = std::hypot(x, 1.0);
    EXPECT_LT(distance(row(scene.materials.axes[e], 0), {x / length, 1.0 / length, 0.0}), 4 * eps);
    EXPECT_LT(distance(row(scene.materials.axes[e], 1), {0.0, 0.0, 1.0}), 4 * eps);
  }
  folder.write("fibres.txt", lines + "1 0 0 0 1 0\n");
  EXPECT_THROW(read_scene(folder.write("hollow.toml", text)), InputError);  // nine lines for eight elements
  folder.write("fibres.txt", lines + "1 0 0\n");
  EXPECT_THROW(read_scene(folder.write("hollow.toml", text)), InputError);  // sheets only in some lines
  folder.write("fibres.txt", "1 0 north\n");
  EXPECT_THROW(read_scene(folder.write("hollow.toml", text)), InputError);
}

/// A turned law equals the law in turned axes, for elastic laws and the bounds of their tangents.
TEST(Fibres, called_laws_turn_with_their_axes) {
  RandomGeometry random(7);
  for (int n = 0; n < 50; ++n) {
    const auto plain = sample_law<HolzapfelOgden>(0.45);
    const CalledLaw called(plain);
    const Tensor<double> A = random.rotation(), H = random.tensor(0.2);
    const auto law = called.with_axes(&A);
    const auto own = A * H * transpose(A);
    const double unit = largest_entry(plain.piola(own));
    EXPECT_LT(largest_entry(law.piola(H) - transpose(A) * plain.piola(own) * A), 64 * eps * unit);
    EXPECT_NEAR(law.energy(H), plain.energy(own), 64 * eps * plain.energy(own));
    EXPECT_NEAR(tangent_bound(law, H).gradient, tangent_bound(plain, own).gradient,
                64 * eps * tangent_bound(plain, own).gradient);
    const auto change = volume_change(H);
    const auto tau = law.weighted_kirchhoff(0.3, H, change, 5.0);
    const auto P = law.weighted_piola(0.3, H, change, 5.0);
    EXPECT_LT(largest_entry(tau - P * transpose(identity<double>() + H)), 64 * eps * (unit + 5.0));
    const auto strain = 0.5 * (H + transpose(H));
    const auto stress = transpose(A) * small_strain_stress(plain, A * strain * transpose(A)) * A;
    EXPECT_LT(largest_entry(small_strain_stress(law, strain) - stress), 64 * eps * largest_entry(stress));
  }
}

template <class Part>
class VolumetricPartTest : public ::testing::Test {};

template <class List>
struct TestTypes;
template <class... Parts>
struct TestTypes<TypeList<Parts...>> {
  using type = ::testing::Types<Parts...>;
};
TYPED_TEST_SUITE(VolumetricPartTest, TestTypes<VolumetricParts>::type);

TYPED_TEST(VolumetricPartTest, has_its_derivatives_and_the_bulk_modulus_when_undeformed) {
  for (const double x : {-0.9, -0.3, -1e-3, 0.0, 1e-6, 0.4, 1.5}) {
    const Dual<double> moving(x, 1.0);
    const double slope = TypeParam::slope(x), curvature = TypeParam::curvature(x);
    EXPECT_NEAR(TypeParam::energy(moving).slope, slope, 16 * eps * std::abs(slope));
    EXPECT_NEAR(TypeParam::slope(moving).slope, curvature, 16 * eps * (1.0 + std::abs(curvature)));
  }
  EXPECT_EQ(TypeParam::energy(0.0), 0.0);
  EXPECT_EQ(TypeParam::slope(0.0), 0.0);
  EXPECT_EQ(TypeParam::curvature(0.0), 1.0);
}

/// No digits are lost near the undeformed shape, in single precision either.
TYPED_TEST(VolumetricPartTest, nothing_cancels_at_small_strains) {
  for (const float x : {1e-3F, -1e-4F, 1e-6F, -1e-8F}) {
    EXPECT_NEAR(TypeParam::energy(x) / (0.5F * x * x), 1.0F, 2e-6F + 2.0F * std::abs(x));
    EXPECT_NEAR(TypeParam::slope(x) / x, 1.0F, 1e-6F + 2.0F * std::abs(x));
  }
}

/// The two parts other than the law's own, at a known value: J = 2.
TEST(VolumetricPart, has_known_values) {
  EXPECT_DOUBLE_EQ(LogarithmicPart::energy(1.0), 0.5 * std::log(2.0) * std::log(2.0));
  EXPECT_DOUBLE_EQ(QuadraticLogarithmicPart::energy(1.0), 0.25 * (3.0 - 2.0 * std::log(2.0)));
  const CalledLaw law(sample_law<NeoHookean>(0.45), LogarithmicPart{});
  EXPECT_DOUBLE_EQ(law.pressure(1.0), law.bulk_modulus() * std::log(2.0) / 2.0);
  const auto H = (std::cbrt(2.0) - 1.0) * identity<double>();
  EXPECT_NEAR(law.energy(H), law.bulk_modulus() * 0.5 * std::log(2.0) * std::log(2.0),
              1e-12 * law.bulk_modulus());
  const auto dW = gradient(H, [&](const auto& dual) { return law.energy(dual); });
  EXPECT_LT(largest_entry(dW - law.piola(H)), 1e-12 * law.bulk_modulus());
}

}  // namespace
}  // namespace sandglass::verification::fibres_test
