#include "commands/deck_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "base/error.hpp"
#include "forces/contact_input.hpp"
#include "forces/obstacle_contact.hpp"
#include "forces/surface_pair.hpp"
#include "problem/scene_rules.hpp"

namespace sandglass {

namespace {

/// Numbers by rows of `width`.
template <class Row>
void write_table(Hdf5File& file, const std::string& name, const std::vector<Row>& rows) {
  using Value = std::conditional_t<std::is_integral_v<typename Row::value_type>, std::int64_t, double>;
  std::vector<Value> entries;
  for (const Row& row : rows) entries.insert(entries.end(), row.begin(), row.end());
  file.write(name, {rows.size(), std::tuple_size_v<Row>}, std::span<const Value>(entries));
}

/// The keys of a table of a case, but for its curve.
template <class Table>
void write_keys(Hdf5File& file, const std::string& group, const Table& table) {
  const auto write = [&]<class Value>(std::string_view name, const Value& value) {
    const std::string key(name);
    if constexpr (std::is_same_v<Value, std::string>) {
      file.write_attribute(group, key, value);
    } else if constexpr (std::is_enum_v<Value>) {
      const std::string_view word = words_of(value)[static_cast<std::size_t>(value)];
      file.write_attribute(group, key, std::string(word));
    } else if constexpr (std::is_arithmetic_v<Value>) {
      file.write_attribute(group, key, static_cast<double>(value));
    } else if constexpr (std::is_same_v<Value, Vector>) {
      file.write(group + "/" + key, {3}, std::span<const double>(value));
    }
  };
  std::apply([&](const auto&... p) { (write(p.name, table.*(p.member)), ...); }, Table::parameters());
}

class ContactWriter {
 public:
  ContactWriter(const Scene& scene, Hdf5File& file)
      : scene_(scene), file_(file), moduli_(young_moduli(scene.mesh, scene.materials)) {}

  void write(const ObstacleContact& contact) {
    Obstacle given = contact.given();
    const auto follows_case = [](const auto& moving) { return moving.curve == LoadCurve{}; };
    const bool is_of_case = follows_case(given) && std::ranges::all_of(given.moves, follows_case);
    const auto moved_at = [&](double at) {
      Vector moved = sum({}, given.curve.at(at, at), given.displacement);
      for (const ObstacleMove& move : given.moves)
        moved = sum(moved, move.curve.at(at, at), move.displacement);
      return moved;
    };
    if (!is_of_case && !scene_.settings.quasi_static)
      refuse(Obstacle::name, given.label, "follows a curve of its own in a dynamic case");
    if (!is_of_case && given.friction > 0.0)
      refuse(Obstacle::name, given.label, "follows a curve of its own, on which friction depends");
    const Vector start = moved_at(0.0), end = moved_at(1.0);
    given.point = sum(given.point, 1.0, start);
    given.end = sum(given.end, 1.0, start);
    given.displacement = difference(end, start);
    const std::string group = fmt::format("/problem/obstacles/{}", obstacles_++);
    const auto faces = faces_of(given.set);
    write_table(file_, group + "/faces", faces);
    write_keys(file_, group, given);
    if (const auto* surface = std::get_if<SurfaceShape>(&contact.shape())) {
      write_table(file_, group + "/points", surface->surface->points());
      write_table(file_, group + "/triangles", surface->surface->triangles());
    }
    file_.write_attribute(group, "stiffness", scale_of(faces).stiffness(given.penalty));
    double depth = -INFINITY;
    for (const TouchingNode& one : contact.touching()) depth = std::max(depth, contact.depth(one, end));
    file_.write_attribute(group, "overlap", depth);
  }

  void write(const SurfacePair& pair) {
    const Contact& given = pair.contact();
    if (given.friction > 0.0 && given.curve != LoadCurve{})
      refuse(Contact::name, given.label, "has a friction that follows a curve");
    const std::string group = fmt::format("/problem/contacts/{}", pairs_++);
    auto faces = faces_of(given.set);
    write_table(file_, group + "/faces", faces);
    if (!given.other.empty()) {
      const auto other = faces_of(given.other);
      write_table(file_, group + "/other_faces", other);
      faces.insert(faces.end(), other.begin(), other.end());
    }
    write_keys(file_, group, given);
    file_.write_attribute(group, "stiffness", scale_of(faces).stiffness(given.penalty));
  }

 private:
  std::vector<Quadrilateral> faces_of(const std::string& set) const {
    return faces_within(scene_.boundary, scene_.sets.at(set));
  }

  ContactScale scale_of(const std::vector<Quadrilateral>& faces) const {
    return {scene_.mesh.points, scene_.mesh.cells, moduli_, faces};
  }

  [[noreturn]] void refuse(std::string_view table, const std::string& label, std::string_view what) const {
    throw InputError(fmt::format("{}: {} '{}' {}, which a deck cannot hold; allowed: the curve of the case",
                                 scene_.settings.file.string(), table, label, what));
  }

  const Scene& scene_;
  Hdf5File& file_;
  const std::vector<double> moduli_;
  int obstacles_ = 0, pairs_ = 0;
};

}  // namespace

void write_contacts(const Scene& scene, Hdf5File& file) {
  ContactWriter writer(scene, file);
  for (const ContactForce* contact : contacts_of(scene.forces)) {
    if (const auto* obstacle = dynamic_cast<const ObstacleContact*>(contact)) writer.write(*obstacle);
    if (const auto* pair = dynamic_cast<const SurfacePair*>(contact)) writer.write(*pair);
  }
}

}  // namespace sandglass
