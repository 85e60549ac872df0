#pragma once

#include <cstring>
#include <vector>

#include "element/element_motion.hpp"
#include "element/hourglass_settings.hpp"
#include "material/memory.hpp"
#include "mesh/hexahedron.hpp"
#include "support/derivatives.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification {

/// A second implementation of the assembly, as in a textbook: elements one by one, gather, force, scatter; no
/// strips, packs or threads. On dual numbers it gives exact derivatives. Nodal values of n nodes are 3 n
/// numbers, component i of node I at 3 I + i.
template <class Kernel, class Law>
class PlainAssembly {
 public:
  template <class T>
  using Histories = std::vector<typename Kernel::template History<T>>;

  /// The number of values in an element's memory.
  static constexpr std::size_t history_numbers =
      Kernel::remembers ? sizeof(typename Kernel::template History<double>) / sizeof(double) : 0;

  PlainAssembly(const Mesh& mesh, const Law& law, const HourglassSettings& settings)
      : mesh_(mesh), law_(law) {
    for (const auto& cell : mesh.cells) {
      X_.push_back(sandglass::gather(mesh.points, cell));
      elements_.push_back(Kernel::precompute(X_.back(), law, settings));
      dual_elements_.push_back(dual_element<Kernel>(elements_.back()));
    }
  }

  std::size_t numbers() const { return 3 * mesh_.points.size(); }

  /// The memory of undeformed elements.
  template <class T>
  Histories<T> rest() const {
    return Histories<T>(mesh_.cells.size(), typename Kernel::template History<T>{});
  }

  /// The internal forces (N) at displacements u (m) reached by `increment` in `step` seconds, infinite in
  /// static solutions. Advances the elements' memory by one step.
  template <class T>
  std::vector<T> force(const std::vector<T>& u, const std::vector<T>& increment, double step,
                       Histories<T>& histories) const {
    std::vector<ElementMotion<T>> motions;
    for (std::size_t e = 0; e < mesh_.cells.size(); ++e) {
      motions.push_back({.u = to_modes(gather(u, e)),
                         .increment = to_modes(gather(increment, e)),
                         .X = to_modes(from_double<T>(X_[e])),
                         .inverse_step = T(1.0 / step),
                         .dilatation = {}});
    }
    if constexpr (Kernel::averages_over_nodes) average_dilatations(motions);
    const auto law = at_step(law_, step);
    const bool timeless = std::isinf(step);
    std::vector<T> force(u.size(), T(0.0));
    for (std::size_t e = 0; e < motions.size(); ++e) {
      if (timeless) histories[e].law = {};
      const auto& element = elements<T>()[e];
      const auto now = Kernel::deformation(motions[e], element);
      const NodalVectors<T> f = from_modes(Kernel::force(now, element, histories[e], law));
      for (std::size_t I = 0; I < 8; ++I) {
        for (std::size_t i = 0; i < 3; ++i) {
          T& sum = force[3 * node(e, I) + i];
          sum = sum + f(static_cast<int>(I), static_cast<int>(i));
        }
      }
    }
    return force;
  }

  /// The limit of a short step: the forces of a body at u with velocities v (m/s) and the memory `histories`.
  /// The step is so short that nothing changes by more than roundoff, and a power of two, so that velocities
  /// follow from increments exactly.
  std::vector<double> force_in_motion(const std::vector<double>& u, const std::vector<double>& v,
                                      Histories<double> histories) const {
    constexpr double instant = 0x1p-64;
    std::vector<double> increment = v;
    for (double& x : increment) x *= instant;
    return force<double>(u, increment, instant, histories);
  }

