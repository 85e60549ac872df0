#include "sandglass/batch.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "assembly/batch_force.hpp"
#include "base/parallel.hpp"
#include "io/case_file.hpp"
#include "sandglass/driven_problem.hpp"
#include "solve/health.hpp"
#include "solve/leapfrog.hpp"
#include "solve/stable_step.hpp"
#include "solve/steady_step.hpp"

namespace sandglass {

namespace {

/// Throws InputError if a batch does not support the case, or the processor.
void require_supported(const Scene& scene, const Processor* processor) {
  const auto refuse_if = [&](bool condition, std::string_view rule) {
    const std::string file = scene.settings.file.string();
    if (condition) throw InputError(fmt::format("{}: {}, or simulate one body at a time", file, rule));
  };
  refuse_if(processor != nullptr, "a batch runs on this processor alone; choose device = 'cpu'");
  const bool remembers = std::ranges::any_of(scene.materials.list, is_viscoelastic, &Material::law);
  refuse_if(remembers || !scene.materials.axes.empty(), "a batch takes isotropic elastic laws; choose one");
  if (const BodyForce* other = first_not_dead(scene.forces))
    refuse_if(true, fmt::format("a batch takes dead loads only; remove [[{}]]", other->traits().name));
  refuse_if(!scene.ties.empty(), "a batch takes no ties; choose a mesh without them");
  refuse_if(scene.settings.dynamics.subcycles > 1 || scene.settings.dynamics.body_frequency > 0,
            "a batch takes the step of its stiffest element; set subcycles = 1 and body_frequency = 0");
}

/// The function that makes the elements of a pack of bodies. Throws InputError, which lists the methods that
/// have such kernels, if this one has none.
template <class Number>
AssembleBatch<Number>* batch_force_of(const Model& model) {
  const auto kernel = [](const MethodEntry& method) {
    if constexpr (std::is_same_v<Number, Pack<double>>)
      return method.packed_double.assemble_batch;
    else
      return method.packed_float.assemble_batch;
  };
  const MethodChoice& choice = model.choice();
  require_supported(model.scene(), choice.processor.get());
  if (const auto assemble = kernel(method_named(choice.method))) return assemble;
  std::vector<std::string_view> known;
  for (const MethodEntry& method : methods())
    if (kernel(method) != nullptr) known.push_back(method.name);
  throw InputError(fmt::format("method = '{}' does not run in a batch; choose one of {}", choice.method,
                               fmt::join(known, ", ")));
}

}  // namespace

/// Values of nodes are three numbers for each row of the layout; body b is in lane b % lanes of pack b /
/// lanes.
template <class Real>
class Batch<Real>::Parts {
  using Number = Pack<Real>;
  using Numbers = std::vector<Number>;
  static constexpr std::size_t lanes = Number::width;

 public:
  Parts(Scene scene, std::size_t bodies, const SimulationSettings& settings)
      : problem_(std::move(scene), settings, precision_of<Real>),
        assemble_(batch_force_of<Number>(problem_.model())),
        elements_(assembled({&this->scene().materials, 1})),
        clock_{.damping = problem_.damping()},
        longest_step_(problem_.damping()),
        frequency_squares_(bodies) {
    if (bodies == 0) throw InputError("bodies = 0 must be at least 1");
    const Number zero(Real(0));
    const Numbers of_rows(3 * elements_->layout().rows(), zero), of_constraints(constraints().size(), zero);
    packs_.assign((bodies + lanes - 1) / lanes, {elements_, of_rows, of_rows, of_rows, of_constraints,
                                                 of_constraints, zero, zero, Number(Real(1))});
    inverse_masses_.resize(of_rows.size());
    const NodalField& v = this->scene().initial_velocities;
    for (std::size_t n = 0; n < elements_->layout().nodes; ++n) {
      for (std::size_t i = 0; i < 3; ++i) {
        inverse_masses_[at(n, i)] = static_cast<Real>(1.0 / problem_.model().masses()[n]);
        if (v.empty()) continue;
        for (auto& pack : packs_) pack.increment[at(n, i)] = Number(v[n][i]);
      }
    }
    for (const Constraint& c : constraints()) {
      constrained_.push_back(at(static_cast<std::size_t>(c.node), static_cast<std::size_t>(c.component)));
      inverse_masses_[constrained_.back()] = Real(0);
      for (auto& pack : packs_) pack.increment[constrained_.back()] = zero;
    }
    check();
    const Step start = step_at(1.0, {});
    for (auto& pack : packs_) evaluate_forces(pack, start);
  }

