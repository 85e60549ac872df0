#include "forces/obstacle.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "forces/contact_input.hpp"
#include "forces/obstacle_contact.hpp"
#include "mesh/face_load.hpp"
#include "mesh/vectors.hpp"

namespace sandglass {

namespace {

bool is_given(const Vector& v) {
  return v != Vector{} && !std::isnan(v[0]);
}

/// `file` is the case's.
ObstacleShape shape_of(const Obstacle& given, const std::filesystem::path& file) {
  const Vector axis = difference(given.end, given.point);
  switch (given.shape) {
    case Obstacle::Shape::plane:
      return PlaneShape{given.point, direction_of(given.normal, length(given.normal))};
    case Obstacle::Shape::sphere:
      return RoundShape{given.point, {}, 0.0, 0.0, given.radius};
    case Obstacle::Shape::capsule:
      return RoundShape{given.point, axis, 0.0, 1.0, given.radius};
    case Obstacle::Shape::cylinder:
      return RoundShape{given.point, axis, -INFINITY, INFINITY, given.radius};
    case Obstacle::Shape::box:
      return BoxShape{given.point, given.half_sizes};
    case Obstacle::Shape::ellipsoid:
      return EllipsoidShape{given.point, given.half_sizes};
    case Obstacle::Shape::surface: {
      const auto path = file.parent_path() / given.file;
      return SurfaceShape{std::make_shared<TriangleSurface>(read_triangle_surface(path)), given.point};
    }
  }
  return {};
}

/// Whether the faces that are closest to a plane look along its normal: then the body is behind it.
bool are_behind(const Vector& normal, const std::vector<Quadrilateral>& faces, const NodalField& points,
                double rounding) {
  const auto height = [&](int node) { return dot(normal, points[at(node)]); };
  double lowest = INFINITY;
  for (const Quadrilateral& face : faces) {
    for (const int node : face) lowest = std::min(lowest, height(node));
  }
  Triple<double> sum{};
  for (const Quadrilateral& face : faces) {
    if (std::ranges::none_of(face, [&](int node) { return height(node) <= lowest + rounding; })) continue;
    for (const FacePoint& gauss : gauss_points_of(corners_of(points, face))) sum += gauss.normal;
  }
  return dot(normal, {sum(0, 0), sum(1, 0), sum(2, 0)}) > 0.5 * std::sqrt(double_dot(sum, sum));
}

}  // namespace

std::optional<BrokenRule> Obstacle::broken_rule() const {
  if (auto broken = broken_rule_of_name(label)) return broken;
  if (curve != LoadCurve{} && displacement == Vector{}) {
    return BrokenRule{"displacement",
                      "is needed with times, factors or formula, which are its curve; a move has its own"};
  }
  const std::string_view word = words_of(shape)[static_cast<std::size_t>(shape)];
  const bool is_plane = shape == Shape::plane, is_file = shape == Shape::surface;
  const bool has_sizes = shape == Shape::box || shape == Shape::ellipsoid;
  const bool has_axis = shape == Shape::capsule || shape == Shape::cylinder;
  struct Need {
    const char* parameter;
    bool needed, given;
    const char* rule;
  };
  for (const auto& [parameter, needed, given, rule] :
       {Need{"point", !is_file, !is_file ? !std::isnan(point[0]) : false, "has no default"},
        Need{"normal", is_plane, is_given(normal), "must have a length"},
        Need{"end", has_axis, !std::isnan(end[0]) && !(has_axis && end == point), "must differ from point"},
        Need{"file", is_file, !file.empty(), "must name a closed surface"},
        Need{"radius", !is_plane && !has_sizes && !is_file, radius > 0.0, "must be positive"},
        Need{"half_sizes", has_sizes,
             has_sizes ? *std::ranges::min_element(half_sizes) > 0.0 : is_given(half_sizes),
             "must be positive"}}) {
    if (needed == given) continue;
    return BrokenRule{parameter, needed ? fmt::format("is needed for shape = '{}' and {}", word, rule)
                                        : fmt::format("has no meaning for shape = '{}'; leave it out", word)};
  }
  return std::nullopt;
}

void Obstacle::resolve(ForceResolver& resolver) const {
  require_own_name(resolver, name, label);
  const auto faces = resolver.faces(name, set);
  const ContactScale scale(resolver.points, resolver.cells, resolver.young_moduli, faces);
  std::map<int, double> areas;
  for (const Quadrilateral& face : faces) {
    for (const FacePoint& gauss : gauss_points_of(corners_of(resolver.points, face))) {
      for (std::size_t I = 0; I < 4; ++I) areas[face[I]] += gauss.N[I] * gauss.area;
    }
  }
  std::vector<TouchingNode> touching;
  for (const auto& [node, area] : areas) {
    if (!resolver.held.empty() && resolver.held[at(node)]) continue;  // the obstacle cannot push it
    touching.push_back({node, resolver.points[at(node)], scale.stiffness(penalty) * area});
  }
  if (touching.empty()) {
    throw InputError(
        fmt::format("{}: {} '{}': all nodes of set '{}' are held or driven, and feel no obstacle; "
                    "allowed: a set with nodes that may move",
                    resolver.file, name, label, set));
  }
  if (shape == Shape::plane &&
      are_behind(direction_of(normal, length(normal)), faces, resolver.points, scale.rounding())) {
    throw InputError(
        fmt::format("{}: {} '{}': the body is behind the plane: the faces of set '{}' that are closest to it "
                    "look along its normal ({:.3g}, {:.3g}, {:.3g}); allowed: a normal towards the body",
                    resolver.file, name, label, set, normal[0], normal[1], normal[2]));
  }
  ObstaclePath path{{{resolver.number_of(curve), displacement}}, resolver.add_moves(), {}};
  for (const ObstacleMove& move : moves)
    path.legs.push_back({resolver.number_of(move.curve), move.displacement});
  std::vector<double> factors;
  for (const LoadCurve& each : resolver.curves) factors.push_back(each.at(0.0, 0.0));
  path.start = path.at(factors);
  Obstacle given = *this;
  for (Vector* place : {&given.point, &given.end}) *place = is_given(*place) ? *place : Vector{};
  auto contact =
      make_moving_contact(std::move(touching), given, shape_of(given, resolver.file), std::move(path));
  const auto depth_of = [&](const TouchingNode& one) { return contact->depth_at_start(one); };
  const TouchingNode deepest = *std::ranges::max_element(contact->touching(), {}, depth_of);
  if (const double depth = depth_of(deepest); depth > scale.rounding()) {
    refuse_node(resolver, name, label, deepest.node,
                fmt::format("is {:.3g} m {} it at the start", depth, inside ? "outside" : "inside"),
                fmt::format("a body {} it", inside ? "inside" : "outside"));
  }
  const auto place = contact->point_of_shape();
  if (place && !inside && winding_number(*place, resolver.boundary, resolver.points) > 0.5) {
    throw InputError(
        fmt::format("{}: {} '{}': its point ({:.6g}, {:.6g}, {:.6g}) m is within the body at the "
                    "start; allowed: an obstacle outside of it",
                    resolver.file, name, label, (*place)[0], (*place)[1], (*place)[2]));
  }
  resolver.forces.push_back(std::move(contact));
}

}  // namespace sandglass
