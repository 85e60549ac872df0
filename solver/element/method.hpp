#pragma once

#include <concepts>

#include "base/type_list.hpp"

namespace sandglass {

/// What a method may state besides its element. Each statement is a type, which a method lists: a misspelt
/// one does not compile.
struct MethodOption {};

/// Kernels are also compiled for bodies side by side; see BatchForce.
struct Batches : MethodOption {};

/// Answers are superposed from responses that are computed once, instead of taking steps.
struct Condensed : MethodOption {};

/// The element, and so the kernels, are those of another method.
template <class Method>
struct SharesKernelsOf : MethodOption {
  using Owner = Method;
};

/// On meshes of parallelepipeds these kinematics give the same forces.
template <class Kinematics>
struct OnParallelepipedsBy : MethodOption {
  using RegularKinematics = Kinematics;
};

/// The method is adaptive: each element uses one of these methods, from the cheapest to the one that the
/// method approximates. Its own element describes undeformed elements, which are at the lowest level.
template <class... Methods>
struct AdaptsAmong : MethodOption {
  using Levels = TypeList<Methods...>;
};

/// The quasi-static limit of an Updated Lagrangian method for small strains.
template <class Method>
struct AtSmallStrainLike : MethodOption {
  using AtSmallStrain = Method;
};

/// The base of all methods: an element and options. A method adds `name` and `summary`; its header and its
/// type bear its name, as `tl_none.hpp`, `TlNone` and "tl-none" do.
template <class KinematicsType, class HourglassType, std::derived_from<MethodOption>... Options>
struct MethodWith : Options... {
  using Kinematics = KinematicsType;
  using Hourglass = HourglassType;
};

/// Whether a method states an option without parameters.
template <class Method, class Option>
inline constexpr bool states = std::derived_from<Method, Option>;

}  // namespace sandglass
