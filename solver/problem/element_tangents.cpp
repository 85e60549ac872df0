#include "problem/element_tangents.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "element/methods.hpp"
#include "mesh/edges.hpp"

namespace sandglass {

namespace {

using Slope = Dual<double>;

/// What the elements of a sweep have in common.
struct Sweep {
  const Mesh& mesh;
  const Materials& materials;
  const std::vector<std::size_t>& alike;  // see numbers_of_alike
  const HourglassSettings& settings;
  const NodalField& u;
  const NodalField& motion;
};

/// The constants of an element as dual numbers without slopes.
template <class Kernel>
typename Kernel::template Element<Slope> as_dual(const typename Kernel::template Element<double>& element) {
  constexpr std::size_t numbers = sizeof(element) / sizeof(double);
  const auto constants = std::bit_cast<std::array<double, numbers>>(element);
  std::array<Slope, numbers> dual;
  for (std::size_t n = 0; n < numbers; ++n) dual[n] = constants[n];
  return std::bit_cast<typename Kernel::template Element<Slope>>(dual);
}

/// The elements of a method with laws of one type.
template <class Method, class Law>
class SlopesOf {
  using Kernel = FormulationOf<Method, Law>;

 public:
  static constexpr bool averages_over_nodes = Kernel::averages_over_nodes;

  SlopesOf(const Sweep& sweep, const std::vector<Law>& laws) : sweep_(sweep) {
    for (const Law& law : laws) {
      setups_.push_back(elastic_law(law));
      laws_.push_back(at_step(law, std::numeric_limits<double>::infinity()));
    }
    if constexpr (Kernel::averages_over_nodes) sum_volumes();
  }

  ElementSlopes forces(std::size_t e) const {
    return forces(e, gather(sweep_.mesh.points, sweep_.mesh.cells[e]));
  }

  /// The derivatives (N) of the scalar product of the forces with v by the corners.
  NodalVectors<double> shape_derivative(std::size_t e, const NodalVectors<double>& v) const {
    constexpr double share_of_edge = 1e-4;
    const auto X = gather(sweep_.mesh.points, sweep_.mesh.cells[e]);
    double shortest = INFINITY;
    for (const auto& [a, b] : hexahedron_edges)
      shortest = std::min(shortest, distance(sweep_.mesh.points[at(sweep_.mesh.cells[e][a])],
                                             sweep_.mesh.points[at(sweep_.mesh.cells[e][b])]));
    const double step = share_of_edge * shortest;
    NodalVectors<double> derivative{};
    for (std::size_t n = 0; n < X.entries.size(); ++n) {
      for (const double side : {1.0, -1.0}) {
        auto moved = X;
        moved.entries[n] += side * step;
        const ElementSlopes f = forces(e, moved);
        for (std::size_t k = 0; k < f.entries.size(); ++k)
          derivative.entries[n] += side / (2.0 * step) * f.entries[k].value * v.entries[k];
      }
    }
    return derivative;
  }

 private:
  using LawAtStep = std::decay_t<decltype(at_step(std::declval<Law>(), 0.0))>;

  ElementSlopes forces(std::size_t e, const NodalVectors<double>& X) const {
    auto motion = motion_of(e, X);
    if constexpr (Kernel::averages_over_nodes) {
      const auto& volumes = volumes_[sweep_.alike[sweep_.materials.of(e)]];
      for (std::size_t corner = 0; corner < motion.dilatation.size(); ++corner) {
        const auto& [change, reference] = volumes[at(sweep_.mesh.cells[e][corner])];
        motion.dilatation[corner] = change / reference;
      }
    }
    const auto element = element_of(e, X);
    const auto law = with_axes(laws_[sweep_.materials.of(e)], axes_of(e));
    typename Kernel::template History<Slope> none{};
    return from_modes(Kernel::force(Kernel::deformation(motion, element), element, none, law));
  }

  static CalledLaw elastic_law(const CalledLaw& law) { return law; }

  const MaterialAxes<double>* axes_of(std::size_t e) const {
    return sweep_.materials.axes.empty() ? nullptr : &sweep_.materials.axes[e];
  }

  auto element_of(std::size_t e, const NodalVectors<double>& X) const {
    const CalledLaw& law = setups_[sweep_.materials.of(e)];
    return as_dual<Kernel>(Kernel::precompute(X, law.with_axes(axes_of(e)), sweep_.settings));
  }

  ElementMotion<Slope> motion_of(std::size_t e, const NodalVectors<double>& X) const {
    const Hexahedron& cell = sweep_.mesh.cells[e];
    ElementMotion<Slope> motion{};
    NodalVectors<Slope> u;
    for (int I = 0; I < u.rows; ++I) {
      const std::size_t node = at(cell[at(I)]);
      for (int i = 0; i < 3; ++i) u(I, i) = {sweep_.u[node][at(i)], sweep_.motion[node][at(i)]};
    }
    motion.u = to_modes(u);
    if constexpr (Kernel::needs_coordinates) {
      motion.X = from_double<Slope>(to_modes(X));
    }
    return motion;
  }

