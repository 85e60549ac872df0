#pragma once

#include <string_view>

#include "base/type_list.hpp"
#include "element/eight_point.hpp"
#include "element/formulation.hpp"
#include "element/hourglass_none.hpp"
#include "element/hourglass_perturbation.hpp"
#include "element/one_point.hpp"

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

/// THE list of methods. A new method is a header (kinematics or hourglass control) and one entry here; tests,
/// tables, benchmarks and charts iterate the list.
using Methods = TypeList<TlNone, TlPerturbation, TlFull, TlMeanDilatation>;

/// A method with a law: the element that the assembly runs.
template <class Method, class Law>
using FormulationOf = Formulation<typename Method::Kinematics, typename Method::Hourglass, Law>;

}  // namespace sandglass
