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
#include "written/shared_program.hpp"

namespace sandglass {

namespace {

/// Laws that differ in parameters only, and their elements.
struct LawGroup {
  SharedProgram shared;
  std::size_t first = 0, count = 0;  // of elements in the order of the device
};

/// The laws of some materials in groups.
struct LawGroups {
  std::vector<LawGroup> groups;
  std::vector<std::size_t> group_of, number_in_group;  // of laws
};

LawGroups law_groups(const std::vector<Material>& materials, const std::vector<std::size_t>& alike,
                     std::string_view method) {
  LawGroups laws;
  std::vector<std::size_t> members;
  for (std::size_t law = 0; law <= std::ranges::max(alike); ++law) {
    const auto one = std::ranges::find(alike, law) - alike.begin();
    const Material& material = materials[static_cast<std::size_t>(one)];
    const ForceProgram program =
        force_program(method, elastic_law(kernel_law(material)), has_fibres(material.law));
    std::size_t group = 0;
    while (group < laws.groups.size() && !laws.groups[group].shared.add(program)) ++group;
    if (group == laws.groups.size()) {
      laws.groups.push_back({SharedProgram(program)});
      members.push_back(0);
    }
    laws.group_of.push_back(group);
    laws.number_in_group.push_back(members[group]++);
  }
  return laws;
}

/// The elements in the order of the device: by group of laws, each group's in a multiple of a work group,
/// filled up with repetitions of its last one, whose forces nobody adds.
struct DeviceOrder {
  std::vector<int> elements;
  std::vector<std::size_t> place_of;  // of each element
};

/// `group_of(e)` is that of an element. Sets the places of the groups.
template <class GroupOf>
DeviceOrder device_order(std::size_t elements, std::vector<LawGroup>& groups, const GroupOf& group_of) {
  DeviceOrder order;
  order.place_of.resize(elements);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    groups[g].first = order.elements.size();
    for (std::size_t e = 0; e < elements; ++e) {
      if (group_of(e) != g) continue;
      order.place_of[e] = order.elements.size();
      order.elements.push_back(static_cast<int>(e));
    }
    if (order.elements.size() == groups[g].first) continue;
    order.elements.resize(in_groups(order.elements.size()), order.elements.back());
    groups[g].count = order.elements.size() - groups[g].first;
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
  const auto alike = numbers_of_alike(materials);
  LawGroups laws = law_groups(materials.list, alike, choice.method);
  const auto law_of = [&](std::size_t e) { return alike[materials.of(e)]; };
  const DeviceOrder order =
      device_order(mesh.cells.size(), laws.groups, [&](std::size_t e) { return laws.group_of[law_of(e)]; });
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

  std::vector<std::vector<Real>> parameters;  // of each group
  std::size_t parameter_count = 0;
  for (std::size_t g = 0; g < laws.groups.size(); ++g) {
    const auto of_laws = laws.groups[g].shared.parameters();
    parameters.push_back(by_number<Real>(order, [&](std::size_t e) {
      const bool is_member = laws.group_of[law_of(e)] == g;
      std::vector<Real> values;
      for (const Constant& one : of_laws[is_member ? laws.number_in_group[law_of(e)] : 0])
        values.push_back(one.as<Real>());
      return values;
    }));
    parameter_count += parameters.back().size();
  }

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
           parameter_count * sizeof(Real),
           slots.size() * sizeof(int),
           order.elements.size() * sizeof(Real),
           results};
  device_->require_room(held_);

  constant_.reserve(4 + laws.groups.size());  // kernels refer to them
  const auto keep = [&]<class Values>(const Values& values) -> const OpenClBuffer& {
    return constant_.emplace_back(*device_, values);
  };
  const OpenClBuffer &on_places = keep(places), &on_constants = keep(constants), &on_axes = keep(axes),
                     &on_coordinates = keep(coordinates);
  nodal_sums_ = std::make_unique<NodalSums>(NodalSums{
      static_cast<int>(count), slots.size(), {*device_, first}, {*device_, slots}, {*device_, results}});
  jacobians_ = std::make_unique<OpenClBuffer>(*device_, order.elements.size() * sizeof(Real));
  const Dialect& dialect = dialect_named("opencl");
  const auto kernel_of = [&](const ForceProgram& program, const OpenClBuffer& on_parameters,
                             const OpenClBuffer& result) {
    OpenClKernel kernel(*device_,
                        kernel_text<Real>(program, dialect, {"of_elements", {}}, NodalValues::of_nodes),
                        "of_elements");
    kernel.set(count, on_places);
    cl_uint next = 2;
    for (const KernelArray& array : program.arrays) {
      kernel.set_argument(next++, array.name == "u"           ? u_
                                  : array.name == "X"         ? on_coordinates
                                  : array.name == "constants" ? on_constants
                                  : array.name == "axes"      ? on_axes
                                                              : on_parameters);
    }
    kernel.set_argument(next, result);
    return kernel;
  };
  for (std::size_t g = 0; g < laws.groups.size(); ++g) {
    const auto& [shared, first_element, number] = laws.groups[g];
    if (number == 0) continue;
    forces_.push_back(
        {kernel_of(shared.program(), keep(parameters[g]), nodal_sums_->f), first_element, number});
  }
  const ForceProgram jacobian = jacobian_program(choice.method);
  const bool reads_coordinates = std::ranges::count(jacobian.arrays, "X", &KernelArray::name) > 0;
  traffic_ = {static_cast<int>(forces_.size()),
              results + places.size() * sizeof(int) +
                  (constants.size() + axes.size() + parameter_count) * sizeof(Real) +
                  (reads_coordinates ? 2 : 1) * bytes_};
  smallest_jacobians_.push_back({kernel_of(jacobian, on_constants, *jacobians_), 0, order.elements.size()});
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
