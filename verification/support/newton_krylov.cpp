#include "support/newton_krylov.hpp"

#include <kinsol/kinsol.h>
#include <sunlinsol/sunlinsol_spfgmr.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/sundials.hpp"

namespace sandglass::verification {

namespace {

constexpr int krylov_dimension = 60;

struct Problem {
  const NonlinearSystem& system;
  std::exception_ptr failure;
  std::string complaint;
};

int evaluate_residual(N_Vector x, N_Vector result, void* data) {
  auto& problem = *static_cast<Problem*>(data);
  bool finite = true;
  const int failed = guarded(problem.failure, [&] {
    const std::vector<double> r = problem.system.residual(numbers_in(x));
    finite = std::all_of(r.begin(), r.end(), [](double value) { return std::isfinite(value); });
    fill(result, r);
  });
  return failed != 0 || finite ? failed : 1;  // positive: a shorter step may succeed
}

int multiply(N_Vector v, N_Vector result, N_Vector x, booleantype* /*x_is_new*/, void* data) {
  auto& problem = *static_cast<Problem*>(data);
  return guarded(problem.failure,
                 [&] { fill(result, problem.system.jacobian_product(numbers_in(x), numbers_in(v))); });
}

int precondition(N_Vector /*x*/, N_Vector /*x_scale*/, N_Vector /*f*/, N_Vector /*f_scale*/, N_Vector v,
                 void* data) {
  auto& problem = *static_cast<Problem*>(data);
  return guarded(problem.failure, [&] { fill(v, problem.system.precondition(numbers_in(v))); });
}

void keep_complaint(int /*code*/, const char* /*module*/, const char* function, char* message, void* data) {
  static_cast<Problem*>(data)->complaint = std::string(function) + ": " + message;
}

struct FreeMemory {
  void operator()(void* memory) const { KINFree(&memory); }
};
struct FreeSolver {
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
};

}  // namespace

std::vector<double> solved_by_newton_krylov(const NonlinearSystem& system, std::vector<double> x, double size,
                                            double tolerance) {
  Problem problem{system, nullptr, {}};
  const SundialsContext context;
  const SundialsVector state = view(x, context);
  std::vector<double> x_scale(x.size(), 1.0 / size), f_scale(x.size(), 1.0 / tolerance);
  const SundialsVector x_scaling = view(x_scale, context), f_scaling = view(f_scale, context);
  const std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, FreeSolver> krylov(
      SUNLinSol_SPFGMR(state.get(), SUN_PREC_RIGHT, krylov_dimension, context));
  const std::unique_ptr<void, FreeMemory> memory(KINCreate(context));
  require_success(KINSetUserData(memory.get(), &problem), "KINSetUserData");
  require_success(KINInit(memory.get(), evaluate_residual, state.get()), "KINInit");
  require_success(KINSetLinearSolver(memory.get(), krylov.get(), nullptr), "KINSetLinearSolver");
  require_success(KINSetJacTimesVecFn(memory.get(), multiply), "KINSetJacTimesVecFn");
  require_success(KINSetPreconditioner(memory.get(), nullptr, precondition), "KINSetPreconditioner");
  require_success(KINSetFuncNormTol(memory.get(), 1.0), "KINSetFuncNormTol");
  require_success(KINSetScaledStepTol(memory.get(), std::numeric_limits<double>::epsilon()),
                  "KINSetScaledStepTol");
  require_success(KINSetMaxNewtonStep(memory.get(), 1e3 * static_cast<double>(x.size())),
                  "KINSetMaxNewtonStep");
  require_success(KINSetEtaForm(memory.get(), KIN_ETACONSTANT), "KINSetEtaForm");
  require_success(KINSetEtaConstValue(memory.get(), 1e-8), "KINSetEtaConstValue");
  require_success(KINSetErrHandlerFn(memory.get(), keep_complaint, &problem), "KINSetErrHandlerFn");
  const int flag = KINSol(memory.get(), state.get(), KIN_LINESEARCH, x_scaling.get(), f_scaling.get());
  if (problem.failure) std::rethrow_exception(problem.failure);
  if (flag != KIN_LINESEARCH_NONCONV) require_success(flag, "KINSol (" + problem.complaint + ")");
  return x;
}

}  // namespace sandglass::verification
