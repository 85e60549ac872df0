// Derivatives by the undeformed shape: of the power of every force of the list, and of the displacements of
// rotated sets, against differences of scenes on moved meshes.
#include "problem/shape_slopes.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "forces/contact_force.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification::shape_slopes_test {
namespace {

constexpr double factor = 0.7;  // of all load curves

/// Unit box of distorted elements of two materials, whose faces are warped, with fields on its nodes.
struct Bodies {
  Mesh mesh = box({1.0, 1.0, 1.0}, {2, 2, 2});
  NodeSets sets;
  ElementSets parts{{"low", {0, 1, 2, 3}}};
  NodalField u, rate, v;

  Bodies() {
    sets["side"] = nodes_where(mesh.points, [](const Vector& X) { return X[0] == 1.0; });
    RandomGeometry random(5);
    const auto field = [&](double size) {
      NodalField values(mesh.points.size());
      for (Vector& value : values) {
        for (double& x : value) x = size * random.uniform(-1.0, 1.0);
      }
      return values;
    };
    const NodalField moves = field(0.05);
    for (std::size_t n = 0; n < moves.size(); ++n) {
      for (std::size_t i = 0; i < 3; ++i) mesh.points[n][i] += moves[n][i];
    }
    u = field(0.1), rate = field(1.0), v = field(1.0);
  }

  Scene scene(const Case& description, const NodalField& points) const {
    Case two = description;
    two.materials.front().elements = "low";
    two.materials.push_back({{sample_law<NeoHookean>(0.3), 2000.0}});
    return make_scene(two, {points, mesh.cells}, sets, parts);
  }

