#pragma once

#include <vector>

#include "math/rows.hpp"

namespace sandglass {

/// Displacements by row and pressures by cell (elements, or boxes of a grid), or residuals of both.
struct MixedVector {
  Rows<float> u;
  std::vector<float> p;
};

/// The scalar product, in double precision.
double dot(const MixedVector& a, const MixedVector& b, int threads);

/// y += factor * x.
void add(float factor, const MixedVector& x, MixedVector& y, int threads);

/// x *= factor.
void multiply(float factor, MixedVector& x, int threads);

/// x = 0.
void clear(MixedVector& x, int threads);

}  // namespace sandglass
