#pragma once

#include <functional>
#include <vector>

namespace sandglass::verification {

/// F(x) = 0 as needed by a Newton-Krylov method.
struct NonlinearSystem {
  using Vector = std::vector<double>;
  std::function<Vector(const Vector& x)> residual;
  std::function<Vector(const Vector& x, const Vector& direction)> jacobian_product;  ///< dF/dx . direction
  std::function<Vector(const Vector& r)> precondition;  ///< approximately (dF/dx)^-1 r
};

/// A root of the system from x by KINSOL (SUNDIALS) with line search and flexible GMRES. It stops when the
/// largest component of the residual is below `tolerance`, or earlier if roundoff permits no smaller one:
/// callers must check the residual. `size` is the unit of x. Throws std::runtime_error.
std::vector<double> solved_by_newton_krylov(const NonlinearSystem& system, std::vector<double> x, double size,
                                            double tolerance);

}  // namespace sandglass::verification
