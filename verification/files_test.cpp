/// Files: the layout of results, references that belong to their case, and no files left behind.

#include <gtest/gtest.h>

#include "comparison/reference_file.hpp"
#include "io/case_file.hpp"
#include "io/hdf5_file.hpp"
#include "io/mesh_file.hpp"
#include "io/result_file.hpp"
#include "io/text_file.hpp"
#include "solve/frame.hpp"
#include "solve/relaxation.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::files_test {
namespace {

namespace fs = std::filesystem;

Scene pulled_block() {
  Case description = plain_case(sample_law<NeoHookean>(0.49));
  description.name = "block";
  const Mesh mesh = box({0.1, 0.1, 0.2}, {1, 2, 2});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.19; })}};
  description.displacements = {{"foot", {}}, {"head", {0.04, 0.0, 0.03}}};
  return make_scene(description, mesh, sets);
}

/// Passes everything to a writer, as the command line does.
class WritingObserver final : public Observer {
 public:
  explicit WritingObserver(ResultWriter& writer) : writer_(writer) {}
  void frame(const Frame& frame) override { writer_.frame(frame); }
  void history(const HistoryRow& row) override {
    writer_.history(row);
    ++rows;
  }
  std::size_t rows = 0;

 private:
  ResultWriter& writer_;
};

TEST(ResultFile, holds_mesh_frames_and_history_as_documented) {
  const TemporaryFolder folder;
  const Scene scene = pulled_block();
  const Model model(scene, {"tl-perturbation", {}});
  Relaxation answer;
  std::size_t rows = 0;
  {
    ResultWriter writer(model, folder / "result.h5", {{"revision", "abc"}, {"build_flags", "fast"}});
    WritingObserver observer(writer);
    answer = relax(model, observer);
    rows = observer.rows;
    EXPECT_FALSE(fs::exists(folder / "result.h5")) << "something is in place before the end";
    writer.commit("complete");
  }
  EXPECT_EQ(folder.entries(), 2U) << "result.h5 and result.xdmf, no temporaries";
  const auto file = Hdf5File::open(folder / "result.h5");
  EXPECT_EQ(file.read_text_attribute("/", "case_hash"), scene.case_hash);
  EXPECT_EQ(file.read_text_attribute("/", "mesh_hash"), scene.mesh_hash);
  EXPECT_EQ(file.read_text_attribute("/", "revision"), "abc");
  EXPECT_EQ(file.read_text_attribute("/", "build_flags"), "fast");
  EXPECT_EQ(file.read_text_attribute("/", "status"), "complete");

  const auto with_sets = read_mesh_file(folder / "result.h5");
  EXPECT_EQ(with_sets.mesh.points, scene.mesh.points);
  EXPECT_EQ(with_sets.mesh.cells, scene.mesh.cells);
  EXPECT_EQ(with_sets.sets, scene.sets);

  const auto frames = file.names_in("/frames");
  ASSERT_GE(frames.size(), 2U);
  EXPECT_EQ(frames.front(), "0000");
  double previous = -1.0;
  for (const auto& frame : frames) {
    const double time = file.read_number_attribute("/frames/" + frame, "time");
    EXPECT_GT(time, previous);
    previous = time;
    const auto& group = "/frames/" + frame;
    EXPECT_EQ(file.read<double>(group + "/velocity").shape, (std::vector<std::size_t>{18, 3}));
    EXPECT_EQ(file.read<double>(group + "/jacobian").shape, (std::vector<std::size_t>{4}));
    EXPECT_EQ(file.read<double>(group + "/hourglass_energy_density").shape, (std::vector<std::size_t>{4}));
    EXPECT_EQ(file.read_text_attribute(group + "/hourglass_energy_density", "unit"), "J/m^3");
    EXPECT_EQ(file.read<double>(group + "/stress").shape, (std::vector<std::size_t>{4, 3, 3}));
    EXPECT_EQ(file.read_text_attribute(group + "/stress", "unit"), "Pa");
    EXPECT_EQ(file.names_in(group + "/reaction"), (std::vector<std::string>{"foot", "head"}));
    EXPECT_EQ(file.read<double>(group + "/reaction/head").shape, (std::vector<std::size_t>{3}));
  }
  // The first frame is the initial state.
  EXPECT_EQ(file.read_number_attribute("/frames/0000", "time"), 0.0);
  EXPECT_EQ(read_nodal_field(file, "/frames/0000/displacement", 18), NodalField(18));
  EXPECT_EQ(file.read<double>("/frames/0000/jacobian").entries, std::vector<double>(4, 1.0));
  // The last frame is the answer, with densities that sum to its hourglass energy.
  const auto last = "/frames/" + frames.back();
  EXPECT_EQ(read_nodal_field(file, last + "/displacement", 18), answer.u);
  double sum = 0.0;
  for (const double density : file.read<double>(last + "/hourglass_energy_density").entries) {
    sum += density * 0.1 * 0.1 * 0.2 / 4;
  }
  const double hourglass = strain_energies(model, answer.u).hourglass;
  EXPECT_GT(hourglass, 0.0);
  EXPECT_NEAR(sum / hourglass, 1.0, 1e-12);

  const std::vector<std::pair<std::string, std::string>> columns{
      {"time", "ramp"},       {"kinetic_energy", "J"}, {"strain_energy", "J"}, {"hourglass_energy", "J"},
      {"external_work", "J"}, {"residual", "-"},       {"step_size", "ramp"},  {"adaption_energy", "J"}};
  EXPECT_EQ(file.names_in("/history").size(), columns.size() + 1);
  EXPECT_EQ(file.names_in("/history/reaction"), (std::vector<std::string>{"foot", "head"}));
  EXPECT_EQ(file.read<double>("/history/reaction/head").shape, (std::vector<std::size_t>{rows, 3}));
  EXPECT_EQ(file.read_text_attribute("/history/reaction/head", "unit"), "N");
  for (const auto& [name, unit] : columns) {
    EXPECT_EQ(file.read<double>("/history/" + name).shape, std::vector<std::size_t>{rows}) << name;
    EXPECT_EQ(file.read_text_attribute("/history/" + name, "unit"), unit) << name;
  }
  const auto energies = strain_energies(model, answer.u);
  EXPECT_EQ(file.read<double>("/history/strain_energy").entries.back(), energies.strain);
  EXPECT_EQ(file.read<double>("/history/hourglass_energy").entries.back(), energies.hourglass);
}

