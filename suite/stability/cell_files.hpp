#pragma once

#include <filesystem>

#include "io/result_file.hpp"
#include "stability/cell.hpp"

namespace sandglass {

/// Finished cells on disk, one file each, so that interrupted work can be resumed and many processes can
/// share it. A cell belongs to a case, identified by its hash, and to a limit.
class CellFiles {
 public:
  CellFiles(const std::filesystem::path& folder, const Case& description, double limit,
            Provenance provenance);

  /// The cell of a map, if it is finished. Throws InputError for a file that is not a cell.
  std::optional<Cell> read(const Map& map, const std::string& method, double x, double y) const;

  /// Stores a cell: writes a temporary file, then renames it. Throws InputError if that fails.
  void write(const Map& map, const Cell& cell) const;

 private:
  std::filesystem::path path(const Map& map, const std::string& method, double x, double y) const;

  std::filesystem::path folder_;
  std::string case_hash_, settings_;
  double limit_;
  Provenance provenance_;
};

/// All maps of a case as JSON text: {provenance..., "case", "limit", "maps": [{"x": {"name", "unit",
/// "values"}, "y", "cells": [...]}]}.
std::string to_json(const Provenance& provenance, const Case& description, double limit,
                    const std::vector<Map>& maps, const std::vector<std::vector<Cell>>& cells);

}  // namespace sandglass
