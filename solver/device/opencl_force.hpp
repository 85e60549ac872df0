#pragma once

#include <mutex>

#include "assembly/processor.hpp"
#include "assembly/resident.hpp"
#include "device/opencl.hpp"
#include "written/force_program.hpp"

namespace sandglass {

/// Work items for so many nodes or elements: whole groups.
inline std::size_t in_groups(std::size_t count) {
  return (count + OpenClKernel::group - 1) / OpenClKernel::group * OpenClKernel::group;
}

/// Elements whose forces an OpenCL device computes: a kernel for each law computes the forces of elements,
/// another one adds those at each node, always in the order of the elements, so that bits do not change from
/// run to run. Displacements are copied to the device at each evaluation, and forces back, unless the state
/// of a moving body stays there (`resident`).
template <class Real>
class OpenClForce final : public DelegatingForce<Real>, public StateKeeper<Real> {
 public:
  /// As Processor::forces, which must not refuse them.
  OpenClForce(std::shared_ptr<const OpenClDevice> device, std::unique_ptr<InternalForce<Real>> own,
              const Mesh& mesh, const Materials& materials, const MethodChoice& choice);

  void evaluate(State<Real>& state, Rows<Real>& force) const override;

  std::unique_ptr<ResidentState<Real>> resident(const NodalProblem<Real>& problem) const override;

  const OpenClDevice& device() const { return *device_; }

  /// The forces of elements, and where those on each node are among them; see `move_nodes` in
  /// written/node_kernels.hpp.
  struct NodalSums {
    int elements;       ///< with those that fill groups
    std::size_t count;  ///< of slots
    OpenClBuffer first, slots, f;
  };
  const NodalSums& nodal_sums() const { return *nodal_sums_; }

  /// What the forces of elements cost.
  const StepTraffic& traffic() const { return traffic_; }

  /// Kernels keep their arguments, and forces of elements are in one array: as long as the returned object
  /// lives, no other thread uses them.
  std::scoped_lock<std::mutex> alone() const { return std::scoped_lock(one_evaluation_); }

  /// Queues the computation of the forces of elements, or of their smallest det F, at displacements u.
  void compute_forces(const OpenClBuffer& u) const;
  void compute_jacobians(const OpenClBuffer& u) const;
  const OpenClBuffer& jacobians() const { return *jacobians_; }

 private:
  /// A kernel for the elements of a law: numbers first to first + count - 1 in the arrays of the device. Its
  /// argument with number 2 is u.
  struct Part {
    OpenClKernel kernel;
    std::size_t first;
    std::size_t count;
  };

  void compute(std::vector<Part>& parts, const OpenClBuffer& u) const;

  std::shared_ptr<const OpenClDevice> device_;
  std::size_t bytes_;  // of nodal values
  mutable std::mutex one_evaluation_;
  mutable OpenClBuffer u_, force_;      // of evaluations
  std::vector<OpenClBuffer> constant_;  // buffers that kernels read
  std::unique_ptr<NodalSums> nodal_sums_;
  std::unique_ptr<OpenClBuffer> jacobians_;
  StepTraffic traffic_;
  std::vector<std::size_t> held_;  // bytes of buffers
  mutable std::vector<Part> forces_, smallest_jacobians_;
  std::unique_ptr<OpenClKernel> sum_;
  std::size_t sums_;
};

extern template class OpenClForce<double>;
extern template class OpenClForce<float>;

}  // namespace sandglass
