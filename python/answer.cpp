#include "answer.hpp"

#include <pybind11/stl/filesystem.h>

#include <variant>

#include "arguments.hpp"
#include "commands/execution_options.hpp"
#include "comparison/comparison.hpp"
#include "comparison/truth_estimate.hpp"
#include "copied.hpp"
#include "derivatives.hpp"
#include "device/opencl_processor.hpp"
#include "io/case_file.hpp"
#include "io/result_file.hpp"
#include "problem/model.hpp"
#include "problem/observer.hpp"
#include "sandglass/case_tables.hpp"
#include "sandglass/driven_problem.hpp"
#include "solve/central_difference.hpp"
#include "solve/error_estimate.hpp"
#include "solve/relaxation.hpp"
#include "solve/sleep.hpp"
#include "watch.hpp"

namespace py = pybind11;

namespace sandglass {
namespace {

py::dict sets_of(const std::map<std::string, std::vector<int>>& sets) {
  py::dict arrays;
  for (const auto& [name, members] : sets) arrays[name.c_str()] = copied<int>(members, {count(members)});
  return arrays;
}

/// Points, cells, node sets and element sets.
py::tuple tuple_of(const MeshWithSets& found) {
  return py::make_tuple(field(found.mesh.points), copied<int>(found.mesh.cells, {count(found.mesh.cells), 8}),
                        sets_of(found.sets), sets_of(found.element_sets));
}

/// Keeps frames and history.
class Recorder final : public Observer {
 public:
  explicit Recorder(Watch& watch) : watch_(watch) {}

  void frame(const Frame& frame) override { frames.push_back(frame); }
  void history(const HistoryRow& row) override { rows.push_back(row); }
  bool proceed(long /*step*/, double share, double /*residual*/) override { return watch_.proceed(share); }

  void stepped(double time, double size) override { steps.add(time, size); }

  std::vector<Frame> frames;
  std::vector<HistoryRow> rows;
  TakenSteps steps;  // of a motion

 private:
  Watch& watch_;
};

/// How a case is solved.
struct Solving {
  int threads = 1;
  std::optional<double> sleep = {};     ///< leave out elements that move by less than this share
  std::optional<double> accuracy = {};  ///< refine the mesh until the truth is this near
  std::shared_ptr<const Processor> processor = nullptr;  ///< that computes forces; none: this one
};

Solving solving(const Arguments& given) {
  const auto share = [&](const char* name) -> std::optional<double> {
    const auto text = given.optional(name, &Arguments::text);
    return text ? std::optional(parse_share(name, *text)) : std::nullopt;
  };
  Solving how{given.integer("threads"), share("sleep"), share("accuracy"),
              processor_named(given.text("device"), "device")};
  require_count("threads", how.threads, 1024);
  if (how.sleep && how.accuracy)
    throw InputError("against: a refined mesh is computed as a whole; leave out sleep");
  return how;
}

/// A case that was solved: immutable.
class SolvedCase : public NeverUnmade {
 public:
  /// Throws InputError and ComputationError as `sandglass run` does.
  SolvedCase(const std::string& case_text, MeshArrays mesh, const Solving& how, Watch& watch)
      : problem_(with_mesh(case_text, checked(std::move(mesh)))), scene_(make_scene(problem_)) {
    choice_ = method_of(scene_.settings);
    choice_.threads = how.threads;
    choice_.processor = how.processor;
    if (how.accuracy && !scene_.settings.method) choice_.method = golden_method;
    require_static(how);
    Recorder recorder(watch);
    summary_ = watch.run([&] {
      if (how.accuracy) refine(*how.accuracy);
      model_ = std::make_unique<Model>(scene_, choice_);
      return scene_.settings.quasi_static ? find_rest(recorder, how) : find_motion(recorder);
    });
    frames_ = std::move(recorder.frames);
    rows_ = std::move(recorder.rows);
    steps_ = std::move(recorder.steps);
  }

  const Scene& scene() const {
    require_made("Answer");
    return scene_;
  }
  std::size_t frames() const {
    require_made("Answer");
    return frames_.size();
  }

  /// The arrays of a frame, in the numbering of the mesh.
  py::dict frame(std::size_t number) const {
    require_made("Answer");
    const Frame& frame = frames_.at(number);
    const auto elements = count(frame.jacobians);
    py::dict arrays;
    arrays["time"] = frame.time;
    arrays["displacement"] = field(frame.u);
    arrays["velocity"] = field(frame.v);
    arrays["volume_ratio"] = numbers(frame.jacobians);
    arrays["hourglass_energy_density"] = numbers(frame.hourglass_energy_densities);
    if (!frame.stresses.empty()) arrays["stress"] = copied<double>(frame.stresses, {elements, 3, 3});
    if (!frame.levels.empty()) arrays["level"] = numbers(frame.levels);
    for (const auto& [name, all] : {std::pair{"reactions", &frame.reactions}, {"moments", &frame.moments}}) {
      py::dict vectors;
      for (const auto& [set, value] : *all) vectors[set.c_str()] = copied<double>(value, {3});
      arrays[name] = vectors;
    }
    return arrays;
  }

