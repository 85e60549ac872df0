#pragma once

#include <set>

#include "mesh/edges.hpp"
#include "mesh/generators.hpp"
#include "mesh/quality.hpp"
#include "solve/stable_step.hpp"
#include "support/problem.hpp"
#include "support/random_hexahedra.hpp"

namespace sandglass::verification {

/// A different problem for each number: every method in turn; meshes of all generators and of two tied boxes,
/// distorted or not, some of them refined; one to three materials of all laws; imposed displacements,
/// rotations, forces, pressures, weight, springs, dashpots, initial velocities; static or in motion; strains
/// of about 1e-3 to .3. Sets and fibres are lists, so that nothing depends on coordinates.
class RandomProblem {
 public:
  RandomProblem(long seed, long number) : random_(static_cast<std::uint64_t>(9000011 * seed + number)) {
    const auto& all = methods();
    method_ = &all[static_cast<std::size_t>(number) % all.size()];
  }

  Problem make() {
    problem_ = {};
    problem_.choice.method = method_->name;
    if (method_->takes_kappa && likely(0.3)) problem_.choice.kappa = std::pow(10.0, uniform(-3.0, -1.0));
    problem_.description = plain_case(NeoHookean{});
    problem_.description.quasi_static = method_->is_condensed || likely(0.5);
    while (!make_mesh()) problem_.description.ties.clear();
    make_materials();
    make_refinement();
    amplitude_ = std::pow(10.0, uniform(-3.0, -0.5));
    make_loads();
    make_settings();
    return std::move(problem_);
  }

  double uniform(double low, double high) { return random_.uniform(low, high); }
  int whole(int low, int high) { return low + static_cast<int>(uniform(0.0, high - low + 1.0)); }
  bool likely(double probability) { return uniform(0.0, 1.0) < probability; }

 private:
  static constexpr double density = 1000.0;

  template <class Entry>
  const Entry& one_of(const std::vector<Entry>& entries) {
    return entries[index(whole(0, static_cast<int>(entries.size()) - 1))];
  }

  /// A vector of random direction.
  Vector vector(double length = 1.0) {
    const Tensor<double> Q = random_.rotation();
    return {length * Q(0, 0), length * Q(1, 0), length * Q(2, 0)};
  }

  // Meshes.

  template <class Generator>
  Generator generator() {
    Generator made;
    const auto draw = [&](const auto& parameter, auto& value) {
      using Value = std::remove_reference_t<decltype(value)>;
      if constexpr (std::is_same_v<Value, int>) {
        value = whole(1, 4);
      } else {
        value = parameter.unit == "m"     ? uniform(0.04, 0.1)
                : parameter.unit == "deg" ? uniform(20.0, 80.0)
                                          : uniform(-0.5, 0.5);
      }
    };
    const auto set = [&](const auto& parameter) {
      const bool free = std::isinf(parameter.range.low) && likely(0.5);
      if (!parameter.required && !free) return;
      auto& value = made.*(parameter.member);
      if constexpr (std::is_arithmetic_v<std::remove_reference_t<decltype(value)>>) {
        draw(parameter, value);
      } else {
        for (auto& entry : value) draw(parameter, entry);
      }
    };
    std::apply([&](const auto&... parameter) { (set(parameter), ...); }, Generator::parameters());
    return made;
  }

  Mesh generated() {
    std::vector<AnyGenerator> all;
    for_each_type(Generators{}, [&]<class Generator>() { all.emplace_back(generator<Generator>()); });
    return generate_mesh(one_of(all));
  }

  /// A box on another one with different elements, its nodes tied to the face below.
  Mesh tied() {
    const std::array<double, 2> section{uniform(0.04, 0.1), uniform(0.04, 0.1)};
    const double height = uniform(0.03, 0.1);
    Mesh mesh = box({section[0], section[1], height}, {whole(1, 2), whole(1, 2), whole(1, 3)});
    const Mesh above = box({section[0], section[1], height}, {whole(2, 3), whole(2, 3), whole(1, 3)});
    const int nodes = static_cast<int>(mesh.points.size());
    problem_.element_sets["below"].clear();
    for (std::size_t e = 0; e < mesh.cells.size(); ++e)
      problem_.element_sets["below"].push_back(static_cast<int>(e));
    problem_.sets["tied"].clear();
    for (const Vector& X : above.points) {
      if (X[2] == 0.0) problem_.sets["tied"].push_back(static_cast<int>(mesh.points.size()));
      mesh.points.push_back({X[0], X[1], X[2] + height});
    }
    for (Hexahedron cell : above.cells) {
      for (int& node : cell) node += nodes;
      mesh.cells.push_back(cell);
    }
    problem_.description.ties = {{"tied", "below"}};
    return mesh;
  }

