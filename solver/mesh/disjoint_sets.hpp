#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace sandglass {

/// Disjoint sets of the numbers from 0 on, joined step by step; the least number represents its set.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : towards_least_(count) {
    std::iota(towards_least_.begin(), towards_least_.end(), 0);
  }

  /// Halves paths as it follows them.
  int least(int member) {
    for (int* next = &towards(member); *next != member; next = &towards(member))
      member = *next = towards(*next);
    return member;
  }

  void join(int a, int b) {
    const auto [low, high] = std::minmax({least(a), least(b)});
    towards(high) = low;
  }

 private:
  int& towards(int member) { return towards_least_[static_cast<std::size_t>(member)]; }

  std::vector<int> towards_least_;
};

}  // namespace sandglass
