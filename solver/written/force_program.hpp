#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "element/hourglass_settings.hpp"
#include "material/called_law.hpp"
#include "math/recorded.hpp"
#include "mesh/hexahedron.hpp"

namespace sandglass {

/// An array that a kernel reads, with so many numbers for each element.
struct KernelArray {
  std::string_view name;
  int numbers;
  std::string meaning;
  bool is_nodal = false;  ///< three numbers for each of the element's nodes
};

/// The internal forces of one element as a straight-line program. Its inputs are the numbers of its arrays in
/// order, its results the forces (N) in the order of the displacements.
struct ForceProgram {
  std::vector<KernelArray> arrays;
  Program program;
};

/// Records the force of a method's elements with an elastic law in its own axes. Throws InputError for
/// methods whose force needs more than the element's motion and constants.
ForceProgram force_program(std::string_view method, const CalledLaw& law, bool has_fibres);

/// Records the smallest det F at the integration points of such a method's element, its only result.
ForceProgram jacobian_program(std::string_view method);

/// The numbers (SI units) of an element with corners X (m) in the array `constants` of its method's kernel;
/// none if the kernel has no such array. The method must accept the element. Without `axes` the law's are
/// those of space.
std::vector<double> element_constants(std::string_view method, const NodalVectors<double>& X,
                                      const CalledLaw& law, const MaterialAxes<double>* axes,
                                      const HourglassSettings& settings);

/// Why a method's force is not such a program; empty if it is.
std::string_view why_not_written(std::string_view method);

}  // namespace sandglass