/// Distinct numbers are read back from the places that bear their names.
TEST(ResultFile, every_number_has_its_name) {
  const TemporaryFolder folder;
  const Scene scene = pulled_block();
  const Model model(scene, {"tl-perturbation", {}});
  RandomGeometry random(7);
  const auto numbers = [&](std::size_t count) {
    std::vector<double> all(count);
    for (double& number : all) number = random.uniform(-1.0, 1.0);
    return all;
  };
  const auto field = [&] {
    NodalField all(scene.mesh.points.size());
    for (Vector& value : all) {
      for (double& component : value) component = random.uniform(-1.0, 1.0);
    }
    return all;
  };
  const Frame frame{.time = 0.25,
                    .u = field(),
                    .v = field(),
                    .jacobians = numbers(4),
                    .hourglass_energy_densities = numbers(4),
                    .levels = numbers(4),
                    .stresses = numbers(36),
                    .reactions = {{"foot", {0.1, 0.2, 0.3}}, {"head", {0.4, 0.5, 0.6}}}};
  {
    ResultWriter writer(model, folder / "result.h5", {});
    writer.frame(frame);
    writer.history({1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, {{"foot", {9.0, 10.0, 11.0}}, {"head", {12.0}}}});
    writer.commit("complete");
  }
  const auto file = Hdf5File::open(folder / "result.h5");
  const auto read = [&](const std::string& name) {
    return file.read<double>("/frames/0000/" + name).entries;
  };
  EXPECT_EQ(file.read_number_attribute("/frames/0000", "time"), frame.time);
  EXPECT_EQ(read_nodal_field(file, "/frames/0000/displacement", 18), frame.u);
  EXPECT_EQ(read_nodal_field(file, "/frames/0000/velocity", 18), frame.v);
  EXPECT_EQ(read("jacobian"), frame.jacobians);
  EXPECT_EQ(read("hourglass_energy_density"), frame.hourglass_energy_densities);
  EXPECT_EQ(read("level"), frame.levels);
  EXPECT_EQ(read("stress"), frame.stresses);
  EXPECT_EQ(read("reaction/foot"), (std::vector<double>{0.1, 0.2, 0.3}));
  EXPECT_EQ(read("reaction/head"), (std::vector<double>{0.4, 0.5, 0.6}));
  EXPECT_EQ(file.read<double>("/history/reaction/foot").entries, (std::vector<double>{9.0, 10.0, 11.0}));
  EXPECT_EQ(file.read<double>("/history/reaction/head").entries, (std::vector<double>{12.0, 0.0, 0.0}));
  double expected = 0.0;
  for (const auto* name : {"time", "kinetic_energy", "strain_energy", "hourglass_energy", "external_work",
                           "residual", "step_size", "adaption_energy"}) {
    EXPECT_EQ(file.read<double>(std::string("/history/") + name).entries, (std::vector<double>{++expected}));
  }
}