  const DrivenProblem& problem() const { return problem_; }
  std::size_t size() const { return frequency_squares_.size(); }
  double time() const { return clock_.time; }
  double step_size() const { return problem_.longest_step(longest_step_.step()); }

  void scale_stiffness(std::size_t body, double factor) {
    require_in_range("factor", factor, Range::positive());
    set_lane(side(body).stiffness, body, factor);
    evaluate_forces(side(body), step_at(0.0, {}));
    choose_step();
  }

  void set_parameters(std::span<const std::map<std::string, std::vector<double>>> of_materials) {
    std::vector<Materials> own = materials_;
    own.resize(packs_.size() * lanes, scene().materials);
    const std::size_t given = of_materials.size(), known = scene().materials.list.size();
    if (given != known)
      throw InputError(
          fmt::format("materials: {} were given; it must be one for each of the {}", given, known));
    for (std::size_t m = 0; m < known; ++m) {
      for (const auto& [name, values] : of_materials[m])
        if (values.size() != size())
          throw InputError(
              fmt::format("material {}: {} has {} values; it must be one for each of the {} bodies", m, name,
                          values.size(), size()));
      for (std::size_t b = 0; b < size(); ++b) {
        std::map<std::string, double> of_body;
        for (const auto& [name, values] : of_materials[m]) of_body[name] = values[b];
        AnyLaw& law = own[b].list[m].law;
        law = with_parameters(law, of_body, fmt::format("material {}, body {}", m, b));
      }
    }
    materials_ = std::move(own);
    for (std::size_t p = 0; p < packs_.size(); ++p) {
      packs_[p].elements = assembled(std::span(materials_).subspan(p * lanes, lanes));
      evaluate_forces(packs_[p], step_at(0.0, {}));
    }
    undeformed_step_ = 0.0;
    check();
  }

  /// displacement(n): of the n-th node of the set, m.
  template <class Displacement>
  void move(std::size_t body, const std::string& set, const Displacement& displacement) {
    problem_.move(set, displacement, [&](std::size_t k, double u) { set_lane(side(body).to[k], body, u); });
  }

  void impose(std::size_t body, double factor) {
    problem_.impose(factor, [&](std::size_t k, double u) { set_lane(side(body).to[k], body, u); });
    set_lane(side(body).factor_to, body, factor);
  }

  void advance(double seconds) {
    require_in_range("seconds", seconds, Range::positive());
    const long interval = scene().settings.dynamics.check_interval;
    double left = seconds;
    while (left > 0.0) {
      std::vector<Step> steps;
      do {
        const double count = steps_in(left, step_size());
        const double step = left / count;
        left = count > 1.0 ? left - step : 0.0;
        const auto coefficients = clock_.advance(step);
        steps.push_back(step_at(1.0 - left / seconds, coefficients));
      } while (left > 0.0 && clock_.step % interval != 0);
      in_parallel(packs_.size(), problem_.model().choice().threads, [&](std::size_t p) {
        for (const Step& step : steps) take(packs_[p], step);
      });
      if (clock_.step % interval == 0) check();
    }
    for (auto& pack : packs_) {
      pack.from = pack.to;
      pack.factor_from = pack.factor_to;
    }
  }

  /// The displacement (m) of a body at a component of a node.
  double displacement(std::size_t body, std::size_t node, std::size_t component) {
    return lane(side(body).u[at(node, component)], body);
  }

  /// The force (N) that drives a component.
  double reaction(std::size_t body, std::size_t constraint) {
    return lane(side(body).force[constrained_[constraint]] * side(body).stiffness, body);
  }

 private:
  /// The bodies of one pack.
  struct Side {
    std::shared_ptr<const BatchForce<Number>> elements;
    Numbers u;           // m
    Numbers increment;   // m, in the last step
    Numbers force;       // internal forces minus loads, N, over the stiffness
    Numbers from, to;    // m, of each constraint, at the start and the end of a frame
    Number factor_from;  // of loads
    Number factor_to;
    Number stiffness;  // over the case's
  };

