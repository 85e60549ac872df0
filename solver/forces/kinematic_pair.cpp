#include <algorithm>
#include <cmath>
#include <utility>

#include "forces/obstacle_shape.hpp"
#include "forces/surface_pair.hpp"

namespace sandglass {

namespace {

/// Points remember also the weights of the point of the face that they meet; the direction to it where the
/// step starts and their impulse along it, kg m; their impulse along the face, kg m; the direction to it
/// where the step ends, and the motion with which they may leave, m. Nodes remember how far the contact moves
/// them in this step, m. The strength of points that touch is one more than the number of the triangle of the
/// face.
class KinematicPair final : public SurfacePair {
 public:
  KinematicPair(const Contact& contact, SurfacesOfPair given, const NodalField& points,
                std::span<const Hexahedron> cells)
      : SurfacePair(contact, std::move(given), points, cells, 5, 1) {}

  bool moves_nodes() const override { return true; }

  void push_out(Factors factors, const NodalPush& nodes) const override {
    ContactMemory memory(nodes.memory);
    memory.pushes = memory.moves = {};
    const double friction_now = friction(factors);
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
      std::fill_n(of_nodes(memory, s), surfaces_[s].nodes().size(), Row<double>{});
    }
    double deepest = 0.0;
    const auto use = [&](const Side& side, std::size_t k, const Vector& x, const SurfaceFoot& foot) {
      Row<double>* remembered = of_point(memory, side, k);
      const bool is_new = remembered[0][strength] == 0.0;
      remembered[0][touched_face] = foot.face;
      remembered[0][strength] = 1.0 + static_cast<double>(foot.triangle);
      const Meeting meeting = meeting_of(side, k, memory);
      const auto [end, n] = MovingSurface::directions(
          foot, x, meeting.onto.corners_now(foot.face, meeting.of_onto), meeting.corners_before(nodes));
      remembered[4] = {{end[0], end[1], end[2], motion_to_leave(meeting, n, is_new, nodes)}};
      remembered[1] = weights_before(meeting, n, nodes);
      remembered[2] = {{n[0], n[1], n[2], is_new ? 0.0 : remembered[2][3]}};
      const Vector along{remembered[3][0], remembered[3][1], remembered[3][2]};
      const Vector kept = is_new ? Vector{} : sum(along, -dot(along, n), n);
      remembered[3] = {{kept[0], kept[1], kept[2]}};
      deepest = std::max(deepest, foot.distance());
    };
    for_each_touch(nodes.u, memory, use, [](Row<double>*) {});
    for_each_meeting(memory, [&](const Meeting& meeting) {  // as in the last step, to begin with
      push(meeting, meeting.impulse(), nodes);
      return 0.0;
    });
    constexpr int most_sweeps = 20;
    constexpr double resolved = 1e-3;
    for (int sweep = 0; sweep < most_sweeps && deepest > 0.0; ++sweep) {
      const double largest = for_each_meeting(
          memory, [&](const Meeting& meeting) { return separate(meeting, friction_now, nodes); });
      if (largest < resolved * deepest) break;
    }
    for_each_meeting(memory, [&](const Meeting& meeting) {
      turn(meeting, nodes);
      return 0.0;
    });
    settle_accounts(nodes, memory);
  }

  void add_contact(Factors /*factors*/, NodalRows /*u*/, Row<double>* /*rows*/,
                   AtNodes<Row<double>> /*forces*/) const override {}
  void add_rates(Factors /*largest*/, const std::vector<double>& /*masses*/,
                 std::vector<LoadRates>& /*rates*/) const override {}

 private:
  /// A point that touches, and the face.
  struct Meeting {
    const MovingSurface &from, &onto;
    const SurfacePoint& point;
    const Quadrilateral& corners;
    const Row<double>& weights;  // of the corners
    Row<double>&normal, &along;  // with the impulses
    const Row<double>& end;      // normal, with the motion to leave
    Row<double>*of_from, *of_onto, *nodes_from, *nodes_onto;

    std::size_t triangle;  // of the face

    Vector direction() const { return {normal[0], normal[1], normal[2]}; }
    Vector direction_at_end() const { return {end[0], end[1], end[2]}; }
    Vector impulse() const { return sum({along[0], along[1], along[2]}, normal[3], direction()); }

