#pragma once

#include "mesh/generators.hpp"

namespace sandglass {

/// A parameter of a generator that counts elements.
struct ElementCount {
  std::string_view parameter;
  std::vector<int> counts;  ///< one, or one for each direction

  bool operator==(const ElementCount&) const = default;
};

/// All of them, in the order of the declarations.
std::vector<ElementCount> element_counts(const AnyGenerator& generator);

/// The same for people, as a case file says it: "core_elements = 10, shell_layers = 2".
std::string counts_text(const AnyGenerator& generator);

/// Coarser meshes of the same body: with one element less across the thinnest part, and with three quarters
/// and half of all counts; each once, none like `generator` itself.
std::vector<AnyGenerator> coarser_meshes(const AnyGenerator& generator);

/// The generator with so many elements across the thinnest part of its mesh, which is where it counts fewest,
/// and its other counts of elements in proportion, at least 1.
AnyGenerator with_elements_across(AnyGenerator generator, int elements);

/// +1 and -1 for the nodes, so that every edge of every hexahedron joins two that differ: the zigzag of all
/// hourglass modes. Throws InputError where a mesh has none, because an odd number of edges closes a ring.
std::vector<int> zigzag(const Mesh& mesh);

}  // namespace sandglass
