#include "problem/element_tangents.hpp"

#include <array>
#include <bit>
#include <limits>

#include "base/error.hpp"
#include "element/methods.hpp"

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
  SlopesOf(const Sweep& sweep, const std::vector<Law>& laws) : sweep_(sweep) {
    for (const Law& law : laws) {
      setups_.push_back(elastic_law(law));
      laws_.push_back(at_step(law, std::numeric_limits<double>::infinity()));
    }
    if constexpr (Kernel::averages_over_nodes) sum_volumes();
  }

  ElementSlopes forces(std::size_t e) const {
    auto motion = motion_of(e);
    if constexpr (Kernel::averages_over_nodes) {
      const auto& volumes = volumes_[sweep_.alike[sweep_.materials.of(e)]];
      for (std::size_t corner = 0; corner < 8; ++corner) {
        const auto& [change, reference] = volumes[at(sweep_.mesh.cells[e][corner])];
        motion.dilatation[corner] = change / reference;
      }
    }
    const auto element = element_of(e);
    const auto law = with_axes(laws_[sweep_.materials.of(e)], axes_of(e));
    typename Kernel::template History<Slope> none{};
    return from_modes(Kernel::force(Kernel::deformation(motion, element), element, none, law));
  }

 private:
  using LawAtStep = std::decay_t<decltype(at_step(std::declval<Law>(), 0.0))>;

  static CalledLaw elastic_law(const CalledLaw& law) { return law; }

  const MaterialAxes<double>* axes_of(std::size_t e) const {
    return sweep_.materials.axes.empty() ? nullptr : &sweep_.materials.axes[e];
  }

  auto element_of(std::size_t e) const {
    const CalledLaw& law = setups_[sweep_.materials.of(e)];
    return as_dual<Kernel>(Kernel::precompute(gather(sweep_.mesh.points, sweep_.mesh.cells[e]),
                                              law.with_axes(axes_of(e)), sweep_.settings));
  }

  ElementMotion<Slope> motion_of(std::size_t e) const {
    const Hexahedron& cell = sweep_.mesh.cells[e];
    ElementMotion<Slope> motion{};
    NodalVectors<Slope> u;
    for (int I = 0; I < 8; ++I) {
      const std::size_t node = at(cell[at(I)]);
      for (int i = 0; i < 3; ++i) u(I, i) = {sweep_.u[node][at(i)], sweep_.motion[node][at(i)]};
    }
    motion.u = to_modes(u);
    if constexpr (Kernel::needs_coordinates) {
      motion.X = from_double<Slope>(to_modes(gather(sweep_.mesh.points, cell)));
    }
    return motion;
  }

  /// For elements that average over nodes: the volumes of each group of like materials around each node.
  void sum_volumes() {
    const std::size_t groups = *std::max_element(sweep_.alike.begin(), sweep_.alike.end()) + 1;
    volumes_.assign(groups, std::vector<std::pair<Slope, Slope>>(sweep_.mesh.points.size()));
    for (std::size_t e = 0; e < sweep_.mesh.cells.size(); ++e) {
      const auto own = Kernel::nodal_volumes(motion_of(e), element_of(e));
      for (std::size_t corner = 0; corner < 8; ++corner) {
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

/// The elements at level `level` of those that a method has.
template <class Method, class Law, class Visit>
void visit_level(const Sweep& sweep, std::span<const double> levels, std::size_t level, const Visit& visit) {
  const SlopesOf<Method, Law> slopes(sweep, laws_of<Law>(sweep.materials));
  for (std::size_t e = 0; e < sweep.mesh.cells.size(); ++e) {
    if (levels.empty() || levels[e] == static_cast<double>(level)) visit(e, slopes.forces(e));
  }
}

template <class Law, class Visit, class... Methods>
void visit_levels(TypeList<Methods...> /*methods*/, const Sweep& sweep, std::span<const double> levels,
                  const Visit& visit) {
  std::size_t level = 0;
  (visit_level<Methods, Law>(sweep, levels, level++, visit), ...);
}

}  // namespace

void for_each_element_slope(const Model& model, const Materials& materials, std::span<const double> levels,
                            const NodalField& u, const NodalField& motion,
                            const std::function<void(std::size_t, const ElementSlopes&)>& visit) {
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
        if (remembers) return visit_levels<Viscoelastic<CalledLaw>>(LevelsOf<Method>{}, sweep, levels, visit);
      }
      visit_levels<CalledLaw>(LevelsOf<Method>{}, sweep, levels, visit);
    }
  });
}

}  // namespace sandglass
