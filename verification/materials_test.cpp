/// Bodies of several materials: each element has its own, in every method.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "element/methods.hpp"
#include "io/case_file.hpp"
#include "io/mesh_file.hpp"
#include "mesh/generators.hpp"
#include "mesh/mesh_part.hpp"
#include "solve/relaxation.hpp"
#include "solve/stable_step.hpp"
#include "support/case_text.hpp"
#include "support/method_test.hpp"
#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::materials_test {
namespace {

struct MaterialsTest : MethodTest {
  /// Materials in random order: inlined laws and others, one with another volumetric part, some with
  /// different fibres in every element, and two viscoelastic ones if the method supports them.
  Materials mixed(std::size_t elements) const {
    Materials materials{{{sample_law<NeoHookean>(0.45, 30000.0), 2000.0},
                         {sample_law<Yeoh>(0.3), 1000.0},
                         {sample_law<MooneyRivlin>(0.3), 1000.0, LogarithmicPart{}},
                         {sample_law<FibreNeoHookean>(0.4), 1000.0},
                         {sample_law<NeoHookean>(0.49), 500.0}}};
    if (method.knows_viscoelasticity) {
      materials.list.push_back({sample_law<Viscoelastic<Ogden>>(0.4), 1500.0});
      materials.list.push_back({sample_law<Viscoelastic<Guccione>>(0.4), 1500.0});
    }
    RandomGeometry random(11);
    for (std::size_t e = 0; e < elements; ++e) {
      materials.axes.push_back(random.rotation());
      materials.of_element.push_back(static_cast<std::uint16_t>(random.uniform(0.0, 0.999) *
                                                                static_cast<double>(materials.list.size())));
    }
    return materials;
  }

