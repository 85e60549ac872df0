#pragma once

#include <filesystem>

#include "io/result_file.hpp"
#include "stability/cell.hpp"

namespace sandglass {

/// Finished cells on disk, one file each, so that work which was broken off, or is shared out to many
/// processes, goes on where it is. A cell belongs to a case, as its hash tells, and to the limit it was
/// judged by.
class CellFiles {
 public:
  CellFiles(const std::filesystem::path& folder, const Case& description, double limit,
            Provenance provenance);

  /// The cell of a map, where it is finished. Throws InputError for a file that is not one of ours.
  std::optional<Cell> read(const Map& map, const std::string& method, double x, double y) const;

  /// Keeps a cell: written to a temporary, then renamed. Throws InputError when that cannot be done.
  void write(const Map& map, const Cell& cell) const;

 private:
  std::filesystem::path path(const Map& map, const std::string& method, double x, double y) const;

  std::filesystem::path folder_;
  std::string case_hash_;
  double limit_;
  Provenance provenance_;
};

/// All maps of a case as JSON text: {provenance..., "case", "limit", "maps": [{"x": {"name", "unit",
/// "values"}, "y", "cells": [...]}]}.
std::string to_json(const Provenance& provenance, const Case& description, double limit,
                    const std::vector<Map>& maps, const std::vector<std::vector<Cell>>& cells);

}  // namespace sandglass
