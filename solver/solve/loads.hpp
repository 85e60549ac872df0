#pragma once

#include "assembly/internal_force.hpp"
#include "problem/scene.hpp"

namespace sandglass {

/// The loads of a scene on the rows of a body: dead forces, pressures that follow their faces, springs and
/// dashpots.
template <class Real>
class Loads {
 public:
  Loads(const Scene& scene, const Layout& layout);

  /// Sets the factors of all curves, at a time (s, or the share of a quasi-static load) and a load factor.
  void set(double time, double load_factor);

  /// Evaluates the loads of a state and subtracts them from its forces (N).
  void subtract(const State<Real>& state, Rows<Real>& force);

  /// The square of the norm of the loads (N^2) that were last evaluated.
  double square() const { return square_; }

  /// The change of the loads (N) to another time and load factor, by row, in the configuration u (m).
  Rows<Real> change_to(double time, double load_factor, const Rows<Real>& u) const;

  /// The energy (J) of which the loads are minus the derivative, at displacements u (m): of dead forces and
  /// springs, and of pressures where the edges of their faces are held or lie in planes of symmetry through
  /// the origin.
  double potential(const Rows<Real>& u) const;

  /// Adds the work of the loads since the last call, from the mean of the forces of both states.
  void add_work(const Rows<Real>& u);

  /// The sum of all that was added, J.
  double work() const;

  /// Makes everything that is kept known to all ranks.
  void gather();

  /// The data that the next work depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    archive("factors of curves", factors_);
    archive("loads", forces_);
    archive("loads before", forces_before_);
    archive("loaded displacements before", u_before_);
    archive("work of loads", work_);
  }

 private:
  struct Dead {
    std::size_t at;  // index of a loaded row
    std::size_t curve;
    Vector force;  // at the factor one, N
  };
  struct Face {
    std::array<std::size_t, 4> at;
    std::array<Vector, 4> corners;  // undeformed, m
    double pressure;                // at the factor one, Pa
    std::size_t curve;
  };
  struct Support {
    std::array<std::size_t, 4> at;
    std::array<FacePoint, 4> points;  // undeformed
    double stiffness;                 // Pa/m
    double damping;                   // Pa s/m
    bool only_normal;
  };

  Vector displacement(const Rows<Real>& u, std::size_t at) const {
    const Row<Real>& row = u[rows_[at]];
    return {static_cast<double>(row[0]), static_cast<double>(row[1]), static_cast<double>(row[2])};
  }
  std::array<Vector, 4> corners(const Rows<Real>& u, const Face& face) const;

  /// Calls use(N, t) for the Gauss points of a support with their shape functions and what resists the vector
  /// `field`, such as u (m), times the area: its normal part or all of it.
  template <class Use>
  void for_each_point(const Support& support, const Rows<Real>& field, const Use& use) const;

  /// Calls add(at, force) for the dead forces and the pressures with these factors of their curves.
  template <class Add>
  void for_each_load(const std::vector<double>& factors, const Rows<Real>& u, const Add& add) const;

  std::vector<double> factors_at(double time, double load_factor) const;

  /// Sets the values at loaded rows that other ranks own.
  void gather(std::span<double> values) const;

  const std::vector<LoadCurve>& curves_;
  std::vector<std::size_t> rows_;  // that carry loads
  std::vector<bool> owned_;        // by this rank, of these
  std::shared_ptr<const Ranks> ranks_;
  std::vector<Dead> dead_;
  std::vector<Face> faces_;
  std::vector<Support> supports_;
  std::vector<double> factors_;  // of curves
  Rows<double> forces_;          // N, of loaded rows
  Rows<double> forces_before_, u_before_;
  std::vector<double> work_;  // J, of loaded rows
  double square_ = 0.0;
};

extern template class Loads<double>;
extern template class Loads<float>;

}  // namespace sandglass