    std::array<Vector, 4> corners_before(const NodalPush& step) const {
      std::array<Vector, 4> x;
      for (std::size_t I = 0; I < 4; ++I) x[I] = before(onto, of_onto, corners[I], step);
      return x;
    }

    /// Where a node of a surface is before the step, m.
    static Vector before(const MovingSurface& surface, const Row<double>* rows, int place,
                         const NodalPush& step) {
      const Row<double>&x = rows[place], &increment = step.increment[surface.nodes()[at(place)]];
      return {x[0] - increment[0], x[1] - increment[1], x[2] - increment[2]};
    }

    /// Calls use(node, place, weight, rows of its surface, rows of nodes) for all nodes of both.
    template <class Use>
    void for_each_node(const Use& use) const {
      for (std::size_t I = 0; I < 4; ++I) {
        const std::size_t place = at(point.nodes[I]);
        if (point.weights[I] != 0.0) use(from.nodes()[place], place, point.weights[I], of_from, nodes_from);
      }
      for (std::size_t I = 0; I < 4; ++I) {
        const std::size_t place = at(corners[I]);
        use(onto.nodes()[place], place, -weights[I], of_onto, nodes_onto);
      }
    }
  };

  /// The largest of use(meeting) for all points that touch.
  template <class Use>
  double for_each_meeting(ContactMemory& memory, const Use& use) const {
    double largest = 0.0;
    for (const Side& side : sides_) {
      for (std::size_t k = 0; k < surfaces_[side.from].points().size(); ++k) {
        if (of_point(memory, side, k)[0][strength] == 0.0) continue;
        largest = std::max(largest, use(meeting_of(side, k, memory)));
      }
    }
    return largest;
  }

  Meeting meeting_of(const Side& side, std::size_t k, ContactMemory& memory) const {
    const MovingSurface &from = surfaces_[side.from], &onto = surfaces_[side.onto];
    Row<double>* remembered = of_point(memory, side, k);
    return {from,
            onto,
            from.points()[k],
            onto.corners(static_cast<int>(remembered[0][touched_face])),
            remembered[1],
            remembered[2],
            remembered[3],
            remembered[4],
            of_surface(memory, side.from),
            of_surface(memory, side.onto),
            of_nodes(memory, side.from),
            of_nodes(memory, side.onto),
            static_cast<std::size_t>(remembered[0][strength]) - 1};
  }

  /// The weights of the point of the face that was in a direction from the point before the step: an impulse
  /// along it has no moment.
  static Row<double> weights_before(const Meeting& meeting, const Vector& direction, const NodalPush& nodes) {
    Vector x{};
    for (std::size_t I = 0; I < 4; ++I) {
      x = sum(x, meeting.point.weights[I],
              Meeting::before(meeting.from, meeting.of_from, meeting.point.nodes[I], nodes));
    }
    return MovingSurface::weights_along(meeting.corners_before(nodes), meeting.triangle, x, direction);
  }