  /// Results of a mesh's elements at displacements u, reached in a tenth of a second.
  struct Answer {
    Answer(const MethodChoice& variant, const Mesh& mesh, const Materials& materials, const NodalField& u)
        : bounds(mesh.cells.size()), densities(mesh.cells.size()) {
      const auto elements = std::get<0>(make_internal_force(mesh, materials, variant));
      State<double> state = state_at(*elements, u);
      state.step = 0.1;
      Rows<double> rows(state.u.size());
      elements->evaluate(state, rows);
      force = to_field(rows, elements->layout());
      energies = elements->energies(state);
      elements->stiffness_bounds(state, bounds);
      elements->hourglass_energy_densities(state, densities);
      std::vector<double> p(mesh.cells.size(), 100.0), defect(p);
      elements->replace_pressures(state, p, lame_lambdas(materials), rows, defect);
      pressure_force = to_field(rows, elements->layout());
    }
    NodalField force, pressure_force;
    StrainEnergies energies;
    std::vector<double> bounds, densities;
  };
};
INSTANTIATE_TEST_SUITE_P(, MaterialsTest, each_of(Methods{}), method_label);

/// A body is the sum of parts of one material each: forces and energies add up, and each element's results
/// are those of its part. The meshes have many chunks and materials that leave lanes empty.
TEST_P(MaterialsTest, a_body_is_the_sum_of_its_parts) {
  const Mesh mesh = box({0.1, 0.12, 0.2}, {6, 7, 12});
  RandomGeometry random(5);
  NodalField u(mesh.points.size());
  for (auto& row : u) {
    for (double& x : row) x = 0.001 * random.uniform(-1.0, 1.0);
  }
  const Materials materials = mixed(mesh.cells.size());
  const Answer whole(choice(), mesh, materials, u);
  NodalField force(u.size()), pressure_force(u.size());
  StrainEnergies energies;
  const double unit = largest_distance(whole.force, NodalField(u.size()));
  for (std::size_t m = 0; m < materials.list.size(); ++m) {
    std::vector<bool> marked(mesh.cells.size());
    for (std::size_t e = 0; e < marked.size(); ++e) marked[e] = materials.of(e) == m;
    const MeshPart part = part_of_mesh(mesh, marked);
    NodalField u_part;
    for (const int node : part.node_of) u_part.push_back(u[index(node)]);
    const Materials own{{materials.list[m]}, {}, materials_of(materials, part.element_of).axes};
    const Answer alone(choice(), part.mesh, own, u_part);
    for (std::size_t n = 0; n < u_part.size(); ++n) {
      for (std::size_t i = 0; i < 3; ++i) {
        force[index(part.node_of[n])][i] += alone.force[n][i];
        pressure_force[index(part.node_of[n])][i] += alone.pressure_force[n][i];
      }
    }
    energies.strain += alone.energies.strain;
    energies.hourglass += alone.energies.hourglass;
    for (std::size_t e = 0; e < alone.bounds.size(); ++e) {
      const std::size_t there = index(part.element_of[e]);
      EXPECT_NEAR(whole.bounds[there], alone.bounds[e], 1e-9 * alone.bounds[e]);
      EXPECT_NEAR(whole.densities[there], alone.densities[e], 1e-9 * (alone.densities[e] + 1.0));
    }
  }
  // Elements may be in other lanes: the same sums in another order.
  EXPECT_LT(largest_distance(force, whole.force), 1e-11 * unit);
  EXPECT_LT(largest_distance(pressure_force, whole.pressure_force), 1e-11 * unit);
  EXPECT_NEAR(energies.strain, whole.energies.strain, 1e-11 * energies.strain);
  EXPECT_NEAR(energies.hourglass, whole.energies.hourglass, 1e-11 * energies.strain);
}

/// A body and its fibres turn together: forces turn too, and elements have the same energies, bounds and
/// levels. If fibres do not turn, forces differ.
TEST_P(MaterialsTest, fibres_turn_with_the_body) {
  if (is_updated_lagrangian(method) || method.is_linear) {
    GTEST_SKIP() << "the method is not objective";
  }
  const Mesh mesh = box({0.1, 0.12, 0.2}, {3, 4, 5});
  RandomGeometry random(5);
  const Tensor<double> Q = random.rotation();
  const auto turned = [&](const Vector& v) {
    const Triple<double> w = Q * Triple<double>{{v[0], v[1], v[2]}};
    return Vector{w(0, 0), w(1, 0), w(2, 0)};
  };
  Mesh other = mesh;
  for (Vector& X : other.points) X = turned(X);
  NodalField u(mesh.points.size()), u_other;
  for (auto& row : u) {
    for (double& x : row) x = 0.002 * random.uniform(-1.0, 1.0);
    u_other.push_back(turned(row));
  }
  Materials materials{{{sample_law<Guccione>(0.4)}}}, along = materials;
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    materials.axes.push_back(random.rotation());
    along.axes.push_back(materials.axes.back() * transpose(Q));
  }
  const Answer here(choice(), mesh, materials, u), there(choice(), other, along, u_other),
      left_behind(choice(), other, materials, u_other);
  const double unit = largest_distance(here.force, NodalField(u.size()));
  NodalField expected;
  for (const Vector& f : here.force) expected.push_back(turned(f));
  EXPECT_LT(largest_distance(there.force, expected), 1e-10 * unit);
  EXPECT_GT(largest_distance(left_behind.force, expected), 1e-3 * unit);
  EXPECT_NEAR(there.energies.strain, here.energies.strain, 1e-10 * here.energies.strain);
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    EXPECT_NEAR(there.bounds[e], here.bounds[e], 1e-9 * here.bounds[e]);
  }
}

TEST_P(MaterialsTest, bits_do_not_depend_on_threads) {
  const Mesh mesh = box({0.1, 0.12, 0.2}, {6, 7, 12});
  NodalField u;
  for (const Vector& X : mesh.points) u.push_back({0.1 * X[2] * X[1], 0.0, 0.05 * std::sin(30.0 * X[0])});
  const Materials materials = mixed(mesh.cells.size());
  const Answer one(choice(), mesh, materials, u),
      three(choice(Precision::double_precision, 3), mesh, materials, u);
  EXPECT_EQ(one.force, three.force);
  EXPECT_EQ(one.pressure_force, three.pressure_force);
}

