#include "support/initial_value_problem.hpp"

#include <arkode/arkode_erkstep.h>

#include "support/sundials.hpp"

namespace sandglass::verification {

namespace {

struct Problem {
  const Rate& rate;
  std::exception_ptr failure;
};

int evaluate_rate(double t, N_Vector y, N_Vector result, void* data) {
  auto& problem = *static_cast<Problem*>(data);
  return guarded(problem.failure, [&] { fill(result, problem.rate(t, numbers_in(y))); });
}

struct FreeMemory {
  void operator()(void* memory) const { ERKStepFree(&memory); }
};

}  // namespace

std::vector<double> solved_in_time(const Rate& rate, std::vector<double> y, double duration, double tolerance,
                                   const std::vector<double>& scale) {
  Problem problem{rate, nullptr};
  std::vector<double> absolute = scale;
  for (double& a : absolute) a *= tolerance;
  const SundialsContext context;
  const SundialsVector state = view(y, context), absolute_tolerance = view(absolute, context);
  const std::unique_ptr<void, FreeMemory> memory(ERKStepCreate(evaluate_rate, 0.0, state.get(), context));
  require_success(ERKStepSetUserData(memory.get(), &problem), "ERKStepSetUserData");
  require_success(ERKStepSetTableNum(memory.get(), ARKODE_FEHLBERG_13_7_8), "ERKStepSetTableNum");
  require_success(ERKStepSVtolerances(memory.get(), tolerance, absolute_tolerance.get()),
                  "ERKStepSVtolerances");
  require_success(ERKStepSetMaxNumSteps(memory.get(), 1000000), "ERKStepSetMaxNumSteps");
  require_success(ERKStepSetStopTime(memory.get(), duration), "ERKStepSetStopTime");
  double t = 0.0;
  const int flag = ERKStepEvolve(memory.get(), duration, state.get(), &t, ARK_NORMAL);
  if (problem.failure) std::rethrow_exception(problem.failure);
  require_success(flag, "ERKStepEvolve");
  return y;
}

}  // namespace sandglass::verification
