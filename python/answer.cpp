#include "answer.hpp"

#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <exception>

#include "copied.hpp"
#include "derivatives.hpp"
#include "io/case_file.hpp"
#include "io/result_file.hpp"
#include "problem/model.hpp"
#include "problem/observer.hpp"
#include "sandglass/case_tables.hpp"
#include "sandglass/driven_problem.hpp"
#include "solve/central_difference.hpp"
#include "solve/error_estimate.hpp"
#include "solve/relaxation.hpp"

namespace py = pybind11;

namespace sandglass {
namespace {

using Clock = std::chrono::steady_clock;

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

/// Keeps frames and history, reports progress to Python, and ends the run on Ctrl-C. The GIL is free
/// meanwhile.
class Recorder final : public Observer {
 public:
  explicit Recorder(const py::object& progress) : progress_(progress) {}

  void frame(const Frame& frame) override { frames.push_back(frame); }
  void history(const HistoryRow& row) override { rows.push_back(row); }

  bool proceed(long /*step*/, double share, double /*residual*/) override {
    constexpr std::chrono::milliseconds often(50);
    if (const auto now = Clock::now(); !error_ && now - last_ >= often) {
      last_ = now;
      const py::gil_scoped_acquire python;
      try {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (!progress_.is_none()) progress_(share);
      } catch (const py::error_already_set&) {
        error_ = std::current_exception();
      }
    }
    return !error_;
  }

  /// Throws the exception that ended the run, if one did.
  void require_uninterrupted() const {
    if (error_) std::rethrow_exception(error_);
  }

  std::vector<Frame> frames;
  std::vector<HistoryRow> rows;

 private:
  const py::object& progress_;
  Clock::time_point last_ = Clock::now();
  std::exception_ptr error_;
};

/// A case that was solved: immutable.
class Answer : public NeverUnmade {
 public:
  /// Throws InputError and ComputationError as `sandglass run` does.
  Answer(const std::string& case_text, MeshArrays mesh, int threads, const py::object& progress)
      : scene_(read_scene(case_text, checked(std::move(mesh)))), model_(scene_, choice(threads)) {
    Recorder recorder(progress);
    std::exception_ptr failure;
    {
      const py::gil_scoped_release others;
      try {
        scene_.settings.quasi_static ? find_rest(recorder) : find_motion(recorder);
      } catch (...) {
        failure = std::current_exception();
      }
    }
    recorder.require_uninterrupted();
    if (failure) std::rethrow_exception(failure);
    frames_ = std::move(recorder.frames);
    rows_ = std::move(recorder.rows);
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
    py::dict reactions;
    for (const auto& [set, force] : frame.reactions) reactions[set.c_str()] = copied<double>(force, {3});
    arrays["reactions"] = reactions;
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
    return columns;
  }

  py::dict summary() const {
    require_made("Answer");
    return summary_;
  }

  py::tuple estimate() const {
    if (!scene().settings.quasi_static) throw InputError("estimate: errors are estimated for static answers");
    ErrorEstimate found;
    {
      const py::gil_scoped_release others;
      found = estimate_error(model_, frames_.back().u);
    }
    return py::make_tuple(found.largest, found.rms);
  }

  /// See Derivatives. Throws InputError for a motion.
  Derivatives& derivatives() const {
    require_made("Answer");
    if (!derivatives_) throw InputError("derivatives: the answer is a motion; allowed: a static answer");
    return *derivatives_;
  }

  void write(const std::filesystem::path& path, const std::string& writer) const {
    require_made("Answer");
    ResultWriter result(model_, path, {{"written by", writer}, {"method", model_.choice().method}});
    for (const Frame& frame : frames_) result.frame(frame);
    for (const HistoryRow& row : rows_) result.history(row);
    result.commit("complete");
  }

 private:
  MethodChoice choice(int threads) const {
    require_threads(threads);
    MethodChoice found = method_of(scene_.settings);
    found.threads = threads;
    return found;
  }

