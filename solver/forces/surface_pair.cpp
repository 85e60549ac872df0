#include "forces/surface_pair.hpp"

#include <algorithm>
#include <utility>

namespace sandglass {

namespace {

constexpr std::string_view only_motion = "surfaces touch each other in motions only";

std::vector<int> nodes_of_all(const std::vector<std::vector<Quadrilateral>>& surfaces) {
  std::vector<int> nodes;
  for (const auto& faces : surfaces) {
    for (const int node : nodes_of(faces)) nodes.push_back(node);
  }
  return nodes;
}

/// What a pair remembers: the sum of the largest ways of nodes, m, and one more than the number of a node
/// that passed through.
enum OfPair : std::size_t { way_so_far = 0, passed_node = 1 };

/// What surface points remember: until which way they touch nothing, m; the stiffness of the spring that
/// pulls them, N/m, zero if they do not touch; their depth then, m. With friction also the face with the
/// point to which it pulls, in further rows its weights, and the extension along the face, m.
enum Remembered : std::size_t { clear_until = 0, face_of_anchor = 1, stiffness_now = 2, last_depth = 3 };

/// A node with the largest weight.
int node_of(const MovingSurface& surface, const SurfacePoint& point) {
  const auto& weights = point.weights.x;
  const auto I = static_cast<std::size_t>(std::ranges::max_element(weights) - weights.begin());
  return surface.nodes()[at(point.nodes[I])];
}

}  // namespace

SurfacePair::SurfacePair(const Contact& contact, double stiffness, double reach, const NodalField& points,
                         std::span<const Hexahedron> cells, std::vector<std::vector<Quadrilateral>> surfaces)
    : ContactForce(nodes_of_all(surfaces), {Contact::name, false, contact.friction > 0.0, only_motion}),
      contact_(contact),
      stiffness_(stiffness),
      reach_(reach),
      faces_(std::move(surfaces)),
      memory_(ContactMemory::own + 1) {  // a row of the pair
  for (const auto& faces : faces_) {
    surfaces_.emplace_back(points, faces);
    rows_of_.push_back(memory_ - ContactMemory::own);
    memory_ += surfaces_.back().rows();
  }
  for (std::size_t from = 0; from < faces_.size(); ++from) {
    const std::size_t onto = faces_.size() - 1 - from;
    sides_.push_back(
        {from, onto, faces_around(surfaces_[from], faces_[onto], cells), memory_ - ContactMemory::own});
    memory_ += by_point() * surfaces_[from].points().size();
  }
}

std::size_t SurfacePair::memory() const {
  return memory_;
}

Touch SurfacePair::touch(const Row<double>* memory) const {
  Touch touch = touch_of(contact_.label, memory);
  touch.passed = static_cast<int>(memory[ContactMemory::own][passed_node]) - 1;
  return touch;
}

template <class Use>
void SurfacePair::for_each_touch(NodalRows u, Row<double>* rows, const Use& use) const {
  ContactMemory memory(rows);
  double& way = memory.others[0][way_so_far];
  double most = 0.0;
  for (std::size_t s = 0; s < surfaces_.size(); ++s)
    most = std::max(most, surfaces_[s].move(u, memory.others + rows_of_[s]));
  way += most;
  bool fits = false;
  for (const Side& side : sides_) {
    const MovingSurface &from = surfaces_[side.from], &onto = surfaces_[side.onto];
    Row<double>*of_from = memory.others + rows_of_[side.from], *of_onto = memory.others + rows_of_[side.onto];
    for (std::size_t k = 0; k < from.points().size(); ++k) {
      Row<double>* of_point = memory.others + side.first_row + by_point() * k;
      if (of_point[0][clear_until] > way) continue;
      if (!fits) {
        for (std::size_t s = 0; s < surfaces_.size(); ++s) surfaces_[s].fit(memory.others + rows_of_[s]);
        fits = true;
      }
      const SurfacePoint& point = from.points()[k];
      const Vector x = MovingSurface::position(point.nodes, point.weights, of_from);
      const SurfaceFoot foot = onto.closest(x, from.normal(point.nodes, point.weights, of_from), reach_,
                                            side.neighbours[k], of_onto);
      // Both surfaces may move by half the distance before they touch.
      of_point[0][clear_until] = foot.behind ? way : way + 0.5 * foot.distance();
      if (foot.behind) {
        of_point[0][last_depth] = foot.distance();
        use(side, k, x, foot, of_point);
      } else if (of_point[0][stiffness_now] > 0.0) {
        constexpr double deep = 0.8;  // of the reach: no step leads from there to the outside
        if (of_point[0][last_depth] > deep * reach_) memory.others[0][passed_node] = 1 + node_of(from, point);
        let_go(of_point, memory);
      }
    }
  }
}

void SurfacePair::add_contact(Factors /*factors*/, NodalRows u, Row<double>* rows,
                              AtNodes<Row<double>> forces) const {
  ContactMemory memory(rows);
  memory.pushes = memory.moves = {};
  for_each_touch(
      u, rows,
      [&](const Side& side, std::size_t k, const Vector& x, const SurfaceFoot& foot, Row<double>* of_point) {
        const MovingSurface &from = surfaces_[side.from], &onto = surfaces_[side.onto];
        const SurfacePoint& point = from.points()[k];
        const Row<double>* of_onto = memory.others + rows_of_[side.onto];
        const double stiffness = 0.5 * stiffness_ * std::min(point.area, onto.area(foot.face));
        memory.moves[3] = std::max(memory.moves[3], foot.distance());
        const Row<double> anchor = contact_.friction > 0.0
                                       ? hold(x, foot, stiffness, of_point, of_onto, memory, onto)
                                       : foot.weights;
        of_point[0][stiffness_now] = stiffness;
        const Quadrilateral& corners = onto.corners(foot.face);
        const Vector pull = difference(MovingSurface::position(corners, anchor, of_onto), x);
        memory.pushes[3] += 0.5 * stiffness * dot(pull, pull);
        for (std::size_t i = 0; i < 3; ++i) {
          const double force = stiffness * pull[i];
          for (std::size_t I = 0; I < 4; ++I) {
            forces[from.nodes()[at(point.nodes[I])]][i] += point.weights[I] * force;
            forces[onto.nodes()[at(corners[I])]][i] -= anchor[I] * force;
          }
          if (side.from != side.onto) memory.pushes[i] += side.from == 0 ? force : -force;
        }
      });
}

/// The weights of the point of the face to which the spring of a point pulls.
Row<double> SurfacePair::hold(const Vector& x, const SurfaceFoot& foot, double stiffness,
                              Row<double>* of_point, const Row<double>* onto, ContactMemory& memory,
                              const MovingSurface& surface) const {
  Row<double>&anchor = of_point[1], &stretch = of_point[2];
  Vector along{};
  if (of_point[0][stiffness_now] > 0.0) {
    const Quadrilateral& corners = surface.corners(static_cast<int>(of_point[0][face_of_anchor]));
    along = difference(foot.x, MovingSurface::position(corners, anchor, onto));
    const Vector inwards = difference(foot.x, x);
    const double square = dot(inwards, inwards);
    along = sum(along, -dot(along, inwards) / square, inwards);
  } else {
    stretch = {};
  }
  memory.sums[0] += stiffness * slip(along, contact_.friction * foot.distance(), stretch);
  stretch = {{along[0], along[1], along[2]}};
  of_point[0][face_of_anchor] = foot.face;
  anchor = surface.weights_at(foot, difference(foot.x, along), onto);
  return anchor;
}

void SurfacePair::let_go(Row<double>* of_point, ContactMemory& memory) const {
  const double stiffness = std::exchange(of_point[0][stiffness_now], 0.0);
  if (by_point() == 1) return;
  const Row<double>& stretch = of_point[2];
  for (std::size_t i = 0; i < 3; ++i) memory.sums[0] += 0.5 * stiffness * stretch[i] * stretch[i];
}

void SurfacePair::add_rates(Factors /*largest*/, const std::vector<double>& masses,
                            std::vector<LoadRates>& rates) const {
  for (const Side& side : sides_) {
    const MovingSurface& surface = surfaces_[side.from];
    std::vector<double> areas(surface.nodes().size()), largest(areas.size());
    for (const SurfacePoint& point : surface.points()) {
      for (std::size_t I = 0; I < 4; ++I) areas[at(point.nodes[I])] += point.weights[I] * point.area;
    }
    for (int face = 0; face < static_cast<int>(faces_[side.from].size()); ++face) {
      for (const int node : surface.corners(face))
        largest[at(node)] = std::max(largest[at(node)], surface.area(face));
    }
    for (std::size_t n = 0; n < areas.size(); ++n) {
      const std::size_t node = at(surface.nodes()[n]);
      rates[node].square += rate_of_one_sided * stiffness_ * (2.0 * areas[n] + largest[n]) / masses[node];
    }
  }
}

std::shared_ptr<const BodyForce> SurfacePair::restricted_to(const MeshPart& part) const {
  std::vector<std::vector<Quadrilateral>> inside;
  for (const auto& faces : faces_) {
    inside.push_back(faces_in(part, faces));
    if (inside.back().empty()) return nullptr;
  }
  return std::make_shared<SurfacePair>(contact_, stiffness_, reach_, part.mesh.points, part.mesh.cells,
                                       std::move(inside));
}

std::optional<SurfacePair::Deepest> SurfacePair::deepest_at_start() const {
  int most = 0;
  for (const int node : nodes()) most = std::max(most, node);
  const Rows<double> undeformed(1);
  Rows<double> rows(memory_);
  std::optional<Deepest> deepest;
  for_each_touch(NodalRows(undeformed.data(), std::vector<int>(at(most) + 1, 0)), rows.data(),
                 [&](const Side& side, std::size_t k, const Vector&, const SurfaceFoot& foot, Row<double>*) {
                   const double depth = foot.distance();
                   if (deepest && depth <= deepest->depth) return;
                   const MovingSurface& from = surfaces_[side.from];
                   deepest = {node_of(from, from.points()[k]), depth};
                 });
  return deepest;
}

}  // namespace sandglass
