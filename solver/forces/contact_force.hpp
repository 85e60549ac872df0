#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "forces/body_force.hpp"
#include "math/spring.hpp"
#include "mesh/vectors.hpp"

namespace sandglass {

/// How a body and an obstacle, or two surfaces of a body, touched at an evaluation.
struct Touch {
  std::string_view name = {};  ///< of the obstacle or of the pair
  Vector force = {};           ///< on the body, or on the first surface, N
  Vector moved = {};           ///< displacement of the obstacle on which this force works, m
  double depth = 0.0;          ///< the largest of a node, m
  double stored = 0.0;         ///< energy of the contact, J
  double dissipated = 0.0;     ///< since the start, J; zero if it moves nodes: see Loads::lost_by_pushes
  double worked = 0.0;         ///< by an obstacle that moves nodes, since the start, J
  int contrary = 0;            ///< nodes whose fixed contact pulls them, or lets them penetrate
  int passed = -1;             ///< a node that may have passed through since the start; -1: none
  std::optional<Vector> moment = {};  ///< of the force of an obstacle, about its point where it is, N m
};

/// The rows that every contact keeps, before its own.
struct ContactMemory {
  Row<double>& pushes;  ///< force as in Touch, N; stored energy, J
  Row<double>& moves;   ///< displacement of the obstacle, m; largest depth, m
  Row<double>& sums;    ///< dissipated energy and work since the start, J; contrary nodes; whether fixed
  Row<double>& turns;   ///< moment as in Touch, N m; one more than a node that may have passed through
  Row<double>* others;

  static constexpr std::size_t own = 4;
  explicit ContactMemory(Row<double>* rows)
      : pushes(rows[0]), moves(rows[1]), sums(rows[2]), turns(rows[3]), others(rows + own) {}

  void note_passed(int node) { turns[3] = 1.0 + static_cast<double>(node); }

  /// Forgets the forces of the last evaluation.
  void clear_forces() {
    pushes = {};
    for (std::size_t i = 0; i < 3; ++i) turns[i] = 0.0;
  }

  /// Adds the force (N) on a node at a place relative to the point of the obstacle, m.
  void add_force(const Vector& force, const Vector& arm) {
    const Vector moment = cross(arm, force);
    for (std::size_t i = 0; i < 3; ++i) {
      pushes[i] += force[i];
      turns[i] += moment[i];
    }
  }
};

inline Touch touch_of(std::string_view name, const Row<double>* memory) {
  const Row<double>&pushes = memory[0], &moves = memory[1], &sums = memory[2], &turns = memory[3];
  return {name,
          {pushes[0], pushes[1], pushes[2]},
          {moves[0], moves[1], moves[2]},
          moves[3],
          pushes[3],
          sums[0],
          sums[1],
          static_cast<int>(sums[2]),
          static_cast<int>(turns[3]) - 1};
}

/// The share of the depth that a contact can follow from which no step leads to the outside, and up to which
/// a node may cut a corner of an obstacle within a step.
constexpr double deep = 0.8, shallow = 0.1;

/// The square of the frequency that steps must allow for over that of a spring that only pushes: it returns a
/// node with more than its energy if the step ends its contact too late. With steps of 1.8 over its
/// frequency, twice in the mean, of 0.9, 1.015 times, of 0.6, 1.001 times.
constexpr double rate_of_one_sided = 9.0;

/// How a point touches in static equilibrium, in its rows; without friction it sticks.
constexpr double not_at_all = 0.0, sticking = 1.0, slipping = 2.0;

/// What evaluations in static equilibrium do not decide. All: which nodes touch, as at the last evaluation,
/// and which of them may slip; fixed contact is a spring that pushes and pulls, so that forces are a smooth
/// function of displacements. Friction: all nodes that touch stick, as before a load moves them; if they
/// slipped along an obstacle that moved ahead of them, too deep in them, friction would throw them.
enum class Fixing { none, all, friction };

/// Of contact in static equilibrium: none, or for the first time in a search, or again.
enum class Augmentation { none, first, further };

/// Whether a point that is fixed to touch so may stay, as it would touch if it were `free`. One that may slip
/// sticks where friction holds it: if it always slipped, its force would turn around as its spring shortens.
constexpr bool agrees(double fixed, double free) {
  return fixed == free || (fixed == slipping && free == sticking);
}

constexpr std::string_view path_of_friction = "friction depends on the path";

/// Two directions of length one at right angles to a third.
inline std::array<Vector, 2> tangents_of(const Vector& normal) {
  Vector axis{};
  axis[std::abs(normal[0]) < 0.6 ? 0 : 1] = 1.0;
  const Vector t = cross(normal, axis);
  const Vector first = sum({}, 1.0 / length(t), t);
  return {first, cross(normal, first)};
}

/// Adds a spring of contact along a normal, and with friction those along the surface: of the same stiffness
/// (N/m) if it sticks; if it slips, none along its extension (m), of which friction leaves `most`.
inline void add_with_friction(Spring spring, double stiffness, const Vector& normal, const Vector& along,
                              double most, bool slips, double friction, std::vector<Spring>& springs) {
  const double size = length(along);
  spring.root = root_of(stiffness, normal);
  if (slips && size > 0.0) {
    for (std::size_t i = 0; i < 3; ++i) spring.drag[i] = static_cast<float>(friction / size * along[i]);
    springs.push_back(spring);
    spring.drag = {};
    spring.root = root_of(stiffness * std::min(1.0, most / size), sum({}, 1.0 / size, cross(normal, along)));
    springs.push_back(spring);
    return;
  }
  springs.push_back(spring);
  for (const Vector& t : tangents_of(normal)) {
    spring.root = root_of(stiffness, t);
    springs.push_back(spring);
  }
}

/// Adds the hold of a point (its nodes and weights) along a normal, with friction also along the surface.
inline void hold_point(const std::vector<Tie::Share>& mean_of, const Vector& normal, bool friction,
                       std::vector<Hold>& holds) {
  holds.push_back({mean_of, normal});
  if (!friction) return;
  for (const Vector& t : tangents_of(normal)) holds.push_back({mean_of, t});
}

/// The part along a surface of the way (m) of a point to where it touches with a gap (m); if the gap was
/// positive before, only since they met.
inline Vector way_along(const Vector& way, const Vector& normal, double gap, double gap_before) {
  const double share = gap_before > 0.0 ? std::clamp(gap / (gap - gap_before), 0.0, 1.0) : 1.0;
  return sum({}, share, sum(way, -dot(way, normal), normal));
}

/// The potential per stiffness (m^2) of a spring along a surface that would be extended by `size` (m), of
/// which friction under constant pressure leaves `most`.
inline double rubbed(double size, double most) {
  const double held = std::min(size, most);
  return held * (size - 0.5 * held);
}

/// Half the square of an extension, m^2: the energy that is lost per stiffness where a spring lets go.
inline double lost(const Row<double>& stretch) {
  return 0.5 * (stretch[0] * stretch[0] + stretch[1] * stretch[1] + stretch[2] * stretch[2]);
}

/// Lets friction shorten the extension (m) of a spring along a surface to `most`, from that before. Returns
/// what it dissipates per stiffness, m^2: the mean of two forces times the slip, as in the time loop.
inline double slip(Vector& along, double most, const Row<double>& before = {}) {
  const double size = std::sqrt(dot(along, along));
  if (!(size > most)) return 0.0;
  double dissipated = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double held = most / size * along[i];
    dissipated += 0.5 * (before[i] + held) * (along[i] - held);
    along[i] = held;
  }
  return dissipated;
}

