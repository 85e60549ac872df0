/// Readers make scenes and never compute. The kernels, minutes of compilation, stay out of the fuzzers; these
/// are the names that the linker still asks for.

#include <array>
#include <stdexcept>

#include "assembly/method_facts.hpp"
#include "element/methods.hpp"

namespace sandglass {

namespace {

[[noreturn]] void refuse() {
  throw std::logic_error("a reader asked for elements");
}

}  // namespace

AnyInternalForce make_internal_force(const Mesh& /*mesh*/, const Materials& /*materials*/,
                                     const MethodChoice& /*choice*/) {
  refuse();
}

template <class Real>
NodalField to_field(const Rows<Real>& /*rows*/, const Layout& /*layout*/) {
  refuse();
}

template <class Real>
State<Real> state_at(const InternalForce<Real>& /*elements*/, const NodalField& /*u*/) {
  refuse();
}

template NodalField to_field(const Rows<double>&, const Layout&);
template NodalField to_field(const Rows<float>&, const Layout&);
template State<double> state_at(const InternalForce<double>&, const NodalField&);
template State<float> state_at(const InternalForce<float>&, const NodalField&);

template <class Method>
MethodEntry method_entry() {
  return method_facts<Method>();
}

namespace {

/// Makes the compiler emit all entries, which the list is made of.
template <class... Method>
auto entries_of(TypeList<Method...> /*methods*/) {
  return std::array{&method_entry<Method>...};
}

[[gnu::used]] const auto entries = entries_of(Methods{});

}  // namespace

}  // namespace sandglass
