#include "forces/obstacle.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "forces/obstacle_contact.hpp"
#include "mesh/edges.hpp"

namespace sandglass {

namespace {

bool is_given(const Vector& v) {
  return v != Vector{};
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

/// The stiffness per area over the penalty, E / h, and h, of the elements with a face among these nodes.
struct Scale {
  double modulus = INFINITY;  ///< Pa
  double edge = INFINITY;     ///< m

  Scale(const ForceResolver& resolver, const std::vector<Quadrilateral>& faces) {
    std::vector<bool> touches(resolver.points.size(), false);
    for (const int node : nodes_of(faces)) touches[at(node)] = true;
    for (std::size_t e = 0; e < resolver.cells.size(); ++e) {
      const Hexahedron& cell = resolver.cells[e];
      if (std::ranges::count_if(cell, [&](int node) { return touches[at(node)]; }) < 4) continue;
      modulus = std::min(modulus, resolver.young_moduli[e]);
      for (const auto& [a, b] : hexahedron_edges)
        edge = std::min(edge, distance(resolver.points[at(cell[a])], resolver.points[at(cell[b])]));
    }
  }
};

}  // namespace

std::optional<BrokenRule> Obstacle::broken_rule() const {
  if (label.empty() || label.find('/') != std::string::npos)
    return BrokenRule{"name", fmt::format("= '{}' must be a word without '/'", label)};
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
       {Need{"normal", is_plane, is_given(normal), "must have a length"},
        Need{"end", has_axis, has_axis ? end != point : is_given(end), "must differ from point"},
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
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: obstacle '{}': {}", resolver.file, label, why));
  };
  if (resolver.sets.contains(label))
    refuse("a node set has the same name, and forces are reported by name; allowed: a name of its own");
  for (const ContactForce* other : contacts_of(resolver.forces)) {
    if (other->touch(std::vector<Row<double>>(other->memory()).data()).name == label)
      refuse("another obstacle has the same name; allowed: a name of its own");
  }
  const auto faces = resolver.faces(name, set);
  const Scale scale(resolver, faces);
  std::map<int, double> areas;
  for (const Quadrilateral& face : faces) {
    for (const FacePoint& gauss : gauss_points_of(corners_of(resolver.points, face))) {
      for (std::size_t I = 0; I < 4; ++I) areas[face[I]] += gauss.N[I] * gauss.area;
    }
  }
  std::vector<TouchingNode> touching;
  for (const auto& [node, area] : areas)
    touching.push_back({node, resolver.points[at(node)], penalty * scale.modulus / scale.edge * area});
  const Vector start = sum({}, curve.at(0.0, 0.0), displacement);
  const auto make = method == Method::penalty ? make_penalty_contact : make_kinematic_contact;
  auto contact =
      make(std::move(touching), *this, shape_of(*this, resolver.file), resolver.number_of(curve), start);
  const auto depth_of = [&](const TouchingNode& one) { return contact->depth_at_start(one); };
  const TouchingNode deepest = *std::ranges::max_element(contact->touching(), {}, depth_of);
  constexpr double rounding = 1e-6;  // of coordinates in files, over the edge
  if (const double depth = depth_of(deepest); depth > rounding * scale.edge) {
    refuse(fmt::format(
        "node {} at ({:.6g}, {:.6g}, {:.6g}) m is {:.3g} m inside of it at the start; allowed: a body "
        "that is {} of it",
        deepest.node, deepest.X[0], deepest.X[1], deepest.X[2], depth, inside ? "within" : "outside"));
  }
  resolver.forces.push_back(std::move(contact));
}

}  // namespace sandglass