  /// The power (W) of the forces on the body with its nodes at `points`.
  double power(const Case& description, const NodalField& points) const {
    const Scene made = scene(description, points);
    std::vector<int> places(points.size());
    std::iota(places.begin(), places.end(), 0);
    const auto rows = [&](const NodalField& field) {
      Rows<double> all(field.size());
      for (std::size_t n = 0; n < field.size(); ++n)
        for (std::size_t i = 0; i < 3; ++i) all[n][i] = field[n][i];
      return all;
    };
    const Rows<double> displaced = rows(u), moved = rows(rate);
    Rows<double> forces(points.size());
    const std::vector<double> factors(made.curves.size(), factor);
    for (const auto& force : made.forces) {
      force->add_forces(factors, {{displaced.data(), places}, {moved.data(), places}, 1.0},
                        {forces.data(), places});
    }
    double sum = 0.0;
    for (std::size_t n = 0; n < points.size(); ++n)
      for (std::size_t i = 0; i < 3; ++i) sum += forces[n][i] * v[n][i];
    return sum;
  }
};

/// The derivative of a function of the nodes' positions by one of them.
template <class Function>
double difference(const Function& function, NodalField points, std::size_t n, std::size_t i) {
  constexpr double h = 1e-4;  // fourth order: its error is that of rounding, 1e-16 / h
  const double X = points[n][i];
  const auto at = [&](double offset) {
    points[n][i] = X + offset;
    return function(points);
  };
  return (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
}

/// Expects the differences of a function to be these derivatives, of which the largest is not small.
template <class Function>
void expect_derivatives(const Function& function, const NodalField& points, const NodalField& derivatives,
                        const std::string& what) {
  double largest = 0.0;
  for (const Vector& row : derivatives) largest = std::max(largest, length(row));
  EXPECT_GT(largest, 1e-3) << what;
  for (std::size_t n = 0; n < points.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(derivatives[n][i], difference(function, points, n, i), 1e-9 * largest)
          << what << ", node " << n << " along "
          << "xyz"[i];
  }
}

using Add = std::function<void(ForceTables<Forces>&)>;

const DeadForce traction{.set = "side", .total = {3.0, -2.0, 1.0}, .moment = {0.5, 1.0, -2.0}};
const Gravity weight{.value = {1.0, 2.0, -9.81}};

/// Tables of kinds of forces, by the name of the kind.
const std::multimap<std::string_view, Add> samples{
    {"mass",
     [](auto& forces) {
       forces.template of<PointMass>().push_back({"side", 500.0});
       forces.template of<Gravity>().push_back(weight);
     }},
    {"force", [](auto& forces) { forces.template of<DeadForce>().push_back(traction); }},
    {"force",
     [](auto& forces) {  // nodes that share a force have the same share wherever they are
       forces.template of<DeadForce>().push_back(traction);
       forces.template of<DeadForce>().push_back(
           {.set = "side", .total = {1.0, 2.0, 3.0}, .on = DeadForce::Carrier::nodes});
     }},
    {"pressure",
     [](auto& forces) {
       forces.template of<Pressure>().push_back({"side", 10.0});
     }},
    {"support",
     [](auto& forces) {
       forces.template of<Support>().push_back({"side", 20.0, 30.0, false});
     }},
    {"support",
     [](auto& forces) {
       forces.template of<Support>().push_back({"side", 20.0, 30.0, true});
     }},
    {"obstacle",
     [](auto& forces) {
       Obstacle wall;
       wall.label = "wall";
       wall.set = "side";
       wall.shape = Obstacle::Shape::plane;
       wall.point = {2.0, 0.0, 0.0};
       wall.normal = {-1.0, 0.0, 0.0};
       forces.template of<Obstacle>().push_back(wall);
     }},
    {"contact", [](auto& forces) {
       Contact itself;
       itself.label = "itself";
       itself.set = "side";
       forces.template of<Contact>().push_back(itself);
     }}};

/// A kind without a sample above, with numbers for all its parameters.
template <class Kind>
Kind any_of_kind() {
  Kind kind;
  const auto set = [&]<class Value>(const Parameter<Kind, Value>& parameter) {
    Value& value = kind.*parameter.member;
    if constexpr (std::is_same_v<Value, std::string>) value = "side";
    if constexpr (std::is_same_v<Value, double>) value = 10.0;
    if constexpr (std::is_same_v<Value, Vector>) value = {1.0, 2.0, 3.0};
  };
  std::apply([&](const auto&... parameter) { (set(parameter), ...); }, Kind::parameters());
  return kind;
}

TEST(ShapeSlopes, are_the_derivatives_of_every_kind_of_force) {
  const Bodies bodies;
  const Working motion{bodies.u, bodies.rate, bodies.v};
  for_each_type(Forces{}, [&]<class Kind>() {
    const std::string kind(Kind::name);
    std::vector<Add> adds;
    for (auto [sample, last] = samples.equal_range(kind); sample != last; ++sample)
      adds.push_back(sample->second);
    if (adds.empty())
      adds.emplace_back([](auto& forces) { forces.template of<Kind>().push_back(any_of_kind<Kind>()); });
    for (const Add& add : adds) {
      Case description = plain_case(sample_law<NeoHookean>(0.3));
      add(description.forces);
      const Scene scene = bodies.scene(description, bodies.mesh.points);
      const std::vector<double> factors(scene.curves.size(), factor);
      NodalField derivatives(bodies.mesh.points.size());
      if (!contacts_of(scene.forces).empty()) {
        EXPECT_THROW(add_slopes_of_forces(1.0, scene, factors, motion, derivatives), InputError);
        continue;
      }
      add_slopes_of_forces(1.0, scene, factors, motion, derivatives);
      expect_derivatives([&](const NodalField& X) { return bodies.power(description, X); },
                         bodies.mesh.points, derivatives, kind);
    }
  });
}

// About a fixed axis, and about one through the mean of the nodes, with a displacement besides.
TEST(ShapeSlopes, rotated_sets_move_with_their_positions) {
  const Bodies bodies;
  const Vector axis{2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0};
  for (const bool fixed : {true, false}) {
    Case description = plain_case(sample_law<NeoHookean>(0.3));
    description.rotations.push_back({"side", axis, 1.5, std::nullopt, {0.1, 0.2, 0.3}});
    if (fixed) description.rotations.back().center = Vector{0.3, -0.2, 0.1};
    const auto work = [&](const NodalField& X) {
      const Scene scene = bodies.scene(description, X);
      double sum = 0.0;
      for (const Constraint& c : scene.constraints) {
        sum += bodies.v[index(c.node)][index(c.component)] *
               c.path.along(path_terms(scene.angles[c.path.angle], factor));
      }
      return sum;
    };
    NodalField derivatives(bodies.mesh.points.size());
    add_slopes_of_rotations(bodies.scene(description, bodies.mesh.points), factor, bodies.v, derivatives);
    expect_derivatives(work, bodies.mesh.points, derivatives, fixed ? "a fixed axis" : "the mean");
  }
}

}  // namespace
}  // namespace sandglass::verification::shape_slopes_test
