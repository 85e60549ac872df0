/// Bodies that are not held: free motions against the null space of a dense stiffness matrix, and the
/// messages about them.

#include "problem/held.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "base/error.hpp"
#include "mesh/node_elements.hpp"
#include "solve/relaxation.hpp"
#include "support/dense_matrix.hpp"
#include "support/random_scene.hpp"

namespace sandglass::verification::held_test {
namespace {

/// Boxes side by side, on top of each other, or joined by an edge or a node; some have meshes that do not
/// match and are partly tied, some are turned and sheared, some split; random components of random nodes are
/// held, and random faces supported.
class RandomBody {
 public:
  explicit RandomBody(std::uint64_t seed) : random_(seed) {
    const int boxes = whole(1, 3);
    for (int b = 0; b < boxes; ++b) add_box(b);
    if (random_.uniform(0.0, 1.0) < 0.5) {
      const Tensor<double> turn = random_.deformation(0.7, 1.4);
      for (Vector& X : mesh_.points) X = linear(turn, X);
    }
    if (tied_.empty() && random_.uniform(0.0, 1.0) < 0.3)
      description_.refinements.push_back(
          {.around = "", .elements = "", .numbers = {whole(0, elements() - 1)}});
    hold();
  }

  Scene scene() const { return make_scene(description_, mesh_, sets_, element_sets_); }

 private:
  int whole(int low, int high) { return low + static_cast<int>(random_.uniform(0.0, high - low + 1.0)); }
  int elements() const { return static_cast<int>(mesh_.cells.size()); }

  /// Adds a box of edge 1 that shares a face, an edge, a node or nothing with the box before it, or stands on
  /// it with another mesh, tied at all nodes of the face or at some of them.
  void add_box(int number) {
    const std::array<std::array<double, 3>, 5> shifts{
        {{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {3, 0, 0}, {0, 0, 1}}};
    const int kind = number == 0 ? 3 : whole(0, 4);
    const int divisions = kind == 4 ? whole(1, 2) : 1;
    for (std::size_t i = 0; i < 3; ++i) corner_[i] += shifts[index(kind)][i];
    Mesh added = box({1, 1, 1}, {divisions, divisions, divisions});
    for (Vector& X : added.points) {
      for (std::size_t i = 0; i < 3; ++i) X[i] += corner_[i];
    }
    std::vector<int> numbers;
    std::vector<int> below;
    for (const Vector& X : added.points) {
      const auto same = nodes_where(mesh_.points, [&](const Vector& Y) { return distance(X, Y) < 1e-9; });
      numbers.push_back(kind < 3 && !same.empty() ? same.front() : static_cast<int>(mesh_.points.size()));
      if (numbers.back() == static_cast<int>(mesh_.points.size())) mesh_.points.push_back(X);
      if (X[2] == corner_[2]) below.push_back(numbers.back());
    }
    const int first = elements();
    for (Hexahedron cell : added.cells) {
      for (int& node : cell) node = numbers[index(node)];
      mesh_.cells.push_back(cell);
    }
    std::vector<int> own(added.cells.size());
    std::iota(own.begin(), own.end(), first);
    const std::string name = "box " + std::to_string(number);
    element_sets_[name] = own;
    if (kind != 4 || whole(0, 3) == 0) return;
    const int kept = whole(1, static_cast<int>(below.size()));  // number of tied nodes
    while (static_cast<int>(below.size()) > kept)
      below.erase(below.begin() + whole(0, static_cast<int>(below.size()) - 1));
    tied_.insert(tied_.end(), below.begin(), below.end());
    sets_["foot " + name] = below;
    description_.ties.push_back({"foot " + name, "box " + std::to_string(number - 1)});
  }

  void hold() {
    const int constraints = whole(0, 6);
    std::set<int> held;
    for (int k = 0; k < constraints; ++k) {
      const int node = whole(0, static_cast<int>(mesh_.points.size()) - 1);
      if (std::ranges::find(tied_, node) != tied_.end() || !held.insert(node).second) continue;
      const std::string name = "node " + std::to_string(k);
      sets_[name] = {node};
      const int one = whole(0, 4);  // three: all of them; four: the same by a rotation
      if (one == 4) {
        description_.rotations.push_back({.set = name, .axis = {0, 0, 1}, .angle = 0.1});
      } else {
        description_.displacements.push_back(
            {name, {}, {one == 0 || one == 3, one == 1 || one == 3, one == 2 || one == 3}});
      }
    }
    const auto boundary = boundary_faces(mesh_.cells);
    const int faces = whole(0, 5) - 3;
    for (int k = 0; k < faces; ++k) {
      const Quadrilateral& face = boundary[index(whole(0, static_cast<int>(boundary.size()) - 1))];
      const std::string name = "face " + std::to_string(k);
      sets_[name] = {face.begin(), face.end()};
      std::ranges::sort(sets_[name]);
      description_.forces.of<Support>().push_back(
          {.set = name, .stiffness = 1e4, .only_normal = whole(0, 2) > 0});
    }
  }

  RandomGeometry random_;
  Case description_ = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.3});
  Mesh mesh_;
  NodeSets sets_;
  ElementSets element_sets_;
  std::vector<int> tied_;
  Vector corner_{};
};

/// The forces (N) of elements and springs at all nodes when a scene is displaced by u (m).
NodalField resistance(const Model& model, const NodalField& u) {
  NodalField sum = internal_forces(model, u);
  std::vector<int> places(u.size());
  std::iota(places.begin(), places.end(), 0);
  sandglass::Rows<double> rows(u.size()), none(u.size()), forces(u.size());
  for (std::size_t n = 0; n < u.size(); ++n) std::ranges::copy(u[n], rows[n].x.begin());
  const std::vector<double> factors(model.scene().curves.size(), 0.0);
  for (const auto& force : model.scene().forces) {
    force->add_forces(factors, {NodalRows(rows.data(), places), NodalRows(none.data(), places), 1.0},
                      AtNodes<Row<double>>(forces.data(), places));
  }
  for (std::size_t n = 0; n < u.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) sum[n][i] -= forces[n][i];
  }
  return sum;
}