  /// Whether no element is nearly inverted, and their number is neither too small nor too large.
  bool is_decent(const Mesh& mesh) {
    for (const Hexahedron& cell : mesh.cells) {
      const NodalVectors<double> X = gather(mesh.points, cell);
      const double volume = mean_gradient(X).volume;
      if (!(volume > 0.0) || !(smallest_measure(X) > 0.03 * volume)) return false;
    }
    return mesh.cells.size() >= 2 && mesh.cells.size() <= 100;
  }

  /// Makes a mesh and its sets: the ends of its longest extent, and some faces of the boundary.
  bool make_mesh() {
    const bool is_tied = likely(0.08);
    Mesh& mesh = problem_.mesh = is_tied ? tied() : generated();
    if (!is_decent(mesh)) return false;
    const auto [low, high] = bounding_box(mesh.points);
    axis_ = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      if (high[i] - low[i] > high[axis_] - low[axis_]) axis_ = i;
    }
    extent_ = high[axis_] - low[axis_];
    thickness_ = std::min({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    const auto boundary = boundary_faces(mesh.cells);
    const auto outer = nodes_of(boundary, mesh.points.size());
    auto& held = problem_.sets["held"] = {};
    auto& moved = problem_.sets["moved"] = {};
    for (std::size_t n = 0; n < mesh.points.size(); ++n) {
      const double share = (mesh.points[n][axis_] - low[axis_]) / extent_;
      if (outer[n] && share < 0.2) held.push_back(static_cast<int>(n));
      if (outer[n] && share > 0.8) moved.push_back(static_cast<int>(n));
    }
    if (held.size() < 4 || moved.size() < 4) return false;
    std::set<int> side;
    const Quadrilateral first = one_of(boundary);
    const bool grows = likely(0.5);
    for (const auto& face : boundary) {
      const bool touches = std::any_of(face.begin(), face.end(), [&](int node) {
        return std::find(first.begin(), first.end(), node) != first.end();
      });
      if (face == first || (grows && touches)) side.insert(face.begin(), face.end());
    }
    problem_.sets["side"].assign(side.begin(), side.end());
    if (!is_tied && likely(0.4)) {
      const double most = 0.15 * shortest_edge(mesh);
      for (Vector& X : mesh.points) {
        for (double& x : X) x += uniform(-most, most);
      }
    }
    return is_decent(mesh);
  }

  // Materials.

  CaseMaterial material() {
    constexpr std::array ratios{0.0, 0.3, 0.45, 0.49, 0.499};
    const double nu = ratios[index(whole(0, 4))], E = 3000.0 * std::pow(10.0, uniform(-0.5, 0.5));
    std::vector<AnyLaw> laws;
    for_each_type(ElasticLaws{}, [&]<class Law>() { laws.emplace_back(sample_law<Law>(nu, E)); });
    if (method_->knows_viscoelasticity && likely(0.25)) {
      laws.clear();
      for_each_type(Laws{}, [&]<class Law>() { laws.emplace_back(sample_law<Law>(nu, E)); });
    }
    CaseMaterial made{{one_of(laws), density * uniform(0.8, 1.25)}};
    if (splits_volume(made.law) && likely(0.2)) {
      std::vector<VolumetricPart> parts;
      for_each_type(VolumetricParts{}, [&]<class Part>() { parts.emplace_back(Part{}); });
      made.volume = one_of(parts);
    }
    if (has_fibres(made.law)) {
      const std::size_t elements = problem_.mesh.cells.size();
      if (likely(0.5)) {
        made.fibres = UniformFibres{vector(), vector()};
      } else {
        ListedFibres listed;
        for (std::size_t e = 0; e < elements; ++e) {
          listed.fibres.push_back(vector());
          listed.sheets.push_back(vector());
        }
        made.fibres = std::move(listed);
      }
    }
    modulus_ = std::max(modulus_, E);
    return made;
  }

  /// One to three materials, in slabs across an axis.
  void make_materials() {
    const int count = likely(0.6) ? 1 : whole(2, 3);
    const std::size_t axis = index(whole(0, 2));
    const auto [low, high] = bounding_box(problem_.mesh.points);
    std::vector<std::vector<int>> parts(index(count));
    for (std::size_t e = 0; e < problem_.mesh.cells.size(); ++e) {
      const double share = (mean_at(problem_.mesh.cells[e], problem_.mesh.points)[axis] - low[axis]) /
                           (high[axis] - low[axis]);
      parts[index(std::min(count - 1, static_cast<int>(share * count)))].push_back(static_cast<int>(e));
    }
    std::erase_if(parts, [](const auto& part) { return part.empty(); });
    auto& materials = problem_.description.materials;
    materials = {material()};
    for (std::size_t k = 1; k < parts.size(); ++k) {
      CaseMaterial next = material();
      if (likely(0.4)) {  // of the same law, so that neighbours share its kernels
        next = materials.front();
        next.density *= 1.5;
      }
      next.elements = "part" + std::to_string(k);
      problem_.element_sets[next.elements] = parts[k];
      materials.push_back(std::move(next));
    }
  }

  void make_refinement() {
    Case& description = problem_.description;
    if (!description.ties.empty() || problem_.mesh.cells.size() > 40 || !likely(0.15)) return;
    if (description.materials.size() > 1) {
      description.refinements = {{.around = {}, .elements = "part1", .numbers = {}}};
    } else {
      description.refinements = {{
          .around = "side",
          .elements = {},
          .numbers = {},
      }};
    }
  }

  // Loads.

  LoadCurve curve() {
    if (likely(0.6)) return {};
    return {.times = {0.0, 1.0}, .factors = {uniform(0.0, 1.0), uniform(0.5, 1.5)}};
  }

  void make_loads() {
    Case& d = problem_.description;
    const bool moves = !d.quasi_static;
    const double speed = std::sqrt(modulus_ / density);
    if (!moves || likely(0.7)) d.displacements.push_back({"held", {}});
    const double drive = uniform(0.0, 1.0);
    if (drive < 0.3) {
      ImposedDisplacement imposed{"moved", vector(amplitude_ * extent_)};
      if (likely(0.25)) {
        for (std::size_t i = 0; i < 3; ++i) imposed.components[i] = i == axis_ || likely(0.5);
        for (std::size_t i = 0; i < 3; ++i) imposed.value[i] *= imposed.components[i] ? 1.0 : 0.0;
      }
      d.displacements.push_back(imposed);
    } else if (drive < 0.45) {
      d.rotations.push_back({.set = "moved",
                             .axis = vector(),
                             .angle = 3.0 * amplitude_,
                             .center = {},
                             .displacement = vector(0.3 * amplitude_ * extent_)});
    }
    const double slender = std::pow(thickness_ / extent_, 2);
    const double force = amplitude_ * slender * modulus_ * thickness_ * thickness_;
    if (likely(0.35)) {
      const bool on_nodes = likely(0.3);
      d.forces.of<DeadForce>().push_back({likely(0.5) ? "side" : "moved", vector(force),
                                          on_nodes ? Vector{} : vector(0.3 * force * thickness_),
                                          on_nodes ? DeadForce::Carrier::nodes : DeadForce::Carrier::faces,
                                          curve()});
    }
    if (likely(0.2))
      d.forces.of<Pressure>().push_back(
          {"side", amplitude_ * slender * modulus_ * uniform(-1.0, 1.0), curve()});
    const bool bare = drive >= 0.45 && d.forces.of<DeadForce>().empty() && d.forces.of<Pressure>().empty();
    if (likely(0.2) || (bare && !moves))
      d.forces.of<Gravity>().push_back(
          {vector(amplitude_ * slender * modulus_ / density / extent_), curve()});
    if (moves && (bare || likely(0.3)))
      d.velocities.push_back(
          {.value = vector(amplitude_ * speed), .spin = vector(amplitude_ * speed / extent_)});
    if (likely(0.15))
      d.forces.of<Support>().push_back({"side", modulus_ / extent_ * uniform(0.1, 1.0),
                                        likely(0.5) ? 0.2 * density * speed : 0.0, likely(0.5)});
  }

  // Settings.

  void make_settings() {
    Case& d = problem_.description;
    d.relaxation.max_steps = 3000;
    double stable = 1e-3;
    try {
      const Scene scene = problem_.scene();
      stable = stable_step(Model(scene, problem_.choice), NodalField(scene.mesh.points.size())).step;
      // A few levels are too few where forces follow the path.
      if (likely(0.15) && !follows_a_path(problem_)) d.relaxation.levels = whole(2, 6);
    } catch (const InputError&) {  // every run will refuse it
    }
    if (d.quasi_static) return;
    problem_.steps = whole(40, 120);
    DynamicsSettings& dynamics = d.dynamics;
    const double step = 0.4 * stable;
    dynamics.duration = step * static_cast<double>(problem_.steps);
    dynamics.check_interval = whole(3, 15);
    dynamics.frames = 3;
    if (likely(0.3)) dynamics.damping = uniform(0.0, 5.0) / dynamics.duration;
    if (likely(0.3)) dynamics.ramp_time = 0.6 * dynamics.duration;
    const double chosen = uniform(0.0, 1.0);
    if (chosen < 0.7) dynamics.time_step = step;
    if (chosen > 0.9) dynamics.subcycles = whole(2, 4);
    if (chosen > 0.8 && chosen < 0.9 && !slackens_somewhere(problem_)) dynamics.body_frequency = 1;
    for_each_curve(d, [&](LoadCurve& curve) {  // made for the share of the load, which is time in statics
      multiply(curve.times, dynamics.duration);
    });
  }

  RandomGeometry random_;
  const MethodEntry* method_;
  Problem problem_;
  double amplitude_ = 0.0, modulus_ = 0.0, extent_ = 0.0, thickness_ = 0.0;
  std::size_t axis_ = 0;
};

}  // namespace sandglass::verification
