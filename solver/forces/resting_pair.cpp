#include "forces/surface_pair.hpp"

namespace sandglass {

namespace {

/// By how much of its height a triangle extends beyond its edges. Points keep their triangle that far, so
/// that none alternates between two triangles.
constexpr double overhang = 0.1;

/// At rest no step is limited by the stiffness.
constexpr double stiffer_at_rest = 30.0;

/// Points that just fit are linearized as touching, up to this share of the shortest edge.
constexpr double just_fits = 1e-6;

std::string_view why_none(const Contact& contact) {
  if (contact.friction > 0.0) return "friction depends on the path";
  if (contact.other.empty()) return "a surface touches itself in motions only";
  return "";
}

/// The force of a point that touches a triangle is along its normal, in proportion to the depth behind its
/// plane: the derivative of an energy, and without moment. Points remember also their triangle, whether their
/// fixed contact is contrary, their depth and the depth of their constant force, m.
class RestingPair final : public SurfacePair {
 public:
  RestingPair(std::shared_ptr<const SurfacePair> moving, const ForceTraits& traits)
      : SurfacePair(*moving, 2, traits), moving_(std::move(moving)) {}

  std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const override {
    const auto inside = std::static_pointer_cast<const SurfacePair>(moving_->restricted_to(part));
    return inside ? make_resting_pair(inside) : nullptr;
  }
  std::shared_ptr<const BodyForce> at_rest() const override { return nullptr; }
  std::shared_ptr<const BodyForce> in_motion() const override { return moving_; }

  void add_contact(Factors /*factors*/, NodalRows u, Row<double>* rows,
                   AtNodes<Row<double>> forces) const override {
    ContactMemory memory(rows);
    memory.pushes = memory.moves = {};
    for_each_resting(u, memory, 0.0, [&](const Resting& one) {
      const double depth = -one.plane.gap;
      memory.pushes[3] += 0.5 * one.stiffness * depth * (depth + 2.0 * one.constant);
      memory.moves[3] = std::max(memory.moves[3], depth);
      const Vector force = sum({}, one.stiffness * (depth + one.constant), one.plane.normal);
      for_each_node(one, [&](int node, double weight) {
        for (std::size_t i = 0; i < 3; ++i) forces[node][i] += weight * force[i];
      });
      for (std::size_t i = 0; i < 3; ++i) memory.pushes[i] += one.side->from == 0 ? force[i] : -force[i];
    });
  }

  void add_contact_potential(Factors /*factors*/, NodalRows u, const Row<double>* memory,
                             double& sum) const override {
    Rows<double> rows(memory, memory + this->memory());
    fix_contact(false, rows.data());
    ContactMemory copy(rows.data());
    for_each_resting(u, copy, 0.0, [&](const Resting& one) {
      const double depth = one.constant - one.plane.gap;
      sum += 0.5 * one.stiffness * depth * depth;
    });
    for_each_point(copy, [&](const Side& side, std::size_t k, Row<double>* of_point) {
      const double constant = of_point[1][constant_depth];
      sum -= 0.5 * stiffness_of(side, k) * constant * constant;
    });
  }

  void add_springs(Factors /*factors*/, NodalRows u, const Row<double>* memory,
                   std::vector<Spring>& springs) const override {
    Rows<double> rows(memory, memory + this->memory());
    ContactMemory copy(rows.data());
    for_each_resting(u, copy, just_fits * given_.reach, [&](const Resting& one) {
      Spring spring{{}, {}, 0, root_of(one.stiffness, one.plane.normal)};
      for_each_node(one, [&](int node, double weight) {
        spring.nodes[spring.size] = node;
        spring.weights[spring.size++] = static_cast<float>(weight);
      });
      springs.push_back(spring);
    });
  }

  void add_holds(std::vector<Hold>& holds) const override {
    const Rows<double> undeformed(1);
    const std::vector<int> first(at(*std::ranges::max_element(nodes())) + 1, 0);
    Rows<double> rows(memory());
    ContactMemory memory(rows.data());
    for_each_resting(
        NodalRows(undeformed.data(), first), memory, just_fits * given_.reach, [&](const Resting& one) {
          Hold& hold = holds.emplace_back(Hold{{}, one.plane.normal});
          for_each_node(one, [&](int node, double weight) { hold.mean_of.push_back({node, weight}); });
        });
  }

  void add_rates(Factors /*largest*/, const std::vector<double>& /*masses*/,
                 std::vector<LoadRates>& /*rates*/) const override {}

  void fix_contact(bool fixed, Row<double>* memory) const override {
    ContactMemory(memory).sums[3] = fixed ? 1.0 : 0.0;
  }

  bool correct_contact(Row<double>* rows) const override {
    ContactMemory memory(rows);
    bool any = false;
    for_each_point(memory, [&](const Side& /*side*/, std::size_t /*k*/, Row<double>* of_point) {
      if (any || of_point[1][contrary] == 0.0) return;
      of_point[0][strength] = 1.0 - of_point[0][strength];
      of_point[1][contrary] = 0.0;
      any = true;
    });
    return any;
  }

