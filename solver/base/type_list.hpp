#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace sandglass {

/// A list of types, each with a static `name` and `summary`. Laws, methods and mesh generators are in such
/// lists: everything that handles all of them iterates the list, so that a new entry is one line.
template <class... Types>
struct TypeList {};

/// Calls `visit.template operator()<Type>()` for every type of the list, in order.
template <class... Types, class Visitor>
constexpr void for_each_type(TypeList<Types...> /*list*/, Visitor&& visit) {
  (visit.template operator()<Types>(), ...);
}

/// Calls `visit.template operator()<Type>()` for the type whose `name` is `name`; returns whether it exists.
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

// Without bodies: only their types are used.
template <class... Types>
std::variant<Types...> variant_of(TypeList<Types...>);
template <template <class> class Wrapper, class... Types>
TypeList<Wrapper<Types>...> wrapped(TypeList<Types...>);

template <class... Lists>
struct Concatenated;
template <class... Types>
struct Concatenated<TypeList<Types...>> {
  using type = TypeList<Types...>;
};
template <class... First, class... Second, class... Rest>
struct Concatenated<TypeList<First...>, TypeList<Second...>, Rest...> {
  using type = typename Concatenated<TypeList<First..., Second...>, Rest...>::type;
};

}  // namespace detail

/// The concatenation of lists.
template <class... Lists>
using Concatenated = typename detail::Concatenated<Lists...>::type;

/// The list of Wrapper<Type> for each type of a list.
template <template <class> class Wrapper, class List>
using Wrapped = decltype(detail::wrapped<Wrapper>(List{}));

/// A value of one of the types of a list.
template <class List>
using VariantOf = decltype(detail::variant_of(List{}));

}  // namespace sandglass
