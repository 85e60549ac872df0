#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "assembly/internal_force.hpp"
#include "base/parameter.hpp"

namespace sandglass {

/// How a quasi-static answer is found: load levels, each solved for its static equilibrium.
struct RelaxationSettings {
  double tolerance = 1e-8;
  int levels = 0;
  int cycles = 0;
  int max_steps = 100000;
  int check_interval = 5;

  static constexpr auto parameters() {
    using S = RelaxationSettings;
    return std::tuple{
        Parameter{&S::tolerance, "tolerance", "-", Range::positive(),
                  "stop when |residual| / |reactions and loads| falls below this", false},
        Parameter{&S::levels, "levels", "-", Range::at_least(0),
                  "equal load levels; 0 chooses as few as the answer needs", false},
        Parameter{&S::cycles, "cycles", "-", Range::at_least(0),
                  "how many times the load returns to a tenth and rises again before the answer", false},
        Parameter{&S::max_steps, "max_steps", "-", Range::at_least(1),
                  "give up after this many evaluations of the forces", false},
        Parameter{&S::check_interval, "check_interval", "-", Range::at_least(1),
                  "evaluations between reports", false}};
  }
};

/// How a dynamic answer is found: central differences with unscaled masses.
struct DynamicsSettings {
  double duration = 0.0;
  double ramp_time = 0.0;
  double time_step = 0.0;
  double step_fraction = 0.9;
  double damping = 0.0;
  int subcycles = 1;
  int body_frequency = 0;
  int check_interval = 20;
  int frames = 20;

  static constexpr auto parameters() {
    using S = DynamicsSettings;
    return std::tuple{
        Parameter{&S::duration, "duration", "s", Range::positive(), "simulated time"},
        Parameter{&S::ramp_time, "ramp_time", "s", Range::at_least(0.0),
                  "time in which imposed displacements, and loads without times or formula, grow by the "
                  "loading curve (10 - 15 s + 6 s^2) s^3 of s = t / ramp_time; 0 means the whole duration",
                  false},
        Parameter{&S::time_step, "time_step", "s", Range::at_least(0.0),
                  "fixed step, at most the stable one; 0 chooses step_fraction of the stable one", false},
        Parameter{&S::step_fraction, "step_fraction", "-", Range{.low = 0.0, .high = 1.0, .high_open = false},
                  "chosen step over the stable one", false},
        Parameter{&S::subcycles, "subcycles", "-",
                  Range{.low = 1.0, .high = 64.0, .low_open = false, .high_open = false},
                  "largest number of small steps that small elements take in a step of the others; 1: all "
                  "take the same",
                  false},
        Parameter{&S::body_frequency, "body_frequency", "-",
                  Range{.low = 0.0, .high = 1.0, .low_open = false, .high_open = false},
                  "1 takes the stable step from the largest frequency of the whole body; 0 from bounds of "
                  "its elements, which is shorter and safer",
                  false},
        Parameter{&S::damping, "damping", "1/s", Range::at_least(0.0), "mass-proportional damping", false},
        Parameter{&S::check_interval, "check_interval", "-", Range::at_least(1),
                  "steps between checks for inversion, divergence and stiffening", false},
        Parameter{&S::frames, "frames", "-", Range::at_least(1), "frames written after the initial one",
                  false}};
  }

  std::optional<BrokenRule> broken_rule() const {
    if (body_frequency == 0 || subcycles == 1) return std::nullopt;
    return BrokenRule{"body_frequency",
                      "= 1 is for steps that all elements share; it must be 0 with subcycles"};
  }
};

/// The part of a case that does not depend on its mesh: its name and how it is solved.
struct CaseSettings {
  std::filesystem::path file;
  std::vector<std::filesystem::path> files;  ///< all files it was read from, with mesh and fibres
  std::string name;                          ///< with the names of its variants, joined by "-"
  std::string family;                        ///< the name that all variants of a file share
  std::vector<std::string> variants;         ///< its variant on each axis of the file; empty without variants
  std::string requirement;
  bool quasi_static = true;  ///< else dynamic
  RelaxationSettings relaxation;
  DynamicsSettings dynamics;
  std::optional<MethodChoice> method;  ///< the default of `sandglass run`
};

}  // namespace sandglass
