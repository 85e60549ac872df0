#include "written/force_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/error.hpp"
#include "element/methods.hpp"

namespace sandglass {

namespace {

template <class Method>
using Kernel = FormulationOf<Method, CalledLaw>;

template <class Method>
constexpr std::string_view obstacle() {
  if (is_condensed<Method>) return "its answers are superposed, not computed from forces";
  if (is_adaptive<Method>) return "it chooses a level for each element; write its levels";
  if (Kernel<Method>::averages_over_nodes) return "it averages over nodes, in two passes over the elements";
  if (Kernel<Method>::remembers) return "its elements remember earlier steps";
  if (Kernel<Method>::needs_increment) return "its force depends on velocities";
  return {};
}

/// An aggregate of the next inputs.
template <class Aggregate>
Aggregate inputs(Tape& tape) {
  Aggregate aggregate{};
  if constexpr (!std::is_empty_v<Aggregate>) {
    std::array<Recorded, sizeof(Aggregate) / sizeof(Recorded)> numbers;
    for (Recorded& number : numbers) number = tape.input();
    aggregate = std::bit_cast<Aggregate>(numbers);
  }
  return aggregate;
}

/// Records results(motion, element, axes) of a method's element; the axes are null unless it has fibres.
template <class Method, class Results>
ForceProgram record(bool has_fibres, const Results& results) {
  using K = Kernel<Method>;
  using Element = typename K::template Element<Recorded>;
  Tape tape;
  ForceProgram force;
  const auto add = [&](std::string_view name, std::size_t bytes, std::string meaning, bool is_nodal = false) {
    force.arrays.push_back({name, static_cast<int>(bytes / sizeof(Recorded)), std::move(meaning), is_nodal});
  };
  ElementMotion<Recorded> motion;
  add("u", sizeof(NodalVectors<Recorded>), "displacements, m: component i of node I is number 3 I + i", true);
  motion.u = to_modes(inputs<NodalVectors<Recorded>>(tape));
  if constexpr (K::needs_coordinates) {
    add("X", sizeof(NodalVectors<Recorded>), "reference coordinates, m, in the order of u", true);
    motion.X = to_modes(inputs<NodalVectors<Recorded>>(tape));
  }
  const auto element = inputs<Element>(tape);
  if constexpr (!std::is_empty_v<Element>) {
    add("constants", sizeof(Element),
        "of the element, in SI units: its Element<T> of the kinematics, then of the control");
  }
  MaterialAxes<Recorded> axes;
  if (has_fibres) {
    add("axes", sizeof axes, "material axes, the rows of a rotation: fibres, sheets, their normal");
    axes = inputs<MaterialAxes<Recorded>>(tape);
  }
  force.program = tape.program(results(motion, element, has_fibres ? &axes : nullptr));
  return force;
}

template <class Method>
ForceProgram record_force(const CalledLaw& law, bool has_fibres) {
  using K = Kernel<Method>;
  return record<Method>(has_fibres, [&](const auto& motion, const auto& element, const auto* axes) {
    typename K::template History<Recorded> none{};
    const auto now = K::deformation(motion, element);
    const auto f = from_modes(K::force(now, element, none, with_axes(law, axes)));
    return std::vector<Recorded>(f.entries.begin(), f.entries.end());
  });
}

template <class Method>
ForceProgram record_jacobian() {
  return record<Method>(false, [](const auto& motion, const auto& element, const auto*) {
    return std::vector<Recorded>{Kernel<Method>::smallest_jacobian(motion, element)};
  });
}

/// What `recorder` records of the method of this name, which must have a kernel of one element.
template <class Recorder>
ForceProgram of_method(std::string_view method, const Recorder& recorder) {
  ForceProgram program;
  with_named_type(Methods{}, method, [&]<class Method>() {
    if constexpr (obstacle<Method>().empty()) {
      program = recorder.template operator()<Method>();
    } else {
      throw InputError(
          fmt::format("method '{}' has no kernel of one element: {}", Method::name, obstacle<Method>()));
    }
  });
  return program;
}

}  // namespace

std::string_view why_not_written(std::string_view method) {
  std::string_view reason;
  with_named_type(Methods{}, method, [&]<class Method>() { reason = obstacle<Method>(); });
  return reason;
}

ForceProgram force_program(std::string_view method, const CalledLaw& law, bool has_fibres) {
  return of_method(method, [&]<class Method>() { return record_force<Method>(law, has_fibres); });
}

ForceProgram jacobian_program(std::string_view method) {
  return of_method(method, []<class Method>() { return record_jacobian<Method>(); });
}

std::vector<double> element_constants(std::string_view method, const NodalVectors<double>& X,
                                      const CalledLaw& law, const MaterialAxes<double>* axes,
                                      const HourglassSettings& settings) {
  std::vector<double> numbers;
  with_named_type(Methods{}, method, [&]<class Method>() {
    using Element = typename Kernel<Method>::template Element<double>;
    if constexpr (!std::is_empty_v<Element>) {
      const Element element = Kernel<Method>::precompute(X, law.with_axes(axes), settings);
      numbers.resize(sizeof element / sizeof(double));
      std::memcpy(numbers.data(), &element, sizeof element);
    }
  });
  return numbers;
}

}  // namespace sandglass
