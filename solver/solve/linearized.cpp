#include "solve/linearized.hpp"

#include <cmath>

#include "solve/acceleration.hpp"

namespace sandglass {

template <class Real>
void solve_linearized(MixedBody<Real>& mixed, const MixedVector& loads, MixedVector& x) {
  // In slender bodies the residual of an unfinished answer may have grown although the answer is still a good
  // start; beyond this growth it is not.
  constexpr double most_growth = 10.0;
  constexpr int most_cycles = 30;
  const ElementLevel& elements = mixed.multigrid().elements();
  const MixedBlocks& blocks = elements.blocks();
  const MixedVector zero = elements.zero();
  MixedVector forces = zero, residual, step, correction;
  const auto evaluate = [&] {
    elements.apply(x, forces);
    residual = forces;
    add(-1.0f, loads, residual, blocks);
    mixed.weigh(residual);
    return std::sqrt(dot(residual, residual, blocks));
  };
  Acceleration acceleration(blocks);
  const double first = evaluate();
  double norm = first, least = first;
  MixedVector best = x;
  for (int k = 0; k < most_cycles && norm > 0.1 * first; ++k) {
    step = correction = zero;
    acceleration.combine(residual, step);
    mixed.correct(residual, correction);
    add(1.0f, correction, step, blocks);
    add(1.0f, step, x, blocks);
    acceleration.moved(step);
    norm = evaluate();
    if (norm < least) {
      least = norm;
      best = x;
    }
  }
  if (!(norm < most_growth * first)) x = best;  // the cycles diverged
}

template void solve_linearized(MixedBody<double>&, const MixedVector&, MixedVector&);
template void solve_linearized(MixedBody<float>&, const MixedVector&, MixedVector&);

}  // namespace sandglass