  py::dict history() const {
    require_made("Answer");
    py::dict columns;
    const auto add = [&](const char* name, double HistoryRow::*member) {
      std::vector<double> column;
      for (const HistoryRow& row : rows_) column.push_back(row.*member);
      columns[name] = numbers(column);
    };
    add("time", &HistoryRow::time);
    add("kinetic", &HistoryRow::kinetic);
    add("strain", &HistoryRow::strain);
    add("hourglass", &HistoryRow::hourglass);
    add("external_work", &HistoryRow::external_work);
    add("residual", &HistoryRow::residual);
    add("step_size", &HistoryRow::step_size);
    add("contact_energy", &HistoryRow::contact);
    add("friction_loss", &HistoryRow::friction);
    add("depth", &HistoryRow::depth);
    return columns;
  }

  py::dict summary() const {
    require_made("Answer");
    py::dict named;
    for (const auto& [name, value] : summary_)
      std::visit([&, key = name](const auto& v) { named[key] = v; }, value);
    return named;
  }

  /// The largest and the rms distance (m) from the mean-dilatation element's answer on this mesh, or from the
  /// truth.
  std::pair<double, double> estimate(const std::string& against) const {
    if (!scene().settings.quasi_static) throw InputError("estimate: errors are estimated for static answers");
    if (against != "golden" && against != "truth")
      throw InputError("against = '" + against + "' must be 'golden' or 'truth'");
    const py::gil_scoped_release others;
    const NodalField& u = frames_.back().u;
    if (against == "golden") {
      const ErrorEstimate found = estimate_error(*model_, u);
      return {found.largest, found.rms};
    }
    const TruthEstimate found = estimate_truth_error(problem_, choice_.threads, u);
    return {found.largest, found.rms};
  }

  /// See sandglass.Solution.
  py::dict gradient(const py::object& displacements, const std::map<std::string, Vector>& reactions,
                    const Wanted& wanted) const {
    require_made("Answer");
    if (scene_.settings.quasi_static) {
      return derivatives().gradient(displacements, reactions, wanted);
    }
    const auto refuse = [](const char* what) {
      throw InputError(
          fmt::format("{}: not available for motions; allowed: a scalar of displacements, and its "
                      "derivatives without points=True",
                      what));
    };
    if (!reactions.empty()) refuse("reactions");
    if (wanted.points) refuse("points");
    return sandglass::gradient(*model_, steps_, frames_, displacements, wanted);
  }

  /// See Derivatives. Throws InputError for a motion, and for an answer of the awake part.
  Derivatives& derivatives() const {
    require_made("Answer");
    if (!scene_.settings.quasi_static)
      throw InputError("sensitivity: the answer is a motion; allowed: a static answer, or its gradient");
    if (!derivatives_) throw InputError("derivatives: elements sleep; allowed: an answer without sleep");
    return *derivatives_;
  }

  void write(const std::filesystem::path& path, const std::string& writer) const {
    require_made("Answer");
    ResultWriter result(*model_, path, {{"written by", writer}, {"method", choice_.method}});
    for (const Frame& frame : frames_) result.frame(frame);
    for (const HistoryRow& row : rows_) result.history(row);
    result.commit("complete");
  }

 private:
  using Summary = std::vector<std::pair<const char*, std::variant<double, long, std::string>>>;

  void require_static(const Solving& how) const {
    if (scene_.settings.quasi_static) return;
    if (how.sleep) throw InputError("sleep: elements sleep in quasi-static cases");
    if (how.accuracy) throw InputError("against: meshes are refined for quasi-static cases");
  }

  /// Takes the refined mesh.
  void refine(double accuracy) {
    AccurateMesh found = refine_until_within(accuracy, problem_, choice_.threads);
    unit_ = displacement_unit(scene_, found.limit);
    problem_ = std::move(found.problem);
    scene_ = std::move(found.scene);
    near_ = std::move(found.u);
    limit_ = std::move(found.limit);
  }

  Summary find_rest(Recorder& recorder, const Solving& how) {
    const Relaxation found = how.sleep ? relax_awake(scene_, choice_, *how.sleep, recorder).relaxation
                                       : relax(*model_, recorder, nullptr, near_.empty() ? nullptr : &near_);
    require_frames(recorder);
    if (!in_equilibrium(found)) throw ComputationError(outcome(found, choice_.precision));
    if (!how.sleep)
      derivatives_ = std::make_unique<Derivatives>(*model_, found, recorder.frames.back().levels);
    Summary summary{{"evaluations", found.steps},
                    {"residual", found.residual},
                    {"seconds", found.seconds},
                    {"stability", stability_text(found)}};
    if (!limit_.empty()) summary.emplace_back("error", largest_distance(limit_, found.u) / unit_);
    return summary;
  }

  Summary find_motion(Recorder& recorder) {
    const Motion found = integrate(*model_, recorder);
    require_frames(recorder);
    return {{"steps", found.steps}, {"smallest_step", found.smallest_step}, {"seconds", found.seconds}};
  }

