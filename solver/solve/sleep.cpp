#include "solve/sleep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "mesh/distances.hpp"
#include "mesh/mesh_part.hpp"
#include "solve/equilibrium.hpp"
#include "solve/load_levels.hpp"

namespace sandglass {

namespace {

// Shares of the allowed error: for the first motion, and for the effect of fixing a part on the rest. A tenth
// is left for the changes under the full load.
constexpr double share_of_motion = 0.27, share_of_holding = 0.63;

/// The nodes with an imposed displacement or a force.
std::vector<int> pushed_nodes(const Scene& scene) {
  std::vector<int> nodes;
  for (const auto& constraint : scene.constraints) {
    const auto& share = constraint.path.share;
    if (std::any_of(share.begin(), share.end(), [](double s) { return s != 0.0; })) {
      nodes.push_back(constraint.node);
    }
  }
  for (const auto& force : scene.forces) {
    if (force->traits().drives) nodes.insert(nodes.end(), force->nodes().begin(), force->nodes().end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

NodalField on_the_whole(const NodalField& field, const MeshPart& part) {
  NodalField whole(part.part_of.size());
  for (std::size_t n = 0; n < field.size(); ++n) whole[at(part.node_of[n])] = field[n];
  return whole;
}

/// Forwards the reports on a part as reports on the whole mesh.
class PartObserver final : public Observer {
 public:
  PartObserver(Observer& listener, const MeshPart& part, std::size_t elements)
      : listener_(listener), part_(part), elements_(elements) {}

  void frame(const Frame& frame) override {
    listener_.frame({frame.time, on_the_whole(frame.u, part_), on_the_whole(frame.v, part_),
                     per_element(frame.jacobians, 1.0), per_element(frame.hourglass_energy_densities, 0.0),
                     frame.levels.empty() ? frame.levels : per_element(frame.levels, 0.0),
                     per_element(frame.stresses, 0.0), frame.reactions});
  }
  void history(const HistoryRow& row) override { listener_.history(row); }
  void at_load(double factor) override { listener_.at_load(factor); }
  bool proceed(long step, double share, double residual) override {
    return listener_.proceed(step, share, residual);
  }

 private:
  std::vector<double> per_element(const std::vector<double>& values, double asleep) const {
    const std::size_t count = values.size() / part_.element_of.size();  // of an element
    std::vector<double> whole(count * elements_, asleep);
    for (std::size_t k = 0; k < values.size(); ++k) {
      whole[count * at(part_.element_of[k / count]) + k % count] = values[k];
    }
    return whole;
  }

  Observer& listener_;
  const MeshPart& part_;
  std::size_t elements_;
};

Vector scaled(const Vector& v, double factor) {
  return {factor * v[0], factor * v[1], factor * v[2]};
}

/// Solves the model of a part under its first load, from a guess, and sets the displacements u (m) of the
/// whole body at the nodes of the part to the solution over the load, which is so small that answers are
/// proportional to it. Returns the number of evaluations of forces.
long find_first_answer(const Model& model, const MeshPart& part, NodalField& whole) {
  // Even a small residual wakes the surroundings.
  constexpr double share_left = 0.05;  // of the residual at the guess
  constexpr long most_evaluations = 1000;
  const double load = first_load(model);
  NodalField u;
  for (const int node : part.node_of) u.push_back(scaled(whole[at(node)], load));
  return std::visit(
      [&]<class Real>(const std::unique_ptr<InternalForce<Real>>& elements) {
        Equilibrium<Real> search(model, *elements);
        search.body().state() = state_at(*elements, u);
        search.body().impose(load);
        search.take_own_pressures();
        search.start(Effort::brief);
        const double enough = share_left * search.residual();
        while (search.residual() > enough && search.evaluations() < most_evaluations && search.step()) {
        }
        u = search.body().field(search.body().state().u);
        for (std::size_t n = 0; n < u.size(); ++n) whole[at(part.node_of[n])] = scaled(u[n], 1.0 / load);
        return search.evaluations();
      },
      model.internal_force());
}

/// The first motion of a body, computed only as far as it reaches.
class FirstMotion {
 public:
  FirstMotion(const Scene& scene, const MethodChoice& choice)
      : scene_(scene),
        choice_(choice),
        distances_(scene.mesh),
        from_pushed_(distances_.from(pushed_nodes(scene))),
        awake_(scene.mesh.cells.size(), false),
        u_(scene.mesh.points.size()) {
    std::vector<int> margin(u_.size(), 0);
    for (std::size_t n = 0; n < margin.size(); ++n) margin[n] = from_pushed_[n] == 0 ? first_margin : 0;
    distances_.mark(margin, awake_);
    find();
  }

  /// Displacements (m) over the load, with an error of at most `share` of the largest.
  const NodalField& within(double share) {
    const auto allowed = [&] { return share * displacement_unit(scene_, u_); };
    while (left_ > allowed() && wake(allowed())) find();
    return u_;
  }

  /// The elements at nodes that move by more than a length (m).
  std::vector<bool> around_what_moves(double by_more_than) const {
    std::vector<int> margin(u_.size(), 0);
    for (std::size_t n = 0; n < u_.size(); ++n) margin[n] = length(u_[n]) > by_more_than ? 1 : 0;
    std::vector<bool> marked(awake_.size(), false);
    distances_.mark(margin, marked);
    for (std::size_t e = 0; e < marked.size(); ++e) marked[e] = marked[e] && awake_[e];
    return marked;
  }

  /// The number of elements that the motion reaches.
  std::size_t elements() const {
    return static_cast<std::size_t>(std::count(awake_.begin(), awake_.end(), true));
  }

  long evaluations() const { return evaluations_; }

 private:
  /// The factor by which the error of a motion that decays as 1/r falls from one part to the next, a third
  /// larger one; no motion decays more slowly.
  static constexpr double slowest = 0.75;
  static constexpr int first_margin = 4;  // elements around pushed nodes
  static constexpr int least_margin =
      2;  // so that the next rim, not the last moving node, is a third farther

  /// Wakes the elements around nodes that move by more than a length (m), within a third of their distance
  /// from the pushed nodes; returns whether any of them slept.
  bool wake(double by_more_than) {
    std::vector<int> margin(u_.size(), 0);
    for (std::size_t n = 0; n < u_.size(); ++n) {
      if (length(u_[n]) > by_more_than) margin[n] = from_pushed_[n] / 3 + least_margin;
    }
    const std::size_t before = elements();
    distances_.mark(std::move(margin), awake_);
    return elements() > before;
  }

  /// Computes the awake part. The change due to newly awake elements was the error before, and its decay from
  /// part to part gives the present error; the slower decay of the last two is used, because motions of
  /// several kinds decay simultaneously, the fast ones first.
  void find() {
    const NodalField before = u_;
    const MeshPart part = part_of_mesh(scene_.mesh, awake_);
    const Scene scene = on_part(scene_, part);
    evaluations_ += find_first_answer(Model(scene, choice_), part, u_);
    const double change = largest_distance(u_, before);
    const double falls = std::min(slowest, change / change_), factor = std::max(falls, falls_);
    left_ = change * factor / (1.0 - factor);
    change_ = change;
    falls_ = falls;
  }

  const Scene& scene_;
  const MethodChoice& choice_;
  Distances distances_;
  std::vector<int> from_pushed_;  // of each node
  std::vector<bool> awake_;       // elements
  NodalField u_;
  double falls_ = slowest;                                 // factor from the last change but one to the last
  double change_ = 0.0;                                    // m, by the last computation
  double left_ = std::numeric_limits<double>::infinity();  // m, of error
  long evaluations_ = 0;
};

}  // namespace

LocalRelaxation relax_awake(const Scene& scene, const MethodChoice& choice, double share,
                            Observer& observer) {
  if (method_named(choice.method).is_condensed) {
    throw InputError(fmt::format(
        "sleep: method '{}' does not compute elements; allowed: a method that takes steps", choice.method));
  }
  if (!scene.ties.empty()) {
    throw InputError(
        scene.coarser.empty()
            ? "sleep: distances are counted in elements that share nodes, which tied parts do not; allowed: "
              "a mesh without [[tie]]"
            : "sleep: distances are counted in elements, which in a refined mesh differ in size; allowed: "
              "a mesh without [[refine]]");
  }
  if (const auto contacts = contacts_of(scene.forces); !contacts.empty()) {
    throw InputError(fmt::format("sleep: what touches changes with the load; allowed: a case without [[{}]]",
                                 contacts.front()->traits().name));
  }
  if (pushed_nodes(scene).empty()) {
    throw InputError("sleep: all elements would sleep; impose a displacement or a force");
  }
  const auto start = std::chrono::steady_clock::now();
  FirstMotion first(scene, choice);
  const NodalField& motion = first.within(share_of_motion * share);
  const double unit = displacement_unit(scene, motion);
  long evaluations = first.evaluations();
  for (double held = 0.5 * share;; held *= 0.6) {
    const MeshPart part = part_of_mesh(scene.mesh, first.around_what_moves(held * unit));
    const Scene awake = on_part(scene, part);
    const Model model(awake, choice);
    if (part.element_of.size() < first.elements()) {
      NodalField neglecting(motion.size());
      for (const int node : part.node_of) neglecting[at(node)] = motion[at(node)];
      evaluations += find_first_answer(model, part, neglecting);
      if (largest_distance(neglecting, motion) > share_of_holding * share * unit) continue;
    }
    PartObserver forwarding(observer, part, scene.mesh.cells.size());
    LocalRelaxation local{relax(model, forwarding), part.element_of.size()};
    local.relaxation.u = on_the_whole(local.relaxation.u, part);
    local.relaxation.steps += evaluations;
    local.relaxation.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return local;
  }
}

}  // namespace sandglass
