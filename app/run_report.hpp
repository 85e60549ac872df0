#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "problem/make_scene.hpp"
#include "problem/model.hpp"
#include "problem/observer.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"

/// The output of `sandglass run`: its input as understood, and its results.
namespace sandglass {

/// Prints size, mass and stiffness of the body with units, so that a wrong unit shows.
void print_problem(const Scene& scene);

/// Prints the method, its kappa and the stable step of the undeformed body.
void print_method(const Model& model);

/// The kappa of a run as text, empty if its method takes none.
std::string kappa_text(const Model& model);

/// Figures from the history of a run that show whether it is sound.
class HistoryReport {
 public:
  void take(const HistoryRow& row);

  const HistoryRow& last() const { return last_; }

  /// The strain and hourglass energy, J: at the end of a quasi-static run; in a motion, the largest of each.
  double strain(bool quasi_static) const;
  double hourglass(bool quasi_static) const;

  /// The largest depth of a node in an obstacle, m: at the end of a quasi-static run; in a motion, the
  /// largest.
  double largest_depth(bool quasi_static) const { return quasi_static ? last_.depth : largest_depth_; }

  /// The unexplained energy (J) at the end, negative if some is missing, over the largest energy or work.
  double unexplained_share() const;

 private:
  bool started_ = false;
  HistoryRow first_{}, last_{};
  double largest_hourglass_ = 0.0, largest_strain_ = 0.0, largest_ = 0.0;
  double largest_depth_ = 0.0;  // m
};

/// Prints the results of a run: the largest displacement of u (m), the smallest volume ratio of an element,
/// the share of the hourglass energy, reactions, separate parts.
void print_static_ending(const Relaxation& found, Precision precision, double tolerance, bool went_on);
void print_dynamic_ending(const Motion& found, const Model& model, bool went_on);
void print_answer(const Model& model, const NodalField& u, const std::vector<double>& volume_ratios,
                  const HistoryReport& history);

/// Prints warnings about a suspect answer to standard error, each with a remedy.
void warn_of_suspect(const Model& model, const HistoryReport& history);

/// Prints the distance of an answer u (m), at the nodes of a scene's own mesh, from the stored truth and, if
/// it was computed on this mesh, from the stored golden.
void print_accuracy(const Scene& scene, const NodalField& u, bool on_own_mesh);

/// Prints an estimate (m) in units of `unit` (m), and how it was found.
void print_estimate(std::string_view against, const Scene& scene, double unit, double largest, double rms,
                    const std::string& how);

/// Prints how many elements of an adaptive method have each of its levels, and the share of the time spent on
/// choosing them. Prints nothing for other methods.
void print_levels(const std::string& method, const std::vector<double>& levels, double share_of_time);

/// Prints the size of an exchange on the rank that sends most; all ranks call it.
void print_traffic(const Ranks& ranks);

}  // namespace sandglass
