#pragma once

#include "forces/body_force.hpp"
#include "forces/box_tree.hpp"

namespace sandglass {

/// A material point of a surface: the mean of the corners of a face with weights that add up to one. It is a
/// corner of faces, the middle of an edge or of a face.
struct SurfacePoint {
  Row<double> weights;
  double area;          ///< its share of the undeformed surface by Simpson's rule, m^2
  Quadrilateral nodes;  ///< by their places in the surface
};

/// The point of a surface that is closest to another.
struct SurfaceFoot {
  double square;  ///< of the distance, m^2
  int face = -1;  ///< -1: none is closer than that
  std::size_t triangle = 0;
  Row<double> weights = {};  ///< of the corners of the face
  Vector x = {};             ///< m
  bool behind = false;       ///< whether the other point is behind it

  double distance() const { return std::sqrt(square); }
};

/// The least and the largest motion of nodes along each axis, m.
struct Motions {
  Vector low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};

  /// No two nodes move by more (m) relative to each other.
  double largest_relative() const { return length(difference(high, low)); }
};

/// Boundary faces of a deformable body where it is now. Faces are four triangles about their middles. What
/// changes is in rows that the caller keeps, zeros at the start.
class MovingSurface {
 public:
  /// `points` of the mesh, m.
  MovingSurface(const NodalField& points, const std::vector<Quadrilateral>& faces);

  /// Its nodes in the mesh, in order.
  const std::vector<int>& nodes() const { return nodes_; }

  /// All corners, middles of edges and middles of faces, which Simpson's rule takes: with these areas a
  /// uniform pressure has its consistent nodal forces.
  const std::vector<SurfacePoint>& points() const { return points_; }

  std::size_t rows() const { return 2 * nodes_.size() + tree_.rows(); }

  /// Moves it to displacements u (m), and extends `motions` by those of its nodes, at first
  /// from the undeformed body.
  template <class Displacements>
  void move(const Displacements& u, bool is_first, Row<double>* rows, Motions& motions) const {
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const Row<double>& of_node = u[nodes_[n]];
      for (std::size_t i = 0; i < 3; ++i) {
        const double x = undeformed_[n][i] + of_node[i], way = is_first ? of_node[i] : x - rows[n][i];
        rows[n][i] = x;
        motions.low[i] = std::min(motions.low[i], way);
        motions.high[i] = std::max(motions.high[i], way);
      }
    }
  }

  /// Fits normals and the tree to the present position, as `closest` needs them.
  void fit(Row<double>* rows) const;

  /// The mean of positions (m) of the nodes.
  static Vector position(const Quadrilateral& nodes, const Row<double>& weights, const Row<double>* rows) {
    return mean(nodes, weights, rows);
  }

  /// The mean of the sums of unit normals of the faces around each node; not of length one.
  Vector normal(const Quadrilateral& nodes, const Row<double>& weights, const Row<double>* rows) const {
    return mean(nodes, weights, rows + nodes_.size());
  }

  /// Where the corners of a face are now, m.
  std::array<Vector, 4> corners_now(int face, const Row<double>* rows) const;

  /// The undeformed area of a face, m^2.
  double area(int face) const { return areas_[at(face)]; }

  /// The corners of a face.
  const Quadrilateral& corners(int face) const { return faces_[at(face)]; }

  /// The closest point to x (m) within `reach` (m) on faces whose normal is so far from a normal that the
  /// cosine of their angle is at most `cosine`, except those of a sorted list. An open surface is extended
  /// beyond its rim in the planes of its faces. Allocates nothing.
  SurfaceFoot closest(const Vector& x, const Vector& normal, double cosine, double reach,
                      const std::vector<int>& except, const Row<double>* rows) const;

  /// The plane of a triangle of a face.
  struct Plane {
    Vector normal;        ///< outwards, of length one
    double gap;           ///< of a point outside, m; negative inside
    Row<double> weights;  ///< of the corners of the face at the projection of the point
    double least;         ///< weight of a corner of the triangle there: negative outside of it
  };

  /// At a point x (m).
  Plane plane_at(int face, std::size_t triangle, const Vector& x, const Row<double>* rows) const;

  /// The weights of the corners of a face at the projection of x (m) onto the plane of one of its triangles,
  /// also beyond the triangle.
  Row<double> weights_at(const SurfaceFoot& foot, const Vector& x, const Row<double>* rows) const;

  /// The direction from a point x (m) behind a face to its foot, of length one, as the triangle has it when
  /// the corners of the face are at `now` and when they are at `then` (m).
  static std::pair<Vector, Vector> directions(const SurfaceFoot& foot, const Vector& x,
                                              const std::array<Vector, 4>& now,
                                              const std::array<Vector, 4>& then);

  /// The weights at the projection of x (m) along a direction onto the plane of a triangle of a face with
  /// these corners (m).
  static Row<double> weights_along(const std::array<Vector, 4>& corners, std::size_t triangle,
                                   const Vector& x, const Vector& direction);

 private:
  static Vector mean(const Quadrilateral& nodes, const Row<double>& weights, const Row<double>* rows) {
    Vector sum_of_all{};
    for (std::size_t I = 0; I < 4; ++I) {
      for (std::size_t i = 0; i < 3; ++i) sum_of_all[i] += weights[I] * rows[nodes[I]][i];
    }
    return sum_of_all;
  }

  void set_behind(const Vector& x, SurfaceFoot& foot, const Row<double>* rows) const;

  std::vector<int> nodes_;
  NodalField undeformed_;                    // m
  std::vector<Quadrilateral> faces_;         // by places in nodes_
  std::vector<double> areas_;                // of faces, m^2
  std::vector<std::array<bool, 4>> on_rim_;  // whether no other face has this edge of a face
  std::vector<SurfacePoint> points_;
  BoxTree tree_;
};

/// For each point of a surface, the faces (sorted) of another, or of itself, that touch an element around it:
/// its neighbours, with which it is connected.
std::vector<std::vector<int>> faces_around(const MovingSurface& surface,
                                           const std::vector<Quadrilateral>& faces,
                                           std::span<const Hexahedron> cells);

}  // namespace sandglass
