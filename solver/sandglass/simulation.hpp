#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"

/// Sandglass in your own program: a body that you move, step and inspect while it runs. This header has no
/// kernels: it needs C++20, but no other header and no compiler flag.
namespace sandglass {

/// A mesh in memory, with named sets of nodes and of elements.
struct MeshArrays {
  std::vector<std::array<double, 3>> points = {};             ///< m
  std::vector<std::array<int, 8>> cells = {};                 ///< hexahedra in VTK order; nodes count from 0
  std::map<std::string, std::vector<int>> sets = {};          ///< name -> nodes
  std::map<std::string, std::vector<int>> element_sets = {};  ///< name -> elements
};

/// Settings of a program in addition to the case.
struct SimulationSettings {
  std::optional<std::string> method =
      {};                              ///< see `sandglass methods`; none: the case's, else tl-perturbation
  std::optional<double> kappa = {};    ///< strength of the hourglass control; none: the case's, else auto
  std::optional<double> damping = {};  ///< 1/s, proportional to mass; none: the case's
  std::optional<double> step_fraction =
      {};                      ///< the longest step over the stable one, in (0, 1]; none: the case's
  int threads = 1;             ///< does not affect the bits
  std::string device = "cpu";  ///< "opencl" or "opencl:2": takes the steps, and keeps the body
};

/// One vector per node where the time loop keeps it: component i of row r is at data[stride * r + i]. Rows
/// are in the order of the loop; `Simulation::row_of_node` has the row of each node.
template <class Real>
struct NodalView {
  static constexpr std::size_t stride = 4;  ///< numbers from one row to the next

  const Real* data;  ///< of the first row
  std::size_t rows;  ///< as many as there are nodes

  /// The components of a row.
  const Real* operator[](std::size_t row) const { return data + stride * row; }
};

/// A body in motion, in `double` or `float`: central differences with lumped masses, as in a dynamic run of
/// `sandglass run`, subcycles included, but you set the targets of driven nodes, frame by frame. Components
/// with an imposed displacement or rotation in the case are driven; they start at rest in their positions in
/// the mesh.
///
/// It is a value: a copy is an independent snapshot that shares all constant data. Several may run
/// simultaneously, each in one thread at a time. Wrong input throws InputError; a failing body throws
/// ComputationError and returns to its last sound state, from which it may move elsewhere.
template <class Real>
class Simulation {
 public:
  /// The case of a file, at rest or with its initial velocities. A mesh of another program is converted by a
  /// process, SANDGLASS_PYTHON (else /usr/bin/python3) with convert.py from the folder SANDGLASS_EXCHANGE
  /// (else exchange/), both variables of the environment; no other case starts one.
  explicit Simulation(const std::filesystem::path& case_file, const SimulationSettings& settings = {});

  /// The same with your own mesh: `case_text` is the text of a case file without [mesh]; its sets are added
  /// to the sets of the mesh.
  Simulation(MeshArrays mesh, const std::string& case_text, const SimulationSettings& settings = {});

  Simulation(const Simulation& other);      ///< a snapshot
  Simulation(Simulation&& other) noexcept;  ///< afterwards `other` can only be assigned to or destroyed
  Simulation& operator=(const Simulation& other);      ///< a snapshot
  Simulation& operator=(Simulation&& other) noexcept;  ///< like the constructor
  ~Simulation();

  /// Sets the target of a set's driven nodes for the end of the next `advance`: `displacement` (m) for all of
  /// them. Components that the case does not impose on the set stay as they are. If it imposes nothing on the
  /// set, the components that it imposes on the set's nodes through other sets move. Nodes without a new
  /// target keep their last one. With the name of an [[obstacle]], its target: a displacement in addition to
  /// its path in the case. Throws InputError for a set without driven nodes, listing the driven sets, and for
  /// numbers that are not finite.
  void move(const std::string& set, const std::array<double, 3>& displacement);

  /// The same with a displacement (m) for each node of `nodes(set)`; too few are an InputError.
  void move(const std::string& set, std::span<const std::array<double, 3>> displacements);

  /// The same for all driven nodes together: their displacements in the case at a load factor, which is 1 at
  /// the end of its loading curve. The forces of the case grow to that factor; before the first call they are
  /// zero.
  void impose(double factor);

  /// Advances by `seconds`, in equal steps of at most `step_size()`; driven nodes and forces change linearly
  /// to their targets. n steps are `advance(n * step_size())`. Every check_interval steps (of the case) it
  /// looks for inverted elements and NaN, and adapts the step to the present stiffness of the body; at the
  /// end it looks for NaN. ComputationError names the time and the failed elements, by their numbers in the
  /// mesh; the body is then back at the last check (at `time()`), with the driven nodes and forces of that
  /// time until you set new targets, and you may continue with a smaller motion.
  void advance(double seconds);

  /// Moves the body to its static equilibrium with driven nodes and forces at their new values, and stops it
  /// there; the time does not change. Driven nodes move straight from the undeformed body to these values, in
  /// load levels as in a quasi-static run of `sandglass run`, with the [relaxation] of the case; the
  /// elements' history is as after a single step. Returns the number of evaluations of the internal forces.
  /// Throws ComputationError if no equilibrium is found; the body is then as it was.
  long settle();

  /// Writes the present state and the targets of driven nodes to a file, which is replaced as a whole or not
  /// at all. Throws InputError or ComputationError if that fails.
  void save(const std::filesystem::path& file) const;

  /// Takes the state that `save` wrote; the same program continues from it with the same bits. Throws
  /// InputError for a damaged file, and for one of another case, mesh or settings, with the differences.
  void resume(const std::filesystem::path& file);

  double time() const;       ///< s
  double step_size() const;  ///< s, the longest step at present

  /// Displacements (m) of all nodes. The view always shows the present ones, as long as the simulation lives,
  /// and costs nothing.
  NodalView<Real> displacements() const;

  /// The row of each node in views. Renumber your drawing once, and no frame needs a copy.
  std::span<const int> row_of_node() const;

  /// The force (N) that holds or drives a set of nodes: the sum over the components that `move` moves,
  /// without the inertia of the nodes themselves. Or the force of the obstacle of this name on the body.
  /// Throws InputError like `move`.
  std::array<double, 3> reaction(const std::string& set) const;

  /// The moment (N m) of the force of an obstacle on the body about the obstacle's `point` where it is now.
  /// Throws InputError for an unknown obstacle.
  std::array<double, 3> moment(const std::string& obstacle) const;

  // The mesh, in its own numbering.

  std::span<const std::array<double, 3>> points() const;  ///< m
  std::span<const std::array<int, 8>> cells() const;      ///< nodes of the hexahedra, in VTK order
  /// The nodes of a set. Throws InputError for an unknown set.
  std::span<const int> nodes(const std::string& set) const;

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

extern template class Simulation<double>;
extern template class Simulation<float>;

}  // namespace sandglass
