#include "forces/surface_pair.hpp"

#include <algorithm>

#include "base/error.hpp"

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

}  // namespace

SurfacePair::SurfacePair(const Contact& contact, SurfacesOfPair given, const NodalField& points,
                         std::span<const Hexahedron> cells, std::size_t by_point, std::size_t by_node)
    : ContactForce(nodes_of_all(given.faces),
                   {Contact::name, false,
                    contact.friction > 0.0 || contact.method == Contact::Method::kinematic, only_motion}),
      contact_(contact),
      given_(std::move(given)),
      by_point_(by_point) {
  for (const auto& faces : given_.faces) surfaces_.emplace_back(points, faces);
  for (std::size_t from = 0; from < surfaces_.size(); ++from) {
    const std::size_t onto = surfaces_.size() - 1 - from;
    sides_.push_back({from, onto, faces_around(surfaces_[from], given_.faces[onto], cells), 0});
  }
  lay_out(by_node);
}

SurfacePair::SurfacePair(const SurfacePair& other, std::size_t by_point, const ForceTraits& traits)
    : ContactForce(other.nodes(), traits),
      contact_(other.contact_),
      given_(other.given_),
      surfaces_(other.surfaces_),
      sides_(other.sides_),
      by_point_(by_point) {
  lay_out(0);
}

void SurfacePair::lay_out(std::size_t by_node) {
  for (const MovingSurface& surface : surfaces_) {
    rows_of_.push_back(memory_ - ContactMemory::own);
    memory_ += surface.rows() + by_node * surface.nodes().size();
  }
  for (Side& side : sides_) {
    side.first_row = memory_ - ContactMemory::own;
    memory_ += by_point_ * surfaces_[side.from].points().size();
  }
}

int SurfacePair::node_of(const MovingSurface& surface, const SurfacePoint& point) {
  const auto& weights = point.weights.x;
  const auto I = static_cast<std::size_t>(std::ranges::max_element(weights) - weights.begin());
  return surface.nodes()[at(point.nodes[I])];
}

double SurfacePair::friction(Factors factors) const {
  const double factor = factors[given_.friction_curve], friction_now = contact_.friction * factor;
  if (friction_now < 0.0) {
    throw InputError(
        fmt::format("{} '{}': the factor of the friction becomes {:.6g}; allowed: none below zero",
                    Contact::name, contact_.label, factor));
  }
  return friction_now;
}

std::shared_ptr<const BodyForce> SurfacePair::restricted_to(const MeshPart& part) const {
  SurfacesOfPair inside = given_;
  for (auto& faces : inside.faces) {
    faces = faces_in(part, faces);
    if (faces.empty()) return nullptr;
  }
  return make_surface_pair(contact_, std::move(inside), part.mesh.points, part.mesh.cells);
}

std::optional<SurfacePair::Deepest> SurfacePair::deepest_at_start() const {
  const Rows<double> undeformed(1);
  const std::vector<int> first(at(*std::ranges::max_element(nodes())) + 1, 0);
  Rows<double> rows(memory_);
  ContactMemory memory(rows.data());
  std::optional<Deepest> deepest;
  const auto use = [&](const Side& side, std::size_t k, const Vector& /*x*/, const SurfaceFoot& foot) {
    if (deepest && foot.distance() <= deepest->depth) return;
    const MovingSurface& from = surfaces_[side.from];
    deepest = {node_of(from, from.points()[k]), foot.distance()};
  };
  for_each_touch(NodalRows(undeformed.data(), first), memory, use, [](Row<double>*) {});
  return deepest;
}

std::shared_ptr<SurfacePair> make_surface_pair(const Contact& contact, SurfacesOfPair given,
                                               const NodalField& points, std::span<const Hexahedron> cells) {
  const auto make = contact.method == Contact::Method::penalty ? make_penalty_pair : make_kinematic_pair;
  return make(contact, std::move(given), points, cells);
}

}  // namespace sandglass