  bool augment(bool augmented, Row<double>* rows) const override {
    ContactMemory memory(rows);
    bool any = false;
    for_each_point(memory, [&](const Side& /*side*/, std::size_t /*k*/, Row<double>* of_point) {
      double& constant = of_point[1][constant_depth];
      const bool touches = augmented && of_point[0][strength] > 0.0;
      constant = touches ? std::max(of_point[1][depth_now] + constant, 0.0) : 0.0;
      any = any || constant > 0.0;
    });
    return any;
  }

 private:
  /// What points remember in their second row.
  enum OfRestingPoint : std::size_t { triangle = 0, contrary = 1, depth_now = 2, constant_depth = 3 };

  /// A point that touches.
  struct Resting {
    const Side* side;
    std::size_t k;  // the point
    int face;
    MovingSurface::Plane plane;
    double stiffness;  // N/m
    double constant;   // depth, m
  };

  double stiffness_of(const Side& side, std::size_t k) const {
    return 0.5 * stiffer_at_rest * given_.stiffness * surfaces_[side.from].points()[k].area;
  }

  /// Calls use(side, k, of_point) for all points.
  template <class Use>
  void for_each_point(ContactMemory& memory, const Use& use) const {
    for (const Side& side : sides_) {
      for (std::size_t k = 0; k < surfaces_[side.from].points().size(); ++k)
        use(side, k, of_point(memory, side, k));
    }
  }

  /// Calls use(node, weight) for the nodes that a force on a point acts on.
  template <class Use>
  void for_each_node(const Resting& one, const Use& use) const {
    const MovingSurface &from = surfaces_[one.side->from], &onto = surfaces_[one.side->onto];
    const SurfacePoint& point = from.points()[one.k];
    const Quadrilateral& corners = onto.corners(one.face);
    for (std::size_t I = 0; I < 4; ++I) {
      if (point.weights[I] != 0.0) use(from.nodes()[at(point.nodes[I])], point.weights[I]);
    }
    for (std::size_t I = 0; I < 4; ++I) use(onto.nodes()[at(corners[I])], -one.plane.weights[I]);
  }

  /// Calls use(resting) for all points that touch at displacements u (m), or whose contact is fixed. Points
  /// up to a margin (m) outside touch, too.
  template <class Use>
  void for_each_resting(NodalRows u, ContactMemory& memory, double margin, const Use& use) const {
    const double range = std::max(given_.reach, move(u, memory).largest_relative()),
                 way = memory.others[0][way_so_far];
    const bool fixed = memory.sums[3] != 0.0;
    memory.sums[2] = 0.0;
    bool fits = false;
    for_each_point(memory, [&](const Side& side, std::size_t k, Row<double>* of_point) {
      const MovingSurface &from = surfaces_[side.from], &onto = surfaces_[side.onto];
      const Row<double>*of_from = of_surface(memory, side.from), *of_onto = of_surface(memory, side.onto);
      const bool touched = of_point[0][strength] > 0.0;
      if (!touched && of_point[0][clear_until] > way + margin) return;
      const double constant = of_point[1][constant_depth], farthest = constant + margin;
      const SurfacePoint& point = from.points()[k];
      const Vector x = MovingSurface::position(point.nodes, point.weights, of_from);
      MovingSurface::Plane plane;
      auto face = static_cast<int>(of_point[0][touched_face]);
      auto of_face = static_cast<std::size_t>(of_point[1][triangle]);
      if (touched) plane = onto.plane_at(face, of_face, x, of_onto);
      bool inside = touched && plane.gap <= farthest, moved = false;
      if (!touched || plane.least < -overhang) {
        for (std::size_t s = 0; s < surfaces_.size() && !fits; ++s) surfaces_[s].fit(of_surface(memory, s));
        fits = true;
        const SurfaceFoot foot = onto.closest(x, from.normal(point.nodes, point.weights, of_from), range,
                                              side.neighbours[k], of_onto);
        of_point[0][clear_until] = foot.behind ? way : way + std::max(foot.distance() - constant, 0.0);
        moved = touched && (foot.face != face || foot.triangle != of_face);
        inside = false;
        if (foot.face >= 0) {
          const auto there = onto.plane_at(foot.face, foot.triangle, x, of_onto);
          inside = there.least >= -overhang && there.gap <= farthest &&
                   (foot.behind || foot.distance() <= farthest);
          if (!(fixed && touched)) {
            face = foot.face;
            of_face = foot.triangle;
            plane = there;
          }
        }
      }
      const bool touches = fixed ? touched : inside, is_contrary = touches != inside || (fixed && moved);
      of_point[1][contrary] = is_contrary ? 1.0 : 0.0;
      if (is_contrary) ++memory.sums[2];
      of_point[0][strength] = touches ? 1.0 : 0.0;
      if (face >= 0) {  // correct_contact may attach it
        of_point[0][touched_face] = face;
        of_point[1][triangle] = static_cast<double>(of_face);
      }
      if (!touches) return;
      of_point[1][depth_now] = -plane.gap;
      use(Resting{&side, k, face, plane, stiffness_of(side, k), constant});
    });
  }

  const std::shared_ptr<const SurfacePair> moving_;
};

}  // namespace

std::shared_ptr<const BodyForce> make_resting_pair(std::shared_ptr<const SurfacePair> pair) {
  const Contact& contact = pair->contact();
  const ForceTraits traits{Contact::name, false, contact.friction > 0.0, why_none(contact)};
  return std::make_shared<RestingPair>(std::move(pair), traits);
}

}  // namespace sandglass
