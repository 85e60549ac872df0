#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace sandglass {

/// Processes that share the work on one body; the base class is a single process. All hold the whole model,
/// make the same decisions, and call these functions in the same order.
class Ranks {
 public:
  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  virtual int rank() const { return 0; }
  virtual int count() const { return 1; }

  /// Data to and from the ranks below and above; empty if there is no such rank.
  struct Exchange {
    std::span<const std::byte> to_below, to_above;
    std::span<std::byte> from_below, from_above;
  };

  /// The traffic of this rank so far.
  struct Traffic {
    long exchanges = 0;
    long messages = 0;  ///< sent
    long bytes = 0;     ///< sent
  };
  virtual Traffic traffic() const { return {}; }

  /// Begins an exchange. The data must not be touched until `finish` returns.
  virtual void start(const Exchange& /*exchange*/) const {}
  virtual void finish() const {}

  /// Sums over the ranks, number by number. If each number comes from one rank and the others have zeros, the
  /// sum is exact: it combines results of separate ranks.
  virtual void sum(std::span<double> /*numbers*/) const {}

  /// Sends each rank's own part of `data`, from bounds[rank] to bounds[rank + 1], to all others.
  virtual void gather(std::byte* /*data*/, std::span<const std::size_t> /*bounds*/) const {}

  /// Whether all ranks finish together with this one; after an error, a rank waits briefly for that.
  virtual bool all_end() const { return true; }

  /// Ends all ranks immediately.
  virtual void abort(int /*exit_code*/) const {}

  /// One value from each rank.
  std::vector<double> of_all(double value) const {
    std::vector<double> values(static_cast<std::size_t>(count()));
    values[static_cast<std::size_t>(rank())] = value;
    sum(values);
    return values;
  }

  /// The largest of the values of all ranks.
  double largest(double value) const { return std::ranges::max(of_all(value)); }

  /// Whether something holds on any rank.
  bool any(bool here) const {
    double sum_of_all = here ? 1.0 : 0.0;
    sum({&sum_of_all, 1});
    return sum_of_all > 0.0;
  }
};

/// The workers that share loops: the ranks, and the threads of each.
struct Team {
  int threads = 1;
  std::shared_ptr<const Ranks> ranks = std::make_shared<const Ranks>();
};

}  // namespace sandglass
