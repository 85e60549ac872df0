#include "forces/support.hpp"

#include <algorithm>

#include "forces/face_forces.hpp"

namespace sandglass {

namespace {

/// The part of a field at the corners of a face that is resisted at one of its points, normal or all, times
/// the area.
template <class T>
Triple<T> resisted(const FacePointOf<T>& point, const std::array<Triple<T>, 4>& field, bool only_normal) {
  Triple<T> t{};
  for (std::size_t I = 0; I < 4; ++I) t += (T(point.N[I]) * point.area) * field[I];
  if (!only_normal) return t;
  return (double_dot(point.normal, t) / (point.area * point.area)) * point.normal;
}

class FaceSupports final : public BodyForce {
 public:
  FaceSupports(const NodalField& points, std::vector<Quadrilateral> faces, const Support& support)
      : BodyForce(nodes_of(faces), {Support::name, false, support.damping > 0.0, ""}),
        faces_(std::move(faces)),
        support_(support) {
    for (const Quadrilateral& face : faces_) points_.push_back(gauss_points_of(corners_of(points, face)));
  }

  void add_forces(Factors /*factors*/, const NodalMotion& motion,
                  AtNodes<Row<double>> forces) const override {
    resist(support_.stiffness, motion.u, forces);
    // The velocity is half a step old; without time it is zero.
    if (support_.damping > 0.0) resist(support_.damping / motion.step, motion.increment, forces);
  }

  void add_derivatives_of_power(Factors /*factors*/, const NodalMotion& motion, NodalRows w,
                                AtNodes<Row<double>> by_u, AtNodes<Row<double>> by_increment) const override {
    resist(support_.stiffness, w, by_u);
    if (support_.damping > 0.0) resist(support_.damping / motion.step, w, by_increment);
  }

  void add_potential(Factors /*factors*/, NodalRows u, double& sum) const override {
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      for_each_point(k, u, [&](const std::array<double, 4>& N, const Vector& t) {
        for (std::size_t I = 0; I < 4; ++I) {
          const Row<double>& moved = u[faces_[k][I]];
          sum += 0.5 * support_.stiffness * N[I] * (moved[0] * t[0] + moved[1] * t[1] + moved[2] * t[2]);
        }
      });
    }
  }

  void add_slopes(Factors /*factors*/, const ShapeSlopes& shape) const override {
    const auto add = [&](double stiffness, const NodalField& field) {
      for (const Quadrilateral& face : faces_) {
        const auto a = corners_of(field, face), v = corners_of(shape.v, face);
        const auto product = [&](const auto& points) {
          Dual<double> sum;
          for (const auto& point : points) {
            const auto a_q = from_double<Dual<double>>(interpolated(point.N, a)),
                       v_q = from_double<Dual<double>>(interpolated(point.N, v));
            sum = sum + (support_.only_normal
                             ? double_dot(point.normal, a_q) * double_dot(point.normal, v_q) / point.area
                             : double_dot(a_q, v_q) * point.area);
          }
          return sum;
        };
        add_at_corners(-stiffness, slopes_by_corners(corners_of(shape.points, face), product), face,
                       shape.by_points);
      }
    };
    add(support_.stiffness, shape.u);
    if (!shape.u_rate.empty()) add(support_.damping, shape.u_rate);
  }

  /// Treats each node as if its share of the area supported it alone.
  void add_rates(Factors /*largest*/, const std::vector<double>& masses,
                 std::vector<LoadRates>& rates) const override {
    for_each_share([&](std::size_t k, std::size_t I, const FacePoint& point) {
      const std::size_t n = at(faces_[k][I]);
      rates[n].square += support_.stiffness * point.N[I] * point.area / masses[n];
      rates[n].damping += support_.damping * point.N[I] * point.area / masses[n];
    });
  }

