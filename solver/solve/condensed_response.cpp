#include "solve/condensed_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <set>

#include "base/error.hpp"
#include "math/row_loops.hpp"
#include "problem/linear_stiffness.hpp"
#include "solve/layered_cholesky.hpp"

namespace sandglass {

namespace {

/// For each node the nodes that share an element with it, if both have free components.
std::vector<std::vector<int>> neighbours_of(const Mesh& mesh, const std::vector<int>& components) {
  std::vector<std::set<int>> sets(mesh.points.size());
  for (const auto& cell : mesh.cells) {
    for (const int a : cell) {
      for (const int b : cell) {
        if (a != b && components[at(a)] > 0 && components[at(b)] > 0) sets[at(a)].insert(b);
      }
    }
  }
  std::vector<std::vector<int>> neighbours;
  neighbours.reserve(sets.size());
  for (const auto& set : sets) neighbours.emplace_back(set.begin(), set.end());
  return neighbours;
}

/// The factorised K_ff of a model, and the numbers of its rows.
class FreeStiffness {
 public:
  explicit FreeStiffness(const Model& model)
      : row_(3 * model.scene().mesh.points.size(), 0), factor_(number_rows(model.scene())) {
    for_each_stiffness(model, [&](const Hexahedron& cell, const ElementStiffness& K) {
      for (int m = 0; m < 24; ++m) {
        const int row = row_[component(cell, m)];
        for (int n = 0; n < 24 && row >= 0; ++n) {
          const int column = row_[component(cell, n)];
          if (column >= 0) factor_.add(row, column, K(m, n));
        }
      }
    });
    factor_.factorise();
  }

  /// Sets the free components of u (m) such that forces vanish there, given the forces f (N) at zero free
  /// displacements.
  void balance(const NodalField& f, NodalField& u) {
    for (std::size_t n = 0; n < row_.size(); ++n) {
      if (row_[n] >= 0) right_side_[at(row_[n])] = -f[n / 3][n % 3];
    }
    factor_.solve(right_side_);
    for (std::size_t n = 0; n < row_.size(); ++n) {
      if (row_[n] >= 0) u[n / 3][n % 3] = right_side_[at(row_[n])];
    }
  }

 private:
  static std::size_t component(const Hexahedron& cell, int m) { return 3 * at(cell[at(m / 3)]) + at(m % 3); }

  /// Numbers the free components, -1 for the others, by layers of their nodes, which start next to the driven
  /// set that minimises the work. Returns the sizes of the layers.
  std::vector<int> number_rows(const Scene& scene) {
    std::vector<int> components(scene.mesh.points.size(), 3);  // number of free ones of each node
    for (const auto& c : scene.constraints) {
      row_[3 * at(c.node) + at(c.component)] = -1;
      --components[at(c.node)];
    }
    const auto neighbours = neighbours_of(scene.mesh, components);
    std::vector<std::vector<int>> layers;
    std::vector<int> sizes;
    double least = INFINITY;
    for (const DrivenSet& set : scene.driven) {
      auto found = layers_from(nodes_next_to(scene, set.name, components), neighbours);
      std::vector<int> found_sizes;
      double work = 0.0;
      for (const auto& layer : found) {
        int size = 0;
        for (const int node : layer) size += components[at(node)];
        found_sizes.push_back(size);
        work += std::pow(size, 3);
      }
      if (work >= least) continue;
      least = work;
      layers = std::move(found);
      sizes = std::move(found_sizes);
    }
    require_room(sizes);
    int next = 0;
    for (const auto& layer : layers) {
      for (const int node : layer) {
        for (std::size_t i = 0; i < 3; ++i) {
          int& row = row_[3 * at(node) + i];
          if (row >= 0) row = next++;
        }
      }
    }
    right_side_.resize(at(next));
    return sizes;
  }

  static void require_room(const std::vector<int>& sizes) {
    constexpr double most = 8e9;
    double bytes = 0.0, before = 0.0;
    for (const double size : sizes) {
      bytes += sizeof(double) * size * (size + before);
      before = size;
    }
    if (bytes <= most) return;
    throw ComputationError(
        fmt::format("factorising the stiffness takes {:.3g} GB, more than the allowed {:.3g} GB; remedy: a "
                    "coarser mesh, or "
                    "a method that takes steps",
                    1e-9 * bytes, 1e-9 * most));
  }

  /// The free nodes that share an element with a set.
  static std::vector<int> nodes_next_to(const Scene& scene, const std::string& set,
                                        const std::vector<int>& components) {
    std::vector<bool> member(scene.mesh.points.size(), false);
    for (const int node : scene.sets.at(set)) member[at(node)] = true;
    std::set<int> neighbours;
    for (const auto& cell : scene.mesh.cells) {
      if (std::none_of(cell.begin(), cell.end(), [&](int node) { return member[at(node)]; })) continue;
      std::copy_if(cell.begin(), cell.end(), std::inserter(neighbours, neighbours.end()),
                   [&](int node) { return components[at(node)] > 0; });
    }
    return {neighbours.begin(), neighbours.end()};
  }

  std::vector<int> row_;  // of each component, -1 where it is constrained
  std::vector<double> right_side_;
  LayeredCholesky factor_;
};

/// Calls visit(constraint, column) for each constraint of a handle, with the column that moves it.
template <class Visit>
void for_each_held(const Scene& scene, const Handles& handles, const Visit& visit) {
  for (std::size_t k = 0; k < scene.constraints.size(); ++k) {
    const Constraint& c = scene.constraints[k];
    if (handles.of_constraint[k] >= 0) visit(c, 3 * at(handles.of_constraint[k]) + at(c.component));
  }
}

NodalField difference(NodalField a, const NodalField& b) {
  for (std::size_t n = 0; n < a.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) a[n][i] -= b[n][i];
  }
  return a;
}

}  // namespace

