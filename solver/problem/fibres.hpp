#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "material/material_axes.hpp"
#include "mesh/mesh.hpp"

/// The directions of fibres and sheets in an anisotropic material. Directions may have any length but zero;
/// what of a sheet is along the fibre is left out, and without one a direction across the fibre is chosen,
/// which plays no part in laws without sheets.
namespace sandglass {

/// The same directions everywhere.
struct UniformFibres {
  Vector fibre{};
  std::optional<Vector> sheet = {};
};

/// Fibres that wind around an axis as in the wall of a heart or an artery: at a distance r from the axis they
/// rise from the circle by an angle that is linear between two radii and constant beyond. Sheets are radial.
struct HelicalFibres {
  int axis = 2;                    ///< parallel to x, y or z
  Vector center{};                 ///< a point of the axis, m
  std::array<double, 2> radii{};   ///< m, increasing
  std::array<double, 2> angles{};  ///< rad, at these
};

/// Directions of each element of the mesh.
struct ListedFibres {
  std::vector<Vector> fibres;
  std::vector<Vector> sheets;       ///< empty, or as many
  std::filesystem::path file = {};  ///< that they were read from
};

/// How a material has its fibres; none for an isotropic one.
using FibreRule = std::variant<std::monostate, UniformFibres, HelicalFibres, ListedFibres>;

/// The axes of an element whose fibres and sheets have these directions. Throws InputError where a direction
/// is zero, or the sheet along the fibre.
MaterialAxes<double> axes_along(const Vector& fibre, const std::optional<Vector>& sheet = {});

/// The axes of an element of the mesh by a rule. Throws InputError as above, and for an element on the axis
/// of a helix.
MaterialAxes<double> axes_by(const FibreRule& rule, const Mesh& mesh, std::size_t element);

}  // namespace sandglass
