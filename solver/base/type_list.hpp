#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace sandglass {

/// A list of types, each with a static `name` and `summary`. Laws, methods and mesh generators are such
/// lists: everything that must know all of them iterates the list, so that a new entry is one line.
template <class... Types>
struct TypeList {};

/// Calls `visit.template operator()<Type>()` for every type of the list, in order.
template <class... Types, class Visitor>
constexpr void for_each_type(TypeList<Types...> /*list*/, Visitor&& visit) {
  (visit.template operator()<Types>(), ...);
}

/// Calls `visit.template operator()<Type>()` for the type whose `name` is `name`; returns whether there is
/// one.
template <class... Types, class Visitor>
bool with_named_type(TypeList<Types...> /*list*/, std::string_view name, Visitor&& visit) {
  return ((Types::name == name && (visit.template operator()<Types>(), true)) || ...);
}

/// The names of the types of a list, in order.
template <class... Types>
std::vector<std::string> names_of(TypeList<Types...> /*list*/) {
  return {std::string(Types::name)...};
}

namespace detail {
template <class List>
struct VariantOf;
template <class... Types>
struct VariantOf<TypeList<Types...>> {
  using type = std::variant<Types...>;
};
}  // namespace detail

/// A value that is one of the types of a list.
template <class List>
using VariantOf = typename detail::VariantOf<List>::type;

}  // namespace sandglass
