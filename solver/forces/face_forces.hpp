#pragma once

#include <optional>
#include <vector>

#include "math/recorded.hpp"
#include "mesh/face_load.hpp"

namespace sandglass {

/// Forces on faces as a straight-line program of one face, for other processors. Its inputs are the motion
/// (m) of the four corners, component i of corner I in place 3 I + i, then the numbers of `constants`; its
/// results are the forces (N) on the corners in the same order, at the factor one.
struct FaceForces {
  /// What the motion of the corners is, and the factor that multiplies the forces.
  enum class Resists { displacements, velocities };

  std::vector<Quadrilateral> faces;
  Program program;
  std::vector<std::vector<double>> constants;  ///< of each face
  std::optional<std::size_t> curve = {};       ///< whose factor multiplies the forces; none: one
  Resists motion = Resists::displacements;     ///< velocities: increments (m), and the factor is 1 / step
};

/// Records the forces on a face: forces(motion, constants) computes them from `numbers` constants.
template <class Forces>
Program face_program(std::size_t numbers, const Forces& forces) {
  Tape tape;
  std::array<Triple<Recorded>, 4> motion;
  for (auto& corner : motion) {
    for (Recorded& component : corner.entries) component = tape.input();
  }
  std::vector<Recorded> constants(numbers), results;
  for (Recorded& constant : constants) constant = tape.input();
  for (const auto& force : forces(motion, constants))
    results.insert(results.end(), force.entries.begin(), force.entries.end());
  return tape.program(results);
}

}  // namespace sandglass
