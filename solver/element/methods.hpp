#pragma once

#include "base/type_list.hpp"
#include "element/method_traits.hpp"
#include "element/methods/linear.hpp"
#include "element/methods/linear_condensed.hpp"
#include "element/methods/t4.hpp"
#include "element/methods/t4_anp.hpp"
#include "element/methods/tl_adaptive.hpp"
#include "element/methods/tl_assumed_strain.hpp"
#include "element/methods/tl_energy_sampling.hpp"
#include "element/methods/tl_enhanced.hpp"
#include "element/methods/tl_four_point.hpp"
#include "element/methods/tl_full.hpp"
#include "element/methods/tl_mean_dilatation.hpp"
#include "element/methods/tl_modal_sampling.hpp"
#include "element/methods/tl_none.hpp"
#include "element/methods/tl_perturbation.hpp"
#include "element/methods/tl_perturbation_compact.hpp"
#include "element/methods/tl_stabilization_matrix.hpp"
#include "element/methods/ul_assumed_strain.hpp"
#include "element/methods/ul_enhanced.hpp"
#include "element/methods/ul_perturbation.hpp"
#include "element/methods/ul_viscous.hpp"

namespace sandglass {

/// The list of methods. A new method is a header in element/methods/ and one entry here; tests, tables,
/// benchmarks and charts iterate the list.
using Methods =
    TypeList<TlNone, TlPerturbation, TlPerturbationCompact, TlEnergySampling, TlStabilizationMatrix,
             TlAssumedStrain, TlEnhanced, UlPerturbation, UlViscous, UlAssumedStrain, UlEnhanced, TlFull,
             TlMeanDilatation, T4, T4Anp, Linear, LinearCondensed, TlModalSampling, TlFourPoint, TlAdaptive>;

}  // namespace sandglass
