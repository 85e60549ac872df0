#include "device/opencl_force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "assembly/face_gather.hpp"
#include "base/error.hpp"
#include "mesh/node_elements.hpp"
#include "written/kernel_text.hpp"

namespace sandglass {

namespace {

/// Adds the forces of the elements around each node. `slots` are the places of the first components.
constexpr std::string_view sum_text = R"(
__kernel void sum_at_nodes(long nodes, long count, __global const int* restrict first,
                           __global const int* restrict slots, __global const {real}* restrict f,
                           __global {real}* restrict force) {{
  const long node = get_global_id(0);
  if (node < nodes) {{
    {real} x = 0, y = 0, z = 0;
    for (int k = first[node]; k < first[node + 1]; ++k) {{
      x += f[slots[k]];
      y += f[slots[k] + count];
      z += f[slots[k] + 2 * count];
    }}
    force[4 * node] = x;
    force[4 * node + 1] = y;
    force[4 * node + 2] = z;
    force[4 * node + 3] = 0;
  }}
}}
)";

std::size_t rounded_up(std::size_t count) {
  return (count + OpenClKernel::group - 1) / OpenClKernel::group * OpenClKernel::group;
}

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
    order.elements.resize(rounded_up(order.elements.size()), order.elements.back());
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
      sums_(rounded_up(mesh.points.size())) {
  const Layout& layout = this->layout();
  const DeviceOrder order = device_order(mesh, materials);
  const auto count = static_cast<cl_long>(order.elements.size());
  const auto row = [&](int node) { return at(layout.row_of_node[at(node)]); };

  const auto places = by_number<int>(order, [&](std::size_t e) {
    std::vector<Place> own_places;
    for (const int node : mesh.cells[e]) own_places.push_back(place_of_row(row(node)));
    return own_places;
  });
  const auto constants = by_number<Real>(order, [&](std::size_t e) {
    const Material& material = materials.list[materials.of(e)];
    const HourglassSettings settings{
        .kappa = choice.kappa, .density = material.density, .kappa_modulus = choice.kappa_modulus};
    return element_constants(choice.method, gather(mesh.points, mesh.cells[e]),
                             elastic_law(kernel_law(material)),
                             materials.axes.empty() ? nullptr : &materials.axes[e], settings);
  });
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
  device_->require_room(std::array{2 * bytes_, bytes_ + places.size() * sizeof(int),
                                   constants.size() * sizeof(Real), axes.size() * sizeof(Real),
                                   slots.size() * sizeof(int), results});

  constant_.reserve(7);  // kernels refer to them
  const auto keep = [&]<class Values>(const Values& values) -> const OpenClBuffer& {
    return constant_.emplace_back(*device_, values);
  };
  const OpenClBuffer &on_places = keep(places), &on_constants = keep(constants), &on_axes = keep(axes);
  const OpenClBuffer &on_coordinates = keep(coordinates), &f = keep(results);
  const Dialect& dialect = dialect_named("opencl");
  for (const auto& [material, first_element, number] : order.laws) {
    const AnyLaw& law = materials.list[material].law;
    const ForceProgram program =
        force_program(choice.method, elastic_law(kernel_law(materials.list[material])), has_fibres(law));
    OpenClKernel kernel(*device_,
                        kernel_text<Real>(program, dialect, {"element_forces", {}}, NodalValues::of_nodes),
                        "element_forces");
    kernel.set(count, on_places);
    cl_uint next = 2;
    for (const KernelArray& array : program.arrays) {
      kernel.set_argument(next++, array.name == "u"           ? u_
                                  : array.name == "X"         ? on_coordinates
                                  : array.name == "constants" ? on_constants
                                                              : on_axes);
    }
    kernel.set_argument(next, f);
    parts_.push_back({std::move(kernel), first_element, number});
  }
  sum_ = std::make_unique<OpenClKernel>(
      *device_, fmt::format(sum_text, fmt::arg("real", sizeof(Real) == sizeof(float) ? "float" : "double")),
      "sum_at_nodes");
  sum_->set(static_cast<cl_long>(mesh.points.size()), count, keep(first), keep(slots), f, force_);
}

template <class Real>
void OpenClForce<Real>::evaluate(State<Real>& state, Rows<Real>& force) const {
  const std::scoped_lock lock(one_evaluation_);
  u_.write(state.u.data(), bytes_);
  for (const Part& part : parts_) part.kernel.run(part.first, part.count);
  sum_->run(0, sums_);
  force_.read(force.data(), bytes_);
}

template class OpenClForce<double>;
template class OpenClForce<float>;

}  // namespace sandglass
