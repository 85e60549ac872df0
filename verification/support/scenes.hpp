#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "element/methods.hpp"
#include "mesh/lattice.hpp"
#include "problem/make_scene.hpp"
#include "problem/model.hpp"
#include "problem/observer.hpp"
#include "support/sample_law.hpp"

/// Small scenes made in code, without case files.
namespace sandglass::verification {

inline std::size_t index(int n) {
  return static_cast<std::size_t>(n);
}

/// A case without mesh and loads, to be completed by tests.
inline Case plain_case(const AnyLaw& law, double density = 1000.0) {
  Case scene;
  scene.file = "made-in-a-test.toml";
  scene.name = "test";
  scene.materials = {{{law, density}}};
  return scene;
}

/// A box from the origin in equal hexahedra.
inline Mesh box(const std::array<double, 3>& size, const std::array<int, 3>& elements) {
  return BoxMesh{size, elements}.build();
}

/// Imposes a displacement `field(X)` on each node of `nodes`: each node is a set of its own.
inline void impose_field(const std::vector<int>& nodes, const NodalField& points,
                         const std::function<Vector(const Vector&)>& field, Case& scene, NodeSets& sets) {
  for (const int node : nodes) {
    const std::string name = "node " + std::to_string(node);
    sets[name] = {node};
    scene.displacements.push_back({name, field(points[index(node)])});
  }
}

/// H X.
inline Vector linear(const Tensor<double>& H, const Vector& X) {
  Vector u{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) u[index(i)] += H(i, j) * X[index(j)];
  }
  return u;
}

/// A mesh of one element with corners at X (m), and their displacements H X (m).
inline std::pair<Mesh, NodalField> one_strained_element(const NodalVectors<double>& X,
                                                        const Tensor<double>& H) {
  Mesh mesh;
  mesh.cells = {{0, 1, 2, 3, 4, 5, 6, 7}};
  NodalField u;
  for (int I = 0; I < 8; ++I) {
    mesh.points.push_back({X(I, 0), X(I, 1), X(I, 2)});
    u.push_back(linear(H, mesh.points.back()));
  }
  return {std::move(mesh), std::move(u)};
}

/// The nodes where `condition(X)` holds.
inline std::vector<int> nodes_where(const NodalField& points,
                                    const std::function<bool(const Vector&)>& condition) {
  std::vector<int> nodes;
  for (std::size_t n = 0; n < points.size(); ++n) {
    if (condition(points[n])) nodes.push_back(static_cast<int>(n));
  }
  return nodes;
}

/// Records all reports of a stepper.
class Recorder final : public Observer {
 public:
  void frame(const Frame& frame) override { frames.push_back(frame); }
  void history(const HistoryRow& row) override { rows.push_back(row); }
  bool proceed(long step, double /*share*/, double /*residual*/) override { return step < last_step; }

  std::vector<Frame> frames;
  std::vector<HistoryRow> rows;
  long last_step = std::numeric_limits<long>::max();  ///< stop at the first check from this step on
};

/// All stored and kinetic energy in a row of history, and what friction dissipated, J.
inline double total_energy(const HistoryRow& row) {
  return row.kinetic + row.strain + row.hourglass + row.contact + row.friction + row.damping;
}

/// The largest difference between the work done and the total energy in any row, over the total work at
/// the end, which must be positive.
inline double energy_imbalance(const std::vector<HistoryRow>& rows) {
  const double work = rows.back().external_work;
  EXPECT_GT(work, 0.0);
  double largest = 0.0;
  for (const auto& row : rows) largest = std::max(largest, std::abs(row.external_work - total_energy(row)));
  return largest / work;
}

}  // namespace sandglass::verification
