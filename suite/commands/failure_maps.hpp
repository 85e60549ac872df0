#pragma once

#include <string>
#include <vector>

#include "choice/choose.hpp"
#include "io/result_file.hpp"
#include "stability/cell.hpp"

namespace sandglass {

/// What `stability` computes.
struct MapPlan {
  std::vector<std::string> maps = {};     ///< "X,Y" or "X", names of axes; none: all usual maps of the case
  std::vector<std::string> values = {};   ///< "AXIS=V1,V2,...": other values of an axis
  std::vector<std::string> methods = {};  ///< none: all
  std::string folder;                     ///< of finished cells, which are not computed again
  int threads = 0;                        ///< runs at the same time; 0: one per processor
};

/// The maps of a case.
struct FailureMaps {
  std::vector<Map> maps;
  std::vector<std::vector<Cell>> cells;  ///< of each map
  double limit;                          ///< the error up to which a method is good, as in `verify`
};

/// Throws InputError for a dynamic case, from which no map can start.
void require_mappable(const Case& description);

/// Computes all cells of the maps of a quasi-static case, whose scene gives the limit. Throws InputError for
/// unknown axes and methods, for values out of range and for axes along which the case cannot be varied;
/// ComputationError if interrupted.
FailureMaps map_failures(const Case& description, const Scene& scene, const MapPlan& plan,
                         const Provenance& provenance, const ProgressOf& progress);

}  // namespace sandglass
