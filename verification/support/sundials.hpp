#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

/// The parts of SUNDIALS' C interface that the two oracles share.
namespace sandglass::verification {

/// Throws if a function of SUNDIALS reports failure.
inline void require_success(int flag, const std::string& function) {
  if (flag < 0) throw std::runtime_error(function + " failed with " + std::to_string(flag));
}

/// A separate context for each problem.
class SundialsContext {
 public:
  SundialsContext() { require_success(SUNContext_Create(nullptr, &context_), "SUNContext_Create"); }
  SundialsContext(const SundialsContext&) = delete;
  SundialsContext& operator=(const SundialsContext&) = delete;
  ~SundialsContext() { SUNContext_Free(&context_); }
  operator SUNContext() const { return context_; }  // NOLINT(google-explicit-constructor)

 private:
  SUNContext context_ = nullptr;
};

struct DestroyVector {
  void operator()(N_Vector v) const { N_VDestroy(v); }
};
using SundialsVector = std::unique_ptr<std::remove_pointer_t<N_Vector>, DestroyVector>;

/// The numbers of a std::vector as a vector of SUNDIALS, which does not own them.
inline SundialsVector view(std::vector<double>& numbers, SUNContext context) {
  return SundialsVector(N_VMake_Serial(static_cast<sunindextype>(numbers.size()), numbers.data(), context));
}

/// The numbers of a vector of SUNDIALS.
inline std::vector<double> numbers_in(N_Vector v) {
  const double* first = N_VGetArrayPointer(v);
  return {first, first + N_VGetLength(v)};
}

/// Copies numbers into a vector of SUNDIALS.
inline void fill(N_Vector v, const std::vector<double>& numbers) {
  std::copy(numbers.begin(), numbers.end(), N_VGetArrayPointer(v));
}

/// Runs `evaluate` for a callback in C, which must not throw: the exception is kept for later, and the
/// callback reports permanent failure.
template <class Evaluate>
int guarded(std::exception_ptr& failure, const Evaluate& evaluate) {
  try {
    evaluate();
    return 0;
  } catch (...) {
    failure = std::current_exception();
    return -1;
  }
}

}  // namespace sandglass::verification
