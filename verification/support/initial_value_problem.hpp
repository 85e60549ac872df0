#pragma once

#include <functional>
#include <vector>

namespace sandglass::verification {

/// y' of a system of ordinary differential equations at time t (s) and state y.
using Rate = std::function<std::vector<double>(double t, const std::vector<double>& y)>;

/// The state after `duration` seconds from y at time 0, by the explicit Runge-Kutta method of order 8 of
/// ARKODE (SUNDIALS; Fehlberg 13-7-8), whose steps keep the local error of each component below `tolerance`
/// times the sum of its own size and its `scale`. Throws std::runtime_error.
std::vector<double> solved_in_time(const Rate& rate, std::vector<double> y, double duration, double tolerance,
                                   const std::vector<double>& scale);

}  // namespace sandglass::verification