  /// The exact rates (1/s) of the elements' memory: a step h leads from history Q to Q + h Q' + O(h^2) with
  /// increments h v, and h is the dual number 0 + epsilon. For elastic laws only: viscoelastic ones store
  /// their step.
  std::vector<double> history_rates(const std::vector<double>& u, const std::vector<double>& v,
                                    const Histories<double>& histories) const {
    static_assert(!law_remembers<Law>);
    std::vector<double> rates(history_numbers * mesh_.cells.size());
    if constexpr (Kernel::remembers) {
      Histories<D> duals = dual(histories);
      std::vector<D> at(u.size()), step(u.size());
      for (std::size_t k = 0; k < u.size(); ++k) {
        at[k] = D(u[k]);
        step[k] = D(0.0, v[k]);
      }
      force<D>(at, step, std::numeric_limits<double>::infinity(), duals);
      std::vector<D> numbers(rates.size());
      std::memcpy(numbers.data(), static_cast<const void*>(duals.data()), numbers.size() * sizeof(D));
      for (std::size_t k = 0; k < rates.size(); ++k) rates[k] = numbers[k].slope;
    }
    return rates;
  }

  /// Histories as constants among dual numbers.
  Histories<D> dual(const Histories<double>& histories) const {
    Histories<D> result = rest<D>();
    if constexpr (Kernel::remembers) {
      static_assert(sizeof(result[0]) == history_numbers * sizeof(D),
                    "histories must be of their number type");
      const std::vector<double> plain = flat(histories);
      const std::vector<D> numbers(plain.begin(), plain.end());
      std::memcpy(static_cast<void*>(result.data()), numbers.data(), numbers.size() * sizeof(D));
    }
    return result;
  }

  /// Histories as numbers, element by element.
  static std::vector<double> flat(const Histories<double>& histories) {
    std::vector<double> numbers(history_numbers * histories.size());
    if constexpr (Kernel::remembers) {
      std::memcpy(numbers.data(), static_cast<const void*>(histories.data()),
                  numbers.size() * sizeof(double));
    }
    return numbers;
  }

  /// Numbers as histories: the inverse of `flat`.
  Histories<double> histories(const double* numbers) const {
    Histories<double> result = rest<double>();
    if constexpr (Kernel::remembers) {
      std::memcpy(static_cast<void*>(result.data()), numbers,
                  history_numbers * result.size() * sizeof(double));
    }
    return result;
  }

 private:
  std::size_t node(std::size_t e, std::size_t I) const { return static_cast<std::size_t>(mesh_.cells[e][I]); }

  template <class T>
  const auto& elements() const {
    if constexpr (std::is_same_v<T, D>) {
      return dual_elements_;
    } else {
      return elements_;
    }
  }

  template <class T>
  NodalVectors<T> gather(const std::vector<T>& field, std::size_t e) const {
    NodalVectors<T> own;
    for (std::size_t I = 0; I < 8; ++I) {
      for (std::size_t i = 0; i < 3; ++i) {
        own(static_cast<int>(I), static_cast<int>(i)) = field[3 * node(e, I) + i];
      }
    }
    return own;
  }

  template <class T>
  void average_dilatations(std::vector<ElementMotion<T>>& motions) const {
    std::vector<T> change(mesh_.points.size(), T(0.0)), rest = change;
    for (std::size_t e = 0; e < motions.size(); ++e) {
      const auto own = Kernel::nodal_volumes(motions[e], elements<T>()[e]);
      for (std::size_t I = 0; I < 8; ++I) {
        change[node(e, I)] = change[node(e, I)] + own.change[I];
        rest[node(e, I)] = rest[node(e, I)] + own.reference[I];
      }
    }
    for (std::size_t e = 0; e < motions.size(); ++e) {
      for (std::size_t I = 0; I < 8; ++I) {
        motions[e].dilatation[I] = change[node(e, I)] / rest[node(e, I)];
      }
    }
  }

  const Mesh& mesh_;
  Law law_;
  std::vector<NodalVectors<double>> X_;
  std::vector<typename Kernel::template Element<double>> elements_;
  std::vector<typename Kernel::template Element<D>> dual_elements_;
};

/// Nodal values as 3 n numbers.
inline std::vector<double> flat(const NodalField& field) {
  std::vector<double> numbers;
  for (const auto& row : field) numbers.insert(numbers.end(), row.begin(), row.end());
  return numbers;
}

/// 3 n numbers as nodal values.
inline NodalField nodal(const std::vector<double>& numbers) {
  NodalField field(numbers.size() / 3);
  for (std::size_t k = 0; k < numbers.size(); ++k) field[k / 3][k % 3] = numbers[k];
  return field;
}

}  // namespace sandglass::verification
