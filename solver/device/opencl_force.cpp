#include "device/opencl_force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "assembly/face_gather.hpp"
#include "base/error.hpp"
#include "device/opencl_state.hpp"
#include "mesh/node_elements.hpp"
#include "written/kernel_text.hpp"
#include "written/mesh_constants.hpp"
#include "written/node_kernels.hpp"

namespace sandglass {

namespace {

/// The elements in the order of the device: by law, each law's in a multiple of a work group, filled up with
/// repetitions of its last one, whose forces nobody adds.
struct DeviceOrder {
  std::vector<int> elements;
  std::vector<std::size_t> place_of;  // of each element
  struct Law {
    std::size_t material;  // one that has it
    std::size_t first;
    std::size_t count;
  };
  std::vector<Law> laws;
};

DeviceOrder device_order(const Mesh& mesh, const Materials& materials) {
  const auto alike = numbers_of_alike(materials);
  DeviceOrder order;
  order.place_of.resize(mesh.cells.size());
  for (std::size_t law = 0; law <= std::ranges::max(alike); ++law) {
    const std::size_t first = order.elements.size();
    for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
      if (alike[materials.of(e)] != law) continue;
      order.place_of[e] = order.elements.size();
      order.elements.push_back(static_cast<int>(e));
    }
    if (order.elements.size() == first) continue;
    order.elements.resize(in_groups(order.elements.size()), order.elements.back());
    order.laws.push_back({materials.of(at(order.elements[first])), first, order.elements.size() - first});
  }
  return order;
}

/// Number k of element e at k * count + e; `numbers(e)` returns those of one element.
template <class T, class Numbers>
std::vector<T> by_number(const DeviceOrder& order, const Numbers& numbers) {
  const std::size_t count = order.elements.size();
  std::vector<T> all;
  for (std::size_t e = 0; e < count; ++e) {
    const auto own = numbers(at(order.elements[e]));
    all.resize(own.size() * count);
    for (std::size_t k = 0; k < own.size(); ++k) all[k * count + e] = static_cast<T>(own[k]);
  }
  return all;
}

}  // namespace

