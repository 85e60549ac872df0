#include "forces/surface_pair.hpp"

namespace sandglass {

namespace {

/// By how much of its height a triangle extends beyond its edges. Points keep their triangle that far, so
/// that none alternates between two triangles. In the answer they would lag behind where they slid: when the
/// contact is augmented, those that are clearly beyond choose the nearest triangle.
constexpr double overhang = 0.1, clearly_beyond = 1e-3;

/// The largest cosine of the normals of a point and of a face that it touches. Sides of a body may lean over
/// points below its edge by more than a right angle; beside a sharp edge, normals are mean values.
constexpr double opposed = -0.3;

/// Points that just fit are linearized as touching, up to this share of the shortest edge.
constexpr double just_fits = 1e-6;

std::string_view why_none(const Contact& contact) {
  if (contact.other.empty()) return "a surface touches itself in motions only";
  return contact.friction > 0.0 ? path_of_friction : "";
}

/// The force of a point that touches a triangle is along its normal, in proportion to the depth behind its
/// plane: the derivative of an energy, and without moment. Points remember also their triangle, how they
/// would touch if that were not fixed, and contrary, their depth and the depth of their constant force, m.
/// With friction also three rows of the last load level: the weights of the point of the other surface from
/// which they slip; its face and their gap there, m; the extension of their spring along the surface, m.
class RestingPair final : public SurfacePair {
 public:
  RestingPair(std::shared_ptr<const SurfacePair> moving, const ForceTraits& traits)
      : SurfacePair(*moving, moving->contact().friction > 0.0 ? 5 : 2, traits), moving_(std::move(moving)) {
    if (rubs()) start_ = undeformed([&](NodalRows u, Row<double>* rows) { note_places(0.0, u, rows); });
  }

  bool remembers_path() const override { return rubs() && !contact_.other.empty(); }

  std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const override {
    const auto inside = std::static_pointer_cast<const SurfacePair>(moving_->restricted_to(part));
    return inside ? make_resting_pair(inside) : nullptr;
  }
  std::shared_ptr<const BodyForce> at_rest() const override { return nullptr; }
  std::shared_ptr<const BodyForce> in_motion() const override { return moving_; }

  void add_contact(Factors factors, NodalRows u, Row<double>* rows,
                   AtNodes<Row<double>> forces) const override {
    ContactMemory memory(rows);
    memory.pushes = memory.moves = {};
    for_each_resting(friction(factors), u, memory, 0.0, [&](const Resting& one) {
      const double depth = -one.plane.gap;
      memory.pushes[3] += 0.5 * one.stiffness * depth * (depth + 2.0 * one.constant);
      memory.moves[3] = std::max(memory.moves[3], depth);
      Vector along = one.along;
      if (one.slips()) slip(along, one.most);
      memory.pushes[3] += 0.5 * one.stiffness * dot(along, along);
      const Vector force =
          sum(sum({}, one.stiffness * (depth + one.constant), one.plane.normal), -one.stiffness, along);
      for_each_node(one, [&](int node, double weight) {
        for (std::size_t i = 0; i < 3; ++i) forces[node][i] += weight * force[i];
      });
      for (std::size_t i = 0; i < 3; ++i) memory.pushes[i] += one.side->from == 0 ? force[i] : -force[i];
    });
  }

  /// With friction that of a slip under constant pressure.
  void add_contact_potential(Factors factors, NodalRows u, const Row<double>* memory,
                             double& sum) const override {
    Rows<double> rows(memory, memory + this->memory());
    fix_contact(Fixing::none, rows.data());
    ContactMemory copy(rows.data());
    for_each_resting(friction(factors), u, copy, 0.0, [&](const Resting& one) {
      const double depth = one.constant - one.plane.gap;
      sum += one.stiffness * (0.5 * depth * depth + rubbed(length(one.along), one.most));
    });
    for_each_point(copy, [&](const Side& side, std::size_t k, Row<double>* of_point) {
      const double constant = of_point[1][constant_depth];
      sum -= 0.5 * stiffness_of(side, k) * constant * constant;
    });
  }

  void add_springs(Factors factors, NodalRows u, const Row<double>* memory,
                   std::vector<Spring>& springs) const override {
    Rows<double> rows(memory, memory + this->memory());
    ContactMemory copy(rows.data());
    const double friction_now = friction(factors);
    for_each_resting(friction_now, u, copy, just_fits * given_.reach, [&](const Resting& one) {
      Spring spring{{}, {}, 0, root_of(one.stiffness, one.plane.normal)};
      for_each_node(one, [&](int node, double weight) {
        spring.nodes[spring.size] = node;
        spring.weights[spring.size++] = static_cast<float>(weight);
      });
      if (!rubs()) return springs.push_back(spring);
      add_with_friction(spring, one.stiffness, one.plane.normal, one.along, one.most, one.slips(),
                        friction_now, springs);
    });
  }

