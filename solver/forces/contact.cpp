#include "forces/contact.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "forces/contact_input.hpp"
#include "forces/surface_pair.hpp"

namespace sandglass {

std::optional<BrokenRule> Contact::broken_rule() const {
  for (const double factor : curve.factors) {
    if (factor < 0.0)
      return BrokenRule{"factors", fmt::format("= ..., {}, ... must not be negative", factor)};
  }
  return broken_rule_of_name(label);
}

namespace {

/// Whether all nodes are tied to others, which are sorted.
bool are_tied_to(const Ties& ties, const std::vector<int>& nodes, const std::vector<int>& others) {
  const auto is_other = [&](const Tie::Share& share) {
    return std::ranges::binary_search(others, share.node);
  };
  return std::ranges::all_of(nodes, [&](int node) {
    const Tie* tie = tie_of(ties, node);
    return tie != nullptr && std::ranges::all_of(tie->mean_of, is_other);
  });
}

}  // namespace

void Contact::resolve(ForceResolver& resolver) const {
  require_own_name(resolver, name, label);
  const auto refuse_at = [&](int node, const std::string& what, const std::string& allowed) {
    refuse_node(resolver, name, label, node, what, allowed);
  };
  std::vector<std::vector<Quadrilateral>> surfaces{resolver.faces(name, set)};
  auto all = surfaces.front();
  if (!other.empty()) {
    surfaces.push_back(resolver.faces(name, other, "other"));
    all.insert(all.end(), surfaces[1].begin(), surfaces[1].end());
    auto first = nodes_of(surfaces[0]), second = nodes_of(surfaces[1]);
    std::ranges::sort(first);
    std::ranges::sort(second);
    std::vector<int> common;
    std::ranges::set_intersection(first, second, std::back_inserter(common));
    if (!common.empty()) {
      refuse_at(common.front(), fmt::format("is on both surfaces, '{}' and '{}'", set, other),
                "surfaces without common nodes, or one set without `other`, which may touch itself");
    }
    if (are_tied_to(resolver.ties, first, second) || are_tied_to(resolver.ties, second, first)) {
      refuse_at(first.front(), "and all others of one surface follow the other surface by a [[tie]]",
                "a tie or a contact between two surfaces");
    }
  }
  if (method == Method::kinematic && resolver.in_motion) {
    for (const int node : nodes_of(all)) {
      if (!is_tied(resolver.ties, node)) continue;
      refuse_at(node, "follows others, by a tie or on a refined mesh, which the kinematic method cannot move",
                "method = 'penalty', or sets without such nodes");
    }
  }
  const ContactScale scale(resolver.points, resolver.cells, resolver.young_moduli, all);
  const bool is_constant = curve == LoadCurve{};
  const std::size_t of_friction =
      resolver.number_of(is_constant ? LoadCurve{.times = {0.0}, .factors = {1.0}} : curve);
  auto pair = make_surface_pair(*this, {surfaces, scale.stiffness(penalty), scale.edge, of_friction},
                                resolver.points, resolver.cells);
  if (const auto deepest = pair->deepest_at_start(); deepest && deepest->depth > scale.rounding()) {
    refuse_at(deepest->node,
              fmt::format("is {:.3g} m inside of what it may touch at the start", deepest->depth),
              "surfaces that do not intersect");
  }
  for (std::size_t s = 0; s < surfaces.size(); ++s) {  // deeper than the pair follows
    const int node = node_within_body(resolver, surfaces[s], surfaces[surfaces.size() - 1 - s]);
    if (node < 0) continue;
    refuse_at(node,
              surfaces.size() > 1 ? "is within the other body at the start"
                                  : "is within the body itself at the start",
              "bodies that do not intersect");
  }
  resolver.forces.push_back(std::move(pair));
}

}  // namespace sandglass