template <class Real>
OpenClForce<Real>::OpenClForce(std::shared_ptr<const OpenClDevice> device,
                               std::unique_ptr<InternalForce<Real>> own, const Mesh& mesh,
                               const Materials& materials, const MethodChoice& choice)
    : DelegatingForce<Real>(std::move(own)),
      device_(std::move(device)),
      bytes_(mesh.points.size() * sizeof(Row<Real>)),
      u_(*device_, bytes_),
      force_(*device_, bytes_),
      sums_(in_groups(mesh.points.size())) {
  const Layout& layout = this->layout();
  const DeviceOrder order = device_order(mesh, materials);
  const auto count = static_cast<cl_long>(order.elements.size());
  const auto row = [&](int node) { return at(layout.row_of_node[at(node)]); };

  const auto places = by_number<int>(order, [&](std::size_t e) {
    std::vector<Place> own_places;
    for (const int node : mesh.cells[e]) own_places.push_back(place_of_row(row(node)));
    return own_places;
  });
  const auto constants =
      by_number<Real>(order, [&](std::size_t e) { return constants_of(mesh, materials, choice, e); });
  std::vector<Real> axes;
  if (!materials.axes.empty())
    axes = by_number<Real>(order, [&](std::size_t e) { return materials.axes[e].entries; });

  std::vector<int> first{0}, slots;
  const NodeElements elements(mesh);
  for (std::size_t r = 0; r < mesh.points.size(); ++r) {
    const int node = layout.node_of_row[r];
    for (const int e : elements.around(node)) {
      const auto& cell = mesh.cells[at(e)];
      const auto corner = std::ranges::find(cell, node) - cell.begin();
      slots.push_back(static_cast<int>(3 * corner * count + static_cast<cl_long>(order.place_of[at(e)])));
    }
    first.push_back(static_cast<int>(slots.size()));
  }
  const Rows<Real> coordinates = centred_coordinates<Real>(mesh.points, layout);
  const std::size_t results = 3 * Hexahedron{}.size() * order.elements.size() * sizeof(Real);
  held_ = {2 * bytes_,
           bytes_ + places.size() * sizeof(int),
           constants.size() * sizeof(Real),
           axes.size() * sizeof(Real),
           slots.size() * sizeof(int),
           order.elements.size() * sizeof(Real),
           results};
  device_->require_room(held_);

  constant_.reserve(4);  // kernels refer to them
  const auto keep = [&]<class Values>(const Values& values) -> const OpenClBuffer& {
    return constant_.emplace_back(*device_, values);
  };
  const OpenClBuffer &on_places = keep(places), &on_constants = keep(constants), &on_axes = keep(axes),
                     &on_coordinates = keep(coordinates);
  nodal_sums_ = std::make_unique<NodalSums>(NodalSums{
      static_cast<int>(count), slots.size(), {*device_, first}, {*device_, slots}, {*device_, results}});
  jacobians_ = std::make_unique<OpenClBuffer>(*device_, order.elements.size() * sizeof(Real));
  const Dialect& dialect = dialect_named("opencl");
  const auto kernel_of = [&](const ForceProgram& program, const OpenClBuffer& result) {
    OpenClKernel kernel(*device_,
                        kernel_text<Real>(program, dialect, {"of_elements", {}}, NodalValues::of_nodes),
                        "of_elements");
    kernel.set(count, on_places);
    cl_uint next = 2;
    for (const KernelArray& array : program.arrays) {
      kernel.set_argument(next++, array.name == "u"           ? u_
                                  : array.name == "X"         ? on_coordinates
                                  : array.name == "constants" ? on_constants
                                                              : on_axes);
    }
    kernel.set_argument(next, result);
    return kernel;
  };
  for (const auto& [material, first_element, number] : order.laws) {
    const AnyLaw& law = materials.list[material].law;
    forces_.push_back(
        {kernel_of(
             force_program(choice.method, elastic_law(kernel_law(materials.list[material])), has_fibres(law)),
             nodal_sums_->f),
         first_element, number});
  }
  const ForceProgram jacobian = jacobian_program(choice.method);
  const bool reads_coordinates = std::ranges::count(jacobian.arrays, "X", &KernelArray::name) > 0;
  traffic_ = {static_cast<int>(order.laws.size()), results + places.size() * sizeof(int) +
                                                       (constants.size() + axes.size()) * sizeof(Real) +
                                                       (reads_coordinates ? 2 : 1) * bytes_};
  smallest_jacobians_.push_back({kernel_of(jacobian, *jacobians_), 0, order.elements.size()});
  sum_ = std::make_unique<OpenClKernel>(
      *device_, node_kernel_text<Real>(node_kernel("sum_at_nodes"), dialect), "sum_at_nodes");
  sum_->set(static_cast<cl_long>(mesh.points.size()), nodal_sums_->elements, nodal_sums_->first,
            nodal_sums_->slots, nodal_sums_->f, force_);
}

template <class Real>
void OpenClForce<Real>::compute(std::vector<Part>& parts, const OpenClBuffer& u) const {
  for (Part& part : parts) {
    part.kernel.set_argument(2, u);
    part.kernel.run(part.first, part.count);
  }
}

template <class Real>
void OpenClForce<Real>::compute_forces(const OpenClBuffer& u) const {
  compute(forces_, u);
}

template <class Real>
void OpenClForce<Real>::compute_jacobians(const OpenClBuffer& u) const {
  compute(smallest_jacobians_, u);
}

template <class Real>
void OpenClForce<Real>::evaluate(State<Real>& state, Rows<Real>& force) const {
  const auto lock = alone();
  u_.write(state.u.data(), bytes_);
  compute_forces(u_);
  sum_->run(0, sums_);
  force_.read(force.data(), bytes_);
}

template <class Real>
std::unique_ptr<ResidentState<Real>> OpenClForce<Real>::resident(const NodalProblem<Real>& problem) const {
  std::vector<std::size_t> all = held_;
  all.insert(all.end(), 4, bytes_);  // displacements, increments, forces and loads
  all.push_back(8 * (problem.dead_loads.size() + problem.constraints.size()) * sizeof(Real));
  for (const FaceForces& own : problem.face_forces)
    all.push_back(own.faces.size() * (12 + own.constants.front().size()) * sizeof(Real));
  device_->require_room(all);
  return std::make_unique<OpenClState<Real>>(*this, problem);
}

template class OpenClForce<double>;
template class OpenClForce<float>;

}  // namespace sandglass