  /// For elements that average over nodes: the volumes of each group of like materials around each node.
  void sum_volumes() {
    const std::size_t groups = *std::max_element(sweep_.alike.begin(), sweep_.alike.end()) + 1;
    volumes_.assign(groups, std::vector<std::pair<Slope, Slope>>(sweep_.mesh.points.size()));
    for (std::size_t e = 0; e < sweep_.mesh.cells.size(); ++e) {
      const auto X = gather(sweep_.mesh.points, sweep_.mesh.cells[e]);
      const auto own = Kernel::nodal_volumes(motion_of(e, X), element_of(e, X));
      for (std::size_t corner = 0; corner < own.change.size(); ++corner) {
        auto& [change, reference] =
            volumes_[sweep_.alike[sweep_.materials.of(e)]][at(sweep_.mesh.cells[e][corner])];
        change = change + own.change[corner];
        reference = reference + own.reference[corner];
      }
    }
  }

  const Sweep& sweep_;
  std::vector<CalledLaw> setups_;  // of each material
  std::vector<LawAtStep> laws_;
  std::vector<std::vector<std::pair<Slope, Slope>>> volumes_;  // change and reference, by group and node
};

template <class Law>
std::vector<Law> laws_of(const Materials& materials) {
  return by_material(materials, [](const Material& material) {
    const KernelLaw law = kernel_law(material);
    if constexpr (law_remembers<Law>) {
      if (const auto* viscoelastic = std::get_if<Law>(&law)) return *viscoelastic;
      return Law{elastic_law(law), 0.0, 1.0, 0.0, 1.0};
    } else {
      return elastic_law(law);
    }
  });
}

/// Calls use(slopes, e) for the elements at a level of those that a method has.
template <class Method, class Law, class Use>
void use_level(const Sweep& sweep, std::span<const double> levels, std::size_t level, const Use& use) {
  const SlopesOf<Method, Law> slopes(sweep, laws_of<Law>(sweep.materials));
  for (std::size_t e = 0; e < sweep.mesh.cells.size(); ++e) {
    if (levels.empty() || levels[e] == static_cast<double>(level)) use(slopes, e);
  }
}

template <class Law, class Use, class... Levels>
void use_levels(TypeList<Levels...> /*methods*/, const Sweep& sweep, std::span<const double> levels,
                const Use& use) {
  std::size_t level = 0;
  (use_level<Levels, Law>(sweep, levels, level++, use), ...);
}

/// The same for all elements of a model.
template <class Use>
void for_each_element(const Model& model, const Materials& materials, std::span<const double> levels,
                      const NodalField& u, const NodalField& motion, const Use& use) {
  const MethodChoice& choice = model.choice();
  const HourglassSettings settings{.kappa = choice.kappa, .kappa_modulus = choice.kappa_modulus};
  const std::vector<std::size_t> alike = numbers_of_alike(model.scene().materials);
  const Sweep sweep{model.scene().mesh, materials, alike, settings, u, motion};
  const bool remembers =
      std::ranges::any_of(materials.list, [](const Material& m) { return is_viscoelastic(m.law); });
  with_named_type(Methods{}, choice.method, [&]<class Method>() {
    if constexpr (FormulationOf<Method, CalledLaw>::needs_increment) {
      throw InputError(
          fmt::format("method '{}': its forces depend on the path, so they have no tangent", Method::name));
    } else {
      if constexpr (knows_law<Method, Viscoelastic<CalledLaw>>) {
        if (remembers) return use_levels<Viscoelastic<CalledLaw>>(LevelsOf<Method>{}, sweep, levels, use);
      }
      use_levels<CalledLaw>(LevelsOf<Method>{}, sweep, levels, use);
    }
  });
}

}  // namespace

void for_each_element_slope(const Model& model, const Materials& materials, std::span<const double> levels,
                            const NodalField& u, const NodalField& motion,
                            const std::function<void(std::size_t, const ElementSlopes&)>& visit) {
  for_each_element(model, materials, levels, u, motion,
                   [&](const auto& slopes, std::size_t e) { visit(e, slopes.forces(e)); });
}

void for_each_shape_derivative(const Model& model, std::span<const double> levels, const NodalField& u,
                               const NodalField& v,
                               const std::function<void(std::size_t, const NodalVectors<double>&)>& visit) {
  const Mesh& mesh = model.scene().mesh;
  for_each_element(model, model.scene().materials, levels, u, NodalField(u.size()),
                   [&]<class Slopes>(const Slopes& slopes, std::size_t e) {
                     if constexpr (Slopes::averages_over_nodes) {
                       throw InputError(fmt::format(
                           "derivatives: method '{}' has none by positions, as its elements average "
                           "over nodes; allowed: another method",
                           model.choice().method));
                     } else {
                       visit(e, slopes.shape_derivative(e, gather(v, mesh.cells[e])));
                     }
                   });
}

}  // namespace sandglass
