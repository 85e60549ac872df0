#include "assembly/internal_force.hpp"

#include <fmt/format.h>

#include "assembly/method_entry.hpp"
#include "assembly/processor.hpp"
#include "base/error.hpp"

namespace sandglass {

namespace {

void require_sensible(const MethodChoice& choice, const MethodEntry& method) {
  if (choice.kappa && !method.takes_kappa) {
    throw InputError(fmt::format("kappa: {} was given, but method '{}' has no such parameter; leave it out",
                                 *choice.kappa, choice.method));
  }
  if (choice.kappa && !(*choice.kappa >= 0.0)) {
    throw InputError(fmt::format("kappa: {} must be in [0, inf), or 'auto'", *choice.kappa));
  }
  if (!(choice.accuracy > 0.0)) {
    throw InputError(fmt::format("accuracy: {} must be positive", choice.accuracy));
  }
  if (choice.threads < 1) {
    throw InputError(fmt::format("threads: {} must be at least 1", choice.threads));
  }
  if (choice.kernel == KernelWidth::scalar && choice.precision == Precision::single_precision) {
    throw InputError("kernel: the scalar kernel exists in double precision only");
  }
}

}  // namespace

bool has_scalar_kernels() {
  return methods().front().scalar_double != nullptr;
}

namespace {

AnyInternalForce own_internal_force(const Mesh& mesh, const Materials& materials,
                                    const MethodChoice& choice) {
  const MethodEntry& method = method_named(choice.method);
  require_sensible(choice, method);
  for (const Material& material : materials.list) {
    if (method.knows_viscoelasticity || !is_viscoelastic(material.law)) continue;
    throw InputError(fmt::format(
        "law: '{}' is viscoelastic, which method '{}' does not support; allowed: an elastic law, or "
        "another method",
        name_of(material.law), method.name));
  }
  const Team team{choice.threads, choice.ranks};
  const HourglassSettings settings{.kappa = choice.kappa, .kappa_modulus = choice.kappa_modulus};
  if (choice.kernel == KernelWidth::scalar) {
    if (!has_scalar_kernels()) {
      throw InputError("kernel: this program has no scalar kernels; sandglass-scalar has");
    }
    return method.scalar_double().assemble(mesh, materials, settings, team);
  }
  if (choice.precision == Precision::double_precision) {
    return method.packed_double.assemble(mesh, materials, settings, team);
  }
  return method.packed_float.assemble(mesh, materials, settings, team);
}

}  // namespace

AnyInternalForce make_internal_force(const Mesh& mesh, const Materials& materials,
                                     const MethodChoice& choice) {
  AnyInternalForce own = own_internal_force(mesh, materials, choice);
  if (choice.processor == nullptr) return own;
  return std::visit(
      [&](auto elements) -> AnyInternalForce {
        return choice.processor->forces(std::move(elements), mesh, materials, choice);
      },
      std::move(own));
}

template <class Real>
Rows<Real> to_rows(const NodalField& field, const Layout& layout) {
  Rows<Real> rows(layout.rows());
  for (std::size_t r = 0; r < layout.nodes; ++r) {
    const Vector& value = field[static_cast<std::size_t>(layout.node_of_row[r])];
    for (std::size_t i = 0; i < 3; ++i) rows[r][i] = static_cast<Real>(value[i]);
  }
  return rows;
}

template <class Real>
NodalField to_field(const Rows<Real>& rows, const Layout& layout) {
  NodalField field(layout.nodes);
  for (std::size_t r = 0; r < layout.nodes; ++r) {
    Vector& value = field[static_cast<std::size_t>(layout.node_of_row[r])];
    for (std::size_t i = 0; i < 3; ++i) value[i] = static_cast<double>(rows[r][i]);
  }
  return field;
}

template <class Real>
State<Real> state_at(const ElementForces<Real>& elements, const NodalField& u) {
  State<Real> state = elements.undeformed();
  state.u = to_rows<Real>(u, elements.layout());
  state.increment = state.u;
  return state;
}

template Rows<double> to_rows(const NodalField&, const Layout&);
template Rows<float> to_rows(const NodalField&, const Layout&);
template NodalField to_field(const Rows<double>&, const Layout&);
template NodalField to_field(const Rows<float>&, const Layout&);
template State<double> state_at(const ElementForces<double>&, const NodalField&);
template State<float> state_at(const ElementForces<float>&, const NodalField&);

}  // namespace sandglass
