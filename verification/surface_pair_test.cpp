/// Deformable bodies that touch each other or themselves: momentum, friction, energies, the same bits after a
/// checkpoint and for any number of threads.

#include <gtest/gtest.h>

#include <numbers>

#include "base/error.hpp"
#include "forces/box_tree.hpp"
#include "mesh/edges.hpp"
#include "solve/central_difference.hpp"
#include "solve/leapfrog.hpp"
#include "support/allocations.hpp"
#include "support/kept_run.hpp"
#include "support/momentum.hpp"
#include "support/two_bodies.hpp"

namespace sandglass::verification::surface_pair_test {
namespace {

/// A box falls obliquely, turning, onto the corner region of another; neither is held.
TwoBodies collision(Contact::Method method, double friction) {
  TwoBodies bodies(box({1.0, 1.0, 1.0}, {4, 4, 4}),
                   moved(box({0.8, 0.8, 0.8}, {3, 3, 3}), {0.33, 0.21, 1.02}),
                   NeoHookean{.young_modulus = 1e4, .poisson_ratio = 0.4});
  bodies.description.forces.of<Contact>() = {pair_of("lower", "upper", method, friction)};
  bodies.description.velocities = {
      {.set = "upper", .value = {-0.25, 0.15, -0.5}, .spin = {0.15, 0.25, 0.35}}};
  bodies.description.dynamics.duration = 1.5;
  bodies.description.dynamics.check_interval = 1;
  return bodies;
}

/// Forces and impulses act on two material points along the line between them, with friction too: momentum
/// and its moment are kept up to the rounding of sums over a thousand steps. Energy is, to the error of
/// steps.
TEST(SurfacePair, keeps_momentum) {
  for (const auto method : both_methods) {
    for (const double friction : {0.0, 0.5}) {
      const Scene scene = collision(method, friction).scene();
      const Model model(scene, {"tl-perturbation"});
      Recorder recorder;
      const Motion motion = integrate(model, recorder);
      const Momentum before(model, recorder.frames.front().u, recorder.frames.front().v),
          after(model, motion.u, motion.v);
      EXPECT_LT(distance(before.linear, after.linear), 1e-12 * length(before.linear));
      EXPECT_LT(distance(before.angular, after.angular), 1e-12 * length(before.angular));
      const double energy = total_energy(recorder.rows.front());
      double largest_force = 0.0;
      for (const HistoryRow& row : recorder.rows) {
        EXPECT_NEAR(total_energy(row), energy, 0.005 * energy);
        largest_force = std::max(largest_force, -row.reactions.at("pair")[2]);
      }
      EXPECT_GT(largest_force, 100.0);
      EXPECT_EQ(recorder.rows.back().friction > 0.07 * energy, friction > 0.0);
    }
  }
}

constexpr double coefficient = 0.3, gravity = 10.0;

/// A slab on a rough deformable floor, under a weight that pulls it sideways by a share of itself.
TwoBodies slab(Contact::Method method, double share, double speed, double duration) {
  TwoBodies bodies(box({3.0, 1.5, 0.2}, {8, 4, 1}), moved(box({1.0, 1.0, 0.2}, {4, 4, 2}), {0.2, 0.25, 0.2}),
                   NeoHookean{.young_modulus = 1e6, .poisson_ratio = 0.3});
  Case& d = bodies.description;
  d.displacements = {{"foot", {}}};
  d.forces.of<Gravity>() = {{{share * gravity, 0.0, -gravity}, {{0.0, 1.0}, {1.0, 1.0}}}};
  d.forces.of<Contact>() = {pair_of("upper", "lower", method, coefficient)};
  if (speed > 0.0) d.velocities = {{.set = "upper", .value = {speed, 0.0, 0.0}}};
  d.dynamics.duration = duration;
  d.dynamics.check_interval = 1;
  return bodies;
}

/// The mean of m u over the mass, of some nodes.
Vector centre_of(const std::vector<int>& nodes, const NodalField& field, const std::vector<double>& masses) {
  Vector centre{};
  double mass = 0.0;
  for (const int node : nodes) {
    mass += masses[at(node)];
    centre = sum(centre, masses[at(node)], field[at(node)]);
  }
  return {centre[0] / mass, centre[1] / mass, centre[2] / mass};
}

/// Friction stops a slab after the way v^2 / (2 mu g) and takes its energy; its force never exceeds the
/// coefficient times the normal force, of each point: of all to 2 %, as faces turn, and in one of a hundred
/// moments to 10 %, when a point at the edge, whose direction is up to 11 degrees from the others, has a
/// tenth of the force. The slab bounces on its elasticity, which a few percent allow for.
TEST(SurfacePair, stops_a_slab_by_friction) {
  for (const auto method : both_methods) {
    const double speed = 2.0, time = speed / (coefficient * gravity), way = 0.5 * speed * time;
    const TwoBodies bodies = slab(method, 0.0, speed, 1.5 * time);
    const Scene scene = bodies.scene();
    const Model model(scene, {"tl-perturbation"});
    Recorder recorder;
    const Motion motion = integrate(model, recorder);
    const double mass = 200.0, energy = 0.5 * mass * speed * speed;
    std::size_t tilted = 0;
    EXPECT_NEAR(centre_of(bodies.sets.at("upper"), motion.u, model.masses())[0], way, 0.03 * way);
    EXPECT_NEAR(recorder.rows.back().friction, energy, 0.05 * energy);
    for (const HistoryRow& row : recorder.rows) {
      EXPECT_TRUE(row.moments.empty());  // a pair has no point about which to have one
      const Vector& force = row.reactions.at("pair");
      const double tangential = std::hypot(force[0], force[1]);
      EXPECT_LE(tangential, coefficient * force[2] * 1.1 + 1.0);
      if (tangential > coefficient * force[2] * 1.02 + 1.0) ++tilted;
      EXPECT_LE(total_energy(row) - row.external_work, 1.01 * total_energy(recorder.rows.front()));
    }
    EXPECT_LE(100 * tilted, recorder.rows.size());
  }
}

/// Friction that ends while the slab has half of its speed leaves it that.
TEST(SurfacePair, rubs_as_long_as_its_curve_says) {
  for (const auto method : both_methods) {
    const double speed = 2.0, time = speed / (coefficient * gravity);
    TwoBodies bodies = slab(method, 0.0, speed, time);
    bodies.description.forces.of<Contact>().front().curve = {{0.5 * time, 0.5 * time + 1e-6}, {1.0, 0.0}};
    const Scene scene = bodies.scene();
    const Model model(scene, {"tl-perturbation"});
    Recorder recorder;
    const Motion motion = integrate(model, recorder);
    const double left = centre_of(bodies.sets.at("upper"), motion.v, model.masses())[0];
    EXPECT_NEAR(left, 0.5 * speed, 0.03 * speed);
    const double rubbed = coefficient * 200.0 * gravity;  // a deformed interface is not quite level
    EXPECT_NEAR(recorder.rows.back().reactions.at("pair")[0], 0.0, 0.01 * rubbed);
  }
}

/// Below the coefficient of friction the slab sticks: once vibrations are damped it does not creep. By the
/// kinematic method it creeps by a hundredth of a percent of its length in two seconds, as points share its
/// weight differently in every step, by up to 1 % of it in sum.
TEST(SurfacePair, holds_a_slab_by_friction) {
  for (const auto method : both_methods) {
    TwoBodies bodies = slab(method, 0.8 * coefficient, 0.0, 4.0);
    bodies.description.dynamics.damping = 40.0;
    bodies.description.dynamics.frames = 4;
    const Scene scene = bodies.scene();
    Recorder recorder;
    integrate(Model(scene, {"tl-perturbation"}), recorder);
    const NodalField &middle = recorder.frames[2].u, &end = recorder.frames[4].u;
    const bool exact = method == Contact::Method::penalty;
    for (std::size_t n = 0; n < end.size(); ++n)
      EXPECT_LT(distance(middle[n], end[n]), exact ? 1e-10 : 2e-4) << n;
    const double weight = 200.0 * gravity, tolerance = exact ? 1e-3 : 0.01 * weight;
    const Vector force = recorder.rows.back().reactions.at("pair");
    EXPECT_NEAR(force[2], weight, tolerance);
    EXPECT_NEAR(force[0], -0.8 * coefficient * weight, tolerance);
  }
}

/// A strip that is bent by half a turn, so that its legs face each other across a gap.
struct BentStrip {
  static constexpr double length = 1.0, thickness = 0.2, gap = 0.1;
  Column column{{1.0, 1.0, 1.0}, {1, 1, 1}, NeoHookean{.young_modulus = 1e4, .poisson_ratio = 0.45}};