  void end_level(Factors factors, NodalRows u, bool /*may_shorten*/, Row<double>* rows) const override {
    ContactMemory memory(rows);
    for_each_point(memory, [&](const Side& side, std::size_t k, const Row<double>* of_point) {
      if (of_point[0][strength] == not_at_all || of_point[1][contrary] != 0.0) return;
      if (of_point[1][depth_now] < given_.reach) return;
      memory.note_passed(node_of(surfaces_[side.from], surfaces_[side.from].points()[k]));
    });
    if (rubs()) note_places(friction(factors), u, rows);
  }

  void add_holds(std::vector<Hold>& holds) const override {
    undeformed([&](NodalRows u, Row<double>* rows) {
      ContactMemory memory(rows);
      for_each_resting(0.0, u, memory, just_fits * given_.reach, [&](const Resting& one) {
        std::vector<Tie::Share> mean_of;
        for_each_node(one, [&](int node, double weight) { mean_of.push_back({node, weight}); });
        hold_point(mean_of, one.plane.normal, rubs(), holds);
      });
    });
  }

  void add_rates(Factors /*largest*/, const std::vector<double>& /*masses*/,
                 std::vector<LoadRates>& /*rates*/) const override {}

  void fix_contact(Fixing fixing, Row<double>* memory) const override {
    ContactMemory(memory).sums[3] = fixing == Fixing::all ? 1.0 : 0.0;
  }

  bool correct_contact(Row<double>* rows) const override {
    ContactMemory memory(rows);
    bool any = false;
    for_each_point(memory, [&](const Side& /*side*/, std::size_t /*k*/, Row<double>* of_point) {
      if (any || of_point[1][contrary] == 0.0) return;
      of_point[0][strength] = of_point[1][contrary] - 1.0;
      of_point[1][contrary] = 0.0;
      any = true;
    });
    return any;
  }

  /// Once only: points of both surfaces without any depth would be more conditions than nodes can satisfy.
  bool augment(Augmentation augmentation, Row<double>* rows) const override {
    ContactMemory memory(rows);
    if (augmentation == Augmentation::further) return false;
    bool any = false;
    for_each_point(memory, [&](const Side& /*side*/, std::size_t /*k*/, Row<double>* of_point) {
      double& constant = of_point[1][constant_depth];
      const bool touches = augmentation == Augmentation::first && of_point[0][strength] > 0.0;
      constant = touches ? std::max(of_point[1][depth_now] + constant, 0.0) : 0.0;
      any = any || constant > 0.0;
    });
    memory.others[0][chooses_again] = any ? 1.0 : 0.0;
    return any;
  }

 private:
  /// What the pair remembers besides: whether the next evaluation that is not fixed chooses triangles again.
  enum OfRestingPair : std::size_t { chooses_again = 3 };

  /// What points remember in their second row.
  enum OfRestingPoint : std::size_t { triangle = 0, contrary = 1, depth_now = 2, constant_depth = 3 };

  /// With friction in their third to fifth row. Faces count from one; zero: nothing is remembered yet;
  /// -1: the other surface was far away.
  enum OfPlace : std::size_t { weights_of_place = 2, place = 3, stretch = 4 };
  enum OfFace : std::size_t { face_of_place = 0, gap_before = 1 };

  /// A point that touches.
  struct Resting {
    const Side* side;
    std::size_t k;  // the point
    int face;
    MovingSurface::Plane plane;
    double stiffness;  // N/m
    double constant;   // depth, m
    double touches;    // how
    Vector x;          // m
    Vector along;      // extension of its spring along the surface before it slips, m
    double most;       // and what friction leaves of it, m

    bool slips() const { return touches == slipping && length(along) > most; }
  };

  bool rubs() const { return contact_.friction > 0.0; }

  /// The rows after use(u, rows) at no displacements.
  template <class Use>
  Rows<double> undeformed(const Use& use) const {
    const Rows<double> none(1);
    const std::vector<int> first(at(*std::ranges::max_element(nodes())) + 1, 0);
    Rows<double> rows(memory());
    use(NodalRows(none.data(), first), rows.data());
    return rows;
  }

  /// With friction, points begin at their places in the undeformed body.
  void begin(ContactMemory& memory) const {
    if (start_.empty() || of_point(memory, sides_.front(), 0)[place][face_of_place] != 0.0) return;
    Rows<double> rows = start_;
    ContactMemory start(rows.data());
    for_each_point(memory, [&](const Side& side, std::size_t k, Row<double>* one) {
      std::copy_n(of_point(start, side, k) + weights_of_place, 3, one + weights_of_place);
    });
  }

  /// The extension (m) along the surface of the spring of a point at x (m) that touches: its way relative to
  /// the other surface since the last load level, or since they met if it was outside.
  Vector extension(const Side& side, const Vector& x, const MovingSurface::Plane& plane,
                   const Row<double>* of_point, const Row<double>* of_onto) const {
    if (!rubs()) return {};
    const auto face = static_cast<int>(of_point[place][face_of_place]) - 1;
    if (face < 0) return {};
    const MovingSurface& onto = surfaces_[side.onto];
    const Vector from = MovingSurface::position(onto.corners(face), of_point[weights_of_place], of_onto);
    return way_along(difference(x, from), plane.normal, plane.gap, of_point[place][gap_before]);
  }

