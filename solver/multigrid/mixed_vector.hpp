#pragma once

#include <vector>

#include "math/row_loops.hpp"

namespace sandglass {

/// Displacements by row and pressures by cell (elements, or boxes of a grid), or residuals of both.
struct MixedVector {
  Rows<float> u;
  std::vector<float> p;
};

/// The blocks of the numbers of both.
struct MixedBlocks {
  Blocks u, p;
};

/// The scalar product, in double precision.
double dot(const MixedVector& a, const MixedVector& b, const MixedBlocks& blocks);

/// y += factor * x.
void add(float factor, const MixedVector& x, MixedVector& y, const MixedBlocks& blocks);

/// x *= factor.
void multiply(float factor, MixedVector& x, const MixedBlocks& blocks);

/// x = 0.
void clear(MixedVector& x, const MixedBlocks& blocks);

}  // namespace sandglass
