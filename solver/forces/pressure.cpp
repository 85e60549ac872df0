#include "forces/pressure.hpp"

#include <algorithm>
#include <cmath>

#include "forces/face_forces.hpp"
#include "mesh/vectors.hpp"

namespace sandglass {

namespace {

/// The same pressure on some faces.
class FacePressures final : public BodyForce {
 public:
  FacePressures(const NodalField& points, std::vector<Quadrilateral> faces, double value, std::size_t curve)
      : BodyForce(nodes_of(faces), {Pressure::name, true, false, "pressures follow their faces"}),
        faces_(std::move(faces)),
        value_(value),
        curve_(curve) {
    for (const Quadrilateral& face : faces_) corners_.push_back(corners_of(points, face));
  }

  void add_forces(Factors factors, const NodalMotion& motion, AtNodes<Row<double>> forces) const override {
    const double p = factors[curve_] * value_;
    if (p == 0.0) return;
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      const auto unit = pressure_forces(corners(k, motion.u));
      for (std::size_t I = 0; I < 4; ++I) {
        for (std::size_t i = 0; i < 3; ++i) forces[faces_[k][I]][i] += p * unit[I][i];
      }
    }
  }

  void add_derivatives_of_power(Factors factors, const NodalMotion& motion, NodalRows w,
                                AtNodes<Row<double>> by_u,
                                AtNodes<Row<double>> /*by_increment*/) const override {
    const double p = factors[curve_] * value_;
    if (p == 0.0) return;
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      std::array<Vector, 4> velocities{};
      for (std::size_t I = 0; I < 4; ++I) {
        for (std::size_t i = 0; i < 3; ++i) velocities[I][i] = w[faces_[k][I]][i];
      }
      const auto unit = slopes_of_power(corners(k, motion.u), velocities);
      for (std::size_t I = 0; I < 4; ++I) {
        for (std::size_t i = 0; i < 3; ++i) by_u[faces_[k][I]][i] += p * unit[I][i];
      }
    }
  }

  /// Exact if the edges of the faces are held or lie in planes of symmetry through the origin: the volume
  /// below a face is a third of the integral of x . n da.
  void add_potential(Factors factors, NodalRows u, double& sum) const override {
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      const auto x = corners(k, u);
      const auto forces = pressure_forces(x);
      for (std::size_t I = 0; I < 4; ++I) {
        sum -= factors[curve_] * value_ / 3.0 *
               (x[I][0] * forces[I][0] + x[I][1] * forces[I][1] + x[I][2] * forces[I][2]);
      }
    }
  }

  void add_slopes(Factors factors, const ShapeSlopes& shape) const override {
    for (const Quadrilateral& face : faces_) {
      const auto v = corners_of(shape.v, face), u = corners_of(shape.u, face);
      auto x = corners_of(shape.points, face);
      for (std::size_t I = 0; I < 4; ++I) x[I] = sandglass::sum(x[I], 1.0, u[I]);
      add_at_corners(factors[curve_] * value_, slopes_of_power(x, v), face, shape.by_points);
    }
  }

  /// A pressure p on a face with edges along xi and eta has the tangent p times the integral of N_I (dN_J/dxi
  /// x dx/deta - ...), whose norm is at most p times half the sum of two edges, because the norms of the
  /// integrals of N_I dN_J/dxi are 1 and |dx/deta| is at most half the longer edge.
  void add_rates(Factors largest, const std::vector<double>& masses,
                 std::vector<LoadRates>& rates) const override {
    const double most = std::abs(value_) * largest[curve_];
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      const auto edge = [&](std::size_t a, std::size_t b) {
        return distance(corners_[k][a], corners_[k][b]);
      };
      double edges = 0.0;
      for (std::size_t I = 0; I < 2; ++I) edges += std::max(edge(I, I + 1), edge(I + 2, (I + 3) % 4));
      for (const int node : faces_[k]) rates[at(node)].square += 0.5 * edges * most / masses[at(node)];
    }
  }

  void add_stiffness(AtNodes<Row<float>> /*diagonal*/) const override {}

  void add_size(double /*arm*/, double& sum) const override {
    for (const auto& corners : corners_) {
      for (const Vector& force : pressure_forces(corners)) sum += std::abs(value_) * length(force);
    }
  }

  std::span<const NodalLoad> dead_loads() const override { return {}; }

  /// Constants: the pressure (Pa), then the corners (m) relative to the first, which keeps their digits.
  std::vector<FaceForces> face_forces() const override {
    FaceForces own{.faces = faces_, .curve = curve_};
    own.program = face_program(13, [](const auto& motion, const auto& constants) {
      auto x = motion;
      for (std::size_t k = 0; k < 12; ++k) {
        Recorded& component = x[k / 3].entries[k % 3];
        component = component + constants[1 + k];
      }
      auto forces = pressure_forces(x);
      for (auto& force : forces) force = constants[0] * force;
      return forces;
    });
    for (const auto& corners : corners_) {
      std::vector<double>& numbers = own.constants.emplace_back(1, value_);
      for (const Vector& corner : corners) {
        for (std::size_t i = 0; i < 3; ++i) numbers.push_back(corner[i] - corners[0][i]);
      }
    }
    return {std::move(own)};
  }

  std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const override {
    auto faces = faces_in(part, faces_);
    if (faces.empty()) return nullptr;
    return std::make_shared<FacePressures>(part.mesh.points, std::move(faces), value_, curve_);
  }

 private:
  /// The derivatives by the corners x of a face of the power of `pressure_forces` at velocities v.
  static std::array<Vector, 4> slopes_of_power(const std::array<Vector, 4>& x,
                                               const std::array<Vector, 4>& v) {
    return slopes_by_corners(x, [&](const auto& points) {
      Dual<double> sum;
      for (const auto& point : points)
        sum = sum - double_dot(from_double<Dual<double>>(interpolated(point.N, v)), point.normal);
      return sum;
    });
  }

  /// The current corners (m) of the k-th face.
  std::array<Vector, 4> corners(std::size_t k, NodalRows u) const {
    std::array<Vector, 4> x = corners_[k];
    for (std::size_t I = 0; I < 4; ++I) {
      for (std::size_t i = 0; i < 3; ++i) x[I][i] += u[faces_[k][I]][i];
    }
    return x;
  }

  std::vector<Quadrilateral> faces_;
  std::vector<std::array<Vector, 4>> corners_;  // undeformed, m
  double value_;                                // at the factor one, Pa
  std::size_t curve_;
};

}  // namespace

void Pressure::resolve(ForceResolver& resolver) const {
  const std::size_t number = resolver.number_of(curve);
  resolver.forces.push_back(
      std::make_shared<FacePressures>(resolver.points, resolver.faces(name, set), value, number));
}

}  // namespace sandglass
