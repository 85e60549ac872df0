#pragma once

#include <string_view>
#include <type_traits>

#include "element/hourglass_none.hpp"
#include "element/hourglass_settings.hpp"
#include "element/one_point.hpp"
#include "material/given_pressure.hpp"
#include "material/memory.hpp"

namespace sandglass {

/// The constants of an element, which do not depend on the law's type.
template <class Kinematics, class Hourglass, class T>
struct ElementConstants {
  [[no_unique_address]] typename Kinematics::template Element<T> body;
  [[no_unique_address]] typename Hourglass::template Element<T> hourglass;
};

/// An element: kinematics (from displacements to strains and from stresses to forces), an hourglass control
/// and a material law. All functions are templated on the number type T: double, a pack, a counting or a dual
/// number. Kinematics and controls implement functions of the same names, which are documented here.
template <class KinematicsType, class Hourglass, class Law>
struct Formulation {
  using Kinematics = KinematicsType;

  template <class T>
  using Element = ElementConstants<Kinematics, Hourglass, T>;

  /// The state of an element in addition to displacements; empty if its force follows from them.
  template <class T>
  struct History {
    [[no_unique_address]] typename Hourglass::template History<T> hourglass;
    [[no_unique_address]] PointMemories<MemoryOf<Law, T>, Kinematics::traits.points> law;
  };

  static constexpr bool remembers = !std::is_empty_v<History<double>>;
  static constexpr bool needs_increment = Kinematics::traits.needs_increment;
  static constexpr bool needs_coordinates = Kinematics::traits.needs_coordinates;

  /// Whether the force needs the dilatation around each node: the assembly then makes two passes over the
  /// elements, the first for their `nodal_volumes`.
  static constexpr bool averages_over_nodes = Kinematics::traits.averages_over_nodes;

  /// The number of passes over the elements in a step.
  static constexpr int passes = averages_over_nodes ? 2 : 1;

  /// Whether the element accepts the reference coordinates X (m) of a hexahedron with a positive measure at
  /// all Gauss points. True unless the kinematics state a condition.
  static bool accepts(const NodalVectors<double>& X) {
    if constexpr (!demand.empty()) return Kinematics::accepts(X);
    return true;
  }

  /// The condition of `accepts` as text.
  static constexpr std::string_view demand = Kinematics::traits.demand;

  /// The constants of an element with reference coordinates X (m), whose law may have its own axes.
  template <class SetupLaw>
  static Element<double> precompute(const NodalVectors<double>& X, const SetupLaw& law,
                                    const HourglassSettings& settings) {
    return {Kinematics::precompute(X), Hourglass::precompute(X, law, settings)};
  }

  /// The same for any number type from the modes x of the reference coordinates (m), for kinematics and
  /// controls with a closed form.
  template <class T>
  static Element<T> constants(const Modes<T>& x, const Law& law, const HourglassSettings& settings) {
    const auto body = Kinematics::geometry(x);
    return {body, Hourglass::template constants<T>(body, law, settings)};
  }

  /// The element's contribution to its nodes in the first of two passes; only u of the motion is set.
  template <class T>
  static NodalVolumes<T> nodal_volumes(const ElementMotion<T>& motion, const Element<T>& element) {
    return Kinematics::nodal_volumes(motion, element.body);
  }

  /// The first half of a step: the deformation on which the force depends. With two halves, a loop can start
  /// the next element before it has finished the current one.
  template <class T>
  using Deformation = typename Kinematics::template Deformation<T>;

  template <class T>
  static Deformation<T> deformation(const ElementMotion<T>& motion, const Element<T>& element) {
    return Kinematics::template deformation<Hourglass>(motion, element.body);
  }

  /// The second half: internal forces (N) in modes, with the law at its step. Advances the history by one
  /// step.
  template <class T, class LawAtStep>
  static Modes<T> force(const Deformation<T>& now, const Element<T>& element, History<T>& history,
                        const LawAtStep& law) {
    return Kinematics::template force<Hourglass>(now, element.body, element.hourglass, history.hourglass,
                                                 recalling(law, history.law));
  }

  /// Strain and hourglass energy (J) of a motion with the history after it.
  template <class T, class LawAtStep>
  static ElementEnergy<T> energy(const ElementMotion<T>& motion, const Element<T>& element,
                                 const History<T>& history, const LawAtStep& law) {
    return Kinematics::template energy<Hourglass>(motion, element.body, element.hourglass, history.hourglass,
                                                  recalling(law, history.law));
  }

  /// The reference volume, m^3.
  template <class T>
  static T volume(const ElementMotion<T>& motion, const Element<T>& element) {
    return Kinematics::volume(motion, element.body);
  }

  /// The smallest det F at the integration points; at a single one the volume ratio.
  template <class T>
  static T smallest_jacobian(const ElementMotion<T>& motion, const Element<T>& element) {
    if constexpr (Kinematics::traits.points > 1) {
      return Kinematics::smallest_jacobian(motion, element.body);
    } else {
      return mean_jacobian(motion, element);
    }
  }

  /// The volume ratio of the element.
  template <class T>
  static T mean_jacobian(const ElementMotion<T>& motion, const Element<T>& element) {
    return T(1) + Kinematics::dilatation(motion, element.body);
  }

  /// The Cauchy stress (Pa) of the material, averaged over the current volume, with the history after the
  /// step and the law at a step of zero length, which does not change memories. For all kinematics it follows
  /// from the forces f_I on nodes at x_I, sum_I f_I (x) x_I = sum_q w_q P_q F_q^T, and the volume from the
  /// forces of a unit pressure. Hourglass controls do not contribute. X: reference coordinates (m).
  template <class T, class LawAtStep>
  static Tensor<T> mean_stress(const ElementMotion<T>& motion, const Modes<T>& X, const Element<T>& element,
                               History<T> history, const LawAtStep& law) {
    constexpr bool small_strain = Kinematics::traits.small_strain;
    const auto now = Kinematics::template deformation<NoHourglassControl>(motion, element.body);
    const auto moment = [&](const auto& point_law) {
      const NoHourglassControl::Element<T> control{};
      NoHistory<T> none;
      const Modes<T> f =
          Kinematics::template force<NoHourglassControl>(now, element.body, control, none, point_law);
      return small_strain ? transpose(f) * X : transpose(f) * (X + motion.u);
    };
    const Tensor<T> weighted = moment(recalling(law, history.law));
    if constexpr (small_strain) {
      return (T(1) / volume(motion, element)) * weighted;
    } else {
      return (T(3) / trace(moment(GivenPressure<T>{T(1)}))) * weighted;
    }
  }

  /// An upper bound of the largest eigenvalue (N/m) of the tangent stiffness, including the hourglass part,
  /// for a step of any length.
  template <class T, class LawAtStep>
  static T stiffness_bound(const ElementMotion<T>& motion, const Element<T>& element,
                           const History<T>& history, const LawAtStep& law) {
    return Kinematics::template stiffness_bound<Hourglass>(motion, element.body, element.hourglass,
                                                           history.hourglass, recalling(law, history.law));
  }
};

}  // namespace sandglass