  /// Remembers the place of each point on the other surface from which it slips in the next load level.
  void note_places(double friction_now, NodalRows u, Row<double>* rows) const {
    ContactMemory memory(rows);
    for_each_resting(friction_now, u, memory, 0.0, [&](const Resting& one) {
      Row<double>* of_point = this->of_point(memory, *one.side, one.k);
      Vector along = one.along;
      memory.sums[0] += one.stiffness * slip(along, one.most, of_point[stretch]);
      const Row<double>* of_onto = of_surface(memory, one.side->onto);
      const auto plane = surfaces_[one.side->onto].plane_at(
          one.face, static_cast<std::size_t>(of_point[1][triangle]), difference(one.x, along), of_onto);
      of_point[weights_of_place] = plane.weights;
      of_point[place] = {{1.0 + one.face, 0.0, 0.0, 0.0}};
      of_point[stretch] = {{along[0], along[1], along[2], 0.0}};
    });
    for (std::size_t s = 0; s < surfaces_.size(); ++s) surfaces_[s].fit(of_surface(memory, s));
    for_each_point(memory, [&](const Side& side, std::size_t k, Row<double>* of_point) {
      if (of_point[0][strength] != not_at_all) return;
      const MovingSurface &from = surfaces_[side.from], &onto = surfaces_[side.onto];
      const Row<double>*of_from = of_surface(memory, side.from), *of_onto = of_surface(memory, side.onto);
      const SurfacePoint& point = from.points()[k];
      const Vector x = MovingSurface::position(point.nodes, point.weights, of_from);
      const SurfaceFoot foot = onto.closest(x, from.normal(point.nodes, point.weights, of_from), opposed,
                                            given_.reach, side.neighbours[k], of_onto);
      memory.sums[0] += stiffness_of(side, k) * lost(of_point[stretch]);
      of_point[stretch] = {};
      of_point[place] = {{-1.0, 0.0, 0.0, 0.0}};
      if (foot.face < 0) return;
      const auto plane = onto.plane_at(foot.face, foot.triangle, x, of_onto);
      of_point[weights_of_place] = plane.weights;
      of_point[place] = {{1.0 + foot.face, plane.gap, 0.0, 0.0}};
    });
  }

  double stiffness_of(const Side& side, std::size_t k) const {
    return 0.5 * given_.stiffness * surfaces_[side.from].points()[k].area;
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
  void for_each_resting(double friction_now, NodalRows u, ContactMemory& memory, double margin,
                        const Use& use) const {
    begin(memory);
    move(u, memory);
    const double way = memory.others[0][way_so_far];
    const bool fixed = memory.sums[3] != 0.0;
    const bool anew = !fixed && std::exchange(memory.others[0][chooses_again], 0.0) != 0.0;
    const double kept = anew ? clearly_beyond : overhang;
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
      MovingSurface::Plane plane{};
      auto face = static_cast<int>(of_point[0][touched_face]);
      auto of_face = static_cast<std::size_t>(of_point[1][triangle]);
      if (touched) plane = onto.plane_at(face, of_face, x, of_onto);
      bool inside = touched && plane.gap <= farthest, moved = false;
      if (!touched || plane.least < -kept || plane.gap < -given_.reach) {
        for (std::size_t s = 0; s < surfaces_.size() && !fits; ++s) surfaces_[s].fit(of_surface(memory, s));
        fits = true;
        const SurfaceFoot foot = onto.closest(x, from.normal(point.nodes, point.weights, of_from), opposed,
                                              given_.reach, side.neighbours[k], of_onto);
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
      Vector along{};
      if (inside || touched) along = extension(side, x, plane, of_point, of_onto);
      const double most = friction_now * std::max(constant - plane.gap, 0.0);
      const double free = !inside ? not_at_all : rubs() && length(along) > most ? slipping : sticking;
      const double touches = fixed ? of_point[0][strength] : free;
      const bool jumped = fixed && moved;
      of_point[1][contrary] = !agrees(touches, free) ? 1.0 + free : jumped ? 1.0 + not_at_all : 0.0;
      if (of_point[1][contrary] != 0.0) ++memory.sums[2];
      of_point[0][strength] = touches;
      if (face >= 0) {  // correct_contact may attach it
        of_point[0][touched_face] = face;
        of_point[1][triangle] = static_cast<double>(of_face);
      }
      if (touches == not_at_all) return;
      of_point[1][depth_now] = -plane.gap;
      use(Resting{&side, k, face, plane, stiffness_of(side, k), constant, touches, x, along, most});
    });
  }

  const std::shared_ptr<const SurfacePair> moving_;
  Rows<double> start_;  // with friction the rows of the undeformed body
};

}  // namespace

std::shared_ptr<const BodyForce> make_resting_pair(std::shared_ptr<const SurfacePair> pair) {
  const Contact& contact = pair->contact();
  const ForceTraits traits{Contact::name, false, contact.friction > 0.0, why_none(contact)};
  return std::make_shared<RestingPair>(std::move(pair), traits);
}

}  // namespace sandglass
