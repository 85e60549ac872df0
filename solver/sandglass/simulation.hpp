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

/// Sandglass in a program of your own: a body that you move, step and look at while it runs. What includes
/// this header needs C++20, no other header and no flag of the compiler: no kernel is in it.
namespace sandglass {

/// A mesh in memory, with named sets of nodes.
struct MeshArrays {
  std::vector<std::array<double, 3>> points = {};     ///< m
  std::vector<std::array<int, 8>> cells = {};         ///< hexahedra in VTK order; nodes count from 0
  std::map<std::string, std::vector<int>> sets = {};  ///< name -> nodes
};

/// What a program chooses in addition to the case.
struct SimulationSettings {
  std::optional<std::string> method =
      {};                              ///< see `sandglass methods`; none: the case's, else tl-perturbation
  std::optional<double> kappa = {};    ///< strength of the hourglass control; none: the case's, else auto
  std::optional<double> damping = {};  ///< 1/s, proportional to mass; none: the case's
  double step_fraction = 0.9;          ///< the longest step over the stable one, in (0, 1]
  int threads = 1;                     ///< the bits do not depend on it
};

/// One vector per node where the time loop keeps it: component i of row r is at data[stride * r + i]. Rows
/// stand in the order of the loop; `Simulation::row_of_node` tells the node's.
template <class Real>
struct NodalView {
  static constexpr std::size_t stride = 4;  ///< numbers from one row to the next

  const Real* data;  ///< of the first row
  std::size_t rows;  ///< as many as there are nodes

  /// The components of a row.
  const Real* operator[](std::size_t row) const { return data + stride * row; }
};

/// A body in motion, in `double` or `float`: central differences with lumped masses, as in a dynamic run of
/// `sandglass run`, subcycles included, but you say where the driven nodes go, frame by frame. Driven are the
/// components to which the case imposes a displacement or a rotation; they start at rest where the mesh has
/// them.
///
/// It is a value: a copy is a snapshot that goes its own way and shares what does not change. Several may run
/// at once, each in one thread at a time. Errors are InputError for what you say and ComputationError when
/// the body fails: it then returns to its last state that was found whole, from which it may move elsewhere.
template <class Real>
class Simulation {
 public:
  /// The case of a file, at rest or with its initial velocities. A mesh of another program is converted by a
  /// process, SANDGLASS_PYTHON (else /usr/bin/python3) with convert.py from the folder SANDGLASS_EXCHANGE
  /// (else exchange/), both variables of the environment; no other case starts one.
  explicit Simulation(const std::filesystem::path& case_file, const SimulationSettings& settings = {});

  /// The same with a mesh of yours: `case_text` is the text of a case file without [mesh]; what it says of
  /// sets adds to those of the mesh.
  Simulation(MeshArrays mesh, const std::string& case_text, const SimulationSettings& settings = {});

  Simulation(const Simulation& other);                 ///< a snapshot
  Simulation(Simulation&& other) noexcept;             ///< afterwards `other` can only be assigned to, or end
  Simulation& operator=(const Simulation& other);      ///< a snapshot
  Simulation& operator=(Simulation&& other) noexcept;  ///< as the constructor
  ~Simulation();

  /// Where the driven nodes of a set shall be when the next `advance` ends: `displacement` (m) for all of
  /// them. Components that the case leaves free stay free. What is not told stays where it was told last.
  /// Throws InputError for a set without driven nodes, naming those with, and for numbers that are not
  /// finite.
  void move(const std::string& set, const std::array<double, 3>& displacement);

  /// The same with a displacement (m) for each node of `nodes(set)`; too few are an InputError.
  void move(const std::string& set, std::span<const std::array<double, 3>> displacements);

  /// The same for all driven nodes at once: where the case has them at a factor of its loads, 1 at the end of
  /// its loading curve. Its forces grow to that factor. Before the first call they are zero.
  void impose(double factor);

  /// Goes on for `seconds`, in equal steps of at most `step_size()`; driven nodes and forces go straight to
  /// where they shall be. n steps are `advance(n * step_size())`. Every check_interval steps (of the
  /// case) it looks for inverted elements and not-a-number, and adapts the step to how stiff the body has
  /// become. ComputationError names the time and the elements that failed, with their numbers in the mesh;
  /// the body is then as it was at the check before (at `time()`), its driven nodes and forces stay as they
  /// were there until you say otherwise, and you may continue with a smaller motion.
  void advance(double seconds);

  /// Moves the body to its static equilibrium with driven nodes and forces at their new values, and stops it
  /// there; the time stays. Driven nodes go straight from the undeformed body to these values, in load levels
  /// as in a quasi-static run of `sandglass run`, with the [relaxation] of the case; what elements remember
  /// is as if they had gone there in one step. Returns the number of evaluations of the internal forces.
  /// Throws ComputationError if no equilibrium is found; the body is then as it was.
  long settle();

  double time() const;       ///< s
  double step_size() const;  ///< s, the longest step at present

  /// Displacements (m) of all nodes. The view shows the present ones for as long as the simulation lives, and
  /// costs nothing.
  NodalView<Real> displacements() const;

  /// The row of each node in views. Renumber once what you draw, and no frame needs a copy.
  std::span<const int> row_of_node() const;

  /// The force (N) that holds or drives a set of nodes: the sum over its driven components, without what
  /// accelerates the masses of the nodes themselves. Throws InputError as `move` does.
  std::array<double, 3> reaction(const std::string& set) const;

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
