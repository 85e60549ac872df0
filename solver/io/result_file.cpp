#include "io/result_file.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "forces/contact_force.hpp"
#include "io/mesh_file.hpp"
#include "io/text_file.hpp"

namespace sandglass {

namespace {

/// One DataItem element of an XDMF file that points into the HDF5 file.
std::string data_item(const std::string& file, const std::string& dataset, const std::string& dimensions,
                      const std::string& type) {
  return fmt::format("<DataItem Format=\"HDF\" Dimensions=\"{}\" {}>{}:{}</DataItem>", dimensions, type, file,
                     dataset);
}

}  // namespace

std::string frame_group(std::size_t number) {
  return fmt::format("/frames/{:04}", number);
}

std::filesystem::path guide_of(const std::filesystem::path& result) {
  return std::filesystem::path(result).replace_extension(".xdmf");
}

void write_frame(Hdf5File& file, const std::string& group, const Frame& frame) {
  const std::size_t n_elements = frame.jacobians.size();
  const auto write_nodal = [&](const std::string& name, const NodalField& field) {
    file.write(group + name, {field.size(), 3},
               std::span<const double>(field.front().data(), 3 * field.size()));
  };
  const auto write_elements = [&](const std::string& name, const std::vector<double>& values) {
    file.write(group + name, {values.size()}, std::span<const double>(values));
  };
  write_nodal("/displacement", frame.u);
  write_nodal("/velocity", frame.v);
  write_elements("/jacobian", frame.jacobians);
  write_elements("/hourglass_energy_density", frame.hourglass_energy_densities);
  file.write_attribute(group + "/hourglass_energy_density", "unit", "J/m^3");
  if (!frame.levels.empty()) write_elements("/level", frame.levels);
  if (!frame.stresses.empty()) {
    file.write(group + "/stress", {n_elements, 3, 3}, std::span<const double>(frame.stresses));
    file.write_attribute(group + "/stress", "unit", "Pa");
  }
  for (const auto& [folder, unit, of_frame, of_row] : reaction_groups) {
    for (const auto& [set, value] : frame.*of_frame) {
      const std::string name = fmt::format("{}{}{}", group, folder, set);
      file.write(name, {3}, std::span<const double>(value));
      file.write_attribute(name, "unit", unit);
    }
  }
  file.write_attribute(group, "time", frame.time);
}

Frame read_frame(const Hdf5File& file, const std::string& group, std::size_t n_nodes,
                 std::size_t n_elements) {
  const auto read_numbers = [&](const std::string& name, const std::vector<std::size_t>& shape) {
    auto values = file.read<double>(group + name);
    if (values.shape != shape) {
      throw InputError(fmt::format("{}: dataset '{}' must have the shape ({})", file.path().string(),
                                   group + name, fmt::join(shape, ", ")));
    }
    return std::move(values.entries);
  };
  const auto read_elements = [&](const std::string& name) { return read_numbers(name, {n_elements}); };
  Frame frame{.time = file.read_number_attribute(group, "time"),
              .u = read_nodal_field(file, group + "/displacement", n_nodes),
              .v = read_nodal_field(file, group + "/velocity", n_nodes),
              .jacobians = read_elements("/jacobian"),
              .hourglass_energy_densities = read_elements("/hourglass_energy_density"),
              .levels = file.contains(group + "/level") ? read_elements("/level") : std::vector<double>{},
              .stresses = file.contains(group + "/stress") ? read_numbers("/stress", {n_elements, 3, 3})
                                                           : std::vector<double>{}};
  for (const auto& [folder, unit, of_frame, of_row] : reaction_groups) {
    for (const auto& set : file.names_in(group + folder)) {
      const auto value = read_numbers(folder + set, {3});
      (frame.*of_frame)[set] = {value[0], value[1], value[2]};
    }
  }
  return frame;
}

void write_reactions(Hdf5File& file, const std::string& group, const std::vector<HistoryRow>& history) {
  if (history.empty()) return;
  for (const auto& [folder, unit, of_frame, of_row] : reaction_groups) {
    for (const auto& first : history.front().*of_row) {
      std::vector<double> values;
      for (const auto& row : history) {
        const Vector& value = (row.*of_row).at(first.first);
        values.insert(values.end(), value.begin(), value.end());
      }
      const std::string name = fmt::format("{}{}{}", group, folder, first.first);
      file.write(name, {history.size(), 3}, std::span<const double>(values));
      file.write_attribute(name, "unit", unit);
    }
  }
}

ResultWriter::ResultWriter(const Model& model, const std::filesystem::path& path,
                           const Provenance& provenance)
    : model_(model), path_(path), file_(Hdf5File::create(path, {.ranks = model.choice().ranks})) {
  write_mesh(model.scene(), file_);
  for (const auto& [name, value] : provenance) file_.write_attribute("/", name, value);
}

void ResultWriter::frame(const Frame& frame) {
  write_frame(file_, frame_group(times_.size()), frame);
  times_.push_back(frame.time);
  has_levels_ = !frame.levels.empty();
  has_stresses_ = !frame.stresses.empty();
}

void ResultWriter::write_history() {
  const auto column = [&](const std::string& name, const std::string& unit, double HistoryRow::*member) {
    std::vector<double> values;
    for (const auto& row : history_) values.push_back(row.*member);
    file_.write("/history/" + name, {values.size()}, std::span<const double>(values));
    file_.write_attribute("/history/" + name, "unit", unit);
  };
  column("time", model_.scene().settings.quasi_static ? "ramp" : "s", &HistoryRow::time);
  column("kinetic_energy", "J", &HistoryRow::kinetic);
  column("strain_energy", "J", &HistoryRow::strain);
  column("hourglass_energy", "J", &HistoryRow::hourglass);
  column("external_work", "J", &HistoryRow::external_work);
  column("residual", "-", &HistoryRow::residual);
  column("step_size", model_.scene().settings.quasi_static ? "ramp" : "s", &HistoryRow::step_size);
  column("adaption_energy", "J", &HistoryRow::adaption);
  if (!contacts_of(model_.scene().forces).empty()) {
    column("contact_energy", "J", &HistoryRow::contact);
    column("friction_loss", "J", &HistoryRow::friction);
    column("depth", "m", &HistoryRow::depth);
  }
  write_reactions(file_, "/history", history_);
}

std::string ResultWriter::xdmf() const {
  const std::string file = path_.filename().string();
  const std::size_t n_nodes = model_.scene().mesh.points.size();
  const std::size_t n_cells = model_.scene().mesh.cells.size();
  const std::string real = "NumberType=\"Float\" Precision=\"8\"";
  const auto attribute = [&](const std::string& dataset, const std::string& label, const std::string& type,
                             const std::string& center, const std::string& dimensions) {
    return fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n",
                       label, type, center, data_item(file, dataset, dimensions, real));
  };
  const auto at_nodes = [&](const std::string& group, const std::string& name) {
    return attribute(group + "/" + name, name, "Vector", "Node", fmt::format("{} 3", n_nodes));
  };
  const auto in_cells = [&](const std::string& group, const std::string& name, const std::string& label) {
    return attribute(group + "/" + name, label, "Scalar", "Cell", fmt::to_string(n_cells));
  };
  std::string text =
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
      "    <Grid Name=\"frames\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t n = 0; n < times_.size(); ++n) {
    const std::string group = frame_group(n);
    text += fmt::format("      <Grid Name=\"frame {}\">\n        <Time Value=\"{}\"/>\n", n, times_[n]);
    text += fmt::format(
        "        <Topology TopologyType=\"Hexahedron\" NumberOfElements=\"{}\">{}</Topology>\n", n_cells,
        data_item(file, "/mesh/cells", fmt::format("{} 8", n_cells), "NumberType=\"Int\" Precision=\"8\""));
    text += fmt::format("        <Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                        data_item(file, "/mesh/points", fmt::format("{} 3", n_nodes), real));
    text += at_nodes(group, "displacement") + at_nodes(group, "velocity");
    text += in_cells(group, "jacobian", "jacobian");
    text += in_cells(group, "hourglass_energy_density", "hourglass energy density [J/m^3]");
    if (has_levels_) text += in_cells(group, "level", "level");
    if (has_stresses_) {
      text += attribute(group + "/stress", "stress [Pa]", "Tensor", "Cell", fmt::format("{} 3 3", n_cells));
    }
    for (const auto& driven : model_.scene().driven) {
      text += attribute(fmt::format("{}/reaction/{}", group, driven.name),
                        fmt::format("reaction at {} [N]", driven.name), "Vector", "Grid", "3");
    }
    text += "      </Grid>\n";
  }
  return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

void ResultWriter::commit(const std::string& status) {
  write_history();
  file_.write_attribute("/", "status", status);
  if (model_.choice().ranks->rank() > 0) return file_.commit();
  NewTextFile guide(guide_of(path_), xdmf());  // both or none
  file_.commit();
  guide.commit();
}

}  // namespace sandglass
