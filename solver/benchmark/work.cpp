#include "benchmark/work.hpp"

#include "element/formulation.hpp"
#include "element/methods.hpp"
#include "model/operations.hpp"

namespace sandglass {

double bytes_per_element(const Traffic& traffic, std::size_t bytes_of_number, const Layout& layout,
                         std::size_t elements) {
  const std::size_t blocks = layout.levels() * static_cast<std::size_t>(layout.width);
  const std::size_t numbers = blocks * (traffic.passes * traffic.constants + 2 * traffic.history) +
                              4 * layout.rows() * (traffic.rows_of_motion + rows_of_update);
  const std::size_t bytes =
      numbers * bytes_of_number + traffic.passes * layout.face_places.size() * sizeof(Place);
  return static_cast<double>(bytes) / static_cast<double>(elements);
}

Work work_of(const MethodChoice& choice, const AnyLaw& any_law, const Layout& layout, std::size_t elements) {
  Work work{};
  with_named_type(Methods{}, choice.method, [&]<class Method>() {
    std::visit(
        [&]<class Law>(const Law& /*law*/) {
          using Kernel = FormulationOf<Method, Law>;
          Traffic traffic{sizeof(typename Kernel::template Element<double>) / sizeof(double), 0, 1,
                          Kernel::passes};
          if constexpr (Kernel::remembers) {
            traffic.history = sizeof(typename Kernel::template History<double>) / sizeof(double);
          }
          if constexpr (Kernel::needs_increment) ++traffic.rows_of_motion;
          if constexpr (Kernel::needs_coordinates) ++traffic.rows_of_motion;
          // Displacements a second time, and the volumes that the first pass writes and the second reads.
          if constexpr (Kernel::averages_over_nodes) traffic.rows_of_motion += 3;
          const bool is_double = choice.precision == Precision::double_precision;
          work = {static_cast<double>(operations_of(choice.method, any_law).total()),
                  bytes_per_element(traffic, is_double ? sizeof(double) : sizeof(float), layout, elements)};
        },
        any_law);
  });
  return work;
}

}  // namespace sandglass