/// An obstacle that a program may move, and the first of the three curves that are its displacement (m).
struct Movable {
  std::string_view name;
  std::size_t first_curve;
};

/// Nodes that an obstacle may move back onto itself within a step.
struct NodalPush {
  AtNodes<Row<double>> u, increment;          ///< m
  AtNodes<const Row<double>> last;            ///< increment of the last step, m; zero in the first
  AtNodes<const Row<double>> inverse_masses;  ///< 1/kg, zero on constrained components
  double gain;                                ///< s^2: a force adds gain / mass to the increment
  Row<double>* memory;
};

/// The force of an obstacle or between two surfaces, which acts where they touch. It is not linear in the
/// factors of its curve. It keeps rows of numbers, zeros at the start, from one evaluation to the next;
/// another evaluation of the same motion does not change them.
class ContactForce : public BodyForce {
 public:
  /// The number of these rows.
  virtual std::size_t memory() const = 0;

  /// Adds its forces, N.
  virtual void add_contact(Factors factors, NodalRows u, Row<double>* memory,
                           AtNodes<Row<double>> forces) const = 0;

  /// Whether it moves nodes within steps instead of adding forces.
  virtual bool moves_nodes() const { return false; }

  /// Moves nodes back onto it.
  virtual void push_out(Factors /*factors*/, const NodalPush& /*nodes*/) const {}

  /// How far nodes may be inside of it and still be pushed back to where they came from, m.
  virtual double half_thickness() const = 0;

  /// The longest way (m) that it moves while the factors of curves change by at most so much.
  virtual double travel(Factors changes) const = 0;

  /// How a program may move it; none: not at all.
  virtual std::optional<Movable> movable() const { return std::nullopt; }

  /// How the body touches it, from these rows.
  virtual Touch touch(const Row<double>* memory) const = 0;

  /// See Fixing.
  virtual void fix_contact(Fixing /*fixing*/, Row<double>* /*memory*/) const {}

  /// Frees or attaches one node whose fixed contact was contrary at the last evaluation; false if there is
  /// none.
  virtual bool correct_contact(Row<double>* /*memory*/) const { return false; }

