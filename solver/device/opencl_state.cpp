#include "device/opencl_state.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "written/kernel_text.hpp"
#include "written/node_kernels.hpp"

namespace sandglass {

namespace {

constexpr std::size_t of_row = 4, of_corner = 3, of_angle = 9;

template <class Real>
OpenClKernel kernel_named(const OpenClDevice& device, std::string_view name) {
  return {device, node_kernel_text<Real>(node_kernel(name), dialect_named("opencl")), std::string(name)};
}

template <class Real>
std::vector<Real> rounded(const std::vector<double>& numbers) {
  return {numbers.begin(), numbers.end()};
}

/// Things that belong to rows, in the order of the rows: where those of each row begin, and the end.
std::vector<int> sort_by_row(std::vector<std::size_t>& things, std::size_t rows, const auto& row_of) {
  std::ranges::stable_sort(things, {}, row_of);
  std::vector<int> first(rows + 1, 0);
  for (const std::size_t thing : things) ++first[row_of(thing) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  return first;
}

std::vector<std::size_t> numbers_below(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return numbers;
}

/// A load on a row: where in g it is, and where its factor is among the numbers of a step.
struct Load {
  std::size_t row;
  int slot, factor;
};

}  // namespace

/// The loads of nodes: g has twelve numbers in each column, the loads on the corners of a face, or four dead
/// loads.
template <class Real>
struct OpenClState<Real>::Loads {
  std::size_t columns = 0;
  std::vector<int> places;  // of the corners of faces
  std::vector<Real> g;
  std::vector<Load> loads;

