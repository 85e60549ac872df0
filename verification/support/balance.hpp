#pragma once

#include <limits>

#include "problem/model.hpp"
#include "support/dense_matrix.hpp"
#include "support/newton_krylov.hpp"
#include "support/plain_assembly.hpp"

namespace sandglass::verification {

/// The balance of a scene's free components: displacements from `from` on, where elements have the memory
/// `histories`, with imposed ones at a share of their final values.
template <class Kernel, class Law>
class Balance {
 public:
  using Assembly = PlainAssembly<Kernel, Law>;
  using Histories = typename Assembly::template Histories<double>;

  Balance(const Scene& scene, const Law& law)
      : scene_(scene),
        assembly_(scene.mesh, law, {.kappa = {}, .density = scene.materials.list.front().density}),
        from_(assembly_.numbers(), 0.0),
        histories_(assembly_.template rest<double>()) {
    std::vector<bool> is_free(assembly_.numbers(), true);
    for (const Constraint& constraint : scene.constraints) {
      is_free[3 * index(constraint.node) + index(constraint.component)] = false;
    }
    for (std::size_t k = 0; k < is_free.size(); ++k) {
      if (is_free[k]) free_.push_back(k);
    }
  }

  /// Continues from displacements (m) with the elements' memory there.
  void start_from(std::vector<double> u, Histories histories) {
    from_ = std::move(u);
    histories_ = std::move(histories);
  }

  const Assembly& assembly() const { return assembly_; }

  std::size_t size() const { return free_.size(); }

  /// All displacements, from those of the free components.
  std::vector<double> displacements(const std::vector<double>& x, double share) const {
    std::vector<double> u(from_.size());
    for (const Constraint& constraint : scene_.constraints) {
      u[3 * index(constraint.node) + index(constraint.component)] = share * final_value(scene_, constraint);
    }
    for (std::size_t k = 0; k < free_.size(); ++k) u[free_[k]] = x[k];
    return u;
  }

  /// The free components of a nodal field.
  std::vector<double> free_of(const std::vector<double>& u) const {
    std::vector<double> x;
    for (const std::size_t k : free_) x.push_back(u[k]);
    return x;
  }

  /// Forces (N) of all components.
  std::vector<double> forces(const std::vector<double>& u) const {
    std::vector<double> increment = u;
    for (std::size_t k = 0; k < u.size(); ++k) increment[k] -= from_[k];
    Histories histories = histories_;
    return assembly_.template force<double>(u, increment, infinite, histories);
  }

  /// The change of the forces along a direction of the free components.
  std::vector<double> derivative(const std::vector<double>& u, const std::vector<double>& direction) const {
    std::vector<D> at(u.size()), increment(u.size());
    for (std::size_t k = 0; k < u.size(); ++k) {
      at[k] = D(u[k]);
      increment[k] = D(u[k] - from_[k]);
    }
    for (std::size_t k = 0; k < free_.size(); ++k) {
      at[free_[k]].slope = increment[free_[k]].slope = direction[k];
    }
    auto histories = assembly_.dual(histories_);
    const std::vector<D> f = assembly_.template force<D>(at, increment, infinite, histories);
    std::vector<double> slopes;
    for (const std::size_t k : free_) slopes.push_back(f[k].slope);
    return slopes;
  }

  /// The tangent stiffness of the free components, by rows.
  std::vector<double> tangent(const std::vector<double>& u) const {
    const std::size_t n = size();
    std::vector<double> K(n * n), direction(n, 0.0);
    for (std::size_t k = 0; k < n; ++k) {
      direction[k] = 1.0;
      const std::vector<double> column = derivative(u, direction);
      for (std::size_t row = 0; row < n; ++row) K[row * n + k] = column[row];
      direction[k] = 0.0;
    }
    return K;
  }

  /// Free components in balance at a share of the imposed displacements, by Newton's method from x.
  std::vector<double> solved(const std::vector<double>& x, double share, double unit,
                             double tolerance) const {
    const std::vector<double> K = tangent(displacements(x, share));
    const NonlinearSystem system{[&](const auto& at) { return free_of(forces(displacements(at, share))); },
                                 [&](const auto& at, const auto& direction) {
                                   return derivative(displacements(at, share), direction);
                                 },
                                 factored(K.data(), static_cast<int>(size()))};
    return solved_by_newton_krylov(system, x, unit, tolerance);
  }

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  const Scene& scene_;
  Assembly assembly_;
  std::vector<std::size_t> free_;
  std::vector<double> from_;
  Histories histories_;
};

}  // namespace sandglass::verification
