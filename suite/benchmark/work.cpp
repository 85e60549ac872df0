#include "benchmark/work.hpp"

namespace sandglass {

double bytes_per_element(const Traffic& traffic, std::size_t bytes_of_number, const Layout& layout,
                         std::size_t elements) {
  const std::size_t blocks = layout.packs() * static_cast<std::size_t>(layout.width);
  const std::size_t numbers = blocks * (traffic.passes * traffic.constants + 2 * traffic.history) +
                              4 * layout.rows() * (traffic.rows_of_motion + rows_of_update);
  const std::size_t bytes =
      numbers * bytes_of_number + traffic.passes * layout.face_places.size() * sizeof(Place);
  return static_cast<double>(bytes) / static_cast<double>(elements);
}

Work work_of(const MethodChoice& choice, const AnyLaw& any_law, const Layout& layout, const Mesh& mesh) {
  const MethodEntry& method = method_named(choice.method);
  const KernelLaw law = kernel_law(any_law);
  const bool is_double = choice.precision == Precision::double_precision;
  const MethodWork work = work_of(method, law, shapes_in(mesh));
  return {
      static_cast<double>(work.operations.total.total()),
      bytes_per_element(work.traffic, is_double ? sizeof(double) : sizeof(float), layout, mesh.cells.size())};
}

}  // namespace sandglass