  /// Augments it, for the first time in this search or again: the forces of this evaluation become constant
  /// forces of the nodes that touch, beside those of their further depths; or ends that. In the next
  /// equilibrium they penetrate less. Returns whether it is augmented now.
  virtual bool augment(Augmentation /*augmentation*/, Row<double>* /*memory*/) const { return false; }

  /// Whether its forces in static equilibrium depend on the load levels before.
  virtual bool remembers_path() const { return false; }

  /// At the end of a load level, in the equilibrium of the last evaluation: from here friction follows the
  /// next one. If the level may be shortened, nodes that came around a corner count as passed.
  virtual void end_level(Factors /*factors*/, NodalRows /*u*/, bool /*may_shorten*/,
                         Row<double>* /*memory*/) const {}

  /// Adds the potential (J) with these forces.
  virtual void add_contact_potential(Factors factors, NodalRows u, const Row<double>* memory,
                                     double& sum) const = 0;

  /// Moves touching nodes along its normal so that displacements from those of `before` change their depth as
  /// on a plane: nodes slide along curved obstacles.
  virtual void slide(Factors /*factors*/, NodalRows /*before*/, const Row<double>* /*memory*/,
                     AtNodes<Row<double>> /*u*/) const {}

  /// Adds the springs that its stiffness consists of where the body touches it now, by numbers of nodes.
  virtual void add_springs(Factors factors, NodalRows u, const Row<double>* memory,
                           std::vector<Spring>& springs) const = 0;

  /// The force that takes its place in static equilibrium, or in motions; none: it is the same.
  virtual std::shared_ptr<const BodyForce> at_rest() const { return nullptr; }
  virtual std::shared_ptr<const BodyForce> in_motion() const { return nullptr; }

  /// The body was moved to static equilibrium and stopped there, with this force (N) and moment (N m) on it:
  /// sets the rows such that the next step of a motion is the first.
  virtual void begin_again(const Vector& force, const Vector& moment, Row<double>* memory) const {
    for (std::size_t i = 0; i < 3; ++i) {
      memory[0][i] = force[i];
      memory[3][i] = moment[i];
    }
  }

  /// As without friction.
  void add_forces(Factors factors, const NodalMotion& motion, AtNodes<Row<double>> forces) const final {
    std::vector<Row<double>> rows(memory());
    add_contact(factors, motion.u, rows.data(), forces);
  }
  void add_potential(Factors factors, NodalRows u, double& sum) const final {
    const std::vector<Row<double>> rows(memory());
    add_contact_potential(factors, u, rows.data(), sum);
  }
  void add_derivatives_of_power(Factors, const NodalMotion&, NodalRows, AtNodes<Row<double>>,
                                AtNodes<Row<double>>) const final {
    refuse_derivatives("");
  }
  void add_slopes(Factors /*factors*/, const ShapeSlopes& /*shape*/) const final {
    refuse_derivatives(" by positions of nodes");
  }
  void add_stiffness(AtNodes<Row<float>> /*diagonal*/) const final {}
  void add_size(double /*arm*/, double& /*sum*/) const final {}
  std::span<const NodalLoad> dead_loads() const final { return {}; }

 protected:
  using BodyForce::BodyForce;

 private:
  [[noreturn]] void refuse_derivatives(std::string_view by) const {
    throw InputError(
        fmt::format("derivatives: [[{}]] has none{}; allowed: a case without it", traits().name, by));
  }
};

/// Those among the forces on a body.
inline std::vector<const ContactForce*> contacts_of(const BodyForces& forces) {
  std::vector<const ContactForce*> contacts;
  for (const auto& force : forces) {
    if (const auto* contact = dynamic_cast<const ContactForce*>(force.get())) contacts.push_back(contact);
  }
  return contacts;
}

/// Whether the forces on a body in static equilibrium depend on the load levels before.
inline bool remember_path(const BodyForces& forces) {
  return std::ranges::any_of(contacts_of(forces), [](const auto* one) { return one->remembers_path(); });
}

/// The obstacles among them that a program may move.
inline std::vector<Movable> movable_of(const BodyForces& forces) {
  std::vector<Movable> all;
  for (const ContactForce* contact : contacts_of(forces)) {
    if (const auto movable = contact->movable()) all.push_back(*movable);
  }
  return all;
}

/// The forces with those that `other` of a contact gives in its place.
template <class Other>
BodyForces with_contacts(BodyForces forces, const Other& other) {
  for (auto& force : forces) {
    const auto* contact = dynamic_cast<const ContactForce*>(force.get());
    if (auto another = contact != nullptr ? other(*contact) : nullptr) force = std::move(another);
  }
  return forces;
}

/// The forces on a body in static equilibrium, and in motions.
inline BodyForces at_rest(BodyForces forces) {
  return with_contacts(std::move(forces), [](const ContactForce& contact) { return contact.at_rest(); });
}
inline BodyForces in_motion(BodyForces forces) {
  return with_contacts(std::move(forces), [](const ContactForce& contact) { return contact.in_motion(); });
}

}  // namespace sandglass
