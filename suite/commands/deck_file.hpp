#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "problem/scene.hpp"

namespace sandglass {

/// The program and element of a deck, with the names of exchange/decks.
struct DeckOptions {
  std::string program;              ///< "calculix", "niftysim" and so on
  std::string element = {};         ///< the program's name of an element type; empty: its default
  std::optional<double> hourglass;  ///< the program's hourglass coefficient; none: its usual value
};

/// Writes a scene as the input of another program: mesh, materials, imposed displacements, forces, contact
/// and, of a dynamic case, the motion. Throws InputError for what the program, or any deck, cannot express.
void write_deck(const Scene& scene, const std::filesystem::path& path, const DeckOptions& options);

}  // namespace sandglass