/// Two layers pressed together between held sides: each has a uniform strain, and the stress across is equal.
/// All elements represent that exactly; the strains follow from two numbers.
TEST_P(MaterialsTest, layers_under_pressure_carry_the_same_stress) {
  if (method.is_linear) GTEST_SKIP() << "another stress";
  Case description = plain_case(NeoHookean{});
  const NeoHookean stiff = sample_law<NeoHookean>(0.3, 9000.0);
  const MooneyRivlin soft = sample_law<MooneyRivlin>(0.4);
  description.materials = {{{stiff, 1000.0}, "lower"}, {{soft, 1000.0}, ""}};
  description.element_sets = {{"lower", false, {std::nullopt, std::nullopt, Interval{0.0, 1.0}}, {}}};
  const double low = 1.0, high = 2.0, pressed = 0.4;
  const Mesh mesh = box({1.0, 1.0, low + high}, {2, 2, 6});
  const auto at = [&](double z) {
    return nodes_where(mesh.points, [=](const Vector& X) { return std::abs(X[2] - z) < 1e-9; });
  };
  const NodeSets sets{{"all", nodes_where(mesh.points, [](const Vector&) { return true; })},
                      {"bottom", at(0.0)},
                      {"top", at(3.0)}};
  description.displacements = {{"all", {}, {true, true, false}},
                               {"bottom", {}, {false, false, true}},
                               {"top", {0.0, 0.0, -pressed}, {false, false, true}}};
  description.relaxation.tolerance = 1e-10;
  const auto stress = [](const auto& law, double e) {
    Tensor<double> H{};
    H(2, 2) = e;
    return law.piola(H)(2, 2);
  };
  double from = -pressed / low, to = 0.0;  // the strain of the lower layer, by bisection
  for (int k = 0; k < 60; ++k) {
    const double e = 0.5 * (from + to);
    (stress(stiff, e) > stress(soft, (-pressed - low * e) / high) ? to : from) = e;
  }
  const double e = 0.5 * (from + to);
  EXPECT_LT(e, -0.02);
  const Scene scene = make_scene(description, mesh, sets);
  Recorder recorder;
  const Relaxation found = relax(Model(scene, choice()), recorder);
  ASSERT_TRUE(found.converged);
  NodalField exact;
  for (const Vector& X : mesh.points) {
    const double rest = (-pressed - low * e) / high;
    exact.push_back({0.0, 0.0, X[2] < low ? e * X[2] : e * low + rest * (X[2] - low)});
  }
  EXPECT_LT(largest_distance(recorder.frames.back().u, exact), 1e-8 * pressed);
}

/// The step of a body is that of its part with the shortest one: element bounds are independent.
TEST_P(MaterialsTest, the_stable_step_is_the_shortest_of_the_parts) {
  if (method.is_condensed) GTEST_SKIP() << "takes no steps";
  const Mesh mesh = box({1.0, 1.0, 4.0}, {2, 2, 8});
  const auto step = [&](const Materials& materials) {
    Case description = plain_case(NeoHookean{});
    description.displacements = {{"foot", {}}};
    Scene scene = make_scene(description, mesh, {{"foot", {0}}});
    scene.materials = materials;
    return stable_step(Model(scene, choice()), NodalField(mesh.points.size())).step;
  };
  const Material light{sample_law<NeoHookean>(0.45, 9000.0), 400.0}, heavy{sample_law<Yeoh>(0.45), 3000.0};
  Materials both{{light, heavy}};
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) both.of_element.push_back(e % 3 == 0 ? 0 : 1);
  EXPECT_LT(step({{light}}), 0.5 * step({{heavy}}));
  EXPECT_NEAR(step(both), step({{light}}), 1e-12 * step({{light}}));
}

const std::string two_materials = replaced(box_case("two", "[1.0, 1.0, 4.0]", "[1, 1, 4]"), R"([material]
law = "neo-hookean"
young_modulus = 3000.0
poisson_ratio = 0.49
density = 1000.0
)",
                                           R"([[materials]]
elements = "foot"
law = "neo-hookean"
young_modulus = 6000.0
poisson_ratio = 0.3
density = 2000.0

[[materials]]
law = "yeoh"
c1 = 500.0
c2 = 10.0
c3 = 1.0
bulk_modulus = 50000.0
density = 1000.0

[element_sets]
foot = { z = [0.0, 2.0] }

[sets]
bottom = { z = [0.0, 0.0] }

[[displacement]]
set = "bottom"
value = [0.0, 0.0, 0.0]
)");

