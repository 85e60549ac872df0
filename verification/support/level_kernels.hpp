#pragma once

#include "element/methods.hpp"
#include "support/sample_law.hpp"

/// The levels of the adaptive method as kernels of a law.
namespace sandglass::verification {

using LevelLaw = NeoHookean;
using OnePointKernel = FormulationOf<TlModalSampling, LevelLaw>;
using FourPointKernel = FormulationOf<TlFourPoint, LevelLaw>;
using EightPointKernel = FormulationOf<TlMeanDilatation, LevelLaw>;

inline LevelLaw level_law() {
  return sample_law<LevelLaw>(0.45);
}

}  // namespace sandglass::verification
