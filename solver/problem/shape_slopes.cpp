#include "problem/shape_slopes.hpp"

#include "mesh/hexahedron.hpp"
#include "mesh/vectors.hpp"
#include "problem/masses.hpp"

namespace sandglass {

void add_slopes_of_forces(double factor, const Scene& scene, std::span<const double> curve_factors,
                          const Working& motion, NodalField& by_points) {
  const Mesh& mesh = scene.mesh;
  const std::vector<double> masses =
      lumped_masses(mesh, element_masses(mesh, scene.materials), scene.attached_masses);
  NodalField of_forces(masses.size());
  std::vector<double> by_masses(masses.size());
  const ShapeSlopes shape{mesh.points, masses, motion.u, motion.u_rate, motion.v, of_forces, by_masses};
  for (const auto& force : scene.forces) force->add_slopes(curve_factors, shape);
  add_slopes_of_masses(scene, by_masses, of_forces);
  for (std::size_t n = 0; n < by_points.size(); ++n) by_points[n] = sum(by_points[n], factor, of_forces[n]);
}

void add_slopes_of_masses(const Scene& scene, const std::vector<double>& by_masses, NodalField& by_points) {
  const auto& [points, cells] = scene.mesh;
  for (std::size_t e = 0; e < cells.size(); ++e) {
    double by_mass = 0.0;
    for (const int node : cells[e]) by_mass += share_of_node(by_masses[at(node)]);
    const auto [gradients, volume] = mean_gradient(gather(points, cells[e]));
    // dV/dX_I is the integral of the gradient of N_I, the volume times its mean.
    const double density = scene.materials.list[scene.materials.of(e)].density;
    scatter_add(gradients, cells[e], by_points,
                [factor = by_mass * density * volume](double gradient) { return factor * gradient; });
  }
}

void add_slopes_of_rotations(const Scene& scene, double load_factor, const NodalField& by_imposed,
                             NodalField& by_points) {
  std::vector<bool> turns(by_points.size(), false);  // a node of two sets turns with the first
  for (const TurnedSet& set : scene.turned) {
    const PathTerms terms = path_terms(scene.angles[set.angle], load_factor);
    Vector of_all{};
    for (const int node : set.nodes) {
      if (turns[at(node)]) continue;
      turns[at(node)] = true;
      const Vector& b = by_imposed[at(node)];
      const Vector across = sum(b, -dot(b, set.axis), set.axis);
      const Vector slope = sum(sum({}, -terms[1], across), terms[2], cross(b, set.axis));
      by_points[at(node)] = sum(by_points[at(node)], 1.0, slope);
      of_all = sum(of_all, 1.0 / static_cast<double>(set.nodes.size()), slope);
    }
    if (!set.about_mean) continue;
    for (const int node : set.nodes) by_points[at(node)] = sum(by_points[at(node)], -1.0, of_all);
  }
}

}  // namespace sandglass
