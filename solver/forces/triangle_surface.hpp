#pragma once

#include <filesystem>
#include <memory>
#include <variant>

#include "forces/box_tree.hpp"
#include "forces/obstacle_shape.hpp"

namespace sandglass {

/// Corners of triangles, counterclockwise seen from outside.
using Triangle = std::array<int, 3>;

/// A closed surface of triangles, with a tree of boxes around them. Distances are exact; inside and outside
/// follow from the normal of the closest face, edge or corner, angle-weighted (Baerentzen and Aanaes 2005).
class TriangleSurface {
 public:
  /// Either orientation will do, if all triangles have the same. Throws InputError that names `file`, the
  /// rule and the place if a triangle has no area or the surface is open, branches, or has no volume.
  TriangleSurface(NodalField points, std::vector<Triangle> triangles, const std::string& file);

  /// Half the shortest edge of the box around it, m.
  double half_thickness() const;

  const NodalField& points() const { return points_; }  ///< m
  const std::vector<Triangle>& triangles() const { return triangles_; }

  /// A point of the surface, m.
  const Vector& first_point() const { return points_.front(); }

  /// See ObstacleShape. Allocates nothing.
  Gap at(const Vector& x) const;

 private:
  struct Closest {
    double square;  // of the distance, m^2
    Vector point;
    Vector normal;  // of the feature
    bool is_face;
  };

  const Vector& point(int n) const { return points_[static_cast<std::size_t>(n)]; }
  void orient(const std::string& file);
  void set_normals(const std::string& file);
  void compare(const Vector& x, std::size_t triangle, Closest& closest) const;

  NodalField points_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<Vector, 7>> normals_;  // of each face, its edges (from corners 0, 1, 2) and corners
  BoxTree tree_;
  Rows<double> boxes_;
};

/// Reads a surface, in m: .stl, text or binary, or .obj. Throws InputError for another file, or a damaged
/// one.
TriangleSurface read_triangle_surface(const std::filesystem::path& path);

/// A surface whose origin is at a point (m).
struct SurfaceShape {
  std::shared_ptr<const TriangleSurface> surface;
  Vector origin;

  Vector point() const { return sum(origin, 1.0, surface->first_point()); }
  double half_thickness() const { return surface->half_thickness(); }
  Gap at(const Vector& x) const { return surface->at(difference(x, origin)); }
};

using ObstacleShape = std::variant<PlaneShape, RoundShape, BoxShape, EllipsoidShape, SurfaceShape>;

}  // namespace sandglass
