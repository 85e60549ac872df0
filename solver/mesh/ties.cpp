#include "mesh/ties.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.hpp"

namespace sandglass {

const Tie* tie_of(const Ties& ties, int node) {
  const auto found = std::ranges::lower_bound(ties, node, {}, &Tie::node);
  return found != ties.end() && found->node == node ? &*found : nullptr;
}

bool is_tied(const Ties& ties, int node) {
  return tie_of(ties, node) != nullptr;
}

Ties to_free_nodes(const Ties& ties) {
  Ties free = ties;
  for (Tie& tie : free) {
    // Each round replaces tied nodes by the nodes that they follow; without a cycle there are at most as many
    // rounds as ties.
    for (std::size_t round = 0;; ++round) {
      std::map<int, double> shares;
      bool tied = false;
      for (const auto& [node, weight] : tie.mean_of) {
        const Tie* next = tie_of(ties, node);
        tied = tied || next != nullptr;
        if (next == nullptr) {
          shares[node] += weight;
        } else {
          for (const auto& share : next->mean_of) shares[share.node] += weight * share.weight;
        }
      }
      if (!tied) break;
      if (round > ties.size()) {
        throw InputError(fmt::format("node {} is tied to itself; ties must not form cycles", tie.node));
      }
      tie.mean_of.clear();
      for (const auto& [node, weight] : shares) tie.mean_of.push_back({node, weight});
    }
  }
  return free;
}

std::vector<double> handed_on(const Ties& ties, std::vector<double> nodal) {
  for (const auto& [node, mean_of] : ties) {
    for (const auto& [to, weight] : mean_of) nodal[at(to)] += weight * nodal[at(node)];
    nodal[at(node)] = 0.0;
  }
  return nodal;
}

void follow(const Ties& ties, NodalField& field) {
  for (const auto& [node, mean_of] : ties) {
    Vector mean{};
    for (const auto& [from, weight] : mean_of) {
      for (std::size_t i = 0; i < 3; ++i) mean[i] += weight * field[at(from)][i];
    }
    field[at(node)] = mean;
  }
}

}  // namespace sandglass
