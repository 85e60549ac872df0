#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "material/material_axes.hpp"
#include "mesh/mesh.hpp"

/// The directions of fibres and sheets in an anisotropic material. Directions may have any length but zero.
/// The part of a sheet's direction along the fibre is dropped; without sheets, any direction perpendicular to
/// the fibre is chosen, which only laws with sheets use.
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
  Vector center{};                 ///< a point on the axis, m
  std::array<double, 2> radii{};   ///< m, increasing
  std::array<double, 2> angles{};  ///< rad, at these radii
};

/// Directions of each element of the mesh.
struct ListedFibres {
  std::vector<Vector> fibres;
  std::vector<Vector> sheets;       ///< empty, or one for each fibre
  std::filesystem::path file = {};  ///< from which they were read
};

/// The fibres of a material; none if it is isotropic.
using FibreRule = std::variant<std::monostate, UniformFibres, HelicalFibres, ListedFibres>;

/// The axes of an element with these directions of fibres and sheets. Throws InputError if a direction is
/// zero or both are parallel.
MaterialAxes<double> axes_along(const Vector& fibre, const std::optional<Vector>& sheet = {});

/// The axes of an element of the mesh by a rule. Throws InputError as above, and for an element on the axis
/// of a helix.
MaterialAxes<double> axes_by(const FibreRule& rule, const Mesh& mesh, std::size_t element);

}  // namespace sandglass
