#include "counting/program_shape.hpp"

#include <algorithm>

namespace sandglass {

namespace {

/// Calls use(operand) for the operands of a step.
void for_each_operand(const Step& step, const auto& use) {
  if (step.operation == Operation::input) return;
  for (const int operand : step.of) {
    if (operand >= 0) use(static_cast<std::size_t>(operand));
  }
}

}  // namespace

ProgramShape shape_of(const Program& program) {
  const auto& steps = program.steps;
  const std::size_t count = steps.size();
  std::vector<int> uses(count, 0), depth(count, 0);
  std::vector<std::size_t> first(count), last(count);  // steps at which values begin and cease to be needed
  for (std::size_t n = 0; n < count; ++n) {
    first[n] = last[n] = n;
    for_each_operand(steps[n], [&](std::size_t operand) {
      // Inputs are read where they are first used.
      if (steps[operand].operation == Operation::input && uses[operand] == 0) first[operand] = n;
      ++uses[operand];
      last[operand] = n;
    });
  }
  for (const int result : program.results) ++uses[static_cast<std::size_t>(result)];
  ProgramShape shape;
  std::vector<int> change(count + 1, 0);
  for (std::size_t n = 0; n < count; ++n) {
    const Operation operation = steps[n].operation;
    if (operation == Operation::constant) continue;
    ++change[first[n]];
    --change[last[n]];
    if (operation == Operation::input) continue;
    ++shape.operations;
    bool fuses = false;
    for_each_operand(steps[n], [&](std::size_t operand) {
      depth[n] = std::max(depth[n], depth[operand]);
      fuses = fuses || (steps[operand].operation == Operation::multiply && uses[operand] == 1);
    });
    if (fuses && (operation == Operation::add || operation == Operation::subtract)) ++shape.fused;
    shape.chain = std::max(shape.chain, ++depth[n]);
  }
  int alive = 0;
  for (const int more : change) shape.alive = std::max(shape.alive, alive += more);
  return shape;
}

}  // namespace sandglass