  BentStrip(Contact::Method method, double friction) {
    constexpr double R = 0.5 * (thickness + gap), bend = std::numbers::pi * R, way = 2.0 * length + bend;
    Mesh& mesh = column.mesh;
    mesh = lattice({25, 2, 3}, [&](const Vector& s) {
      const double along = way * s[0], r = R + thickness * (s[1] - 0.5), y = 0.3 * s[2];
      if (along < length) return Vector{along, y, -r};
      if (along > length + bend) return Vector{way - along, y, r};
      const double angle = (along - length) / R;
      return Vector{length + r * std::sin(angle), y, -r * std::cos(angle)};
    });
    const auto on_boundary = boundary_nodes(mesh);
    auto& sets = column.sets;
    sets = {{"skin", {}},
            {"foot", plane(mesh.points, 2, -0.5 * gap - thickness)},
            {"top", plane(mesh.points, 2, 0.5 * gap + thickness)},
            {"low",
             nodes_where(mesh.points,
                         [](const Vector& X) { return std::abs(X[2] + 0.5 * gap) < 1e-9 && X[0] < length; })},
            {"high", nodes_where(mesh.points, [](const Vector& X) {
               return std::abs(X[2] - 0.5 * gap) < 1e-9 && X[0] < length;
             })}};
    for (std::size_t n = 0; n < on_boundary.size(); ++n) {
      if (on_boundary[n]) sets["skin"].push_back(static_cast<int>(n));
    }
    Case& d = column.description;
    d.quasi_static = false;
    d.displacements = {{"foot", {}}, {"top", {0.05, 0.02, -0.16}}};
    d.forces.of<Contact>() = {pair_of("skin", "", method, friction)};
    d.dynamics.duration = 1.0;
    d.dynamics.check_interval = 5;
  }

