#pragma once

#include "assembly/face_gather.hpp"
#include "element/element_motion.hpp"

namespace sandglass {

/// The elements of a pack: their index among the packs, their lower face, behind which the upper one stands,
/// and their material.
struct StripPlace {
  std::size_t pack;
  std::size_t face;
  std::size_t material;
};

/// Calls visit(place) for the packs of the groups `first` to `last` - 1.
template <class Visit>
void for_each_pack(const ElementGroups& groups, std::size_t first, std::size_t last, const Visit& visit) {
  for (std::size_t g = first; g < last; ++g) {
    const ElementGroups::Group group = groups.groups[g];
    for (std::size_t k = 0; k < group.packs; ++k) {
      visit(StripPlace{group.first_pack + k, group.first_face + k, group.material});
    }
  }
}

/// Walks along the strips of the groups `first` to `last` - 1. gather(face, material) returns the values of a
/// face, which serve the elements on both of its sides; compute(lower, upper, place) returns the FacePair
/// that the elements between two faces contribute; scatter(sum, face) is called once for each face with the
/// sum over both of its sides.
template <class Gather, class Compute, class Scatter>
void walk_strips(const ElementGroups& groups, std::size_t first, std::size_t last, const Gather& gather,
                 const Compute& compute, const Scatter& scatter) {
  for (std::size_t g = first; g < last; ++g) {
    const auto [first_pack, first_face, packs, material] = groups.groups[g];
    auto lower = gather(first_face, material);
    decltype(compute(lower, lower, StripPlace{}).upper) carried{};
    for (std::size_t k = 0; k < packs; ++k) {
      const auto upper = gather(first_face + k + 1, material);
      const auto own = compute(lower, upper, StripPlace{first_pack + k, first_face + k, material});
      scatter(carried + own.lower, first_face + k);
      carried = own.upper;
      lower = upper;
    }
    scatter(carried, first_face + packs);
  }
}

/// The same walk without contributions: compute returns nothing. It runs less often, so that its code is kept
/// small: `gather`, which is inlined, is called at one place.
template <class Gather, class Compute>
void walk_strips(const ElementGroups& groups, std::size_t first, std::size_t last, const Gather& gather,
                 const Compute& compute) {
  for (std::size_t g = first; g < last; ++g) {
    const auto [first_pack, first_face, packs, material] = groups.groups[g];
    decltype(gather(first_face, material)) lower{};
    for (std::size_t k = 0; k <= packs; ++k) {
      const auto upper = gather(first_face + k, material);
      if (k > 0) compute(lower, upper, StripPlace{first_pack + k - 1, first_face + k - 1, material});
      lower = upper;
    }
  }
}

}  // namespace sandglass