double product(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// The stiffness between free components, by central differences: components that are neither imposed nor of
/// tied nodes, which follow others and pass their forces on.
std::vector<double> stiffness(const Model& model,
                              const std::vector<std::pair<std::size_t, std::size_t>>& free) {
  const Scene& scene = model.scene();
  const double h = 1e-3;                             // m
  std::vector<double> K(free.size() * free.size());  // by rows
  for (std::size_t c = 0; c < free.size(); ++c) {
    std::array<NodalField, 2> ends;
    for (const double sign : {-1.0, 1.0}) {
      NodalField u(scene.mesh.points.size());
      u[free[c].first][free[c].second] = sign * h;
      follow(scene.ties, u);
      NodalField forces = resistance(model, u);
      for (const auto& [node, mean_of] : scene.ties) {
        for (const auto& [to, weight] : mean_of) {
          for (std::size_t i = 0; i < 3; ++i) forces[at(to)][i] += weight * forces[at(node)][i];
        }
      }
      ends[sign > 0.0] = forces;
    }
    for (std::size_t r = 0; r < free.size(); ++r) {
      const auto [node, i] = free[r];
      const double half = (ends[1][node][i] - ends[0][node][i]) / (4.0 * h);
      K[r * free.size() + c] += half;
      K[c * free.size() + r] += half;
    }
  }
  return K;
}

std::vector<std::pair<std::size_t, std::size_t>> free_components(const Scene& scene) {
  std::vector<std::pair<std::size_t, std::size_t>> free;
  const NodeElements elements(scene.mesh);
  for (int n = 0; n < static_cast<int>(scene.mesh.points.size()); ++n) {
    if (is_tied(scene.ties, n) || elements.around(n).empty()) continue;
    for (int i = 0; i < 3; ++i) {
      const auto is = [&](const Constraint& c) { return c.node == n && c.component == i; };
      if (std::ranges::none_of(scene.constraints, is)) free.emplace_back(n, i);
    }
  }
  return free;
}

/// The displacements of a motion, in which pieces agree on shared nodes.
NodalField field_of(const Scene& scene, const LooseBody& body, std::size_t motion) {
  NodalField u(scene.mesh.points.size());
  std::vector<bool> known(u.size(), false);
  for (std::size_t p = 0; p < body.pieces.size(); ++p) {
    for (const int e : body.pieces[p].elements) {
      for (const int node : scene.mesh.cells[at(e)]) {
        const Vector d =
            displacement_of(body.motions[motion][p], body.pieces[p], scene.mesh.points[at(node)]);
        if (known[at(node)]) {
          EXPECT_LT(distance(d, u[at(node)]), 1e-4);
        }
        u[at(node)] = d;
        known[at(node)] = true;
      }
    }
  }
  return u;
}

/// The motions found are in the null space of the stiffness, are independent, and are as many as its
/// dimension: so they span it. At small strain forces are linear, so that differences give the stiffness to
/// roundoff: eigenvalues below 1e-12 of the largest are zero. All others are above 1e-10, the square of the
/// share below which a motion counts as free.
TEST(Held, finds_the_null_space_of_the_stiffness) {
  const long bodies = from_environment("SANDGLASS_SCENES", 200), seed = from_environment("SANDGLASS_SEED", 1);
  std::map<long, int> of_dimension;
  int of_several_pieces = 0;
  for (long n = 0; n < bodies; ++n) {
    SCOPED_TRACE(n);
    const Scene scene = RandomBody(static_cast<std::uint64_t>(1000003 * seed + n)).scene();
    const Model model(scene, {"linear"});
    const auto free = free_components(scene);
    const std::vector<double> K = stiffness(model, free);
    long zeros = 0;
    double least = 0.0;
    if (!free.empty()) {
      const std::vector<double> values = symmetric_eigenvalues(K);
      zeros = std::ranges::count_if(values, [&](double value) { return value < 1e-12 * values.back(); });
      const bool all_zero = zeros == std::ssize(values);
      if (!all_zero) least = values[at(static_cast<int>(zeros))] / values.back();
      EXPECT_TRUE(all_zero || least > 1e-10) << least;
    }
    const std::vector<LooseBody> loose = free_motions(scene);
    std::vector<std::vector<double>> fields;
    for (const LooseBody& body : loose) {
      of_several_pieces += body.pieces.size() > 1 ? 1 : 0;
      for (std::size_t m = 0; m < body.motions.size(); ++m) {
        const NodalField u = field_of(scene, body, m);
        std::vector<double> v, forces;
        for (const auto& [node, i] : free) v.push_back(u[node][i]);
        const double length = std::sqrt(product(v, v));
        for (double& component : v) component /= length;
        for (std::size_t r = 0; r < v.size(); ++r)
          forces.push_back(product({K.data() + r * v.size(), v.size()}, v));
        EXPECT_LT(std::sqrt(product(forces, forces)), 1e-7 * std::sqrt(product(K, K)));
        fields.push_back(v);
      }
    }
    EXPECT_EQ(static_cast<long>(fields.size()), zeros) << described_free_motions(scene);
    ++of_dimension[zeros];
    if (fields.empty()) {
      EXPECT_NO_THROW(require_held(scene));
      continue;
    }
    std::vector<double> gram;
    for (const auto& a : fields) {
      for (const auto& b : fields) gram.push_back(product(a, b));
    }
    EXPECT_GT(symmetric_eigenvalues(gram).front(), 1e-3);
    EXPECT_THROW(require_held(scene), InputError);
  }
  if (bodies < 200) return;
  for (const long dimension : {0, 1, 2, 3, 4, 5, 6}) EXPECT_GT(of_dimension[dimension], 2) << dimension;
  EXPECT_GT(of_dimension[0], 20);
  EXPECT_GT(of_several_pieces, 20);
}

/// A box of 1 m made of one element, or a given mesh, with imposed components of nodes.
Scene held_at(const std::vector<std::pair<int, std::array<bool, 3>>>& places,
              Mesh mesh = box({1, 1, 1}, {1, 1, 1})) {
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.3});
  NodeSets sets;
  for (const auto& [node, components] : places) {
    const std::string name = "node " + std::to_string(node);
    sets[name] = {node};
    description.displacements.push_back({name, {}, components});
  }
  return make_scene(description, std::move(mesh), sets);
}

