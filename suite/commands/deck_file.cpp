#include "commands/deck_file.hpp"

#include <fmt/format.h>

#include <type_traits>

#include "base/error.hpp"
#include "io/foreign_file.hpp"
#include "io/mesh_file.hpp"
#include "io/temporary_folder.hpp"
#include "solve/stable_step.hpp"

namespace sandglass {

namespace {

/// The method whose stable step is written to decks.
constexpr std::string_view one_point = "tl-perturbation";

/// Throws InputError for anything that no deck can express.
void require_expressible(const Scene& scene) {
  const auto refuse = [&](std::string_view what) {
    throw InputError(fmt::format("{}: {}", scene.settings.file.string(), what));
  };
  if (const BodyForce* other = first_not_dead(scene.forces))
    refuse(fmt::format("a deck cannot hold a {}; allowed: dead loads", other->traits().name));
  if (!scene.ties.empty()) refuse("a deck cannot hold hanging nodes, which refinement and ties make");
  if (scene.settings.quasi_static) return;
  if (!scene.initial_velocities.empty()) refuse("a deck cannot hold initial velocities");
  if (!scene.attached_masses.empty()) refuse("a deck cannot hold masses of a dynamic case");
  if (scene.angles.size() > 1) refuse("a deck cannot hold rotations of a dynamic case");
  for (const auto& load : dead_loads(scene.forces)) {
    if (load.curve != 0) refuse("a deck cannot hold load curves of a dynamic case");
  }
}

/// /problem/imposed (node, component, final value in m), /problem/forces (node and three components in N).
void write_conditions(const Scene& scene, Hdf5File& file) {
  const auto write_rows = [&](const std::string& name, std::size_t width, const std::vector<double>& rows) {
    if (!rows.empty()) file.write(name, {rows.size() / width, width}, std::span<const double>(rows));
  };
  std::vector<double> imposed, forces;
  for (const auto& constraint : scene.constraints) {
    imposed.insert(imposed.end(),
                   {static_cast<double>(constraint.node), static_cast<double>(constraint.component),
                    final_value(scene, constraint)});
  }
  for (const auto& [node, force, curve] : dead_loads(scene.forces)) {
    const double factor = scene.curves[curve].at(1.0, 1.0);
    forces.insert(forces.end(),
                  {static_cast<double>(node), factor * force[0], factor * force[1], factor * force[2]});
  }
  write_rows("/problem/imposed", 3, imposed);
  write_rows("/problem/forces", 4, forces);
}

/// Attributes material.I.law, .density, .shear_modulus, .bulk_modulus, .volumetric and .parameter.NAME of
/// each material.
void write_materials(const Scene& scene, Hdf5File& file) {
  const auto shear = shear_moduli(scene.materials), lambda = lame_lambdas(scene.materials);
  for (std::size_t i = 0; i < scene.materials.list.size(); ++i) {
    const Material& material = scene.materials.list[i];
    const std::string prefix = fmt::format("material.{}.", i);
    file.write_attribute("/", prefix + "density", material.density);
    file.write_attribute("/", prefix + "shear_modulus", shear[i]);
    file.write_attribute("/", prefix + "bulk_modulus", lambda[i] + 2.0 / 3.0 * shear[i]);
    std::visit(
        [&](const auto& part) { file.write_attribute("/", prefix + "volumetric", std::string(part.name)); },
        material.volume);
    const auto write_number = [&]<class Value>(std::string_view name, const Value& value) {
      if constexpr (std::is_arithmetic_v<Value>) {
        file.write_attribute("/", fmt::format("{}parameter.{}", prefix, name), static_cast<double>(value));
      }
    };
    std::visit(
        [&](const auto& law) {
          file.write_attribute("/", prefix + "law", std::string(law.name));
          std::apply([&](const auto&... p) { (write_number(p.name, law.*(p.member)), ...); },
                     law.parameters());
        },
        material.law);
  }
}

/// Attribute stable_step, and of a dynamic case time_step, duration, ramp_time and damping.
void write_motion(const Scene& scene, Hdf5File& file) {
  const Model model(scene, {.method = std::string(one_point)});
  const double stable = stable_step(model, NodalField(scene.mesh.points.size())).step;
  file.write_attribute("/", "stable_step", stable);
  if (scene.settings.quasi_static) return;
  const DynamicsSettings& given = scene.settings.dynamics;
  const double step = given.time_step > 0.0 ? given.time_step : given.step_fraction * stable;
  file.write_attribute("/", "time_step", step);
  file.write_attribute("/", "duration", given.duration);
  file.write_attribute("/", "ramp_time", given.ramp_time > 0.0 ? given.ramp_time : given.duration);
  file.write_attribute("/", "damping", given.damping);
}

}  // namespace

void write_deck(const Scene& scene, const std::filesystem::path& path, const DeckOptions& options) {
  require_expressible(scene);
  const TemporaryFolder folder;
  const auto source = folder / "problem.h5";
  auto file = Hdf5File::create(source);
  write_mesh(scene, file);
  write_conditions(scene, file);
  write_materials(scene, file);
  write_motion(scene, file);
  file.commit();
  std::vector<std::string> arguments{"deck", source.string(), as_argument(path), options.program};
  if (!options.element.empty()) arguments.push_back("--element=" + options.element);
  if (options.hourglass) arguments.push_back("--hourglass=" + fmt::to_string(*options.hourglass));
  run_converter(std::move(arguments), path);
}

}  // namespace sandglass