TEST(ResultFile, leaves_nothing_without_commit) {
  const TemporaryFolder folder;
  const Scene scene = pulled_block();
  const Model model(scene, {"tl-none", {}});
  {
    ResultWriter writer(model, folder / "result.h5", {});
    const NodalField rest(scene.mesh.points.size());
    writer.frame(static_frame(model, 0.0, rest));
  }
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(ResultFile, keeps_the_former_result_until_commit) {
  const TemporaryFolder folder;
  folder.write("result.h5", "former");
  const Scene scene = pulled_block();
  const Model model(scene, {"tl-none", {}});
  { ResultWriter writer(model, folder / "result.h5", {}); }
  EXPECT_EQ(fs::file_size(folder / "result.h5"), 6U);
}

TEST(ResultFile, missing_folder_is_reported_before_the_work) {
  const TemporaryFolder folder;
  const Scene scene = pulled_block();
  const Model model(scene, {"tl-none", {}});
  const auto text = input_error([&] { ResultWriter(model, folder / "none/result.h5", {}); });
  EXPECT_TRUE(contains(text, "none/result.h5: cannot be written"));
}

TEST(TextFile, is_whole_or_not_there) {
  const TemporaryFolder folder;
  write_text_file(folder / "a.json", "{}\n");
  EXPECT_EQ(fs::file_size(folder / "a.json"), 3U);
  EXPECT_TRUE(
      contains(input_error([&] { write_text_file(folder / "none/a.json", "{}"); }), "cannot be written"));
  fs::create_directory(folder / "taken");
  fs::create_directory(folder / "taken/by");
  EXPECT_TRUE(
      contains(input_error([&] { write_text_file(folder / "taken", "{}"); }), "cannot be put in place"));
  EXPECT_EQ(folder.entries(), 2U) << "a temporary was left";
}

// References.

/// Writes displacements with chosen hashes.
void write_reference(const fs::path& path, const NodalField& u, const std::string& case_hash,
                     const std::string& mesh_hash) {
  auto file = Hdf5File::create(path);
  file.write("/displacement", {u.size(), 3}, std::span<const double>(u.front().data(), 3 * u.size()));
  file.write_attribute("/", "case_hash", case_hash);
  file.write_attribute("/", "mesh_hash", mesh_hash);
  file.commit();
}

class ReferenceFileTest : public ::testing::Test {
 protected:
  std::string error() const {
    return input_error([&] { read_reference(path, scene); });
  }

  TemporaryFolder folder;
  Scene scene = pulled_block();
  NodalField u = NodalField(scene.mesh.points.size(), Vector{1.0, 2.0, 3.0});
  fs::path path = folder / "golden.h5";
};

TEST_F(ReferenceFileTest, is_read_when_it_belongs_to_the_case) {
  write_reference(path, u, scene.case_hash, scene.mesh_hash);
  EXPECT_EQ(read_reference(path, scene), Displacements{u});
}

TEST_F(ReferenceFileTest, of_another_case_is_refused_with_the_command_that_helps) {
  write_reference(path, u, "0123456789abcdef", scene.mesh_hash);
  const auto text = error();
  EXPECT_TRUE(contains(text, "golden.h5"));
  EXPECT_TRUE(contains(text, "case_hash is 0123456789abcdef"));
  EXPECT_TRUE(contains(text, scene.case_hash));
  EXPECT_TRUE(contains(text, "reference/regenerate block"));
}

TEST_F(ReferenceFileTest, of_another_mesh_is_refused_with_the_command_that_helps) {
  write_reference(path, u, scene.case_hash, "0123456789abcdef");
  EXPECT_TRUE(contains(error(), "mesh_hash is 0123456789abcdef"));
  EXPECT_TRUE(contains(error(), "reference/regenerate block"));
}

TEST_F(ReferenceFileTest, with_too_few_nodes_is_refused) {
  u.pop_back();
  write_reference(path, u, scene.case_hash, scene.mesh_hash);
  EXPECT_TRUE(contains(error(), "'/displacement' has shape [17, 3]; it must be [18, 3]"));
}

TEST_F(ReferenceFileTest, with_a_number_that_is_not_finite_is_refused) {
  u[4][1] = NAN;
  write_reference(path, u, scene.case_hash, scene.mesh_hash);
  EXPECT_TRUE(contains(error(), "at node 4; every value must be finite"));
}

TEST_F(ReferenceFileTest, missing_truncated_and_foreign_files_are_distinguished) {
  EXPECT_TRUE(contains(error(), "golden.h5: no such file"));
  folder.write("golden.h5", "this is no HDF5 file");
  EXPECT_TRUE(contains(error(), "golden.h5: is not a complete HDF5 file"));
  write_reference(path, u, scene.case_hash, scene.mesh_hash);
  fs::resize_file(path, fs::file_size(path) / 2);
  EXPECT_TRUE(contains(error(), "golden.h5: is not a complete HDF5 file"));
  {
    auto foreign = Hdf5File::create(path);
    const std::vector<double> numbers{1.0, 2.0};
    foreign.write("/something/else", {2}, std::span<const double>(numbers));
    foreign.commit();
  }
  EXPECT_TRUE(contains(error(), "attribute 'case_hash' is missing"));
}

TEST(MeshFile, wrong_contents_are_refused) {
  const TemporaryFolder folder;
  const auto path = folder / "mesh.h5";
  const auto error_with = [&](const std::vector<std::int64_t>& cells, std::size_t width) {
    auto file = Hdf5File::create(path);
    const std::vector<double> points(24, 0.5);
    file.write("/mesh/points", {8, 3}, std::span<const double>(points));
    file.write("/mesh/cells", {cells.size() / width, width}, std::span<const std::int64_t>(cells));
    file.commit();
    return input_error([&] { read_mesh_file(path); });
  };
  EXPECT_TRUE(
      contains(error_with({0, 1, 2, 3}, 4), "'/mesh/cells' has shape [1, 4]; it must be [elements, 8]"));
  EXPECT_TRUE(
      contains(error_with({0, 1, 2, 3, 4, 5, 6, 8}, 8), "/mesh/cells names node 8; allowed are 0 to 7"));
  EXPECT_TRUE(contains(error_with({0, 1, 2, 3, 4, 5, 6, -1}, 8), "names node -1"));
  EXPECT_TRUE(contains(error_with({0, 1, 2, 3, 4, 5, 4, 4}, 8),
                       "node 6 of /mesh/points belongs to no element (2 such nodes in all)"));
}

}  // namespace
}  // namespace sandglass::verification::files_test
