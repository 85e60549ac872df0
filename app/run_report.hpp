#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "problem/make_scene.hpp"
#include "problem/model.hpp"
#include "problem/observer.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"

/// What `sandglass run` prints: what it has understood, and what it found.
namespace sandglass {

/// The size, mass and stiffness of the body, with units, so that a mistake in them is seen.
void print_problem(const Case& description, const Scene& scene);

/// The method as a run computes it, its kappa beside it, and the stable step of the undeformed body.
void print_method(const Model& model);

/// The kappa of a run in words, empty if its method takes none.
std::string kappa_text(const Model& model);

/// What the history of a run shows of its soundness.
class HistoryReport {
 public:
  void take(const HistoryRow& row);

  const HistoryRow& last() const { return last_; }

  /// Hourglass over strain energy: of a quasi-static run at the end, of a motion the largest of both.
  double hourglass_share(bool quasi_static) const;

  /// The energy (J) that nothing accounts for at the end, negative where some is missing, over the largest
  /// energy or work. `damping` is that of the masses, 1/s.
  double unexplained_share(double damping) const;

 private:
  bool started_ = false;
  HistoryRow first_{}, last_{};
  double largest_hourglass_ = 0.0, largest_strain_ = 0.0, largest_ = 0.0;
  double kinetic_time_ = 0.0;  // J s, the integral of the kinetic energy
};

/// How a run ended, and what it found: the largest displacement of u (m), the smallest volume ratio of an
/// element, the share of the hourglass energy, reactions, separate parts.
void print_static_ending(const Relaxation& found, Precision precision, double tolerance, bool went_on);
void print_dynamic_ending(const Motion& found, int subcycles, std::size_t elements, bool went_on);
void print_answer(const Scene& scene, const NodalField& u, const std::vector<double>& volume_ratios,
                  const HistoryReport& history);

/// Warnings on standard error of what makes an answer suspect, with a remedy.
void warn_of_suspect(const Model& model, const HistoryReport& history);

/// The distance of an answer u (m), at the nodes of a scene's own mesh, from the stored truth, and of one
/// that was computed on this mesh also from the stored golden.
void print_accuracy(const Scene& scene, const NodalField& u, bool on_own_mesh);

/// An estimate (m) in units of `unit` (m), and how it was found.
void print_estimate(std::string_view against, const Scene& scene, double unit, double largest, double rms,
                    const std::string& how);

/// How many elements of an adaptive method stand at each of its levels, and what share of the time it took to
/// choose them. Nothing for other methods.
void print_levels(const std::string& method, const std::vector<double>& levels, double share_of_time);

/// Prints what an exchange takes on the rank that sends most; all ranks call it.
void print_traffic(const Ranks& ranks);

}  // namespace sandglass
