#pragma once

#include <gtest/gtest.h>

#include "solve/relaxation.hpp"

namespace sandglass::verification {

/// A method's answer of a quasi-static scene, which must converge.
inline Relaxation static_answer(const Scene& scene, const MethodChoice& choice) {
  Observer quiet;
  Relaxation found = relax(Model(scene, choice), quiet);
  EXPECT_TRUE(found.converged);
  return found;
}

}  // namespace sandglass::verification