constexpr std::array<bool, 3> xyz{true, true, true}, only_x{true, false, false}, only_z{false, false, true};

TEST(Held, says_what_is_free) {
  const std::string body = "the body against ";
  EXPECT_EQ(described_free_motions(held_at({})), body + "every translation and rotation");
  EXPECT_EQ(described_free_motions(held_at({{0, only_z}, {1, only_z}, {2, only_z}, {3, only_z}})),
            body + "translation along x and y, rotation about z");
  EXPECT_EQ(described_free_motions(held_at({{0, xyz}})),
            body + "rotation about every axis through (0, 0, 0) m");
  EXPECT_EQ(described_free_motions(held_at({{0, xyz}, {1, xyz}})),
            body + "rotation about x through (0.5, 0, 0) m");
  EXPECT_EQ(described_free_motions(held_at({{0, xyz}, {7, xyz}})),
            body + "rotation about (0.577, 0.577, 0.577) through (0.5, 0.5, 0.5) m");
  EXPECT_EQ(described_free_motions(held_at({{0, xyz}, {1, xyz}, {2, only_x}})),
            body + "rotation about x through (0.5, 0, 0) m");
  EXPECT_EQ(described_free_motions(held_at({{0, xyz}, {1, xyz}, {2, only_z}})), "");
}

