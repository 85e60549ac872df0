#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "solve/motion_gradient.hpp"

namespace sandglass {

/// A field on `nodes` nodes from an array of Python; empty if it is None. Throws TypeError and InputError
/// that name it.
NodalField nodal_field(const char* name, const pybind11::object& given, std::size_t nodes);

/// The derivatives of a scalar J of a motion with the derivatives dJ/du (frames, n, 3) at its frames, or
/// None.
pybind11::dict gradient(const Model& model, const TakenSteps& steps, const std::vector<Frame>& frames,
                        const pybind11::object& displacements, const Wanted& wanted);

/// The derivatives of a static answer, in arrays of Python. The tangent is made when it is first needed; it
/// serves one thread at a time, and the GIL is free meanwhile.
class Derivatives {
 public:
  /// `levels` are those of an adaptive method, else empty; the model must live as long.
  Derivatives(const Model& model, Relaxation answer, std::vector<double> levels)
      : model_(model), answer_(std::move(answer)), levels_(std::move(levels)) {}

  /// The derivatives of a scalar J with the derivatives dJ/du (n, 3) or None, and dJ/dR for driven sets.
  pybind11::dict gradient(const pybind11::object& displacements,
                          const std::map<std::string, Vector>& reactions, const Wanted& wanted);

  /// The derivative of the displacements along a change of the parameters of each material, of nodal forces
  /// and of imposed displacements, arrays (n, 3) or None.
  pybind11::array sensitivity(const std::vector<std::map<std::string, double>>& materials,
                              const pybind11::object& forces, const pybind11::object& imposed);

 private:
  template <class Use>
  auto with_tangent(const Use& use);
  NodalField of_reactions(const std::map<std::string, Vector>& reactions) const;
  std::vector<std::vector<double>> parameters(
      const std::vector<std::map<std::string, double>>& materials) const;

  const Scene& scene() const { return model_.scene(); }

  const Model& model_;
  const Relaxation answer_;
  const std::vector<double> levels_;
  std::mutex busy_;
  std::optional<StaticTangent> tangent_;
};

}  // namespace sandglass
