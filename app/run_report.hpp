#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "problem/observer.hpp"
#include "problem/scene.hpp"

/// What `sandglass run` prints of an answer.
namespace sandglass {

void print_energies(const Scene& scene, const HistoryRow& row);

/// The distance of an answer u (m), at the nodes of a scene's own mesh, from the stored truth, and of one
/// that was computed on this mesh also from the stored golden.
void print_accuracy(const Scene& scene, const NodalField& u, bool on_own_mesh);

/// An estimate (m) in units of `unit` (m), and how it was found.
void print_estimate(std::string_view against, const Scene& scene, double unit, double largest, double rms,
                    const std::string& how);

/// How many elements of an adaptive method stand at each of its levels, and what share of the time it took to
/// choose them. Nothing for other methods.
void print_levels(const std::string& method, const std::vector<double>& levels, double share_of_time);

/// `asleep`: steps had different numbers of elements.
void print_time(double seconds, long steps, std::size_t elements, bool went_on, bool asleep);

/// Prints what an exchange takes on the rank that sends most; all ranks call it.
void print_traffic(const Ranks& ranks);

}  // namespace sandglass
