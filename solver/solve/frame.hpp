#pragma once

#include "solve/body.hpp"

namespace sandglass {

/// A frame of a body's present state, at `time` (s) and with velocities v (m/s).
template <class Real>
Frame frame_of(const Body<Real>& body, double time, NodalField v);

/// A frame of a model with displacements u (m), reached in one step, and zero velocities.
Frame static_frame(const Model& model, double time, const NodalField& u);

}  // namespace sandglass