  /// The smallest height (m) of the upper leg's nodes over those of the lower one that are next to them.
  double narrowest(const NodalField& u) const {
    const auto at_end = [&](int node) { return sum(column.mesh.points[at(node)], 1.0, u[at(node)]); };
    double narrowest = INFINITY;
    for (const int node : column.sets.at("high")) {
      const Vector x = at_end(node);
      double nearest = INFINITY, height = 0.0;
      for (const int below : column.sets.at("low")) {
        const Vector y = at_end(below);
        const double r = std::hypot(x[0] - y[0], x[1] - y[1]);
        if (r > nearest) continue;
        nearest = r;
        height = x[2] - y[2];
      }
      narrowest = std::min(narrowest, height);
    }
    return narrowest;
  }
};

/// The legs are pressed together by 1.6 times the gap. Without contact they intersect by three fifths of the
/// gap. By the penalty it is by as much as they are compressed, by 15 %, over the penalty: 0.15 h, and more
/// at their ends; by the kinematic method by what is left after all sweeps, a hundredth of an edge. Node
/// above node, coarse faces that turn add a tenth. Forces balance each other, and work is in the energy.
TEST(SurfacePair, keeps_a_body_out_of_itself) {
  for (const auto method : both_methods) {
    for (const double friction : {0.0, 0.3}) {
      BentStrip strip(method, friction);
      const Scene scene = strip.column.scene();
      Recorder recorder;
      const Motion motion = integrate(Model(scene, {"tl-perturbation"}), recorder);
      const double edge = shortest_edge(scene.mesh),
                   deepest = (method == Contact::Method::penalty ? 0.4 : 0.01) * edge;
      EXPECT_GT(strip.narrowest(motion.u), -deepest - 0.1 * edge);
      for (const HistoryRow& row : recorder.rows) {
        EXPECT_LT(row.depth, deepest);
        EXPECT_EQ(row.reactions.at("pair"), Vector{});
      }
      EXPECT_LT(energy_imbalance(recorder.rows), 1e-3);
    }
  }
  BentStrip strip(Contact::Method::kinematic, 0.0);
  strip.column.description.forces.of<Contact>().clear();
  const Scene scene = strip.column.scene();
  Recorder silent;
  EXPECT_LT(strip.narrowest(integrate(Model(scene, {"tl-perturbation"}), silent).u), -0.5 * BentStrip::gap);
}

/// A contact that is too soft for what presses is an error that names the place, not a wrong answer.
TEST(SurfacePair, reports_what_passes_through) {
  BentStrip strip(Contact::Method::penalty, 0.0);
  strip.column.description.forces.of<Contact>().front().penalty = 0.01;
  const Scene scene = strip.column.scene();
  Recorder silent;
  try {
    integrate(Model(scene, {"tl-perturbation"}), silent);
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_NE(std::string(error.what()).find("contact 'pair': node"), std::string::npos) << error.what();
  }
}

/// Steps allocate nothing, and have the same bits for any number of threads and after any checkpoint.
TEST(SurfacePair, takes_steps_like_any_force) {
  for (const auto method : both_methods) {
    TwoBodies bodies = collision(method, 0.3);
    bodies.description.dynamics.duration = 0.3;
    bodies.description.dynamics.check_interval = 10;
    const Scene scene = bodies.scene();
    const Model model(scene, {"tl-perturbation"});
    const auto& elements = *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force());
    Leapfrog<double> leapfrog(model, elements, 0.0);
    leapfrog.set_initial_velocities(scene.initial_velocities);
    const auto step = [&] { leapfrog.advance(5e-3, [](Body<double>& body) { body.impose(1.0, 0.0); }); };
    step();
    const long before = allocations();
    for (int k = 0; k < 20; ++k) step();
    EXPECT_EQ(allocations(), before);
    EXPECT_LT(leapfrog.body().touch("pair")->force[2], 0.0);
    const auto moved = [&](int threads) {
      Recorder silent;
      return integrate(Model(scene, {"tl-perturbation", {}, Precision::double_precision, threads}), silent).u;
    };
    EXPECT_EQ(moved(1), moved(2));
    KeepingRecorder whole;
    const NodalField answer = integrate(model, whole).u;
    ASSERT_GT(whole.kept().size(), 2U);
    for (const RunSoFar& kept : whole.kept()) {
      KeepingRecorder resumed(kept);
      EXPECT_EQ(integrate(model, resumed, &kept.point).u, answer);
      EXPECT_EQ(resumed.run().history.back().friction, whole.run().history.back().friction);
    }
  }
}

/// The search of the closest of n^2 faces compares a number of them that does not grow with n.
TEST(BoxTree, compares_few_of_many) {
  for (const int n : {8, 32, 128}) {
    NodalField centres;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) centres.push_back({i + 0.5, j + 0.5, 0.0});
    }
    const BoxTree tree(centres, 1);
    std::vector<Row<double>> boxes(tree.rows());
    tree.fit(boxes.data(), [&](int item, const auto& grow) {
      grow(sum(centres[at(item)], 1.0, {0.5, 0.5, 0.0}));
      grow(sum(centres[at(item)], 1.0, {-0.5, -0.5, 0.0}));
    });
    long compared = 0, found = 0;
    for (const Vector& centre : centres) {
      const Vector x = sum(centre, 1.0, {0.2, -0.1, 0.3});
      double square = 1.0;
      int closest = -1;
      tree.search(x, boxes.data(), square, [&](int item) {
        ++compared;
        const Vector from = difference(x, centres[at(item)]);
        if (dot(from, from) >= square) return;
        square = dot(from, from);
        closest = item;
      });
      if (closest >= 0 && centres[at(closest)] == centre) ++found;
    }
    EXPECT_EQ(found, n * n);
    EXPECT_LE(compared, 3 * n * n);
  }
}