TEST(Materials, a_case_file_gives_each_element_its_own) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("two.toml", two_materials));
  EXPECT_EQ(scene.materials.of_element, (std::vector<std::uint16_t>{0, 0, 1, 1}));
  EXPECT_EQ(scene.materials.list[1].density, 1000.0);
  const Model model(scene, {"tl-perturbation"});
  EXPECT_DOUBLE_EQ(model.element_masses()[1], 2000.0);
  EXPECT_DOUBLE_EQ(model.element_masses()[2], 1000.0);
  const auto file = folder / "two.h5";
  // A mesh file holds the set, so that a case that reads it needs no rule.
  write_mesh_file(scene, file);
  const MeshWithSets read = read_mesh_file(file);
  EXPECT_EQ(read.element_sets.at("foot"), (std::vector<int>{0, 1}));
  const std::string text =
      replaced(replaced(two_materials, "foot = { z = [0.0, 2.0] }", ""),
               "generator = \"box\"\nsize = [1.0, 1.0, 4.0]\nelements = [1, 1, 4]", "file = \"two.h5\"");
  EXPECT_EQ(read_scene(folder.write("again.toml", text)).materials.of_element, scene.materials.of_element);
}

TEST(Materials, another_material_is_another_answer) {
  const TemporaryFolder folder;
  const auto hash_with = [&](const std::string& from, const std::string& to) {
    return read_scene(folder.write("two.toml", replaced(two_materials, from, to))).case_hash;
  };
  const std::string hash = hash_with("c1 = 500.0", "c1 = 500.0");
  EXPECT_NE(hash_with("c1 = 500.0", "c1 = 501.0"), hash);
  EXPECT_NE(hash_with("young_modulus = 6000.0", "young_modulus = 6001.0"), hash);
  EXPECT_NE(hash_with("[0.0, 2.0]", "[0.0, 3.0]"), hash);
}

/// Of any material, first or last: lambda / mu = 2 nu / (1 - 2 nu).
TEST(Materials, the_least_compressible_counts) {
  const Material stiff{sample_law<NeoHookean>(0.45, 30000.0), 1000.0};
  const Material soft{sample_law<NeoHookean>(0.25, 30000.0), 1000.0};
  EXPECT_NEAR(largest_lambda_over_mu({{stiff}}), 9.0, 1e-12);
  EXPECT_NEAR(largest_lambda_over_mu({{stiff, soft}}), 9.0, 1e-12);
  EXPECT_NEAR(largest_lambda_over_mu({{soft, stiff}}), 9.0, 1e-12);
}

TEST(Materials, wrong_input_is_refused) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& from, const std::string& to) {
    const auto path = folder.write("two.toml", replaced(two_materials, from, to));
    return input_error([&] { read_scene(path); });
  };
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(said("elements = \"foot\"", "elements = \"food\""), "did you mean 'foot'?");
  expect(said("elements = \"foot\"", ""), "lack `elements` 2 times");
  expect(said("law = \"yeoh\"", "elements = \"foot\"\nlaw = \"yeoh\""),
         "element 0 is in 'foot' and in 'foot'");
  expect(said("law = \"yeoh\"", "elements = \"head\"\nlaw = \"yeoh\""), "'head' is not an element set");
  expect(said("foot = { z = [0.0, 2.0] }", "foot = { z = [5.0, 6.0] }"), "has no element in the mesh");
  expect(said("foot = {", "foot = { surface = true,"), "surface");
  expect(said("[element_sets]", "[material]\nlaw = \"neo-hookean\"\n\n[element_sets]"), "one or the other");
  expect(
      said("foot = { z = [0.0, 2.0] }", "foot = { z = [0.0, 2.0] }\nhead = { z = [2.0, 3.0] }\n\n[case2]\n"),
      "case2");
  const std::string uncovered =
      replaced(two_materials, "law = \"yeoh\"", "elements = \"head\"\nlaw = \"yeoh\"");
  const auto path =
      folder.write("two.toml", replaced(uncovered, "foot = {", "head = { z = [2.0, 3.0] }\nfoot = {"));
  expect(input_error([&] { read_scene(path); }), "1 of the 4 elements have none, the first is element 3");
}

}  // namespace
}  // namespace sandglass::verification::materials_test