  /// Moves a node by its share of an impulse, kg m: its displacement, its position `x` on the surface and how
  /// far the contact `moved` it, m.
  static void push(int node, double weight, const Vector& impulse, const NodalPush& nodes, Row<double>& x,
                   Row<double>& moved) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double by = weight * nodes.inverse_masses[node][i] * impulse[i];
      for (Row<double>* row : {&nodes.u[node], &nodes.increment[node], &x, &moved}) (*row)[i] += by;
    }
  }

  /// Moves the impulse on the face to where it has no moment with friction either.
  static void turn(const Meeting& meeting, const NodalPush& nodes) {
    const Vector impulse = meeting.impulse();
    if (meeting.along.x == Row<double>{}.x) return;
    const Row<double> there = weights_before(meeting, impulse, nodes);
    for (std::size_t I = 0; I < 4; ++I) {
      const int place = meeting.corners[I], node = meeting.onto.nodes()[at(place)];
      push(node, meeting.weights[I] - there[I], impulse, nodes, meeting.of_onto[place],
           meeting.nodes_onto[place]);
    }
  }

  /// Moves the nodes of a point and of the face that it touches by an impulse, kg m.
  static void push(const Meeting& meeting, const Vector& impulse, const NodalPush& nodes) {
    meeting.for_each_node([&](int node, std::size_t place, double weight, Row<double>* x, Row<double>* rows) {
      push(node, weight, impulse, nodes, x[place], rows[place]);
    });
  }

  /// The share of the speed at which a point meets the face with which it may leave. Points that touched in
  /// the last step may not: under a lasting load they would oscillate from step to step, and lose force.
  static constexpr double returned = 0.5;

  /// The share of its depth by which such a point leaves in a step beyond that: a depth does not last.
  static constexpr double recovered = 0.02;

  /// The motion (m) along n with which a point may leave the face in this step, from that in the last.
  static double motion_to_leave(const Meeting& meeting, const Vector& n, bool is_new,
                                const NodalPush& nodes) {
    Vector last{};
    meeting.for_each_node([&](int node, std::size_t, double weight, const Row<double>*, Row<double>*) {
      for (std::size_t i = 0; i < 3; ++i) last[i] += weight * nodes.last[node][i];
    });
    const double arrived = dot(last, n);
    if (arrived >= 0.0) return arrived;
    return is_new ? returned * arrived : 0.0;
  }

  /// Changes the impulse of a point so that it is on the face. Returns by how much it moves, m.
  double separate(const Meeting& meeting, double friction, const NodalPush& nodes) const {
    const Vector n = meeting.direction(), end = meeting.direction_at_end();
    Vector apart{}, motion{};
    double along_n = 0.0, mobility = 0.0;  // 1/kg, of an impulse along n, and in the mean
    meeting.for_each_node(
        [&](int node, std::size_t place, double weight, const Row<double>* x, Row<double>*) {
          const Row<double>&w = nodes.inverse_masses[node], &increment = nodes.increment[node];
          for (std::size_t i = 0; i < 3; ++i) {
            apart[i] += weight * x[place][i];
            motion[i] += weight * increment[i];
            along_n += weight * weight * w[i] * n[i] * end[i];
            mobility += weight * weight * w[i] / 3.0;
          }
        });
    if (!(along_n > 0.0)) return 0.0;
    double& impulse = meeting.normal[3];
    const double inside = dot(apart, end), leaves = meeting.end[3];
    const double before = std::exchange(
        impulse,
        std::max(0.0, impulse - std::max(inside, dot(motion, n) + leaves + recovered * inside) / along_n));
    Vector change = sum({}, impulse - before, n);
    if (contact_.friction > 0.0) {
      const Vector old{meeting.along[0], meeting.along[1], meeting.along[2]};
      Vector held = sum(old, -1.0 / mobility, sum(motion, -dot(motion, n), n));
      const double size = std::sqrt(dot(held, held)), most = friction * impulse;
      if (size > most) held = sum({}, most / size, held);
      change = sum(change, 1.0, difference(held, old));
      meeting.along = {{held[0], held[1], held[2]}};
    }
    push(meeting, change, nodes);
    return std::abs(impulse - before) * along_n;
  }

  /// The force on a node is its mass times the change of velocity over the step.
  void settle_accounts(const NodalPush& nodes, ContactMemory& memory) const {
    double farthest = 0.0;
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
      const Row<double>* moved = of_nodes(memory, s);
      for (std::size_t n = 0; n < surfaces_[s].nodes().size(); ++n) {
        const Row<double>& w = nodes.inverse_masses[surfaces_[s].nodes()[n]];
        for (std::size_t i = 0; i < 3; ++i) {
          if (!(w[i] > 0.0)) continue;
          if (s == 0 && surfaces_.size() > 1) memory.pushes[i] += moved[n][i] / (w[i] * nodes.gain);
          farthest = std::max(farthest, std::abs(moved[n][i]));
        }
      }
    }
    memory.others[0][way_so_far] += 2.0 * std::sqrt(3.0) * farthest;
    memory.moves[3] = for_each_meeting(memory, [](const Meeting& meeting) {  // what is left
      double apart = 0.0;
      meeting.for_each_node([&](int, std::size_t place, double weight, const Row<double>* x, Row<double>*) {
        for (std::size_t i = 0; i < 3; ++i) apart -= weight * x[place][i] * meeting.end[i];
      });
      return apart;
    });
  }
};

}  // namespace

std::shared_ptr<SurfacePair> make_kinematic_pair(const Contact& contact, SurfacesOfPair given,
                                                 const NodalField& points,
                                                 std::span<const Hexahedron> cells) {
  return std::make_shared<KinematicPair>(contact, std::move(given), points, cells);
}

}  // namespace sandglass
