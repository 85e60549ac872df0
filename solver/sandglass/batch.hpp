#pragma once

#include "sandglass/simulation.hpp"

namespace sandglass {

/// Many bodies of one case that move side by side, in `double` or `float`: for identification, training data
/// and studies of uncertainty. They share mesh, kinds of laws, densities, method, damping and step; each has
/// its own stiffness, parameters of laws, driven nodes and forces. A register holds one body in each lane, 8
/// in double and 16 in float with AVX-512, so that nothing is gathered (`sandglass bench --bodies`); empty
/// lanes cost as much as full ones.
///
/// Supported are methods that declare `batches`, isotropic elastic laws, imposed displacements, dead forces
/// and initial velocities. Steps follow from the stiffest element of all bodies; see Simulation.
template <class Real>
class Batch {
 public:
  /// `bodies` copies of the case of a file, at rest or with its initial velocities. Throws InputError for a
  /// case that a batch does not support.
  Batch(const std::filesystem::path& case_file, std::size_t bodies, const SimulationSettings& settings = {});

  /// The same with your own mesh; see Simulation.
  Batch(MeshArrays mesh, const std::string& case_text, std::size_t bodies,
        const SimulationSettings& settings = {});

  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;
  ~Batch();

  // Bodies count from 0; a number that is too large is an InputError.

  /// Multiplies all moduli of the case by `factor` for one body. The step adapts immediately.
  void scale_stiffness(std::size_t body, double factor);

  /// Replaces parameters of the laws of all bodies: for each material of the case, by the name of a parameter
  /// of its law, a value for each body. Others stay as they are. Throws InputError that names the material,
  /// the parameter, value and rule. An element then has constants for each body, which take as much more
  /// memory.
  void set_parameters(std::span<const std::map<std::string, std::vector<double>>> of_materials);

  /// Sets the targets of a body's driven nodes in a set for the next `advance`; see Simulation::move.
  void move(std::size_t body, const std::string& set, const std::array<double, 3>& displacement);

  /// The same with a displacement (m) for each node of the set, in the order of `nodes(set)`.
  void move(std::size_t body, const std::string& set, std::span<const std::array<double, 3>> displacements);

  /// The same for all driven nodes and the forces of a body; see Simulation::impose.
  void impose(std::size_t body, double factor);

  /// Advances all bodies by `seconds`; see Simulation::advance. Each thread computes its own bodies. Throws
  /// ComputationError, which names the body, for inverted elements, NaN and collapsing steps.
  void advance(double seconds);

  double time() const;       ///< s
  double step_size() const;  ///< s, the longest step at present

  /// The displacement (m) of a node of a body, in the numbering of the mesh.
  std::array<double, 3> displacement(std::size_t body, std::size_t node) const;

  /// See Simulation::reaction, N.
  std::array<double, 3> reaction(std::size_t body, const std::string& set) const;

  /// The number of bodies.
  std::size_t bodies() const;

  /// The number of nodes of a body.
  std::size_t nodes() const;

  /// The nodes of a set. Throws InputError for an unknown set.
  std::span<const int> nodes(const std::string& set) const;

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

extern template class Batch<double>;
extern template class Batch<float>;

}  // namespace sandglass
