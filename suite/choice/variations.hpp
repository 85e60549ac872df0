#pragma once

#include "mesh/generators.hpp"

namespace sandglass {

/// A parameter of a generator that counts elements.
struct ElementCount {
  std::string_view parameter;
  std::vector<int> counts;  ///< one, or one for each direction

  bool operator==(const ElementCount&) const = default;
};

/// The element counts of a generator, in the order of their declarations.
std::vector<ElementCount> element_counts(const AnyGenerator& generator);

/// The element counts as in a case file: "core_elements = 10, shell_layers = 2".
std::string counts_text(const AnyGenerator& generator);

/// Coarser meshes of the same body: with one element fewer across the thinnest part, and with three quarters
/// and half of all counts, without duplicates and without `generator` itself.
std::vector<AnyGenerator> coarser_meshes(const AnyGenerator& generator);

/// The generator with `elements` elements across the thinnest part of its mesh, which is the direction with
/// the smallest count, and with its other counts in proportion, at least 1.
AnyGenerator with_elements_across(AnyGenerator generator, int elements);

/// +1 or -1 for each node, such that every edge of every hexahedron joins two different signs: the zigzag of
/// all hourglass modes. Throws InputError if a mesh has none, because it has a closed ring of an odd number
/// of edges.
std::vector<int> zigzag(const Mesh& mesh);

}  // namespace sandglass
