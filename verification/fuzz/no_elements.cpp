/// Readers make scenes and never compute. Fuzzers leave out the kernels, which take minutes to compile; these
/// functions are the ones that the linker still needs.

#include <stdexcept>

#include "support/own_kernels.hpp"

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

template <class Method, class Number>
Kernels<Number> kernels() {
  return {};
}

}  // namespace sandglass
