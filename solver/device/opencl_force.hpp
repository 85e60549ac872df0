#pragma once

#include <mutex>

#include "assembly/processor.hpp"
#include "device/opencl.hpp"

namespace sandglass {

/// Elements whose forces an OpenCL device computes: a kernel for each law computes the forces of elements,
/// another one adds those at each node, always in the order of the elements, so that bits do not change from
/// run to run. Displacements are copied to the device at each evaluation, and forces back.
template <class Real>
class OpenClForce final : public DelegatingForce<Real> {
 public:
  /// As Processor::forces, which must not refuse them.
  OpenClForce(std::shared_ptr<const OpenClDevice> device, std::unique_ptr<InternalForce<Real>> own,
              const Mesh& mesh, const Materials& materials, const MethodChoice& choice);

  void evaluate(State<Real>& state, Rows<Real>& force) const override;

 private:
  /// The elements of a law: numbers first to first + count - 1 in the arrays of the device.
  struct Part {
    OpenClKernel kernel;
    std::size_t first;
    std::size_t count;
  };

  std::shared_ptr<const OpenClDevice> device_;
  std::size_t bytes_;  // of nodal values
  mutable std::mutex one_evaluation_;
  mutable OpenClBuffer u_, force_;
  std::vector<OpenClBuffer> constant_;  // buffers that kernels read
  std::vector<Part> parts_;
  std::unique_ptr<OpenClKernel> sum_;
  std::size_t sums_;
};

extern template class OpenClForce<double>;
extern template class OpenClForce<float>;

}  // namespace sandglass
