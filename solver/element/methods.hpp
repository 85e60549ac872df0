#pragma once

#include <string_view>

#include "base/type_list.hpp"
#include "element/compact_one_point.hpp"
#include "element/eight_point.hpp"
#include "element/formulation.hpp"
#include "element/four_point.hpp"
#include "element/hourglass_assumed_strain.hpp"
#include "element/hourglass_energy_sampling.hpp"
#include "element/hourglass_enhanced.hpp"
#include "element/hourglass_matrix.hpp"
#include "element/hourglass_none.hpp"
#include "element/hourglass_perturbation.hpp"
#include "element/hourglass_rate_perturbation.hpp"
#include "element/hourglass_sampling.hpp"
#include "element/hourglass_viscous.hpp"
#include "element/linear_one_point.hpp"
#include "element/one_point.hpp"
#include "element/stabilization_matrix.hpp"
#include "element/tetrahedra.hpp"
#include "element/updated_one_point.hpp"

namespace sandglass {

struct TlNone {
  static constexpr std::string_view name = "tl-none";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, no hourglass control: fails visibly";
  static constexpr int integration_points = 1;
  using Kinematics = OnePoint;
  using Hourglass = NoHourglassControl;
};

struct TlPerturbation {
  static constexpr std::string_view name = "tl-perturbation";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, perturbation hourglass control (the paper)";
  static constexpr int integration_points = 1;
  using Kinematics = OnePoint;
  using Hourglass = PerturbationHourglassControl;
};

struct TlPerturbationCompact {
  static constexpr std::string_view name = "tl-perturbation-compact";
  static constexpr std::string_view summary =
      "tl-perturbation with its geometry computed anew each step instead of loaded";
  static constexpr int integration_points = 1;
  using Kinematics = CompactOnePoint;
  using Hourglass = PerturbationHourglassControl;
};

struct TlEnergySampling {
  static constexpr std::string_view name = "tl-energy-sampling";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, the missing part of the shear energy restored: no parameter";
  static constexpr int integration_points = 1;
  using Kinematics = OnePoint;
  using Hourglass = EnergySamplingControl;
};

struct TlStabilizationMatrix {
  static constexpr std::string_view name = "tl-stabilization-matrix";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, what the mean-dilatation element has more at rest as a constant matrix";
  static constexpr int integration_points = 1;
  using Kinematics = OnePoint;
  using Hourglass = HourglassMatrixControl<StabilizationMatrix>;
};

struct TlAssumedStrain {
  static constexpr std::string_view name = "tl-assumed-strain";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, assumed strain of Belytschko and Bindeman (ASQBI), computed at rest";
  static constexpr int integration_points = 1;
  using Kinematics = OnePoint;
  using Hourglass = RestHourglassControl<AssumedStrain>;
};

struct TlEnhanced {
  static constexpr std::string_view name = "tl-enhanced";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, enhanced assumed strain after Puso, computed at rest";
  static constexpr int integration_points = 1;
  using Kinematics = OnePoint;
  using Hourglass = RestHourglassControl<EnhancedStrain>;
};

// What an Updated Lagrangian method tends to as strains vanish and time plays no part, it names
// `AtSmallStrain`.

struct UlPerturbation {
  static constexpr std::string_view name = "ul-perturbation";
  static constexpr std::string_view summary =
      "one point, Updated Lagrangian, the same control integrated in time and turned: what ABAQUS does";
  static constexpr int integration_points = 1;
  using Kinematics = UpdatedOnePoint;
  using Hourglass = RatePerturbationControl;
  using AtSmallStrain = TlPerturbation;
};

struct UlViscous {
  static constexpr std::string_view name = "ul-viscous";
  static constexpr std::string_view summary =
      "one point, Updated Lagrangian, viscous control: LS-DYNA's and OpenRadioss's default; no use at rest";
  static constexpr int integration_points = 1;
  static constexpr int zero_energy_modes = 18;  // it resists velocities only
  using Kinematics = UpdatedOnePoint;
  using Hourglass = ViscousHourglassControl;
  using AtSmallStrain = TlNone;
};

struct UlAssumedStrain {
  static constexpr std::string_view name = "ul-assumed-strain";
  static constexpr std::string_view summary =
      "one point, Updated Lagrangian, assumed strain (ASQBI) of the current shape: LS-DYNA's type 6";
  static constexpr int integration_points = 1;
  using Kinematics = UpdatedOnePoint;
  using Hourglass = RateHourglassControl<AssumedStrain>;
  using AtSmallStrain = TlAssumedStrain;
};

struct UlEnhanced {
  static constexpr std::string_view name = "ul-enhanced";
  static constexpr std::string_view summary =
      "one point, Updated Lagrangian, enhanced assumed strain after Puso: ABAQUS's costlier control";
  static constexpr int integration_points = 1;
  using Kinematics = UpdatedOnePoint;
  using Hourglass = RateHourglassControl<EnhancedStrain>;
  using AtSmallStrain = TlEnhanced;
};

struct TlFull {
  static constexpr std::string_view name = "tl-full";
  static constexpr std::string_view summary = "eight points, displacement element: locks as nu -> 1/2";
  static constexpr int integration_points = 8;
  using Kinematics = EightPoint<PointPressure>;
  using Hourglass = NoHourglassControl;
};

struct TlMeanDilatation {
  static constexpr std::string_view name = "tl-mean-dilatation";
  static constexpr std::string_view summary =
      "eight points, one pressure per element: the golden's own element";
  static constexpr int integration_points = 8;
  using Kinematics = EightPoint<MeanPressure>;
  using Hourglass = NoHourglassControl;
};

struct T4 {
  static constexpr std::string_view name = "t4";
  static constexpr std::string_view summary =
      "linear tetrahedra, both cuts of a hexahedron into five: locks as nu -> 1/2";
  static constexpr int integration_points = 10;
  using Kinematics = Tetrahedra<OwnPressure>;
  using Hourglass = NoHourglassControl;
};

struct T4Anp {
  static constexpr std::string_view name = "t4-anp";
  static constexpr std::string_view summary = "the same tetrahedra with pressures averaged at the nodes";
  static constexpr int integration_points = 10;
  using Kinematics = Tetrahedra<NodalPressure>;
  using Hourglass = NoHourglassControl;
};

struct LinearPerturbation {
  static constexpr std::string_view name = "linear";
  static constexpr std::string_view summary =
      "one point, small strain, perturbation hourglass control: right only while nothing turns or strains "
      "much";
  static constexpr int integration_points = 1;
  using Kinematics = LinearOnePoint;
  using Hourglass = PerturbationHourglassControl;
};

struct LinearCondensed {
  static constexpr std::string_view name = "linear-condensed";
  static constexpr std::string_view summary =
      "linear, solved once for all loads: answers are superposed from the response to unit displacements";
  static constexpr int integration_points = 1;
  static constexpr bool condensed = true;
  using Kinematics = LinearOnePoint;
  using Hourglass = PerturbationHourglassControl;
};

struct TlModalSampling {
  static constexpr std::string_view name = "tl-modal-sampling";
  static constexpr std::string_view summary =
      "one point, Total Lagrangian, a stiffness for each hourglass mode from its shear energy: no parameter";
  static constexpr int integration_points = 1;
  using Kinematics = OnePoint;
  using Hourglass = ModalSamplingControl;
};

struct TlFourPoint {
  static constexpr std::string_view name = "tl-four-point";
  static constexpr std::string_view summary =
      "four points on the element's mean parallelepiped, one pressure: nearly eight, from one point's memory";
  static constexpr int integration_points = 4;
  using Kinematics = FourPoint;
  using Hourglass = LastModeControl;
};

/// An adaptive method names its `Levels`, methods from the cheapest to the one that it stands for. What it
/// says of itself beside that is what an element at rest is.
struct TlAdaptive {
  static constexpr std::string_view name = "tl-adaptive";
  static constexpr std::string_view summary =
      "one, four or eight points, each element as many as the accuracy asked for needs";
  static constexpr int integration_points = 1;
  using Kinematics = OnePoint;
  using Hourglass = ModalSamplingControl;
  using Levels = TypeList<TlModalSampling, TlFourPoint, TlMeanDilatation>;
};

/// THE list of methods. A new method is a header (kinematics or hourglass control) and one entry here; tests,
/// tables, benchmarks and charts iterate the list.
using Methods = TypeList<TlNone, TlPerturbation, TlPerturbationCompact, TlEnergySampling,
                         TlStabilizationMatrix, TlAssumedStrain, TlEnhanced, UlPerturbation, UlViscous,
                         UlAssumedStrain, UlEnhanced, TlFull, TlMeanDilatation, T4, T4Anp, LinearPerturbation,
                         LinearCondensed, TlModalSampling, TlFourPoint, TlAdaptive>;

/// An hourglass control that resists velocities alone says so with `damps_only`: it loses energy, and does
/// nothing where time plays no part.
template <class Hourglass>
concept DampsOnly = requires {
  requires Hourglass::damps_only;
};

/// Whether the strength of a method's hourglass control matters to a body at rest.
template <class Method>
inline constexpr bool kappa_matters_at_rest =
    Method::Hourglass::takes_kappa && !DampsOnly<typename Method::Hourglass>;

/// Whether a method's forces are linear in the displacements, f = K u.
template <class Method>
inline constexpr bool is_linear = requires {
  requires Method::Kinematics::small_strain;
};

/// Whether a method takes no steps: its answers are superposed from responses that are computed once.
template <class Method>
inline constexpr bool is_condensed = requires {
  requires Method::condensed;
};

/// Whether a method's elements change the way they integrate.
template <class Method>
inline constexpr bool is_adaptive = requires {
  typename Method::Levels;
};

/// Whether a method knows what to do with a law: small-strain theory takes a law's moduli at rest, and would
/// forget that it relaxes; what an element remembers at one point says nothing of eight.
template <class Method, class Law>
inline constexpr bool knows_law = !((is_linear<Method> || is_adaptive<Method>)&&law_remembers<Law>);

/// A method with a law: the element that the assembly runs.
template <class Method, class Law>
using FormulationOf = Formulation<typename Method::Kinematics, typename Method::Hourglass, Law>;

}  // namespace sandglass