/// Nodes on a plane or a line, whose coordinates a file rounded to six digits, hold what they should and
/// nothing else: nodes on a line leave the rotation about it free.
TEST(Held, takes_rounded_nodes_on_a_line_for_a_line) {
  Mesh mesh = box({1, 1, 1}, {4, 4, 4});
  RandomGeometry random(3);
  for (Vector& X : mesh.points) {
    for (double& x : X) x += random.uniform(-2.5e-6, 2.5e-6);  // of numbers below one, to six digits
  }
  std::vector<std::pair<int, std::array<bool, 3>>> places;
  for (const int node : nodes_where(mesh.points, [](const Vector& X) { return X[1] < 1e-3 && X[2] < 1e-3; }))
    places.emplace_back(node, xyz);
  ASSERT_EQ(places.size(), 5U);
  const auto loose = free_motions(held_at(places, mesh));
  ASSERT_EQ(loose.size(), 1U);
  EXPECT_EQ(loose[0].motions.size(), 1U);
}

/// Boxes joined by an edge: each is a piece, and the one that is not held turns about the edge.
TEST(Held, finds_hinges) {
  Mesh mesh = box({2, 2, 1}, {2, 2, 1});
  mesh.cells = {mesh.cells[0], mesh.cells[3]};
  std::vector<std::pair<int, std::array<bool, 3>>> places;
  for (const int node : mesh.cells[0]) places.emplace_back(node, xyz);
  EXPECT_EQ(described_free_motions(held_at(places, mesh)),
            "1 of 2 elements around (1.5, 1.5, 0.5) m against rotation about z through (1, 1, 0.5) m");
}

/// A static case is refused with a list of free motions before anything is computed.
TEST(Held, is_required_for_a_static_answer) {
  const Scene scene = held_at({{0, xyz}});
  Recorder recorder;
  try {
    relax(Model(scene, {"tl-mean-dilatation"}), recorder);
    FAIL();
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("rotation about every axis through (0, 0, 0) m"), std::string::npos) << text;
    EXPECT_NE(text.find("[[support]]"), std::string::npos) << text;
  }
  EXPECT_TRUE(recorder.rows.empty());
}

}  // namespace
}  // namespace sandglass::verification::held_test
