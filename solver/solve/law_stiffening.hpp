#pragma once

#include <optional>
#include <vector>

#include "assembly/layout.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// How much stiffer than undeformed the laws of a model's elements are in a configuration; known for the laws
/// that split volume from shape, with methods that are not linear.
class LawStiffening {
 public:
  explicit LawStiffening(const Model& model);

  /// Whether it is known for any of the materials.
  bool is_known() const;

  /// By cell of the layout, for displacements u (m) of its rows; 1 where it is not known. See
  /// material/stiffening.hpp.
  std::vector<float> by_cell(const Rows<float>& u, const Layout& layout) const;

 private:
  const Mesh& mesh_;
  const Materials& materials_;
  std::vector<std::optional<CalledLaw>> laws_;  // of each material; none if not known
};

}  // namespace sandglass
