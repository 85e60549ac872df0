#include "io/case_mesh.hpp"

#include <algorithm>

namespace sandglass {

namespace {

std::vector<PlacedBody> read_bodies(TableReader& table) {
  std::vector<PlacedBody> bodies;
  for (TableReader& each : table.tables("bodies")) {
    PlacedBody body;
    each.parameters(body);
    if (std::ranges::find(bodies, body.label, &PlacedBody::label) != bodies.end())
      each.fail("name", fmt::format("= '{}' appears twice; every body needs its own name", body.label));
    body.generator = each.required_listed<Generators>("generator");
    each.finish();
    bodies.push_back(std::move(body));
  }
  return bodies;
}

}  // namespace

MeshSource read_mesh_source(TableReader& table, const std::filesystem::path& folder) {
  MeshSource source;
  const auto keys = table.keys();
  const auto has = [&](const char* key) { return std::ranges::find(keys, key) != keys.end(); };
  if (const auto file = table.optional<std::string>("file")) {
    source = MeshFile{folder / *file, table.optional<Vector>("spacing", Range::positive())};
  } else if (auto bodies = read_bodies(table); !bodies.empty()) {
    source = std::move(bodies);
  } else if (!has("generator")) {
    table.fail("generator",
               fmt::format("is missing; this key, mesh.file or [[mesh.bodies]] must be given, but there {}",
                           keys.empty() ? "is no key" : fmt::format("is only {}", fmt::join(keys, ", "))));
  } else {
    source = table.required_listed<Generators>("generator");
  }
  table.finish();
  return source;
}

}  // namespace sandglass