  /// Treats each node as if its share of the area supported it alone.
  void add_stiffness(AtNodes<Row<float>> diagonal) const override {
    for_each_share([&](std::size_t k, std::size_t I, const FacePoint& point) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double n = point.normal.entries[i] / point.area, share = support_.only_normal ? n * n : 1.0;
        diagonal[faces_[k][I]][i] += static_cast<float>(support_.stiffness * share * point.N[I] * point.area);
      }
    });
  }

  void add_holds(std::vector<Hold>& holds) const override {
    if (support_.stiffness == 0.0) return;
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      for (const FacePoint& point : points_[k]) {
        std::vector<Tie::Share> mean_of;
        for (std::size_t I = 0; I < 4; ++I) mean_of.push_back({faces_[k][I], point.N[I]});
        if (support_.only_normal) {
          const auto& n = point.normal.entries;
          holds.push_back({mean_of, {n[0] / point.area, n[1] / point.area, n[2] / point.area}});
        } else {
          for (const Vector& axis : coordinate_axes) holds.push_back({mean_of, axis});
        }
      }
    }
  }

  void add_size(double /*arm*/, double& /*sum*/) const override {}
  std::span<const NodalLoad> dead_loads() const override { return {}; }

  /// Constants: stiffness or damping per area, then area and normal of each point.
  std::vector<FaceForces> face_forces() const override {
    FaceForces own{.faces = faces_};
    own.program =
        face_program(17, [&, only_normal = support_.only_normal](const auto& motion, const auto& constants) {
          std::array<Triple<Recorded>, 4> forces{};
          for (std::size_t q = 0; q < 4; ++q) {
            const auto* number = &constants[1 + 4 * q];
            const FacePointOf<Recorded> point{
                points_.front()[q].N, {}, number[0], {{number[1], number[2], number[3]}}};
            const auto t = resisted(point, motion, only_normal);
            for (std::size_t I = 0; I < 4; ++I) forces[I] += (-constants[0] * Recorded(point.N[I])) * t;
          }
          return forces;
        });
    const auto with = [&](double resistance) {
      FaceForces all = own;
      for (const auto& points : points_) {
        std::vector<double>& numbers = all.constants.emplace_back(1, resistance);
        for (const FacePoint& point : points) {
          const auto& n = point.normal.entries;
          numbers.insert(numbers.end(), {point.area, n[0], n[1], n[2]});
        }
      }
      return all;
    };
    std::vector<FaceForces> all;
    if (support_.stiffness > 0.0) all.push_back(with(support_.stiffness));
    if (support_.damping > 0.0) {
      all.push_back(with(support_.damping));
      all.back().motion = FaceForces::Resists::velocities;
    }
    return all;
  }

  std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const override {
    auto faces = faces_in(part, faces_);
    if (faces.empty()) return nullptr;
    return std::make_shared<FaceSupports>(part.mesh.points, std::move(faces), support_);
  }

 private:
  /// Adds the forces that resist a field, such as u (m), in proportion to a factor per area.
  void resist(double factor, NodalRows field, AtNodes<Row<double>> forces) const {
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      for_each_point(k, field, [&](const std::array<double, 4>& N, const Vector& t) {
        for (std::size_t I = 0; I < 4; ++I) {
          for (std::size_t i = 0; i < 3; ++i) forces[faces_[k][I]][i] -= factor * N[I] * t[i];
        }
      });
    }
  }

  /// Calls use(N, t) for the Gauss points of the k-th face: shape functions, and the part of `field`, such as
  /// u (m), that is resisted, normal or all, times the area.
  template <class Use>
  void for_each_point(std::size_t k, NodalRows field, const Use& use) const {
    std::array<Triple<double>, 4> own;
    for (std::size_t I = 0; I < 4; ++I) {
      const Row<double>& row = field[faces_[k][I]];
      own[I] = {{row[0], row[1], row[2]}};
    }
    for (const FacePoint& point : points_[k])
      use(point.N, resisted(point, own, support_.only_normal).entries);
  }

  /// Calls use(k, I, point) for the Gauss points of all faces k and their corners I.
  template <class Use>
  void for_each_share(const Use& use) const {
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      for (const FacePoint& point : points_[k]) {
        for (std::size_t I = 0; I < 4; ++I) use(k, I, point);
      }
    }
  }

  std::vector<Quadrilateral> faces_;
  std::vector<std::array<FacePoint, 4>> points_;  // undeformed
  Support support_;
};

}  // namespace

std::optional<BrokenRule> Support::broken_rule() const {
  if (stiffness > 0.0 || damping > 0.0) return std::nullopt;
  return BrokenRule{"stiffness", "or damping must be given and positive, or both"};
}

void Support::resolve(ForceResolver& resolver) const {
  resolver.forces.push_back(
      std::make_shared<FaceSupports>(resolver.points, resolver.faces(name, set), *this));
}

}  // namespace sandglass
