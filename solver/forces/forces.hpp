#pragma once

#include <algorithm>
#include <tuple>

#include "base/type_list.hpp"
#include "forces/contact.hpp"
#include "forces/dead_force.hpp"
#include "forces/gravity.hpp"
#include "forces/obstacle.hpp"
#include "forces/point_mass.hpp"
#include "forces/pressure.hpp"
#include "forces/support.hpp"

namespace sandglass {

/// The list of kinds of forces, in the order in which they are resolved and summed: masses first, because
/// weight reads them. A new one is a header, its source and one entry here. Each holds the plain data of a
/// table [[name]] of a case file, and has: name, summary, and parameters(), whose texts name node sets;
/// only_in_motion, the parameter that has no effect in static cases, if any; by_mass, whether it depends on
/// the density; and resolve(resolver), which adds its BodyForce on a mesh. The optional `one_of` names
/// parameters of which at least one must be given, the optional `numerical` those that change how accurately
/// an answer is computed, but not the exact answer. All loads are proportional to the factor of their curve.
using Forces = TypeList<PointMass, DeadForce, Pressure, Gravity, Support, Obstacle, Contact>;

/// The forces of a case: its tables of each kind, in their order.
template <class List>
class ForceTables;

template <class... Kinds>
class ForceTables<TypeList<Kinds...>> {
 public:
  template <class Kind>
  std::vector<Kind>& of() {
    return std::get<std::vector<Kind>>(tables_);
  }
  template <class Kind>
  const std::vector<Kind>& of() const {
    return std::get<std::vector<Kind>>(tables_);
  }

  /// Calls use(force) for all forces, kind by kind.
  template <class Use>
  void for_each(const Use& use) {
    (std::ranges::for_each(of<Kinds>(), use), ...);
  }
  template <class Use>
  void for_each(const Use& use) const {
    (std::ranges::for_each(of<Kinds>(), use), ...);
  }

 private:
  std::tuple<std::vector<Kinds>...> tables_;
};

}  // namespace sandglass
