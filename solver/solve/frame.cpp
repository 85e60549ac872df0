#include "solve/frame.hpp"

#include "assembly/face_gather.hpp"

namespace sandglass {

template <class Real>
Frame frame_of(const Body<Real>& body, double time, NodalField v) {
  const InternalForce<Real>& elements = body.elements();
  const State<Real>& state = body.state();
  const Mesh& mesh = body.scene().mesh;
  const std::size_t count = mesh.cells.size();
  Frame frame{time,
              body.field(state.u),
              std::move(v),
              std::vector<double>(count),
              std::vector<double>(count),
              elements.levels(state),
              std::vector<double>(9 * count),
              body.reactions_of_sets(),
              body.moments_of_obstacles()};
  elements.jacobians(state, frame.jacobians);
  elements.hourglass_energy_densities(state, frame.hourglass_energy_densities);
  elements.stresses(state, centred_coordinates<Real>(mesh.points, body.layout()), frame.stresses);
  for (auto* values : {&frame.jacobians, &frame.hourglass_energy_densities, &frame.levels, &frame.stresses}) {
    if (!values->empty()) gather_elements(body.layout(), *values, count);
  }
  return frame;
}

Frame static_frame(const Model& model, double time, const NodalField& u) {
  return std::visit(
      [&]<class Real>(const std::unique_ptr<InternalForce<Real>>& elements) {
        Body<Real> body(model, *elements);
        body.state() = state_at(*elements, u);
        body.evaluate_forces();
        return frame_of(body, time, NodalField(u.size()));
      },
      model.internal_force());
}

template Frame frame_of(const Body<double>&, double, NodalField);
template Frame frame_of(const Body<float>&, double, NodalField);

}  // namespace sandglass
