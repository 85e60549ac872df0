#include "stability/cell_files.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"

namespace sandglass {

namespace {

using Json = nlohmann::ordered_json;

Json symptoms_record(const std::optional<Symptoms>& symptoms) {
  if (!symptoms) return nullptr;
  return {{"error", symptoms->error},
          {"zigzag_share", symptoms->zigzag_share},
          {"bending_ratio", symptoms->bending_ratio},
          {"stiffness_ratio", symptoms->stiffness_ratio}};
}

Json to_record(const Cell& cell) {
  return {{"method", cell.method},
          {"x", cell.x},
          {"y", cell.y},
          {"finding", cell.finding ? Json(name_of(*cell.finding)) : Json(nullptr)},
          {"golden_failed", cell.golden_failed},
          {"refused", cell.refused},
          {"symptoms", symptoms_record(cell.symptoms)},
          {"status", cell.status},
          {"steps", cell.steps}};
}

Json to_record(const Axis* axis, const std::vector<double>& values) {
  if (axis == nullptr) return nullptr;
  return {{"name", axis->name}, {"meaning", axis->meaning}, {"values", values}};
}

std::optional<Finding> finding_named(const Json& name) {
  if (name.is_null()) return std::nullopt;
  for (const Finding finding : all_findings) {
    if (name_of(finding) == name.get<std::string>()) return finding;
  }
  throw InputError(fmt::format("finding '{}' is not known", name.get<std::string>()));
}

/// A number; JSON writes NaN and infinity as null.
double number(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

Cell to_cell(const Json& record) {
  Cell cell{.method = record.at("method"),
            .x = record.at("x"),
            .y = record.at("y"),
            .finding = finding_named(record.at("finding")),
            .status = record.at("status"),
            .golden_failed = record.at("golden_failed"),
            .refused = record.at("refused"),
            .steps = record.at("steps")};
  if (const Json& found = record.at("symptoms"); !found.is_null()) {
    cell.symptoms = Symptoms{.error = number(found.at("error")),
                             .zigzag_share = number(found.at("zigzag_share")),
                             .bending_ratio = number(found.at("bending_ratio")),
                             .stiffness_ratio = number(found.at("stiffness_ratio"))};
  }
  return cell;
}

}  // namespace

CellFiles::CellFiles(const std::filesystem::path& folder, const Case& description, double limit,
                     Provenance provenance)
    : folder_(folder / description.name),
      case_hash_(case_hash(description)),
      settings_(numerical_settings(description)),
      limit_(limit),
      provenance_(std::move(provenance)) {}

std::filesystem::path CellFiles::path(const Map& map, const std::string& method, double x, double y) const {
  std::string name = fmt::format("{}={}", map.x->name, x);
  if (map.y != nullptr) name += fmt::format(",{}={}", map.y->name, y);
  return folder_ / map.name() / method / (name + ".json");
}

std::optional<Cell> CellFiles::read(const Map& map, const std::string& method, double x, double y) const {
  const auto file = path(map, method, x, y);
  std::ifstream stream(file);
  if (!stream) return std::nullopt;
  try {
    const Json record = Json::parse(stream);
    if (record.at("case_hash") != case_hash_ || record.at("limit") != limit_ ||
        record.value("settings", "") != settings_)
      return std::nullopt;
    return to_cell(record);
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: not a cell of a map ({}); remove it to compute it again", file.string(),
                                 error.what()));
  }
}

void CellFiles::write(const Map& map, const Cell& cell) const {
  const auto file = path(map, cell.method, cell.x, cell.y);
  make_folder(file.parent_path());
  Json record = to_record(cell);
  record["case_hash"] = case_hash_;
  record["settings"] = settings_;
  record["limit"] = limit_;
  for (const auto& [name, value] : provenance_) record[name] = value;
  write_text_file(file, record.dump(1) + "\n");
}

std::string to_json(const Provenance& provenance, const Case& description, double limit,
                    const std::vector<Map>& maps, const std::vector<std::vector<Cell>>& cells) {
  Json document;
  for (const auto& [name, value] : provenance) document[name] = value;
  document["case"] = description.name;
  document["limit"] = limit;
  document["maps"] = Json::array();
  for (std::size_t m = 0; m < maps.size(); ++m) {
    Json records = Json::array();
    for (const Cell& cell : cells[m]) records.push_back(to_record(cell));
    document["maps"].push_back({{"name", maps[m].name()},
                                {"x", to_record(maps[m].x, maps[m].xs)},
                                {"y", to_record(maps[m].y, maps[m].ys)},
                                {"cells", std::move(records)}});
  }
  return document.dump(1) + "\n";
}

}  // namespace sandglass
