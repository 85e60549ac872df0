#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "counting/operation_count.hpp"
#include "counting/program_shape.hpp"
#include "io/result_file.hpp"

namespace sandglass {

/// The operations of one part of an element per step.
struct CountedPart {
  std::string_view method;
  std::string_view law;
  std::string_view form;  ///< "kernel": as it runs; "paper": as the paper writes it
  std::string_view part;
  Operations operations;
  long bytes = 0;  ///< 0 if the part reads nothing of its own
};

/// Every method with one law, counted by running the kernels.
std::vector<CountedPart> count_methods();

/// Every law at one point of an element; counts do not depend on its parameters.
std::vector<CountedPart> count_laws();

/// The force of an element as a recorded program.
struct CountedProgram {
  std::string_view method;
  ProgramShape shape;
};

/// Of every method that has such a program (`sandglass kernels`), with one law.
std::vector<CountedProgram> count_programs();

/// As JSON: provenance, one record for each part, and one for each program.
std::string to_json(const Provenance& provenance, const std::vector<CountedPart>& parts,
                    const std::vector<CountedProgram>& programs);

}  // namespace sandglass