  /// A step of all bodies.
  struct Step {
    double share;  // of the way from `from` to `to`
    LeapfrogClock::Coefficients coefficients;
    std::vector<std::array<double, 2>> curves;  // factors of loads at a load factor f: [0] + [1] f
  };

  const Scene& scene() const { return problem_.scene(); }
  const std::vector<Constraint>& constraints() const { return problem_.scene().constraints; }

  /// The elements of as many bodies as there are materials, or of a pack with the same.
  std::shared_ptr<const BatchForce<Number>> assembled(std::span<const Materials> bodies) const {
    const MethodChoice& choice = problem_.model().choice();
    return assemble_(scene().mesh, bodies, {.kappa = choice.kappa, .kappa_modulus = choice.kappa_modulus});
  }

  std::size_t at(std::size_t node, std::size_t component) const {
    return 3 * static_cast<std::size_t>(elements_->layout().row_of_node[node]) + component;
  }

  static double lane(const Number& number, std::size_t body) {
    return static_cast<double>(Lanes<Number>::get(number, static_cast<int>(body % lanes)));
  }

  static void set_lane(Number& number, std::size_t body, double value) {
    Lanes<Number>::set(number, static_cast<int>(body % lanes), static_cast<Real>(value));
  }

  /// The pack of a body. Throws InputError if there is no such body.
  Side& side(std::size_t body) {
    if (body >= size()) throw InputError(fmt::format("body = {} must be below {}", body, size()));
    return packs_[body / lanes];
  }

  Step step_at(double share, LeapfrogClock::Coefficients coefficients) const {
    Step step{share, coefficients, {}};
    for (const LoadCurve& curve : scene().curves) {
      const double none = curve.at(clock_.time, 0.0);
      step.curves.push_back({none, curve.at(clock_.time, 1.0) - none});
    }
    return step;
  }

  void take(Side& pack, const Step& step) const {
    const Number keep(step.coefficients.keep), gain = Number(-step.coefficients.gain) * pack.stiffness;
    for (std::size_t n = 0; n < pack.u.size(); ++n) {
      pack.increment[n] = keep * pack.increment[n] + gain * Number(inverse_masses_[n]) * pack.force[n];
      pack.u[n] = pack.u[n] + pack.increment[n];
    }
    const Number share(step.share), rest(1.0 - step.share);
    for (std::size_t k = 0; k < constrained_.size(); ++k)
      pack.u[constrained_[k]] = share * pack.to[k] + rest * pack.from[k];
    evaluate_forces(pack, step);
  }

  void evaluate_forces(Side& pack, const Step& step) const {
    pack.elements->evaluate(pack.u, pack.force);
    const Number factor = Number(step.share) * pack.factor_to + Number(1.0 - step.share) * pack.factor_from;
    for (const auto& dead : scene().forces) {
      for (const NodalLoad& load : dead->dead_loads()) {
        const auto& [constant, slope] = step.curves[load.curve];
        const Number share = (Number(constant) + Number(slope) * factor) / pack.stiffness;
        for (std::size_t i = 0; i < 3; ++i) {
          Number& force = pack.force[at(static_cast<std::size_t>(load.node), i)];
          force = force - share * Number(load.force[i]);
        }
      }
    }
  }

  void check() {
    std::vector<typename BatchForce<Number>::Extremes> extremes(packs_.size());
    in_parallel(packs_.size(), problem_.model().choice().threads,
                [&](std::size_t p) { extremes[p] = packs_[p].elements->extremes(packs_[p].u); });
    for (std::size_t b = 0; b < size(); ++b) {
      const double jacobian = lane(extremes[b / lanes].jacobian, b);
      if (!is_healthy(jacobian)) {
        throw ComputationError(fmt::format(
            "body {}, step {}: an element is inverted or not finite (det F = {:.3g}); move it less far or "
            "more slowly, or take smaller steps (step_fraction)",
            b, clock_.step, jacobian));
      }
      frequency_squares_[b] = lane(extremes[b / lanes].frequency_square, b);
    }
    const auto fastest = std::max_element(frequency_squares_.begin(), frequency_squares_.end());
    const StableStep shortest{stable_step_of(problem_.model(), *fastest),
                              static_cast<int>(fastest - frequency_squares_.begin())};
    if (undeformed_step_ == 0.0) undeformed_step_ = shortest.step;
    require_worthwhile(damped(shortest, problem_.damping()), undeformed_step_, time(), clock_.step, "body");
    choose_step();
  }