  Loads(const NodalProblem<Real>& problem, const Layout& layout) {
    const auto row = [&](int node) { return at(layout.row_of_node[at(node)]); };
    for (const FaceForces& own : problem.face_forces) columns += in_groups(own.faces.size());
    const std::size_t first_dead = columns;
    columns += (problem.dead_loads.size() + 3) / 4;
    places.resize(4 * columns);
    g.resize(4 * of_corner * columns);
    const auto slot = [&](std::size_t column, std::size_t corner) {
      return static_cast<int>(of_corner * corner * columns + column);
    };
    const auto factor_of = [](std::size_t number) { return static_cast<int>(2 + number); };
    const std::size_t one = problem.curves, per_step = problem.curves + 1;
    std::size_t column = 0;
    for (const FaceForces& own : problem.face_forces) {
      const std::size_t factor =
          own.motion == FaceForces::Resists::velocities ? per_step : own.curve.value_or(one);
      for (std::size_t k = 0; k < in_groups(own.faces.size()); ++k, ++column) {
        const Quadrilateral& face = own.faces[std::min(k, own.faces.size() - 1)];
        for (std::size_t I = 0; I < 4; ++I) {
          places[I * columns + column] = static_cast<int>(place_of_row(row(face[I])));
          if (k < own.faces.size()) loads.push_back({row(face[I]), slot(column, I), factor_of(factor)});
        }
      }
    }
    for (std::size_t k = 0; k < problem.dead_loads.size(); ++k) {
      const auto& [node, force, curve] = problem.dead_loads[k];
      const int there = slot(first_dead + k / 4, k % 4);
      for (std::size_t i = 0; i < 3; ++i) g[at(there) + i * columns] = static_cast<Real>(force[i]);
      loads.push_back({row(node), there, factor_of(curve)});
    }
  }
};

template <class Real>
const OpenClBuffer& OpenClState<Real>::keep(OpenClBuffer buffer) {
  return *constant_.emplace_back(std::make_unique<OpenClBuffer>(std::move(buffer)));
}

template <class Real>
OpenClState<Real>::OpenClState(const OpenClForce<Real>& elements, const NodalProblem<Real>& problem)
    : elements_(elements),
      device_(elements.device()),
      nodes_(elements.layout().nodes),
      by_row_(numbers_below(problem.constraints.size())),
      numbers_of_step_(2 + problem.curves + 2 + of_angle * problem.angles),
      move_(kernel_named<Real>(device_, "move_nodes")),
      find_ill_(kernel_named<Real>(device_, "find_ill")),
      on_shares_(device_, of_row * by_row_.size() * sizeof(Real)),
      u_(device_, of_row * nodes_ * sizeof(Real)),
      increment_(device_, of_row * nodes_ * sizeof(Real)),
      force_(device_, of_row * nodes_ * sizeof(Real)),
      load_(device_, of_row * nodes_ * sizeof(Real)),
      load_work_(device_, nodes_ * sizeof(Real)),
      reaction_(device_, by_row_.size() * sizeof(Real)),
      driving_(device_, by_row_.size() * sizeof(Real)),
      work_(device_, by_row_.size() * sizeof(Real)),
      ill_(device_, sizeof(Real)) {
  const Loads all(problem, elements.layout());
  std::vector<std::size_t> order = numbers_below(all.loads.size());
  const auto first_load = sort_by_row(order, nodes_, [&](std::size_t k) { return all.loads[k].row; });
  std::vector<int> slots, factors;
  for (const std::size_t k : order) {
    slots.push_back(all.loads[k].slot);
    factors.push_back(all.loads[k].factor);
  }
  const auto first_constraint =
      sort_by_row(by_row_, nodes_, [&](std::size_t k) { return problem.constraints[k].row; });
  std::vector<int> components, angles;
  for (const std::size_t k : by_row_) {
    const auto& constraint = problem.constraints[k];
    components.push_back(static_cast<int>(constraint.component));
    angles.push_back(static_cast<int>(2 + problem.curves + 2 + of_angle * constraint.angle));
    for (const double share : constraint.share) shares_.push_back(static_cast<Real>(share));
    shares_.push_back(static_cast<Real>(constraint.mass));
  }
  on_shares_.write(shares_.data(), shares_.size() * sizeof(Real));
  const auto on_device = [&](const auto& values) -> const OpenClBuffer& { return keep({device_, values}); };
  const OpenClBuffer &places = on_device(all.places), &g = on_device(all.g);
  std::size_t column = 0;
  for (const FaceForces& own : problem.face_forces) {
    const std::size_t numbers = own.constants.front().size(), count = in_groups(own.faces.size());
    std::vector<Real> constants(numbers * all.columns);
    for (std::size_t k = 0; k < count; ++k) {
      const auto& of_face = own.constants[std::min(k, own.faces.size() - 1)];
      for (std::size_t n = 0; n < numbers; ++n)
        constants[n * all.columns + column + k] = static_cast<Real>(of_face[n]);
    }
    const ForceProgram program{{{"u", 12, "motion of the corners, m", true},
                                {"constants", static_cast<int>(numbers), "of the face"}},
                               own.program};
    OpenClKernel kernel(
        device_, kernel_text<Real>(program, dialect_named("opencl"), {"of_faces", {}}, NodalValues::of_nodes),
        "of_faces");
    kernel.set(static_cast<cl_long>(all.columns), places,
               own.motion == FaceForces::Resists::velocities ? increment_ : u_, on_device(constants), g);
    faces_.push_back({std::move(kernel), column, count});
    column += count;
  }
  const auto& sums = elements.nodal_sums();
  move_.set(static_cast<cl_long>(nodes_), 0, 0, keep({device_, sizeof(Real)}), sums.elements, sums.first,
            sums.slots, sums.f, static_cast<int>(all.columns), on_device(first_load), on_device(slots),
            on_device(factors), g, on_device(first_constraint), on_device(components), on_device(angles),
            on_shares_, on_device(problem.inverse_masses), u_, increment_, force_, load_, load_work_,
            reaction_, driving_, work_);
  traffic_ = traffic_of(first_load, problem.face_forces);
  find_ill_.set(static_cast<cl_long>(sums.elements), elements.jacobians(), ill_);
}

/// Of the nodes: where lists begin; forces of elements by slots; inverse mass; u and increment, read and
/// written; of constraints their lists, shares, driving force and work, and the reaction; of loads their
/// lists, forces, and the last forces and works of their nodes.
template <class Real>
StepTraffic OpenClState<Real>::traffic_of(const std::vector<int>& first_load,
                                          const std::vector<FaceForces>& faces) const {
  constexpr std::size_t index = sizeof(int), number = sizeof(Real), row = of_row * number;
  const auto loads = at(first_load.back()), slots = elements_.nodal_sums().count;
  std::size_t loaded = 0;
  for (std::size_t n = 0; n < nodes_; ++n) loaded += first_load[n] < first_load[n + 1] ? 1U : 0U;
  StepTraffic sum = elements_.traffic();
  sum.launches += 1 + static_cast<int>(faces.size());
  sum.bytes += nodes_ * (3 * index + number + 4 * row) + slots * (index + of_corner * number) +
               by_row_.size() * (2 * index + 9 * number) + loads * (2 * index + of_corner * number) +
               loaded * (2 * row + 2 * number);
  for (const FaceForces& own : faces)
    sum.bytes += in_groups(own.faces.size()) *
                 (4 * index + own.constants.front().size() * number + 4 * row + 4 * of_corner * number);
  return sum;
}

template <class Real>
void OpenClState<Real>::redirect(std::span<const typename NodalProblem<Real>::Share> shares) {
  for (std::size_t n = 0; n < by_row_.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) shares_[of_row * n + i] = static_cast<Real>(shares[by_row_[n]][i]);
  }
  on_shares_.write(shares_.data(), shares_.size() * sizeof(Real));
}

template <class Real>
void OpenClState<Real>::write(const ResidentBody<Real>& body) {
  const std::size_t bytes = of_row * nodes_ * sizeof(Real);
  u_.write(body.u.data(), bytes);
  increment_.write(body.increment.data(), bytes);
  force_.write(body.force.data(), bytes);
  load_.write(body.loads.data(), bytes);
  std::vector<Real> driving;
  for (const std::size_t k : by_row_) driving.push_back(body.driving[k]);
  driving_.write(driving.data(), driving.size() * sizeof(Real));
  clear_works();
}

template <class Real>
void OpenClState<Real>::clear_works() {
  const std::vector<Real> none(std::max(nodes_, by_row_.size()));
  load_work_.write(none.data(), nodes_ * sizeof(Real));
  work_.write(none.data(), by_row_.size() * sizeof(Real));
}

template <class Real>
void OpenClState<Real>::take(std::span<const ResidentStep> steps) {
  std::vector<Real> numbers;
  for (const ResidentStep& step : steps) {
    const auto add = [&](std::span<const double> some) {
      for (const double number : some) numbers.push_back(static_cast<Real>(number));
    };
    add(std::array{step.keep, -step.gain});
    add(step.factors);
    add(std::array{1.0, 1.0 / step.step});
    for (const auto& angle : step.angles) {
      add(angle.terms);
      add(angle.moved);
      add(angle.accelerations);
    }
  }
  const OpenClBuffer sent(device_, numbers);
  const auto alone = elements_.alone();
  move_.set_argument(3, sent);
  const int none = -1, of_step = static_cast<int>(numbers_of_step_), count = static_cast<int>(steps.size());
  for (int n = 0; n <= count; ++n) {
    move_.set_argument(1, n == 0 ? none : (n - 1) * of_step);
    move_.set_argument(2, n == count ? none : n * of_step);
    move_.run(0, in_groups(nodes_));
    if (n == count) break;
    elements_.compute_forces(u_);
    for (const Faces& faces : faces_) faces.kernel.run(faces.first, faces.count);
  }
}

template <class Real>
void OpenClState<Real>::wait() {
  Real last;
  ill_.read(&last, sizeof last);
}

template <class Real>
bool OpenClState<Real>::is_healthy() {
  Real ill = 0;
  ill_.write(&ill, sizeof ill);
  const auto alone = elements_.alone();
  elements_.compute_jacobians(u_);
  find_ill_.run(0, static_cast<std::size_t>(elements_.nodal_sums().elements));
  ill_.read(&ill, sizeof ill);
  return ill == Real(0);
}

template <class Real>
void OpenClState<Real>::read(ResidentBody<Real>& body) {
  const std::size_t bytes = of_row * nodes_ * sizeof(Real);
  u_.read(body.u.data(), bytes);
  increment_.read(body.increment.data(), bytes);
  force_.read(body.force.data(), bytes);
  load_.read(body.loads.data(), bytes);
  load_work_.read(body.works_of_loads.data(), nodes_ * sizeof(Real));
  std::vector<Real> numbers(by_row_.size());
  const auto bring = [&](const OpenClBuffer& buffer, std::vector<Real>& to) {
    buffer.read(numbers.data(), numbers.size() * sizeof(Real));
    for (std::size_t n = 0; n < numbers.size(); ++n) to[by_row_[n]] = numbers[n];
  };
  bring(reaction_, body.reactions);
  bring(driving_, body.driving);
  bring(work_, body.works);
  clear_works();
}

template class OpenClState<double>;
template class OpenClState<float>;

}  // namespace sandglass