/// Wrong input is refused, and the message names the place.
TEST(SurfacePair, names_what_is_wrong) {
  const NeoHookean law{.young_modulus = 1e4, .poisson_ratio = 0.3};
  constexpr auto kinematic = Contact::Method::kinematic;
  const auto message = [&](double gap, const Contact& contact, std::vector<Refinement> refinements = {},
                           std::vector<NodeTie> ties = {}) {
    TwoBodies bodies(box({1.0, 1.0, 0.5}, {2, 2, 2}),
                     moved(box({1.0, 1.0, 0.5}, {3, 3, 2}), {0.0, 0.0, 0.5 + gap}), law);
    bodies.sets["points"] = {0, 5};
    bodies.description.forces.of<Contact>() = {contact};
    bodies.description.refinements = std::move(refinements);
    bodies.description.element_sets = {
        {"below", false, {std::nullopt, std::nullopt, Interval{0.0, 0.5}}, {}}};
    bodies.description.ties = std::move(ties);
    try {
      bodies.scene();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(0.0, pair_of("under", "over", kinematic)), "");
  const auto expect = [&](double gap, const Contact& contact, const std::string& text) {
    const std::string all = message(gap, contact);
    EXPECT_NE(all.find(text), std::string::npos) << all;
    EXPECT_NE(all.find("llowed"), std::string::npos) << all;
  };
  expect(-0.03, pair_of("lower", "upper", kinematic), "is 0.03 m inside of what it may touch at the start");
  expect(0.0, pair_of("lower", "under", kinematic), "is on both surfaces, 'lower' and 'under'");
  const std::vector<Refinement> corner{{.around = "points", .layers = 1}};  // leaves nodes that hang
  const std::string hanging = message(0.01, pair_of("lower", "upper", kinematic), corner);
  EXPECT_NE(hanging.find("follows others, by a tie or on a refined mesh"), std::string::npos) << hanging;
  EXPECT_EQ(message(0.01, pair_of("lower", "upper", Contact::Method::penalty), corner), "");
  const std::string tied =
      message(0.0, pair_of("under", "over", Contact::Method::penalty), {}, {{"over", "below"}});
  EXPECT_NE(tied.find("follow the other surface by a [[tie]]"), std::string::npos) << tied;
  EXPECT_NE(message(0.0, pair_of("under", "points", kinematic))
                .find("contact.other = 'points' has no boundary face"),
            std::string::npos);
  EXPECT_NE(message(0.0, pair_of("under", "nowhere", kinematic)).find("contact.other = 'nowhere'"),
            std::string::npos);
}

}  // namespace
}  // namespace sandglass::verification::surface_pair_test