  void choose_step() {
    double square = 0.0;
    for (std::size_t b = 0; b < size(); ++b) {
      square = std::max(square, frequency_squares_[b] * lane(packs_[b / lanes].stiffness, b));
    }
    const StableStep stable = damped({stable_step_of(problem_.model(), square), 0}, problem_.damping());
    longest_step_.next(problem_.step_fraction() * stable.step, time());
  }

  const DrivenProblem problem_;
  AssembleBatch<Number>* const assemble_;
  std::shared_ptr<const BatchForce<Number>> elements_;  // of bodies with the materials of the case
  std::vector<Materials> materials_;                    // of each body and empty lane, if they differ
  LeapfrogClock clock_;
  SteadyStep longest_step_;
  double undeformed_step_ = 0.0;           // s, of a body with the stiffness of the case
  std::vector<double> frequency_squares_;  // 1/s^2, of each body at the last check and factor one
  std::vector<Side> packs_;
  std::vector<Real> inverse_masses_;      // 1/kg, of each component; zero on constrained ones
  std::vector<std::size_t> constrained_;  // components, in the order of the scene's constraints
};

template <class Real>
Batch<Real>::Batch(const std::filesystem::path& case_file, std::size_t bodies,
                   const SimulationSettings& settings)
    : parts_(std::make_unique<Parts>(read_scene(case_file), bodies, settings)) {}

template <class Real>
Batch<Real>::Batch(MeshArrays mesh, const std::string& case_text, std::size_t bodies,
                   const SimulationSettings& settings)
    : parts_(std::make_unique<Parts>(read_scene(case_text, checked(std::move(mesh))), bodies, settings)) {}

template <class Real>
Batch<Real>::~Batch() = default;

template <class Real>
void Batch<Real>::scale_stiffness(std::size_t body, double factor) {
  parts_->scale_stiffness(body, factor);
}

template <class Real>
void Batch<Real>::set_parameters(std::span<const std::map<std::string, std::vector<double>>> of_materials) {
  parts_->set_parameters(of_materials);
}

template <class Real>
void Batch<Real>::move(std::size_t body, const std::string& set, const std::array<double, 3>& displacement) {
  parts_->move(body, set, [&](std::size_t /*node*/) { return displacement; });
}

template <class Real>
void Batch<Real>::move(std::size_t body, const std::string& set,
                       std::span<const std::array<double, 3>> displacements) {
  parts_->problem().require_one_for_each_node(set, displacements.size());
  parts_->move(body, set, [&](std::size_t node) { return displacements[node]; });
}

template <class Real>
void Batch<Real>::impose(std::size_t body, double factor) {
  parts_->impose(body, factor);
}

template <class Real>
void Batch<Real>::advance(double seconds) {
  parts_->advance(seconds);
}

template <class Real>
double Batch<Real>::time() const {
  return parts_->time();
}

template <class Real>
double Batch<Real>::step_size() const {
  return parts_->step_size();
}

template <class Real>
std::array<double, 3> Batch<Real>::displacement(std::size_t body, std::size_t node) const {
  if (node >= nodes()) throw InputError(fmt::format("node = {} must be below {}", node, nodes()));
  std::array<double, 3> u{};
  for (std::size_t i = 0; i < 3; ++i) u[i] = parts_->displacement(body, node, i);
  return u;
}

template <class Real>
std::array<double, 3> Batch<Real>::reaction(std::size_t body, const std::string& set) const {
  std::array<double, 3> sum{};
  for (const auto& [constraint, node, component] : parts_->problem().driven(set)) {
    sum[component] += parts_->reaction(body, constraint);
  }
  return sum;
}

template <class Real>
std::size_t Batch<Real>::bodies() const {
  return parts_->size();
}

template <class Real>
std::size_t Batch<Real>::nodes() const {
  return parts_->problem().scene().mesh.points.size();
}

template <class Real>
std::span<const int> Batch<Real>::nodes(const std::string& set) const {
  return parts_->problem().nodes(set);
}

template class Batch<double>;
template class Batch<float>;

}  // namespace sandglass
