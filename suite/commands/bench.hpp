#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/bench.hpp"
#include "benchmark/rest.hpp"
#include "benchmark/side_by_side.hpp"
#include "choice/choose.hpp"
#include "mesh/quality.hpp"

namespace sandglass {

/// What is timed: the scene of a case, or a box.
struct BenchSubject {
  std::optional<Case> description = {};  ///< none for a box
  int elements = 0;                      ///< of a box, about
  Shapes shapes = Shapes::any;           ///< of a box
};

/// Cases by name, and boxes of about these numbers of elements and of cubes; without any the case
/// ellipsoid-indentation.
std::vector<BenchSubject> bench_subjects(const std::vector<std::string>& names,
                                         const std::vector<int>& elements, const std::vector<int>& cubes);

/// Makes the scene of a case.
using SceneOf = std::function<Scene(const Case&)>;

/// The plan with the usual methods and numbers of threads where it names none. Throws InputError for an
/// unknown method. Repeated values are dropped.
BenchPlan completed(BenchPlan plan);

/// Times all variants on each subject in turn. Scenes are made one after another, because large ones fill the
/// memory. `each` receives the records of a subject. Throws ComputationError if interrupted.
std::vector<BenchRecord> bench_all(const std::vector<BenchSubject>& subjects, const BenchPlan& plan,
                                   MachineSpeed& machine, const SceneOf& scene_of, const ProgressOf& progress,
                                   const std::function<void(const std::vector<BenchRecord>&)>& each);

/// The quasi-static cases to time until equilibrium: those named, or all canonical ones but small cases with
/// published values, which test accuracy, not time.
std::vector<Case> cases_for_rest(const std::vector<std::string>& names);

/// The time of each scene to static equilibrium: packs only, by default one thread, one method with one point
/// and one with eight.
std::vector<RestRecord> rest_all(
    const std::vector<Scene>& scenes, BenchPlan plan, const ProgressOf& progress,
    const std::function<void(const Scene&, const std::vector<RestRecord>&)>& each);

/// Throws ComputationError if a run found no equilibrium.
void require_at_rest(const std::vector<RestRecord>& records);

/// Times this many bodies of each case side by side and one by one; packs only, by default one thread and all
/// methods that compute bodies side by side.
std::vector<SideBySide> bodies_all(const std::vector<Case>& cases, int bodies, BenchPlan plan,
                                   const ProgressOf& progress,
                                   const std::function<void(const std::vector<SideBySide>&)>& each);

}  // namespace sandglass