Handles handles_of_sets(const Scene& scene) {
  Handles handles;
  for (const Constraint& c : scene.constraints) {
    handles.of_constraint.push_back(c.group);
    handles.count = std::max(handles.count, static_cast<std::size_t>(c.group + 1));
  }
  return handles;
}

Handles handles_of_nodes(const Scene& scene) {
  Handles handles;
  int before = -1;
  for (const auto& constraint : scene.constraints) {  // which are sorted by node
    if (constraint.node != before) ++handles.count;
    before = constraint.node;
    handles.of_constraint.push_back(static_cast<int>(handles.count) - 1);
  }
  return handles;
}

std::vector<Vector> final_displacements(const Scene& scene, const Handles& handles) {
  std::vector<Vector> d(handles.count);
  for_each_held(scene, handles,
                [&](const Constraint& c, std::size_t row) { d[row / 3][row % 3] = final_value(scene, c); });
  return d;
}

std::vector<int> all_nodes(const Scene& scene) {
  std::vector<int> nodes(scene.mesh.points.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

template <class Real>
CondensedResponse<Real>::CondensedResponse(const Model& model, const Handles& handles,
                                           std::vector<int> outputs, const std::vector<NodalField>& loads)
    : handles_(handles.count),
      loads_(loads.size()),
      outputs_(std::move(outputs)),
      stiffness_(columns() * columns()),
      load_share_(columns() * loads_) {
  const Scene& scene = model.scene();
  if (scene.constraints.empty()) {
    throw InputError(fmt::format("{}: method '{}' needs an imposed displacement; add a [[displacement]]",
                                 scene.settings.file.string(), model.choice().method));
  }
  const Model exact(scene, {.method = model.choice().method, .kappa = model.choice().kappa});
  FreeStiffness K_ff(exact);
  response_.reserve(3 * (columns() + loads_) * outputs_.size());
  // Balances u against a load, stores it as a column, and calls take(row, force) for the forces of handles.
  const auto add_column = [&](NodalField u, const NodalField& load, const auto& take) {
    K_ff.balance(difference(internal_forces(exact, u), load), u);
    const NodalField f = difference(internal_forces(exact, u), load);
    for_each_held(scene, handles,
                  [&](const Constraint& c, std::size_t row) { take(row, f[at(c.node)][at(c.component)]); });
    for (const int node : outputs_) {
      for (const double component : u[at(node)]) response_.push_back(static_cast<Real>(component));
    }
  };
  const NodalField nothing(scene.mesh.points.size());
  for (std::size_t column = 0; column < columns(); ++column) {
    NodalField u = nothing;
    for_each_held(scene, handles, [&](const Constraint& c, std::size_t row) {
      if (row == column) u[at(c.node)][at(c.component)] = 1.0;
    });
    add_column(std::move(u), nothing,
               [&](std::size_t row, double force) { stiffness_[row * columns() + column] += force; });
  }
  for (std::size_t n = 0; n < loads_; ++n) {
    add_column(nothing, loads[n],
               [&](std::size_t row, double force) { load_share_[n * columns() + row] += force; });
  }
}

template <class Real>
void CondensedResponse<Real>::displacements(std::span<const Vector> d, std::span<Displacement> u, int threads,
                                            std::span<const double> factors) const {
  const std::size_t numbers = 3 * outputs_.size();
  Real* const sum = u.data()->data();
  const double* const amounts = d.data()->data();
  const std::size_t size = block_size(numbers);
  in_parallel((numbers + size - 1) / size, threads, [=, this](std::size_t block) {
    const std::size_t first = block * size, last = std::min(numbers, first + size);
    const auto add = [=, this](std::size_t column, double amount) {
      const auto share = static_cast<Real>(amount);
      const Real* const response = response_.data() + column * numbers;
#pragma omp simd
      for (std::size_t k = first; k < last; ++k) sum[k] += share * response[k];
    };
    std::fill(sum + first, sum + last, Real(0));
    for (std::size_t column = 0; column < columns(); ++column) add(column, amounts[column]);
    for (std::size_t n = 0; n < factors.size(); ++n) add(columns() + n, factors[n]);
  });
}

template <class Real>
void CondensedResponse<Real>::forces(std::span<const Vector> d, std::span<Vector> f,
                                     std::span<const double> factors) const {
  const double* const amounts = d.data()->data();
  for (std::size_t row = 0; row < columns(); ++row) {
    const double* const S = stiffness_.data() + row * columns();
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t column = 0; column < columns(); ++column) sum += S[column] * amounts[column];
    for (std::size_t n = 0; n < factors.size(); ++n) sum += load_share_[n * columns() + row] * factors[n];
    f[row / 3][row % 3] = sum;
  }
}

template <class Real>
double CondensedResponse<Real>::operations() const {
  return 2.0 * static_cast<double>(response_.size() + stiffness_.size() + load_share_.size());
}

template <class Real>
double CondensedResponse<Real>::bytes() const {
  return static_cast<double>(sizeof(Real) * (response_.size() + 3 * outputs_.size()) +
                             sizeof(double) * (stiffness_.size() + load_share_.size() + 2 * columns()));
}

template class CondensedResponse<double>;
template class CondensedResponse<float>;

}  // namespace sandglass
