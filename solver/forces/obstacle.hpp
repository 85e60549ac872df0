#pragma once

#include <array>
#include <cmath>
#include <string>

#include "forces/force_resolver.hpp"

namespace sandglass {

/// A motion of an obstacle along a straight line.
struct ObstacleMove {
  static constexpr std::string_view name = "move";

  Vector displacement{};  ///< at the factor one, m
  LoadCurve curve = {};

  static constexpr auto parameters() {
    using M = ObstacleMove;
    return std::tuple{
        Parameter{&M::displacement, "displacement", "m", Range::any(), "how far it moves"},
        Parameter{&M::curve, "curve", "-", Range::any(), "its factors multiply this displacement", false}};
  }
};

/// A rigid obstacle that keeps boundary nodes out of itself, and moves by the sum of its moves. The pressure
/// of a penalty acts on the undeformed area of the boundary, at its nodes.
struct Obstacle {
  static constexpr std::string_view name = "obstacle";
  static constexpr std::string_view summary = "a rigid obstacle that the body touches";
  static constexpr std::string_view only_in_motion{};
  static constexpr bool by_mass = false;
  static constexpr std::array<std::string_view, 2> numerical{"penalty", "method"};

  static constexpr Vector not_given{NAN, NAN, NAN};  ///< to be the origin, but case files must say so

  enum class Shape { plane, sphere, capsule, cylinder, box, ellipsoid, surface };
  friend constexpr std::array<std::string_view, 7> words_of(Shape /*type*/) {
    return {"plane", "sphere", "capsule", "cylinder", "box", "ellipsoid", "surface"};
  }

  /// Of motions. Kinematic: in every step, nodes are moved back onto it. Penalty: a force in proportion to
  /// the depth, as always in static equilibrium.
  enum class Method { kinematic, penalty };
  friend constexpr std::array<std::string_view, 2> words_of(Method /*type*/) {
    return {"kinematic", "penalty"};
  }

  std::string label;
  std::string set;
  Shape shape = Shape::plane;
  Vector point = not_given;  ///< m
  Vector end = not_given;    ///< m
  Vector normal{};           ///< of any length
  double radius = 0.0;       ///< m
  Vector half_sizes{};       ///< m
  std::string file;
  bool inside = false;    ///< whether the body is inside of it, as in a cavity
  Vector displacement{};  ///< at the factor one, m
  LoadCurve curve = {};
  std::vector<ObstacleMove> moves = {};  ///< in addition
  double friction = 0.0;                 ///< Coulomb's coefficient
  double penalty = 30.0;                 ///< see parameters
  Method method = Method::kinematic;

  static constexpr auto parameters() {
    using O = Obstacle;
    return std::tuple{
        Parameter{&O::label, "name", "-", Range::any(), "its name in reports of its force"},
        Parameter{&O::set, "set", "-", Range::any(), "node set with the boundary faces that may touch it"},
        Parameter{&O::shape, "shape", "-", Range::any(), "its shape"},
        Parameter{
            &O::point, "point", "m", Range::any(),
            "a point of the plane, the centre of the sphere, box or ellipsoid, one end of the axis, or the "
            "origin of the file (by default that of coordinates)",
            false},
        Parameter{&O::end, "end", "m", Range::any(),
                  "the other end of the axis of a capsule or of a cylinder, which is infinite along it",
                  false},
        Parameter{&O::normal, "normal", "-", Range::any(), "the normal of the plane, towards the body",
                  false},
        Parameter{&O::radius, "radius", "m", Range::at_least(0.0), "of the sphere, capsule or cylinder",
                  false},
        Parameter{&O::half_sizes, "half_sizes", "m", Range::at_least(0.0),
                  "half the sizes of the box or ellipsoid along the coordinate axes", false},
        Parameter{&O::file, "file", "-", Range::any(), "of a closed surface of triangles in m, .stl or .obj",
                  false},
        Parameter{&O::inside, "inside", "-", Range::any(), "whether the body is in it, as in a cavity",
                  false},
        Parameter{&O::displacement, "displacement", "m", Range::any(), "how far it moves", false},
        Parameter{&O::curve, "curve", "-", Range::any(),
                  "its factors multiply the displacement, in place of the loading curve of the case", false},
        Parameter{
            &O::moves, "move", "-", Range::any(),
            "[[obstacle.move]], several times: further displacements that add to it, each with displacement "
            "and a curve of its own: times and factors, or formula",
            false},
        Parameter{&O::friction, "friction", "-", Range::at_least(0.0), "Coulomb's coefficient", false},
        Parameter{
            &O::penalty, "penalty", "-", Range::positive(),
            "pressure over E depth / h, with the smallest Young's modulus E and the shortest edge h of the "
            "elements that may touch it",
            false},
        Parameter{
            &O::method, "method", "-", Range::any(),
            "of motions: kinematic moves nodes back onto it in steps as long as without it; penalty pushes "
            "them, in shorter steps, and loses energy by friction alone; static equilibrium takes the "
            "penalty",
            false}};
  }
  std::optional<BrokenRule> broken_rule() const;

  void resolve(ForceResolver& resolver) const;
};

}  // namespace sandglass