  static void require_frames(const Recorder& recorder) {
    if (recorder.frames.empty()) throw ComputationError("the run ended before its first frame");
  }

  CaseOnMesh problem_;  // that of the refined mesh, if it was refined
  Scene scene_;
  MethodChoice choice_;
  NodalField near_, limit_;  // m; of a refined mesh: an answer near by, and the truth at the original nodes
  double unit_ = 0.0;        // m, of errors
  std::unique_ptr<const Model> model_;
  std::vector<Frame> frames_;
  std::vector<HistoryRow> rows_;
  TakenSteps steps_;                          // of a motion
  std::unique_ptr<Derivatives> derivatives_;  // of a static answer of the whole body
  Summary summary_;
};

/// A declaration as a dict of its members.
py::dict described(const CaseTable& table) {
  using namespace pybind11::literals;
  py::list keys;
  for (const CaseKey& key : table.keys) {
    keys.append(py::dict("name"_a = key.name, "type"_a = key.type, "count"_a = key.count, "unit"_a = key.unit,
                         "allowed"_a = key.allowed, "required"_a = key.required, "standard"_a = key.standard,
                         "meaning"_a = key.meaning));
  }
  return py::dict("table"_a = table.table, "several"_a = table.several, "choice_key"_a = table.choice_key,
                  "choice"_a = table.choice, "summary"_a = table.summary, "keys"_a = keys);
}

}  // namespace

void add_answers(py::module_& m) {
  using namespace pybind11::literals;
  m.def(
      "case_tables",
      [] {
        py::list tables;
        for (const CaseTable& table : case_tables()) tables.append(described(table));
        return tables;
      },
      "The declared tables of a case file.");
  m.def(
      "share",
      [](const std::string& name, const std::string& text) { return parse_share(name.c_str(), text); },
      "name"_a, "text"_a, "A share of a text such as \"2%\", as `sandglass run` reads it.");
  m.def(
      "mesh_of_keys", [](const std::string& keys) { return tuple_of(mesh_of_keys(keys)); }, "keys"_a,
      "Points, cells, node sets and element sets of a table [mesh].");

  m.def(
      "checked_mesh",
      [](const py::object& points, const py::object& cells, const std::map<std::string, py::object>& sets,
         const std::map<std::string, py::object>& element_sets) {
        return tuple_of(checked(mesh_arrays(points, cells, sets, element_sets)));
      },
      "points"_a, "cells"_a, "sets"_a, "element_sets"_a, "A mesh of arrays, checked, with sorted sets.");

  py::class_<SolvedCase>(m, "Answer", "A case that was solved; see sandglass.Solution.")
      .def_property_readonly("frames", &SolvedCase::frames, "The number of frames, with the undeformed body.")
      .def("frame", &SolvedCase::frame, "number"_a, "The arrays of a frame.")
      .def("history", &SolvedCase::history, "The columns of the history.")
      .def("summary", &SolvedCase::summary, "How it was found.")
      .def("estimate", &SolvedCase::estimate, "against"_a,
           "The largest and the rms distance from the mean-dilatation answer or from the truth, m.")
      .def(
          "gradient",
          [](const SolvedCase& answer, const py::object& displacements,
             const std::map<std::string, Vector>& reactions, bool materials, bool points) {
            return answer.gradient(displacements, reactions, {.parameters = materials, .points = points});
          },
          "displacements"_a, "reactions"_a, "materials"_a, "points"_a,
          "The derivatives of a scalar by everything; see sandglass.Solution.")
      .def(
          "sensitivity",
          [](const SolvedCase& answer, const std::vector<std::map<std::string, double>>& materials,
             const py::object& forces, const py::object& imposed) {
            return answer.derivatives().sensitivity(materials, forces, imposed);
          },
          "materials"_a, "forces"_a, "imposed"_a,
          "The derivative of the displacements along a change; see sandglass.Solution.")
      .def("write", &SolvedCase::write, "path"_a, "writer"_a, "Writes a result file.")
      .def(
          "mesh",
          [](const SolvedCase& answer) {
            const Scene& scene = answer.scene();
            return tuple_of({scene.mesh, scene.sets, scene.element_sets});
          },
          "The mesh, with the sets of all rules, after refinement.")
      .def(
          "boundary",
          [](const SolvedCase& answer) {
            const auto& faces = answer.scene().boundary;
            return copied<int>(faces, {count(faces), 4});
          },
          "The faces on the boundary, counterclockwise seen from outside.");
  m.def(
      "solve",
      [](const py::object& points, const py::object& cells, const std::map<std::string, py::object>& sets,
         const std::map<std::string, py::object>& element_sets, const std::string& case_text,
         const py::dict& arguments, const py::object& progress) {
        Watch watch(progress);
        return std::make_unique<SolvedCase>(case_text, mesh_arrays(points, cells, sets, element_sets),
                                            solving(Arguments(arguments)), watch);
      },
      "points"_a, "cells"_a, "sets"_a, "element_sets"_a, "case_text"_a, "arguments"_a, "progress"_a,
      "Solves a case.");
}

}  // namespace sandglass