  void find_rest(Recorder& recorder) {
    const Relaxation found = relax(model_, recorder);
    recorder_ends(recorder);
    if (!in_equilibrium(found)) throw ComputationError(outcome(found, model_.choice().precision));
    derivatives_ = std::make_unique<Derivatives>(model_, found, recorder.frames.back().levels);
    const py::gil_scoped_acquire python;
    summary_["evaluations"] = found.steps;
    summary_["residual"] = found.residual;
    summary_["seconds"] = found.seconds;
    summary_["stability"] = stability_text(found);
  }

  void find_motion(Recorder& recorder) {
    const Motion found = integrate(model_, recorder);
    recorder_ends(recorder);
    const py::gil_scoped_acquire python;
    summary_["steps"] = found.steps;
    summary_["smallest_step"] = found.smallest_step;
    summary_["seconds"] = found.seconds;
  }

  static void recorder_ends(const Recorder& recorder) {
    if (recorder.frames.empty()) throw ComputationError("the run ended before its first frame");
  }

  const Scene scene_;
  const Model model_;
  std::vector<Frame> frames_;
  std::vector<HistoryRow> rows_;
  std::unique_ptr<Derivatives> derivatives_;  // of a static answer
  py::dict summary_;
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

void require_threads(int threads) {
  if (threads < 1 || threads > 1024)
    throw InputError("threads = " + std::to_string(threads) + " must be in [1, 1024]");
}

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
      "mesh_of_keys", [](const std::string& keys) { return tuple_of(mesh_of_keys(keys)); }, "keys"_a,
      "Points, cells, node sets and element sets of a table [mesh].");

  m.def(
      "checked_mesh",
      [](const py::object& points, const py::object& cells, const std::map<std::string, py::object>& sets,
         const std::map<std::string, py::object>& element_sets) {
        return tuple_of(checked(mesh_arrays(points, cells, sets, element_sets)));
      },
      "points"_a, "cells"_a, "sets"_a, "element_sets"_a, "A mesh of arrays, checked, with sorted sets.");

  py::class_<Answer>(m, "Answer", "A case that was solved; see sandglass.Solution.")
      .def_property_readonly("frames", &Answer::frames, "The number of frames, with the undeformed body.")
      .def("frame", &Answer::frame, "number"_a, "The arrays of a frame.")
      .def("history", &Answer::history, "The columns of the history.")
      .def("summary", &Answer::summary, "How it was found.")
      .def("estimate", &Answer::estimate,
           "The largest and the rms distance from the mean-dilatation answer, m.")
      .def(
          "gradient",
          [](const Answer& answer, const py::object& displacements,
             const std::map<std::string, Vector>& reactions,
             bool points) { return answer.derivatives().gradient(displacements, reactions, points); },
          "displacements"_a, "reactions"_a, "points"_a,
          "The derivatives of a scalar by everything; see sandglass.Solution.")
      .def(
          "sensitivity",
          [](const Answer& answer, const std::vector<std::map<std::string, double>>& materials,
             const py::object& forces, const py::object& imposed) {
            return answer.derivatives().sensitivity(materials, forces, imposed);
          },
          "materials"_a, "forces"_a, "imposed"_a,
          "The derivative of the displacements along a change; see sandglass.Solution.")
      .def("write", &Answer::write, "path"_a, "writer"_a, "Writes a result file.")
      .def(
          "mesh",
          [](const Answer& answer) {
            const Scene& scene = answer.scene();
            return tuple_of({scene.mesh, scene.sets, scene.element_sets});
          },
          "The mesh, with the sets of all rules, after refinement.")
      .def(
          "boundary",
          [](const Answer& answer) {
            const auto& faces = answer.scene().boundary;
            return copied<int>(faces, {count(faces), 4});
          },
          "The faces on the boundary, counterclockwise seen from outside.");
  m.def(
      "solve",
      [](const py::object& points, const py::object& cells, const std::map<std::string, py::object>& sets,
         const std::map<std::string, py::object>& element_sets, const std::string& case_text, int threads,
         const py::object& progress) {
        return std::make_unique<Answer>(case_text, mesh_arrays(points, cells, sets, element_sets), threads,
                                        progress);
      },
      "points"_a, "cells"_a, "sets"_a, "element_sets"_a, "case_text"_a, "threads"_a = 1,
      "progress"_a = py::none(), "Solves a case.");
}

}  // namespace sandglass
