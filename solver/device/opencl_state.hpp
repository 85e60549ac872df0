#pragma once

#include "device/opencl_force.hpp"

namespace sandglass {

/// A moving body whose state stays on an OpenCL device. A step is one launch per law of the elements, one per
/// set of loaded faces, and one for the nodes (`move_nodes`). The numbers of several steps are sent together,
/// and their launches queued without waiting. States of the same elements may be used by several threads.
template <class Real>
class OpenClState final : public ResidentState<Real> {
 public:
  /// `elements` must outlive the state, and not be evaluated while it takes steps. Throws InputError if the
  /// device has too little memory.
  OpenClState(const OpenClForce<Real>& elements, const NodalProblem<Real>& problem);

  StepTraffic step_traffic() const override { return traffic_; }
  void redirect(std::span<const typename NodalProblem<Real>::Share> shares) override;
  void write(const ResidentBody<Real>& body) override;
  void take(std::span<const ResidentStep> steps) override;
  void wait() override;
  bool is_healthy() override;
  void read(ResidentBody<Real>& body) override;

 private:
  struct Loads;

  /// A kernel for the loaded faces in columns first to first + count - 1 of g.
  struct Faces {
    OpenClKernel kernel;
    std::size_t first;
    std::size_t count;
  };

  const OpenClBuffer& keep(OpenClBuffer buffer);
  void clear_works();
  StepTraffic traffic_of(const std::vector<int>& first_load, const std::vector<FaceForces>& faces) const;

  const OpenClForce<Real>& elements_;
  const OpenClDevice& device_;
  std::size_t nodes_;
  std::vector<std::size_t> by_row_;  // constraints in the order of the device
  std::vector<Real> shares_;         // of their paths, m, and their masses, kg
  std::size_t numbers_of_step_;
  StepTraffic traffic_;
  std::vector<std::unique_ptr<OpenClBuffer>> constant_;  // buffers that kernels read
  std::vector<Faces> faces_;
  OpenClKernel move_, find_ill_;
  OpenClBuffer on_shares_, u_, increment_, force_, load_, load_work_, reaction_, driving_, work_, ill_;
};

}  // namespace sandglass
